"""Pen on ink: a part of a sheet is held against the ink of a pen on the ways there, pixel by pixel.

    1. to the edge of what way's line each pixel within reach is nearest, and how far beyond it is
    2. what pens as wide as each line was felt leave wrong in the box about each of those pixels; where that
       is hardly anything, the best pens draw no more than that on paper, and stations are judged by them
    3. else pens of the share of those widths that explains each box best: what they draw on paper, and what
       they leave

Signals: darkness of a part of the sheet (rows, columns), places of the ways (n, 2) in its columns and rows,
stations (m, 2) of lines that are judged among them; what is over about each station out (see `own_ink`).

Source: our own. Questions: none.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.tracer.tangles.pen import ink_at
from morfax.tracer.tangles.tangle import DARKEST


class PenOnInk(NamedTuple):
    """The pen of most lines: half its width and its softness in pixels, how far from its way it is looked at,
    the variance of the paper's noise on either side, shares of a line's width that are tried, the widest
    last, and how much may be over for nothing else to be tried, in widths.
    """

    half_px: float
    softness_px: float
    reach_px: float
    noise: float
    of_width: tuple[float, ...]
    over: float


class Ways(NamedTuple):
    """Places (n, 2) of all ways on a sheet, columns and rows in pixels; the number of the line of each; and
    by lines: half the width in pixels, and whether it is judged.
    """

    places_px: NDArray[np.float32]
    line: NDArray[np.int32]
    half_px: Array
    judged: NDArray[np.bool_]

    def seen_from(self, corner: NDArray[np.float32], some: NDArray[np.int64]) -> Ways:
        """Some of the places, counted from a corner."""
        return self._replace(places_px=self.places_px[some] - corner, line=self.line[some])


class Room(NamedTuple):
    """Room to work in, for as many pixels (n,) as the largest part of a sheet has: how far they are beyond
    an edge, numbers, and two rows of values; the first three are as empty after each part as before it.
    """

    beyond: NDArray[np.float32]
    number: NDArray[np.int32]
    spread: Array
    boxes: Array

    @classmethod
    def of(cls, pixels: int, pen: PenOnInk) -> Room:
        """Room for so many pixels within a pen's reach: made once, as the system wipes what it gives out."""
        beyond = np.full(pixels, pen.reach_px - pen.half_px, np.float32)
        return cls(beyond, np.zeros(pixels, np.int32), np.zeros(pixels), np.empty(pixels))


class Band(NamedTuple):
    """Pixels nearest to lines that are judged: rows and columns, how far they are beyond the line's edge,
    half the width of that, the darkness.
    """

    row: NDArray[np.int32]
    column: NDArray[np.int32]
    beyond_px: Array
    half_px: Array
    dark: Array


@njit(cache=True)
def over_at(seen, ways, stations, pen, room):  # type: ignore[no-untyped-def]
    """What is over in the worst box about each station (m,), in widths of the pen squared."""
    band = band_of(seen, ways, pen, room)
    clear(seen, band, room)
    shape, side = seen.shape, 2 * round(pen.half_px) + 1
    spread, boxes = (
        room.spread[: seen.size].reshape(shape),
        room.boxes[: seen.size].reshape(shape),
    )
    width2, over = (2 * pen.half_px) ** 2, np.empty(len(stations))
    # 1. the felt pens alone
    values = np.empty(len(band.dark))
    for k in range(len(values)):
        wrong = ink_at(band.beyond_px[k], 0.0, pen.softness_px) - band.dark[k]
        values[k] = wrong * wrong - 2 * pen.noise
    most = in_boxes(band, values, side, spread, boxes)
    if most < pen.over * width2:
        for k in range(len(stations)):
            over[k] = most_about(boxes, stations[k], side) / width2
        return over
    # 2. the best of some shares of their widths
    on_paper, on_ink = np.zeros(shape), np.zeros(shape)
    _best(band, pen, spread, on_paper, on_ink)
    for k in range(len(stations)):
        paper, left = (
            most_about(on_paper, stations[k], side),
            most_about(on_ink, stations[k], side),
        )
        over[k] = min(paper, left) / width2
    return over


@njit(cache=True)
def _best(band, pen, spread, on_paper, on_ink):  # type: ignore[no-untyped-def]
    """Fill in what the pen that explains each box best draws on paper there, and what ink it leaves."""
    papers, lefts = np.empty(spread.shape), np.empty(spread.shape)
    least = np.full(spread.shape, np.inf)
    for share in pen.of_width:
        beyond_px = band.beyond_px - (share - 1) * band.half_px
        sums_of(band, beyond_px, pen, spread, (papers, lefts))
        for i in range(len(spread)):
            for j in range(spread.shape[1]):
                both = papers[i, j] + lefts[i, j]
                if both < least[i, j]:
                    least[i, j], on_paper[i, j], on_ink[i, j] = both, papers[i, j], lefts[i, j]


@njit(cache=True)
def sums_of(band, beyond_px, pen, spread, sums):  # type: ignore[no-untyped-def]
    """Fill in what pens, beyond whose edge each pixel of a band is so far, draw on paper in the box about it,
    and what ink they leave there.
    """
    side, (papers, lefts) = 2 * round(pen.half_px) + 1, sums
    paper, left = np.empty(len(band.dark)), np.empty(len(band.dark))
    for k in range(len(band.dark)):
        wrong = ink_at(beyond_px[k], 0.0, pen.softness_px) - band.dark[k]
        paper[k] = max(wrong, 0.0) ** 2 - pen.noise
        left[k] = max(-wrong, 0.0) ** 2 - pen.noise
    in_boxes(band, paper, side, spread, papers)
    in_boxes(band, left, side, spread, lefts)


