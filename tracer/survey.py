"""The survey of a knot: which leg the head takes out of it.

Signals: the incoming leg and the trail in; the outgoing leg out, and where the two meet.

Straight on at a crossing; on along the only leg at a corner; never onto what has been followed already; across a gap no wider than allowed.

Source: our own (see `knot`).
"""

from __future__ import annotations

import math

import numpy as np

from tracer.knot import legs_around
from tracer.leg import Leg, Meeting, leg_of, meet, reach_of_ink, turn
from tracer.trail import Trail
from tracer.view import Array, View

STRAIGHT = math.radians(40)  # straight on is within this
PASSES = math.radians(12)  # two legs in line with each other within this are one line that passes
FARTHEST_WIDTHS = 6.0  # how far the heading is held through a blot, in widths of the line


Way = tuple[Leg | None, Meeting | None, int]


def survey(view: View, incoming: Leg, trail: Trail, rank: int = 0) -> Way:
    """The outgoing leg (None if there is none), the distances (mm) beyond the incoming and before the outgoing clean end where they meet, and how many
    legs there were, counting 1 more where one was left out because it has been followed already.

    Looked for where the line stops being clean, and, unless it goes straight on from there, where the ink ahead ends: at the tip of a sharp corner.
    `rank` 1 takes the second straightest leg.
    """
    ink = reach_of_ink(view, incoming, 6 * view.width_mm + 2.0)
    half = 0.5 * view.width_mm
    near = half + view.step_mm
    found = _look(view, incoming, trail, incoming.at(near if ink is None else max(0.0, min(near, ink - half))), rank)
    if ink is not None and ink - half > near and not goes_straight(incoming, found[0]):
        at_tip = _look(view, incoming, trail, incoming.at(ink - half), rank)
        found = at_tip if at_tip[0] is not None else found
    return found


def _look(view: View, incoming: Leg, trail: Trail, centre: Array, rank: int) -> Way:
    """Look for legs about a centre, and again about the place where incoming and outgoing meet, until that is known."""
    way_in = np.vstack([trail.recent(), incoming.seen[:, :2]])
    outgoing, legs_mm, choices = None, None, 0
    for _ in range(3):
        every = legs_around(view, centre, way_in)
        legs = [leg for leg in every if not trail.holds(leg, view.width_mm)]
        choices = max(choices, len(legs) + (len(legs) < len(every)))
        if not legs:
            break
        if rank == 0:
            legs = _without_pairs(view, incoming, legs, every) or legs
        legs.sort(key=lambda leg: abs(turn(incoming.heading_rad, leg.heading_rad)))
        outgoing = legs[min(rank, len(legs) - 1)]
        legs_mm = meet(incoming, outgoing)
        if legs_mm is None or legs_mm[0] < -view.width_mm:
            break
        vertex = incoming.at(legs_mm[0])
        if np.hypot(*(vertex - centre)) < 0.3 * view.width_mm:
            break
        centre = vertex
    return outgoing, legs_mm, choices


def _without_pairs(view: View, incoming: Leg, legs: list[Leg], every: list[Leg]) -> list[Leg]:
    """The legs that are not the two ends of a line that passes here, straighter than any leg goes on from the incoming one."""
    taken: list[Leg] = []
    for i, a in enumerate(every):
        for b in every[i + 1 :]:
            bent = abs(turn(a.heading_rad + math.pi, b.heading_rad))
            gap = b.end_mm - a.end_mm
            aside = abs(gap[0] * math.sin(a.heading_rad) - gap[1] * math.cos(a.heading_rad))
            own = min(abs(turn(incoming.heading_rad, leg.heading_rad)) for leg in (a, b))
            if bent < PASSES and aside < 0.35 * view.width_mm and own > bent + PASSES:
                taken += [a, b]
    return [leg for leg in legs if not any(leg is other for other in taken)]


def goes_straight(incoming: Leg, outgoing: Leg | None) -> bool:
    """Whether a leg goes on straight from another."""
    return outgoing is not None and abs(turn(incoming.heading_rad, outgoing.heading_rad)) < STRAIGHT


def straight_on(view: View, incoming: Leg, gap_mm: float) -> Leg | None:
    """The clean line met by going straight on with the heading held, through a blot, or across a gap no wider than allowed."""
    light_mm, step = 0.0, 0.35 * view.pitch_mm
    for along in np.arange(0.5 * view.width_mm, FARTHEST_WIDTHS * view.width_mm + gap_mm, step):
        place = incoming.at(along)
        light_mm = 0.0 if view.dark(place) else light_mm + step
        if light_mm > gap_mm + step:
            return None
        if light_mm:
            continue
        seen = view.feel(place, incoming.heading_at(along), view.leg_mm)
        if len(seen) < 8 or np.hypot(*(seen[0, :2] - place)) > 0.5 * view.width_mm:
            continue
        leg = leg_of(seen, False, view.leg_mm)
        if goes_straight(incoming, leg):
            return leg
    return None
