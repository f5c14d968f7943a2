"""Felt stretches of a sheet: its graph, what the cells felt along every stretch, and how wide each line is.

Signals: the patches of a sheet in; stations along each stretch of its ink out (see `felt`).

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median, weighted_median
from morfax.tracer.drawing.broad import SHORT_WIDTHS
from morfax.tracer.drawing.components import Mask
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Window
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.apertures import feel_all
from morfax.tracer.ink.beside import StretchLine, lines_beside
from morfax.tracer.ink.doubled import BROADER, Doubled, SureWidths
from morfax.tracer.ink.felt import (
    Ends,
    Parted,
    is_steady,
    judged,
    whole,
)
from morfax.tracer.ink.graph import RING, Graph
from morfax.tracer.ink.run import Run
from morfax.tracer.ink.straight_on import Measured, StraightOn, of_two_lines
from morfax.tracer.ink.swelling import Swelling, narrow_of
from morfax.tracer.limits import WIDER

# All limits below were chosen by trial on drawings of nets.
# a short one, with those into which it goes straight on, is long enough to tell its width
ENOUGH_WIDTHS = 6.0
HALF = 0.5  # of a stretch's stations


@dataclass(slots=True)
class Taken:
    """A stretch, if its line is taken to be of a width: its stations, clean runs, and what parts them."""

    stations: Run
    clean: list[Run]
    _parted: list[Array]
    _whole: Run | None = None

    @property
    def clean_mm(self) -> float:
        """The length of its clean runs."""
        return sum(run.length_mm for run in self.clean)

    @property
    def parted(self) -> Parted:
        """Its clean runs, or all of it as one where it is clean nowhere; and what was felt between them."""
        if self.clean:
            return list(self.clean), list(self._parted)
        self._whole = self._whole or whole(self.stations)
        return [self._whole], []


@dataclass(frozen=True, slots=True)
class FeltSheet:
    """The stretches of a sheet as they were felt: what nets are made of."""

    graph: Graph
    felt: list[Run]
    measured: list[Measured]
    widths_mm: list[float]
    settings: Settings
    ends: list[Ends]  # of each stretch, whether the ink ends there
    doubled: Doubled = field(default_factory=Doubled)
    # the lines of each stretch in part of which two run beside each other
    beside: dict[int, list[StretchLine]] = field(default_factory=dict)
    # stretches that have turned out to be two lines
    together: set[int] = field(default_factory=set)
    _taken: dict[tuple[int, float], Taken] = field(default_factory=dict)

    def taken(self, number: int) -> Taken:
        """A stretch, if its line is as wide as it is taken to be; that is asked once for each width."""
        key = number, self.widths_mm[number]
        if key not in self._taken:
            stations = with_width(self.felt[number], key[1])
            # on a clean sheet ink that tapers is two lines', and no rough one's
            is_smooth = self.doubled.is_sure and math.isfinite(self.doubled.pen_mm)
            felt = judged(stations, key[1], is_smooth=is_smooth)
            clean, parted = felt.runs(self.ends[number])
            self._taken[key] = Taken(stations, *self._of_one_line(number, clean, parted))
        return self._taken[key]

    def _of_one_line(self, number: int, clean: list[Run], parted: list[Array]) -> Parted:
        """Clean runs without those that two lines share of which one ends on the way."""
        doubled = self.doubled
        is_whole = number in doubled.throughout(self.felt)
        if not doubled.is_sure or number not in doubled.stations or is_whole:
            return clean, parted
        shared_mm = WIDER * doubled.pen_mm
        own = [n for n, run in enumerate(clean) if median(run.widths_mm) < shared_mm]
        if not own:
            return clean, parted
        return clean[own[0] : own[-1] + 1], parted[own[0] : own[-1]]

    def is_shared(self, number: int) -> bool:
        """Whether the ink along a stretch is that of two lines, each as wide as its line is taken to be."""
        measured = self.measured[number]
        if number in self.together or measured.known < HALF:
            return True
        return measured.width_mm > WIDER * self.widths_mm[number]

    def is_broad(self, number: int) -> bool:
        """Whether a stretch is broader than the pen of a clean sheet; of another sheet that is not known."""
        doubled = self.doubled
        return doubled.is_sure and self.measured[number].width_mm > BROADER * doubled.pen_mm

    @property
    def shared_mm(self) -> Array:
        """Places (n, 2) along the stretches that are known to be two lines'."""
        doubled = self.doubled.stations if self.doubled.is_sure else ()
        some = (self.felt[n].places_mm for n in {*doubled, *self.together, *self.beside})
        return np.vstack([np.empty((0, 2)), *some])

    def without_cells(self) -> FeltSheet:
        """The stretches as they were felt, without what the cells saw: that is as large as the sheet."""
        felt = [replace(run, view=run.view.without_cells()) for run in self.felt]
        return replace(self, felt=felt, _taken={})

    @classmethod
    def of(
        cls,
        drawing: Drawing,
        settings: Settings,
        ink: Mask,
        letters: Mask | None = None,
        window: Window | None = None,
        *,
        are_strokes: bool = False,
    ) -> FeltSheet:
        """Find and feel the stretches of some ink, of which some is letters, in a window of the sheet.

        Strokes end where the pen was lifted beside another line; contours go on into that line.
        """
        graph = Graph.of(ink, *window[:2]) if window else Graph.of(ink)
        felt = feel_all(graph, drawing, settings, window)
        measured, at = [Measured.of(run) for run in felt], graph.at_nodes()
        straight = StraightOn(graph, felt, at)
        widths = _line_widths(straight, measured, settings)
        ends = [(_is_end(s.nodes[0], at), _is_end(s.nodes[1], at)) for s in graph.stretches]
        doubled, some = Doubled(), _no_letters(graph, letters)
        beside = dict[int, list[StretchLine]]()
        if not settings.line_width_mm and not drawing.grainy:
            patch, sure = graph.patches(), SureWidths.of(drawing)
            swell = {n: s for n in some if (s := Swelling.of(felt[n], ends[n])) is not None}
            patch_of = {n: int(patch[n]) for n in some}
            doubled = Doubled.of(felt, swell, patch_of, straight.onward, sure)
            pen_mm = narrow_of(list(swell.values()))
            beside = {
                n: lines
                for n in (swell if are_strokes else ())
                if (lines := lines_beside(felt[n], pen_mm, ends[n]))
            }
        if doubled.is_sure and math.isfinite(doubled.pen_mm):
            second = {n for n in some if doubled.is_second(felt[n])}
            two = of_two_lines(straight, measured, doubled.pen_mm)
            for n in set(some).intersection(two) - second:
                widths[n] = doubled.pen_mm
            for n in second:
                widths[n] = measured[n].width_mm
        return cls(graph, felt, measured, widths, settings, ends, doubled, beside)


