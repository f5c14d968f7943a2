"""Corners felt round: an obtuse corner or a tight round, along which the line was felt as if it were smooth.

The line is clean round an obtuse corner, for its ink shows only a little too much. So what was felt is
searched for a corner; its ink decides whether the way goes by the vertex, or by an arc between straight legs.

Signals: the planner, and stations of the line (n, 3) mm in; a plan out.

Source: our own, from first principles.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.neighbours import Neighbours
from morfax.motion.plane import heading_of
from morfax.motion.polyline import APART_MM, with_places
from morfax.tracer.head.course import ahead_mm
from morfax.tracer.head.plan import Plan
from morfax.tracer.junctions.corner import (
    Corner,
    bends_on,
    is_sharp,
    rounded_corner,
    rounding,
)
from morfax.tracer.junctions.planner import BEYOND_MM, Planner
from morfax.tracer.junctions.rings import corner_in
from morfax.tracer.sensing.leg import STRAIGHT, Leg, leg_of, turn
from morfax.tracer.sensing.view import View

# Chosen by trial on the test drawings.
AHEAD = 4  # stations: a corner nearer to the head is behind the cells
SKIPPED = 2  # stations on either side of a corner that no leg is fitted to
AS_FELT = 0.65  # pixels that single stations are off
TIGHT_LEGS = 0.75  # of a leg's length: a round of a smaller radius is averaged away by feeling
LEG_STATIONS = 12  # make a leg beside a round
BENT_BACK = 2  # stations by which a leg that bends is shortened: it lies in the round
LEAST_COSINE = 0.5  # beyond a turn of 120 degrees the inner edge of the ink is no measure


class FeltCorner(NamedTuple):
    """Stations of a line (n, 3) that was felt as if it were smooth, and the one at which it turns sharply."""

    seen: Array
    station: int

    @property
    def place_mm(self) -> Array:
        """Where the line turns, as it was felt."""
        return self.seen[self.station, :2]

    @property
    def rounded(self) -> Array:
        """The places (n, 2) between the legs, as they were felt."""
        return self.seen[self.station - SKIPPED : self.station + SKIPPED + 1, :2]

    def legs(self, view: View) -> tuple[Leg, Leg]:
        """The legs before and after the stations that the corner rounds."""
        incoming = leg_of(self.seen[: self.station - SKIPPED], True, view.leg_mm)
        return incoming, leg_of(self.seen[self.station + SKIPPED + 1 :], False, view.leg_mm)

    def legs_beyond(self, view: View, back: int, on: int) -> tuple[Leg, Leg] | None:
        """The legs that end so many stations further back, and begin so many further on; None if one of them
        is too short.
        """
        last, first = self.station - SKIPPED - 1 - back, self.station + SKIPPED + 1 + on
        if last + 1 < LEG_STATIONS or first > len(self.seen) - LEG_STATIONS:
            return None
        incoming = leg_of(self.seen[: last + 1], True, view.leg_mm)
        return incoming, leg_of(self.seen[first:], False, view.leg_mm)

    def corner(self, view: View, back: int, on: int) -> Corner | None:
        """The corner of these legs; None without them, or if they do not meet."""
        legs = self.legs_beyond(view, back, on)
        return None if legs is None else Corner.of(*legs)


def corner_ahead(view: View, seen: Array, here: int) -> FeltCorner | None:
    """The corner in what was felt, ahead of station `here`; None if there is none."""
    longer = _felt_on(view, seen)
    i = corner_in(longer, here + AHEAD)
    return None if i is None or i > len(seen) - LEG_STATIONS else FeltCorner(longer, i)


def round_corner(planner: Planner, felt: FeltCorner) -> Plan | None:
    """The way round a corner in what was felt; None if its ink shows none."""
    return _by_vertex(planner, felt) or _by_round(planner, felt)


def corner_of_round(view: View, felt: FeltCorner) -> Corner | None:
    """The corner of the two legs about a round; None if there is none.

    Each leg is felt up to where its ink shows that the round begins: what is felt of a round is averaged over
    more of the line than the round is long.
    """
    back = on = 0
    while (corner := felt.corner(view, back, on)) is not None:
        touch_mm = rounding(view, corner)[1]
        more_back, more_on = (
            BENT_BACK if leg.bend_per_mm else max(0, math.ceil((touch_mm - mm) / view.step_mm))
            for leg, mm in (
                (corner.incoming, corner.beyond_mm),
                (corner.outgoing, corner.before_mm),
            )
        )
        if not more_back and not more_on:
            return corner
        back, on = back + more_back, on + more_on
    return None


def _felt_on(view: View, seen: Array) -> Array:
    """What was felt of a line, (n, 3), and a leg's length more where that is clean.

    The corner in it may be near its end.
    """
    way = seen[3, :2] - seen[0, :2]
    length_mm = len(seen) * view.step_mm + view.leg_mm
    more = view.feel(seen[0, :2], heading_of(way), length_mm)
    return more if len(more) > len(seen) else seen


def _by_vertex(planner: Planner, felt: FeltCorner) -> Plan | None:
    """The way by the vertex of a corner, if its ink shows it to be sharp."""
    view = planner.view
    incoming, outgoing = felt.legs(view)
    corner = Corner.of(incoming, outgoing)
    # the bend is not between the legs
    if corner is None or corner.nearest_mm < view.step_mm:
        return None
    if bends_on(view, corner) or not is_sharp(view, corner):
        return None
    plan = planner.through(incoming, outgoing, corner)
    angle = abs(turn(incoming.heading_rad, outgoing.heading_rad))
    return plan if is_as_felt(view, plan, felt.seen, angle) else None


def _by_round(planner: Planner, felt: FeltCorner) -> Plan | None:
    """The way by an arc between two straight legs about a station; None if there is none."""
    corner = corner_of_round(planner.view, felt)
    if corner is None:
        return None
    plan = _by_arc(planner, corner, rounding(planner.view, corner)[1])
    if plan is None or not is_as_felt(planner.view, plan, felt.seen, corner.deflection_rad):
        return None
    return plan


def _by_arc(planner: Planner, corner: Corner, touch_mm: float) -> Plan | None:
    """The way by the arc that touches two straight legs so far from their vertex.

    None if the corner is sharp, slight or wide, or if the head is in it.
    """
    widest_mm = TIGHT_LEGS * planner.view.leg_mm * math.tan(corner.deflection_rad / 2)
    room_mm = corner.beyond_mm + ahead_mm(planner.stands[0], corner.incoming)
    if corner.deflection_rad < STRAIGHT or not 0 < touch_mm < min(widest_mm, room_mm):
        return None
    end_mm = max(BEYOND_MM - corner.before_mm, 0.0)
    way = rounded_corner(planner.stands, corner, touch_mm, end_mm)
    return Plan([way], corner.outgoing.shifted(end_mm, corner.outgoing.seen))


def is_as_felt(view: View, plan: Plan, seen: Array, deflection: float) -> bool:
    """Whether a way round a corner is where the line was felt, but for the vertex.

    There the middle of the ink is inside of it. A pen of width w that turns by d about a vertex leaves the
    inner edge of its ink w/2/cos(d/2) from it, and the outer one w/2 before the aperture rounds it.
    """
    inside_mm = 0.5 * view.width_mm * (1 / max(math.cos(deflection / 2), LEAST_COSINE) - 1)
    felt = Neighbours(with_places(seen[:, :2], APART_MM))
    away_mm = felt.nearest(np.vstack(plan.stretches))[0]
    return bool(away_mm.max() < inside_mm + AS_FELT * view.pitch_mm)
