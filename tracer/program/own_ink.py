"""Own ink: whether a pen along closed ways would leave the ink that is on the sheet.

    ║  ╭╮  ║      the head went straight across a bay, or cut its end short: there the pen's ink lies beside
    ║  ││  ║      the sheet's
    ╚══╯╰══╝

Within some widths of a way each pixel is held against the ink of a pen (see `tangles.pen`) on whatever way is
nearest to it, of that width which explains a box about it best: a line that swells is no other line. What the
pen draws on paper there is summed,

    over = (sum((drawn - seen)²) - what the paper's noise leaves) · area of a pixel / width²

and so is the ink that it leaves; a way is beside its ink where the lesser of both is large, and far above
that of most of its line. By itself neither tells: another line or a tick leaves ink, and a gap is paper.

Signals: the drawing and lines that were followed in; stretches of closed ones beside their ink out.

Source: our own, as tangles are redrawn. Questions: a way that cuts off ink, and stays on ink, as along a
tick, is not found.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.median import median, percentile
from morfax.motion.polyline import evenly
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.tangles import pen
from morfax.tracer.tangles.tangle import DARKEST

# Limits chosen by trial on 625 right ways of parts, holes, slots, notches and tongues, none of which comes
# above them. Of 25 wrong ones 12 do, and of those that are more than 0.4 mm off all but two.
OVER = 0.05
MOST_SPECKS = 2.2  # the same in pixels: so much is left by specks, which a scan has
OF_MOST = 6.0  # times what is over on most of the line
DOUBTFUL = 0.3  # of the limit: a way that comes above it may be wrong
MOST = 60.0  # percent of the line
REACH_WIDTHS = 1.25  # from a way: ink further away is another line's
OF_WIDTH = (0.8, 0.9, 1.0, 1.1, 1.25)  # of the line's: pens that are tried
STATION_WIDTHS = 0.25  # between the places at which a way is judged
PLACES_PX = (
    1.0  # between the places that stand for a way: near its edge they are 0.04 px off it
)
TILE_PX = 128


class Beside(NamedTuple):
    """A stretch of a closed way beside its ink: the place furthest beside it, how long it is, mm, and whether
    noise alone never leaves so much.
    """

    place_mm: tuple[float, float]
    length_mm: float
    is_sure: bool


class Ways(NamedTuple):
    """Places (n, 2) of all ways on a sheet, columns and rows in pixels; the number of the line of each; and
    by lines: half the width in pixels, and whether it is closed.
    """

    places_px: NDArray[np.float32]
    line: NDArray[np.int32]
    half_px: Array
    closed: NDArray[np.bool_]

    @property
    def pen_px(self) -> float:
        """Half the width of most closed lines."""
        return median(self.half_px[self.closed])


class _Tiles(NamedTuple):
    """In which tile each place of the ways is, the places in the order of these, and tiles in a row."""

    of_place: NDArray[np.int32]
    order: NDArray[np.int64]
    across: int

    @classmethod
    def of(cls, ways: Ways) -> _Tiles:
        """The tiles of some ways; the last of each row is empty."""
        column, row = np.maximum(ways.places_px.T / TILE_PX, 0).astype(np.int32)
        across = 2 + int(column.max())
        of_place = row * across + column
        return cls(of_place, np.argsort(of_place, kind="stable"), across)

    def about(self, row: int, column: int) -> NDArray[np.int64]:
        """The numbers of the places in a tile and in the eight about it."""
        firsts = (np.arange(row - 1, row + 2) * self.across + column - 1).tolist()
        ends = np.searchsorted(
            self.of_place, [(first, first + 3) for first in firsts], sorter=self.order
        )
        return np.sort(np.concatenate([self.order[a:b] for a, b in ends.tolist()]))


def beside(drawing: Drawing, lines: Sequence[Line]) -> Iterator[Beside]:
    """Where closed lines run beside their ink; nothing where no pen can be told."""
    if not drawing.noise.softness_px > 0 or drawing.grainy:
        return
    ways = _ways(drawing, lines)
    judged = list(_judged(drawing, ways))
    if not judged:
        return
    line, station, over = (np.concatenate(column) for column in zip(*judged, strict=True))
    for number in np.flatnonzero(ways.closed):
        own = np.flatnonzero(line == number)
        order = own[np.argsort(station[own], kind="stable")]
        least = max(OVER, MOST_SPECKS / (2 * ways.half_px[number]) ** 2)
        if len(order):
            least = max(least, OF_MOST * percentile(over[order], MOST))
        for first, last in _stretches(over[order] > DOUBTFUL * least):
            stretch = order[first:last]
            worst = stretch[int(np.argmax(over[stretch]))]
            places = 1 + station[stretch[-1]] - station[stretch[0]]
            place_mm = _mm(drawing, ways.places_px[station[worst]])
            long_mm = float(places * PLACES_PX * drawing.pitch_mm)
            yield Beside(place_mm, long_mm, bool(over[worst] > least))


def _ways(drawing: Drawing, lines: Sequence[Line]) -> Ways:
    """The ways of lines in pixels of the sheet."""
    pitch_mm, rows = drawing.pitch_mm, drawing.darkness.shape[0]
    ways = [evenly(line.places_mm, PLACES_PX * pitch_mm) for line in lines]
    places = [np.column_stack([way[:, 0], rows * pitch_mm - way[:, 1]]) for way in ways]
    return Ways(
        np.vstack([(some / pitch_mm - 0.5).astype(np.float32) for some in places]),
        np.repeat(np.arange(len(ways), dtype=np.int32), [len(way) for way in ways]),
        np.array([0.5 * line.width_mm / pitch_mm for line in lines]),
        np.array([line.ending == "closed" and not line.on_edge for line in lines]),
    )


def _judged(
    drawing: Drawing, ways: Ways
) -> Iterator[tuple[NDArray[np.int32], NDArray[np.int64], Array]]:
    """The stations of closed lines, tile by tile: line, number of the place, and what is over."""
    tiles = _Tiles.of(ways)
    is_station = ways.closed[ways.line] & (np.arange(len(ways.line)) % _every(ways) == 0)
    for number in sorted(set(tiles.of_place[is_station].tolist())):
        row, column = divmod(number, tiles.across)
        near = tiles.about(row, column)
        stations = near[is_station[near] & (tiles.of_place[near] == number)]
        margin = math.ceil(2 * (REACH_WIDTHS + 1) * ways.pen_px) + 1
        top, left = max(row * TILE_PX - margin, 0), max(column * TILE_PX - margin, 0)
        seen = drawing.darkness[
            top : (row + 1) * TILE_PX + margin, left : (column + 1) * TILE_PX + margin
        ]
        over = _over(drawing, np.asarray(seen, float), (left, top), ways, near)
        at = np.round(ways.places_px[stations]).astype(int) - (left, top)
        at = np.clip(at, 0, np.array(over.shape)[::-1] - 1)
        yield ways.line[stations], stations, over[at[:, 1], at[:, 0]]


def _every(ways: Ways) -> int:
    """One place of the ways in so many is a station."""
    return max(1, round(2 * STATION_WIDTHS * float(np.min(ways.half_px)) / PLACES_PX))


def _over(
    drawing: Drawing,
    seen: Array,
    corner: tuple[int, int],
    ways: Ways,
    near: NDArray[np.int64],
) -> Array:
    """What the pen draws on paper in the worst box about each pixel of a part of the sheet."""
    half_px = ways.pen_px
    # 1. what is nearest to each pixel
    away_px, owner = np.full(seen.shape, np.inf), np.full(seen.shape, -1)
    reach_px = 2 * REACH_WIDTHS * half_px
    places = np.ascontiguousarray(ways.places_px[near] - corner)
    _nearest(places, ways.line[near], reach_px, away_px, owner)
    i, j = np.nonzero((owner >= 0) & ways.closed[owner])
    away, half = away_px[i, j], ways.half_px[owner[i, j]]
    dark, drawn = np.minimum(seen[i, j], DARKEST), np.empty(len(i))
    # 2. where the felt pen leaves hardly anything wrong, the best one draws no more than that on paper
    side = 2 * round(half_px) + 1
    about, width2 = np.ones((side, side), np.uint8), (2 * half_px) ** 2
    noise = 0.5 * drawing.noise.paper**2
    pen.ink(away, half_px, drawing.noise.softness_px, drawn)
    wrong = _in_boxes(seen.shape, (i, j), (drawn - dark) ** 2 - 2 * noise, side)
    if wrong.max(initial=0.0) < DOUBTFUL * OVER * width2:
        return np.asarray(cv2.dilate(wrong, about) / width2)
    # 3. the pen of some widths that explains each box best: what it draws on paper, and what ink it leaves
    least = np.full(seen.shape, np.inf)
    over, left = np.zeros(seen.shape), np.zeros(seen.shape)
    for share in OF_WIDTH:
        pen.ink(away - (share - 1) * half, half_px, drawing.noise.softness_px, drawn)
        on_paper, on_ink = (
            _in_boxes(seen.shape, (i, j), np.maximum(wrong, 0.0) ** 2 - noise, side)
            for wrong in (drawn - dark, dark - drawn)
        )
        is_better = on_paper + on_ink < least
        over, left = np.where(is_better, on_paper, over), np.where(is_better, on_ink, left)
        least = np.minimum(least, on_paper + on_ink)
    # 4. about each pixel: a way over paper without ink beside it crosses a gap
    worst = np.minimum(cv2.dilate(over, about), cv2.dilate(left, about))
    return np.asarray(worst / width2)


def _in_boxes(
    shape: tuple[int, ...],
    at: tuple[NDArray[np.int64], NDArray[np.int64]],
    values: Array,
    side: int,
) -> Array:
    """Sums of the values at some pixels (n,) over a box about each pixel."""
    spread = np.zeros(shape)
    spread[at] = values
    return np.asarray(
        cv2.boxFilter(spread, -1, (side, side), normalize=False, borderType=cv2.BORDER_CONSTANT)
    )


@njit(cache=True)
def _nearest(places, lines, reach_px, away_px, owner):  # type: ignore[no-untyped-def]
    """For each pixel how far the nearest of some places (n, 2) is, and of which line; within a reach."""
    rows, columns = away_px.shape
    for k in range(len(places)):
        x, y = places[k, 0], places[k, 1]
        for row in range(max(0, math.ceil(y - reach_px)), min(rows, int(y + reach_px) + 1)):
            for column in range(
                max(0, math.ceil(x - reach_px)), min(columns, int(x + reach_px) + 1)
            ):
                away = math.hypot(column - x, row - y)
                if away < away_px[row, column] and away < reach_px:
                    away_px[row, column] = away
                    owner[row, column] = lines[k]


def _stretches(above: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """The first and the one after the last of each stretch of stations that are above the limit."""
    edges = np.flatnonzero(np.diff(np.r_[False, above, False].astype(np.int8)))
    return [(int(first), int(last)) for first, last in edges.reshape(-1, 2)]


def _mm(drawing: Drawing, place_px: NDArray[np.float32]) -> tuple[float, float]:
    """A place in pixels, on the sheet in mm."""
    column, row = place_px.tolist()
    rows = drawing.darkness.shape[0]
    return (column + 0.5) * drawing.pitch_mm, (rows - row - 0.5) * drawing.pitch_mm
