"""The ray: a cell moved from a place along a line or a parabola until the darkness crosses the level.

Signals: the cells, a ray (place in sheet mm, direction, bend in 1/mm) and a stretch of it in mm in; the
distance to the crossing in mm out, interpolated between two samples that are `STEP_PX` apart.

    place(u) = start + u·t + bend/2·u²·n            t, n: along the ray and to its left

Every search for an edge in the tracer goes through `crossing_mm`.

Source: our own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from morfax.motion.compiled import njit
from morfax.tracer.sensing.photocell import STEP_PX, darkness_at, darkness_on

SPECK_PX, SPECK_MM = 2.2, 0.25  # no wider is a speck: one pixel seen through the aperture
# of the darkness: of two places as dark the nearer one; less than noise over the reach of a line
FAR_PER_MM = 1e-3


class Ray(NamedTuple):
    """Where a ray begins (sheet mm), its direction there (cosine, sine), and its bend to the left (1/mm)."""

    x_mm: float
    y_mm: float
    cosine: float
    sine: float
    bend_per_mm: float = 0.0


@njit(cache=True, inline="always")
def seen_on(cells, ray, u_mm):  # type: ignore[no-untyped-def]
    """Darkness on a ray at a distance from its beginning."""
    aside = 0.5 * ray.bend_per_mm * u_mm * u_mm
    x = ray.x_mm + u_mm * ray.cosine - aside * ray.sine
    y = ray.y_mm + u_mm * ray.sine + aside * ray.cosine
    return darkness_at(cells, x, y)


@njit(cache=True, _nrt=False)
def crossing_mm(cells, ray, begin_mm, end_mm, speck_mm):  # type: ignore[no-untyped-def]
    """Distance along a ray at which ink changes to paper, or paper to ink; NaN if neither happens.

    The search runs from `begin_mm` to the first sample at or beyond `end_mm`. A change that is undone within
    `speck_mm` is a speck, and the search goes on.
    """
    level, step = cells.level, STEP_PX * cells.pitch_mm
    before = seen_on(cells, ray, begin_mm)
    begins_dark, found = before >= level, math.nan
    k, u = 0, begin_mm
    while u < end_mm:
        k += 1
        u = begin_mm + k * step
        now = seen_on(cells, ray, u)
        if (now >= level) != (before >= level):
            undone = (now >= level) == begins_dark
            found = math.nan if undone else u - step * (level - now) / (before - now)
        if u - found >= speck_mm:
            return found
        before = now
    return math.nan


@njit(cache=True, _nrt=False)
def end_of_ink(cells, ray, begin_mm, end_mm):  # type: ignore[no-untyped-def]
    """Distance along a ray at which the ink ends; NaN if the ray begins on paper, or the ink goes on."""
    if seen_on(cells, ray, begin_mm) < cells.level:
        return math.nan
    return crossing_mm(cells, ray, begin_mm, end_mm, 0.0)


@njit(cache=True, _nrt=False)
def edge_along(cells, x_mm, y_mm, direction, reach_mm):  # type: ignore[no-untyped-def]
    """How far the ink under (x, y) goes on in a direction, mm, past specks of paper; NaN if there is no ink,
    or if it reaches farther.
    """
    ray = Ray(x_mm, y_mm, math.cos(direction), math.sin(direction), 0.0)
    if seen_on(cells, ray, 0.0) < cells.level:
        return math.nan
    return crossing_mm(cells, ray, 0.0, reach_mm, min(SPECK_PX * cells.pitch_mm, SPECK_MM))


@njit(cache=True, _nrt=False)
def edges(cells, x_mm, y_mm, heading, reach_mm):  # type: ignore[no-untyped-def]
    """Where the line under (x, y) ends to the right and to the left of a heading, mm; NaN for an edge out of
    reach or no ink.

    The search starts at the darkest place within half the reach.
    """
    return edges_beside(cells, (x_mm, y_mm), (math.cos(heading), math.sin(heading)), reach_mm)


@njit(cache=True, _nrt=False)
def edges_beside(cells, place_mm, way, reach_mm):  # type: ignore[no-untyped-def]
    """The same of the unit vector of a heading.

    Each place is looked at once, from the right to the left: the newest change before the darkest place so
    far and the first one after it are its edges. All this is in pixels, and in steps between the looks.
    """
    step_mm = STEP_PX * cells.pitch_mm
    half = math.ceil(reach_mm / step_mm)
    first, last = -half // 2, half // 2
    x, y = place_mm[0] / cells.pitch_mm, place_mm[1] / cells.pitch_mm
    dx, dy = -STEP_PX * way[1], STEP_PX * way[0]
    far, level = FAR_PER_MM * step_mm, cells.level
    # 1. within half the reach
    before = darkness_on(cells, x + first * dx, y + first * dy)
    darkest, right, left, changed = before - far * abs(first), math.nan, math.nan, math.nan
    for k in range(first + 1, last + 1):
        now = darkness_on(cells, x + k * dx, y + k * dy)
        if (now >= level) != (before >= level):
            changed = k - (level - now) / (before - now)
            if math.isnan(left):
                left = changed
        if now - far * abs(k) > darkest:
            darkest, right, left = now - far * abs(k), changed, math.nan
        before = now
    if darkest < level:
        return math.nan, math.nan
    right_mm, left_mm = right * step_mm, left * step_mm
    # 2. further out, to one sample beyond the reach
    end_mm = (half + 0.5) * step_mm
    if math.isnan(right):
        ray = Ray(place_mm[0], place_mm[1], way[1], -way[0], 0.0)
        right_mm = -crossing_mm(cells, ray, -first * step_mm, end_mm, 0.0)
    if math.isnan(left):
        ray = Ray(place_mm[0], place_mm[1], -way[1], way[0], 0.0)
        left_mm = crossing_mm(cells, ray, last * step_mm, end_mm, 0.0)
    return right_mm, left_mm
