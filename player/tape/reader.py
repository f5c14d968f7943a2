"""The reader: all that stands between a tape and the drives, read through from its start or from a place on
it.

    tape ─┬► discriminator ──► levels evened ──► gaps bridged ──► warrant ──► watch ──► certain rows, a fault
          │       └── first block ──► bearings: zero, levels, reference      │
          └► check signal, where there is one ───────────────────────────────┘

Signals in: the tape's frames in blocks. Signals out: rows of phases at the motion rate, the bearings they
count from, and the row of the block from which nothing is certain, with its fault. One block of tape is held
at a time.

Source: patent ES 361967, figure 5 (from the reading heads to the comparators).
Questions: the patent's machine starts where the tape does; here a run may also begin at a later tape time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import Fault, TapeFault
from morfax.player.tape.bare import BareTape
from morfax.player.tape.check_reader import read_ahead, read_check
from morfax.player.tape.discriminator import Discriminator, Phases, discriminate
from morfax.player.tape.dropouts import Bridge, Gaps, under_way
from morfax.player.tape.standstill import STANDSTILL_S, Bearings, evened, take_bearings
from morfax.player.tape.vouching import Vouching
from morfax.player.tape.watch import Watch, demand_apart
from morfax.recorder.tape.tape import Stored, Tape, TapeFormat, full_scale

BLOCK_FRAMES = 65536  # 1.4 s at 48 kHz, a megabyte of four tracks


Read = tuple[Phases, Bearings, tuple[int, Fault] | None]


class TapeReader:
    """Reads one tape, as often as wanted.

    Of the last time through: `bridged`, the dropouts that were ridden over (tape time in s, axis: length in
    s). With `told`, whole cycles to add at dropouts (row, axis), none is too uncertain to be ridden over;
    those that would have been are then in `doubtful`.
    """

    def __init__(
        self,
        open_tape: Callable[[], AbstractContextManager[Tape]],
        fmt: TapeFormat,
        start_mm: Array,
        acceleration_mm_s2: float,
        resume_at_s: float = 0.0,
    ) -> None:
        self._open_tape, self._format, self._start_mm = open_tape, fmt, start_mm
        self._acceleration_mm_s2, self._resume_at_s = acceleration_mm_s2, resume_at_s
        self.bridged: dict[tuple[float, str], float] = {}
        self.told: dict[tuple[int, int], int] | None = None
        self.doubtful: dict[tuple[int, int], Bridge] = {}
        self.is_checked = False  # whether the tape has a check signal
        # whether a count that differs from what a track says is a fault; mending counts anew
        self.trusts_counts = True

    def read(self, stands_mm: Callable[[], Sequence[float]]) -> Iterator[Read]:
        """Rows, bearings, and the first uncertain row of a block; `stands_mm`: the machine's place.

        Raises TapeFault where the tape is none, or its reference is on another track.
        """
        fmt, rate_hz = self._format, self._format.motion_rate_hz
        discriminator = Discriminator(
            fmt.sample_rate_hz, fmt.reference_hz, fmt.samples_per_motion, fmt.tracks
        )
        first_row = round(self._resume_at_s * rate_hz)
        # rows that the filter needs
        lead = min(first_row, discriminator.filter_frames // fmt.samples_per_motion)
        with self._open_tape() as tape:
            # 1. the first blocks tell whether the tape has a check signal
            blocks = tape.stored_blocks(
                BLOCK_FRAMES, (first_row - lead) * fmt.samples_per_motion
            )
            ahead = read_ahead(blocks, fmt)
            warrant = self._warrant(ahead, first_row - lead)
            held: list[Stored] = []
            rows = (
                evened(rows.moved(first_row - lead), fmt)
                for rows in discriminate(_noted(ahead, blocks, warrant, held), discriminator)
            )
            # 2. the first rows tell where the axes stand
            start = next(rows, None)
            if start is None:
                raise _too_short(tape.frames, discriminator.filter_frames)
            start = start.cut(lead if first_row else 0, len(start))
            still = warrant.begin(start)
            bearings = self._bearings(full_scale(held[-1]), start, still, discriminator)
            warrant.zero_cycles = None if first_row else bearings.zero_cycles
            gaps, watch = self._gaps(discriminator, bearings), Watch(fmt, bearings)
            # a check signal says which track is which, and how late
            watch.takes_skew = not warrant.is_checked
            watched = not (first_row or warrant.is_checked)
            # 3. row by row, to the end
            for phases in chain([start], rows):
                out, fault = warrant.feed(*gaps.feed(phases), stands_mm)
                time_s = self._time_s(phases)
                wrong = watch.wrong_reference(held[-1], time_s) if watched else None
                if wrong is not None:
                    raise wrong
                yield out, bearings, watch.first_fault(out, stands_mm()) or fault
            rest = gaps.feed(phases.cut(len(phases), len(phases)), last=True)
            out, fault = warrant.feed(*rest, stands_mm, last=True)
            yield out, bearings, fault
            if first_row:
                return  # what was before is not known
            doubt = watch.doubtful_reference(self._time_s(phases)) if watched else None
            if doubt is not None:
                raise doubt
            warrant.end(self._time_s(phases))

    def _warrant(self, ahead: list[Stored], first_row: int) -> Vouching | BareTape:
        """What vouches for the rows of this tape: its check signal, or what can be found out without."""
        check = read_check(ahead, self._format, first_row)
        self.is_checked = check is not None
        if check is None:
            return BareTape(self._format, self._start_mm)
        return Vouching(self._format, check, trusts_counts=self.trusts_counts)

    def _bearings(
        self,
        first: NDArray[np.float32],
        start: Phases,
        still: Phases,
        discriminator: Discriminator,
    ) -> Bearings:
        """The bearings from the first block; on a resumed tape the zero is the machine's stated place.

        `still`: the first rows without the delays of their tracks.
        """
        fmt = self._format
        if self._resume_at_s:
            places = under_way(start, discriminator)
            return replace(take_bearings(first, start, fmt), zero_cycles=places)
        bearings = take_bearings(first, still, fmt)
        demand_apart(
            first[: round(STANDSTILL_S * fmt.sample_rate_hz)], bearings.levels, fmt.axes
        )
        return bearings

    def _gaps(self, discriminator: Discriminator, bearings: Bearings) -> Gaps:
        """The bridge builder for the dropouts of this tape."""
        fmt, start_mm = self._format, self._start_mm

        def place_mm(axis: int, cycles: float) -> float:
            return float(
                start_mm[axis] + (cycles - bearings.zero_cycles[axis]) * fmt.mm_per_cycle
            )

        most = self._acceleration_mm_s2 * fmt.cycles_per_mm / fmt.motion_rate_hz**2
        gaps = Gaps(
            discriminator,
            bearings.levels,
            fmt.motion_rate_hz,
            most,
            place_mm,
            fmt.axes,
            self.told,
        )
        self.bridged, self.doubtful = gaps.bridged, gaps.doubtful
        return gaps

    def _time_s(self, phases: Phases) -> float:
        """Tape time after some rows, s."""
        return (phases.first_row + len(phases)) / self._format.motion_rate_hz


def _noted(
    ahead: list[Stored],
    blocks: Iterator[Stored],
    warrant: Vouching | BareTape,
    held: list[Stored],
) -> Iterator[Stored]:
    """All blocks of the tape; the last one is held, and the check signal is read from those not yet read."""
    for block in ahead or [np.zeros((0, 1), np.float32)]:
        held[:] = [block]
        yield block
    for block in blocks:
        warrant.hear(block)
        held[:] = [block]
        yield block


def _too_short(frames: int, filter_frames: int) -> TapeFault:
    """The fault of a tape without enough frames for a single row."""
    return TapeFault(
        f"the tape ends after {frames} frames; it must be longer than the discriminator's filter, "
        f"{filter_frames} frames; record it again"
    )
