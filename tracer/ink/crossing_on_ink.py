"""Crossings on their ink: where the ways that legs tell leave a crossing's ink, others are held against it.

    ────────┬────       the corner of one line lies in the ink of another: its legs meet beside the place
       ╱    │           where all lines meet, and how they go on is told by the ink that a pen would leave

A pen along all ways through a crossing, along its legs and the ends of lines without a partner is held
against the ink there. Where it leaves ink for a third of a line's width, or draws as much on paper, other
pairs are tried, the likeliest first, with a corner wherever two legs meet in ink; corners move to where the
pen leaves least. Where none of these explains the ink partners are exchanged, step by step (see `exchanges`).
What explains the ink goes before what the legs tell. Not where lines are of several widths,
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
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import direction, meeting
from morfax.motion.polyline import nearest_mm
from morfax.tracer.head.course import on_ink
from morfax.tracer.ink.astray import astray
from morfax.tracer.ink.crossing_ink import REACH, CrossingInk, WaysOn, ended_mm
from morfax.tracer.ink.exchanges import Pairs, exchanges
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
from morfax.tracer.sensing.leg import turn
from morfax.tracer.tangles.redrawing import STROKE, VERTEX

if TYPE_CHECKING:
    from morfax.tracer.ink.crossing import Crossing

# All limits below were chosen by trial on crowded sheets of lines, circles and rectangles.
OFF = 0.08  # widths², in a box as wide as a line: of crossings that are right to 0.1 mm none comes above
MUCH = 0.3  # widths²: so much less is left by what explains not all of the ink, and is better all the same
TRIED = 5  # pairings, and as many from which partners are exchanged
FEWEST_LEGS = 4  # of which more than one may go on in another way than the others
# widths: two legs that meet far off turn where their lines meet, or at both ends of a side between them, so
# far before each would end alone: there a side is within the ink of a line that passes
BACK = None, 0.0, 0.5
FLAT = math.sin(SMOOTHLY)  # of two lines that meet nowhere
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

    @cached_property
    def off(self) -> float:
        """By how much it is off the ink in the worst box as wide as a line, widths²."""
        return self.ink.worst(self._wrong)

    @property
    def legs_about_worst(self) -> set[int]:
        """The legs of the lines that come by the worst of these boxes, or would if they went on."""
        crossing, place_mm = self.crossing, self.ink.worst_at_mm(self._wrong)
        legs, alone = crossing.legs, without_partner(crossing.pairs, len(crossing.legs))
        reach_mm = np.ptp([leg.end_mm for leg in legs], axis=0).max()
        ahead_mm = np.arange(0.0, reach_mm, 0.5 * crossing.width_mm)
        ways = list[tuple[tuple[int, ...], Array]](
            zip(crossing.pairs, crossing.ways_mm, strict=True)
        )
        ways += [((k,), legs[k].at(ahead_mm)) for k in alone]
        near_mm = REACH * crossing.width_mm
        return {
            leg
            for some, way in ways
            for leg in some
            if nearest_mm(place_mm[None], way)[0] < near_mm
        }

    @cached_property
    def cost(self) -> float:
        """What is wrong in all, and the price of its corners, also astray, and of lines that end, widths²."""
        pairs, corners = self.crossing.solution
        effort = float(sum(map(len, corners.values())))
        effort += STROKE * (len(self.crossing.legs) - 2 * len(pairs))
        effort += astray(self.crossing)
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
    costs = turnings(crossing.legs, crossing.width_mm, view)
    others = _others(crossing, told, ink, costs)
    tried = [AsDrawn(crossing.as_drawn(drawn), ink) for drawn in others]
    # of an odd number of legs one may be two lines that run together (see `solving`)
    known = [now, *tried]
    is_even = len(crossing.legs) % 2 == 0
    best = min(known, key=lambda each: each.cost)
    if is_even and (other := _exchanged(known, costs)).off < OFF:
        all_go_on = not without_partner(other.crossing.pairs, len(crossing.legs))
        best = other if all_go_on else best
    gain = 0.0 if best.off < OFF else MUCH
    if best.off >= now.off or best.cost >= now.cost - gain:
        return told
    drawn = best.crossing.solution
    return _straightest(best, drawn) if best.off < OFF else drawn


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
    joined = likeliest(costs[np.ix_(alone, alone)], TRIED)
    more = [tuple((alone[a], alone[b]) for a, b in pairs) for pairs in joined]
    ways = [tuple(sorted((*told.pairs, *pairs))) for pairs in more if pairs]
    if any(crossing.turnings_rad[pair] > PLAIN for pair in told.pairs):
        ways += [told.pairs, *likeliest(costs, TRIED)]
    if not ways:
        return told
    others = [_cornered(crossing, pairs, ink, costs) for pairs in dict.fromkeys(ways)]
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
    cornered = _cornered(crossing, (pair,), ink, np.zeros((2, 2)))
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


def _others(
    crossing: Crossing, told: WaysOn, ink: CrossingInk, costs: Array
) -> Iterator[WaysOn]:
    """Other ways to go on, with their corners where these explain the ink best."""
    for pairs in dict.fromkeys([told.pairs, *likeliest(costs, TRIED)]):
        if (drawn := _cornered(crossing, pairs, ink, costs)) is not None:
            yield drawn


def _exchanged(known: Sequence[AsDrawn], costs: Array) -> AsDrawn:
    """The way for the lines of a crossing to go on that costs least, partners exchanged step by step from
    some known ways, the cheapest first, until one that explains all ink is cheaper than all beside it.
    """
    crossing, ink = known[0].crossing, known[0].ink
    found = {each.crossing.solution.pairs: each for each in known}
    left = list(found.values())
    for _ in range(TRIED):
        here = min(left, key=lambda each: each.cost, default=None)
        least = min(found.values(), key=lambda each: each.cost)
        if here is None or (least is not here and least.off < OFF):
            break
        left.remove(here)
        pairs_here = here.crossing.solution.pairs
        for pairs in exchanges(pairs_here, np.isfinite(costs), here.legs_about_worst):
            if pairs not in found and (drawn := _cornered(crossing, pairs, ink, costs)):
                found[pairs] = AsDrawn(crossing.as_drawn(drawn), ink)
                left.append(found[pairs])
    return min(found.values(), key=lambda each: each.cost)


def _cornered(
    crossing: Crossing, pairs: Pairs, ink: CrossingInk, costs: Array
) -> WaysOn | None:
    """Ways to go on with corners wherever two legs turn, where they explain the ink best; None if they lead
    over paper.
    """
    has_far = not all(math.isfinite(costs[pair]) for pair in pairs)
    tried = list[AsDrawn]()
    for back in BACK if has_far else BACK[:1]:
        drawn = WaysOn(pairs, _corners(crossing, pairs, costs, back))
        if not drawn.corners:
            return drawn
        tried.append(AsDrawn(crossing.as_drawn(ink.settled(crossing, drawn)), ink))
        if astray(tried[-1].crossing) > 1:
            tried.append(AsDrawn(crossing.as_drawn(drawn), ink))
    some = min(tried, key=lambda each: each.cost).crossing
    corners = some.solution.corners
    ways = [way for pair, way in zip(pairs, some.ways_mm, strict=True) if pair in corners]
    is_inked = all(on_ink(crossing.views[0], [way]) for way in ways)
    return some.solution if is_inked else None


def _corners(
    crossing: Crossing, pairs: Pairs, costs: Array, back: float | None
) -> dict[Pair, Array]:
    """The corners (n, 2) mm of those pairs whose legs turn: where they meet; of legs that meet far off, or
    nowhere, that place, or the ends of a side between them, so many widths before each would end alone.
    """
    corners = dict[Pair, Array]()
    for pair in pairs:
        one, other = (crossing.legs[k] for k in pair)
        corner = Corner.of(one, other.turned_round())
        if math.isfinite(costs[pair]):
            if corner is not None and corner.deflection_rad > SMOOTHLY:
                corners[pair] = corner.vertex_mm[None]
        elif back is None and abs(math.sin(turn(one.heading_rad, other.heading_rad))) > FLAT:
            ways = direction(one.heading_rad), direction(other.heading_rad)
            corners[pair] = meeting(one.end_mm, ways[0], other.end_mm, ways[1])[None]
        else:
            apart = crossing.as_drawn(WaysOn(tuple(some for some in pairs if some != pair), {}))
            back_mm = (back or 0.0) * crossing.width_mm
            ends = [crossing.legs[k].at(max(apart.end_mm(k) - back_mm, 0.0)) for k in pair]
            corners[pair] = np.array(ends)
    return corners
