"""Unravelling a tangle: by which leg, and over which vertices, the head's own line leaves it.

Signals: the view, the incoming leg, the trail, and what was planned by the legs alone in; stretches and the outgoing leg out.

Source: our own (see `pairing`).
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import combinations, pairwise
from typing import NamedTuple

import numpy as np

from tracer import pen
from tracer.course import SPACING_MM, ahead_mm, along_leg, hermite, onto
from tracer.leg import Leg, stroke_end, turn
from tracer.marks import longest_mm
from tracer.pairing import MOST_LEGS, NONE, VERTEX, Sketch, Way, ways
from tracer.survey import goes_straight
from tracer.tangle import Tangle, tangle_ahead
from tracer.trail import Trail
from tracer.view import Array, View

CLEAR = 0.25  # misfit up to which a way explains the ink
LEAST_CLEAR, BETTER = (
    1.0,
    0.25,
)  # a long tangle is explained less well: up to this, if that is so much better than the plan
TWICE, LEAST_MISFIT = 2.0, 0.02
DOUBTFUL = 0.08  # straight on stands unless the ink tells against it by more
BLOT_VERTICES, BLOT_WIDTHS = (
    4.5,
    4.0,
)  # a way with more vertices that reaches no farther, and leaves ink, is a scribble over a blot
WELL_MM2 = 0.015  # area of wrong ink in a way that explains all of it
AS_GOOD = 0.05  # misfit of a plan that needs no other to be compared with
LEAST_SEEN = 4  # stations of the incoming leg, to know the pen by
SAME_RAD = math.radians(20)
NEAR_MM = 3.0
LEAST_AHEAD_MM = 0.1
MARK_AS_GOOD = 1.3
BACK_RAD, LONGEST_TIP_MM = math.radians(130), 5.5  # lines that run together to one tip
CROSSES_RAD = math.radians(25)
KINK_RAD = math.radians(14)  # a smaller change of heading is run through


class Planned(NamedTuple):
    """Stretches from where the head is, the leg that they lead to, and what of the line was felt clean on the way."""

    stretches: list[Array]
    leg: Leg
    seen: Array | None = None


class Tangles:
    """The tangles that the head has come to, each with the way it was drawn: where a line leads into one again it takes the strand that is left."""

    def __init__(self) -> None:
        self._known: list[tuple[Tangle, Way]] = []
        self._left: list[tuple[int, int, Leg]] = []
        self._beside: list[Leg] = []

    def way_out(
        self,
        view: View,
        incoming: Leg,
        trail: Trail,
        way_in: tuple[Array, float],
        plan: Planned | None,
        number: int = 0,
        rank: int = 0,
    ) -> tuple[Planned | None, bool]:
        """The way from where the head is (place, heading) out of the tangle ahead, and whether it explains the tangle's ink.

        It is the plan if that explains the ink as well as any other way, or if the tangle does not end in legs, or in too many, or if no way explains its
        ink. `rank` 1 takes the second best way out, 2 the third, and `number` is that of the tangle among the junctions.
        """
        if len(incoming.seen) < LEAST_SEEN:
            return plan, False
        strand = self._strand_left(incoming, trail, way_in[0], view.width_mm)
        if strand is not None and rank == 0:
            first, vertices, last = strand
            return Planned(_stretches(way_in, first, vertices, last), last), True
        tangle = tangle_ahead(view, incoming)
        odd = len(tangle.legs) % 2 == 1  # one line ends on another: that is a junction, which the legs tell better
        if odd:
            self._beside += [leg for leg in tangle.legs[1:] if _runs_back(view, incoming, leg)]
        if not tangle.whole or not 2 <= len(tangle.legs) <= MOST_LEGS or (odd and plan is not None):
            return plan, False
        found, way, others = _unravelled(Sketch.of(view, tangle), incoming, trail, way_in, plan, rank)
        if way is not None:
            self._known.append((tangle, way))
        if rank == 0:
            self._left += [(number, k + 1, leg) for k, leg in enumerate(others)]
        return found, way is not None

    def goes_back(self, tip: Array, trail: Trail, width_mm: float) -> bool:
        """Whether the line that ends at a tip is two that ran together a little before, of which the one has not been followed."""
        near = [leg for leg in self._beside if np.hypot(*(leg.end_mm - tip)) < LONGEST_TIP_MM]
        self._beside = []
        return any(not trail.holds(leg, width_mm) for leg in near)

    def doubts(self, trail: Trail, width_mm: float) -> tuple[tuple[int, int], ...]:
        """Numbers of the junctions where another way out would have done as well and leads to ink that has not been followed, and its rank."""
        return tuple((number, rank) for number, rank, leg in self._left if not trail.holds(leg, width_mm))

    def _strand_left(self, incoming: Leg, trail: Trail, place: Array, width_mm: float) -> tuple[Leg, Array, Leg] | None:
        """The legs and the vertices between them of the strand that a line leads into; None if it leads into no tangle that is known."""
        for tangle, way in self._known:
            legs = [tangle.legs[0].turned_round(), *tangle.legs[1:]]
            for pair, vertices in zip(way.pairs, way.vertices, strict=True):
                if 0 in pair:
                    continue  # the one that was taken
                for a, b, between in ((*pair, vertices), (*pair[::-1], vertices[::-1])):
                    first = legs[a].turned_round()
                    if _same(first, incoming, width_mm) and not trail.holds(legs[b], width_mm):
                        return first if ahead_mm(place, first) > LEAST_AHEAD_MM else incoming, between, legs[b]
        return None


def _runs_back(view: View, incoming: Leg, leg: Leg) -> bool:
    """Whether a leg is that of a line, no mark, that runs together with the incoming one, ahead."""
    back = abs(turn(incoming.heading_rad, leg.heading_rad)) > BACK_RAD
    return back and stroke_end(view, leg, longest_mm(view)) is None


def _unravelled(
    sketch: Sketch, incoming: Leg, trail: Trail, way_in: tuple[Array, float], plan: Planned | None, rank: int
) -> tuple[Planned | None, Way | None, list[Leg]]:
    """The way out of a tangle, the way in which its ink is drawn then, None if no way explains it, and the legs of others that would do as well."""
    view, tangle = sketch.view, sketch.tangle
    drawn = [] if plan is None else _as_drawn(plan, tangle, view.width_mm)
    planned = math.inf if plan is None else sketch.misfit_with(Way((), ()), drawn)
    two = len(tangle.legs) == 2
    if plan is not None and two and planned < AS_GOOD and _same(plan.leg, tangle.legs[1], view.width_mm):
        return plan, Way(((0, 1),), (NONE,)), []
    every = ways(sketch)
    if _partner(every[0]) is None:
        return plan, None, []  # the line ends here, on another
    clear = max(CLEAR, min(BETTER * planned, LEAST_CLEAR)) if two else CLEAR
    best: dict[int, Way] = {}
    for way in every:
        leg = _partner(way)
        if leg is not None and way.misfit < clear and not trail.holds(tangle.legs[leg], view.width_mm):
            best.setdefault(leg, way)
    if not best:
        return plan, None, []
    leg, straight = next(iter(best)), False
    if plan is not None and goes_straight(incoming, plan.leg) and not two:
        for k, way in best.items():
            if _same(plan.leg, tangle.legs[k], view.width_mm) and _as_good(way, best[leg]):
                leg, straight = k, _aside_mm(_own(way), plan.stretches) < view.width_mm
                break
    others = [k for k in best if k != leg]
    if rank and others:
        leg, straight = others[min(rank, len(others)) - 1], False
    way = best[leg]
    as_good = [tangle.legs[k] for k in others if _as_good(best[k], way)] if _bends(sketch, way) else []
    if straight or (
        plan is not None and _same(plan.leg, tangle.legs[leg], view.width_mm) and _stands(sketch, way, plan, drawn)
    ):
        return plan, way, as_good
    return Planned(_stretches(way_in, incoming, _own(way), tangle.legs[leg]), tangle.legs[leg]), way, as_good


def _stands(sketch: Sketch, way: Way, plan: Planned, drawn: list[Array]) -> bool:
    """Whether a plan that leads where the best way does explains the ink as well, but for a mark beside it."""
    planned = sketch.misfit_with(_without_own(way), drawn)
    if planned < way.misfit + VERTEX * (1 + len(_own(way))):
        return True
    return goes_straight(sketch.tangle.legs[0], plan.leg) and _is_mark(sketch, way, plan)


def _bends(sketch: Sketch, way: Way) -> bool:
    """Whether no strand of a way goes straight on: lines that do are lines that cross, or that another touches."""
    headings = sketch.poses[:, 2]
    return all(abs(turn(headings[a], headings[b] + math.pi)) > CROSSES_RAD for a, b in way.pairs)


def _as_good(way: Way, other: Way) -> bool:
    """Whether a way explains the ink about as well as another."""
    return way.cost < other.cost + DOUBTFUL and way.misfit < TWICE * other.misfit + LEAST_MISFIT


def _is_mark(sketch: Sketch, way: Way, plan: Planned) -> bool:
    """Whether what a way draws beside the straight one may be a mark or a blot: no longer than a mark, and no stroke of the line explains it better."""
    width_mm = sketch.view.width_mm
    aside_mm = _aside_mm(_own(way), plan.stretches)
    if aside_mm >= longest_mm(sketch.view):
        return False
    scribble = way.misfit > WELL_MM2 / width_mm**2 and way.cost - way.misfit > BLOT_VERTICES * VERTEX
    if scribble and aside_mm < BLOT_WIDTHS * width_mm:
        return True
    bare = Way(way.pairs, tuple(NONE for _ in way.pairs))
    marked = sketch.improved(bare, marks_only=True)
    tips = [*_own(way), *(stroke[1] for stroke in marked.strokes)]
    ticks = [np.array(two) for two in combinations(tips, 2)] + list(marked.strokes[:1])
    ticked = min((sketch.settled(replace(bare, strokes=(tick,))).misfit for tick in ticks), default=math.inf)
    if ticked < MARK_AS_GOOD * way.misfit + LEAST_MISFIT:
        return True
    if aside_mm < width_mm:
        return marked.misfit < TWICE * way.misfit
    return marked.misfit < way.misfit and marked.cost < way.cost


def _as_drawn(plan: Planned, tangle: Tangle, width_mm: float) -> list[Array]:
    """What a plan draws: its stretches, what was felt of its leg, and on to that leg's clean end in the tangle."""
    way = [*plan.stretches[:-1], np.vstack([plan.stretches[-1], plan.leg.seen[:, :2]])]
    for leg in tangle.legs[1:]:
        if _same(plan.leg, leg, width_mm):
            way[-1] = np.vstack([way[-1], leg.end_mm])
    return way


