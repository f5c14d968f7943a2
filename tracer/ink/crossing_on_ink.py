"""Crossings on their ink: where the ways that legs tell leave a crossing's ink, others are held against it.

    ────────┬────       the corner of one line lies in the ink of another: its legs meet beside the place
       ╱    │           where all lines meet, and how they go on is told by the ink that a pen would leave

A pen along all ways through a crossing, along its legs and the ends of lines without a partner is held
against the ink there. Where it leaves ink for a third of a line's width, or draws as much on paper, other
pairs are tried, the likeliest first, with a corner wherever two legs meet in ink; corners move to where the
pen leaves least. What explains the ink goes before what the legs tell. Not where lines are of several widths,
as those of letters are, nor on scans whose pixels were made finer, or of pencil: their ink shows no pen, and
blots and arrowheads were run to and fro.

Where the ways that legs tell explain the ink, others may do so about as well: a corner in another line's ink
leaves what two ends there leave, and what two lines leave that bend within it. Of these the lines go on that
turn least: two that go straight on and one with a corner go before three that bend.

Signals: a crossing in; its pairs, and the corners between them, out.

Four legs of one pen that turn are redrawn over as many vertices as it takes instead, if that explains their
ink (see `redrawn_crossing`).

Source: our own; the pen and how corners move are those of `tangles`, whose lines have no legs of their own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.head.course import on_ink
from morfax.tracer.ink.crossing_ink import CrossingInk, WaysOn, ended_mm
from morfax.tracer.ink.partners import (
    CORNERED,
    MOST_LEGS,
    SMOOTHLY,
    Pair,
    likeliest,
    pairs_cost,
    turnings,
    without_partner,
)
from morfax.tracer.ink.redrawn_crossing import AS_WELL
from morfax.tracer.junctions.corner import Corner
from morfax.tracer.tangles.redrawing import STROKE, VERTEX

if TYPE_CHECKING:
    from morfax.tracer.ink.crossing import Crossing

# All limits below were chosen by trial on crowded sheets of lines, circles and rectangles.
OFF = 0.08  # widths², in a box as wide as a line: of crossings that are right to 0.1 mm none comes above
MUCH = 0.3  # widths²: so much less is left by what explains not all of the ink, and is better all the same
TRIED = 5  # pairings
FEWEST_LEGS = 4  # of which more than one may go on in another way than the others
PLAIN = math.radians(6)  # lines that turn by less, all of which go on, are plain


@dataclass(frozen=True)
class AsDrawn:
    """A crossing as it would be drawn: what its pen leaves, and draws on paper, of the ink about it."""

    crossing: Crossing
    ink: CrossingInk

    @cached_property
    def ways(self) -> list[Array]:
        """The ways through it, and the ends of lines without a partner, (n, 2) mm."""
        return [*self.crossing.ways_mm, *ended_mm(self.crossing)]

    @cached_property
    def _wrong(self) -> Array:
        return self.ink.wrong(self.ways)

    @property
    def off(self) -> float:
        """By how much it is off the ink in the worst box as wide as a line, widths²."""
        return self.ink.worst(self._wrong)

    @property
    def cost(self) -> float:
        """What is wrong in all, and the price of its corners and of lines that end in it, widths²."""
        pairs, corners = self.crossing.solution
        effort = float(sum(map(len, corners.values())))
        effort += STROKE * (len(self.crossing.legs) - 2 * len(pairs))
        return self.ink.left(self._wrong) + VERTEX * effort


def told_by_ink(crossing: Crossing, told: WaysOn) -> WaysOn:
    """How lines go on through a crossing: as the legs tell, or otherwise, if that explains the ink."""
    if not 3 <= len(crossing.legs) <= MOST_LEGS or _is_plain(crossing, told):
        return told
    view = crossing.views[0]
    if view.parted > 1 or view.grainy or not crossing.is_of_one_pen:
        return told  # no pen is told by such ink
    by_legs = crossing.as_drawn(told)
    # where no line passes, and nothing was felt, lines that turn lie in the ink between its legs
    is_known = bool(told.pairs or crossing.inked)
    ink = CrossingInk.about(crossing, by_legs.ways_mm if is_known else _turns(crossing))
    now = AsDrawn(by_legs, ink)
    if ink.is_empty:
        return told
    if now.off < OFF:
        return _straightest(now, told)
    tried = [AsDrawn(crossing.as_drawn(drawn), ink) for drawn in _others(crossing, told, ink)]
    best = min(tried, key=lambda each: each.cost, default=now)
    gain = 0.0 if best.off < OFF else MUCH
    if best.off < now.off and best.cost < now.cost - gain:
        return best.crossing.solution
    return told


def _turns(crossing: Crossing) -> list[Array]:
    """The ways over the corners of any two legs that may be one line, (n, 2) mm."""
    legs = crossing.legs
    costs = turnings(legs, crossing.width_mm, crossing.views[0])
    ways = list[Array]()
    for a, b in np.argwhere(np.triu(np.isfinite(costs))).tolist():
        if (corner := Corner.of(legs[a], legs[b].turned_round())) is not None:
            ways.append(np.vstack([legs[a].end_mm, corner.vertex_mm, legs[b].end_mm]))
    return ways


def _straightest(now: AsDrawn, told: WaysOn) -> WaysOn:
    """How lines go on through a crossing whose ink they explain: as they turn least, of all ways that explain
    it about as well. Two lines that would end beside each other are one with a corner.
    """
    crossing, ink = now.crossing, now.ink
    if len(crossing.legs) < FEWEST_LEGS:
        return told
    costs = turnings(crossing.legs, crossing.width_mm, crossing.views[0])
    alone = without_partner(told.pairs, len(crossing.legs))
    if len(alone) > 1:
        joined = likeliest(costs[np.ix_(alone, alone)], TRIED)
        more = [tuple((alone[a], alone[b]) for a, b in pairs) for pairs in joined]
        ways = [tuple(sorted((*told.pairs, *pairs))) for pairs in more if pairs]
    elif any(crossing.turnings_rad[pair] > PLAIN for pair in told.pairs):
        ways = [told.pairs, *likeliest(costs, TRIED)]
    else:
        return told
    others = [_cornered(crossing, pairs, ink) for pairs in dict.fromkeys(ways)]
    tried = [AsDrawn(crossing.as_drawn(drawn), ink) for drawn in others if drawn is not None]
    right = [now, *(each for each in tried if each.off < OFF)]
    least = min(each.cost for each in right)
    as_good = [each for each in right if each.cost < least + AS_WELL]
    best = min(as_good, key=lambda each: (_turned(each.crossing.solution, costs), each.cost))
    return best.crossing.solution


def _turned(way: WaysOn, turnings_rad: Array) -> float:
    """By how much lines turn that go on so, rad²; one that has a corner turns as one does at least."""
    costs = turnings_rad.copy()
    for pair in way.corners:
        costs[pair] = max(costs[pair], CORNERED)
    return pairs_cost(way.pairs, costs)


def is_one_with_a_tip(crossing: Crossing, pair: Pair) -> bool:
    """Whether two legs that come in side by side explain their ink as one line with a corner, and not as two
    that end there.
    """
    ends = crossing.as_drawn(WaysOn((), {}))
    one = crossing.as_drawn(WaysOn((pair,), {}))
    ink = CrossingInk.about(crossing, one.ways_mm)
    if ink.is_empty or AsDrawn(ends, ink).off < OFF:
        return False
    cornered = _cornered(crossing, (pair,), ink)
    return cornered is not None and AsDrawn(crossing.as_drawn(cornered), ink).off < OFF


def is_explained(crossing: Crossing) -> bool:
    """Whether a pen along the ways of a crossing leaves its ink."""
    ink = CrossingInk.about(crossing, crossing.ways_mm)
    return ink.is_empty or AsDrawn(crossing, ink).off < OFF


def _is_plain(crossing: Crossing, told: WaysOn) -> bool:
    """Whether all lines of a crossing go straight on."""
    costs = crossing.turnings_rad
    return 2 * len(told.pairs) == len(crossing.legs) and all(
        costs[pair] < PLAIN for pair in told.pairs
    )


def _others(crossing: Crossing, told: WaysOn, ink: CrossingInk) -> Iterator[WaysOn]:
    """Other ways to go on, with their corners where these explain the ink best."""
    legs, view = crossing.legs, crossing.views[0]
    costs = turnings(legs, crossing.width_mm, view)
    for pairs in dict.fromkeys([told.pairs, *likeliest(costs, TRIED)]):
        if (drawn := _cornered(crossing, pairs, ink)) is not None:
            yield drawn


def _cornered(crossing: Crossing, pairs: tuple[Pair, ...], ink: CrossingInk) -> WaysOn | None:
    """Ways to go on with a corner wherever two legs turn, where it explains the ink best; None if it leads
    over paper.
    """
    legs, corners = crossing.legs, dict[Pair, Array]()
    for a, b in pairs:
        corner = Corner.of(legs[a], legs[b].turned_round())
        if corner is not None and corner.deflection_rad > SMOOTHLY:
            corners[a, b] = corner.vertex_mm[None]
    drawn = WaysOn(pairs, corners)
    if not corners:
        return drawn
    drawn = ink.settled(crossing, drawn)
    some = crossing.as_drawn(drawn)
    ways = [way for pair, way in zip(pairs, some.ways_mm, strict=True) if pair in corners]
    return drawn if all(on_ink(crossing.views[0], [way]) for way in ways) else None
