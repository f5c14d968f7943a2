"""The tail of a tape: how far an axis moves behind its last delays, more than it told.

Signals in: the rows of an axis that are held to the tape's end, put right by its delay, and the delay.
Signals out: by how many cycles averages of them lie further apart than the axis told that it moves.

    told       behind the last delay that is told, a straight line runs on     0.03 cycle
    settled    behind the last that is settled, the line goes through it       0.045 cycle

Source: our own. Questions: 26 dB of noise move an axis by 0.006 cycle, a reel by 0.026 and 0.042.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.player.tape.delays import Delay
from morfax.player.tape.told_bounds import ToldBounds

TOLD_CYCLES, SETTLED_CYCLES = 0.03, 0.045
MEAN_S = 0.025  # over which places are averaged


def beyond_cycles(
    way: Array, first_row: int, delay: Delay, bounds: ToldBounds, mean_rows: int
) -> float:
    """By how much a way (n,) from a row to the tape's end moves more than was told; 0: it does not."""
    last, most = first_row + len(way) - 1, 0.0
    for row, allowed in ((delay.told_row, TOLD_CYCLES), (delay.settled_row, SETTLED_CYCLES)):
        first = max(int(row), first_row)
        rest, bound = way[first - first_row :], bounds.between(first, last)
        told = bound.speed * len(rest) if bound else 0.0
        most = max(most, apart(rest, mean_rows) - allowed - told)
    return most


def apart(places: Array, rows: int) -> float:
    """How far averages of so many places (n,), one behind the other, lie apart."""
    some = max(min(rows, len(places)), 1)
    return float(np.ptp(np.convolve(places, np.full(some, 1 / some), "valid")))
