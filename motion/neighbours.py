"""Neighbours: which of many points lie nearest to a place, exactly.

Signals in: points (n, 2) and places (m, 2), mm or pixels. Signals out: distances and numbers of points.

Points come along lines, so points of neighbouring numbers lie near each other. Each `LEAF` of them have a
box, each two boxes a larger one, up to one box round all:

    box 1
    box 2            box 3
    box 4   box 5    box 6   box 7
    0…7     8…15     16…23   24…31       numbers of points

Points without such an order are put into one first, along a Z-curve.

A place looks into the nearer of two boxes first, and into no box that is further off than what was found. It
begins with what the place before it found, since places come along lines as well. Of points at the same
distance the one with the lowest number is found.

Source: bounding volume hierarchies, as ray tracers have them. scipy's k-d tree does the same for points in
any order; to import it takes as long as to import numpy, and following a page needs nothing else of scipy.
Questions: none.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit

LEAF = 8  # points to a smallest box: 4 and 16 take a tenth longer
DEEPEST = 64  # boxes within boxes: no memory holds 2^64 points
# way from point to point in times of √(n · area): 0.7 along a curve that fills the area, √n / 2 at random
IN_ORDER = 4.0
BITS = 16  # of each axis of the Z-curve


class Neighbours:
    """Finds the nearest of some points (n, 2)."""

    def __init__(self, points: ArrayLike) -> None:
        given = np.asarray(points, np.float64).reshape(-1, 2)
        self._order = None if _is_in_order(given) else _along_z(given)
        ordered = given if self._order is None else given[self._order]
        self._points = np.ascontiguousarray(ordered)
        leaves = 1 << (-(-len(given) // LEAF) - 1).bit_length()
        self._boxes = np.empty((2 * leaves, 4))
        _boxed(self._points, leaves, self._boxes)

    def nearest(
        self, places: ArrayLike, within: float = np.inf
    ) -> tuple[Array, NDArray[np.int64]]:
        """The distance of each place (m, 2) from the nearest point, and that point's number.

        Where no point is nearer than `within`, the distance is infinite and the number n.
        """
        away, number = self._some(places, 1, within)
        return away[:, 0], number[:, 0]

    def several(self, places: ArrayLike, count: int) -> NDArray[np.int64]:
        """The numbers (m, count) of the nearest points of each place, the nearest first; count <= n."""
        return self._some(places, count, np.inf)[1]

    def _some(
        self, places: ArrayLike, count: int, within: float
    ) -> tuple[Array, NDArray[np.int64]]:
        """Distances and numbers (m, count) of the nearest points."""
        at = np.ascontiguousarray(places, np.float64).reshape(-1, 2)
        squared = np.full((len(at), count), within * within)
        number = np.full((len(at), count), len(self._points))
        _searched(self._points, self._boxes, at, squared, number)
        away = np.where(number < len(self._points), np.sqrt(squared), np.inf)
        if self._order is not None:
            number = np.r_[self._order, len(self._points)][number]
        return away, number


def pairs_within(points: ArrayLike, reach: float) -> NDArray[np.int64]:
    """The pairs (m, 2) of points (n, 2) that are no further apart than a reach; m may be n² / 2."""
    points = np.asarray(points, np.float64)
    order = np.argsort(points[:, 0], kind="stable")
    ordered = points[order]
    found = [np.empty((0, 2), np.int64)]
    ends = np.searchsorted(ordered[:, 0], ordered[:, 0] + reach, side="right")
    for k, end in enumerate(ends.tolist()):
        away = np.hypot(*(ordered[k + 1 : end] - ordered[k]).T)
        near = order[k + 1 : end][away <= reach]
        found.append(np.column_stack([np.full(len(near), order[k]), near]))
    return np.vstack(found)


def _is_in_order(points: Array) -> bool:
    """Whether points of neighbouring numbers lie near each other."""
    if not len(points):
        return True
    sides = np.ptp(points, axis=0)
    way = float(np.hypot(*np.diff(points, axis=0).T).sum())
    return way <= IN_ORDER * (float(np.sqrt(len(points) * sides.prod())) + float(sides.sum()))


def _along_z(points: Array) -> NDArray[np.int64]:
    """The numbers of the points along a Z-curve: the bits of x and of y in turn make its place."""
    low = points.min(axis=0)
    side = max(float(np.ptp(points, axis=0).max()), 1e-300)
    bits = ((points - low) * ((2**BITS - 1) / side)).astype(np.uint64)
    for shift, kept in ((8, 0x00FF00FF), (4, 0x0F0F0F0F), (2, 0x33333333), (1, 0x55555555)):
        bits = (bits | (bits << np.uint64(shift))) & np.uint64(kept)
    return np.argsort(bits[:, 0] | (bits[:, 1] << np.uint64(1)), kind="stable")


@njit(cache=True, nogil=True)
def _boxed(points: Array, leaves: int, boxes: Array) -> None:
    """Fill in the boxes: lowest and highest x and y; those without points are nowhere."""
    boxes[:, :2] = np.inf
    boxes[:, 2:] = -np.inf
    for i in range(len(points)):
        box = boxes[leaves + i // LEAF]
        for axis in range(2):
            box[axis] = min(box[axis], points[i, axis])
            box[2 + axis] = max(box[2 + axis], points[i, axis])
    for k in range(leaves - 1, 0, -1):
        for axis in range(2):
            boxes[k, axis] = min(boxes[2 * k, axis], boxes[2 * k + 1, axis])
            boxes[k, 2 + axis] = max(boxes[2 * k, 2 + axis], boxes[2 * k + 1, 2 + axis])


@njit(cache=True, nogil=True)
def _off(box: Array, x: float, y: float) -> float:
    """Square of the distance of a place from a box; infinite from one without points."""
    dx = max(box[0] - x, x - box[2], 0.0)
    dy = max(box[1] - y, y - box[3], 0.0)
    return dx * dx + dy * dy


@njit(cache=True, nogil=True)
def _apart(point: Array, place: Array) -> float:
    """Square of the distance of a place from a point."""
    x = point[0] - place[0]
    y = point[1] - place[1]
    return x * x + y * y


@njit(cache=True, nogil=True)
def _put(away: float, i: int, squared: Array, number: NDArray[np.int64]) -> None:
    """Put a point among the nearest of a place, in its order; the last of them falls out."""
    slot = len(squared) - 1
    while slot > 0 and (
        away < squared[slot - 1] or (away == squared[slot - 1] and i < number[slot - 1])
    ):
        squared[slot] = squared[slot - 1]
        number[slot] = number[slot - 1]
        slot -= 1
    squared[slot], number[slot] = away, i


@njit(cache=True, nogil=True)
def _look_through(
    points: Array, first: int, place: Array, squared: Array, number: NDArray[np.int64]
) -> None:
    """Put the points of a leaf among the nearest of a place, as far as they are."""
    for i in range(first, min(first + LEAF, len(points))):
        away = _apart(points[i], place)
        if away < squared[-1] or (away == squared[-1] and i < number[-1]):
            _put(away, i, squared, number)


@njit(cache=True, nogil=True)
def _searched(
    points: Array, boxes: Array, places: Array, squared: Array, number: NDArray[np.int64]
) -> None:
    """Fill in squares of distances and numbers (m, k), which hold the limit and n to begin with."""
    leaves = len(boxes) // 2
    left = np.empty(2 * DEEPEST, np.int64)
    for m in range(len(places)):
        place = places[m]
        far = squared[m]
        found = number[m]
        # 1. what the place before found is no nearer than what this one will find
        limit = far[-1]
        if m > 0 and number[m - 1, -1] < len(points):
            reached = 0.0
            for i in number[m - 1]:
                reached = max(reached, _apart(points[i], place))
            limit = min(limit, reached)
        # 2. down from the box round all
        left[0], waiting = 1, 1
        while waiting > 0:
            waiting -= 1
            box = left[waiting]
            if _off(boxes[box], place[0], place[1]) > min(limit, far[-1]):
                continue
            if box >= leaves:
                _look_through(points, (box - leaves) * LEAF, place, far, found)
                continue
            near, other = 2 * box, 2 * box + 1
            if _off(boxes[other], place[0], place[1]) < _off(boxes[near], place[0], place[1]):
                near, other = other, near
            left[waiting], left[waiting + 1] = other, near
            waiting += 2
