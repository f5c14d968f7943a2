"""Slips: cycles of the reference that were miscounted while it failed.

Signals in: points of the subcarrier, where the next frame should begin, and its number. Signals out: the
whole cycles by which it begins later, or nothing where no frame of the reference's track can be read.

    theta goes on at the last rate of the tape while the reference fails: 0.5 s of a tape that then runs 0.2 %
    faster are 6 cycles. The frame is looked for at every quarter of a symbol, up to two symbols to either
    side; early against late symbols then tell where it begins, to 0.3 cycle.

Source: our own. Questions: a frame at another place than that is taken for lost; speeds that change by more
than 1 % within a loss of a second are a fault.
"""

from __future__ import annotations

from morfax.player.tape.subcarrier import Subcarrier
from morfax.player.tape.symbols import QUARTER, read_symbols
from morfax.recorder.tape.check_frame import NUMBERS, from_bits

CENTRING = 3  # times: what is left after each is a tenth
# quarters of a symbol, nearest first: 48 cycles to either side
TRIED = (0, 1, -1, 2, -2, 3, -3, 4, -4, 5, -5, 6, -6, 7, -7, 8, -8)


def slip(points: Subcarrier, begins: float, number: int) -> int | None:
    """How many cycles later than counted the frame of this number begins; None where none is read."""
    for quarters in TRIED:
        at = begins + quarters * QUARTER
        gates = read_symbols(points, at)
        said = from_bits(gates.bits[:1])[0]
        if said is None or said.track or said.number != number % NUMBERS:
            continue
        for _ in range(CENTRING):
            at += float(gates.late[0])
            gates = read_symbols(points, at)
        return round(at - begins)
    return None
