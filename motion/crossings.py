"""Crossings: where polylines cross.

Signals: polylines (n, 2) mm in; crossings out. A crossing is the number of a place with the share of the
piece after it: 3.25 is a quarter of the way from place 3 to place 4.

Source: our own; a grid, so that each piece is held against its neighbours only.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit

Ints = NDArray[np.int64]
CELL_MM = 0.05  # at least, of the grid in which crossings are sought


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
    longest_mm = float(np.hypot(*(points[pieces + 1] - points[pieces]).T).max())
    cell_mm = max(CELL_MM, 2 * longest_mm)  # two that cross begin within a cell of each other
    cells = np.floor(points[pieces] / cell_mm).astype(np.int64)
    cells -= cells.min(axis=0) - 1
    wide = int(cells[:, 1].max()) + 2
    keys = cells[:, 0] * wide + cells[:, 1]
    order = np.argsort(keys, kind="stable")
    return _crossings_in(points, pieces[order], keys[order], wide)


@njit(cache=True)
def _crossings_in(points, pieces, keys, wide):  # type: ignore[no-untyped-def]
    """The crossings of pieces that are sorted by the cells of a grid; a piece is shorter than half a cell."""
    found = np.empty((16, 2))
    count = 0
    for m in range(len(pieces)):
        i = pieces[m]
        ax = points[i, 0]
        ay = points[i, 1]
        px = points[i + 1, 0] - ax
        py = points[i + 1, 1] - ay
        for column in range(-1, 2):
            first = keys[m] + column * wide - 1
            for n in range(np.searchsorted(keys, first), len(pieces)):
                if keys[n] > first + 2:
                    break
                j = pieces[n]
                if j <= i + 1:
                    continue
                qx = points[j + 1, 0] - points[j, 0]
                qy = points[j + 1, 1] - points[j, 1]
                cross = px * qy - py * qx
                if cross == 0.0:
                    continue
                wx = points[j, 0] - ax
                wy = points[j, 1] - ay
                u = (wx * qy - wy * qx) / cross
                v = (wx * py - wy * px) / cross
                if 0.0 <= u < 1.0 and 0.0 <= v < 1.0:
                    if count == len(found):
                        found = np.concatenate((found, np.empty_like(found)))
                    found[count, 0] = i + u
                    found[count, 1] = j + v
                    count += 1
    return found[:count].copy()
