"""The sides of the lines: which lie inside which, which cross, and how much room a line leaves beside it.

Signals: closed lines and open ones, (n, 2) mm, in; depths, crossings and the largest circle beside a line
out (mm).

Lines that cross each other are both edges of the part: neither lies in the other. A line that crosses itself
has no outside and no inside: what lies between its lobes is as much the one as the other.

Source: our own. The largest circle is found on a grid, by the distances from all lines, and then on finer
grids about its middle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion import nesting
from morfax.motion.arrays import Array
from morfax.motion.crossings import crossings_of
from morfax.motion.offset import DriveCurve
from morfax.motion.polyline import (
    Nearest,
    area_mm2,
    closed_up,
    lengths_mm,
    with_places,
)
from morfax.motion.usual import INCREMENT_MM, THINNED

LOOP_MM = 1.0  # a shorter loop is the head's swivel, and not drawn; by trial
CELLS = 500  # of the grid, along the longer side of what is looked at
MARGIN = 2  # cells about it
FINER = 10  # times, again and again about the best cell
PASSES_MM = 0.05  # steps of the diameters that are named, and room that a cutter needs at least


@dataclass(frozen=True, slots=True)
class Clearance:
    """The largest circle beside a line: where its middle is, and how wide it is (mm)."""

    place_mm: tuple[float, float]
    wide_mm: float

    @property
    def passes_mm(self) -> float:
        """The diameter of a cutter that goes into it, in steps that one finds in a drawer."""
        return PASSES_MM * max(0, int(self.wide_mm / PASSES_MM - 0.5))


def whole(curve: DriveCurve) -> Array:
    """The places of a drive curve, the first once more at the end of a closed one."""
    return closed_up(curve.points_mm) if curve.closed else curve.points_mm


def is_counterclockwise(places: Array) -> bool:
    """Whether a closed line goes round counter-clockwise."""
    return area_mm2(places) > 0


def thinned(line_mm: Array) -> Array:
    """Places of a closed line that show where it runs, (n, 2) mm."""
    if len(line_mm) >= 4 * THINNED:
        return line_mm[::THINNED]
    return with_places(line_mm, LOOP_MM)[:-1]


def crossing(lines_mm: Sequence[Array]) -> NDArray[np.bool_]:
    """Which lines (n, 2) mm, taken for closed, cross which; `[i, i]` if line i crosses itself."""
    closed = [closed_up(line) for line in lines_mm]
    owner = np.concatenate([np.full(len(line), k) for k, line in enumerate(closed)])
    last = np.flatnonzero(np.r_[np.diff(owner) != 0, True])
    firsts = np.r_[0, last + 1]
    crossed = np.zeros((len(closed), len(closed)), bool)
    for a, b in crossings_of(np.vstack(closed), np.setdiff1d(np.arange(len(owner)), last)):
        i = owner[int(a)]
        j = owner[int(b)]
        if i == j:
            lengths = lengths_mm(closed[i])
            begin_mm, end_mm = np.interp([a, b], firsts[i] + np.arange(len(lengths)), lengths)
            loop_mm = float(abs(end_mm - begin_mm))
            crossed[i, i] |= min(loop_mm, lengths[-1] - loop_mm) > LOOP_MM
        else:
            crossed[i, j] = crossed[j, i] = True
    return crossed


def depths(lines_mm: Sequence[Array], crossed: NDArray[np.bool_]) -> list[int]:
    """In how many of the others each closed line lies."""
    inside = nesting.nested(lines_mm, [True] * len(lines_mm)) & ~crossed
    return [int(n) for n in inside.sum(axis=1)]


def tool_left(
    lines_mm: Sequence[Array], crossed: NDArray[np.bool_], inside: bool = False
) -> list[bool]:
    """Whether a tool outside of the part, or inside, is on the left of the travel of each closed line."""
    return [
        is_counterclockwise(line) == (inside == (depth % 2 == 0))
        for line, depth in zip(lines_mm, depths(lines_mm, crossed), strict=True)
    ]


def room(curves: Sequence[DriveCurve], number: int) -> Clearance | None:
    """The largest circle that goes beside one of the lines, on its side; None if that side is not shut in."""
    own = curves[number]
    if not own.closed:
        return None
    # 1. a coarse grid
    inside = is_counterclockwise(own.points_mm) == own.left
    around = own.points_mm if inside else np.vstack([curve.points_mm for curve in curves])
    grid = _Grid.about(around)
    near_by = [whole(curve) for curve in curves if grid.holds_some(curve.points_mm)]
    free, here = _free(grid, near_by, own.points_mm, inside)
    if not here.any() or here[0].any():  # the outermost cells are outside of all lines
        return None
    distances = cv2.distanceTransform(free, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    away = distances * here
    row, column = np.unravel_index(int(away.argmax()), away.shape)
    place = grid.low_mm + (np.array([column, row]) - MARGIN) * grid.cell_mm
    # 2. finer grids about the best cell
    near, cell_mm = Nearest(near_by, float(away.max()) * grid.cell_mm), grid.cell_mm
    while cell_mm > INCREMENT_MM:
        steps = np.arange(-FINER, FINER + 1) * 2 * cell_mm / FINER
        places = place + np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
        away_mm = near.distances_mm(places)
        place = places[int(away_mm.argmax())]
        cell_mm = cell_mm * 2 / FINER
    return Clearance((float(place[0]), float(place[1])), 2 * float(away_mm.max()))


@dataclass(frozen=True, slots=True)
class _Grid:
    """A grid over part of the sheet: its lowest corner, its size and its cells, mm."""

    low_mm: Array
    size_mm: Array
    cell_mm: float

    @classmethod
    def about(cls, places_mm: Array) -> _Grid:
        """The grid about some places (n, 2) mm."""
        size = np.ptp(places_mm, axis=0)
        return cls(places_mm.min(axis=0), size, float(size.max()) / CELLS)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        columns, rows = (
            np.ceil(self.size_mm / self.cell_mm).astype(int) + 2 * MARGIN + 1
        ).tolist()
        return rows, columns

    def holds_some(self, places_mm: Array) -> bool:
        """Whether one of some places (n, 2) mm is on the grid."""
        high_mm = self.low_mm + self.size_mm
        on_it = (places_mm >= self.low_mm) & (places_mm <= high_mm)
        return bool(on_it.all(axis=1).any())

    def cells(self, places_mm: Array) -> NDArray[np.int32]:
        """The cells of some places (n, 2) mm."""
        return np.round((places_mm - self.low_mm) / self.cell_mm + MARGIN).astype(np.int32)


def _free(
    grid: _Grid, lines_mm: Sequence[Array], own_mm: Array, inside: bool
) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    """A grid that is 0 where a line runs, else 1; and which cells are beside the own line, on its side."""
    free = np.ones(grid.shape, np.uint8)
    filled, beside = np.zeros_like(free), np.zeros_like(free)
    cv2.polylines(free, [grid.cells(line) for line in lines_mm], False, 0)
    line = grid.cells(own_mm)
    cv2.fillPoly(filled, [line], 1)
    cv2.polylines(beside, [line], True, 1, 2 * MARGIN + 1)
    _, rooms = cv2.connectedComponents(free, connectivity=4)
    ours = np.unique(rooms[(beside > 0) & (free > 0) & ((filled > 0) == inside)])
    return free, np.isin(rooms, ours[ours > 0])
