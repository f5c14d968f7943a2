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

from morfax.motion.arrays import Array
from morfax.motion.circle import circle_through
from morfax.motion.polyline import lengths_mm

SPACING_MM = 0.05  # of the places that stand for a path
WINDOW_MM = 0.2  # to either side of a corner
CORNER_RAD = 0.2  # turned within the window: less is a bend
SAME_MM = 1e-6  # nearer places are one
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
    sharp = np.flatnonzero((np.abs(wide) > CORNER_RAD) & (np.abs(narrow) > 0.6 * np.abs(wide)))
    if not len(sharp):
        return sharp
    groups = np.split(sharp, np.flatnonzero(np.diff(s[sharp]) > WINDOW_MM) + 1)
    return np.array([group[np.argmax(np.abs(narrow[group]))] for group in groups])


def _turn_rad(points: Array, s: Array, reach_mm: float) -> Array:
    """The turn of the direction within a reach to either side of each point, rad; 0 near the ends."""
    before, after = (
        np.column_stack([np.interp(s + r, s, c) for c in points.T])
        for r in (-reach_mm, reach_mm)
    )
    (ax, ay), (bx, by) = (points - before).T, (after - points).T
    turn = np.arctan2(ax * by - ay * bx, ax * bx + ay * by)
    turn[(s < reach_mm / 2) | (s > s[-1] - reach_mm / 2)] = 0.0
    return turn


def longest_pieces(places: Array, tolerance_mm: float) -> list[Piece]:
    """Pieces (first, last, straight) of a row of places, each as long as a line or circle fits it."""
    pieces, first, last = [], 0, len(places) - 1
    while first < last:
        low, step = first + 1, 1  # low is known to fit
        while low < last and _fits(places[first : min(low + step, last) + 1], tolerance_mm):
            low, step = min(low + step, last), 2 * step
        high = min(low + step, last + 1)
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (
                (middle, high)
                if _fits(places[first : middle + 1], tolerance_mm)
                else (low, middle)
            )
        straight = bool(np.abs(off_line_mm(places[first : low + 1])).max() <= tolerance_mm)
        if not straight and _turned_rad(places[first : low + 1]) > LARGEST_TURN_RAD:
            pieces.append((first, (first + low) // 2, False))
            first = (first + low) // 2
        pieces.append((first, low, straight))
        first = low
    return pieces


def _turned_rad(places: Array) -> float:
    """The approximate turn of a row of places on a circle, rad."""
    return float(np.hypot(*np.diff(places, axis=0).T).sum()) / max(
        circle_through(places)[1], SAME_MM
    )


def _fits(places: Array, tolerance_mm: float) -> bool:
    """Whether a line or a circle stays within the tolerance of some places."""
    if len(places) < 3 or np.abs(off_line_mm(places)).max() <= tolerance_mm:
        return True
    return bool(np.abs(off_circle_mm(places)).max() <= tolerance_mm)


def off_line_mm(points: Array) -> Array:
    """Distance of each point from the line that fits them best, mm."""
    centred = points - points.mean(axis=0)
    along = np.linalg.svd(centred, full_matrices=False)[2][0]
    return centred @ np.array([-along[1], along[0]])


def off_circle_mm(points: Array) -> Array:
    """Distance of each point from the circle that fits them best, mm."""
    centre, radius, _ = circle_through(points)
    return np.hypot(*(points - centre).T) - radius


def curvature_per_mm(places: Array) -> float:
    """Curvature of the arc that is nearest to a row of places, positive to the left."""
    chord, heading = math.dist(places[0], places[-1]), heading_rad(places)
    dx, dy = (places - places[0]).T
    u, v = (
        dx * math.cos(heading) + dy * math.sin(heading),
        dy * math.cos(heading) - dx * math.sin(heading),
    )
    if np.abs(v).max() > 0.2 * chord:  # more than a third of a turn: a chord says little
        side = places[len(places) // 2] - places.mean(axis=0)
        across = dx[len(dx) // 4] * dy[len(dy) // 2] - dy[len(dy) // 4] * dx[len(dx) // 2]
        return math.copysign(
            1 / max(circle_through(places)[1], float(np.hypot(*side)) / 10), across
        )
    weight = u * u - chord * u + v * v
    return 2 * float(v @ weight) / max(float(weight @ weight), 1e-30)


def heading_rad(places: Array) -> float:
    """Direction of the chord, rad."""
    return math.atan2(*(places[-1] - places[0])[::-1])
