"""How far places are from a way: from the nearest of its straight pieces.

Signals: places (n, 2) and pieces, x and y of either end (4, k), in; distances out, all mm. Of a long way a
place meets only the pieces in whose box one may be nearer than the nearest so far.

Source: our own.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.plane import NOTHING_MM2

NOWHERE_MM = 1e3  # from all that is drawn
LONG, BOXED = 300, 64  # pieces of a long way, and those of it that have one box; by trial
GROUPED = 16  # boxes that have one about them: of a way of 12 000 pieces a place meets a twelfth of all boxes


@njit(cache=True, fastmath=True)
def away(places, lines, count, out):  # type: ignore[no-untyped-def]
    """Lower distances (n,) of places to those from the first pieces of some lines (4, k), mm."""
    x0, y0 = lines[0, :count].copy(), lines[1, :count].copy()
    vx, vy = lines[2, :count] - x0, lines[3, :count] - y0
    per = 1.0 / (vx * vx + vy * vy + NOTHING_MM2)
    for k in range(len(places)):
        best = out[k] * out[k]
        x, y = places[k, 0], places[k, 1]
        for i in range(count):
            wx, wy = x - x0[i], y - y0[i]
            t = min(max((wx * vx[i] + wy * vy[i]) * per[i], 0.0), 1.0)
            wx, wy = wx - t * vx[i], wy - t * vy[i]
            best = min(best, wx * wx + wy * wy)
        out[k] = math.sqrt(best)


def away_from(places: Array, way: Array) -> Array:
    """How far places (n, 2) are from a way (m, 2), mm."""
    distance = np.full(len(places), NOWHERE_MM)
    lines = np.ascontiguousarray(np.hstack([way[:-1], way[1:]]).T)
    if len(way) <= LONG:
        away(places, lines, len(way) - 1, distance)
    else:
        _away_by_boxes(places, lines, distance)
    return distance


@njit(cache=True)
def boxes_of(lines):  # type: ignore[no-untyped-def]
    """The boxes about pieces of lines (4, k), so many in each: least x and y, greatest x and y, (n, 4)."""
    count = lines.shape[1]
    boxes = np.empty(((count + BOXED - 1) // BOXED, 4))
    for b in range(len(boxes)):
        low_x = low_y = NOWHERE_MM
        high_x = high_y = -NOWHERE_MM
        for i in range(b * BOXED, min((b + 1) * BOXED, count)):
            low_x, high_x = (
                min(low_x, lines[0, i], lines[2, i]),
                max(high_x, lines[0, i], lines[2, i]),
            )
            low_y, high_y = (
                min(low_y, lines[1, i], lines[3, i]),
                max(high_y, lines[1, i], lines[3, i]),
            )
        boxes[b, 0], boxes[b, 1], boxes[b, 2], boxes[b, 3] = low_x, low_y, high_x, high_y
    return boxes


@njit(cache=True)
def groups_of(boxes):  # type: ignore[no-untyped-def]
    """The boxes about some boxes (n, 4), so many in each."""
    groups = np.empty(((len(boxes) + GROUPED - 1) // GROUPED, 4))
    for g in range(len(groups)):
        some = boxes[g * GROUPED : (g + 1) * GROUPED]
        groups[g, 0], groups[g, 1] = some[:, 0].min(), some[:, 1].min()
        groups[g, 2], groups[g, 3] = some[:, 2].max(), some[:, 3].max()
    return groups


@njit(cache=True)
def to_box2(boxes, b, x, y):  # type: ignore[no-untyped-def]
    """The square of the distance of a place from a box."""
    dx = max(boxes[b, 0] - x, x - boxes[b, 2], 0.0)
    dy = max(boxes[b, 1] - y, y - boxes[b, 3], 0.0)
    return dx * dx + dy * dy


@njit(cache=True, fastmath=True)
def _away_by_boxes(places, lines, out):  # type: ignore[no-untyped-def]
    """The same as `away` of a long way: a place meets only those pieces in whose box it may be nearer."""
    count = lines.shape[1]
    x0, y0 = lines[0], lines[1]
    vx, vy = lines[2] - x0, lines[3] - y0
    per = 1.0 / (vx * vx + vy * vy + NOTHING_MM2)
    boxes = boxes_of(lines)
    groups = groups_of(boxes)
    # the box in which the place before was nearest comes first
    newest = 0
    for k in range(len(places)):
        best = out[k] * out[k]
        x, y = places[k, 0], places[k, 1]
        for g in range(-1, len(groups)):
            if g >= 0 and to_box2(groups, g, x, y) >= best:
                continue
            first = newest if g < 0 else g * GROUPED
            for b in range(first, first + 1 if g < 0 else min(first + GROUPED, len(boxes))):
                if to_box2(boxes, b, x, y) >= best:
                    continue
                before = best
                for i in range(b * BOXED, min((b + 1) * BOXED, count)):
                    wx, wy = x - x0[i], y - y0[i]
                    t = min(max((wx * vx[i] + wy * vy[i]) * per[i], 0.0), 1.0)
                    wx, wy = wx - t * vx[i], wy - t * vy[i]
                    best = min(best, wx * wx + wy * wy)
                if best < before:
                    newest = b
        out[k] = math.sqrt(best)
