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

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import AbstractContextManager, closing
from dataclasses import replace
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import TapeFault
from morfax.player.tape.ahead import ReadAhead
from morfax.player.tape.bare import BareTape
from morfax.player.tape.bridges import Bound, Bridge
from morfax.player.tape.calm_frames import Heard
from morfax.player.tape.check_reader import CheckReader, read_ahead, read_check
from morfax.player.tape.discriminator import Discriminator, discriminate
from morfax.player.tape.dropouts import Gaps, under_way
from morfax.player.tape.lost_ways import Laid
from morfax.player.tape.phases import Phases, Uncertain
from morfax.player.tape.riding import Riding
from morfax.player.tape.standstill import STANDSTILL_S, Bearings, evened, take_bearings
from morfax.player.tape.steadiest import Steadiest
from morfax.player.tape.vouching import Vouching
from morfax.player.tape.warrant import Certain, Warrant
from morfax.player.tape.watch import Watch, demand_apart
from morfax.recorder.sound.source import BLOCK_FRAMES
from morfax.recorder.tape.tape import Stored, Tape, TapeFormat, full_scale

Listened = tuple[Stored, list[Heard]]


class ReadRows(NamedTuple):
    """Rows, the bearings they count from, what watches them (None: nothing), and the fault behind them.

    Who reads ahead leaves it to the machine's side to look at the rows: both have about as much to do then.
    """

    rows: Phases
    bearings: Bearings
    watch: Watch | None
    ended: Uncertain | None

    def first_fault(self, rate_hz: float, stands_mm: list[float]) -> Uncertain | None:
        """The first row that is not certain, with its fault; the machine stands at `stands_mm`."""
        found = self.bearings.first_fault(self.rows, rate_hz, stands_mm)
        if found is None and self.watch is not None:
            found = self.watch.first_fault(self.rows, lambda: stands_mm)
        return found or self.ended


class _Run(NamedTuple):
    """What keeps watch over one time through a tape."""

    warrant: Warrant
    bearings: Bearings
    gaps: Gaps
    watch: Watch
    steadiest: Steadiest


