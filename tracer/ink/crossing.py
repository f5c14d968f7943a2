"""Crossings: the legs of lines that meet, which of them are one line, and the ways that go through.

Signals: legs as they come in, how the head sees each of their lines, and what was felt of the ink between
them in; pairs of legs that are one line out, places (n, 2) mm of the ways from one leg to its partner, and
how far beyond their legs lines end that have no partner, mm.

The net of a sheet is made a few times, until no ink is left over; a crossing whose legs are still the same is
solved once, and known again by its `key`.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.curves import bow, hermite
from morfax.motion.median import median
from morfax.motion.neighbours import Neighbours
from morfax.motion.plane import direction
from morfax.tracer.effort import EVERY_MM
from morfax.tracer.head.course import SMOOTH
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.trail import Trail
from morfax.tracer.ink.crossing_ink import WaysOn
from morfax.tracer.ink.crossing_on_ink import is_explained, is_one_with_a_tip, told_by_ink
from morfax.tracer.ink.felt import usual_width_mm
from morfax.tracer.ink.lifted import Loose, ends_in_ink_mm
from morfax.tracer.ink.net import COVERED, Inner
from morfax.tracer.ink.over_paper import without_paper
from morfax.tracer.ink.partners import (
    CORNERED,
    Pair,
    are_side_by_side,
    meeting_place,
    partners,
    turnings,
    way_through,
    without_partner,
)
from morfax.tracer.ink.redrawn_crossing import redrawn
from morfax.tracer.ink.shared_ink import SharedInk, are_apart_where_they_cross
from morfax.tracer.junctions.planner import Planner
from morfax.tracer.limits import WIDER
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.probe import reach_of_ink
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.strands import stretches_over

# of a stretch within a crossing, along which ways go; by trial on drawings of nets
COVERED_SHARE = 0.7
# widths between the ends of two lines that come to a tip: nearer, they are one. Within one width their pens'
# rounds overlap, and legs that have felt each other tell ends 1.0 apart
APART = 1.2
LONG = 15.0  # widths: in ink that reaches further lines run together, and their rims tell them
NOWHERE = np.empty((0, 2))


@dataclass
class Crossing:
    """Legs that meet, each with the view of its line, and the stretches of ink between them.

    `near` are places of each line as far from the junction as another's end may lie in its ink, (n, 2) mm.
    """

    legs: list[Leg]
    views: list[View]
    settings: Settings
    near: list[Array] = field(default_factory=list)
    inked: list[Inner] = field(default_factory=list)
    drawn: WaysOn | None = None  # where it is told by the ink
    _covers: dict[int, bool] = field(default_factory=dict)
    _drawn: dict[Hashable, Crossing] = field(default_factory=dict)  # as its lines may go on
    # where legs end, by what passes there
    _ended: dict[Hashable, list[float | None]] = field(default_factory=dict)

    @property
    def key(self) -> Hashable:
        """What decides how lines go on here."""
        both = zip(self.legs, self.views, strict=True)
        widths_mm = [(leg.width_mm, view.width_mm) for leg, view in both]
        legs = [(*leg.end_mm.tolist(), leg.heading_rad, leg.bend_per_mm) for leg in self.legs]
        return tuple(legs), tuple(widths_mm), tuple(inner.stretch for inner in self.inked)

    @property
    def pairs(self) -> list[Pair]:
        """The legs, by their numbers here, that are one line."""
        return list(self.solution.pairs)

    @cached_property
    def solution(self) -> WaysOn:
        """How its lines go on: as its legs tell, or as its ink does."""
        if self.drawn is not None:
            return self.drawn
        if len(self.legs) == 2:
            are_two = self._tips and not is_one_with_a_tip(self, (0, 1))
            return WaysOn(() if are_two else ((0, 1),), {})
        if vertices := self._vertices:
            return without_paper(self, WaysOn(tuple(sorted(vertices)), vertices))
        return without_paper(self, told_by_ink(self, WaysOn(tuple(self._by_turnings), {})))

    def as_drawn(self, drawn: WaysOn) -> Crossing:
        """The same crossing with its lines going on in another way; one for each way to go on."""
        corners = tuple((pair, places.tobytes()) for pair, places in drawn.corners.items())
        key = drawn.pairs, corners
        if key not in self._drawn:
            self._drawn[key] = replace(self, drawn=drawn, _covers={}, _drawn={})
        return self._drawn[key]

    @cached_property
    def _solved(self) -> Crossing:
        """The same as it is drawn: its ways and ends were made when they were held against its ink."""
        solved = self.as_drawn(self.solution)
        self._drawn.clear()
        self._ended.clear()
        return solved

    @cached_property
    def is_explained(self) -> bool:
        """Whether its lines explain its ink."""
        return is_explained(self)

    @cached_property
    def turnings_rad(self) -> Array:
        """By how much a way turns from each leg to each other, rad (n, n)."""
        return turnings(self.legs, self.width_mm)

    @cached_property
    def _by_turnings(self) -> list[Pair]:
        """The pairs that turn least."""
        return self._by_rims(partners(self.turnings_rad), self.turnings_rad)

    @cached_property
    def _vertices(self) -> Mapping[Pair, Array]:
        """Where the ways between the legs of each pair turn, (n, 2) mm, if legs that meet may be told by
        their ink only.
        """
        pairs, costs = self._by_turnings, self.turnings_rad
        if len(pairs) != 2 or len(self.legs) != 2 * len(pairs):
            return {}
        reach_mm = float(np.ptp([leg.end_mm for leg in self.legs], axis=0).max())
        is_smooth = max(costs[pair] for pair in pairs) < SMOOTH
        if is_smooth or reach_mm > LONG * self.width_mm or not self.is_of_one_pen:
            return {}
        return redrawn(self.views[0], self.legs, costs)

    @property
    def is_of_one_pen(self) -> bool:
        """Whether its legs are about as wide, and the ink between them is no narrower."""
        legs_mm = [leg.width_mm for leg in self.legs]
        inked_mm = [usual_width_mm(inner.run) for inner in self.inked]
        return max(legs_mm) < WIDER * min(legs_mm + inked_mm)

    @property
    def width_mm(self) -> float:
        """The usual width of its lines."""
        return median([leg.width_mm for leg in self.legs])

    def _by_rims(self, pairs: list[Pair], costs: Array) -> list[Pair]:
        """Pairs of which two exchange their partners where their ways cross in ink too broad for that."""
        now = list(pairs)
        for one, other in combinations(range(len(now)) if self.inked else (), 2):
            (a, b), (c, d) = now[one], now[other]
            way, onto = self._bows([now[one], now[other]])
            tried = [
                (max(costs[pair] for pair in two), two)
                for two in (((a, c), (b, d)), ((a, d), (b, c)))
            ]
            turned, two = min(tried)
            if turned < CORNERED and are_apart_where_they_cross(
                way, onto, self._inked, self.width_mm
            ):
                now[one], now[other] = two
        return [(min(pair), max(pair)) for pair in now]

    @cached_property
    def _inked(self) -> SharedInk:
        """What was felt within it."""
        return SharedInk([inner.run for inner in self.inked])

    def _bows(self, pairs: Sequence[Pair]) -> list[Array]:
        """Cubics from legs to their partners, (n, 2) mm."""
        return [
            bow(one.end_mm, one.heading_rad, onto.end_mm, onto.heading_rad)
            for one, onto in ((self.legs[a], self.legs[b].turned_round()) for a, b in pairs)
        ]

    @cached_property
    def ink(self) -> SharedInk | None:
        """Its own ink and the ways through it; None if nothing is known of it."""
        if not self.inked and not self.solution.corners:
            return None
        vertices = [self.solution.corners.get(pair) for pair in self.pairs]
        ways = [
            self._over(pair, places) for pair, places in zip(self.pairs, vertices, strict=True)
        ]
        return replace(self._inked, ways=ways, vertices=vertices)

    def _over(self, pair: Pair, vertices: Array | None) -> Array:
        """The way from a leg over vertices to its partner, (n, 2) mm; without any as it is redrawn."""
        if vertices is None:
            return self._bows([pair])[0]
        one, onto = self.legs[pair[0]], self.legs[pair[1]].turned_round()
        stands = one.end_mm, one.heading_rad
        if not len(vertices):
            return hermite(*stands, onto.end_mm, onto.heading_rad)
        return np.vstack(stretches_over(stands, one, vertices, onto))

    @cached_property
    def ways_mm(self) -> list[Array]:
        """The ways of the lines that pass, from clean end to clean end, (n, 2) mm."""
        if self.drawn is None:
            return self._solved.ways_mm
        return [self.way(pair) for pair in self.pairs]

    @cached_property
    def passing_mm(self) -> Array:
        """Places of the lines that pass, (n, 2) mm."""
        return np.vstack([NOWHERE, *self.ways_mm])

    @cached_property
    def ends_mm(self) -> dict[int, float]:
        """How far beyond their clean ends legs without a partner end that come onto others, mm."""
        if not self.pairs:
            return self._tips
        if self.drawn is None:
            return self._solved.ends_mm
        alone = without_partner(self.pairs, len(self.legs))
        loose = [Loose(self.views[k], self.legs[k], self.near[k]) for k in alone]
        passing = (self.near[k] for k in range(len(self.legs)) if k not in alone)
        lines_mm = np.vstack([self.passing_mm, *passing])
        key = tuple(alone), lines_mm.tobytes()
        if key not in self._ended:
            self._ended[key] = ends_in_ink_mm(loose, lines_mm)
        found = zip(alone, self._ended[key], strict=True)
        return {k: end_mm for k, end_mm in found if end_mm is not None}

    def end_mm(self, k: int) -> float:
        """How far beyond its clean end a leg without a partner ends, mm."""
        if (end_mm := self.ends_mm.get(k)) is not None:
            return end_mm
        leg = self.legs[k]
        on_mm = float((meeting_place(self.legs) - leg.end_mm) @ direction(leg.heading_rad))
        inked_mm = reach_of_ink(self.views[k], leg, max(on_mm, 0.0) + leg.width_mm)
        return max(0.0, on_mm if inked_mm is None else min(on_mm, inked_mm))

    @cached_property
    def _tips(self) -> dict[int, float]:
        """How far beyond their legs two lines end in each other's ink; none if they are one with a tip."""
        if len(self.legs) != 2 or not self.inked or not are_side_by_side(*self.legs):
            return {}
        one, other = self.legs
        two = zip(self.views, self.legs, strict=True)
        ends_mm = ends_in_ink_mm(
            [Loose(*each, NOWHERE) for each in two], NOWHERE, are_tips=True
        )
        if ends_mm[0] is None or ends_mm[1] is None:
            return {}
        apart_mm = math.dist(one.at(ends_mm[0]), other.at(ends_mm[1]))
        is_one = apart_mm < APART * one.width_mm
        return {} if is_one else {0: ends_mm[0], 1: ends_mm[1]}

    @cached_property
    def _ways(self) -> Neighbours | None:
        """Places of all lines in it."""
        ended = [
            self.legs[k].at(np.arange(0.0, mm, EVERY_MM)) for k, mm in self.ends_mm.items()
        ]
        places = np.vstack([self.passing_mm, *ended])
        return Neighbours(places) if len(places) else None

    def covers(self, inner: Inner) -> bool:
        """Whether lines in it go along a stretch within it."""
        if self._ways is None:
            return False
        if inner.stretch not in self._covers:
            away_mm, _ = self._ways.nearest(inner.run.places_mm)
            share = float(np.mean(away_mm < COVERED * self.legs[0].width_mm))
            self._covers[inner.stretch] = share > COVERED_SHARE
        return self._covers[inner.stretch]

    def way(self, pair: Pair) -> Array:
        """The way of a pair through it, (n, 2) mm."""
        one, other = self.legs[pair[0]], self.legs[pair[1]].turned_round()
        view = self.views[pair[0]]
        stands = one.end_mm, one.heading_rad
        planner = Planner(view, stands, Trail(one.end_mm, view.step_mm), self.settings)
        return np.vstack(way_through(planner, (one, other), None, self.ink))