@njit(cache=True)
def band_of(seen, ways, pen, room):  # type: ignore[no-untyped-def]
    """The pixels of a part of the sheet that are nearest to lines that are judged; their numbers, from 1, are
    left in the room until it is cleared.
    """
    all_beyond = room.beyond[: seen.size].reshape(seen.shape)
    number = room.number[: seen.size].reshape(seen.shape)
    most_px = pen.reach_px - pen.half_px
    count, reached = _nearest(ways, most_px, all_beyond, number)
    row, column = np.empty(count, np.int32), np.empty(count, np.int32)
    beyond, half, dark = np.empty(count), np.empty(count), np.empty(count)
    n = 0
    for i in range(len(reached)):
        for j in range(reached[i, 0], reached[i, 1]):
            line = number[i, j] - 1
            if line < 0:
                continue
            number[i, j] = 0
            if ways.judged[line]:
                row[n], column[n] = i, j
                beyond[n], half[n] = all_beyond[i, j], ways.half_px[line]
                dark[n] = min(float(seen[i, j]), DARKEST)
                n += 1
                number[i, j] = n
            all_beyond[i, j] = most_px
    return Band(row[:n], column[:n], beyond[:n], half[:n], dark[:n])


@njit(cache=True)
def clear(seen, band, room):  # type: ignore[no-untyped-def]
    """Take the numbers of a band's pixels out of the room."""
    number = room.number[: seen.size].reshape(seen.shape)
    for k in range(len(band.row)):
        number[band.row[k], band.column[k]] = 0


@njit(cache=True)
def _nearest(ways, most_px, beyond, number):  # type: ignore[no-untyped-def]
    """For each pixel how far it is beyond the nearest edge of a line along some ways, if less than what is
    there, and the number, from 1, of that line; a pixel that is further beyond than the most keeps both. Give
    how many pixels have a number, and from and to before which column of each row (rows, 2) some have.

    Nothing branches in the innermost loop, so that it runs in vectors.
    """
    places, (rows, columns) = ways.places_px, beyond.shape
    reach_px = most_px + ways.half_px
    across2 = np.empty(2 * math.ceil(reach_px.max()) + 2, np.float32)
    reached = np.empty((rows, 2), np.int64)
    reached[:, 0], reached[:, 1] = columns, 0
    for k in range(len(places)):
        x, y, line = places[k, 0], places[k, 1], np.int32(ways.line[k] + 1)
        half, reach = np.float32(ways.half_px[ways.line[k]]), reach_px[ways.line[k]]
        left, right = max(0, math.ceil(x - reach)), min(columns, int(x + reach) + 1)
        if left >= right:  # beside this part of the sheet
            continue
        for j in range(right - left):
            across2[j] = (left + j - x) ** 2
        for row in range(max(0, math.ceil(y - reach)), min(rows, int(y + reach) + 1)):
            down2 = np.float32((row - y) ** 2)
            away, lines = beyond[row, left:right], number[row, left:right]
            for j in range(len(away)):
                by = np.sqrt(across2[j] + down2) - half
                is_nearer = by < away[j]
                away[j] = by if is_nearer else away[j]
                lines[j] = line if is_nearer else lines[j]
            reached[row, 0] = min(reached[row, 0], left)
            reached[row, 1] = max(reached[row, 1], right)
    count = 0
    for i in range(rows):
        for j in range(reached[i, 0], reached[i, 1]):
            count += number[i, j] > 0
    return count, reached


@njit(cache=True)
def in_boxes(band, values, side, spread, sums):  # type: ignore[no-untyped-def]
    """Fill in sums of the values of the band's pixels over a box about each pixel; give the largest sum.

    `spread` is room to work in: zeros before and after.
    """
    rows, columns = sums.shape
    half, most = side // 2, -np.inf
    for k in range(len(values)):
        spread[band.row[k], band.column[k]] = values[k]
    # sums down the columns, with half a box of paper to the left and right of them
    down = np.zeros(columns + 2 * half + 1)
    inner = down[half + 1 : half + 1 + columns]
    for row in range(-half, rows):
        if row + half < rows:
            inner += spread[row + half]
        if row > half:
            inner -= spread[row - half - 1]
        if row < 0:
            continue
        total = down[:side].sum()
        for column in range(columns):
            total += down[column + side] - down[column]
            sums[row, column] = total
            most = max(most, total)
    for k in range(len(values)):
        spread[band.row[k], band.column[k]] = 0.0
    return most


@njit(cache=True)
def most_about(boxes, pixel, side):  # type: ignore[no-untyped-def]
    """The most that is in the boxes about a pixel (column and row)."""
    half, most = side // 2, -np.inf
    for row in range(max(0, pixel[1] - half), min(len(boxes), pixel[1] + half + 1)):
        left, right = max(0, pixel[0] - half), min(boxes.shape[1], pixel[0] + half + 1)
        for column in range(left, right):
            most = max(most, boxes[row, column])
    return most