class TapeReader:
    """Reads one tape, as often as wanted.

    Of the last time through: `bridged`, the dropouts that were ridden over (tape time in s, axis: length in
    s). With `told`, whole cycles to add at dropouts (row, axis) of a bare tape, none is too uncertain to be
    ridden over; those that would have been are then in `doubtful`. If it `mends`, those of a checked tape are
    laid anew, and are in `mended` with the whole cycles put back. `begun`: the reader of the check signal, as
    it is behind the first blocks of the tape, if somebody has read them already; it is used once.
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
        self.begun: CheckReader | None = None
        self.is_checked = False  # whether the tape has a check signal
        self.notes: tuple[str, ...] = ()  # known when the first rows are read
        self.mends = (
            False  # whether the way of dropouts is laid anew, where counts behind them tell it
        )
        self.mended: list[Laid] = []

    def read(
        self, stands_mm: Callable[[], Sequence[float]], *, ahead: bool = False
    ) -> Iterator[ReadRows]:
        """Rows, bearings, and the first uncertain row of a block; `stands_mm`: the machine's place.

        With `ahead` the check signal is read in a thread of its own. Raises TapeFault where the tape is none,
        or its reference is on another track.
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
            begun = read_ahead(blocks, fmt)
            warrant = self._warrant(begun, first_row - lead)
            held: list[Stored] = []
            with closing(_listened(blocks, warrant, ahead=ahead)) as listened:
                noted = _noted(begun, listened, warrant, held)
                rows = (
                    evened(rows.moved(first_row - lead), fmt)
                    for rows in discriminate(noted, discriminator)
                )
                # 2. the first rows tell where the axes stand
                start = next(rows, None)
                if start is None:
                    raise _too_short(tape.frames, discriminator.filter_frames)
                start = start.cut(lead if first_row else 0, len(start))
                run = self._run(warrant, start, full_scale(held[-1]), discriminator)
                self.notes = (*tape.notes, *warrant.notes)
                # 3. row by row, to the end
                yield from self._through(chain([start], rows), run, held, stands_mm)

    def _run(
        self,
        warrant: Warrant,
        start: Phases,
        first: NDArray[np.float32],
        discriminator: Discriminator,
    ) -> _Run:
        """What keeps watch over this time through the tape, as its first rows and frames tell."""
        begun = warrant.begin(start)
        bearings = self._bearings(first, start, begun, discriminator)
        fmt, start_mm = self._format, self._start_mm

        def place_mm(axis: int, cycles: float) -> float:
            travel = cycles - bearings.zero_cycles[axis]
            return float(start_mm[axis] + travel * fmt.mm_per_cycle)

        warrant.bear(None if self._resume_at_s else bearings.zero_cycles, place_mm)
        riding = self._riding(warrant)
        gaps = Gaps(discriminator, bearings.levels, fmt, riding, place_mm)
        self.bridged, self.doubtful = gaps.bridged, gaps.doubtful
        watch = Watch(fmt, bearings)
        # a check signal says which track is which, and how late
        watch.takes_skew = not warrant.is_checked
        steadiest = Steadiest(fmt, bearings.reference_hz)
        return _Run(warrant, bearings, gaps, watch, steadiest)

    def _through(
        self,
        rows: Iterator[Phases],
        run: _Run,
        held: list[Stored],
        stands_mm: Callable[[], Sequence[float]],
    ) -> Iterator[ReadRows]:
        """All rows of the tape through its gaps, its warrant and the watch; `held`: the last block of it."""
        warrant, bearings, gaps, watch, steadiest = run
        watched = not (self._resume_at_s or warrant.is_checked)
        for phases in rows:
            out, fault = warrant.feed(_certain(gaps, phases), stands_mm)
            time_s = self._time_s(phases)
            wrong = steadiest.wrong(held[-1], time_s) if watched else None
            if wrong is not None:
                raise wrong
            yield ReadRows(out, bearings, watch, fault)
        rest = _certain(gaps, phases.cut(len(phases), len(phases)), last=True)
        out, fault = warrant.feed(rest, stands_mm, last=True)
        yield ReadRows(out, bearings, None, fault)
        if self._resume_at_s:
            return  # what was before is not known
        doubt = steadiest.doubtful(time_s) if watched else None
        if doubt is not None:
            raise doubt
        warrant.end(time_s)

    def _warrant(self, ahead: list[Stored], first_row: int) -> Warrant:
        """What vouches for the rows of this tape: its check signal, or what can be found out without."""
        check = self.begun or read_check(ahead, self._format, first_row)
        self.begun = None
        self.is_checked = check is not None
        if check is None:
            return BareTape(self._format, self._start_mm)
        vouching = Vouching(self._format, check, mends=self.mends)
        self.mended = vouching.mended
        return vouching

    def _riding(self, warrant: Warrant) -> Riding:
        """How the dropouts of this tape are ridden over."""
        fmt, rate_hz = self._format, self._format.motion_rate_hz
        motors = Bound(
            self._acceleration_mm_s2 * fmt.cycles_per_mm / rate_hz**2,
            fmt.largest_deviation_hz / rate_hz,
        )
        return Riding(motors, warrant.bounds if warrant.is_checked else None, self.told)

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

    def _time_s(self, phases: Phases) -> float:
        """Tape time after some rows, s."""
        return (phases.first_row + len(phases)) / self._format.motion_rate_hz


def _certain(gaps: Gaps, phases: Phases, *, last: bool = False) -> Certain:
    """The rows that the dropouts leave certain, and the gaps bridged in them."""
    rows, fault = gaps.feed(phases, last=last)
    return Certain(rows, fault, gaps.found())


def _listened(
    blocks: Iterator[Stored], warrant: Warrant, *, ahead: bool
) -> Generator[Listened, None, None]:
    """Blocks of the tape, and what its check signal says by each of them."""

    def listened() -> Generator[Listened, None, None]:
        for block in blocks:
            yield block, warrant.listen(block)

    return (
        ReadAhead[Listened]().blocks(listened) if ahead and warrant.is_checked else listened()
    )


def _noted(
    begun: list[Stored],
    listened: Iterator[Listened],
    warrant: Warrant,
    held: list[Stored],
) -> Iterator[Stored]:
    """All blocks of the tape, those first that it began with; the last one is held."""
    for block in begun or [np.zeros((0, 1), np.float32)]:
        held[:] = [block]
        yield block
    for block, reports in listened:
        warrant.hear(reports)
        held[:] = [block]
        yield block


def _too_short(frames: int, filter_frames: int) -> TapeFault:
    """The fault of a tape without enough frames for a single row."""
    return TapeFault(
        f"the tape ends after {frames} frames; it must be longer than the discriminator's filter, "
        f"{filter_frames} frames; record it again"
    )
