"""Pairing: which legs of a tangle belong together, and by what way, as its ink shows.

Every leg is the end of a strand, and each strand has two. So all ways to join the legs in pairs are tried:
for each the strands are drawn as plainly as can be, and the pen's ink (see `pen`) is compared with the ink
that is there. Where ink is left over, the strand next to it gets a vertex more at the end of that ink, or a
stroke is drawn there that belongs to no strand: a tick, or the end of another line. Whatever explains the ink
with the fewest vertices is the way.

    misfit = sum((drawn - seen)²) · area of a pixel / width²        what a wrong or a missing stretch as long as the line is wide costs: about 1

Signals: a tangle in; ways to draw it out, the best first: pairs of legs, the vertices between them (mm),
strokes, misfit.

Source: our own. Questions: a line that goes to a tip and back on itself leaves the ink of a tick; it is taken
for a tick.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise, product

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.tracer.sensing.leg import Leg, meet, turn
from morfax.tracer.sensing.photocell import darkness_at
from morfax.tracer.sensing.probe import end_of
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles import pen
from morfax.tracer.tangles.tangle import Tangle

Pair = tuple[int, int]

MOST_LEGS = 4
VERTEX = 0.03  # what a vertex costs, as misfit
STROKE = 2.5  # vertices
DOUBLED, DOUBLED_RAD = 4.0, math.radians(3)  # vertices; a tip as narrow as this is a tick
MOST_ADDED = 6
MOST_IMPROVED = 4
MOST_SETTLED = 4
LEFT_OVER = 0.4  # of the line's darkness: ink that is not drawn
PLAN_EVERY = 4  # of the places of a stretch, 20 um apart
NONE = np.empty((0, 2))


@dataclass(frozen=True, slots=True)
class Way:
    """A way to draw a tangle: its strands as pairs of legs with the vertices between them, strokes (2, 2)
    besides, and what is left unexplained.
    """

    pairs: tuple[Pair, ...]
    vertices: tuple[Array, ...]
    strokes: tuple[Array, ...] = ()
    misfit: float = math.inf
    cost: float = math.inf


@dataclass(frozen=True, slots=True)
class Sketch:
    """A tangle as the pen sees it: poses of the legs' ends, facing in, the pen, and how far each place is
    from the legs.
    """

    view: View
    tangle: Tangle
    poses: Array
    pen: tuple[float, float]
    known_mm: Array
    unit: float  # of misfit per place

    @classmethod
    def of(cls, view: View, tangle: Tangle) -> Sketch:
        """Set the pen to the width and softness of the legs, and draw these."""
        facing = [
            leg.heading_rad + (math.pi if k else 0.0) for k, leg in enumerate(tangle.legs)
        ]
        poses = np.array(
            [(*leg.end_mm, heading) for leg, heading in zip(tangle.legs, facing, strict=True)]
        )
        width = float(np.median([leg.width_mm for leg in tangle.legs]))
        known = np.full(len(tangle.darkness), 1e3)
        for k, leg in enumerate(tangle.legs):
            way = leg.at(np.linspace(0, 1.2 if k else -1.2, 7))
            pen.away(
                tangle.places_mm, np.hstack([way[:-1], way[1:]]).T.copy(), len(way) - 1, known
            )
        softness = _softness(view, tangle.legs[0])
        return cls(
            view,
            tangle,
            poses,
            (0.5 * width, softness),
            known,
            tangle.area_mm2 / len(known) / width**2,
        )

    def _drawn(self, way: Way) -> tuple[Array, NDArray[np.int64], int, Array]:
        """A way as the pen takes it."""
        ends = np.array([[self.poses[a], self.poses[b]] for a, b in way.pairs]).reshape(
            -1, 2, 3
        )
        counts = np.array([len(v) for v in way.vertices], np.int64)
        return (
            ends,
            counts,
            len(way.strokes),
            np.asarray(np.vstack([NONE, *way.vertices, *way.strokes])),
        )

    def settled(self, way: Way, rounds: int = 12) -> Way:
        """The way with its vertices moved to where they explain the ink best."""
        ends, counts, strokes, vertices = self._drawn(way)
        left = pen.settle(
            self.tangle.places_mm,
            self.tangle.darkness,
            self.known_mm,
            self.pen,
            ends,
            counts,
            strokes,
            vertices,
            rounds,
        )
        parts = np.split(vertices, np.cumsum([*counts, *[2] * strokes]))
        moved = replace(
            way, vertices=tuple(parts[: len(counts)]), strokes=tuple(parts[len(counts) : -1])
        )
        misfit = float(left) * self.unit + self._on_paper(moved)
        return replace(moved, misfit=misfit, cost=misfit + VERTEX * self._effort(moved))

    def _on_paper(self, way: Way) -> float:
        """How much of a way lies on paper, in widths: beyond the places about the ink no misfit tells of it."""
        ends, counts, strokes, vertices = self._drawn(way)
        lines = np.empty((4, 2 * pen.PIECES * len(ends) + 2 * len(vertices) + 1))
        count = pen.pieces(ends, counts, strokes, vertices, lines)
        on_paper_mm = float(pen.on_paper_mm(self.view.cells, lines, count))
        return on_paper_mm / (2 * self.pen[0])

    def _effort(self, way: Way) -> float:
        """What a way costs by its vertices and strokes, in vertices."""
        effort = STROKE * (
            len(way.strokes) - len(self.poses) % 2
        )  # a leg that is left over has its stroke
        for (a, b), vertices in zip(way.pairs, way.vertices, strict=True):
            effort += len(vertices) + DOUBLED * _doubled(
                np.vstack([self.poses[a, :2], vertices, self.poses[b, :2]])
            )
        return effort

    def plainest(self, pairs: tuple[Pair, ...], *, bare: bool = False) -> Way:
        """The legs joined with no vertex, with one where they meet, or, unless `bare`, with those where the
        ink ahead of the one, the other or both ends.
        """
        joints = [self._joints(a, b)[: 2 if bare else None] for a, b in pairs]
        spare = set(range(len(self.poses))) - {leg for pair in pairs for leg in pair}
        ends = tuple(self._end(leg) for leg in spare)
        rough = sorted(
            (self.settled(Way(pairs, v, ends), 0) for v in product(*joints)),
            key=lambda way: way.cost,
        )
        return min(
            (self.settled(way, 4) for way in rough[:MOST_SETTLED]), key=lambda way: way.cost
        )

    def _joints(self, a: int, b: int) -> list[Array]:
        """Vertices (n, 2) by which two legs may be joined."""
        one, other = self._end(a)[1:], self._end(b)[1:]
        return [NONE, self._meeting(a, b), one, other, np.vstack([one, other])]

    def _end(self, leg: int) -> Array:
        """The stroke (2, 2) by which a leg goes on straight and ends half a width within the ink."""
        place, heading = self.poses[leg, :2], self.poses[leg, 2]
        ahead = Leg(place, heading, 0.0, 2 * self.pen[0], NONE)
        return np.array([place, ahead.at(max(end_of(self.view, ahead) or 0.0, self.pen[0]))])

    def _meeting(self, a: int, b: int) -> Array:
        """Where two legs meet, (1, 2); half way between their ends if they do not."""
        one, other = (
            Leg(pose[:2], pose[2], 0.0, 0.0, NONE)
            for pose in (self.poses[a], self.poses[b] + [0, 0, math.pi])
        )
        met = meet(one, other)
        if met is None or min(met) < -2 * self.pen[0] or max(met) > 5.0:
            return 0.5 * (one.end_mm + other.end_mm)[None]
        return one.at(met[0])[None]

    def _ink(self, way: Way) -> tuple[Array, Array, Array]:
        """Darkness drawn at each place, its distance from what is drawn, and the pieces (n, 4) of it."""
        ends, counts, strokes, vertices = self._drawn(way)
        lines = np.empty((4, 2 * pen.PIECES * len(ends) + 2 * len(vertices) + 1))
        count = pen.pieces(ends, counts, strokes, vertices, lines)
        distance, drawn = self.known_mm.copy(), np.empty(len(self.known_mm))
        pen.away(self.tangle.places_mm, lines, count, distance)
        pen.ink(distance, *self.pen, drawn)
        return drawn, distance, lines[:, :count].T

    def misfit_with(self, way: Way, stretches: list[Array]) -> float:
        """The misfit of a way together with some stretches (n, 2) mm."""
        _, distance, _ = self._ink(way)
        for stretch in stretches:
            some = np.vstack([stretch[:-1:PLAN_EVERY], stretch[-1:]])
            pen.away(
                self.tangle.places_mm,
                np.hstack([some[:-1], some[1:]]).T.copy(),
                len(some) - 1,
                distance,
            )
        drawn = np.empty(len(distance))
        pen.ink(distance, *self.pen, drawn)
        return float(np.sum((drawn - self.tangle.darkness) ** 2)) * self.unit

    def _left_over(self, way: Way) -> tuple[Array, Array, int] | None:
        """The tip of the ink that is farthest from what is drawn, half a width within, the place drawn next
        to it, and the piece that it lies on.
        """
        drawn, distance, lines = self._ink(way)
        left = (self.tangle.darkness - drawn > LEFT_OVER) & (distance > self.pen[0])
        if not left.any():
            return None
        place = self.tangle.places_mm[int(np.argmax(np.where(left, distance, 0)))]
        along = lines[:, 2:] - lines[:, :2]
        t = np.sum((place - lines[:, :2]) * along, axis=1) / (np.sum(along**2, axis=1) + 1e-18)
        feet = lines[:, :2] + np.clip(t, 0, 1)[:, None] * along
        piece = int(np.argmin(np.hypot(*(feet - place).T)))
        foot = feet[piece]
        return (
            place + (foot - place) * self.pen[0] / max(float(np.hypot(*(foot - place))), 1e-9),
            foot,
            piece,
        )

    def improved(self, way: Way, *, marks_only: bool = False) -> Way:
        """The way with vertices and strokes added while they explain more ink than they cost; `marks_only`:
        strokes alone.
        """
        way = self.settled(way)
        for _ in range(MOST_ADDED):
            found = self._left_over(way) if way.misfit > VERTEX else None
            if found is None:
                break
            more = _with_more(way, *found)
            tries = [self.settled(t, 3) for t in (more[:1] if marks_only else more)]
            best = self.settled(min(tries, key=lambda t: t.cost))
            if best.cost >= way.cost:
                break
            way = self._pruned(best)
        return way

    def _pruned(self, way: Way) -> Way:
        """The way without the vertices that explain less ink than they cost."""
        while True:
            fewer = [
                replace(
                    way,
                    vertices=(
                        *way.vertices[:k],
                        np.delete(v, i, axis=0),
                        *way.vertices[k + 1 :],
                    ),
                )
                for k, v in enumerate(way.vertices)
                for i in range(len(v))
            ]
            best = min((self.settled(w, 3) for w in fewer), key=lambda w: w.cost, default=way)
            if best.cost >= way.cost:
                return way
            way = self.settled(best)


def ways(sketch: Sketch) -> list[Way]:
    """Ways to draw a tangle, the best first."""
    plain = sorted(
        (sketch.plainest(pairs) for pairs in matchings(len(sketch.poses))), key=lambda w: w.cost
    )
    return sorted((sketch.improved(way) for way in plain[:MOST_IMPROVED]), key=lambda w: w.cost)


def matchings(legs: int) -> list[tuple[Pair, ...]]:
    """Every way to join legs in pairs; of an odd number one is left over."""

    def of(rest: tuple[int, ...], spare: bool) -> list[tuple[Pair, ...]]:
        if not rest:
            return [()]
        out = [
            ((rest[0], rest[k]), *more)
            for k in range(1, len(rest))
            for more in of(rest[1:k] + rest[k + 1 :], spare)
        ]
        return out + (of(rest[1:], False) if spare else [])

    return of(tuple(range(legs)), legs % 2 == 1)


def _with_more(way: Way, tip: Array, foot: Array, piece: int) -> list[Way]:
    """The way with a stroke from a foot to a tip, then with the tip as a vertex, or as that of a spike, of
    the strand on whose piece the foot is.
    """
    more = [replace(way, strokes=(*way.strokes, np.array([foot, tip])))]
    for k, v in enumerate(way.vertices):
        pieces = 2 * pen.PIECES + max(len(v) - 1, 0)
        if not 0 <= piece < pieces:
            piece -= pieces
            continue
        gap = min(max(piece - pen.PIECES + 1, 0), len(v))
        spikes = [[tip], [foot, tip], [tip, foot], [foot, tip, foot]]
        added = [(gap, spike) for spike in spikes] + [
            (at, [tip]) for at in range(len(v) + 1) if at != gap
        ]
        for at, vertices in added:
            longer = np.vstack([v[:at], *vertices, v[at:]])
            more.append(
                replace(way, vertices=(*way.vertices[:k], longer, *way.vertices[k + 1 :]))
            )
        break
    return more


def _doubled(places: Array) -> int:
    """At how many vertices of a strand it goes back on itself."""
    steps = np.diff(places, axis=0)
    headings = np.arctan2(steps[:, 1], steps[:, 0])
    return sum(abs(turn(a, b)) > math.pi - DOUBLED_RAD for a, b in pairwise(headings))


def _softness(view: View, leg: Leg) -> float:
    """Softness of the line's edges, mm: that with which the pen's ink is most like the leg's."""
    stations = leg.seen[::3, :2]
    way = np.gradient(stations, axis=0)
    t = way / np.hypot(*way.T)[:, None]
    u = np.linspace(-0.5, 0.5, 25) * (leg.width_mm + 0.6)
    seen = np.median(
        [
            [darkness_at(view.cells, p[0] - a * d[1], p[1] + a * d[0]) for a in u]
            for p, d in zip(stations, t, strict=True)
        ],
        axis=0,
    ) / (2 * view.level)  # fmt: skip
    drawn = np.empty(len(u))
    misfits = []
    options = np.geomspace(0.2, 4.0, 24) * view.pitch_mm
    for softness in options:
        pen.ink(np.abs(u), 0.5 * leg.width_mm, softness, drawn)
        misfits.append(float(np.sum((drawn - seen) ** 2)))
    return float(options[int(np.argmin(misfits))])
