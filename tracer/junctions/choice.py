"""The survey of a junction: which leg the head takes out of it.

Straight on at a crossing; on along the only leg at a corner; never onto what has been followed already. A
stroke that ends soon and is not straight on is a mark, and no leg. The operator may ask for a turn to the
left or right. Where a lead line ends square on another line, the head turns left: that is clockwise round a
contour that it comes to from outside.

Signals: the incoming leg and the trail in; the outgoing leg, and the corner that the two make, out.

Source: our own (see `rings`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import CORNER_RAD
from morfax.tracer.head.course import SMOOTH
from morfax.tracer.head.trail import Trail
from morfax.tracer.junctions.corner import Corner
from morfax.tracer.junctions.rings import legs_around
from morfax.tracer.limits import NEAR
from morfax.tracer.marks.marks import longest_mm
from morfax.tracer.sensing.leg import STRAIGHT, Leg, goes_straight, turn, turns_off
from morfax.tracer.sensing.probe import END_MM, END_WIDTHS, reach_of_ink, stroke_end
from morfax.tracer.sensing.side import Side
from morfax.tracer.sensing.view import View

# Chosen by trial on the test drawings.
BESIDE = 0.35  # of the width: they lie on one line
# widths ahead where a line is sought that turns back to a side: at first its ink runs along with the way in
SIDEWAYS_WIDTHS = (0.0, 1.0, 2.0)
# a lead line may be drawn so far beyond the contour's edge
OVERRUN_MM, OVERRUN_WIDTHS = 1.5, 2.0
LOOKS = 3  # about a place, and then about the vertex found there


class Asked(NamedTuple):
    """How the head is to leave a junction.

    `rank` 1 asks for the second straightest leg, `side` for the straightest that turns off to that side, if
    there is one. A line that `leads` ends at the line that it comes to, though the pen ran on a little.
    `straight` asks for the straightest leg whatever else is there: the operator has said so.
    """

    rank: int = 0
    side: Side | None = None
    leads: bool = False
    straight: bool = False


STRAIGHTEST = Asked()


class Choice(NamedTuple):
    """The leg by which the head leaves a junction, None if no leg leads on, and its corner with the way in.

    `choices` says how many legs there were, and 1 more where one was left out because it had been followed.
    """

    leg: Leg | None
    corner: Corner | None
    choices: int


@dataclass(frozen=True, slots=True)
class WayIn:
    """The way into a junction: how the line is seen, its leg, the trail, and legs found about places there.

    Several surveys of one junction look about the same places: their legs are felt once, and how far each
    reaches.
    """

    view: View
    incoming: Leg
    trail: Trail
    _felt: dict[tuple[float, float], list[Leg]] = field(default_factory=dict)
    # by the leg itself, which is kept: another that is made later may be at its place
    _reaches_mm: dict[int, tuple[Leg, float]] = field(default_factory=dict)

    def legs_around(self, centre: Array) -> list[Leg]:
        """The clean legs that leave a place (see `rings`), but for the way in, and those of other lines."""
        place = float(centre[0]), float(centre[1])
        if place not in self._felt:
            way_in = np.vstack([self.trail.recent(), self.incoming.seen[:, :2]])
            legs = legs_around(self.view, centre, way_in)
            self._felt[place] = [leg for leg in legs if not self.view.is_others(leg.end_mm)]
        return self._felt[place]

    def reach_mm(self, leg: Leg) -> float:
        """How far one of these legs reaches beyond the edge of the incoming line, mm; infinite if it is no
        mark.
        """
        if id(leg) not in self._reaches_mm:
            self._reaches_mm[id(leg)] = leg, self._felt_reach_mm(leg)
        return self._reaches_mm[id(leg)][1]

    def _felt_reach_mm(self, leg: Leg) -> float:
        """The same, as it is felt."""
        end = stroke_end(self.view, leg, longest_mm(self.view))
        if end is None:
            return math.inf
        way = leg.end_mm - self.incoming.end_mm
        heading = self.incoming.heading_rad
        aside = abs(way[1] * math.cos(heading) - way[0] * math.sin(heading))
        return float(end + aside - 0.5 * self.view.width_mm)


def survey(way_in: WayIn, asked: Asked = STRAIGHTEST) -> Choice:
    """Choose the leg by which the head leaves the junction ahead of a leg.

    Rings stand where the line stops being clean. If it does not go straight on from there, they also stand
    where the ink ahead ends: at the tip of a sharp corner.
    """
    view, incoming = way_in.view, way_in.incoming
    half = 0.5 * view.width_mm
    near = half + view.step_mm
    ink = reach_of_ink(view, incoming, END_WIDTHS * view.width_mm + END_MM)
    around = _Survey(way_in, asked)
    # 1. where the line stops being clean
    begin = near if ink is None else max(0.0, min(near, ink - half))
    found = around.look(incoming.at(begin))
    # 2. further ahead, for the side that is asked for
    if asked.side is not None:
        for widths in SIDEWAYS_WIDTHS:
            aside = around.look(incoming.at(near + widths * view.width_mm))
            if aside.leg is not None and is_aside(incoming, aside.leg, asked.side):
                return aside
    # 3. at the tip
    if ink is not None and ink - half > near and not goes_straight(incoming, found.leg):
        at_tip = around.look(incoming.at(ink - half))
        if at_tip.leg is not None:
            return at_tip._replace(choices=max(found.choices, at_tip.choices))
    return found


@dataclass(frozen=True, slots=True)
class _Survey:
    """What a junction is surveyed by: the way in, and how the head is to leave."""

    way_in: WayIn
    asked: Asked

    @property
    def view(self) -> View:
        """How the line is seen."""
        return self.way_in.view

    @property
    def incoming(self) -> Leg:
        """The leg of the way in."""
        return self.way_in.incoming

    def look(self, centre: Array) -> Choice:
        """Choose among the legs about a centre, and then about the vertex, until that stays."""
        view, incoming, trail = self.view, self.incoming, self.way_in.trail
        leg, corner, count = None, None, 0
        for _ in range(LOOKS):
            every = self.way_in.legs_around(centre)
            every = self._without_overrun(every) if self.asked.leads else every
            every = self._without_marks(every)
            new = [leg for leg in every if not trail.holds(leg, view.width_mm)]
            new = self._without_stubs(new, every)
            count = max(count, len(new) + (len(new) < len(every)))
            if not new:
                break
            leg = self._chosen(new, every)
            corner = Corner.of(incoming, leg)
            if corner is None or corner.beyond_mm < -view.width_mm:
                break
            if np.hypot(*(corner.vertex_mm - centre)) < NEAR * view.width_mm:
                break
            centre = corner.vertex_mm
        return Choice(leg, corner, count)

    def _chosen(self, legs: list[Leg], every: list[Leg]) -> Leg:
        """The leg to take: by side, if one turns off there; else by how straight it goes on."""
        rank, side = self.asked.rank, self.asked.side
        # 1. by side
        if side is not None:
            aside = [leg for leg in legs if is_aside(self.incoming, leg, side)]
            if aside:
                return min(aside, key=lambda leg: abs(self._turn(leg)))
        # 2. by how straight
        if self.asked.straight:
            return min(legs, key=lambda leg: abs(self._turn(leg)))
        if rank == 0:
            legs = self._without_passing(legs, every) or legs
        legs = sorted(legs, key=lambda leg: abs(self._turn(leg)))
        # 3. left, where the line comes square to another
        if rank == 0 and len(legs) > 1:
            one = self._turn(legs[0])
            other = self._turn(legs[1])
            if abs(one) > STRAIGHT and abs(one + other) < CORNER_RAD:
                return max(legs[:2], key=self._turn)
        return legs[min(rank, len(legs) - 1)]

    def _turn(self, leg: Leg) -> float:
        """Angle from the way in to a leg, rad, left positive."""
        return turn(self.incoming.heading_rad, leg.heading_rad)

    def _without_marks(self, legs: list[Leg]) -> list[Leg]:
        """The legs but for marks that are not straight on, if others are left."""
        reach_mm = [
            math.inf if goes_straight(self.incoming, leg) else self.way_in.reach_mm(leg)
            for leg in legs
        ]
        kept = []
        for leg, mm in zip(legs, reach_mm, strict=True):
            across = _is_across(leg, legs, reach_mm)
            if mm > longest_mm(self.view, across=across):
                kept.append(leg)
        return kept or legs

    def _without_overrun(self, legs: list[Leg]) -> list[Leg]:
        """The legs but for the end of a lead line drawn beyond the contour.

        That goes straight on and ends soon, and the other legs are a line that passes.
        """
        width_mm = self.view.width_mm
        aside = [leg for leg in legs if not goes_straight(self.incoming, leg)]
        if not _passing(aside):
            return legs
        overrun_mm = max(OVERRUN_MM, OVERRUN_WIDTHS * width_mm)
        return [
            leg
            for leg in legs
            if _is_among(leg, aside) or self.way_in.reach_mm(leg) > overrun_mm
        ]

    def _without_stubs(self, legs: list[Leg], every: list[Leg]) -> list[Leg]:
        """The legs but for marks on what has been followed already, however straight on.

        There the head has come back to its lead line. Where it crosses a line that it has followed, what lies
        beyond is its own, and may end soon.
        """
        held = [leg for leg in every if not _is_among(leg, legs)]
        if not held or _passing(held):
            return legs
        return [leg for leg in legs if self.way_in.reach_mm(leg) > longest_mm(self.view)]

    def _without_passing(self, legs: list[Leg], every: list[Leg]) -> list[Leg]:
        """The legs that are no line that passes here, straighter than any leg goes on from the way in."""
        taken: list[Leg] = []
        for a, b in combinations(every, 2):
            bent = _bent(a, b)
            gap = b.end_mm - a.end_mm
            aside = abs(gap[0] * math.sin(a.heading_rad) - gap[1] * math.cos(a.heading_rad))
            own = min(abs(self._turn(leg)) for leg in (a, b))
            if bent < SMOOTH and aside < BESIDE * self.view.width_mm and own > bent + SMOOTH:
                taken += [a, b]
        return [leg for leg in legs if not _is_among(leg, taken)]


def _is_among(leg: Leg, legs: Sequence[Leg]) -> bool:
    """Whether a leg is one of some, and not only like one of them."""
    return any(leg is other for other in legs)


def _bent(one: Leg, other: Leg) -> float:
    """By how much two legs out of a junction are off one line, rad."""
    return abs(turn(one.heading_rad + math.pi, other.heading_rad))


def _passing(legs: Sequence[Leg]) -> bool:
    """Whether any two legs are about one line."""
    return any(_bent(a, b) < CORNER_RAD for a, b in combinations(legs, 2))


def is_aside(incoming: Leg, leg: Leg, side: Side) -> bool:
    """Whether a leg turns off to a side."""
    to_left = turn(incoming.heading_rad, leg.heading_rad) > 0
    return to_left == (side == "left") and turns_off(incoming, leg)


def _is_across(leg: Leg, legs: list[Leg], reach_mm: list[float]) -> bool:
    """Whether another stroke that ends soon lies in line with a leg, on the other side."""
    return any(
        math.isfinite(mm) and _bent(leg, other) < CORNER_RAD
        for other, mm in zip(legs, reach_mm, strict=True)
    )