def _no_letters(graph: Graph, letters: Mask | None) -> list[int]:
    """The stretches, by their numbers, that are no letters."""
    every = range(len(graph.stretches))
    if letters is None:
        return list(every)
    middles = np.array([s.pixels[len(s.pixels) // 2] for s in graph.stretches], int)
    lettered = letters[graph.rows[middles], graph.columns[middles]]
    return [n for n in every if not lettered[n]]


def _is_end(node: int, at: dict[int, list[int]]) -> bool:
    """Whether a single stretch is at a node."""
    return len(at.get(node, ())) == 1


def with_width(run: Run, width_mm: float) -> Run:
    """A run as a head sees it that knows the line's width."""
    return replace(run, view=replace(run.view, width_mm=width_mm))


def _line_widths(
    straight: StraightOn, measured: list[Measured], settings: Settings
) -> list[float]:
    """The width of the line of each stretch, mm: its own, and of a short one that of those beside it."""
    graph, felt, at = straight.graph, straight.felt, straight.at
    lengths, own, known = zip(*measured, strict=True) if measured else ((), (), ())
    if settings.line_width_mm:
        return [settings.line_width_mm] * len(own)

    def of_some(some: Iterable[int]) -> float | None:
        """The width that most of some stretches have; a hair on which no cell felt two edges tells none."""
        telling = [m for m in some if known[m] > 0]
        return weighted_median([own[m] for m in telling], [lengths[m] for m in telling])

    found, usual_mm = list[float](), of_some(range(len(own)))
    for n, stretch in enumerate(graph.stretches):
        if (
            lengths[n] > SHORT_WIDTHS * own[n]
            or stretch.nodes[0] == RING
            or is_steady(felt[n], felt[n].view.width_mm)
        ):
            found.append(own[n])
            continue
        # its own width says nothing where two lines run together in it
        further = straight.through(n) - {n}
        if sum(lengths[m] for m in further) < ENOUGH_WIDTHS * own[n]:
            beside = {n, *(m for node in stretch.nodes for m in at[node])}
            further = {
                m for k in beside for node in graph.stretches[k].nodes for m in at.get(node, ())
            } - {n} or {n}
        found.append(of_some(further) or usual_mm or own[n])
    return found
