"""Courses: the short ways that the head runs from memory through a junction.

A course is a list of stretches, each a polyline (n, 2) in sheet mm with a place every few hundredths; between
stretches the head stops and swivels.

    smooth     from heading to heading by a cubic (Hermite), which is right to its fourth order
    corner     along the incoming leg's line to the vertex, stop, swivel, along the outgoing leg's line
    rounding   where the ink shows that the corner is rounded: an arc that touches both legs

The last two are `junctions.corner`'s.

Signals: where the head stands, legs and stations in sheet mm in; polylines (n, 2) mm out.

Source: our own, from first principles (the patent's head swivels on its axis; how sharply is left open).
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion import curves
from morfax.motion.arrays import Array
from morfax.motion.curves import hermite
from morfax.motion.plane import direction
from morfax.motion.polyline import APART_MM
from morfax.tracer.sensing.leg import Leg, centre_at
from morfax.tracer.sensing.view import View

# of a leg's length, to both sides: what a place on a felt line is averaged over
FELT_LEGS = 0.3
NODES = 3  # within that length
LEFT_LEGS = 0.55  # of a leg's length: less of a felt line is too little to tell a corner by
ONTO_MM = 0.2  # the shortest way onto the incoming leg's line, unless half the way to the limit is less
ON_INK = 0.8  # share of a course's places on ink: it may cross a gap
FAINT = 0.5  # of the level: ink, faint or not
ON_INK_EVERY = 5  # of a course's places, 0.02 mm apart, one is looked at
# a smaller change of heading is no corner: the head runs through it; by trial on the test drawings
SMOOTH = math.radians(14)


def onto(place: Array, heading: float, leg: Leg, limit_mm: float) -> tuple[Array, float]:
    """The way from where the head is onto a leg's line, and how far beyond the leg's end it arrives, mm.

    It arrives at the leg's clean end, or beyond it if that is too near, but never beyond half the way to
    `limit_mm`.
    """
    ahead, along = ahead_mm(place, leg), 0.0
    if ahead <= ONTO_MM:
        along = min(ONTO_MM - ahead, 0.5 * (limit_mm - ahead))
    along = min(along, limit_mm)
    return hermite(place, heading, leg.at(along), leg.heading_at(along)), along


def along_leg(leg: Leg, start_mm: float, end_mm: float) -> Array:
    """Places on a leg's line from one distance to another (from its clean end)."""
    count = max(2, math.ceil(abs(end_mm - start_mm) / APART_MM) + 1)
    return leg.at(np.linspace(start_mm, end_mm, count))


def nodes_along(
    view: View, start: tuple[Array, float], seen: Array, left: float = LEFT_LEGS
) -> tuple[list[tuple[Array, float]], Leg | None]:
    """Places and headings along a line that was felt throughout (n, 3), from where the head stands; the last
    one also as a leg, None if the line is too short. `left` of a leg's length stays over at the end.
    """
    half_mm, left_mm = FELT_LEGS * view.leg_mm, left * view.leg_mm
    nodes, leg = [start], None
    here = int(np.argmin(np.hypot(*(seen[:, :2] - start[0]).T)))
    for i in range(here, len(seen)):
        place = seen[i, :2]
        too_near = i < here + half_mm / view.step_mm
        if too_near or np.hypot(*(place - nodes[-1][0])) < half_mm / NODES:
            continue
        if np.hypot(*(place - seen[-1, :2])) < left_mm:
            break
        leg = centre_at(seen, i, half_mm)
        nodes.append((leg.end_mm, leg.heading_rad))
    return nodes, leg


def through_nodes(nodes: list[tuple[Array, float]]) -> Array:
    """Cubics through places and headings, (n, 2) mm."""
    return curves.through(nodes)


def to_end(stands: tuple[Array, float], leg: Leg, end_mm: float) -> Array:
    """The course from where the head stands along a leg to its end, (n, 2) mm."""
    way, along = onto(*stands, leg, end_mm)
    return np.vstack([way, along_leg(leg, along, end_mm)])


def ahead_mm(place: Array, leg: Leg) -> float:
    """How far ahead of a place a leg's clean end is, mm along the leg."""
    return float((leg.end_mm - place) @ direction(leg.heading_rad))


def on_ink(view: View, stretches: list[Array]) -> bool:
    """Whether a course lies on ink, faint or not, for the most part."""
    places = np.vstack(stretches)[::ON_INK_EVERY]
    return float(np.mean(view.darkness_along(places) > FAINT * view.level)) > ON_INK
