"""The counts that the tracks of the axes tell, until they are compared with what their phases say.

Signals in: frame by frame the rows of its start and its middle, and what each axis tells there; where an axis
was found at such a row, cycles. Signals out: how far it lies off, and how far it may.

    grain      half of a count: 1/128 cycle, 1/32 in tapes of version 1
    noise      three standard deviations of the phase in a row, which the check signal tells (a standard error
               of a told delay, as a share of the reference's cycle), and 0.008 cycle for delays that drift
               and starts that are cut (measured: 0.004); 0.02 in all, as noise of 26 dB needs
    instant    how well a frame's first instant is known: measured 1 us, 13 us under a tilted head, 18 us
               behind a start that is cut; an axis that moves is off by as much as it goes meanwhile

Source: our own. Questions: counts begin again after 0.8 m at 20 cycles per mm (52 m in tapes of versions 1
and 2), those of the middle after each cycle, and differences are taken so.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from morfax.motion.median import OUTLIERS
from morfax.recorder.tape.check_frame import CheckFrame
from morfax.recorder.tape.format import SURE_CYCLES

LEAST_NOISE_CYCLES, MOST_NOISE_CYCLES = 0.008, 0.02
INSTANT_S = 15e-6

Told = dict[int, CheckFrame]  # by axis


class Due(NamedTuple):
    """The row at which axes are told, what each tells, how far it may lie off; whether it is the middle."""

    row: float
    told: Told
    limit_cycles: dict[int, float]
    is_middle: bool


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
        self.zero_cycles = [math.nan] * axes
        self._is_timed = is_timed
        self._waiting: list[Due] = []

    def begin(self, row: float, middle_row: float) -> None:
        """Begin the next frame."""
        self._waiting += [Due(row, {}, {}, False), Due(middle_row, {}, {}, True)]

    def tell(self, axis: int, said: CheckFrame, error_cycles: float) -> None:
        """Take what an axis tells in it; `error_cycles`: the standard error of a delay that it tells."""
        start, middle = self._waiting[-2:]
        noise = min(MOST_NOISE_CYCLES, LEAST_NOISE_CYCLES + OUTLIERS * error_cycles)
        limit = said.grain_cycles / 2 + noise + INSTANT_S * said.speed
        start.told[axis] = said
        start.limit_cycles[axis] = limit if self._is_timed else SURE_CYCLES
        if said.middle_cycles is not None and self._is_timed:
            middle.told[axis], middle.limit_cycles[axis] = said, limit

    def due(self, first_row: int, rows: int) -> Due | None:
        """What is told next within so many rows from one on; None if there is nothing yet."""
        while self._waiting and rows and self._waiting[0].row <= first_row + rows - 1:
            due = self._waiting.pop(0)
            is_zeroed = not any(map(math.isnan, self.zero_cycles))
            # before the first row an axis still stands, unless the tape is taken up under way
            if is_zeroed or (due.row >= first_row and not due.is_middle):
                return due
        return None

    def off(self, axis: int, found: float, due: Due) -> Off:
        """What an axis tells held against the place where it was found, cycles."""
        said = due.told[axis]
        if math.isnan(self.zero_cycles[axis]):
            self.zero_cycles[axis] = found - said.cycles
        off = found - self.zero_cycles[axis]
        limit = due.limit_cycles[axis]
        if due.is_middle and said.middle_cycles is not None:
            return Off(math.remainder(off - said.middle_cycles, 1.0), limit)
        return Off(math.remainder(off - said.cycles, said.turn_cycles), limit)