def _same(leg: Leg, other: Leg, width_mm: float) -> bool:
    """Whether two legs lie on the same line, near each other."""
    along = ahead_mm(leg.end_mm, other) * math.cos(turn(leg.heading_rad, other.heading_rad))
    gap = other.end_mm - leg.at(along)
    turned = abs(turn(leg.heading_at(along), other.heading_rad))
    return turned < SAME_RAD and float(np.hypot(*gap)) < 0.5 * width_mm and abs(along) < max(4 * width_mm, NEAR_MM)


def _stretches(way_in: tuple[Array, float], incoming: Leg, vertices: Array, outgoing: Leg) -> list[Array]:
    """Stretches from where the head is over the vertices to the outgoing leg's clean end, one ending at each vertex where the head swivels."""
    way, along = onto(*way_in, incoming, 0.0)
    start = np.vstack([way, along_leg(incoming, along, 0.0)])
    if not len(vertices):
        return [
            np.vstack([start, hermite(incoming.end_mm, incoming.heading_rad, outgoing.end_mm, outgoing.heading_rad)])
        ]
    first = np.vstack([start, _bend(incoming.end_mm, incoming.heading_rad, vertices[0])])
    last = _bend(outgoing.end_mm, outgoing.heading_rad + math.pi, vertices[-1])[::-1]
    out = [first]
    for part in [*(_straight(a, b) for a, b in pairwise(vertices)), last]:
        before, after = out[-1][-1] - out[-1][-2], part[1] - part[0]
        if abs(turn(math.atan2(before[1], before[0]), math.atan2(after[1], after[0]))) > KINK_RAD:
            out.append(part)
        else:
            out[-1] = np.vstack([out[-1], part[1:]])
    return out


