"""Faint corners: a pencil leaves little ink where it turns, so that a line that comes round looks open.

    ╲     ╱      two tips near to each other, and ink between them that is too pale for a line: by where both
     ╲ . ╱       lines meet, or straight on from one tip to the other
       ·

Signals: the view, and two tips with the directions in which their lines lead out, in; the course out.

Source: our own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import CORNER_RAD, cross, direction, heading_of, meeting
from morfax.motion.polyline import APART_MM, with_places
from morfax.tracer.head.course import on_ink
from morfax.tracer.junctions.line_ahead import AHEAD
from morfax.tracer.sensing.leg import Leg, turn
from morfax.tracer.sensing.probe import END_WIDTHS, end_of
from morfax.tracer.sensing.view import View


class TipPose(NamedTuple):
    """An end of a line: where it is (x, y) mm, and in which direction the line leads out to it, rad."""

    place_mm: Array
    outward_rad: float

    @classmethod
    def of(cls, view: View, leg: Leg) -> TipPose:
        """The tip to which a leg leads; the leg's end, if it ends nowhere near."""
        end_mm = end_of(view, leg) or 0.0
        return cls(leg.at(end_mm), leg.heading_at(end_mm))


def faint_corner(view: View, one: TipPose, other: TipPose) -> list[Array] | None:
    """The course from one tip to another as stretches (n, 2) mm, if pale ink with grain leads there, or None:
    of a scan without grain such ink is a gap's soft edges.
    """
    if not view.grainy:
        return None
    begin, end = one.place_mm, other.place_mm
    way, straight = end - begin, [_straight(begin, end)]
    away_mm = float(np.hypot(*way))
    if not 0 < away_mm <= END_WIDTHS * view.width_mm:
        return None
    if away_mm < 0.5 * view.width_mm:  # within the ink of both
        return straight
    on_rad = heading_of(way)
    off_rad = abs(turn(on_rad, one.outward_rad)), abs(turn(on_rad + math.pi, other.outward_rad))
    if min(off_rad) > AHEAD:
        return None
    corner = _where_both_meet(one, other)
    ways = [] if corner is None else [[_straight(begin, corner), _straight(corner, end)]]
    return next((way for way in [*ways, straight] if on_ink(view, way)), None)


def _where_both_meet(one: TipPose, other: TipPose) -> Array | None:
    """Where the lines meet straight on from their tips, (x, y) mm; None if they do not."""
    on, back = direction(one.outward_rad), direction(other.outward_rad)
    if abs(cross(on, back)) < math.sin(CORNER_RAD):
        return None
    corner = meeting(one.place_mm, on, other.place_mm, back)
    is_ahead = (corner - one.place_mm) @ on > 0 and (corner - other.place_mm) @ back > 0
    return corner if is_ahead else None


def _straight(begin: Array, end: Array) -> Array:
    """The straight way from one place to another, (n, 2) mm."""
    return with_places(np.vstack([begin, end]), APART_MM)
