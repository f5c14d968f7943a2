"""Vouching: rows of the tape are held until the check signal has vouched for them, and delays are taken out.

Signals in: rows of phases that the dropouts have left certain, and the reports of the check reader. Signals
out: rows that are vouched for, about a second later, and the first that is not, with its fault.

    identity    each track says which it is                      another order: a fault
    number      frames follow one another, at their time         a lost or repeated stretch: a fault
    late        symbols lie within 0.25 ms of the clock          the same, where it is less than a frame
    delay       of a track against the reference                 above 200 us, or a step: a fault
                                                                 below: taken out of the phase
    count       cycles of the axis at the start of each frame    a quarter of a cycle off: a fault
    last        the last two frames say that the tape ends       the end is missing: a fault

A frame of a track may be missing, in a dropout, if one of the next vouches for what was between.

Source: our own. Questions: a delay that drifts by 50 us/s moves 12 us in two parts of a frame; one lost
sample moves 21. A sample that is lost on all tracks alike moves nothing but the time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import Fault
from morfax.player.tape import check_faults as faults
from morfax.player.tape.check_reader import CheckReader, FrameReport
from morfax.player.tape.delays import Delay
from morfax.player.tape.discriminator import Phases
from morfax.recorder.tape.check_frame import NUMBERS, CheckFrame
from morfax.recorder.tape.check_signal import CYCLES_PER_FRAME
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.tape.tape import Stored

LARGEST_DELAY_S = 200e-6  # what is asked; half a cycle of the subcarrier is 500
LARGEST_LATE_S = 250e-6  # of the symbols: the delay, and 50 us for the gates
LARGEST_STEP_S = 16e-6  # of a delay in two parts of a frame, 0.24 s: 50 us/s of drift are 12
COUNT_CYCLES = 0.25  # as the end is checked
MOST_MISSING = 3  # frames in a row of one track

Vouched = tuple[Phases, tuple[int, Fault] | None]


class Vouching:
    """Holds the rows of one tape until they are vouched for.

    `zero_cycles` is where the count of each axis begins; None: at its first frame, on a tape that is resumed.
    Unless it `trusts_counts`, a count that differs is let pass.
    """

    is_checked = True

    def __init__(
        self, fmt: TapeFormat, check: CheckReader, *, trusts_counts: bool = True
    ) -> None:
        self._format, self._check, self._trusts_counts = fmt, check, trusts_counts
        self.zero_cycles: Array | None = None
        self._rate_hz, self._reference_hz = fmt.motion_rate_hz, fmt.reference_hz
        self._delays = [Delay(fmt.reference_hz, fmt.motion_rate_hz) for _ in fmt.axes]
        self._held: Phases | None = None
        self._given = 0  # rows that were given out and are still held, to lend their speed
        self._counts: list[tuple[float, int, float]] = []  # row, axis, cycles: not yet checked
        self._told: list[list[float]] = [[] for _ in range(fmt.tracks)]  # delays of a frame, s
        self._missing = np.zeros(fmt.tracks, int)
        self._number: int | None = None  # of the next frame
        self._counted = [0.0] * len(fmt.axes)  # the last row at which the count was right
        self._is_last = np.zeros(fmt.tracks, bool)
        self._fault: Fault | None = None

    def hear(self, frames: Stored) -> None:
        """Take the next frames of the tape."""
        self._check.feed(frames)

    def begin(self, rows: Phases) -> Phases:
        """The first rows, put right as far as the first frames tell; raises TapeFault for a wrong track."""
        self._demand_all_tracks()
        self._take_reports()
        return self._corrected(rows)

    def end(self, time_s: float) -> None:
        """The tape ends, and has said so."""

    def _demand_all_tracks(self) -> None:
        """Raise TapeFault unless each track says in the first block that it is what it should be."""
        names = self._format.axes
        for track, says in enumerate(self._check.tracks):
            if says is None:
                raise faults.silent_track(track, names)
            if says != track:
                raise faults.wrong_track(track, says, names, 0.0)

    def _take_reports(self) -> None:
        """Take what the check reader has read by now."""
        for report in self._check.reports():
            if self._fault is None:
                self._take(report)

    def _corrected(self, rows: Phases) -> Phases:
        """The rows without the delays of their tracks."""
        if not any(delay.moves for delay in self._delays):
            return rows
        columns = [
            delay.corrected(column, rows.first_row)
            for delay, column in zip(self._delays, rows.cycles.T, strict=True)
        ]
        return replace(rows, cycles=np.column_stack(columns))

    def feed(
        self,
        rows: Phases,
        fault: tuple[int, Fault] | None,
        stands_mm: Callable[[], Sequence[float]],
        *,
        last: bool = False,
    ) -> Vouched:
        """Take the next rows and the fault behind them; the rows that are vouched for, and the fault."""
        self._held = held = rows if self._held is None else self._held.joined(rows)
        if last:
            self._check.finish()
        self._take_reports()
        self._check_counts(held, stands_mm)
        ended = last and fault is None and self._fault is None
        if ended and not self._is_last.all():
            self._fault = faults.no_end(self._vouched / self._rate_hz)
            ended = False
        upto = len(held) if ended else min(int(self._vouched) - held.first_row, len(held))
        upto = max(upto, self._given)
        out = self._cut(held, upto)
        if self._fault is not None:
            return out, (len(out), self._fault)
        if fault is not None:
            return out, (len(out), fault[1])
        keep = max(upto - self._delays[0].span, 0)
        self._held, self._given = held.cut(keep, len(held)), upto - keep
        return out, None

    def _cut(self, held: Phases, upto: int) -> Phases:
        """The rows up to one that are not yet given out, put right; those around them lend their speed."""
        if upto <= self._given:
            return held.cut(upto, upto)
        beyond = held.cut(0, upto + self._delays[0].span)
        return self._corrected(beyond).cut(self._given, upto)

    @property
    def _vouched(self) -> float:
        """The row up to which delays and counts are known."""
        settled = min(delay.settled_row for delay in self._delays)
        return min(settled, *self._counted)

    def _take(self, report: FrameReport) -> None:
        """Take the report of one frame."""
        expected = report.number if self._number is None else self._number
        self._number = report.number + 1
        for track, said in enumerate(report.said):
            if said is None:
                self._missing[track] += 1
                if self._missing[track] > MOST_MISSING:
                    time_s = report.row / self._rate_hz - MOST_MISSING * self._frame_s
                    self._fault = faults.unreadable(track, self._format.axes, time_s)
                continue
            self._missing[track] = 0
            self._is_last[track] = said.last
            fault = self._misplaced(track, said, expected, report)
            fault = fault or self._too_late(track, report)
            if fault is not None:
                self._fault = self._fault or fault
                return
            self._note(track, said.cycles, report)

    def _note(self, track: int, cycles: float, report: FrameReport) -> None:
        """Note the count and the delays of one track."""
        delays_s = report.delay_s[track]
        if not all(map(math.isfinite, delays_s)):
            return  # the reference says nothing
        self._told[track] = (self._told[track] + delays_s)[-4:]
        if not track:
            return
        axis = track - 1
        self._counts.append((report.row, axis, cycles))
        self._delays[axis].add(report.part_rows, delays_s)

    def _check_counts(self, held: Phases, stands_mm: Callable[[], Sequence[float]]) -> None:
        """Compare the axes' counts with what their tracks say; note the first that differs."""
        ends = held.first_row + len(held) - 1
        due = [count for count in self._counts if count[0] <= ends]
        self._counts = [count for count in self._counts if count[0] > ends]
        if self.zero_cycles is None:
            self.zero_cycles = np.full(len(self._delays), np.nan)
        for row, axis, told in due:
            at = max(int(row) - held.first_row, 0)
            first, reach = (
                max(at - 2 * self._delays[axis].span, 0),
                at + 2 * self._delays[axis].span,
            )
            near = self._delays[axis].corrected(
                held.cycles[first : reach + 1, axis], held.first_row + first
            )
            found = float(np.interp(row - held.first_row - first, np.arange(len(near)), near))
            if math.isnan(self.zero_cycles[axis]):
                self.zero_cycles[axis] = found - told
            off = found - float(self.zero_cycles[axis]) - told
            if abs(off) <= COUNT_CYCLES or not self._trusts_counts:
                self._counted[axis] = row
            elif self._fault is None:
                name, time_s = self._format.axes[axis], row / self._rate_hz
                self._fault = faults.miscounted(
                    name, off, COUNT_CYCLES, time_s, stands_mm()[axis]
                )
                return

    def _misplaced(
        self, track: int, said: CheckFrame, expected: int, report: FrameReport
    ) -> Fault | None:
        """The fault of a track that says to be another, or whose frame is not the next."""
        names, time_s = self._format.axes, report.row / self._rate_hz
        if said.track != track:
            return faults.wrong_track(track, said.track, names, time_s)
        off = (said.number - expected + NUMBERS // 2) % NUMBERS - NUMBERS // 2
        return faults.disordered(track, names, off * self._frame_s, time_s) if off else None

    def _too_late(self, track: int, report: FrameReport) -> Fault | None:
        """The fault of a track whose delay is too long, or makes a step: samples were lost or repeated."""
        names, time_s = self._format.axes, report.row / self._rate_hz
        late_s = report.late_s[track]
        told = self._told[track] + [
            delay for delay in report.delay_s[track] if math.isfinite(delay)
        ]
        longest_s = max(map(abs, told), default=0.0)
        if abs(late_s) > LARGEST_LATE_S or longest_s > LARGEST_DELAY_S:
            late_s = late_s if abs(late_s) > LARGEST_LATE_S else longest_s
            return faults.too_late(track, names, late_s, LARGEST_DELAY_S, time_s)
        step_s = max((abs(b - a) for a, b in zip(told, told[2:], strict=False)), default=0.0)
        return faults.stepped(track, names, step_s, time_s) if step_s > LARGEST_STEP_S else None

    @property
    def _frame_s(self) -> float:
        """Length of a frame of the check signal, s."""
        return CYCLES_PER_FRAME / self._reference_hz