def _aside_mm(vertices: Array, stretches: list[Array]) -> float:
    """How far vertices reach from some stretches, mm."""
    places = np.vstack(stretches)
    return max((float(np.min(np.hypot(*(places - vertex).T))) for vertex in vertices), default=0.0)


def _without_own(way: Way) -> Way:
    """The way without the strand of the incoming leg."""
    others = [(pair, v) for pair, v in zip(way.pairs, way.vertices, strict=True) if pair[0] != 0]
    return Way(tuple(pair for pair, _ in others), tuple(v for _, v in others), way.strokes)


def _partner(way: Way) -> int | None:
    """The leg with which the incoming one is joined."""
    return next((b for a, b in way.pairs if a == 0), None)


def _own(way: Way) -> Array:
    """The vertices of the incoming leg's strand."""
    return next(v for (a, _), v in zip(way.pairs, way.vertices, strict=True) if a == 0)


def _bend(place: Array, heading: float, vertex: Array) -> Array:
    """Places (n, 2) along the bend from a leg's end to a vertex."""
    shares = np.linspace(0, 1, max(2, math.ceil(float(np.hypot(*(vertex - place))) / SPACING_MM) + 1))
    return np.array([pen.bend(place[0], place[1], heading, vertex[0], vertex[1], t) for t in shares])


def _straight(start: Array, end: Array) -> Array:
    """Places (n, 2) along a straight line."""
    return np.linspace(start, end, max(2, math.ceil(float(np.hypot(*(end - start))) / SPACING_MM) + 1))
