"""The reader: all that stands between a tape and the drives, read through from its start or from a place on
it.

    tape ──► discriminator ──► levels evened ──► gaps bridged ──► watch ──► rows that are certain, or a fault
                  └── first block ──► bearings: zero, levels, reference

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
from morfax.player.tape.bare import demand_own_motion
from morfax.player.tape.discriminator import Discriminator, Phases, discriminate
from morfax.player.tape.dropouts import Bridge, Gaps, under_way
from morfax.player.tape.standstill import STANDSTILL_S, Bearings, evened, take_bearings
from morfax.player.tape.watch import Watch, demand_apart
from morfax.recorder.tape.own_motion import OwnMotion
from morfax.recorder.tape.pipe import Pipe
from morfax.recorder.tape.tape import Stored, Tape, TapeFormat, full_scale

BLOCK_FRAMES = 65536  # 1.4 s at 48 kHz, a megabyte of four tracks


Read = tuple[Phases, Bearings, tuple[int, Fault] | None]


class Reader:
    """Reads one tape, as often as wanted.

    Of the last time through: `bridged`, the dropouts that were ridden over (tape time in s, axis: length in
    s). With `told`, whole cycles to add at dropouts (row, axis), none is too uncertain to be ridden over;
    those that would have been are then in `doubtful`.
    """

    def __init__(
        self,
        open_tape: Callable[[], AbstractContextManager[Tape | Pipe]],
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

    def read(self, stands_mm: Callable[[], Sequence[float]]) -> Iterator[Read]:
        """Rows, bearings, and the first uncertain row of a block; `stands_mm`: the machine's place.

        Raises TapeFault where the tape is none, or its reference is on another track.
        """
        fmt, rate_hz = self._format, self._format.motion_rate_hz
        discriminator = Discriminator(
            fmt.sample_rate_hz, fmt.reference_hz, fmt.samples_per_motion, fmt.tracks
        )
        first_row = round(self._resume_at_s * rate_hz)
        with self._open_tape() as tape:
            # rows that the filter needs
            lead = min(first_row, discriminator.filter_frames // fmt.samples_per_motion)
            blocks = iter(
                tape.stored_blocks(BLOCK_FRAMES, (first_row - lead) * fmt.samples_per_motion)
            )
            first = next(blocks, np.zeros((0, fmt.tracks), np.float32))
            held = [first]

            def noted() -> Iterator[Stored]:
                for block in chain([held[0]], blocks):
                    held[0] = block
                    yield block

            rows = (
                evened(rows.moved(first_row - lead), fmt)
                for rows in discriminate(noted(), discriminator)
            )
            start = next(rows, None)
            if start is None:
                raise _too_short(tape.frames, discriminator.filter_frames)
            start = start.cut(lead if first_row else 0, len(start))
            bearings = self._bearings(full_scale(first), start, discriminator)
            gaps, watch = self._gaps(discriminator, bearings), Watch(fmt, bearings)
            own = OwnMotion(len(fmt.axes))
            for phases in chain([start], rows):
                out, fault = gaps.feed(phases)
                own.feed(out.cycles)
                wrong = (
                    None if first_row else watch.wrong_reference(held[0], self._time_s(phases))
                )
                if wrong is not None:
                    raise wrong
                yield out, bearings, watch.first_fault(out, stands_mm()) or fault
            out, fault = gaps.feed(phases.cut(len(phases), len(phases)), last=True)
            yield out, bearings, fault
            if first_row:
                return  # what was before is not known
            own.feed(out.cycles)
            ended_s = self._time_s(phases)
            doubt = watch.doubtful_reference(ended_s)
            if doubt is not None:
                raise doubt
            demand_own_motion(own, fmt, self._start_mm.tolist(), ended_s)

    def _bearings(
        self, first: NDArray[np.float32], start: Phases, discriminator: Discriminator
    ) -> Bearings:
        """The bearings from the first block; on a resumed tape the zero is the machine's stated place."""
        fmt = self._format
        if self._resume_at_s:
            places = under_way(start, discriminator)
            return replace(take_bearings(first, start, fmt), zero_cycles=places)
        bearings = take_bearings(first, start, fmt)
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


def _too_short(frames: int, filter_frames: int) -> TapeFault:
    """The fault of a tape without enough frames for a single row."""
    return TapeFault(
        f"the tape ends after {frames} frames; it must be longer than the discriminator's filter, "
        f"{filter_frames} frames; record it again"
    )
