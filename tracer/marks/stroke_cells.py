"""Stroke cells: what the cells see of a stroke beside the line, in rows along the path.

Signals: the cells, the place of the path from which a stroke is felt and the side, in; its middles along and
away from the path and its widths, how dark it is, and what ink is beside it and beyond it, out; all mm.

Source: our own (see `ticks`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.tracer.limits import CLEAR_WIDTHS
from morfax.tracer.sensing.gauge import WIDEST
from morfax.tracer.sensing.photocell import STEP_PX
from morfax.tracer.sensing.ray import Ray, end_of_ink, seen_on
from morfax.tracer.sensing.scout import SPECK_MM, SPECK_PX

ACROSS = 1.2  # widths, along the path from a stroke's middle: its edges are nearer
STRAY = 0.25  # widths: the middle of a dash is no further from the stroke's own line
# of paper on a stroke, at most as long as a speck
SPECK_WIDTHS = 0.6
NEAREST = 0.4  # widths from the path: the line's own ink is not felt


class Base(NamedTuple):
    """Where and to which side a stroke is felt: a place of the path (mm), the path's direction there (unit
    vector), and the side, 1 left or -1 right."""

    place: Array
    along: Array
    side: int


@njit(cache=True)
def _row(base, v_mm):  # type: ignore[no-untyped-def]
    """The ray along the path at a distance away from it."""
    place, along, side = base
    x = place[0] - side * v_mm * along[1]
    y = place[1] + side * v_mm * along[0]
    return Ray(x, y, along[0], along[1], 0.0)


@njit(cache=True)
def darkness_of(cells, base, middles):  # type: ignore[no-untyped-def]
    """The darkness of a stroke along its middle."""
    seen = np.empty(len(middles))
    for k in range(len(middles)):
        seen[k] = seen_on(cells, _row(base, middles[k, 1]), middles[k, 0])
    return np.median(seen)


@njit(cache=True)
def soiled_beside(cells, base, middles, beside_mm):  # type: ignore[no-untyped-def]
    """The share of ink to both sides of a stroke, between two distances from its edges."""
    dark = count = 0
    for k in range(len(middles)):
        for out in np.arange(beside_mm[0], beside_mm[1], cells.pitch_mm):
            for to in (-1, 1):
                u = middles[k, 0] + to * (0.5 * middles[k, 2] + out)
                dark += seen_on(cells, _row(base, middles[k, 1]), u) > cells.level
                count += 1
    return dark / max(count, 1)


@njit(cache=True)
def goes_on(cells, base, middles, beyond_mm, width_mm):  # type: ignore[no-untyped-def]
    """Whether a stroke goes on in its own line after a gap, for one and a half widths or more."""
    last = np.argmax(middles[:, 1])
    first = np.argmin(middles[:, 1])
    u, v = middles[last, 0], middles[last, 1]
    slant = (u - middles[first, 0]) / max(v - middles[first, 1], 0.5 * width_mm)
    step, run = 0.5 * cells.pitch_mm, 0.0
    for k in range(1, int(beyond_mm / step)):
        there = u + slant * k * step
        right, left = _across(cells, base, there, v + k * step, ACROSS * width_mm)
        stray = abs(0.5 * (left + right) - there)
        like = left - right < WIDEST * width_mm and stray < STRAY * width_mm
        run = run + step if like else 0.0
        if run > CLEAR_WIDTHS * width_mm:
            return True
    return False


@njit(cache=True)
def stroke_at(cells, base, away_mm, farthest_mm, width_mm):  # type: ignore[no-untyped-def]
    """Middles (along, away) and widths of a stroke, (n, 3) mm, felt inward and outward from a place on it.

    It ends where no ink is left but specks.
    """
    step = 0.5 * cells.pitch_mm
    speck_mm = min(max(SPECK_MM, SPECK_PX * cells.pitch_mm), SPECK_WIDTHS * width_mm)
    seen = np.empty((2 * int(farthest_mm / step) + 4, 3))
    count = 0
    for way in (-1, 1):
        u, v = 0.0, away_mm if way < 0 else away_mm + step
        if way > 0 and count:
            u = seen[0, 0]
        last = v
        while NEAREST * width_mm < v <= farthest_mm:
            right, left = _across(cells, base, u, v, ACROSS * width_mm)
            if math.isnan(left - right):
                if abs(v - last) > speck_mm:
                    break
                v += way * step
                continue
            last = v
            u = 0.5 * (left + right)
            seen[count, 0], seen[count, 1], seen[count, 2] = u, v, left - right
            count += 1
            v += way * step
    return seen[:count].copy()


@njit(cache=True)
def _across(cells, base, u_mm, v_mm, reach_mm):  # type: ignore[no-untyped-def]
    """Where ink about u ends, back and forth along the path, at a distance v from it; NaN if it does not."""
    ahead = _row(base, v_mm)
    x, y = ahead.x_mm + u_mm * ahead.cosine, ahead.y_mm + u_mm * ahead.sine
    ahead = Ray(x, y, ahead.cosine, ahead.sine, 0.0)
    back = Ray(x, y, -ahead.cosine, -ahead.sine, 0.0)
    last_mm = reach_mm - STEP_PX * cells.pitch_mm  # no sample beyond the reach
    behind = end_of_ink(cells, back, 0.0, last_mm)
    before = end_of_ink(cells, ahead, 0.0, last_mm)
    return u_mm - behind, u_mm + before
