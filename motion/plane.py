"""Directions in the plane: the one of a heading, the heading of one, what is to its left, and where two meet.

Signals: headings, rad from X to Y, and directions (2,) of any length in and out; of a cross product the third
component.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.compiled import njit

NOTHING_MM = 1e-9  # rounding leaves so much of a length that is none, ...
NOTHING_MM2 = NOTHING_MM**2  # ... and this of its square
SAME_MM = 1e-6  # places as near as a nanometre are one
CORNER_RAD = math.radians(20)  # a way that turns by more has a corner there ...
BEND_RAD = CORNER_RAD / 2  # ... and one that turns by less is a bend


def direction(heading_rad: float) -> Array:
    """The direction of a heading, of length 1."""
    return np.array([math.cos(heading_rad), math.sin(heading_rad)])


def heading_of(way: Array) -> float:
    """The heading of a direction, rad."""
    return math.atan2(way[1], way[0])


def left_of(ways: Array) -> Array:
    """Directions (2,) or (n, 2) a quarter of a turn to the left, as long."""
    return np.asarray(ways[..., ::-1] * (-1.0, 1.0))


def left_of_headings(headings_rad: Array) -> Array:
    """The directions a quarter of a turn to the left of headings (n,), of length 1, (n, 2)."""
    return np.column_stack([-np.sin(headings_rad), np.cos(headings_rad)])


def unit(ways: Array) -> Array:
    """Directions (2,) or (n, 2), of length 1; one of no length stays so."""
    return np.asarray(ways / np.maximum(np.hypot(*ways.T), NOT_ZERO)[..., None])


def cross(a: Array, b: Array) -> float:
    """The area between two directions: positive if the second is to the left of the first."""
    return float(a[0] * b[1] - a[1] * b[0])


def meeting(place: Array, way: Array, other: Array, its_way: Array) -> Array:
    """Where a line through a place meets one through another; they may not be parallel."""
    gap = other - place
    return np.asarray(place + way * cross(gap, its_way) / cross(way, its_way))


# between two of some places (n, 2 or more columns), for kernels


@njit(cache=True, _nrt=False, inline="always")
def heading_between(places, first, last):  # type: ignore[no-untyped-def]
    """The heading from one place to another, rad."""
    return math.atan2(places[last, 1] - places[first, 1], places[last, 0] - places[first, 0])


@njit(cache=True, _nrt=False, inline="always")
def length_between(places, first, last):  # type: ignore[no-untyped-def]
    """How far one place is from another."""
    return math.hypot(places[last, 0] - places[first, 0], places[last, 1] - places[first, 1])
