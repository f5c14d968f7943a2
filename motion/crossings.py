"""Crossings: where polylines cross.

Signals: polylines (n, 2) mm in; crossings out. A crossing is the number of a place with the share of the
piece after it: 3.25 is a quarter of the way from place 3 to place 4.

Pieces come along lines, so that those of neighbouring numbers lie near each other: each `BOXED` have a box.
Boxes are gone through from left to right, and pieces are held against each other where two boxes overlap.

Source: our own; sweep and prune, as simulations of many bodies have it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit

Ints = NDArray[np.int64]
CELL_MM = 0.05  # at least, of the grid that says in which order crossings come
BOXED = (
    16  # pieces have one box: as fast with 8, half as fast with 32, by trial on 12 000 pieces
)


def crossings(one_mm: Array, other_mm: Array) -> Array:
    """Where two polylines cross: places of each, (n, 2), along the first; quick if all pieces are short."""
    both, begin = np.ascontiguousarray(np.vstack([one_mm, other_mm])), len(one_mm)
    pieces = np.delete(np.arange(len(both) - 1), begin - 1)
    found = crossings_of(both, pieces)
    of_each = (found[:, 0] < begin) & (found[:, 1] >= begin)
    found = found[of_each] - [0, begin]
    return np.asarray(found[np.argsort(found[:, 0])])


def crossings_of(points: Array, pieces: Ints) -> Array:
    """Where straight pieces, given by the numbers of their first points, cross: places of both, (n, 2)."""
    if not len(pieces):
        return np.empty((0, 2))
    found = _crossings_in(points, pieces)
    if len(found) > 1:
        found = found[_by_cells(points, pieces, found[:, 2:].astype(np.int64))]
    return np.ascontiguousarray(found[:, :2])


def _by_cells(points: Array, pieces: Ints, crossed: Ints) -> Ints:
    """The order in which crossings of pieces (n, 2) come: by the cells of a grid in which these begin."""
    longest_mm = float(np.hypot(*(points[pieces + 1] - points[pieces]).T).max())
    cell_mm = max(CELL_MM, 2 * longest_mm)
    one, other = crossed.T
    by = [other, *_cells(points[other], cell_mm), one, *_cells(points[one], cell_mm)]
    return np.lexsort(by)


def _cells(points: Array, cell_mm: float) -> Ints:
    """The row and the column of the cells that points (n, 2) lie in, (2, n)."""
    return np.floor(points[:, ::-1] / cell_mm).astype(np.int64).T


@njit(cache=True)
def _crossings_in(points, pieces):  # type: ignore[no-untyped-def]
    """The crossings of pieces: places of both, and the numbers of the pieces, which rise, (n, 4)."""
    boxes = _boxes_about(points, pieces)
    order = np.argsort(boxes[:, 0])
    found, count = np.empty((16, 4)), 0
    for k in range(len(order)):
        one = boxes[order[k]]
        for n in range(k, len(order)):
            other = boxes[order[n]]
            if other[0] > one[2]:
                break
            if other[1] > one[3] or one[1] > other[3]:
                continue
            first, last = min(order[k], order[n]), max(order[k], order[n])
            for m in range(first * BOXED, min((first + 1) * BOXED, len(pieces))):
                i = pieces[m]
                for q in range(max(m + 1, last * BOXED), min((last + 1) * BOXED, len(pieces))):
                    j = pieces[q]
                    if j == i + 1 or _are_apart(points, i, j):
                        continue
                    u, v = _where(points, i, j)
                    if not (0.0 <= u < 1.0 and 0.0 <= v < 1.0):
                        continue
                    if count == len(found):
                        found = np.concatenate((found, np.empty_like(found)))
                    found[count, 0], found[count, 1] = i + u, j + v
                    found[count, 2], found[count, 3] = i, j
                    count += 1
    return found[:count].copy()


@njit(cache=True)
def _are_apart(points, i, j):  # type: ignore[no-untyped-def]
    """Whether one of two pieces lies beside the other, in x, all of it."""
    a, b, c, d = points[i, 0], points[i + 1, 0], points[j, 0], points[j + 1, 0]
    return max(a, b) < min(c, d) or max(c, d) < min(a, b)


@njit(cache=True)
def _where(points, i, j):  # type: ignore[no-untyped-def]
    """Which share of either of two pieces lies before the place where their straight lines cross; -1 where
    these are parallel.
    """
    ax, ay = points[i, 0], points[i, 1]
    px, py = points[i + 1, 0] - ax, points[i + 1, 1] - ay
    qx, qy = points[j + 1, 0] - points[j, 0], points[j + 1, 1] - points[j, 1]
    cross = px * qy - py * qx
    if cross == 0.0:
        return -1.0, -1.0
    wx, wy = points[j, 0] - ax, points[j, 1] - ay
    return (wx * qy - wy * qx) / cross, (wx * py - wy * px) / cross


@njit(cache=True)
def _boxes_about(points, pieces):  # type: ignore[no-untyped-def]
    """The boxes about pieces, so many in each: least x and y, greatest x and y, (n, 4)."""
    boxes = np.empty(((len(pieces) + BOXED - 1) // BOXED, 4))
    boxes[:, :2], boxes[:, 2:] = np.inf, -np.inf
    for k in range(len(pieces)):
        b, i = k // BOXED, pieces[k]
        for axis in range(2):
            low, high = (
                min(points[i, axis], points[i + 1, axis]),
                max(points[i, axis], points[i + 1, axis]),
            )
            boxes[b, axis] = min(boxes[b, axis], low)
            boxes[b, axis + 2] = max(boxes[b, axis + 2], high)
    return boxes
