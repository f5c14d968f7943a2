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

import numpy as np

from morfax.motion.compiled import njit
from morfax.motion.median import OUTLIERS
from morfax.player.tape.calm_frames import CalmFrames
from morfax.player.tape.held_rows import HeldRows
from morfax.recorder.tape.check_frame import COUNTS_PER_CYCLE, VERSION, CheckFrame, turn_cycles
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

    def __init__(self, axes: int, reference_hz: float, *, is_timed: bool) -> None:
        self.zero_cycles = [math.nan] * axes
        self._reference_hz = reference_hz
        of_axis = 1 / COUNTS_PER_CYCLE[VERSION], turn_cycles(VERSION, 1)
        self._scale = reference_hz, *of_axis
        self._is_timed = is_timed
        self._waiting: list[Due] = []
        self._calm: list[CalmFrames] = []  # behind those that wait
        self._done = 0  # moments of the first of them: two a frame

    def begin(self, row: float, middle_row: float) -> None:
        """Begin the next frame."""
        while self._calm:
            self._unfold()
        self._wait(row, middle_row)

    def _wait(self, row: float, middle_row: float) -> None:
        """Let the start and the middle of a frame wait."""
        self._waiting += [Due(row, {}, {}, False), Due(middle_row, {}, {}, True)]

    def tell(self, axis: int, said: CheckFrame, error_s: float) -> None:
        """Take what an axis tells in it; `error_s`: the standard error of a delay that it tells."""
        start, middle = self._waiting[-2:]
        limit = _limit_cycles.py_func(
            said.grain_cycles, said.speed, error_s * self._reference_hz
        )
        start.told[axis] = said
        start.limit_cycles[axis] = limit if self._is_timed else SURE_CYCLES
        if said.middle_cycles is not None and self._is_timed:
            middle.told[axis], middle.limit_cycles[axis] = said, limit

    def take(self, frames: CalmFrames) -> None:
        """Take calm frames; the reference says when they begin."""
        self._calm.append(frames)

    def pass_right(self, held: HeldRows) -> float | None:
        """Compare what calm frames tell, as long as it is right; the last start of a frame among that.

        The axes are where their rows say: no delay is to be taken out.
        """
        passed, zeros = None, np.array(self.zero_cycles)
        while self._calm and not self._waiting and len(held):
            frames, begun = self._calm[0], self._done
            near = held.around(frames.rows[begun // 2, begun % 2])
            told = frames.rows, frames.said, frames.figures
            self._done = _right_until(begun, told, self._scale, near, zeros)
            last = (self._done - 1) // 2
            if 2 * last >= begun:
                passed = float(frames.rows[last, 0])
            if self._done == begun:
                break
            self._drop_compared()
        return passed

    def _drop_compared(self) -> None:
        """Let the first calm frames go if all of them are compared."""
        if self._done == 2 * self._calm[0].frames:
            self._calm.pop(0)
            self._done = 0

    def _is_due(self, last_row: int) -> bool:
        """Whether what is told next lies no further on than a row."""
        if self._calm and not self._waiting:
            at, is_middle = divmod(self._done, 2)
            if self._calm[0].rows[at, is_middle] > last_row:
                return False
            self._unfold()
        return bool(self._waiting) and self._waiting[0].row <= last_row

    def _unfold(self) -> None:
        """Let the next calm frame wait as any other, as far as it is not compared."""
        at, is_middle = divmod(self._done, 2)
        report = self._calm[0].report(at)
        self._done += 2 - is_middle
        self._drop_compared()
        self._wait(report.row, report.middle_row)
        for axis, said in enumerate(report.said[1:]):
            assert said is not None
            self.tell(axis, said, report.error_s[axis + 1])
        if is_middle:
            del self._waiting[-2]

    def due(self, first_row: int, rows: int) -> Due | None:
        """What is told next within so many rows from one on; None if there is nothing yet."""
        while rows and self._is_due(first_row + rows - 1):
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


@njit(cache=True, nogil=True)
def _limit_cycles(grain_cycles, speed, error_cycles):  # type: ignore[no-untyped-def]
    """How far an axis may lie off what it tells, cycles."""
    noise = min(MOST_NOISE_CYCLES, LEAST_NOISE_CYCLES + OUTLIERS * error_cycles)
    return grain_cycles / 2 + noise + INSTANT_S * speed


@njit(cache=True, nogil=True)
def _right_until(done, told, scale, near, zeros):  # type: ignore[no-untyped-def]
    """How many moments of calm frames, two each, lie among some rows and are right, of all axes.

    `done`: so many were before; `told`: rows, what is said, and figures, of CalmFrames; `scale`: Hz of the
    reference, cycles of a count, and after how many counts begin again; `near`: the first of the rows, and
    the places there.
    """
    (moments, said, figures), (first_row, cycles) = told, near
    reference_hz, grain_cycles, whole = scale
    for moment in range(done, 2 * len(moments)):
        frame, is_middle = moment // 2, moment % 2
        at = max(moments[frame, is_middle] - first_row, 0.0)
        low = int(at)
        if low + 1 >= len(cycles):
            return moment
        turn = 1.0 if is_middle else whole
        for axis in range(len(zeros)):
            before = cycles[low, axis]
            place = before + (at - low) * (cycles[low + 1, axis] - before)
            off = place - zeros[axis] - said[frame, axis, is_middle]
            off -= turn * np.rint(off / turn)
            error_cycles = figures[frame, axis + 1, -2] * reference_hz
            limit = _limit_cycles(grain_cycles, said[frame, axis, 2], error_cycles)
            if not abs(off) <= limit:
                return moment
    return 2 * len(moments)
