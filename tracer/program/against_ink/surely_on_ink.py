"""Surely on ink: a quick proof that what a pen leaves wrong about stations of a way is below a limit.

`over_at` (see `pen_on_ink`) has the pens of several widths that explain a box best. Whatever pens these are,
they leave no more than the felt ones, and neither what they draw on paper nor what ink they leave counts for
less than no noise at all. So both are below

    over <= sum((drawn by the felt pens - seen)²) - noise · pixels of the box

and only boxes that are above the limit by this are looked at with all the pens; only stations about which
all that is wrong is above it are looked at box by box. No pen draws more on paper than the widest does: where
that is below the limit in every box, as where other lines cross, no other is tried.

Signals: as of `over_at`, and the limit of each station (m,) in; out for each whether it may be over.

Source: our own. Questions: none.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import ROUNDED
from morfax.motion.compiled import njit
from morfax.tracer.program.against_ink.pen_on_ink import band_of, clear
from morfax.tracer.tangles.pen import ink_at

KEPT = 1021  # boxes of which is kept what was told; a prime number
WIDEST_PX = 1 << 20  # more than any part of a sheet is wide: a box's number tells its place


@njit(cache=True)
def may_be_over(seen, ways, stations, limits, pen, room, out):  # type: ignore[no-untyped-def]
    """Fill `out` (m,) with whether more than its limit, in widths of the pen squared, is over about each
    station.
    """
    band = band_of(seen, ways, pen, room)
    spread, side = room.spread[: seen.size].reshape(seen.shape), 2 * round(pen.half_px) + 1
    # 1. all that is wrong in each square of half a box's side, from a box before the part on
    half, number = max(1, side // 2), room.number[: seen.size].reshape(seen.shape)
    squares = np.zeros(
        ((len(seen) + 2 * side) // half + 2, (seen.shape[1] + 2 * side) // half + 2)
    )
    for k in range(len(band.dark)):
        wrong = ink_at(band.beyond_px[k], 0.0, pen.softness_px) - band.dark[k]
        row, column = band.row[k], band.column[k]
        spread[row, column] = wrong * wrong - pen.noise
        squares[(row + side) // half, (column + side) // half] += max(spread[row, column], 0.0)
    # 2. where that is more than the limit, box by box: with the felt pens, what the widest draw, the best
    down, boxes, papers = np.empty(2 * side - 1), np.empty((side, side)), np.empty((side, side))
    near, middle = np.empty((2 * side - 1, 2 * side - 1)), np.array([side - 1, side - 1])
    told, wrongs = np.full((KEPT, 3), -1.0), np.empty((0, 0))
    for k in range(len(stations)):
        limit = (1 - ROUNDED) * limits[k] * (2 * pen.half_px) ** 2
        out[k] = _most_in_squares(squares, stations[k], side, half) > limit
        if out[k]:
            _in_boxes_about(spread, stations[k], down, boxes)
            out[k] = boxes.max() > limit
        if out[k]:
            _on_paper(band, number, stations[k], pen, near)
            _in_boxes_about(near, middle, down, papers)
            out[k] = papers.max() > limit
        if out[k] and not wrongs.size:
            wrongs = np.full((len(pen.of_width), len(band.dark)), np.nan)
        if out[k]:
            part = seen, (band, wrongs), room
            out[k] = _is_over((boxes, told), part, stations[k], limit, pen)
    for k in range(len(band.dark)):
        spread[band.row[k], band.column[k]] = 0.0
    clear(seen, band, room)


@njit(cache=True)
def _most_in_squares(squares, pixel, side, half):  # type: ignore[no-untyped-def]
    """The most in the squares of half a side that any box about a pixel (column, row) may reach into."""
    more, most = (side + half - 2) // half, 0.0
    for top in range((pixel[1] + 1) // half, (pixel[1] + side) // half + 1):
        for left in range((pixel[0] + 1) // half, (pixel[0] + side) // half + 1):
            here = 0.0
            for i in range(top, top + more + 1):
                for j in range(left, left + more + 1):
                    here += squares[i, j]
            most = max(most, here)
    return most


@njit(cache=True)
def _too_dark(band, k, share, pen):  # type: ignore[no-untyped-def]
    """What a pen of a share of its line's width draws too dark at a pixel of a band."""
    beyond_px = band.beyond_px[k] - (share - 1) * band.half_px[k]
    return ink_at(beyond_px, 0.0, pen.softness_px) - band.dark[k]


