"""The tail of a tape: what becomes of an axis behind the last of its delays.

Signals in: the rows of an axis that are held to the tape's end, put right by its delay; the delay, and what
the axis told of its motion. Signals out: the row from which it stands still, or how far its delay is in
doubt.

    at rest    the axis told that it stands still from the last settled delay on: what moves there is the
               delay, and the axis is held; more than a quarter of a cycle is a fault
    moving     the straight line through seven delays runs on; averages of the way lie further apart than the
               axis told that it moves by 0.03 cycle, or three standard errors of the line are a twentieth of
               a cycle: a fault

Source: our own. Questions: 26 dB of noise move an axis by 0.006 cycle behind the last delay told, a reel by
0.026.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.player.tape.delays import Delay
from morfax.player.tape.standstill import ALLOWED_CYCLES
from morfax.player.tape.told_bounds import ToldBounds
from morfax.recorder.tape.format import SURE_CYCLES, TapeFormat

TAIL_CYCLES = 0.03
MEAN_S = 0.025  # over which places are averaged


class Tail(NamedTuple):
    """The row from which an axis stands still to the end, if it does; its delay's doubt, s: 0 is none."""

    rest_row: int | None
    off_s: float


def tail_of(
    way: Array, first_row: int, delay: Delay, bounds: ToldBounds, fmt: TapeFormat
) -> Tail:
    """What becomes of a way (n,), cycles, that goes from a row to the tape's end."""
    last = first_row + len(way) - 1
    mean_rows = round(MEAN_S * fmt.motion_rate_hz)
    settled = max(int(delay.settled_row), first_row)
    if bounds.rests(settled, last):
        off = apart(way[settled - first_row :], mean_rows) - SURE_CYCLES
        return Tail(settled, max(off, 0.0) / fmt.reference_hz)
    told = max(int(delay.told_row), first_row)
    rest, bound = way[told - first_row :], bounds.between(told, last)
    moves = bound.speed * len(rest) if bound else 0.0
    off = apart(rest, mean_rows) - TAIL_CYCLES - moves
    doubt_s = delay.doubt_s(last)
    if off <= 0 and doubt_s * fmt.reference_hz <= ALLOWED_CYCLES:
        return Tail(None, 0.0)
    return Tail(None, max(off / fmt.reference_hz, doubt_s))


def apart(places: Array, rows: int) -> float:
    """How far averages of so many places (n,), one behind the other, lie apart."""
    some = max(min(rows, len(places)), 1)
    return float(np.ptp(np.convolve(places, np.full(some, 1 / some), "valid")))
