"""Patches of ink: connected components of a sheet as runs of pixels, so that paper costs no memory.

Signals: masks of ink in strips of whole rows, from the top, in; out for each run its row, where it begins and
ends (pixels, the end not included), and the number of the patch that it belongs to. Two runs of neighbouring
rows belong together if they touch, also at a corner.

                row  ..####....##..      3 runs, 2 patches: an image of labels would take four bytes
              row+1  ....####......      for every pixel of the paper

Source: our own; joining runs by a forest of parents is the textbook's way.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit

if TYPE_CHECKING:  # they are made of patches
    from morfax.tracer.drawing.enclosure import Enclosure
    from morfax.tracer.drawing.holes import Hole

Mask = NDArray[np.uint8]
Numbers = NDArray[np.int32]
Chosen = NDArray[np.bool_] | int  # which of all patches, or the number of one

INK = 0.5  # of the darkest: what is darker is ink
SOFTENED_PX = 0.7  # standard deviation of the spot behind which ink is told
ROW_BITS = 32  # a row is worth so many bits more than a column, in one number for both
STRIP_PX = 1 << 24  # pixels that are worked on at a time
FRINGE_PX = 4  # beyond ink its soft edge ends


@dataclass(frozen=True)
class Patches:
    """Runs of ink, by rows, and the patch of each (0 … count - 1)."""

    row: Numbers
    begin: Numbers
    end: Numbers
    patch: Numbers
    count: int
    # of those that were asked for (see `holes.holes_in`)
    known_holes: dict[int, list[Hole]] = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, runs: Iterable[tuple[Numbers, Numbers, Numbers]]) -> Patches:
        """Join runs (see `runs_of`), strip by strip from the top, to patches."""
        row, begin, end = (np.concatenate(part) for part in zip(*runs, strict=True))
        patch, count = joined(row, begin, end, True)
        return cls(row, begin, end, patch, int(count))

    @cached_property
    def firsts(self) -> NDArray[np.int64]:
        """The number of the first run of each row, and of the one after the last row with runs."""
        return np.concatenate([[0], np.cumsum(np.bincount(self.row))])

    @cached_property
    def every(self) -> NDArray[np.bool_]:
        """All patches, as those that count."""
        return np.ones(self.count, bool)

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Pixels of each patch."""
        return np.asarray(np.bincount(self.patch, self.end - self.begin, self.count), float)

    @cached_property
    def boxes(self) -> Numbers:
        """First row, last row + 1, first column, last column + 1 of each patch; (n, 4) pixels."""
        return np.asarray(_boxes(self.row, self.begin, self.end, self.patch, self.count))

    @cached_property
    def longer_sides(self) -> Numbers:
        """Width or height of each patch, whichever is more; pixels."""
        top, bottom, left, right = self.boxes.T
        return np.maximum(bottom - top, right - left)

    @cached_property
    def enclosure(self) -> Enclosure:
        """Which patch goes round which area of paper, found once."""
        from morfax.tracer.drawing.enclosure import Enclosure

        return Enclosure.of(self, int(self.row[-1]) + 1)

    def box(self, chosen: NDArray[np.bool_]) -> tuple[int, int, int, int]:
        """First row, last row + 1, first column, last column + 1 of the chosen patches."""
        tops, bottoms, lefts, rights = self.boxes[chosen].T
        return int(tops.min()), int(bottoms.max()), int(lefts.min()), int(rights.max())

    @cached_property
    def _by_patches(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The numbers of all runs, patch by patch and by rows, and where those of each patch begin."""
        begins = np.zeros(self.count + 1, np.int64)
        np.cumsum(np.bincount(self.patch, minlength=self.count), out=begins[1:])
        return np.argsort(self.patch, kind="stable"), begins

    def runs_between(self, top: int, bottom: int) -> slice:
        """The runs from a row up to another."""
        begins = self.firsts
        last = len(begins) - 1
        return slice(*(int(begins[min(max(row, 0), last)]) for row in (top, bottom)))

    def runs_of(self, patch: int, top: int, bottom: int) -> NDArray[np.int64]:
        """The numbers of one patch's runs from a row up to another: on a plate of holes most are others'."""
        numbers, begins = self._by_patches
        own = numbers[begins[patch] : begins[patch + 1]]
        first, last = np.searchsorted(self.row[own], (top, bottom)).tolist()
        return own[first:last]

    def alone(self, patch: int) -> NDArray[np.bool_]:
        """One patch as the chosen one of all."""
        return np.asarray(np.arange(self.count) == patch)

    def painted(self, chosen: Chosen, top: int, bottom: int, left: int, right: int) -> Mask:
        """Mask (rows, columns) of the chosen patches in a part of the sheet."""
        mask = np.zeros((bottom - top, right - left), np.uint8)
        own = self._chosen_runs(chosen, top, bottom)
        _paint(mask, self.row[own] - top, self.begin[own] - left, self.end[own] - left)
        return mask

    def _chosen_runs(self, chosen: Chosen, top: int, bottom: int) -> NDArray[np.int64]:
        """The numbers of the chosen patches' runs from a row up to another."""
        if not isinstance(chosen, np.ndarray):
            return self.runs_of(chosen, top, bottom)
        rows = self.runs_between(top, bottom)
        return np.asarray(rows.start + np.flatnonzero(chosen[self.patch[rows]]))

    def runs_within(
        self, chosen: Chosen, top: int, bottom: int, left: int, right: int
    ) -> tuple[Numbers, Numbers, Numbers]:
        """Row, begin and end of the runs of the chosen patches in a part of the sheet, from its corner."""
        own = self._chosen_runs(chosen, top, bottom)
        begin = np.maximum(self.begin[own] - np.int32(left), np.int32(0))
        end = np.minimum(self.end[own] - np.int32(left), np.int32(right - left))
        within = begin < end
        return self.row[own][within] - np.int32(top), begin[within], end[within]

    def pixels_of(
        self, chosen: NDArray[np.bool_], values: NDArray[np.float32]
    ) -> NDArray[np.float32]:
        """The values of a sheet, (rows, columns), at the pixels of the chosen patches; row by row."""
        own = np.flatnonzero(chosen[self.patch])
        lengths = self.end[own] - self.begin[own]
        return np.asarray(
            _taken(
                values,
                self.row[own],
                self.begin[own],
                self.end[own],
                np.cumsum(lengths) - lengths,
            )
        )


def painted(row: Numbers, begin: Numbers, end: Numbers, shape: tuple[int, int]) -> Mask:
    """Mask of runs, (rows, columns)."""
    mask = np.zeros(shape, np.uint8)
    _paint(mask, row, begin, end)
    return mask


def strips(
    shape: tuple[int, ...], halo: int = 0, pixels: int = STRIP_PX
) -> Iterator[tuple[int, int, slice]]:
    """First row and last row + 1 of each strip of a sheet, and its rows with a halo of neighbours.

    A strip has about so many `pixels`, the halo apart.
    """
    rows, columns = shape[:2]
    height = max(4 * halo, pixels // max(columns, 1), 1)
    for top in range(0, rows, height):
        bottom = min(rows, top + height)
        yield top, bottom, slice(max(0, top - halo), min(rows, bottom + halo))


def runs_of(mask: Mask | NDArray[np.bool_], top: int) -> tuple[Numbers, Numbers, Numbers]:
    """Row, begin and end of the runs of a strip whose first row on the sheet is `top`."""
    rows, columns = mask.shape
    padded = np.zeros((rows, columns + 2), np.bool_)
    padded[:, 1:-1] = mask
    edges = np.flatnonzero(padded[:, 1:] != padded[:, :-1])
    row, column = (part.astype(np.int32) for part in np.divmod(edges, columns + 1))
    return row[::2] + np.int32(top), column[::2], column[1::2]


def runs_at(
    row: Numbers, begin: Numbers, rows: NDArray[np.integer], columns: NDArray[np.integer]
) -> NDArray[np.int64]:
    """Of each of some pixels the number of the last run that begins there or before, by rows; -1: none."""
    begins = (row.astype(np.int64) << ROW_BITS) + begin
    asked = (rows.astype(np.int64) << ROW_BITS) + columns
    return np.searchsorted(begins, asked, side="right") - 1


@njit(cache=True)
def _paint(mask, row, begin, end):  # type: ignore[no-untyped-def]
    """Set those parts of the runs that lie within the mask."""
    for k in range(len(row)):
        for column in range(max(begin[k], 0), min(end[k], mask.shape[1])):
            mask[row[k], column] = 1


@njit(cache=True)
def _boxes(row, begin, end, patch, count):  # type: ignore[no-untyped-def]
    """First row, last row + 1, first column, last column + 1 of the runs of each patch."""
    boxes = np.zeros((count, 4), np.int32)
    boxes[:, 0] = boxes[:, 2] = np.iinfo(np.int32).max
    for k in range(len(row)):
        box = boxes[patch[k]]
        box[0], box[1] = min(box[0], row[k]), max(box[1], row[k] + 1)
        box[2], box[3] = min(box[2], begin[k]), max(box[3], end[k])
    return boxes


@njit(cache=True)
def _taken(values, row, begin, end, places):  # type: ignore[no-untyped-def]
    """The values along runs; each run's first goes to its place."""
    last = len(row) - 1
    taken = np.empty(places[last] + end[last] - begin[last] if len(row) else 0, values.dtype)
    for k in range(len(row)):
        for j in range(end[k] - begin[k]):
            taken[places[k] + j] = values[row[k], begin[k] + j]
    return taken


@njit(cache=True)
def joined(row, begin, end, corners):  # type: ignore[no-untyped-def]
    """The patch of each run, numbered as they are met, and how many there are.

    Runs that touch only at a corner belong together if `corners` count.
    """
    return _numbered(_roots(row, begin, end, 0 if corners else 1))


@njit(cache=True)
def _roots(row, begin, end, apart):  # type: ignore[no-untyped-def]
    """The tree of each run: a run that it is joined to, or itself."""
    runs = len(row)
    parent = np.arange(runs)
    above = 0
    for k in range(runs):
        while above < k and (
            row[above] < row[k] - 1
            or (row[above] == row[k] - 1 and end[above] < begin[k] + apart)
        ):
            above += 1
        other = above
        while other < k and row[other] == row[k] - 1 and begin[other] + apart <= end[k]:
            a, b = _root(parent, other), _root(parent, k)
            parent[max(a, b)] = min(a, b)
            other += 1
    return parent


@njit(cache=True)
def grouped(pairs, count):  # type: ignore[no-untyped-def]
    """The group of each of `count` things of which some pairs (n, 2) belong together, in their order."""
    parent = np.arange(count)
    for k in range(len(pairs)):
        a, b = _root(parent, pairs[k, 0]), _root(parent, pairs[k, 1])
        parent[max(a, b)] = min(a, b)
    return _numbered(parent)[0]


@njit(cache=True)
def _numbered(parent):  # type: ignore[no-untyped-def]
    """The tree's number of each run, in their order, and how many trees there are."""
    patch = np.empty(len(parent), np.int32)
    count = 0
    for k in range(len(parent)):
        root = _root(parent, k)
        if root == k:
            patch[k] = count
            count += 1
        else:
            patch[k] = patch[root]
    return patch, count


@njit(cache=True)
def _root(parent, k):  # type: ignore[no-untyped-def]
    """The first run of a run's patch, as far as it is joined; the way there is halved."""
    while parent[k] != k:
        parent[k] = parent[parent[k]]
        k = parent[k]
    return k


def draw_way(mask: Mask, way_px: NDArray[np.floating], across_px: int) -> None:
    """Draw a stroke of a width along places (n, 2) of a mask, column and row of pixels' middles."""
    sixteenths = np.round(16 * way_px).astype(np.int32)
    cv2.polylines(mask, [sixteenths], False, 1, across_px, cv2.LINE_8, shift=4)
