"""In one box: where a pen both draws on paper and leaves ink within a width, a way surely is not the line's.

    ──────╮         the way cuts a tip, a step or a bump of less than a width: its pen draws on paper on one
      ──╮ ╰───      side of it and leaves ink on the other, and neither is much

Another line, a tick or a blot leaves ink, and a gap is paper; a box of a width with both shows a line that
runs elsewhere, however little there is of each. A cut tip leaves ink only, but the pen that explains it best
is a broader one; a line that begins there would want that too, so where ink goes on the felt pen is held
against it. A light speck on the line and a dark one beside it are just that: of each pixel no more counts
than is wrong, to the same side, at one of those about it.

    both = min(sum(too dark²), sum(too light²)) · area of a pixel / width²

Signals: lines that were held against their ink (see `own_ink`) in; stretches that surely are beside it out.

Source: our own. Questions: a way off within ink that several sides share leaves nothing to see.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.median import NEARLY_ALL, percentile
from morfax.tracer.drawing.components import INK
from morfax.tracer.program.against_ink.off_ink import EDGE
from morfax.tracer.program.against_ink.own_ink import (
    DOUBT,
    PLACES_PX,
    TILE_PX,
    BesideInk,
    OwnInk,
    parts,
    pen_of,
    place_of_mm,
    stretches_of,
)
from morfax.tracer.program.against_ink.pen_on_ink import band_of, clear, in_boxes, most_about
from morfax.tracer.program.against_ink.unexplained import Unexplained, is_about
from morfax.tracer.tangles.felt_pen import FAR
from morfax.tracer.tangles.pen import ink_at

# times what all but one in twenty of a line's stations have: of lines that are ragged throughout, as in
# prints, none has more. The least that tells, as of all that is in doubt, is thrice what any of 230 000
# stations of right ways has, on lines of 2.7 to 10 pixels; most burrs of a line drawn by hand leave less
RAGGED = 6.0
# sides of a box, odd: in one so broad about it, other ink reaches as far as is looked at
ROUND = 3


def with_boxes(own: OwnInk, sure: Sequence[Unexplained]) -> tuple[Unexplained, ...]:
    """Some places that lines leave unexplained, and where one box shows that they run beside their ink; the
    longest first.
    """
    found = list(sure)
    for place_mm, long_mm, _ in _surely_beside(own):
        place = Unexplained(place_mm, long_mm, "beside")
        found += [] if is_about(place, found, own.lines) else [place]
    return tuple(sorted(found, key=lambda place: -place.length_mm))


def _surely_beside(own: OwnInk) -> Iterator[BesideInk]:
    """Where lines that closed or ended surely run beside their ink, as far as one box shows it."""
    for _, station, over in own.judged:
        if over.max() < DOUBT.over:
            continue
        both = _both_at(own, station)
        limit = max(DOUBT.over, RAGGED * percentile(both, NEARLY_ALL))
        for first, last in stretches_of(both > limit):
            worst = station[first + int(np.argmax(both[first:last]))]
            long_px = PLACES_PX * (1 + station[last - 1] - station[first])
            place_mm = place_of_mm(own.drawing, own.ways.places_px[worst])
            yield BesideInk(place_mm, float(long_px * own.drawing.pitch_mm), is_sure=True)


def _both_at(own: OwnInk, stations: NDArray[np.int64]) -> Array:
    """What pens draw on paper and leave of the ink as well in the worst box about some stations (n,)."""
    ways, pen = own.ways, pen_of(own.drawing, own.ways)
    is_station, both = np.zeros(len(ways.line), bool), np.zeros(len(ways.line))
    is_station[stations] = True
    for part in parts(own.drawing, ways, is_station, TILE_PX, pen):
        both[part.stations] = in_one_box(part.seen, part.ways, part.at, part.pen, part.room)
    return both[stations]


@njit(cache=True)
def in_one_box(seen, ways, stations, pen, room):  # type: ignore[no-untyped-def]
    """What the pens that explain a box best draw on paper there, and leave of the ink as well, in the worst
    box about each station (m,), in widths of the pen squared; where ink goes on beyond what is looked at,
    pens as wide as the lines were felt.
    """
    band, side = band_of(seen, ways, pen, room), 2 * round(pen.half_px) + 1
    shape, count, width2 = seen.shape, len(band.dark), (2 * pen.half_px) ** 2
    number = room.number[: seen.size].reshape(shape)
    spread = room.spread[: seen.size].reshape(shape)
    goes_on, papers, lefts = np.empty(shape), np.empty(shape), np.empty(shape)
    # 1. where ink goes on beyond what is looked at
    wrong, paper, left = np.empty(count), np.empty(count), np.empty(count)
    for k in range(count):
        is_far = band.beyond_px[k] + band.half_px[k] > (FAR - EDGE) * 2 * pen.half_px
        left[k] = 1.0 if is_far and band.dark[k] > INK else 0.0
    in_boxes(band, left, ROUND * side, spread, goes_on)
    # 2. what pens of each width draw on paper and leave
    least, both = np.full(shape, np.inf), np.zeros(shape)
    for share in pen.of_width:
        for k in range(count):
            beyond_px = band.beyond_px[k] - (share - 1) * band.half_px[k]
            wrong[k] = ink_at(beyond_px, 0.0, pen.softness_px) - band.dark[k]
        _without_specks(band, number, wrong, paper, left)
        for k in range(count):
            paper[k] = paper[k] ** 2 - pen.noise
            left[k] = left[k] ** 2 - pen.noise
        in_boxes(band, paper, side, spread, papers)
        in_boxes(band, left, side, spread, lefts)
        for i in range(shape[0]):
            for j in range(shape[1]):
                is_others = goes_on[i, j] > 0.5 * EDGE * width2
                total = papers[i, j] + lefts[i, j]
                if (share == 1.0 and is_others) or (total < least[i, j] and not is_others):
                    least[i, j], both[i, j] = total, min(papers[i, j], lefts[i, j])
    clear(seen, band, room)
    most = np.empty(len(stations))
    for k in range(len(stations)):
        most[k] = most_about(both, stations[k], side) / width2
    return most


@njit(cache=True)
def _without_specks(band, number, wrong, dark, light):  # type: ignore[no-untyped-def]
    """Fill in by how much pixels of a band are too dark (n,) and too light, of what is wrong (n,) there:
    no more than one of the eight about it; their numbers (rows, columns) count from 1.
    """
    for k in range(len(wrong)):
        most_dark, most_light = 0.0, 0.0
        row, column = band.row[k], band.column[k]
        for i in range(max(0, row - 1), min(len(number), row + 2)):
            for j in range(max(0, column - 1), min(number.shape[1], column + 2)):
                near = number[i, j] - 1
                if near >= 0 and near != k:
                    most_dark = max(most_dark, wrong[near])
                    most_light = max(most_light, -wrong[near])
        dark[k] = min(max(wrong[k], 0.0), most_dark)
        light[k] = min(max(-wrong[k], 0.0), most_light)
