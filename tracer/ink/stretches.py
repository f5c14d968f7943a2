"""Felt stretches of a sheet: its graph, what the cells felt along every stretch, and how wide each line is.

Signals: the patches of a sheet in; stations along each stretch of its ink out (see `felt`).

The sheet is seen through an aperture for each pen, and each of these pictures is made once:

    ink │     ▂█▅                stretches by their width: those about the commonest are one pen's, then those
        │    ▁███▁      ▁▃▁      about the commonest of what is left; ink broader than any pen, which lines
        └──────────────────      share, has one aperture, too; a stretch of rare width is seen through the
           0.4 mm      0.9 mm    aperture that is nearest to its own

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median, weighted_median
from morfax.motion.plane import unit
from morfax.motion.polyline import length_mm
from morfax.tracer.drawing.components import Mask
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import ONE_PEN, Window
from morfax.tracer.following.plain_places import FAINTEST, aperture_for
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.beside import Beside, lines_beside
from morfax.tracer.ink.doubled import BROADER, LEAST_PX, LEAST_WIDTHS, SHARED, Doubled
from morfax.tracer.ink.felt import (
    Ends,
    Parted,
    feel_along,
    is_steady,
    judged,
    whole,
)
from morfax.tracer.ink.graph import RING, Graph
from morfax.tracer.ink.run import Run
from morfax.tracer.ink.straight_on import SHORT_WIDTHS, Measured, StraightOn, of_two_lines
from morfax.tracer.ink.swelling import Swelling, narrow_of
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.photocell import LEVEL
from morfax.tracer.sensing.view import View

# All limits below were chosen by trial on drawings of nets.
APERTURES_MM = 0.02  # apertures are whole steps of this
PENS_SHARE = 0.1  # of the ink is drawn by a pen that is worth an aperture of its own
# a short one, with those into which it goes straight on, is long enough to tell its width
ENOUGH_WIDTHS = 6.0
# two lines with a slit between are darker so far beside their middle, of their ink's width, by so much
SLIT, LIGHTER = 0.25, 1.1
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
    beside: dict[int, list[Beside]] = field(default_factory=dict)
    together: set[int] = field(
        default_factory=set
    )  # stretches that have turned out to be two lines
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
        shared_mm = SHARED * doubled.pen_mm
        own = [n for n, run in enumerate(clean) if median(run.widths_mm) < shared_mm]
        if not own:
            return clean, parted
        return clean[own[0] : own[-1] + 1], parted[own[0] : own[-1]]

    def is_shared(self, number: int) -> bool:
        """Whether the ink along a stretch is that of two lines, each as wide as its line is taken to be."""
        measured = self.measured[number]
        if number in self.together or measured.known < HALF:
            return True
        return measured.width_mm > SHARED * self.widths_mm[number]

    def is_broad(self, number: int) -> bool:
        """Whether a stretch is broader than the pen of a clean sheet; of another sheet that is not known."""
        doubled = self.doubled
        return doubled.is_sure and self.measured[number].width_mm > BROADER * doubled.pen_mm

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
        felt = _felt(graph, drawing, settings, window)
        measured, at = [Measured.of(run) for run in felt], graph.at_nodes()
        straight = StraightOn(graph, felt, at)
        widths = _line_widths(straight, measured, settings)
        ends = [(_is_end(s.nodes[0], at), _is_end(s.nodes[1], at)) for s in graph.stretches]
        doubled, some = Doubled(), _no_letters(graph, letters)
        beside = dict[int, list[Beside]]()
        if not settings.line_width_mm and not drawing.grainy:
            patch, pixel_mm = graph.patches(), drawing.pitch_mm * drawing.finer
            narrowest_mm = LEAST_PX[drawing.is_hard] * pixel_mm
            swell = {n: s for n in some if (s := Swelling.of(felt[n], ends[n])) is not None}
            patch_of = {n: int(patch[n]) for n in some}
            doubled = Doubled.of(felt, swell, patch_of, narrowest_mm)
            pen_mm = narrow_of(list(swell.values()))
            some_beside = swell if are_strokes else {}
            beside = {
                n: lines
                for n in some_beside
                if (lines := lines_beside(felt[n], pen_mm, ends[n]))
            }
        if doubled.is_sure and math.isfinite(doubled.pen_mm):
            for n in set(some).intersection(of_two_lines(straight, measured, doubled.pen_mm)):
                widths[n] = doubled.pen_mm
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


class _Seen:
    """The sheet through its cells, made once for each aperture of some."""

    def __init__(self, drawing: Drawing, apertures_mm: Array, window: Window | None) -> None:
        self._parted, self._grainy = drawing.finer, drawing.grainy
        self._cells = {
            mm: photocell.behind_aperture(drawing, mm, window=window)
            for mm in np.unique(apertures_mm).tolist()
        }

    def view(self, guide_mm: Array, width_mm: float, aperture_mm: float) -> View:
        """How the head sees a line along a guide."""
        cells = self._cells[aperture_mm]
        view = View(cells, width_mm, parted=self._parted, grainy=self._grainy)
        some = guide_mm[:: max(1, len(guide_mm) // 50)]
        dark = median(view.darkness_along(some))
        if length_mm(guide_mm) > LEAST_WIDTHS * width_mm:
            beside = _beside(some, SLIT * width_mm)
            lines = min(median(view.darkness_along(places)) for places in beside)
            dark = lines if lines > LIGHTER * dark else dark
        return view.at_level(LEVEL * max(dark, FAINTEST))


def _felt(
    graph: Graph, drawing: Drawing, settings: Settings, window: Window | None
) -> list[Run]:
    """What the cells feel along every stretch."""
    places, pitch_mm = graph.places_mm(drawing), drawing.pitch_mm
    halves_px = [
        max(median(graph.depths_px[stretch.pixels]) - 0.5, 0.5) for stretch in graph.stretches
    ]
    widths_mm = [2 * half_px * pitch_mm for half_px in halves_px]
    own_mm = np.array([settings.aperture_mm or aperture_for(drawing, mm) for mm in widths_mm])
    apertures_mm = _few(own_mm, [len(stretch.pixels) for stretch in graph.stretches])
    seen, felt = _Seen(drawing, apertures_mm, window), list[Run]()
    for n, stretch in enumerate(graph.stretches):
        guide = _softened(places[stretch.pixels], round(2 * halves_px[n]))
        felt.append(feel_along(seen.view(guide, widths_mm[n], float(apertures_mm[n])), guide))
    return felt


def _few(own_mm: Array, pixels: Sequence[int]) -> Array:
    """The aperture of each stretch, mm: that of its pen, the one for broad ink, or the nearest to its own."""
    if not len(own_mm):
        return own_mm
    # 1. each pen's: the commonest of what is left, and all about it
    steps, inked = np.round(own_mm / APERTURES_MM), np.asarray(pixels, float)
    least, made, left = PENS_SHARE * inked.sum(), list[float](), np.ones(len(steps), bool)
    while not made or inked[left].sum() > least:
        common = float(np.argmax(np.bincount(steps[left].astype(int), inked[left])))
        pen = left & (np.abs(steps - common) < ONE_PEN * max(common, 1.0))
        if made and inked[pen].sum() < least:
            break
        made.append(common)
        left &= ~pen
    # 2. broad ink, which lines share: a small cell feels each pixel of its rims
    if (steps > (1 + ONE_PEN) * max(made)).any():
        made.append(float(steps.max()))
    nearest = np.argmin(np.abs(steps[:, None] - np.array(made)), axis=1)
    return np.asarray(APERTURES_MM * np.array(made)[nearest])


def _softened(places: Array, reach: int) -> Array:
    """Places each averaged with as many before as behind it, fewer near the ends, which stay."""
    count = len(places)
    at = np.arange(count)
    reaches = np.minimum(np.minimum(at, count - 1 - at), reach)
    sums = np.vstack([np.zeros(2), np.cumsum(places, axis=0)])
    return np.asarray(
        (sums[at + reaches + 1] - sums[at - reaches]) / (2 * reaches + 1)[:, None]
    )


def _beside(places: Array, aside_mm: float) -> tuple[Array, Array]:
    """Places (n, 2) mm so far to the left and to the right of others along a line."""
    if len(places) < 2:
        return places, places
    ways = np.gradient(places, axis=0)
    normals = np.column_stack([-ways[:, 1], ways[:, 0]])
    aside = aside_mm * unit(normals)
    return places + aside, places - aside


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
