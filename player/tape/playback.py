"""The machine: a tape in, the motion of the machine's own lead screws out.

Signals in: the tape's frames in blocks. Signals out: Motion in blocks at the motion rate, sample 0 at the
start of the tape, standstill included; a fault of the tape or a drive comes after the last sample that was
still right. A few blocks of tape are held at a time: a file is read ahead of the drives (ahead.py).

The reference track turns the sector wheels through the synchronous motor 116, so the machine's clock is the
tape: a tape that runs fast or flutters makes the machine run fast or flutter along the same path, and the
times here are the tape's own (at an override, the machine's: see setting.py). The zero of each axis is the
phase at standstill; the tape holds displacements, and where they start from is in its text chunk or given by
hand.

Source: patent ES 361967, figure 5 and claims 15 to 17. Questions: which motion is "played" is not in doubt:
that of the machine's screws, never of the tape; they differ by the following error. The end position, where
the tape states one, is checked to a quarter of a cycle, as a whole cycle lost on the way shows nowhere else.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from itertools import islice
from os import PathLike
from typing import BinaryIO, Unpack

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.drive import SOUND
from morfax.motion.faults import Fault, LockFault
from morfax.motion.motion import AXES, Motion
from morfax.player.monitor.monitor import Supervised
from morfax.player.tape.ahead import ReadAhead
from morfax.player.tape.drives import Drives, ReferenceTrack, following_limit
from morfax.player.tape.lock_faults import Stood, ended_elsewhere, out_of_range
from morfax.player.tape.phase_lock import PhaseLock
from morfax.player.tape.reader import ReadRows, TapeReader
from morfax.player.tape.sector_wheel import SectorWheel
from morfax.player.tape.setting import Setting, check_resumption
from morfax.player.tape.track_order import found_order
from morfax.recorder.sound.pipe import PipeSource, Samples
from morfax.recorder.sound.source import FileSource, Source
from morfax.recorder.tape.format import SURE_CYCLES
from morfax.recorder.tape.stated import TapeEntries
from morfax.recorder.tape.tape import Tape, TapeFormat


def play(
    file: str | PathLike[str] | Callable[[], Source],
    *,
    closed: bool = False,
    settings: PhaseLock | None = None,
    acceleration_mm_s2: float | None = None,
    resume_at_s: float = 0.0,
    zero_mm: Sequence[float] = (),
    override: float = 1.0,
    wheel: SectorWheel | None = None,
    **by_hand: Unpack[TapeEntries],
) -> TapePlayback:
    """Put a tape in the machine, with what is given of it by hand. Raises TapeFault, FileFault.

    `file`: its name, or what opens its source, each time that it is called. `closed`: it returns to its
    start, if it does not say where it ends.

    `settings` are those of the drives (MOTORS). `zero_mm`: by how much the phase changers move each axis;
    `override`: how fast the tape runs against the speed at which it was recorded. `wheel`: what is wrong with
    the sector wheels of the machine's pick-ups. Raises ValueError for what cannot be of these.

    `acceleration_mm_s2` is the most that the program asks of an axis (else what the motors can do); a dropout
    is ridden over as long as that makes the count certain. `resume_at_s` is a tape time at which the machine
    stands at `start_mm`.
    """

    opened = file if callable(file) else lambda: FileSource(file)

    def open_tape() -> Tape:
        return Tape.of(opened(), **by_hand)

    with open_tape() as tape:
        fmt, frames = _ending(tape.format, closed), tape.frames
        ordered = by_hand.get("order") or resume_at_s
        found, check = (None, None) if ordered else found_order(tape)
    if found:
        by_hand["order"] = found
    start_mm = by_hand.get("start_mm")
    # the place is not the tape's start, so the end does not go along
    if resume_at_s and fmt.end_mm is not None:
        at_start: TapeEntries = {**by_hand, "start_mm": None}
        with Tape.of(opened(), **at_start) as tape:
            fmt = replace(fmt, end_mm=tape.format.end_mm)
    setting = Setting(settings or PhaseLock(), tuple(zero_mm), override, wheel or SectorWheel())
    check_resumption(resume_at_s, start_mm, frames / fmt.sample_rate_hz)
    playback = TapePlayback(open_tape, fmt, frames, setting, acceleration_mm_s2, resume_at_s)
    playback.found_order, playback.reads_ahead = found, True
    if found is None:
        playback.reader.begun = check
    return playback


def play_pipe(
    stream: BinaryIO,
    *,
    samples: Samples | None = None,
    closed: bool = False,
    **by_hand: Unpack[TapeEntries],
) -> TapePlayback:
    """Put a tape from a pipe in the machine, as `play_live` does."""
    return play_live(PipeSource(stream, samples), closed=closed, **by_hand)


def play_live(
    source: Source, *, closed: bool = False, **by_hand: Unpack[TapeEntries]
) -> TapePlayback:
    """Put a tape that comes once, through a pipe or from a device, in the machine. Raises TapeFault."""
    tape = Tape.of(source, **by_hand)
    return TapePlayback(lambda: tape, _ending(tape.format, closed), 0, Setting())


def _ending(fmt: TapeFormat, closed: bool) -> TapeFormat:
    """The format with the end of a closed program, if it states none."""
    return replace(fmt, end_mm=fmt.start_mm) if closed and fmt.end_mm is None else fmt


class TapePlayback(Supervised):
    """A tape in the machine: iterate for the machine's motion, as often as wanted.

    Known beforehand: `format`, `frames`, `duration_s`, `start_mm`. Figures of the last time through, one per
    axis of the tape: `following_error_mm` (the largest), `end_mm` (where the machine stands), `end_error_mm`
    (against the end that the tape states; None before the end, or if it states none), `cell_edges` (given by
    the pick-up). `conditions`: what is wrong with the drives. `found_order`: on which tracks reference, X,
    Y … were found, if that was not as they should be. The rate and the times of the motion are the machine's,
    as are those of a drive's fault; a tape's fault has tape time.
    """

    def __init__(
        self,
        open_tape: Callable[[], AbstractContextManager[Tape]],
        fmt: TapeFormat,
        frames: int,
        setting: Setting,
        acceleration_mm_s2: float | None = None,
        resume_at_s: float = 0.0,
    ) -> None:
        self.format, self.frames, self.setting = fmt, frames, setting
        self.rate_hz = fmt.motion_rate_hz * setting.override
        self.settings = setting.lock.suited_to(fmt.motion_rate_hz)
        # of the loop to a row: it is no slower where the tape is
        self._steps = math.ceil(1 / setting.override)
        # as it would be on the tape
        motors_mm_s2 = self.settings.drive.acceleration_mm_s2 / setting.override**2
        self.acceleration_mm_s2 = (
            motors_mm_s2 if acceleration_mm_s2 is None else acceleration_mm_s2
        )
        self._zero_mm = setting.zeros_mm(fmt.axes)
        self._rows = 0
        self.reads_ahead = False
        self.start_mm: Array = np.array(fmt.start_mm, dtype=np.float64) + self._zero_mm
        self.reader = TapeReader(
            open_tape, fmt, self.start_mm, self.acceleration_mm_s2, resume_at_s
        )
        self.end_mm: Array = self.start_mm.copy()
        self.end_error_mm: Array | None = None
        self._bridged: int | None = (
            None  # how many dropouts lie before what was played; None: all
        )
        self.cell_edges: Array = np.zeros(len(fmt.axes))
        self.found_order: tuple[int, ...] | None = None
        self.notes: tuple[str, ...] = ()  # some tapes give them when their first block is read
        self.conditions = [SOUND] * len(fmt.axes)
        self.limit = following_limit(
            self.settings, fmt.mm_per_cycle, self.rate_hz * self._steps
        )
        self.supervise(fmt.axes, self.rate_hz)

    @property
    def bridged(self) -> dict[tuple[float, str], float]:
        """Dropouts bridged in the last run: tape time in s and axis, and length in s."""
        return dict(islice(self.reader.bridged.items(), self._bridged))

    @property
    def duration_s(self) -> float:
        """Running time of the tape, s."""
        return self.frames / self.format.sample_rate_hz / self.setting.override

    def __iter__(self) -> Iterator[Motion]:
        """Play: the motion in blocks; raises TapeFault, LockFault, FollowingFault after its last sample."""
        fmt = self.format
        drives = Drives(
            len(fmt.axes),
            fmt.mm_per_cycle,
            self.rate_hz,
            self.settings,
            steps=self._steps,
            reference=ReferenceTrack(fmt.reference_hz / fmt.motion_rate_hz, self.setting.wheel),
        )
        drives.adjust(self._zero_mm)
        adjusted_edges = drives.cell_edges
        drives.conditions = self.conditions
        rest_mm = self.start_mm - self._zero_mm  # where the screws stood before that
        monitor, self.end_error_mm = self.supervise(fmt.axes, self.rate_hz), None
        for read in self._read():
            phases = read.rows
            self.notes = self.reader.notes
            found = read.first_fault(fmt.motion_rate_hz, self.end_mm.tolist())
            sound = len(phases) if found is None else min(found.row, len(phases))
            zero_cycles = self._zero_mm * fmt.cycles_per_mm - read.bearings.zero_cycles
            monitor.rows_seen = phases.first_row
            places_mm, demands_mm = drives.run(phases.cycles[:sound], zero_cycles, rest_mm)
            self.cell_edges = drives.cell_edges - adjusted_edges
            rows = monitor.watch(demands_mm, places_mm)
            if rows:
                self._rows, self.end_mm = phases.first_row + rows, places_mm[rows - 1]
                yield self._motion(places_mm[:rows], phases.first_row)
            if rows < len(places_mm):
                raise monitor.warnings[-1]
            if rows < sound:
                raise self._out_of_range(drives, phases.first_row + rows)
            if found is not None:
                raise found.fault
        self._check_end()

    def _read(self) -> Iterator[ReadRows]:
        """What the reader gives, read ahead if it may be."""
        ahead = ReadAhead[tuple[ReadRows, int]]()

        def stands_mm() -> Sequence[float]:
            if self.reads_ahead:
                ahead.wait_for_use()
            return self.end_mm.tolist()

        def made() -> Iterator[tuple[ReadRows, int]]:
            for read in self.reader.read(stands_mm, ahead=self.reads_ahead):
                yield read, len(self.reader.bridged)

        try:
            for read, bridged in ahead.blocks(made) if self.reads_ahead else made():
                self._bridged = bridged
                yield read
        except Fault:  # of the tape: a fault of the drives does not come by here
            self._bridged = None
            raise
        self._bridged = None

    def _motion(self, places_mm: Array, first_row: int) -> Motion:
        """A block of positions: X, Y, Z and further axes of the tape; an axis without a track stands at 0."""
        rate_hz, names = self.rate_hz, self.format.axes
        if tuple(names[: len(AXES)]) == AXES:
            return Motion(places_mm, rate_hz, first_row / rate_hz, names)
        columns = [*AXES, *(name for name in names if name not in AXES)]
        positions_mm = np.zeros((len(places_mm), len(columns)))
        positions_mm[:, [columns.index(name) for name in names]] = places_mm
        return Motion(positions_mm, rate_hz, first_row / rate_hz, tuple(columns))

    def _out_of_range(self, drives: Drives, row: int) -> LockFault:
        """The fault of fault circuit 162: a drive that could not follow."""
        error_mm = drives.error_mm
        axis = int(np.argmax(np.where(np.isnan(error_mm), np.inf, np.abs(error_mm))))
        stood = self._stood(axis, row / self.rate_hz, float(error_mm[axis]))
        return out_of_range(stood, self.setting)

    def _check_end(self) -> None:
        """Compare the machine's end with the tape's; raises LockFault beyond a quarter of a cycle."""
        fmt = self.format
        if fmt.end_mm is None:
            return
        self.end_error_mm = self.end_mm - np.array(fmt.end_mm) - self._zero_mm
        axis = int(np.argmax(np.abs(self.end_error_mm)))
        error_mm = float(self.end_error_mm[axis])
        if abs(error_mm) * fmt.cycles_per_mm > SURE_CYCLES:
            time_s = self._rows / fmt.motion_rate_hz
            raise ended_elsewhere(self._stood(axis, time_s, error_mm), fmt)

    def _stood(self, axis: int, time_s: float, error_mm: float) -> Stood:
        """Where the machine stands on an axis that is off."""
        error_cycles, position_mm = (
            error_mm * self.format.cycles_per_mm,
            float(self.end_mm[axis]),
        )
        return Stood(self.format.axes[axis], time_s, error_cycles, position_mm)
