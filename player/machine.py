"""The machine: a tape in, the motion of the machine's own lead screws out.

Signals in: the tape's frames in blocks. Signals out: Motion in blocks at the motion rate, sample 0 at the start of
the tape, standstill included; a fault of the tape or a drive comes after the last sample that was still right. One
block of tape is held at a time.

The reference track turns the sector wheels through the synchronous motor 116, so the machine's clock is the tape: a
tape that runs fast or flutters makes the machine run fast or flutter along the same path, and the times here are the
tape's own (at an override, the machine's: see setting.py). The zero of each axis is the phase at standstill; the tape
holds displacements, and where they start from is in its text chunk or given by hand.

Source: patent ES 361967, figure 5 and claims 15 to 17.
Questions: which motion is "played" is not in doubt: that of the machine's screws, never of the tape; they differ by
the following error. The end position, where the tape states one, is checked to a quarter of a cycle, as a whole cycle
lost on the way shows nowhere else.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from itertools import chain
from os import PathLike
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from motion.drive import SOUND
from motion.faults import Fault, LockFault, TapeFault
from motion.motion import AXES, Motion
from player.bearings import STANDSTILL_S, Bearings, evened, take_bearings
from player.discriminator import Discriminator, Phases, discriminate
from player.dropouts import Gaps, under_way
from player.monitor import Supervised
from player.phase_lock import Drives, PhaseLock, following_limit
from player.setting import Setting
from player.watch import Watch, demand_apart
from recorder.pipe import Pipe, Samples
from recorder.tape import Stored, Tape, TapeFormat, full_scale

BLOCK_FRAMES = 65536
END_CYCLES = 0.25  # a cycle lost is four times as much, and a drive at rest stands a hundred times nearer

Array = NDArray[np.float64]


def play(
    file: str | PathLike[str],
    *,
    reference_hz: float | None = None,
    cycles_per_mm: float | None = None,
    start_mm: Sequence[float] | None = None,
    settings: PhaseLock | None = None,
    acceleration_mm_s2: float | None = None,
    resume_at_s: float = 0.0,
    zero_mm: Sequence[float] = (),
    override: float = 1.0,
) -> Playback:
    """Put a tape in the machine; what is given by hand goes before its text chunk. Raises TapeFault, FileFault.

    `settings` are those of the drives (MOTORS). `zero_mm`: by how much the phase changers move each axis; `override`: how
    fast the tape runs against the speed at which it was recorded. Raises ValueError for what cannot be of these.

    `acceleration_mm_s2` is the most that the program asks of an axis (else what the motors can do); a dropout is ridden
    over as long as that makes the count certain. `resume_at_s` is a tape time at which the machine stands at `start_mm`.
    """

    def open_tape() -> AbstractContextManager[Tape | Pipe]:
        return Tape.open(file, reference_hz=reference_hz, cycles_per_mm=cycles_per_mm, start_mm=start_mm)

    with open_tape() as tape:
        fmt, frames = tape.format, tape.frames
    if resume_at_s and fmt.end_mm is not None:  # the place is not the tape's start, so the end does not go along
        with Tape.open(file, reference_hz=reference_hz, cycles_per_mm=cycles_per_mm) as tape:
            fmt = replace(fmt, end_mm=tape.format.end_mm)
    setting = Setting(settings or PhaseLock(), tuple(zero_mm), override)
    _check_resumption(resume_at_s, start_mm, frames / fmt.sample_rate_hz)
    return Playback(open_tape, fmt, frames, setting, acceleration_mm_s2, resume_at_s)


def play_pipe(
    stream: BinaryIO,
    *,
    reference_hz: float | None = None,
    cycles_per_mm: float | None = None,
    start_mm: Sequence[float] | None = None,
    samples: Samples | None = None,
) -> Playback:
    """Put a tape that comes through a pipe in the machine, as it comes; it can be played once. Raises TapeFault."""
    start = None if start_mm is None else tuple(start_mm)
    pipe = Pipe.open(stream, reference_hz=reference_hz, cycles_per_mm=cycles_per_mm, start_mm=start, samples=samples)
    return Playback(lambda: pipe, pipe.format, 0, Setting())


def _check_resumption(resume_at_s: float, start_mm: Sequence[float] | None, duration_s: float) -> None:
    """Raise ValueError for a tape time from which a tape cannot be gone on with."""
    if not 0 <= resume_at_s < duration_s:
        raise ValueError(f"the tape cannot be resumed at {resume_at_s:g} s; it lasts from 0 to {duration_s:.3f} s")
    if resume_at_s and start_mm is None:
        raise ValueError(f"where the machine stands at {resume_at_s:g} s must be said; give the place (--from X,Y,Z)")


class Playback(Supervised):
    """A tape in the machine: iterate for the machine's motion, as often as wanted.

    Known beforehand: `format`, `frames`, `duration_s`, `start_mm`. Figures of the last time through, one per axis of
    the tape: `following_error_mm` (the largest), `end_mm` (where the machine stands), `end_error_mm` (against the end
    that the tape states; None before the end, or if it states none). `conditions`: what is wrong with the drives.
    The rate and the times of the motion are the machine's, as are those of a drive's fault; a tape's fault has tape time.
    """

    def __init__(
        self,
        open_tape: Callable[[], AbstractContextManager[Tape | Pipe]],
        fmt: TapeFormat,
        frames: int,
        setting: Setting,
        acceleration_mm_s2: float | None = None,
        resume_at_s: float = 0.0,
    ) -> None:
        self._open_tape, self.format, self.frames, self.setting = open_tape, fmt, frames, setting
        self.rate_hz = fmt.motion_rate_hz * setting.override
        self.settings = setting.lock.suited_to(fmt.motion_rate_hz)
        self._steps = math.ceil(1 / setting.override)  # of the loop to a row: it is no slower where the tape is
        motors_mm_s2 = self.settings.drive.acceleration_mm_s2 / setting.override**2  # as it would be on the tape
        self.acceleration_mm_s2 = motors_mm_s2 if acceleration_mm_s2 is None else acceleration_mm_s2
        self.resume_at_s = resume_at_s
        self._zero_mm = setting.zeros_mm(fmt.axes)
        self.bridged: dict[tuple[float, str], float] = {}
        self._rows = 0
        self.start_mm: Array = np.array(fmt.start_mm, dtype=np.float64) + self._zero_mm
        self.end_mm: Array = self.start_mm.copy()
        self.end_error_mm: Array | None = None
        self.conditions = [SOUND] * len(fmt.axes)
        self.limit = following_limit(self.settings, fmt.mm_per_cycle, self.rate_hz * self._steps)
        self.supervise(fmt.axes, self.rate_hz)

    @property
    def duration_s(self) -> float:
        """How long the tape runs, s."""
        return self.frames / self.format.sample_rate_hz / self.setting.override

    def __iter__(self) -> Iterator[Motion]:
        """Play: the motion in blocks; raises TapeFault, LockFault or FollowingFault after the last sample that was right."""
        fmt = self.format
        drives = Drives(len(fmt.axes), fmt.mm_per_cycle, self.rate_hz, self.settings, steps=self._steps)
        drives.adjust(self._zero_mm)
        drives.conditions = self.conditions
        rest_mm = self.start_mm - self._zero_mm  # where the screws stood before that
        monitor, self.end_error_mm = self.supervise(fmt.axes, self.rate_hz), None
        for phases, bearings, gap in self._phases():
            found = bearings.first_fault(phases, fmt.motion_rate_hz, self.end_mm.tolist()) or gap
            sound = len(phases) if found is None else min(found[0], len(phases))
            cycles = phases.cycles[:sound] - bearings.zero_cycles + self._zero_mm * fmt.cycles_per_mm
            places_mm = drives.follow(cycles) + rest_mm
            demand_mm = cycles[: len(places_mm)] * fmt.mm_per_cycle + rest_mm
            monitor.rows_seen = phases.first_row
            rows = monitor.watch(demand_mm, places_mm)
            if rows:
                self._rows, self.end_mm = phases.first_row + rows, places_mm[rows - 1]
                yield self._motion(places_mm[:rows], phases.first_row)
            if rows < len(places_mm):
                raise monitor.warnings[-1]
            if rows < sound:
                raise self._out_of_range(drives, phases.first_row + rows)
            if found is not None:
                raise found[1]
        self._check_end()

    def _phases(self) -> Iterator[tuple[Phases, Bearings, tuple[int, Fault] | None]]:
        """The tape's phases in blocks, the bearings taken from the first, and the gap that ends it, if one does."""
        fmt, rate_hz = self.format, self.format.motion_rate_hz
        discriminator = Discriminator(fmt.sample_rate_hz, fmt.reference_hz, fmt.samples_per_motion, fmt.tracks)
        first_row = round(self.resume_at_s * rate_hz)
        with self._open_tape() as tape:
            lead = min(first_row, discriminator.filter_frames // fmt.samples_per_motion)  # rows that the filter needs
            blocks = iter(tape.stored_blocks(BLOCK_FRAMES, (first_row - lead) * fmt.samples_per_motion))
            first = next(blocks, np.zeros((0, fmt.tracks), np.float32))
            held = [first]

            def noted() -> Iterator[Stored]:
                for block in chain([held[0]], blocks):
                    held[0] = block
                    yield block

            rows = (evened(rows.moved(first_row - lead), fmt) for rows in discriminate(noted(), discriminator))
            start = next(rows, None)
            if start is None:
                raise self._too_short(discriminator.filter_frames)
            first = full_scale(first)
            if first_row:
                start = start.cut(lead, len(start))
                places = under_way(start, discriminator)
                bearings = replace(take_bearings(first, start, fmt), zero_cycles=places)
            else:
                bearings = take_bearings(first, start, fmt)
                demand_apart(first[: round(STANDSTILL_S * fmt.sample_rate_hz)], bearings.levels, fmt.axes)
            gaps = self._gaps(discriminator, bearings)
            watch = Watch(fmt, bearings)
            for phases in chain([start], rows):
                out, fault = gaps.feed(phases)
                wrong = None if self.resume_at_s else watch.wrong_reference(held[0], self._time_s(phases))
                if wrong is not None:
                    raise wrong
                yield out, bearings, watch.first_fault(out, self.end_mm.tolist()) or fault
            out, fault = gaps.feed(phases.cut(len(phases), len(phases)), last=True)
            yield out, bearings, fault
            doubt = None if self.resume_at_s else watch.doubtful_reference(self._time_s(phases))
            if doubt is not None:
                raise doubt

    def _time_s(self, phases: Phases) -> float:
        """Tape time at the end of some rows, s."""
        return (phases.first_row + len(phases)) / self.format.motion_rate_hz

    def _gaps(self, discriminator: Discriminator, bearings: Bearings) -> Gaps:
        """What bridges the dropouts of this tape."""
        fmt, start_mm = self.format, self.start_mm

        def place_mm(axis: int, cycles: float) -> float:
            return float(start_mm[axis] + (cycles - bearings.zero_cycles[axis]) * fmt.mm_per_cycle)

        most = self.acceleration_mm_s2 * fmt.cycles_per_mm / fmt.motion_rate_hz**2
        gaps = Gaps(discriminator, bearings.levels, fmt.motion_rate_hz, most, place_mm, fmt.axes)
        self.bridged = gaps.bridged
        return gaps

    def _too_short(self, filter_frames: int) -> TapeFault:
        """The fault of a tape that ends before it has begun."""
        return TapeFault(
            f"the tape ends after {self.frames} frames; it must be longer than the discriminator's filter, "
            f"{filter_frames} frames; record it again"
        )

    def _motion(self, places_mm: Array, first_row: int) -> Motion:
        """A block of positions: X, Y, Z and what other axes the tape has; an axis without a track stands at 0."""
        rate_hz, names = self.rate_hz, self.format.axes
        if tuple(names[: len(AXES)]) == AXES:
            return Motion(places_mm, rate_hz, first_row / rate_hz, names)
        columns = [*AXES, *(name for name in names if name not in AXES)]
        positions_mm = np.zeros((len(places_mm), len(columns)))
        positions_mm[:, [columns.index(name) for name in names]] = places_mm
        return Motion(positions_mm, rate_hz, first_row / rate_hz, tuple(columns))

    def _out_of_range(self, drives: Drives, row: int) -> LockFault:
        """The fault of fault circuit 162: a drive that could not follow."""
        error_mm, drive = drives.error_mm, self.settings.drive
        axis = int(np.argmax(np.where(np.isnan(error_mm), np.inf, np.abs(error_mm))))
        name, time_s = self.format.axes[axis], row / self.rate_hz
        error_cycles, position_mm = float(error_mm[axis]) * self.format.cycles_per_mm, float(self.end_mm[axis])
        return LockFault(
            f"the drive of {name.upper()} lost its lock at {time_s:.3f} s, position {position_mm:.3f} mm: error "
            f"{error_cycles:+.2f} cycles, allowed ±{self.settings.range_cycles:g}; the tape asks for more than "
            f"{drive.acceleration_mm_s2:g} mm/s² or {drive.top_speed_mm_s:g} mm/s: play it slower, or record it smoother",
            axis=name,
            time_s=time_s,
            error_cycles=error_cycles,
            position_mm=position_mm,
        )

    def _check_end(self) -> None:
        """Compare where the machine stands with what the tape says; raises LockFault beyond a quarter of a cycle."""
        fmt = self.format
        if fmt.end_mm is None:
            return
        self.end_error_mm = self.end_mm - np.array(fmt.end_mm) - self._zero_mm
        axis = int(np.argmax(np.abs(self.end_error_mm)))
        error_mm, position_mm = float(self.end_error_mm[axis]), float(self.end_mm[axis])
        if abs(error_mm) * fmt.cycles_per_mm <= END_CYCLES:
            return
        raise LockFault(
            f"{fmt.axes[axis].upper()} ends at {position_mm:.3f} mm, {error_mm:+.3f} mm from the end that the tape "
            f"states; allowed ±{END_CYCLES * fmt.mm_per_cycle:g} mm; cycles were lost, or it is cut short: get another",
            axis=fmt.axes[axis],
            time_s=self._rows / fmt.motion_rate_hz,
            error_cycles=error_mm * fmt.cycles_per_mm,
            position_mm=position_mm,
        )
