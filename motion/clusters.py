"""Clusters: which of many points hang together, each no further than a reach from another one of its cluster.

    ·· ·· ·        · ··          within a reach from point to point: two clusters
    ▔▔▔▔▔▔▔        ▔▔▔▔

The points lie in square cells whose diagonal is the reach, so those of one cell hang together. Of two cells
near each other points are tried until two are within the reach, unless the cells hang together already.

Signals in: points (n, 2), and the reach, mm or pixels. Signals out: the number of each point's cluster, in
the order of their first points.

Source: disjoint sets with halved ways (Tarjan). `neighbours.pairs_within` gives all pairs, of which crowded
points have hundreds each.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from morfax.motion.arrays import ROUNDED
from morfax.motion.compiled import njit

# rows and columns to the cells that are near a cell; those on its other side are near by these too
NEAR = [(0, 1), (0, 2), *((down, along) for down in (1, 2) for along in range(-2, 3))]


def clusters(points: ArrayLike, reach: float) -> NDArray[np.int64]:
    """The number of the cluster (n,) of each of the points (n, 2)."""
    points = np.asarray(points, np.float64).reshape(-1, 2)
    if not len(points):
        return np.empty(0, np.int64)
    # 1. the points in the order of their cells
    side = (1 - ROUNDED) * reach / np.sqrt(2)
    row, column = ((points - points.min(axis=0)) / side).astype(np.int64).T
    across = int(column.max()) + 3  # cells beside the last of a row are empty
    key = row * across + column
    order = np.argsort(key, kind="stable")
    cells, begins = np.unique(key[order], return_index=True)
    begins = np.append(begins, len(points))
    # 2. cells that are near each other
    first = np.arange(len(cells))
    for down, along in NEAR:
        wanted = cells + down * across + along
        other = np.minimum(np.searchsorted(cells, wanted), len(cells) - 1)
        near = np.flatnonzero(cells[other] == wanted)
        _join(points[order], begins, np.column_stack([near, other[near]]), reach, first)
    # 3. numbered in the order of their points
    of_point = np.empty(len(points), np.int64)
    of_point[order] = np.repeat(first, np.diff(begins))
    _, begin, number = np.unique(of_point, return_index=True, return_inverse=True)
    return np.asarray(np.argsort(np.argsort(begin))[number.reshape(-1)], np.int64)


@njit(cache=True, nogil=True)
def _join(points, begins, near, reach, first):  # type: ignore[no-untyped-def]
    """Join cells near each other, pairs (m, 2), of which two points are within the reach: fill in the first
    cell of each one's cluster.
    """
    for pair in range(len(near)):
        one, other = near[pair]
        a, b = _first(first, one), _first(first, other)
        if a == b:
            continue
        is_within = False
        for k in range(begins[one], begins[one + 1]):
            for m in range(begins[other], begins[other + 1]):
                x, y = points[m, 0] - points[k, 0], points[m, 1] - points[k, 1]
                is_within = x * x + y * y <= reach * reach
                if is_within:
                    break
            if is_within:
                break
        if is_within:
            first[max(a, b)] = min(a, b)
    for cell in range(len(first)):
        first[cell] = _first(first, cell)


@njit(cache=True, nogil=True)
def _first(first, cell):  # type: ignore[no-untyped-def]
    """The first cell of a cell's cluster, as far as it is joined; the way there is halved."""
    while first[cell] != cell:
        first[cell] = first[first[cell]]
        cell = first[cell]
    return cell
