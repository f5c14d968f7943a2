"""Strokes off their ink: where those that run along all of it leave ink, or draw on paper.

    ────────┬────       a corner within the ink of another line: the head has cut it, or ended two strokes
       ╱    │           there, and a pen along these would leave part of the ink

All the ink is some stroke's: what a pen leaves there is no other line's, as it may be beside a contour (see
`own_ink`). So about each place that the head ran from memory both tell, each by itself:

    off = max(ink left, ink drawn on paper), in widths of the pen squared, in a box as wide as the pen

of the pen's widths that explain the box best: the stroke's own, which is that of its longest run, or that of
most strokes. A felt pen's ink is ragged, and a nib's swells: told is what is off far more than where the
swinging cell led, whatever that is on the sheet. Ends that are alone are left out, and so are gaps that the
head may cross: a pen is lifted as it likes.

Signals: the drawing and its strokes in; places out, the worst first.

Source: our own. Questions: a way that is wrong within ink that other strokes explain is not seen.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import ROUNDED, Array
from morfax.motion.compiled import njit
from morfax.motion.median import median, percentile
from morfax.motion.neighbours import Neighbours
from morfax.motion.polyline import at_lengths, lengths_mm
from morfax.motion.usual import THINNED
from morfax.tracer.drawing.between import between
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import CELL
from morfax.tracer.ink.crossing_on_ink import OFF
from morfax.tracer.limits import ABOUT_WIDTHS, CLEAR_WIDTHS, PAPER
from morfax.tracer.program.against_ink.own_ink import PLACES_PX, parts
from morfax.tracer.program.against_ink.pen_on_ink import (
    PenOnInk,
    Ways,
    band_of,
    clear,
    in_boxes,
    most_about,
    sums_of,
)
from morfax.tracer.program.against_ink.turned_in_ink import stretches_that_turn, without
from morfax.tracer.program.against_ink.unexplained import Unexplained
from morfax.tracer.tangles.pen import ink_at

# All limits below were chosen by trial on crowded sheets.
# times what is off at nine of ten of some places to which the cell led; on six sheets of felt pens, nibs and
# print 0.03 to 0.08 of a width², on those of even pens 0.002 to 0.004
OF_USUAL, MOST, PLACES = 6.0, 90.0, 200
HALF = 0.5  # widths²: half of a box is off, whatever the pen
OF_WIDTH = (0.9, 1.0, 1.1)  # of the line's: pens that are tried
ABOUT_END = 2.0  # widths: nearer to an end, the round of its pen is looked at
TILE_PX = 192  # of what is judged in one
STATION_PX = 2  # places from one that is judged to the next


def strokes_off_ink(
    drawing: Drawing, lines: Sequence[Line], gap_mm: float = 0.0
) -> list[Unexplained]:
    """Where strokes along all the ink, over gaps in it too, are off it, the worst first; nothing where no pen
    can be told.
    """
    noise, some = drawing.noise, [line for line in lines if not line.on_edge]
    if not noise.softness_px > 0 or drawing.grainy or drawing.finer > 1 or not some:
        return []
    ways, from_memory = _ways(drawing, some)
    judged = ~_at_lone_ends(ways) & ~_at_lone_gaps(drawing, ways, gap_mm / drawing.pitch_mm)
    is_station = from_memory & judged & (np.arange(len(judged)) % STATION_PX == 0)
    if not is_station.any():
        return []
    by_cell = np.flatnonzero(~from_memory & judged)
    is_station[by_cell[:: 1 + len(by_cell) // PLACES]] = True
    half_px = median(ways.half_px)
    reach_px, paper = 2 * CLEAR_WIDTHS * half_px, 0.5 * noise.paper**2
    pen = PenOnInk(half_px, noise.softness_px, reach_px, paper, OF_WIDTH, OFF)
    # what is told, or raises the limit, is above these
    limits = np.where(from_memory, OFF, OFF / OF_USUAL)
    stations, off = _off(drawing, ways, is_station, limits, pen)
    limit = _limit(off[~from_memory[stations]])
    is_off = from_memory[stations] & (off > limit)
    told = list(_places(drawing, ways, stations[is_off], off[is_off]))
    # 3. what turns, and is told by no ink
    for first, last in stretches_that_turn(ways, from_memory & judged, half_px):
        is_station[:] = False
        is_station[first:last:STATION_PX] = True
        others = without(ways, first, last, reach_px)
        stations, off = _off(drawing, others, is_station, np.full(len(judged), limit), pen)
        if off.max() < limit:
            told += _places(drawing, ways, stations, off)
    return told


def _off(
    drawing: Drawing,
    ways: Ways,
    is_station: NDArray[np.bool_],
    limits: Array,
    pen: PenOnInk,
) -> tuple[NDArray[np.int64], Array]:
    """The numbers of some stations, and by how much strokes are off their ink about each (see `_off_at`)."""
    found = [
        (
            part.stations,
            _off_at(part.seen, part.ways, part.at, limits[part.stations], pen, part.room),
        )
        for part in parts(drawing, ways, is_station, TILE_PX, pen)
    ]
    stations, off = (np.concatenate(column) for column in zip(*found, strict=True))
    return stations, off


def _limit(by_cell: Array) -> float:
    """By how much strokes are off where they are not on their ink, widths², if they are so much off where the
    cell led.
    """
    usual = percentile(by_cell, MOST) if len(by_cell) else 0.0
    return min(max(OFF, OF_USUAL * usual), HALF)


def _ways(drawing: Drawing, lines: Sequence[Line]) -> tuple[Ways, NDArray[np.bool_]]:
    """The ways of strokes in pixels of the sheet, and to which of their places the head ran from memory."""
    pitch_mm, rows = drawing.pitch_mm, drawing.darkness.shape[0]
    places, from_memory = list[Array](), list[NDArray[np.bool_]]()
    for line in lines:
        come_mm, (_, leaders) = (
            lengths_mm(line.places_mm),
            line.led.thinned(line.xy_mm, THINNED),
        )
        count = 2 + math.ceil(come_mm[-1] / (PLACES_PX * pitch_mm))
        at_mm = np.linspace(0.0, come_mm[-1], count)
        leads = leaders[np.minimum(np.searchsorted(come_mm, at_mm), len(leaders) - 1)]
        places.append(at_lengths(line.places_mm, at_mm))
        from_memory.append(leads != CELL)
    every = np.vstack(places)
    columns = np.column_stack([every[:, 0], rows * pitch_mm - every[:, 1]]) / pitch_mm - 0.5
    number = np.repeat(np.arange(len(lines), dtype=np.int32), [len(way) for way in places])
    half_px = np.array([0.5 * line.width_mm / pitch_mm for line in lines])
    ways = Ways(columns.astype(np.float32), number, half_px, np.ones(len(lines), bool))
    return ways, np.concatenate(from_memory)


def _at_lone_ends(ways: Ways) -> NDArray[np.bool_]:
    """Which places are about an end of a stroke beside which no other runs."""
    first = np.flatnonzero(np.diff(ways.line, prepend=-1))
    last = np.r_[first[1:], len(ways.line)] - 1
    lone = np.concatenate([ends[_are_lone(ways, ends)] for ends in (first, last)])
    return _about(ways, lone, lone)


def _at_lone_gaps(drawing: Drawing, ways: Ways, gap_px: float) -> NDArray[np.bool_]:
    """Which places are about a gap in a stroke's ink, no longer than that, beside which no other runs."""
    column, row = ways.places_px.T
    is_bare = between(drawing.darkness, row, column, edge_goes_on=True) < PAPER
    edges = np.diff(np.r_[False, is_bare, False].astype(np.int8))
    first, last = np.flatnonzero(edges > 0), np.flatnonzero(edges < 0) - 1
    most_px = gap_px + CLEAR_WIDTHS * 2 * ways.half_px[ways.line[first]]
    is_gap = (ways.line[first] == ways.line[last]) & ((last - first) * PLACES_PX < most_px)
    is_gap &= _are_lone(ways, first) & _are_lone(ways, last)
    return _about(ways, first[is_gap], last[is_gap])


