"""The counts that the tracks of the axes tell, until they are compared with what their phases say.

Signals in: frame by frame the row at which it begins and what each axis tells there; where an axis was found
at that row, cycles. Signals out: how far it lies off, and how far it may.

    grain      half of a count: 1/128 cycle, 1/32 in tapes of version 1
    noise      0.02 cycle: noise of 26 dB and delays leave 0.016
    instant    how well a frame's first instant is known: measured 1 us, 13 us under a tilted head, 18 us
               behind a start that is cut; an axis that moves is off by as much as it goes meanwhile

Source: our own. Questions: counts begin again after 52 m at 20 cycles per mm, and differences are taken so.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.player.tape.lost_ways import COUNT_CYCLES
from morfax.recorder.tape.check_frame import CheckFrame

NOISE_CYCLES = 0.02
INSTANT_S = 15e-6

Told = dict[int, CheckFrame]  # by axis


class Off(NamedTuple):
    """How far the count of an axis lies off the place where it was found, and how far it may, cycles."""

    cycles: float
    limit_cycles: float

    @property
    def is_right(self) -> bool:
        """Whether it lies off by no more than it may."""
        return abs(self.cycles) <= self.limit_cycles


class Counts:
    """The counts of one tape that are not yet compared; `zero_cycles`: where those of each axis begin.

    `is_timed`: whether the reference itself says when its frames begin. Else an axis that moves is told as
    at another moment, and only whole cycles count.
    """

    def __init__(self, axes: int, *, is_timed: bool) -> None:
        self.zero_cycles: Array = np.full(axes, np.nan)
        self._is_timed = is_timed
        self._waiting: list[tuple[float, Told]] = []

    def begin(self, row: float) -> None:
        """Begin the next frame."""
        self._waiting.append((row, {}))

    def tell(self, axis: int, said: CheckFrame) -> None:
        """Take what an axis tells in it."""
        self._waiting[-1][1][axis] = said

    def due(self, first_row: int, rows: int) -> tuple[float, Told] | None:
        """The next frame that begins within so many rows from one on; None if there is none yet."""
        while self._waiting and rows and self._waiting[0][0] <= first_row + rows - 1:
            row, told = self._waiting.pop(0)
            # before the first row an axis still stands, unless the tape is taken up under way
            if row >= first_row or not np.isnan(self.zero_cycles).any():
                return row, told
        return None

    def off(self, axis: int, found: float, said: CheckFrame) -> Off:
        """What an axis tells held against the place where it was found, cycles."""
        if math.isnan(self.zero_cycles[axis]):
            self.zero_cycles[axis] = found - said.cycles
        off = found - float(self.zero_cycles[axis]) - said.cycles
        limit = said.grain_cycles / 2 + NOISE_CYCLES + INSTANT_S * said.speed
        return Off(
            math.remainder(off, said.turn_cycles), limit if self._is_timed else COUNT_CYCLES
        )
