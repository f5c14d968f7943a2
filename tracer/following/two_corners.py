"""Two corners beside one another, as at the root of a gear's tooth, where an arc or one vertex was laid.

    ────────╮ .  vertex       an arc touches both legs; or they end before and behind the vertex, and a short
             ╲   .            side joins them: whichever leaves the ink that is there
              ╲     .
               ────────

The short side is hidden between stations that feel a corner, and has no leg. So the two places where the legs
end move to where a pen leaves least unexplained.

Signals: the planner, a corner in what was felt, and the way that was laid round it, or none, in; the better
way out.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import APART_MM, with_places
from morfax.tracer.following.hidden_corner import is_rough
from morfax.tracer.head.course import ahead_mm, along_leg, onto
from morfax.tracer.head.plan import Plan
from morfax.tracer.junctions.corner import Corner
from morfax.tracer.junctions.felt_corner import FeltCorner, corner_of_round, is_as_felt
from morfax.tracer.junctions.planner import BEYOND_MM, Planner
from morfax.tracer.limits import ABOUT_WIDTHS, CLEAR_WIDTHS
from morfax.tracer.sensing.leg import STRAIGHT
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.seen_ink import STEPS

# Chosen by trial on racks of teeth and on rounds, drawn with known truth.
MOST_TIMES = 2.0  # as far as the arc that leaves as much ink touches its legs
PLACES = 8  # of a leg, which bends little


class _Over(NamedTuple):
    """When two corners go before a way round: what it leaves unexplained at the least, and what they gain, in
    times of what a pen leaves beside it.
    """

    worse: float
    gain: float


# on rounds of 0.5 to 2.5 widths two corners gain less than 0.1, and mostly leave more; what is left at a
# right vertex is less than twice as much as beside it
OVER_ARC, OVER_OTHER = _Over(0.0, 0.1), _Over(2.0, 1.0)


def or_two_corners(planner: Planner, felt: FeltCorner, plan: Plan | None) -> Plan | None:
    """A plan round a corner, or none; instead the way by two corners, if their ink is more like what is
    there.
    """
    view = planner.view
    if is_rough(view, felt):
        return plan
    round_mm = felt.seen[:, :2] if plan is None else np.vstack(plan.stretches)
    if plan is not None and len(plan.stretches) == 1:
        over, corners = OVER_ARC, [corner_of_round(view, felt)]
    else:
        over, corners = OVER_OTHER, list(_beside_another(view, felt))
    found = [_better(planner, corner, round_mm, over) for corner in corners if corner]
    better = [it for it in found if it is not None]
    if not better:
        return plan
    best = max(better, key=lambda it: it.gain)
    two = _plan(planner, best.corner, best.ends_mm)
    return two if is_as_felt(view, two, felt.seen, best.corner.deflection_rad) else plan


def _beside_another(view: View, felt: FeltCorner) -> Iterator[Corner]:
    """The corners that the legs make if the line turns there at the first of two corners, or the second."""
    apart = math.ceil(ABOUT_WIDTHS * view.width_mm / view.step_mm)
    for corner in (felt.corner(view, 0, apart), felt.corner(view, apart, 0)):
        # a leg that bends goes round another corner
        if corner is None or corner.incoming.bend_per_mm or corner.outgoing.bend_per_mm:
            continue
        is_near = math.dist(corner.vertex_mm, felt.place_mm) < ABOUT_WIDTHS * view.width_mm
        if is_near and corner.deflection_rad > STRAIGHT:
            yield corner


class _Two(NamedTuple):
    """Two corners: the one of their legs, how far before and behind it they are, mm, and what they gain."""

    corner: Corner
    ends_mm: Array
    gain: float


def _better(planner: Planner, corner: Corner, round_mm: Array, over: _Over) -> _Two | None:
    """The two corners in place of a way (n, 2) round; None if they do not go before it."""
    from morfax.tracer.tangles.least_squares import fitted
    from morfax.tracer.tangles.likeness import Patch, Pen

    # 1. the ink about the round
    view, pen = planner.view, Pen.of(planner.view, corner.incoming)
    away_mm = np.hypot(*(round_mm - corner.vertex_mm).T)
    first_mm = float(away_mm.min()) / math.sin(corner.deflection_rad / 2)
    first_mm = max(first_mm, 0.5 * view.width_mm)
    if first_mm > ABOUT_WIDTHS * view.width_mm:
        return None
    most_mm, beside_mm = MOST_TIMES * first_mm, CLEAR_WIDTHS * view.width_mm
    patch = Patch.about(view, round_mm[np.argmin(away_mm)], first_mm + beside_mm, pen)
    long_mm = most_mm + 3 * beside_mm
    come, go = np.split(_legs(corner, np.full(2, most_mm), long_mm), 2)
    by_round = patch.misfit(np.vstack([come, round_mm, go]))
    before_mm, behind_mm = _legs(corner, np.full(2, most_mm + beside_mm), 0.0)[[0, -1]]
    usual = min(
        Patch.about(view, place_mm, beside_mm, pen).misfit(leg)
        for place_mm, leg in ((before_mm, come), (behind_mm, go))
    )
    if by_round < over.worse * usual:
        return None
    # 2. a side as far from the vertex as the round, and from there to where least is unexplained
    ends_mm = fitted(
        lambda ends: patch.wrong(_legs(corner, ends, long_mm)), np.full(2, first_mm), STEPS
    )
    room_mm = corner.beyond_mm + ahead_mm(planner.stands[0], corner.incoming)
    if not (ends_mm.min() > 0 and ends_mm.max() < most_mm and ends_mm[0] < room_mm):
        return None
    # 3. held against the round
    gain = by_round - patch.misfit(_legs(corner, ends_mm, long_mm))
    return _Two(corner, ends_mm, gain) if gain > over.gain * usual else None


def _legs(corner: Corner, ends_mm: Array, long_mm: float) -> Array:
    """Places (n, 2) mm along both legs, as far as their ends before and behind the vertex."""
    away_mm = np.linspace(0.0, long_mm, PLACES)
    return np.vstack(
        [
            corner.incoming.at(corner.beyond_mm - ends_mm[0] - away_mm[::-1]),
            corner.outgoing.at(ends_mm[1] - corner.before_mm + away_mm),
        ]
    )


def _plan(planner: Planner, corner: Corner, ends_mm: Array) -> Plan:
    """The way from where the head stands by the two places where the legs end."""
    incoming, outgoing = corner.incoming, corner.outgoing
    first_mm, second_mm = corner.beyond_mm - ends_mm[0], ends_mm[1] - corner.before_mm
    end_mm = max(second_mm + BEYOND_MM, 0.0)
    way, along = onto(*planner.stands, incoming, first_mm)
    arriving = np.vstack([way, along_leg(incoming, along, first_mm)])
    leaving = along_leg(outgoing, second_mm, end_mm)
    side = with_places(np.array([arriving[-1], leaving[0]]), APART_MM)
    return Plan([arriving, side, leaving], outgoing.shifted(end_mm, outgoing.seen))
