"""Neighbours: which of many points lie nearest to a place, exactly.

Signals in: points (n, 2) and places (m, 2), mm or pixels. Signals out: distances and numbers of points.

Points come along lines, so points of neighbouring numbers lie near each other. Each `LEAF` of them have a
box, each two boxes a larger one, up to one box round all:

    box 1
    box 2            box 3
    box 4   box 5    box 6   box 7
    0…7     8…15     16…23   24…31       numbers of points

Where that makes large boxes, as of many short lines in any order, the points are put along a Z-curve first.

A place looks into the nearer of two boxes first, and into no box that is further off than what was found. It
begins with what the place before it found, since places come along lines as well. Of points at the same
distance the one with the lowest number is found.

Source: bounding volume hierarchies, as ray tracers have them. scipy's k-d tree does the same for points in
any order; to import it takes as long as to import numpy, and following a page needs nothing else of scipy.
Questions: none.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from morfax.motion.arrays import ROUNDED, Array, bounds
from morfax.motion.compiled import njit

LEAF = 8  # points to a smallest box: 4 and 16 take a tenth longer
DEEPEST = 64  # boxes within boxes: no memory holds 2^64 points
# a place meets more boxes than this: the points are in no order. Along lines it meets 4 to 24, along a
# Z-curve 6 to 40, and of 1000 circles in any order 1050
MOST_MET = 50.0
TINY = 1e-100  # of points that are all alike
BITS = 16  # of each axis of the Z-curve


class Neighbours:
    """Finds the nearest of some points (n, 2)."""

    def __init__(self, points: ArrayLike) -> None:
        self._points = np.ascontiguousarray(points, np.float64).reshape(-1, 2)
        self._boxes = _boxes_of(self._points)
        self._numbers = np.arange(len(self._points) + 1)  # the last one is none
        if _met(self._boxes, len(self._points)) > MOST_MET:
            self._numbers[:-1] = _along_z(self._points)
            self._points = self._points[self._numbers[:-1]]
            self._boxes = _boxes_of(self._points)

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
        found = np.full((len(at), count), len(self._points))
        _searched((self._points, self._numbers), self._boxes, at, squared, found)
        away = np.where(found < len(self._points), np.sqrt(squared), np.inf)
        return away, self._numbers[found]


def those_near(ways: Sequence[Array], places: Array, reach: float) -> Iterator[Array]:
    """Those of some ways (n, 2) whose box comes within a reach of the box of places (m, 2): what is nearer to
    any of the places is among them.
    """
    low, high = bounds(places)
    low, high = low - (1 + ROUNDED) * reach, high + (1 + ROUNDED) * reach
    for way in ways:
        if len(way):
            first, last = bounds(way)
            if (first <= high).all() and (last >= low).all():
                yield way


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


def crowds(
    points: ArrayLike, reach: float, apart: int = 1
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """How many of the points (n, 2) are no further from each than a reach, of those with numbers lower by
    so many or more, and of those with numbers higher by as much.
    """
    points = np.asarray(points, np.float64)
    order = np.argsort(points[:, 0], kind="stable")
    lower, higher = np.zeros(len(order), np.int64), np.zeros(len(order), np.int64)
    _count_pairs((points[order], order), reach, apart, lower, higher)
    return lower, higher


@njit(cache=True, nogil=True)
def _count_pairs(numbered, reach, apart, lower, higher):  # type: ignore[no-untyped-def]
    """Count each pair at both its points, which stand in order of x with the number of each."""
    points, numbers = numbered
    for k in range(len(points)):
        for other in range(k + 1, len(points)):
            x, y = points[other, 0] - points[k, 0], points[other, 1] - points[k, 1]
            if x > reach:
                break
            if x * x + y * y <= reach * reach and abs(numbers[other] - numbers[k]) >= apart:
                lower[max(numbers[k], numbers[other])] += 1
                higher[min(numbers[k], numbers[other])] += 1


def _boxes_of(points: Array) -> Array:
    """The boxes (2 · leaves, 4) round some points: lowest and highest x and y; the first is none."""
    leaves = 1 << (-(-len(points) // LEAF) - 1).bit_length()
    boxes = np.empty((2 * leaves, 4))
    _boxed(points, leaves, boxes)
    return boxes


def _met(boxes: Array, count: int) -> float:
    """How many boxes a place anywhere meets with a square about it that holds one of so many points."""
    if not count:
        return 0.0
    width, height = (boxes[1:, 2:] - boxes[1:, :2]).T
    wide, high = float(width[0]), float(height[0])
    reach = float(np.sqrt(wide * high / count)) + max(wide, high) / count + TINY
    is_some = width >= 0.0
    met = (width[is_some] + reach) * (height[is_some] + reach)
    return float(met.sum()) / ((wide + reach) * (high + reach))


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
def _put(
    away: float, i: int, numbers: NDArray[np.int64], squared: Array, found: NDArray[np.int64]
) -> None:
    """Put a point among the nearest of a place, in its order; the last of them falls out."""
    slot = len(squared) - 1
    while slot > 0 and (
        away < squared[slot - 1]
        or (away == squared[slot - 1] and numbers[i] < numbers[found[slot - 1]])
    ):
        squared[slot] = squared[slot - 1]
        found[slot] = found[slot - 1]
        slot -= 1
    squared[slot], found[slot] = away, i


@njit(cache=True, nogil=True)
def _look_through(
    numbered: tuple[Array, NDArray[np.int64]],
    first: int,
    place: Array,
    squared: Array,
    found: NDArray[np.int64],
) -> None:
    """Put the points of a leaf among the nearest of a place, as far as they are."""
    points, numbers = numbered
    for i in range(first, min(first + LEAF, len(points))):
        away = _apart(points[i], place)
        if away < squared[-1] or (away == squared[-1] and numbers[i] < numbers[found[-1]]):
            _put(away, i, numbers, squared, found)


@njit(cache=True, nogil=True)
def _searched(
    numbered: tuple[Array, NDArray[np.int64]],
    boxes: Array,
    places: Array,
    squared: Array,
    found: NDArray[np.int64],
) -> None:
    """Fill in squares of distances and points (m, k), which hold the limit and n to begin with.

    `numbered`: the points as they stand in the boxes, and the number of each.
    """
    points, _ = numbered
    leaves = len(boxes) // 2
    left, left_off = np.empty(DEEPEST, np.int64), np.empty(DEEPEST)
    for m in range(len(places)):
        place = places[m]
        far, mine = squared[m], found[m]
        # 1. what the place before found is no nearer than what this one will find
        limit = far[-1]
        if m > 0 and found[m - 1, -1] < len(points):
            reached = 0.0
            for i in found[m - 1]:
                reached = max(reached, _apart(points[i], place))
            limit = min(limit, reached)
        # 2. down from the box round all, always into the nearer one first
        box, off, waiting = 1, _off(boxes[1], place[0], place[1]), 0
        while True:
            if off <= min(limit, far[-1]):
                if box < leaves:
                    box, other = 2 * box, 2 * box + 1
                    off = _off(boxes[box], place[0], place[1])
                    other_off = _off(boxes[other], place[0], place[1])
                    if other_off < off:
                        box, other, off, other_off = other, box, other_off, off
                    left[waiting], left_off[waiting] = other, other_off
                    waiting += other_off <= limit
                    continue
                _look_through(numbered, (box - leaves) * LEAF, place, far, mine)
            if waiting == 0:
                break
            waiting -= 1
            box, off = left[waiting], left_off[waiting]
