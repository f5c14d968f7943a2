"""In one box: where a pen both draws on paper and leaves ink within a width, a way surely is not the line's.

    ──────╮         the way cuts a tip, a step or a bump of less than a width: its pen draws on paper on one
      ──╮ ╰───      side of it and leaves ink on the other, and neither is much

Another line, a tick or a blot leaves ink, and a gap is paper; a box of a width with both shows a line that
runs elsewhere, however little there is of each. But for specks: a light one on the line and a dark one beside
it are just that. So of each pixel no more counts than is wrong, to the same side, at one of those about it.

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
from morfax.motion.median import percentile
from morfax.tracer.program.against_ink.own_ink import (
    MOST,
    NEARLY,
    PLACES_PX,
    TILE_PX,
    BesideInk,
    OverLimits,
    OwnInk,
    parts,
    pen_of,
    place_of_mm,
    stretches_of,
)
from morfax.tracer.program.against_ink.pen_on_ink import band_of, clear, in_boxes, most_about
from morfax.tracer.program.against_ink.unexplained import Unexplained, is_about
from morfax.tracer.tangles.pen import ink_at

# of 230 000 stations of right ways on lines of 2.7 to 10 pixels none comes above 0.005; a way 0.16 widths off
# leaves 0.02
BOTH = OverLimits(NEARLY.over, specks_px2=0.08, of_most=NEARLY.of_most)


def surely_left(own: OwnInk, left: Sequence[Unexplained]) -> tuple[Unexplained, ...]:
    """Those of some places that lines leave unexplained that are sure, and where one box shows that they run
    beside their ink; the longest first.
    """
    sure = [place for place in left if place.is_sure]
    for place_mm, long_mm, _ in _surely_beside(own):
        place = Unexplained(place_mm, long_mm, "beside")
        sure += [] if is_about(place, sure, own.lines) else [place]
    return tuple(sorted(sure, key=lambda place: -place.length_mm))


def _surely_beside(own: OwnInk) -> Iterator[BesideInk]:
    """Where lines that closed or ended surely run beside their ink, as far as one box shows it."""
    for half_px, station, over in own.judged:
        limit = max(float(BOTH.of(half_px)), BOTH.of_most * percentile(over, MOST))
        asked = over > limit  # elsewhere the best pens explain all
        if not asked.any():
            continue
        both = np.zeros(len(over))
        both[asked] = _both_at(own, station[asked])
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
    """What pens as wide as the lines were felt draw on paper, and leave of the ink as well, in the worst box
    about each station (m,), in widths of the pen squared.
    """
    band, side = band_of(seen, ways, pen, room), 2 * round(pen.half_px) + 1
    shape, count = seen.shape, len(band.dark)
    number, spread = (
        room.number[: seen.size].reshape(shape),
        room.spread[: seen.size].reshape(shape),
    )
    both, lefts = np.empty(shape), np.empty(shape)
    wrong, paper, left = np.empty(count), np.empty(count), np.empty(count)
    for k in range(count):
        wrong[k] = ink_at(band.beyond_px[k], 0.0, pen.softness_px) - band.dark[k]
    _without_specks(band, number, wrong, paper, left)
    for k in range(count):
        paper[k] = paper[k] ** 2 - pen.noise
        left[k] = left[k] ** 2 - pen.noise
    in_boxes(band, paper, side, spread, both)
    in_boxes(band, left, side, spread, lefts)
    for i in range(shape[0]):
        for j in range(shape[1]):
            both[i, j] = min(both[i, j], lefts[i, j])
    clear(seen, band, room)
    most, width2 = np.empty(len(stations)), (2 * pen.half_px) ** 2
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
