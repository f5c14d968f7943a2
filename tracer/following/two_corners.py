"""Two corners beside one another, as at the root of a gear's tooth, which the ink's edge shows as one arc.

    ────────╮ .  vertex       an arc touches both legs; or they end before and behind the vertex, and a short
             ╲   .            side joins them: whichever leaves the ink that is there
              ╲     .
               ────────

The short side is hidden between stations that feel a corner, and has no leg. So the two places where the legs
end move to where a pen leaves least unexplained.

Signals: the planner, a corner in what was felt, and the way by an arc in; the better way out.

Source: our own.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import APART_MM, with_places
from morfax.tracer.following.hidden_corner import REACH_WIDTHS, is_rough
from morfax.tracer.head.course import ahead_mm, along_leg, onto
from morfax.tracer.head.plan import Plan
from morfax.tracer.junctions.corner import Corner, rounding
from morfax.tracer.junctions.felt_corner import FeltCorner, corner_of_round
from morfax.tracer.junctions.planner import BEYOND_MM, Planner

# of what a pen leaves unexplained beside the corner: two corners go before an arc if they leave so much less;
# on rounds of 0.5 to 2.5 widths they gain less than 0.1 of it, and mostly leave more
GAIN = 0.1
MOST = 40  # times that the ink is drawn for the two places
PLACES = 8  # of a leg, which bends little


def or_two_corners(planner: Planner, felt: FeltCorner, plan: Plan | None) -> Plan | None:
    """A plan round a corner; in place of an arc, or of none, the way by two corners, if their ink is more
    like what is there.
    """
    if (plan is not None and len(plan.stretches) > 1) or is_rough(planner.view, felt):
        return plan
    corner = corner_of_round(planner.view, felt)
    if corner is None:
        return plan
    ends_mm = _better(planner, corner, felt.seen[:, :2] if plan is None else plan.stretches[0])
    return plan if ends_mm is None else _plan(planner, corner, ends_mm)


def _better(planner: Planner, corner: Corner, round_mm: Array) -> Array | None:
    """How far before and behind the vertex the two corners are, mm; None if a way (n, 2) round is as good."""
    from morfax.tracer.tangles.least_squares import fitted
    from morfax.tracer.tangles.likeness import Patch, Pen

    # 1. the ink about the round
    view = planner.view
    missing_mm, touch_mm = rounding(view, corner)
    beside_mm = REACH_WIDTHS * view.width_mm
    reach_mm, pen = 0.5 * touch_mm + beside_mm, Pen.of(view, corner.incoming)
    middle = round_mm[np.argmin(np.hypot(*(round_mm - corner.vertex_mm).T))]
    patch = Patch.about(view, middle, reach_mm, pen)
    # 2. a side as far from the vertex as the arc, and from there to where least is unexplained
    first_mm = missing_mm / math.sin(corner.deflection_rad / 2)
    figures = fitted(
        lambda ends_mm: patch.wrong(_legs(corner, ends_mm, 3 * reach_mm)),
        np.full(2, first_mm),
        MOST,
    )
    room_mm = corner.beyond_mm + ahead_mm(planner.stands[0], corner.incoming)
    if not (figures.min() > 0 and figures.max() < touch_mm and figures[0] < room_mm):
        return None
    # 3. held against the round
    way = _legs(corner, figures, 3 * reach_mm)
    come, go = np.split(_legs(corner, np.full(2, touch_mm), 3 * reach_mm), 2)
    gain = patch.misfit(np.vstack([come, round_mm, go])) - patch.misfit(way)
    usual = min(
        Patch.about(view, at, beside_mm, pen).misfit(way)
        for at in (
            corner.incoming.at(corner.beyond_mm - touch_mm - beside_mm),
            corner.outgoing.at(touch_mm + beside_mm - corner.before_mm),
        )
    )
    return figures if gain > GAIN * usual else None


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
