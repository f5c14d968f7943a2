"""Felt stretches of a sheet: its graph, what the cells felt along every stretch, and how wide each line is.

Signals: the patches of a sheet in; stations along each stretch of its ink out (see `felt`).

The sheet is seen through a few apertures, and each of these pictures is made once.

Source: our own.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import length_mm
from morfax.tracer.drawing.components import Mask
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.plain_places import FAINTEST, aperture_for
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.doubled import BROADER, SHARED, Doubled
from morfax.tracer.ink.felt import Ends, Parted, feel_along, is_steady, judged, usual_width_mm
from morfax.tracer.ink.graph import RING, Graph
from morfax.tracer.ink.run import Run
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.photocell import LEVEL, Cells
from morfax.tracer.sensing.view import View

# All limits below were chosen by trial on drawings of nets.
APERTURES_MM = 0.02  # cells of about one aperture are the same cells
SHORT_WIDTHS = 30.0  # a shorter stretch is judged by the widths of those beside it, too
# a short one, with those into which it goes straight on, is long enough to tell its width
ENOUGH_WIDTHS = 6.0
FAR = 6  # stretches straight on to either side
STRAIGHT_COS = 0.85  # 32 degrees
HALF = 0.5  # of a stretch's stations
AWAY_WIDTHS = 3.0  # from a node, over which a stretch shows where it leads


@dataclass(frozen=True, slots=True)
class FeltSheet:
    """The stretches of a sheet as they were felt: what nets are made of."""

    graph: Graph
    felt: list[Run]
    widths_mm: list[float]
    settings: Settings
    ends: list[Ends]  # of each stretch, whether the ink ends there
    doubled: Doubled = field(default_factory=Doubled)
    together: set[int] = field(
        default_factory=set
    )  # stretches that have turned out to be two lines
    _runs: dict[tuple[int, float], Parted] = field(default_factory=dict)

    def runs(self, number: int) -> Parted:
        """The clean runs of a stretch, if its line is as wide as it is taken to be."""
        key = number, self.widths_mm[number]
        if key not in self._runs:
            stations = with_width(self.felt[number], key[1])
            self._runs[key] = judged(stations, key[1]).runs(self.ends[number])
        runs, parted = self._runs[key]
        return list(runs), list(parted)

    def is_shared(self, number: int, run: Run) -> bool:
        """Whether the ink along a stretch is that of two lines, each as wide as a run's view says."""
        known = run.widths_mm[np.isfinite(run.widths_mm)]
        if number in self.together or len(known) < HALF * len(run):
            return True
        return float(np.median(known)) > SHARED * run.view.width_mm

    def is_broad(self, number: int) -> bool:
        """Whether a stretch is broader than the pen of a clean sheet; of another sheet that is not known."""
        return usual_width_mm(self.felt[number]) > BROADER * self.doubled.pen_mm

    @classmethod
    def of(cls, drawing: Drawing, settings: Settings, ink: Mask) -> FeltSheet:
        """Find and feel the stretches of some ink of a drawing."""
        seen = _Seen(drawing, settings)
        graph = Graph.of(ink)
        felt = _felt(graph, seen)
        at = graph.at_nodes()
        widths = _line_widths(graph, felt, at, settings)
        doubled = Doubled() if settings.line_width_mm else Doubled.of(felt)
        ends = [(_is_end(s.nodes[0], at), _is_end(s.nodes[1], at)) for s in graph.stretches]
        return cls(graph, felt, widths, settings, ends, doubled)


def _is_end(node: int, at: dict[int, list[int]]) -> bool:
    """Whether a single stretch is at a node."""
    return len(at.get(node, ())) == 1


