"""Sheet parts: tiles of the sheet with all that lies about them, in which stations of ways are judged.

Signals: the drawing, ways in its pixels, which of their places are stations, and a pen in; tiles out.

Source: our own. Questions: none.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.against_ink.pen_on_ink import PenOnInk, Room, Ways
from morfax.tracer.tangles.felt_pen import FAR


class _Tiles(NamedTuple):
    """In which tile of a side each place of the ways is, the places in the order of these, and tiles in a
    row.
    """

    side_px: int
    of_place: NDArray[np.int32]
    order: NDArray[np.int64]
    across: int

    @classmethod
    def of(cls, ways: Ways, side_px: int) -> _Tiles:
        """The tiles of some ways; the last of each row is empty."""
        column, row = np.maximum(ways.places_px.T / side_px, 0).astype(np.int32)
        across = 2 + int(column.max())
        of_place = row * across + column
        return cls(side_px, of_place, np.argsort(of_place, kind="stable"), across)

    def about(self, row: int, column: int) -> NDArray[np.int64]:
        """The numbers of the places in a tile and in the eight about it."""
        firsts = (np.arange(row - 1, row + 2) * self.across + column - 1)[:, None]
        edges = (firsts + np.array([0, 3])).astype(
            self.of_place.dtype
        )  # else all would be copied
        ends = np.searchsorted(self.of_place, edges, sorter=self.order)
        return np.sort(np.concatenate([self.order[a:b] for a, b in ends.tolist()]))


class Part(NamedTuple):
    """A tile of the sheet with what lies about it: the darkness, the ways as they are seen from its corner,
    the numbers of the stations in the tile and their pixels, the pen, and room to work in.
    """

    seen: NDArray[np.float32]
    ways: Ways
    stations: NDArray[np.int64]
    at: NDArray[np.int64]
    pen: PenOnInk
    room: Room


def parts(
    drawing: Drawing, ways: Ways, is_station: NDArray[np.bool_], side_px: int, pen: PenOnInk
) -> Iterator[Part]:
    """The tiles of a side in which some of the places that stand for ways are stations."""
    tiles = _Tiles.of(ways, side_px)
    margin = margin_px(pen)
    room = Room.of((side_px + 2 * margin) ** 2, pen)
    for number in sorted(set(tiles.of_place[is_station].tolist())):
        row, column = divmod(number, tiles.across)
        near = tiles.about(row, column)
        stations = near[is_station[near] & (tiles.of_place[near] == number)]
        top, left = max(row * side_px - margin, 0), max(column * side_px - margin, 0)
        down, along = (row + 1) * side_px + margin, (column + 1) * side_px + margin
        seen = np.ascontiguousarray(drawing.darkness[top:down, left:along])
        corner = np.array([left, top], np.float32)
        at = np.round(ways.places_px[stations] - corner).astype(int)
        at = np.clip(at, 0, np.array(seen.shape)[::-1] - 1)
        yield Part(seen, ways.seen_from(corner, near), stations, at, pen, room)


def margin_px(pen: PenOnInk) -> int:
    """How far about a station what lies there tells of it, pixels."""
    return math.ceil(2 * (FAR + 1) * pen.half_px) + 1
