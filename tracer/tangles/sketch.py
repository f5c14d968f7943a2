"""The sketch: a tangle as the pen sees it, redrawn in every way until its ink is explained.

All ways to join the legs in pairs are tried. For each the strands are drawn as plainly as can be, and the
pen's ink (see `pen`) is compared with the ink that is there. Where ink is left over, the strand next to it
gets a vertex more at the end of that ink, or a stroke is drawn there. The redrawing that explains the ink
with the fewest vertices is the best.

    misfit = sum((drawn - seen)²) · area of a pixel / width²        a wrong or missing stretch as long as the
                                                                    line is wide costs about 1

Signals: a tangle in; redrawings out, the best first.

Source: our own. Questions: a line that goes to a tip and back on itself leaves the ink of a tick; it is taken
for a tick.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median, medians
from morfax.motion.plane import NOTHING_MM2, left_of, unit
from morfax.tracer.junctions.rings import FARTHEST_MM
from morfax.tracer.sensing.leg import Leg, meet
from morfax.tracer.sensing.photocell import darkness_along
from morfax.tracer.sensing.probe import end_of
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles import distances, pen, settling
from morfax.tracer.tangles.redrawing import (
    DOUBLED,
    IN_GRAIN,
    NONE,
    STROKE,
    VERTEX,
    Pair,
    Redrawing,
    matchings,
    with_more,
)
from morfax.tracer.tangles.tangle import Tangle

# Chosen by trial on the test drawings.
MOST_LEGS = 4  # of a tangle: there are three ways to join them, and fifteen for six
MOST_ADDED = 6  # vertices and strokes
MOST_SETTLED = 4  # redrawings, plain and rough ones
LEFT_OVER = 0.4  # of the line's darkness: ink that is not drawn
PLAN_EVERY = 4  # of the places of a stretch, 20 um apart
# rounds in which vertices settle: at last, of a plain redrawing, of a try
ALL, SOME, FEW = 12, 4, 3
LEG_MM = np.linspace(0, 1.2, 7)  # of each leg is drawn

SOFTNESSES_PX = np.geomspace(0.2, 4.0, 24)  # that the pen is tried with
# of the width and some paper, where a leg's darkness is seen
ACROSS = np.linspace(-0.5, 0.5, 25)
PAPER_MM = 0.6  # of paper, half on either side
STATIONS_EVERY = 3  # of a leg's stations one is looked at


@dataclass(frozen=True, slots=True)
class Sketch:
    """A tangle as the pen sees it: poses of the legs' ends, facing in, its ink, and misfit per place."""

    view: View
    tangle: Tangle
    poses: Array
    ink: pen.Ink
    unit: float

    @classmethod
    def of(cls, view: View, tangle: Tangle) -> Sketch:
        """Set the pen to the width and softness of the legs, and draw these."""
        # 1. the legs, the first of which heads in and the others out
        known = np.full(len(tangle.darkness), distances.NOWHERE_MM)
        poses = []
        for k, leg in enumerate(tangle.legs):
            poses.append((*leg.end_mm, leg.heading_rad + (math.pi if k else 0.0)))
            _draw(tangle, leg.at(LEG_MM if k else -LEG_MM), known)
        # 2. the pen
        width = median([leg.width_mm for leg in tangle.legs])
        softness = softness_of(view, tangle.legs[0])
        ink = pen.Ink(tangle.places_mm, tangle.darkness, known, 0.5 * width, softness)
        return cls(view, tangle, np.array(poses), ink, tangle.area_mm2 / len(known) / width**2)

    @property
    def vertex(self) -> float:
        """What a vertex costs, as misfit."""
        return IN_GRAIN * VERTEX if self.view.grainy else VERTEX

    def _drawn(self, way: Redrawing) -> tuple[pen.Drawn, Array]:
        """A redrawing as the pen takes it, and its vertices (n, 2)."""
        ends = self.poses[np.array(way.pairs, np.int64).reshape(-1, 2)]
        counts = np.array([len(v) for v in way.vertices], np.int64)
        vertices = np.concatenate([NONE, *way.vertices, *way.strokes])
        return pen.Drawn(ends, counts, len(way.strokes)), vertices

    def _pieces(self, way: Redrawing) -> Array:
        """The straight pieces (4, n) of a redrawing."""
        drawn, vertices = self._drawn(way)
        lines = np.empty((4, pen.most_pieces(drawn, vertices)))
        return lines[:, : pen.pieces(drawn, vertices, lines)]

    def settled(self, way: Redrawing, rounds: int = ALL) -> Redrawing:
        """The redrawing with its vertices moved to where they explain the ink best."""
        drawn, vertices = self._drawn(way)
        cells = self.view.cells
        wrong, paper_mm, tips = settling.weighed(self.ink, cells, drawn, vertices, rounds)
        # what lies on paper, in widths: no place about the ink would show it
        misfit = wrong * self.unit + paper_mm / (2 * self.ink.half_mm)
        # a leg that is left over has its stroke
        effort = STROKE * (len(way.strokes) - len(self.poses) % 2)
        effort += sum(map(len, way.vertices)) + DOUBLED * tips
        return way.moved(vertices, misfit, misfit + self.vertex * effort)

    def plainest(self, pairs: tuple[Pair, ...]) -> Redrawing:
        """The legs joined with no vertex, with one where they meet, or with those where their ink ends."""
        joints = [self._joints(a, b) for a, b in pairs]
        spare = set(range(len(self.poses))) - {leg for pair in pairs for leg in pair}
        ends = tuple(self._end(leg) for leg in spare)
        tries = [self.settled(Redrawing(pairs, v, ends), 0) for v in product(*joints)]
        rough = sorted(tries, key=lambda way: way.cost)[:MOST_SETTLED]
        return min((self.settled(way, SOME) for way in rough), key=lambda way: way.cost)

    def _joints(self, a: int, b: int) -> list[Array]:
        """Vertices (n, 2) by which two legs may be joined."""
        one, other = self._end(a)[1:], self._end(b)[1:]
        return [NONE, self._meeting(a, b), one, other, np.vstack([one, other])]

    def _end(self, leg: int) -> Array:
        """The stroke (2, 2) by which a leg goes on straight and ends half a width within the ink."""
        place, heading = self.poses[leg, :2], self.poses[leg, 2]
        ahead = Leg(place, heading, 0.0, 2 * self.ink.half_mm, NONE)
        reach_mm = max(end_of(self.view, ahead) or 0.0, self.ink.half_mm)
        return np.array([place, ahead.at(reach_mm)])

    def _meeting(self, a: int, b: int) -> Array:
        """Where two legs meet, (1, 2); half way between their ends if they do not."""
        into, out = self.poses[a], self.poses[b] + [0, 0, math.pi]
        one, other = (Leg(pose[:2], pose[2], 0.0, 0.0, NONE) for pose in (into, out))
        met = meet(one, other)
        if met is None or min(met) < -2 * self.ink.half_mm or max(met) > FARTHEST_MM:
            return 0.5 * (one.end_mm + other.end_mm)[None]
        return one.at(met[0])[None]

    def misfit_with(self, way: Redrawing, stretches: list[Array]) -> float:
        """The misfit of a redrawing together with some stretches (n, 2) mm."""
        _, distance, _ = self._inked(way)
        for stretch in stretches:
            some = np.vstack([stretch[:-1:PLAN_EVERY], stretch[-1:]])
            _draw(self.tangle, some, distance)
        drawn = np.empty(len(distance))
        pen.ink(distance, self.ink.half_mm, self.ink.softness_mm, drawn)
        return float(np.sum((drawn - self.tangle.darkness) ** 2)) * self.unit

    def _inked(self, way: Redrawing) -> tuple[Array, Array, Array]:
        """Darkness drawn at each place, its distance from what is drawn, and the pieces (n, 4) of that."""
        lines = np.ascontiguousarray(self._pieces(way))
        distance, drawn = self.ink.known_mm.copy(), np.empty(len(self.ink.known_mm))
        distances.away(self.tangle.places_mm, lines, lines.shape[1], distance)
        pen.ink(distance, self.ink.half_mm, self.ink.softness_mm, drawn)
        return drawn, distance, lines.T

    def _left_over(self, way: Redrawing) -> tuple[Array, Array, int] | None:
        """The tip of the ink that is farthest from what is drawn, the foot next to it, and the foot's piece.

        The tip is half a width within the ink.
        """
        half_mm = self.ink.half_mm
        drawn, distance, lines = self._inked(way)
        left = (self.tangle.darkness - drawn > LEFT_OVER) & (distance > half_mm)
        if not left.any():
            return None
        place = self.tangle.places_mm[int(np.argmax(np.where(left, distance, 0)))]
        along = lines[:, 2:] - lines[:, :2]
        come = np.sum((place - lines[:, :2]) * along, axis=1)
        t = come / (np.sum(along**2, axis=1) + NOTHING_MM2)
        feet = lines[:, :2] + np.clip(t, 0, 1)[:, None] * along
        piece = int(np.argmin(np.hypot(*(feet - place).T)))
        foot = feet[piece]
        within = half_mm * unit(foot - place)
        return place + within, foot, piece

    def improved(self, way: Redrawing, *, marks_only: bool = False) -> Redrawing:
        """The redrawing with vertices and strokes added while they explain more ink than they cost.

        With `marks_only` strokes alone.
        """
        way = self.settled(way)
        for _ in range(MOST_ADDED):
            found = self._left_over(way) if way.misfit > self.vertex else None
            if found is None:
                break
            more = with_more(way, *found)
            tries = [self.settled(t, FEW) for t in (more[:1] if marks_only else more)]
            best = self.settled(min(tries, key=lambda t: t.cost))
            if best.cost >= way.cost:
                break
            way = self._pruned(best)
        return way

    def _pruned(self, way: Redrawing) -> Redrawing:
        """The redrawing without the vertices that explain less ink than they cost."""
        while True:
            fewer = [
                way.with_strand(k, np.delete(v, i, axis=0))
                for k, v in enumerate(way.vertices)
                for i in range(len(v))
            ]
            tries = (self.settled(w, FEW) for w in fewer)
            best = min(tries, key=lambda w: w.cost, default=way)
            if best.cost >= way.cost:
                return way
            way = self.settled(best)