@dataclass(slots=True)
class _Seen:
    """The sheet through its cells: those of an aperture are made once."""

    drawing: Drawing
    settings: Settings
    made: dict[float, Cells] = field(default_factory=dict)

    def view(self, guide_mm: Array, width_mm: float) -> View:
        """How the head sees a line along a guide."""
        spot_mm = self.settings.aperture_mm or aperture_for(self.drawing, width_mm)
        spot_mm = APERTURES_MM * round(spot_mm / APERTURES_MM)
        if spot_mm not in self.made:
            self.made[spot_mm] = photocell.behind_aperture(self.drawing, spot_mm)
        view = View(self.made[spot_mm], width_mm)
        some = guide_mm[:: max(1, len(guide_mm) // 50)]
        dark = float(np.median([view.darkness_at(place) for place in some]))
        return view.at_level(LEVEL * max(dark, FAINTEST))


def _felt(graph: Graph, seen: _Seen) -> list[Run]:
    """What the cells feel along every stretch."""
    drawing = seen.drawing
    places = graph.places_mm(drawing)
    felt = []
    for stretch in graph.stretches:
        half_px = max(float(np.median(graph.depths_px[stretch.pixels])) - 0.5, 0.5)
        width_mm = 2 * half_px * drawing.pitch_mm
        guide = _softened(places[stretch.pixels], round(2 * half_px))
        felt.append(feel_along(seen.view(guide, width_mm), guide))
    return felt


def _softened(places: Array, reach: int) -> Array:
    """Places each averaged with as many before as behind it, fewer near the ends, which stay."""
    count = len(places)
    at = np.arange(count)
    reaches = np.minimum(np.minimum(at, count - 1 - at), reach)
    sums = np.vstack([np.zeros(2), np.cumsum(places, axis=0)])
    return np.asarray(
        (sums[at + reaches + 1] - sums[at - reaches]) / (2 * reaches + 1)[:, None]
    )


def with_width(run: Run, width_mm: float) -> Run:
    """A run as a head sees it that knows the line's width."""
    return replace(run, view=replace(run.view, width_mm=width_mm))


def felt_mm(run: Run) -> float:
    """Length of a felt stretch."""
    return length_mm(run.places_mm)


def _line_widths(
    graph: Graph, felt: list[Run], at: dict[int, list[int]], settings: Settings
) -> list[float]:
    """The width of the line of each stretch, mm: its own, and of a short one that of those beside it."""
    own = [usual_width_mm(run) for run in felt]
    if settings.line_width_mm:
        return [settings.line_width_mm] * len(own)
    lengths = [felt_mm(run) for run in felt]
    found, straight = [], StraightOn(graph, felt, at)
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
        found.append(_weighted_median([own[m] for m in further], [lengths[m] for m in further]))
    return found


@dataclass(frozen=True, slots=True)
class StraightOn:
    """Which stretches go straight on into which: hatching on a frame of another width is not of its line."""

    graph: Graph
    felt: list[Run]
    at: dict[int, list[int]]

    def through(self, number: int) -> set[int]:
        """A stretch, and those into which it goes straight on at its ends, a few to either side."""
        found = {number}
        for last in (False, True):
            here: tuple[int, bool] | None = (number, last)
            for _ in range(FAR):
                here = self._onto(*here) if here is not None else None
                if here is None or here[0] in found:
                    break
                found.add(here[0])
        return found

    def _onto(self, number: int, last: bool) -> tuple[int, bool] | None:
        """The stretch straight on from an end of another, and its far end; None if none is straight on."""
        node = self.graph.stretches[number].nodes[last]
        way = -self._away(number, last)
        best, most = None, STRAIGHT_COS
        for other in self.at[node]:
            for other_last in (False, True):
                if other == number or self.graph.stretches[other].nodes[other_last] != node:
                    continue
                straight = float(self._away(other, other_last) @ way)
                if straight > most:
                    best, most = (other, not other_last), straight
        return best

    def _away(self, number: int, last: bool) -> Array:
        """The direction in which a stretch leaves the node at its end, (x, y)."""
        run = self.felt[number]
        places = run.places_mm[::-1] if last else run.places_mm
        far = min(len(places) - 1, round(AWAY_WIDTHS * run.view.width_mm / run.view.step_mm))
        chord = places[far] - places[0]
        return np.asarray(chord / max(float(np.hypot(*chord)), 1e-9))


def _weighted_median(values: list[float], weights: list[float]) -> float:
    """The value below which lies half of the weight."""
    order = np.argsort(values)
    sums = np.cumsum(np.asarray(weights)[order])
    return float(np.asarray(values)[order][np.searchsorted(sums, 0.5 * sums[-1])])
