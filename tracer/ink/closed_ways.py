"""Closed ways: the lines of a net that come round, told by its junctions.

Signals: the junctions of a net in; closed chains of its lines out, those that go straight on first.

    ╭───╮ ╱      the partners of all junctions make closed chains. Where other lines touch a line, a wrong
    │   │╱       partner breaks its chain: so along each line that is left the closed way is looked for that
    ╰───╯        leaves partners least. Last come the ways round what only bars join to the rest

A way counts if most of it is along no other before it. It may leave partners, at a cost:

    smoothly   onto another leg that is nearly in line
    corner     where two legs meet and neither goes on smoothly elsewhere
    end        once, and only if hardly any of the way is along others: where one of two legs at a corner goes
               on elsewhere, as where hatching goes on from the side of a square

It never leaves a line that goes on for another that goes on, and never goes onto the line of another pen. A
bar that ends on a line at both its ends comes round by two ends, and so never.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from heapq import heappop, heappush
from typing import NamedTuple

from morfax.tracer.ink.chains import Chain, Junction, Junctions, Link, Side
from morfax.tracer.ink.outlines import (
    Outline,
    as_outline,
    parts,
    straight_chains,
    turned_by,
)
from morfax.tracer.sensing.leg import FACING

# Chosen by trial on synthetic nets: what leaving a partner costs, and what a way may cost in all
# (smoothly also between two legs of which neither goes on elsewhere)
ALONE, CORNER, SMOOTHLY, END, MOST = 0.2, 0.5, 1.0, 1.5, 4.0
ENDS = 1  # in a way
NEW_BY_END = 0.9  # of a way with an end is along no other
SHARP = math.radians(150)  # a way that turns by more goes back
OTHER_PEN = 1.35  # times as wide: the two pens of a drawing differ by 1.4 or more (ISO 128)

State = tuple[
    int, Side
]  # the ends of a way so far, and the side of a line to which it has come


class _Onward(NamedTuple):
    """A side onto which a line may go on, what it costs, and whether it is an end."""

    cost: float
    is_end: bool
    side: Side


class _Found(NamedTuple):
    """A closed way, what it costs, and how many ends it has."""

    cost: float
    ends: int
    way: Outline


def closed_ways(junctions: Junctions, taken: set[int], share: float) -> Iterator[Outline]:
    """The closed ways of a net of which more than a share is beside all others, and beside lines of the net
    that are taken.
    """
    taken, search = set(taken), _Search(junctions)

    def is_new(way: Outline, least: float = share) -> bool:
        if share_beside(way.chain, taken, junctions) <= least:
            return False
        taken.update(link.line for link in way.chain.links)
        return True

    # 1. straight on
    yield from filter(is_new, straight_chains(junctions))
    # 2. leaving partners, the least first
    found = [search.way(n) for n in range(len(junctions.net.lines)) if n not in taken]
    by_cost = sorted(filter(None, found), key=lambda it: (it.cost, -it.way.length_mm))
    yield from (it.way for it in by_cost if is_new(it.way, NEW_BY_END if it.ends else share))
    # 3. round what hangs together, and round what does without all these
    yield from filter(is_new, parts(junctions))
    rest = [way for way in parts(junctions, taken) if search.allows(way.chain)]
    yield from filter(is_new, rest)


def share_beside(chain: Chain, taken: set[int], junctions: Junctions) -> float:
    """The share of a chain that is along none of some lines."""
    lengths = {link.line: junctions.net.lines[link.line].length_mm for link in chain.links}
    beside_mm = sum(mm for line, mm in lengths.items() if line not in taken)
    return beside_mm / max(sum(lengths.values()), 1e-9)


@dataclass
class _Search:
    """The search for closed ways along lines of a net."""

    junctions: Junctions
    _known: dict[Side, list[_Onward]] = field(default_factory=dict)

    def way(self, number: int) -> _Found | None:
        """The closed way along a line that costs least; None if there is none."""
        goal, begin = Side(number, False), (0, Side(number, True))
        heap: list[tuple[float, State, State | None]] = [(0.0, begin, None)]
        before = dict[State, State | None]()
        while heap:
            cost, state, came_by = heappop(heap)
            if state in before:
                continue
            before[state] = came_by
            ends, far = state
            if far == goal:
                return self._found(cost, state, before)
            for more, is_end, near in self._onward(far):
                onto = near if near == goal else Side(near.line, not near.last)
                is_back = near.line == number and near != goal
                if not is_back and cost + more <= MOST and ends + is_end <= ENDS:
                    heappush(heap, (cost + more, (ends + is_end, onto), state))
        return None

    def _found(
        self, cost: float, state: State, before: dict[State, State | None]
    ) -> _Found | None:
        """The way that came to a state; None if it goes along a line twice."""
        links, at = list[Link](), before[state]
        while at is not None:
            _, far = at
            links.append(Link(far.line, not far.last))
            at = before[at]
        if len({link.line for link in links}) < len(links):
            return None
        return _Found(cost, state[0], as_outline(Chain(links[::-1], True), self.junctions))

    def allows(self, chain: Chain) -> bool:
        """Whether a closed chain goes on at each junction as ways may."""
        onward = [*chain.links[1:], chain.links[0]]
        return all(
            any(on.side == (onto.line, onto.back) for on in self._onward(_far(link)))
            for link, onto in zip(chain.links, onward, strict=True)
        )

    def _onward(self, far: Side) -> list[_Onward]:
        """The sides onto which a line may go on from one of its sides."""
        if far not in self._known:
            there = self.junctions.at(far)
            if len(there.sides) == 2:
                partner = there.partner(far)
                found = [] if partner is None else [_Onward(0.0, False, partner)]
            else:
                others = (self._onto(far, near) for near in there.sides if near != far)
                found = [onto for onto in others if onto is not None]
            self._known[far] = found
        return self._known[far]

    def _onto(self, far: Side, near: Side) -> _Onward | None:
        """How a way goes on from one side at a junction onto another; None if it may not."""
        there = self.junctions.at(far)
        one, other = there.leg(far), there.leg(near).turned_round()
        turned = turned_by(one, other)
        if turned > SHARP or _are_of_two_pens(there, far, near):
            return None
        go_on = self._goes_on(far) + self._goes_on(near)
        if near == there.partner(far):
            return _Onward(0.0 if go_on else CORNER, False, near)
        if turned < FACING:
            return _Onward(SMOOTHLY if go_on else ALONE, False, near)
        return (_Onward(CORNER, False, near), _Onward(END, True, near), None)[go_on]

    def _goes_on(self, side: Side) -> bool:
        """Whether a line goes on smoothly at one of its sides."""
        there = self.junctions.at(side)
        partner = there.partner(side)
        if partner is None:
            return False
        return turned_by(there.leg(side), there.leg(partner).turned_round()) < FACING


def _far(link: Link) -> Side:
    """The side of a line to which a chain comes along it."""
    return Side(link.line, not link.back)


def _are_of_two_pens(there: Junction, one: Side, other: Side) -> bool:
    """Whether the lines of two sides have other widths, and each is as wide as another line there: ink that
    two lines share is wider, too.
    """
    widths_mm = [there.leg(side).width_mm for side in (one, other)]
    if max(widths_mm) < OTHER_PEN * min(widths_mm):
        return False
    others = [
        leg.width_mm
        for side, leg in zip(there.sides, there.legs, strict=True)
        if side not in (one, other)
    ]
    return all(
        any(max(mm, own) < OTHER_PEN * min(mm, own) for own in others) for mm in widths_mm
    )
