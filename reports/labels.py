"""Labels: names beside places, put where they hide neither each other nor the lines.

Signals in: a plate and the size of its axes, points. Out: its words with other offsets from their places.

The axes are a grid of small cells. Each name in turn tries places round its own, the nearest first, and takes
the one with the fewest cells that are taken: by a line a little, by another name, a legend or the frame much.
A thin line leads from a place to a name that stands further off than a title is high.

Source: our own. Questions: none.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.reports import lettering
from morfax.reports.lettering import PX_PER_PT
from morfax.reports.looks import ON_PATHS, THIN_PT, TITLE_PT
from morfax.reports.plate import Caption, Mark, Place, Plate, Polyline, Spot, filled_in, fitted

CELL_PT = 2.0
LETTER = 0.62  # width of a letter over its size; DejaVu's own is 0.6 on average
OFFSETS_PT = (7.0, 14.0, 24.0, 36.0, 50.0)  # from a place to its name
LINE_COST, SPOT_COST, NAME_COST = 1.0, 2.0, 100.0
# more are shortened to a letter and a number; the legend says what the letter means
FEW_NAMES = 12
SIDES = ((1, 1), (-1, 1), (1, -1), (-1, -1), (1, 0), (-1, 0), (0, 1), (0, -1))


def shortened(names: Mapping[str, Place]) -> dict[str, tuple[str, str]]:
    """What is written for each name, such as "unexplained 3", and what the legend says for its kind.

    Few names are written in full, and the legend says nothing of them.
    """
    if len(names) <= FEW_NAMES:
        return {name: (name, "") for name in names}
    kinds = {name: name.rstrip("0123456789 ") for name in names}
    short = {kind: _start(kind, set(kinds.values())) for kind in kinds.values()}
    return {
        name: (
            f"{short[kind]}{name.removeprefix(kind).strip()}",
            f"{short[kind]}  {kind}",
        )
        for name, kind in kinds.items()
    }


def _start(kind: str, kinds: set[str]) -> str:
    """The shortest beginning of a kind that no other kind has."""
    for letters in range(1, len(kind)):
        if sum(other.startswith(kind[:letters]) for other in kinds) == 1:
            return kind[:letters]
    return kind


def spread(plate: Plate, wide_pt: float, high_pt: float) -> None:
    """Give the words of a plate, on axes of a size, offsets at which nothing is hidden."""
    grid, marks = _Grid(plate, wide_pt, high_pt), list[Mark]()
    for mark in plate.marks:
        if isinstance(mark, Caption) and not mark.centred:
            put = grid.put(mark)
            marks += [*grid.leaders(put), put]
        else:
            marks.append(mark)
    plate.marks = marks


class _Grid:
    """What is taken of the axes: the cost of a name on each cell, rows from below."""

    def __init__(self, plate: Plate, wide_pt: float, high_pt: float) -> None:
        self.view = fitted(plate.view, high_pt / wide_pt)
        self.pt_per_mm = wide_pt / (self.view[1] - self.view[0])
        rows, columns = int(high_pt / CELL_PT) + 1, int(wide_pt / CELL_PT) + 1
        self.cost: NDArray[np.float64] = np.zeros((rows, columns))
        for mark in plate.marks:
            if isinstance(mark, Polyline):
                self._take_line(mark.places_mm)
            elif isinstance(mark, Spot):
                x, y = self._pt(np.array([mark.place_mm]))[0]
                half = 0.5 * mark.size_pt
                self._take((x - half, y - half, x + half, y + half), SPOT_COST)
        legend = lettering.legend(plate, wide_pt * PX_PER_PT, high_pt * PX_PER_PT)
        if legend is not None:
            left, top, right, bottom = (side / PX_PER_PT for side in legend.sides_px)
            self._take((left, high_pt - bottom, right, high_pt - top), NAME_COST)

    def put(self, words: Caption) -> Caption:
        """The same words at the best offset; those of places beside the axes stay as they are."""
        x, y = self._pt(np.array([words.place_mm]))[0].tolist()
        if not (
            0 <= x / CELL_PT < self.cost.shape[1] and 0 <= y / CELL_PT < self.cost.shape[0]
        ):
            return words
        wide = _wide_pt(words)
        tried = [words.offset_pt, *_offsets(wide, words.size_pt)]
        corners = [(x + dx, y + dy) for dx, dy in tried]
        boxes = [(left, low, left + wide, low + words.size_pt) for left, low in corners]
        best = int(np.argmin([self._cost_of(box) for box in boxes]))
        self._take(boxes[best], NAME_COST)
        return replace(words, offset_pt=tried[best])

    def leaders(self, words: Caption) -> list[Polyline]:
        """The line from a place to its name, where that does not stand beside it."""
        wide, (dx, dy) = _wide_pt(words), words.offset_pt
        nearest_pt = np.clip(0.0, [dx, dy], [dx + wide, dy + words.size_pt])
        if np.hypot(*nearest_pt) < TITLE_PT:
            return []
        end_mm = words.place_mm + nearest_pt / self.pt_per_mm
        return [
            Polyline(np.array([words.place_mm, end_mm]), words.colour, THIN_PT, order=ON_PATHS)
        ]

    def _pt(self, places_mm: Array) -> Array:
        """Places from the lower left corner of the axes, points."""
        return (places_mm - np.array([self.view[0], self.view[2]])) * self.pt_per_mm

    def _take_line(self, places_mm: Array) -> None:
        """Take the cells along a line."""
        column, row = filled_in(self._pt(places_mm) / CELL_PT, 1.0).astype(int).T
        inside = (column >= 0) & (row >= 0)
        inside &= (column < self.cost.shape[1]) & (row < self.cost.shape[0])
        taken = row[inside], column[inside]
        self.cost[taken] = np.maximum(self.cost[taken], LINE_COST)

    def _cells(self, box: tuple[float, float, float, float]) -> tuple[slice, slice, int]:
        """The rows and columns of a box, points, and how many of its cells lie beside the axes."""
        left, low, right, high = (int(np.floor(side / CELL_PT)) for side in box)
        rows = slice(max(low, 0), min(high + 1, self.cost.shape[0]))
        columns = slice(max(left, 0), min(right + 1, self.cost.shape[1]))
        within = max(rows.stop - rows.start, 0) * max(columns.stop - columns.start, 0)
        return rows, columns, (high + 1 - low) * (right + 1 - left) - within

    def _take(self, box: tuple[float, float, float, float], cost: float) -> None:
        rows, columns, _ = self._cells(box)
        np.maximum(self.cost[rows, columns], cost, out=self.cost[rows, columns])

    def _cost_of(self, box: tuple[float, float, float, float]) -> float:
        rows, columns, beside = self._cells(box)
        return float(self.cost[rows, columns].sum()) + NAME_COST * beside


def _wide_pt(words: Caption) -> float:
    """How long a name is."""
    return max(len(words.text), 1) * LETTER * words.size_pt


def _offsets(wide_pt: float, high_pt: float) -> Iterator[Place]:
    """Offsets of a name's lower left corner from its place, the nearest first."""
    for away in OFFSETS_PT:
        for side, up in SIDES:
            dx = away if side > 0 else -away - wide_pt if side < 0 else -0.5 * wide_pt
            dy = away if up > 0 else -away - high_pt if up < 0 else -0.5 * high_pt
            yield dx, dy
