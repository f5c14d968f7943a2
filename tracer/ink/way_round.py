"""Way round: the closed way along a line of a net that leaves partners least.

Signals: the junctions of a net and a line of it in; a closed chain and what it costs out. A way may leave
partners, at a cost:

    smoothly   onto another leg that is nearly in line
    corner     where two legs meet and neither goes on smoothly elsewhere
    crossing   where both go on into lines that stand aside
    end        once: where one of two legs at a corner goes on elsewhere, as where hatching goes on from the
               side of a square

It never leaves a line that goes on for another that goes on, and never goes onto the line of another pen. A
bar that ends on a line at both its ends comes round by two ends, and so never. Nor does it go along a line
that goes straight on beyond both ends of that: a centre line makes no halves of a circle.

Source: our own; E. W. Dijkstra 1959 for the way that costs least.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from heapq import heappop, heappush
from typing import NamedTuple

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.polyline import length_mm
from morfax.tracer.ink.chains import Chain, Junctions, Link, Side
from morfax.tracer.ink.hatching import STRAIGHT
from morfax.tracer.ink.onward import Onward
from morfax.tracer.ink.outlines import Outline, as_outline, turned_by
from morfax.tracer.limits import BACK_RAD
from morfax.tracer.sensing.leg import FACING

# Chosen by trial on synthetic nets: what leaving a partner costs, and what a way may cost in all
# (smoothly also between two legs of which neither goes on elsewhere)
ALONE, CORNER, SMOOTHLY, CROSSING, END, MOST = 0.1, 0.5, 1.0, 1.0, 1.5, 4.0
ENDS = 1  # in a way
# a way that turns by more than BACK_RAD goes back, but for a tip whose sides are so many times as long as the
# ink that they share, and over so long a way bend by less than its angle; circles that touch by twice that
TIP = 10.0

NOT, PAST, CROSSES = 0, 1, 2  # how a line goes straight on where a way leaves it

# the ends of a way so far, how its line goes on straight behind where the way came onto it, and the side of a
# line to which it has come
State = tuple[int, int, Side]


class _Onward(NamedTuple):
    """A side onto which a line may go on, what it costs, and whether it is an end; and how the line that is
    left goes straight on there, into whatever, and the other one behind it: not, past an end, or crossing.
    """

    cost: float
    is_end: bool
    side: Side
    beyond: int = NOT
    behind: int = NOT
    bends: bool = False  # at a corner of one line


class FoundWay(NamedTuple):
    """A closed way, what it costs, and how many ends it has."""

    cost: float
    ends: int
    way: Outline


@dataclass
class Search:
    """The search for closed ways along lines of a net."""

    junctions: Junctions
    onward: Onward  # without lines aside
    straight: Onward  # into whatever
    _known: dict[Side, list[_Onward]] = field(default_factory=dict)

    def way(self, number: int) -> FoundWay | None:
        """The closed way along a line that costs least; None if there is none."""
        goal, begin = Side(number, False), (0, NOT, Side(number, True))
        heap: list[tuple[float, State, State | None]] = [(0.0, begin, None)]
        before = dict[State, State | None]()
        while heap:
            cost, state, came_by = heappop(heap)
            if state in before:
                continue
            before[state] = came_by
            ends, behind, far = state
            if far == goal:
                return self._found(cost, state, before)
            for on in self._onward(far):
                near = on.side
                onto = near if near == goal else Side(near.line, not near.last)
                is_back = near.line == number and near != goal
                if is_back or _is_chord(behind, on):
                    continue
                if cost + on.cost <= MOST and ends + on.is_end <= ENDS:
                    then = ends + on.is_end, self._behind(behind, on), onto
                    heappush(heap, (cost + on.cost, then, state))
        return None

    def _found(
        self, cost: float, state: State, before: dict[State, State | None]
    ) -> FoundWay | None:
        """The way that came to a state; None if it goes along a line twice."""
        links, at = list[Link](), before[state]
        while at is not None:
            _, _, far = at
            links.append(Link(far.line, not far.last))
            at = before[at]
        chain = Chain(links[::-1], True)
        if len({link.line for link in links}) < len(links) or self.cost(chain) == math.inf:
            return None
        return FoundWay(cost, state[0], as_outline(chain, self.junctions))

    def cost(self, chain: Chain) -> float:
        """What a closed chain costs; infinite if it goes on at a junction as no way may, or goes along a line
        that goes straight on beyond both ends of that.
        """
        onward = [*chain.links[1:], chain.links[0]]
        cost, behind = 0.0, NOT
        for again in (False, True):  # once more round, for the line with which it begins
            for link, onto in zip(chain.links, onward, strict=True):
                on = self._turn(link, onto)
                if on is None or _is_chord(behind, on):
                    return math.inf
                cost += 0.0 if again else on.cost
                behind = self._behind(behind, on)
        return cost

    def keeps_to_lines(self, chain: Chain) -> bool:
        """Whether a closed chain never leaves a line that goes on for another that goes on."""
        goes_on, onward = self.onward.goes_on, [*chain.links[1:], chain.links[0]]
        turns = (
            (_far(link), Side(*onto)) for link, onto in zip(chain.links, onward, strict=True)
        )
        return all(
            self.junctions.at(far).partner(far) == near or not (goes_on(far) and goes_on(near))
            for far, near in turns
        )

    def _behind(self, behind: int, on: _Onward) -> int:
        """How a way's line goes straight on behind where the way came onto it; not, if it has bent since."""
        if on.bends or on.side.line not in self._straight_lines:
            return NOT
        return behind if on.cost == 0.0 else on.behind

    @cached_property
    def _straight_lines(self) -> set[int]:
        """The lines, by their numbers, that are straight."""
        places = [line.places_mm for line in self.junctions.net.lines]
        return {n for n, way in enumerate(places) if _is_straight(way)}

    def _turn(self, link: Link, onto: Link) -> _Onward | None:
        """How a way goes on from one line into another with the least cost; None if it may not."""
        found = [on for on in self._onward(_far(link)) if on.side == (onto.line, onto.back)]
        return min(found, key=lambda on: on.cost, default=None)

    def _onward(self, far: Side) -> list[_Onward]:
        """The sides onto which a line may go on from one of its sides."""
        if far not in self._known:
            there = self.junctions.at(far)
            if len(there.sides) == 2:
                partner = there.partner(far)
                found = []
                if partner is not None:
                    turned = turned_by(there.leg(far), there.leg(partner).turned_round())
                    found.append(_Onward(0.0, False, partner, bends=turned > FACING))
            else:
                left = [
                    near
                    for near in there.sides
                    if near != far and near.line not in self.onward.aside
                ]
                others = (self._onto(far, near) for near in left)
                found = [onto for onto in others if onto is not None]
            self._known[far] = found
        return self._known[far]

    def _onto(self, far: Side, near: Side) -> _Onward | None:
        """How a way goes on from one side at a junction onto another; None if it may not."""
        there = self.junctions.at(far)
        one, other = there.leg(far), there.leg(near).turned_round()
        turned = turned_by(one, other)
        if turned > BACK_RAD and not self._is_tip(far, near, turned):
            return None
        if self.onward.are_of_two_pens(far, near):
            return None
        are_alone = sum(side.line not in self.onward.aside for side in there.sides) == 2
        go_on = self.onward.goes_on(far) + self.onward.goes_on(near)
        if turned < FACING:
            is_straight = are_alone or near == there.partner(far)
            return _Onward(0.0 if is_straight else SMOOTHLY if go_on else ALONE, False, near)
        if near == there.partner(far):
            return _Onward(CORNER, False, near)
        return self._turned(far, near, go_on, are_alone)

    def _is_tip(self, far: Side, near: Side, turned: float) -> bool:
        """Whether two lines are so long, and so straight, that they show a sharp tip: of lobes in a ring, and
        not of hatching in a wall, or of lines that touch.
        """
        there, lines = self.junctions.at(far), self.junctions.net.lines
        legs, tip = [there.leg(far), there.leg(near)], max(math.pi - turned, NOT_ZERO)
        shared_mm = 0.5 * legs[0].width_mm / math.sin(0.5 * tip)
        bend = max(abs(leg.bend_per_mm) for leg in legs)
        is_long = min(lines[side.line].length_mm for side in (far, near)) > TIP * shared_mm
        return is_long and bend * TIP * shared_mm < tip

    def _turned(self, far: Side, near: Side, go_on: int, are_alone: bool) -> _Onward | None:
        """How a way turns at a corner, at which some of its two lines go on elsewhere."""
        beyond, behind = (self.straight.goes_on(side) for side in (far, near))
        crosses = beyond and behind
        if go_on == 2:
            return None
        cost = END if go_on else ALONE if are_alone else CORNER
        how = (CROSSES, CROSSES) if crosses else (PAST * beyond, PAST * behind)
        return _Onward(cost + crosses * CROSSING, go_on > 0, near, *how)


def _is_chord(behind: int, on: _Onward) -> bool:
    """Whether a line goes straight on beyond both ends of where a way goes along it, and crosses it once."""
    return NOT not in (behind, on.beyond) and CROSSES in (behind, on.beyond)


def _is_straight(way: Array) -> bool:
    """Whether a way's ends are about as far apart as it is long."""
    return math.dist(way[0], way[-1]) > STRAIGHT * length_mm(way)


def _far(link: Link) -> Side:
    """The side of a line to which a chain comes along it."""
    return Side(link.line, not link.back)