def _about(ways: Ways, first: NDArray[np.int64], last: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Which places of their lines lie between some places and others, or so near that ends are looked at."""
    about = np.zeros(len(ways.line), bool)
    reach = np.ceil(_about_end_px(ways, first) / PLACES_PX).astype(int)
    begins, ends = (
        np.searchsorted(ways.line, ways.line[first], side) for side in ("left", "right")
    )
    begins, ends = np.maximum(first - reach + 1, begins), np.minimum(last + reach, ends)
    for begin, end in zip(begins.tolist(), ends.tolist(), strict=True):
        about[begin:end] = True
    return about


def _about_end_px(ways: Ways, some: NDArray[np.int64]) -> Array:
    """How near to each of some places, if it were an end, the round of its pen is looked at, pixels."""
    return np.asarray(ABOUT_END * 2 * ways.half_px[ways.line[some]])


def _are_lone(ways: Ways, some: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether beside each of some places no other stroke runs, nor the same one farther on."""
    if not len(some):
        return np.zeros(0, bool)
    about_px = _about_end_px(ways, some)
    widest_px = ABOUT_END * 2 * float(ways.half_px.max())
    count = min(2 * math.ceil(widest_px / PLACES_PX), len(ways.line))
    near = Neighbours(ways.places_px).several(ways.places_px[some], count)
    off_px = np.hypot(*np.moveaxis(ways.places_px[near] - ways.places_px[some, None], 2, 0))
    on_px = np.abs(near - some[:, None]) * PLACES_PX
    is_other = ways.line[near] != ways.line[some, None]
    is_other |= on_px > 2 * about_px[:, None]
    return np.asarray(~(is_other & (off_px < about_px[:, None])).any(axis=1))


@njit(cache=True)
def _off_at(seen, ways, stations, limits, pen, room):  # type: ignore[no-untyped-def]
    """By how much strokes are off their ink about each station (m,) of a tile, widths², where that may be
    above its limit; else no less than that, and not above the limit.
    """
    band = band_of(seen, ways, pen, room)
    clear(seen, band, room)
    spread, side = room.spread[: seen.size].reshape(seen.shape), 2 * round(pen.half_px) + 1
    worst, off = np.empty(seen.shape), np.empty(len(stations))
    # 1. all that the strokes' own pens leave: the best pens leave no more
    values = np.empty(len(band.dark))
    for k in range(len(values)):
        wrong = ink_at(band.beyond_px[k], 0.0, pen.softness_px) - band.dark[k]
        values[k] = wrong * wrong - pen.noise
    in_boxes(band, values, side, spread, worst)
    is_sure = True
    for k in range(len(off)):
        off[k] = most_about(worst, stations[k], side) / (2 * pen.half_px) ** 2
        is_sure &= off[k] < (1 - ROUNDED) * limits[k]
    if is_sure:
        return off
    # 2. what the best pens do
    _best_of(band, pen, spread, worst)
    for k in range(len(off)):
        off[k] = most_about(worst, stations[k], side) / (2 * pen.half_px) ** 2
    return off


@njit(cache=True)
def _best_of(band, pen, spread, worst):  # type: ignore[no-untyped-def]
    """Fill in the more of what the pen that explains each box best draws on paper, and of what it leaves."""
    least, worst[:] = np.full(worst.shape, np.inf), 0.0
    paper, left = np.empty(worst.shape), np.empty(worst.shape)
    # ink that two lines share is broad, and a stroke that goes on from there is not
    own_px, usual_px = band.half_px, np.minimum(band.half_px, pen.half_px)
    for pens in range(1 + np.any(own_px > usual_px)):
        for share in pen.of_width:
            half_px = share * (own_px if pens == 0 else usual_px)
            sums_of(band, band.beyond_px + own_px - half_px, pen, spread, (paper, left))
            for i in range(len(least)):
                for j in range(least.shape[1]):
                    if paper[i, j] + left[i, j] < least[i, j]:
                        least[i, j] = paper[i, j] + left[i, j]
                        worst[i, j] = max(paper[i, j], left[i, j])


def _places(
    drawing: Drawing, ways: Ways, stations: NDArray[np.int64], off: Array
) -> Iterator[Unexplained]:
    """The places at which stations are off their ink, each the worst of those about it, the worst first."""
    rows, pitch_mm, left = drawing.darkness.shape[0], drawing.pitch_mm, np.argsort(-off)
    about_px = ABOUT_WIDTHS * 2 * median(ways.half_px)
    while len(left):
        at = ways.places_px[stations[left]]
        is_near = np.hypot(*(at - at[0]).T) < about_px
        # a place of one station is as long as what that stands for
        long_px = max(np.hypot(*np.ptp(at[is_near], axis=0)), STATION_PX * PLACES_PX)
        column, row = at[0].tolist()
        place_mm = (column + 0.5) * pitch_mm, (rows - row - 0.5) * pitch_mm
        yield Unexplained(place_mm, float(long_px) * pitch_mm, "off")
        left = left[~is_near]
