"""Courses: the short ways that the head runs from memory through a knot.

A course is a list of stretches, each a polyline (n, 2) in sheet mm with a place every few hundredths; between
stretches the head stops and swivels.

    smooth     from heading to heading by a cubic (Hermite), which is right to its fourth order
    corner     along the incoming leg's line to the vertex, stop, swivel, along the outgoing leg's line
    rounding   where the ink shows that the corner is rounded: an arc that touches both legs

Whether a corner is sharp is seen on the outside of its ink: a pen of width w that turns on the vertex inks
w/2 beyond it on the bisector; what is missing there is by how much the line passes the vertex.

Source: our own, from first principles (the patent's head swivels on its axis; how sharply is left open).
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.curves import SPACING_MM, hermite
from morfax.tracer.sensing.leg import Leg, centre_at
from morfax.tracer.sensing.view import View

# of a leg's length, to both sides: what a place on a felt line is averaged over
FELT_LEGS = 0.3


def onto(place: Array, heading: float, leg: Leg, limit_mm: float) -> tuple[Array, float]:
    """From where the head is onto the incoming leg's line; the way, and how far along the leg (mm from its
    end) it arrives.

    It arrives at the leg's clean end, or beyond it if that is too near, but never beyond half the way to
    `limit_mm`.
    """
    ahead = ahead_mm(place, leg)
    along = min(0.0 if ahead > 0.2 else min(0.2 - ahead, 0.5 * (limit_mm - ahead)), limit_mm)
    return hermite(place, heading, leg.at(along), leg.heading_at(along)), along


def along_leg(leg: Leg, start_mm: float, end_mm: float) -> Array:
    """Places on a leg's line from one distance to another (from its clean end)."""
    return leg.at(
        np.linspace(
            start_mm, end_mm, max(2, math.ceil(abs(end_mm - start_mm) / SPACING_MM) + 1)
        )
    )


def nodes_along(
    view: View, start: tuple[Array, float], seen: Array, left: float = 0.55
) -> tuple[list[tuple[Array, float]], Leg | None]:
    """Places and headings along a line that was felt throughout (n, 3), from where the head stands; the last
    also as a leg, None if there is too little.

    A share of a leg is `left` over: too little to tell a corner by.
    """
    half_mm, left_mm = FELT_LEGS * view.leg_mm, left * view.leg_mm
    nodes, leg = [start], None
    here = int(np.argmin(np.hypot(*(seen[:, :2] - start[0]).T)))
    for i in range(here, len(seen)):
        if (
            i < here + half_mm / view.step_mm
            or np.hypot(*(seen[i, :2] - nodes[-1][0])) < half_mm / 3
        ):
            continue
        if np.hypot(*(seen[i, :2] - seen[-1, :2])) < left_mm:
            break
        leg = centre_at(seen, i, half_mm)
        nodes.append((leg.end_mm, leg.heading_rad))
    return nodes, leg


def through_nodes(nodes: list[tuple[Array, float]]) -> Array:
    """Cubics through places and headings, (n, 2) mm."""
    return np.vstack([hermite(*a, *b) for a, b in pairwise(nodes)])


def ahead_mm(place: Array, leg: Leg) -> float:
    """How far ahead of a place a leg's clean end is, mm along the leg."""
    return float(
        (leg.end_mm - place) @ np.array([math.cos(leg.heading_rad), math.sin(leg.heading_rad)])
    )


def on_ink(view: View, stretches: list[Array]) -> bool:
    """Whether a course lies on ink, faint or not, for the most part: it may cross a gap."""
    places = np.vstack(stretches)[::5]
    fainter = view.at_level(0.5 * view.level)
    return float(np.mean([fainter.dark(place) for place in places])) > 0.8