def redrawings(sketch: Sketch) -> list[Redrawing]:
    """Redrawings of a tangle, the best first."""
    plain = [sketch.plainest(pairs) for pairs in matchings(len(sketch.poses))]
    plain = sorted(plain, key=lambda way: way.cost)[:MOST_SETTLED]
    return sorted((sketch.improved(way) for way in plain), key=lambda way: way.cost)


def _draw(tangle: Tangle, way: Array, distance_mm: Array) -> None:
    """Lower the distances of a tangle's places, in place, to those from a way (n, 2)."""
    lines = np.hstack([way[:-1], way[1:]]).T.copy()
    distances.away(tangle.places_mm, lines, len(way) - 1, distance_mm)


def softness_of(view: View, leg: Leg) -> float:
    """Softness of the line's edges, mm: that with which the pen's ink is most like the leg's."""
    # 1. the leg's darkness across it
    stations = leg.seen[::STATIONS_EVERY, :2]
    along = np.array([[math.cos(leg.heading_rad), math.sin(leg.heading_rad)]])
    if len(stations) > 1:  # a leg of few stations has one
        along = unit(np.gradient(stations, axis=0))
    left = left_of(along)
    u = ACROSS * (leg.width_mm + PAPER_MM)
    places = stations[:, None] + u[:, None] * left[:, None]
    across = darkness_along(view.cells, places.reshape(-1, 2)).reshape(len(left), len(u))
    seen = medians(across.T) / (2 * view.level)
    # 2. the pen that is most like it
    misfits, softnesses_mm = np.empty(len(SOFTNESSES_PX)), SOFTNESSES_PX * view.pitch_mm
    pen.misfits((np.abs(u), seen), 0.5 * leg.width_mm, softnesses_mm, misfits)
    return float(softnesses_mm[int(np.argmin(misfits))])
