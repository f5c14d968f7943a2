"""Pieces of a path: where its corners are, and how far a line or a circle reaches from each place.

Signals in: a polyline in the plane, mm. Signals out: its corners, and pieces that a line or an arc can stand
for.

1. Corners are kept: places where the direction turns as much over a quarter of the window as over all of it;
   a bend of any radius turns a quarter.
2. From a corner on, each piece is made as long as a line or a circle (least squares) stays within the
   tolerance. Where a long piece fits so does every part of it, so no row of pieces has fewer.

Source: none of the patents says how the lines and arcs of a program are found; chosen here. Questions: a bend
of less than a tenth of a mm cannot be told from a corner, and is made one. An arc of more than 200 degrees is
cut in two, as its chord no longer says where its centre is.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.circle import kasa, spread
from morfax.motion.compiled import njit
from morfax.motion.plane import SAME_MM, length_between
from morfax.motion.polyline import lengths_mm

SPACING_MM = 0.05  # of the places that stand for a path
WINDOW_MM = 0.2  # to either side of a corner
CORNER_RAD = 0.2  # turned within the window: less is a bend
LARGEST_TURN_RAD = 3.5  # 200 degrees, beyond which an arc is cut in two


Piece = tuple[int, int, bool]  # first place, last place, whether it is straight


def resample(points_mm: Array, spacing_mm: float = SPACING_MM) -> Array:
    """Points at about equal distances along a polyline, its first and last included."""
    s = lengths_mm(points_mm)
    at = np.linspace(0.0, s[-1], max(2, round(s[-1] / spacing_mm) + 1))
    return np.column_stack(
        [np.interp(at, s, points_mm[:, 0]), np.interp(at, s, points_mm[:, 1])]
    )


def corners(points_mm: Array) -> NDArray[np.int64]:
    """Indices of the corners of a polyline; its first and last points are none."""
    s = lengths_mm(points_mm)
    wide, narrow = (_turn_rad(points_mm, s, reach) for reach in (WINDOW_MM, WINDOW_MM / 4))
    wide, narrow = np.abs(wide), np.abs(narrow)
    is_sharp = (wide > CORNER_RAD) & (narrow > 0.6 * wide)
    sharp = np.flatnonzero(is_sharp)
    if not len(sharp):
        return sharp
    apart_mm = np.diff(s[sharp])
    groups = np.split(sharp, np.flatnonzero(apart_mm > WINDOW_MM) + 1)
    return np.array([group[np.argmax(narrow[group])] for group in groups])


def _turn_rad(points: Array, s: Array, reach_mm: float) -> Array:
    """The turn of the direction within a reach to either side of each point, rad; 0 near the ends."""
    before, after = (
        np.column_stack([np.interp(s + r, s, c) for c in points.T])
        for r in (-reach_mm, reach_mm)
    )
    ax, ay = (points - before).T
    bx, by = (after - points).T
    turn = np.arctan2(ax * by - ay * bx, ax * bx + ay * by)
    turn[(s < reach_mm / 2) | (s > s[-1] - reach_mm / 2)] = 0.0
    return turn


def longest_pieces(places: Array, tolerance_mm: float) -> list[Piece]:
    """Pieces (first, last, straight) of a row of places, each as long as a line or circle fits it."""
    ends = np.empty((2 * len(places), 2), np.int64)
    straight = np.empty(len(ends), np.bool_)
    count = _longest(np.ascontiguousarray(places), tolerance_mm, ends, straight)
    return [
        (first, last, is_straight)
        for (first, last), is_straight in zip(
            ends[:count].tolist(), straight[:count].tolist(), strict=True
        )
    ]


@njit(cache=True)
def _longest(places, tolerance_mm, ends, straight):  # type: ignore[no-untyped-def]
    """Fill the first and last place of each piece, and whether it is straight; how many there are."""
    count, first, last = 0, 0, len(places) - 1
    while first < last:
        # 1. ever further, until nothing fits; then half way between what fits and what does not
        low, step = first + 1, 1
        while low < last and _fits(places[first : min(low + step, last) + 1], tolerance_mm):
            low = min(low + step, last)
            step = 2 * step
        high = min(low + step, last + 1)
        while high - low > 1:
            middle = (low + high) // 2
            if _fits(places[first : middle + 1], tolerance_mm):
                low = middle
            else:
                high = middle
        # 2. what turns too far is two arcs
        piece = places[first : low + 1]
        is_straight = off_line_mm(piece) <= tolerance_mm
        if not is_straight and _turned_rad(piece) > LARGEST_TURN_RAD:
            middle = (first + low) // 2
            ends[count, 0], ends[count, 1], straight[count] = first, middle, False
            first, count = middle, count + 1
        ends[count, 0], ends[count, 1], straight[count] = first, low, is_straight
        first, count = low, count + 1
    return count


@njit(cache=True)
def _fits(places, tolerance_mm):  # type: ignore[no-untyped-def]
    """Whether a line or a circle stays within the tolerance of some places."""
    if len(places) < 3 or off_line_mm(places) <= tolerance_mm:
        return True
    return off_circle_mm(places) <= tolerance_mm


@njit(cache=True)
def _turned_rad(places):  # type: ignore[no-untyped-def]
    """The approximate turn of a row of places on a circle, rad."""
    way = 0.0
    for i in range(1, len(places)):
        way += length_between(places, i - 1, i)
    return way / max(kasa(places)[2], SAME_MM)


@njit(cache=True)
def off_line_mm(places):  # type: ignore[no-untyped-def]
    """The largest distance of some places (n, 2) from the line that fits them best, mm."""
    x, y, xx, xy, yy = spread(places)
    heading = 0.5 * math.atan2(2 * xy, xx - yy)
    c = math.cos(heading)
    s = math.sin(heading)
    most = 0.0
    for i in range(len(places)):
        most = max(most, abs((places[i, 1] - y) * c - (places[i, 0] - x) * s))
    return most


@njit(cache=True)
def off_circle_mm(places):  # type: ignore[no-untyped-def]
    """The largest distance of some places (n, 2) from the circle that fits them best, mm."""
    x, y, radius = kasa(places)
    most = 0.0
    for i in range(len(places)):
        most = max(most, abs(math.hypot(places[i, 0] - x, places[i, 1] - y) - radius))
    return most


def curvature_per_mm(places: Array) -> float:
    """Curvature of the arc that is nearest to a row of places, positive to the left."""
    chord = math.dist(places[0], places[-1])
    heading = heading_rad(places)
    dx, dy = (places - places[0]).T
    u, v = (
        dx * math.cos(heading) + dy * math.sin(heading),
        dy * math.cos(heading) - dx * math.sin(heading),
    )
    if np.abs(v).max() > 0.2 * chord:  # more than a third of a turn: a chord says little
        side = places[len(places) // 2] - places.mean(axis=0)
        quarter = len(dx) // 4
        half = len(dx) // 2
        across = dx[quarter] * dy[half] - dy[quarter] * dx[half]
        least_mm = float(np.hypot(*side)) / 10
        return math.copysign(1 / max(kasa(places)[2], least_mm), across)
    weight = u * u - chord * u + v * v
    return 2 * float(v @ weight) / max(float(weight @ weight), NOT_ZERO)


def heading_rad(places: Array) -> float:
    """Direction of the chord, rad."""
    return math.atan2(*(places[-1] - places[0])[::-1])