@njit(cache=True)
def _on_paper(band, number, pixel, pen, near):  # type: ignore[no-untyped-def]
    """Fill in what the widest pen draws on paper at pixels that boxes about a pixel (column, row) hold."""
    reach = len(near) // 2
    near[:] = 0.0
    for i in range(max(0, pixel[1] - reach), min(len(number), pixel[1] + reach + 1)):
        for j in range(max(0, pixel[0] - reach), min(number.shape[1], pixel[0] + reach + 1)):
            k = number[i, j] - 1
            if k >= 0:
                wrong = max(_too_dark(band, k, pen.of_width[-1], pen), 0.0)
                near[i - pixel[1] + reach, j - pixel[0] + reach] = wrong**2 - pen.noise


@njit(cache=True)
def _in_boxes_about(values, pixel, down, boxes):  # type: ignore[no-untyped-def]
    """Fill in the sums of values over the boxes about each pixel of the box about a pixel (column, row).

    `down` is room to work in: sums of each column, two sides less one wide.
    """
    side = len(boxes)
    top, left = pixel[1] - side + 1, pixel[0] - side + 1
    first, last = max(left, 0), min(left + len(down), values.shape[1])
    down[:] = 0.0
    inner = down[first - left : last - left]
    for n in range(2 * side - 1):
        if 0 <= top + n < len(values):
            entering = values[top + n, first:last]
            for j in range(len(inner)):
                inner[j] += entering[j]
        if n >= side and 0 <= top + n - side < len(values):
            leaving = values[top + n - side, first:last]
            for j in range(len(inner)):
                inner[j] -= leaving[j]
        if n >= side - 1:
            across = boxes[n - side + 1]
            across[:] = 0.0
            for i in range(side):
                for j in range(side):
                    across[j] += down[i + j]


@njit(cache=True)
def _is_over(found, part, station, limit, pen):  # type: ignore[no-untyped-def]
    """Whether the best pens draw more than a limit on paper in a box about a station, and leave more ink.

    What is told of a box is kept for the next stations, as long as no other needs its place: `told` has the
    box's number, and both.
    """
    (boxes, told), half = found, round(pen.half_px)
    most_paper, most_left = -np.inf, -np.inf
    for i in range(len(boxes)):
        for j in range(len(boxes)):
            if boxes[i, j] <= limit:
                continue
            box = station[0] + j - half, station[1] + i - half
            number = box[1] * WIDEST_PX + box[0]
            kept = told[number % KEPT]
            if kept[0] != number:
                kept[0] = number
                kept[1], kept[2] = _best_in(part, box, pen)
            most_paper, most_left = max(most_paper, kept[1]), max(most_left, kept[2])
    return min(most_paper, most_left) > limit


@njit(cache=True)
def _best_in(part, box, pen):  # type: ignore[no-untyped-def]
    """What the pen that explains the box about a pixel (column, row) best draws on paper there, and what ink
    it leaves.

    What a pen draws too dark at a pixel is worked out once, for pixels of such boxes alone.
    """
    seen, (band, wrongs), room = part
    number = room.number[: seen.size].reshape(seen.shape)
    half, least = round(pen.half_px), np.inf
    best_paper, best_left = 0.0, 0.0
    for n, wrong in enumerate(wrongs):
        paper, left = 0.0, 0.0
        for i in range(max(0, box[1] - half), min(len(seen), box[1] + half + 1)):
            for j in range(max(0, box[0] - half), min(seen.shape[1], box[0] + half + 1)):
                k = number[i, j] - 1
                if k >= 0:
                    if np.isnan(wrong[k]):
                        wrong[k] = _too_dark(band, k, pen.of_width[n], pen)
                    paper += max(wrong[k], 0.0) ** 2 - pen.noise
                    left += max(-wrong[k], 0.0) ** 2 - pen.noise
        if paper + left < least:
            least, best_paper, best_left = paper + left, paper, left
    return best_paper, best_left
