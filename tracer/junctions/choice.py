"""The survey of a knot: which leg the head takes out of it.

Signals: the incoming leg and the trail in; the outgoing leg out, and where the two meet.

Straight on at a crossing; on along the only leg at a corner; never onto what has been followed already;
across a gap no wider than allowed. A stroke that ends soon and is not straight on is a mark, no leg. At a
junction the operator may turn left or right; where a lead line ends square on another the head turns left,
which is clockwise round a contour that it comes to from outside.

Source: our own (see `knot`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import combinations

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.head.trail import Trail
from morfax.tracer.junctions.rings import legs_around
from morfax.tracer.marks.marks import longest_mm
from morfax.tracer.sensing.leg import (
    STRAIGHT,
    Leg,
    Meeting,
    goes_straight,
    leg_of,
    meet,
    turn,
    turns_off,
)
from morfax.tracer.sensing.probe import reach_of_ink, stroke_end
from morfax.tracer.sensing.side import Side
from morfax.tracer.sensing.view import View

AHEAD = math.radians(75)  # a lost line is looked for within this of its heading
SQUARE = math.radians(
    20
)  # two legs that turn off to both sides alike, within this, are a line that the head comes to
PASSES = math.radians(
    12
)  # two legs in line with each other within this are one line that passes
SIDEWAYS_WIDTHS = (
    0.0,
    1.0,
    2.0,
)  # ahead a line that turns back to a side is looked for: its ink runs along with the way in at first
OVERRUN_MM, OVERRUN_WIDTHS = (
    1.5,
    2.0,
)  # a lead line may be drawn so far beyond the contour's edge
FARTHEST_WIDTHS = 6.0  # how far the heading is held through a blot, in widths of the line


Way = tuple[Leg | None, Meeting | None, int]


def survey(
    view: View,
    incoming: Leg,
    trail: Trail,
    rank: int = 0,
    side: Side | None = None,
    *,
    leads: bool = False,
) -> Way:
    """The outgoing leg (None if there is none), the distances (mm) beyond the incoming and before the
    outgoing clean end where they meet, and how many legs there were, counting 1 more where one was left out
    because it has been followed already.

    Looked for where the line stops being clean, and, unless it goes straight on from there, where the ink
    ahead ends: at the tip of a sharp corner. `rank` 1 takes the second straightest leg, `side` the
    straightest that turns off to that side, if there is one. A line that `leads` ends at the line that it
    comes to, though the pen ran on a little beyond that.
    """
    ink = reach_of_ink(view, incoming, 6 * view.width_mm + 2.0)
    half = 0.5 * view.width_mm
    near = half + view.step_mm
    choose, look = (
        partial(_chosen, incoming, rank, side),
        partial(_look, view, incoming, trail, leads),
    )
    found = look(incoming.at(near if ink is None else max(0.0, min(near, ink - half))), choose)
    for widths in SIDEWAYS_WIDTHS if side is not None else ():
        aside = look(incoming.at(near + widths * view.width_mm), choose)
        if aside[0] is not None and side is not None and _is_aside(incoming, aside[0], side):
            return aside
    if ink is not None and ink - half > near and not goes_straight(incoming, found[0]):
        at_tip = look(incoming.at(ink - half), choose)
        found = found if at_tip[0] is None else (*at_tip[:2], max(found[2], at_tip[2]))
    return found


def _look(
    view: View,
    incoming: Leg,
    trail: Trail,
    leads: bool,
    centre: Array,
    choose: Callable[[list[Leg], list[Leg], View], Leg],
) -> Way:
    """Look for legs about a centre, and again about the place where incoming and outgoing meet, until that is
    known.
    """
    way_in = np.vstack([trail.recent(), incoming.seen[:, :2]])
    outgoing, legs_mm, choices = None, None, 0
    for _ in range(3):
        every = legs_around(view, centre, way_in)
        every = _without_overrun(view, incoming, every) if leads else every
        every = _without_marks(view, incoming, every)
        legs = [leg for leg in every if not trail.holds(leg, view.width_mm)]
        legs = _without_stubs(view, incoming, legs, every)
        choices = max(choices, len(legs) + (len(legs) < len(every)))
        if not legs:
            break
        outgoing = choose(legs, every, view)
        legs_mm = meet(incoming, outgoing)
        if legs_mm is None or legs_mm[0] < -view.width_mm:
            break
        vertex = incoming.at(legs_mm[0])
        if np.hypot(*(vertex - centre)) < 0.3 * view.width_mm:
            break
        centre = vertex
    return outgoing, legs_mm, choices


def _chosen(
    incoming: Leg, rank: int, side: Side | None, legs: list[Leg], every: list[Leg], view: View
) -> Leg:
    """The leg to take: by side, if one turns off there; else by how straight it goes on."""
    turns = {id(leg): turn(incoming.heading_rad, leg.heading_rad) for leg in legs}
    if side is not None:
        aside = [leg for leg in legs if _is_aside(incoming, leg, side)]
        if aside:
            return min(aside, key=lambda leg: abs(turns[id(leg)]))
    if rank == 0:
        legs = _without_pairs(view, incoming, legs, every) or legs
    legs = sorted(legs, key=lambda leg: abs(turns[id(leg)]))
    if (
        rank == 0
        and len(legs) > 1
        and abs(turns[id(legs[0])]) > STRAIGHT
        and abs(turns[id(legs[0])] + turns[id(legs[1])]) < SQUARE
    ):
        return max(legs[:2], key=lambda leg: turns[id(leg)])
    return legs[min(rank, len(legs) - 1)]


def _is_aside(incoming: Leg, leg: Leg, side: Side) -> bool:
    """Whether a leg turns off to a side."""
    return (turn(incoming.heading_rad, leg.heading_rad) > 0) == (side == "left") and turns_off(
        incoming, leg
    )


def _without_marks(view: View, incoming: Leg, legs: list[Leg]) -> list[Leg]:
    """The legs but for those that are marks and not straight on, if others are left."""
    reach = [
        math.inf if goes_straight(incoming, leg) else _reach_mm(view, incoming, leg)
        for leg in legs
    ]
    kept = [
        leg
        for leg, mm in zip(legs, reach, strict=True)
        if mm > longest_mm(view, across=_is_across(leg, legs, reach))
    ]
    return kept or legs


def _without_overrun(view: View, incoming: Leg, legs: list[Leg]) -> list[Leg]:
    """The legs but for one straight on that ends soon, if the others are a line that passes: the end of a
    lead line drawn beyond the contour.
    """
    passing = [leg for leg in legs if not goes_straight(incoming, leg)]
    if not any(
        abs(turn(a.heading_rad + math.pi, b.heading_rad)) < SQUARE
        for a, b in combinations(passing, 2)
    ):
        return legs
    overrun_mm = max(OVERRUN_MM, OVERRUN_WIDTHS * view.width_mm)
    return [
        leg
        for leg in legs
        if any(leg is u for u in passing) or _reach_mm(view, incoming, leg) > overrun_mm
    ]


def _without_stubs(view: View, incoming: Leg, legs: list[Leg], every: list[Leg]) -> list[Leg]:
    """The legs but for marks on what has been followed already, however straight on: the head has come back
    to its lead line.

    Where it crosses a line that it has followed, what lies beyond is its own, and may end soon.
    """
    held = [leg for leg in every if not any(leg is other for other in legs)]
    passing = any(
        abs(turn(a.heading_rad + math.pi, b.heading_rad)) < SQUARE
        for a, b in combinations(held, 2)
    )
    if not held or passing:
        return legs
    return [leg for leg in legs if _reach_mm(view, incoming, leg) > longest_mm(view)]


def _is_across(leg: Leg, legs: list[Leg], reach_mm: list[float]) -> bool:
    """Whether another stroke that ends soon lies in line with a leg, on the other side."""
    return any(
        math.isfinite(mm) and abs(turn(leg.heading_rad + math.pi, other.heading_rad)) < SQUARE
        for other, mm in zip(legs, reach_mm, strict=True)
    )


def _reach_mm(view: View, incoming: Leg, leg: Leg) -> float:
    """How far a leg reaches beyond the edge of the line that comes in, mm; infinite if it does not end within
    a mark's length.
    """
    end = stroke_end(view, leg, longest_mm(view))
    way = leg.end_mm - incoming.end_mm
    aside = abs(
        way[1] * math.cos(incoming.heading_rad) - way[0] * math.sin(incoming.heading_rad)
    )
    return math.inf if end is None else end + aside - 0.5 * view.width_mm


def _without_pairs(view: View, incoming: Leg, legs: list[Leg], every: list[Leg]) -> list[Leg]:
    """The legs that are not the two ends of a line that passes here, straighter than any leg goes on from the
    incoming one.
    """
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


def straight_on(view: View, incoming: Leg, gap_mm: float) -> Leg | None:
    """The clean line met by going straight on, through a blot, or across a gap no wider than allowed: along
    the leg's bend, or else with the heading held.

    The bend of a dash two or three millimetres long is uncertain.
    """
    return _met(view, incoming, gap_mm) or _met(
        view, replace(incoming, bend_per_mm=0.0), gap_mm
    )


def _met(view: View, incoming: Leg, gap_mm: float) -> Leg | None:
    """The clean line met by going on along a leg."""
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


def caught_again(view: View, incoming: Leg, trail: Trail, within_mm: float) -> Leg | None:
    """The line that the head meets first in widening arcs ahead of where it lost it, no further than allowed;
    None if there is none.

    Only lines that have not been followed, and that lead on ahead.
    """
    end = incoming.at(reach_of_ink(view, incoming, view.width_mm) or 0.0)
    for radius in np.arange(view.width_mm, within_mm, 0.5 * view.width_mm):
        legs = []
        for arc in view.ring(end, radius):
            if abs(turn(incoming.heading_rad, float(arc.mean()))) < AHEAD:
                met = end + radius * np.array([math.cos(arc.mean()), math.sin(arc.mean())])
                legs += [leg for leg in _from(view, met) if not trail.holds(leg, view.width_mm)]
        legs = [leg for leg in legs if abs(turn(incoming.heading_rad, leg.heading_rad)) < AHEAD]
        if legs:
            return min(legs, key=lambda leg: abs(turn(incoming.heading_rad, leg.heading_rad)))
    return None


def _from(view: View, place: Array) -> list[Leg]:
    """The clean legs that leave a place on ink."""
    found = []
    for arc in view.ring(place, 1.5 * view.width_mm):
        heading = float(arc.mean())
        start = place + 1.5 * view.width_mm * np.array([math.cos(heading), math.sin(heading)])
        seen = view.feel(start, heading, view.leg_mm)
        if len(seen) >= 8:
            found.append(leg_of(seen, False, view.leg_mm))
    return found
