"""Two corners beside one another, as at the root of a gear's tooth, where an arc or one vertex was laid, or
of a step, which was felt as one bend.

    ────────╮ .  vertex      ────────╮           an arc touches both legs; or they end at two places, and a
             ╲   .                   ╲           short side joins them: whichever leaves the ink that is
              ╲     .                 ╰────────  there
               ────────

The short side is hidden between stations that feel a corner, and has no leg. So the two places where the legs
end move to where a pen leaves least unexplained.

Signals: the planner, a corner in what was felt, or the leg beyond, and the way that was laid, or none, in;
the better way out.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import direction, heading_of, left_of
from morfax.motion.polyline import APART_MM, with_places
from morfax.tracer.following.hidden_corner import is_rough
from morfax.tracer.head.course import (
    SMOOTH,
    ahead_mm,
    along_leg,
    nodes_along,
    onto,
    through_nodes,
)
from morfax.tracer.head.plan import Plan
from morfax.tracer.junctions.choice import Choice
from morfax.tracer.junctions.corner import Corner
from morfax.tracer.junctions.felt_corner import (
    LEG_STATIONS,
    FeltCorner,
    corner_of_round,
    is_as_felt,
)
from morfax.tracer.junctions.planner import BEYOND_MM, Planner
from morfax.tracer.limits import ABOUT_WIDTHS, CLEAR_WIDTHS, TIP_RAD
from morfax.tracer.sensing.leg import STRAIGHT, Leg, leg_of, turn
from morfax.tracer.sensing.view import View

if TYPE_CHECKING:
    from morfax.tracer.tangles.likeness import Patch

# Chosen by trial on racks of teeth and on rounds, drawn with known truth.
PLACES = 8  # of a leg, which bends little
STEEP_RAD = np.radians([30.0, 60.0, 90.0])  # sides of a step to begin with


class _Over(NamedTuple):
    """When two corners go before a way round: what it leaves unexplained at the least, what they gain, and
    what they leave at the most, in times of what a pen leaves beside it.
    """

    worse: float
    gain: float
    left: float = math.inf


# on rounds of 0.5 to 2.5 widths two corners gain less than 0.1, and mostly leave more; what is left at a
# right vertex is less than twice as much as beside it
OVER_ARC, OVER_OTHER = _Over(0.0, 0.1), _Over(2.0, 1.0)
# a way along what was felt cuts both corners of a step, and one out of a tangle may have one vertex for both;
# where nothing was felt beyond them, other ink must not be taken for a side
OVER_FELT, OVER_BEFORE = _Over(1.0, 0.05), _Over(1.2, 0.2, left=2.0)


def or_two_corners(planner: Planner, felt: FeltCorner, plan: Plan | None) -> Plan | None:
    """A plan round a corner, or none; instead the way by two corners, if their ink is more like what is
    there.
    """
    view = planner.view
    if is_rough(view, felt.seen):
        return plan
    round_mm = _as_felt(planner, felt) if plan is None else np.vstack(plan.stretches)
    if plan is not None and len(plan.stretches) == 1:
        corner = corner_of_round(view, felt)
        over, sides = OVER_ARC, [] if corner is None else [_cutting(view, corner, round_mm)]
    else:
        over = OVER_FELT if plan is None else OVER_OTHER
        sides = list(_beside_another(view, felt, round_mm))
    found = [_better(planner, side, round_mm, over) for side in sides if side]
    better = [it for it in found if it is not None]
    if not better:
        return plan
    best = max(better, key=lambda it: it.gain)
    two = _plan(planner, best)
    return two if is_as_felt(view, two, felt.seen, max(map(abs, best.turns_rad))) else plan


def or_two_before(planner: Planner, seen: Array, choice: Choice, plan: Plan) -> Plan:
    """A plan onto the one leg beyond what was felt of a line, (n, 3); or the way by two corners, of which the
    line was felt round the first.
    """
    view, outgoing = planner.view, choice.leg
    last = len(seen) - math.ceil(ABOUT_WIDTHS * view.width_mm / view.step_mm)
    if outgoing is None or last < LEG_STATIONS or is_rough(view, seen):
        return plan
    legs = leg_of(seen[:last], True, view.leg_mm), outgoing
    round_mm = np.vstack(plan.stretches)
    sides = _between(view, legs, seen[-1, :2], round_mm)
    two = None if sides is None else _better(planner, sides, round_mm, OVER_BEFORE)
    return plan if two is None else _plan(planner, two)


def _as_felt(planner: Planner, felt: FeltCorner) -> Array:
    """The way (n, 2) that the head takes along what it felt: each place is averaged over some of the line."""
    nodes, _ = nodes_along(planner.view, planner.stands, felt.seen)
    return through_nodes(nodes) if len(nodes) > 1 else felt.seen[:, :2]


class _Sides(NamedTuple):
    """Short sides from one leg to another, of which one is to be found: how far beyond the end of each leg
    some begin and end, mm (k, 2), and how much farther those of the one may be.
    """

    incoming: Leg
    outgoing: Leg
    along_mm: Array
    room_mm: float

    def way(self, along_mm: Array, long_mm: float) -> Array:
        """Places (n, 2) mm along so much of the one leg, over a side, and along the other."""
        away_mm = np.linspace(0.0, long_mm, PLACES)
        come = self.incoming.at(along_mm[0] - away_mm[::-1])
        return np.vstack([come, self.outgoing.at(along_mm[1] + away_mm)])

    def turns_rad(self, along_mm: Array) -> tuple[float, float]:
        """By how much the way turns onto a side and off it, left positive."""
        first, second = along_mm.tolist()
        heading = heading_of(self.outgoing.at(second) - self.incoming.at(first))
        onto_it = turn(self.incoming.heading_at(first), heading)
        return onto_it, turn(heading, self.outgoing.heading_at(second))


def _beside_another(view: View, felt: FeltCorner, round_mm: Array) -> Iterator[_Sides | None]:
    """The sides that there may be if the line turns there at the first of two corners, or the second."""
    apart = math.ceil(ABOUT_WIDTHS * view.width_mm / view.step_mm)
    for back, on in ((0, apart), (apart, 0)):
        legs = felt.legs_beyond(view, back, on)
        if legs is not None:
            yield _between(view, legs, felt.place_mm, round_mm)


def _between(
    view: View, legs: tuple[Leg, Leg], place_mm: Array, round_mm: Array
) -> _Sides | None:
    """The sides that there may be about a place between two legs, where a way (n, 2) leads round."""
    # a leg that bends goes round another corner
    bends_rad = [abs(leg.bend_per_mm) * len(leg.seen) * view.step_mm for leg in legs]
    if max(bends_rad) > SMOOTH:
        return None
    corner = Corner.of(*legs)
    if corner is None or corner.deflection_rad <= STRAIGHT:
        return _stepping(view, *legs, round_mm)
    if math.dist(corner.vertex_mm, place_mm) > ABOUT_WIDTHS * view.width_mm:
        return None
    return _cutting(view, corner, round_mm)


def _cutting(view: View, corner: Corner, round_mm: Array) -> _Sides | None:
    """The side as far from the vertex as a way (n, 2) round it; None if that is too far."""
    away_mm = float(np.hypot(*(round_mm - corner.vertex_mm).T).min())
    first_mm = max(away_mm / math.sin(corner.deflection_rad / 2), 0.5 * view.width_mm)
    if first_mm > ABOUT_WIDTHS * view.width_mm:
        return None
    along_mm = [[corner.beyond_mm - first_mm, first_mm - corner.before_mm]]
    return _Sides(corner.incoming, corner.outgoing, np.array(along_mm), first_mm)


def _stepping(view: View, incoming: Leg, outgoing: Leg, round_mm: Array) -> _Sides | None:
    """The sides of a step from a leg to one beside it, about where a way (n, 2) is half-way between."""
    ways = np.array([direction(leg.heading_rad) for leg in (incoming, outgoing)])
    from_ends = round_mm - np.array([incoming.end_mm, outgoing.end_mm])[:, None]
    along = (from_ends @ ways[:, :, None])[..., 0]
    aside = (from_ends @ left_of(ways)[:, :, None])[..., 0]
    half_way = int(np.argmin(np.abs(aside.sum(axis=0))))
    high_mm = float(np.abs(aside[:, half_way]).sum())
    if high_mm > ABOUT_WIDTHS * view.width_mm:
        return None
    back_mm = high_mm / np.tan(STEEP_RAD) / 2
    along_mm = along[:, half_way] + np.column_stack([-back_mm, back_mm])
    return _Sides(incoming, outgoing, along_mm, max(high_mm, 0.5 * view.width_mm))


class _Two(NamedTuple):
    """Two corners: the legs and where the side between begins and ends along them, mm; what they gain."""

    sides: _Sides
    along_mm: Array
    gain: float

    @property
    def turns_rad(self) -> tuple[float, float]:
        """By how much the way turns at both, left positive."""
        return self.sides.turns_rad(self.along_mm)


def _better(planner: Planner, sides: _Sides, round_mm: Array, over: _Over) -> _Two | None:
    """The two corners in place of a way (n, 2) round; None if they do not go before it."""
    from morfax.tracer.tangles.likeness import Patch, Pen

    # 1. the ink about the round
    view, pen = planner.view, Pen.of(planner.view, sides.incoming)
    beside_mm = CLEAR_WIDTHS * view.width_mm
    reach_mm = sides.room_mm + beside_mm
    long_mm = 2 * sides.room_mm + 3 * beside_mm
    first = sides.along_mm[-1]
    middle_mm = 0.5 * (sides.incoming.at(first[0]) + sides.outgoing.at(first[1]))
    about_mm = round_mm[np.argmin(np.hypot(*(round_mm - middle_mm).T))]
    patch = Patch.about(view, about_mm, reach_mm, pen)
    apart = np.array([-1.0, 1.0])
    come, go = np.split(sides.way(first + sides.room_mm * apart, long_mm), 2)
    by_round = patch.misfit(np.vstack([come, round_mm, go]))
    before_mm, behind_mm = sides.way(first + reach_mm * apart, 0.0)[[0, -1]]
    usual = min(
        Patch.about(view, place_mm, beside_mm, pen).misfit(leg)
        for place_mm, leg in ((before_mm, come), (behind_mm, go))
    )
    if by_round < over.worse * usual:
        return None
    # 2. the side that leaves least unexplained
    likest = min(sides.along_mm, key=lambda it: patch.misfit(sides.way(it, long_mm)))
    along_mm = _settled(sides, patch, likest, long_mm)
    room_mm = along_mm[0] + ahead_mm(planner.stands[0], sides.incoming)
    if not (room_mm > 0 and np.abs(along_mm - likest).max() < sides.room_mm):
        return None
    if max(map(abs, sides.turns_rad(along_mm))) > TIP_RAD:
        return None
    # 3. held against the round
    left = patch.misfit(sides.way(along_mm, long_mm))
    gain = by_round - left
    explains = gain > over.gain * usual and left < over.left * usual
    return _Two(sides, along_mm, gain) if explains else None


def _settled(sides: _Sides, patch: Patch, along_mm: Array, long_mm: float) -> Array:
    """Where the legs end, moved to where a pen along the side between leaves least of a patch's ink."""
    from morfax.tracer.tangles.figured import Figured
    from morfax.tracer.tangles.least_squares import fitted
    from morfax.tracer.tangles.seen_ink import STEPS

    for _ in range(2):  # straight on, and once more: a leg may bend
        way = sides.way(along_mm, long_mm)
        moved = (
            sides.way(along_mm + by, long_mm) - sides.way(along_mm - by, long_mm)
            for by in np.eye(2)
        )
        shape = Figured.moved(
            way, 0.5 * np.stack(list(moved), axis=1), np.zeros(len(way), bool)
        )
        along_mm = along_mm + fitted(shape, patch.for_kernel(), np.zeros(2), STEPS)
    return along_mm


def _plan(planner: Planner, two: _Two) -> Plan:
    """The way from where the head stands by the two places where the legs end."""
    incoming, outgoing = two.sides.incoming, two.sides.outgoing
    first_mm, second_mm = two.along_mm.tolist()
    end_mm = max(second_mm + BEYOND_MM, 0.0)
    way, along = onto(*planner.stands, incoming, first_mm)
    arriving = np.vstack([way, along_leg(incoming, along, first_mm)])
    leaving = along_leg(outgoing, second_mm, end_mm)
    side = with_places(np.array([arriving[-1], leaving[0]]), APART_MM)
    return Plan([arriving, side, leaving], outgoing.shifted(end_mm, outgoing.seen))
