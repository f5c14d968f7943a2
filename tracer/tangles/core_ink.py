"""The ink of a pen along the way that keeps one distance from a core of a few points (see `compass`).

Signals: places (n, 2) mm, the points of a core, the distance and half the pen's width, mm, in; the darkness
that the pen leaves there, and by how much each of these figures darkens it, out.

Source: our own. A fit draws a core some ten times: in kernels.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion import arrays
from morfax.motion.arrays import NOT_ZERO
from morfax.motion.compiled import njit
from morfax.motion.plane import NOTHING_MM2
from morfax.tracer.tangles import pen


@njit(cache=True)
def ink(places, core, softness_mm, is_filled, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n,) with the darkness that a pen leaves at places (n, 2) along the way about a core, and
    within it if it is filled; `core`: its points (m, 2), the distance from it and half the pen's width, mm.
    """
    points, radius_mm, half_mm = core
    sides = _sides(points)
    for k in range(len(places)):
        from_core_mm, _, _ = _from_core(places[k, 0], places[k, 1], points, sides)
        away_mm = from_core_mm - radius_mm
        away_mm = away_mm if is_filled else abs(away_mm)
        out[k] = pen.ink_at(away_mm, half_mm, softness_mm)


@njit(cache=True)
def changes(places, core, softness_mm, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, f) with by how much each coordinate of the points, the radius, if there is a column for
    it, and half the pen's width darken the places, per mm (see `moved_way`).
    """
    points, radius_mm, half_mm = core
    sides, last = _sides(points), out.shape[1] - 1
    for k in range(len(places)):
        x, y = places[k, 0], places[k, 1]
        from_core_mm, i, share = _from_core(x, y, points, sides)
        away_mm = from_core_mm - radius_mm
        fades = pen.fades_at(abs(away_mm), half_mm, softness_mm)
        out[k, :] = 0.0
        out[k, last] = fades
        # the way comes nearer as the radius grows, or the core comes nearer, to a place outside of it
        by = math.copysign(fades, away_mm)
        if last > 2 * len(points):
            out[k, last - 1] = by
        if fades == 0.0 or abs(from_core_mm) < NOT_ZERO:
            continue
        j = (i + 1) % len(points)
        dx = by * (x - points[i, 0] - share * sides[i, 0]) / from_core_mm
        dy = by * (y - points[i, 1] - share * sides[i, 1]) / from_core_mm
        out[k, 2 * i] += (1 - share) * dx
        out[k, 2 * i + 1] += (1 - share) * dy
        out[k, 2 * j] += share * dx
        out[k, 2 * j + 1] += share * dy


@njit(cache=True)
def _sides(points):  # type: ignore[no-untyped-def]
    """The sides of a polygon (m, 2) from each point to the next: x, y and the square of the length (m, 3)."""
    sides = np.empty((len(points), 3))
    for i in range(len(points)):
        j = (i + 1) % len(points)
        vx, vy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
        sides[i, 0], sides[i, 1], sides[i, 2] = vx, vy, vx * vx + vy * vy + NOTHING_MM2
    return sides


@njit(cache=True)
def _from_core(x, y, points, sides):  # type: ignore[no-untyped-def]
    """Distance of a place from a point, a stretch or a polygon (m, 2) with its sides, negative within a
    polygon; the nearest side, and at which share of it.

    The root is taken only of squares that are, but for rounding, the least so far: it takes longest.
    """
    inside, best, best2, side, share = False, math.inf, math.inf, 0, 0.0
    for i in range(len(points)):
        vx, vy = sides[i, 0], sides[i, 1]
        wx, wy = x - points[i, 0], y - points[i, 1]
        t = min(max((wx * vx + wy * vy) / sides[i, 2], 0.0), 1.0)
        ax, ay = wx - t * vx, wy - t * vy
        square = ax * ax + ay * ay
        if square <= best2:
            away_mm = math.hypot(ax, ay)
            if away_mm < best:
                best, side, share = away_mm, i, t
            best2 = square * (1 + arrays.ROUNDED)
        j = (i + 1) % len(points)
        if (points[i, 1] > y) != (points[j, 1] > y) and x < points[i, 0] + wy * vx / vy:
            inside = not inside
    return -best if inside else best, side, share
