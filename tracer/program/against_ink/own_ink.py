"""Own ink: whether a pen along ways would leave the ink that is on the sheet.

    ║  ╭╮  ║      the head went straight across a bay, or cut its end short: there the pen's ink lies beside
    ║  ││  ║      the sheet's
    ╚══╯╰══╝

Within some widths of a way each pixel is held against the ink of a pen (see `pen_on_ink`) along whatever line
its edge is nearest to, as wide as that was felt, or by that share which explains a box about it best: a line
that swells is no other line. What the pens draw on paper there is summed,

    over = (sum((drawn - seen)²) - what the paper's noise leaves) · area of a pixel / width²

and so is the ink that they leave; a way is beside its ink where the lesser of both is large, and far above
that of most of its line. By itself neither tells: another line or a tick leaves ink, and a gap is paper.

Signals: the drawing and lines that were followed in; stretches of them beside their ink out, of those that
closed or ended.

Source: our own, as tangles are redrawn. Questions: a way that cuts off ink, and stays on ink, as along a
tick, is not found. At the end of an open line there is paper ahead, or another line's ink: neither counts.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array, bounds
from morfax.motion.median import median, percentile
from morfax.motion.polyline import evenly
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.moved import moved
from morfax.tracer.program.against_ink.pen_on_ink import PenOnInk, Ways, over_at
from morfax.tracer.program.against_ink.sheet_parts import margin_px, parts
from morfax.tracer.program.against_ink.surely_on_ink import may_be_over
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles.felt_pen import FAR

# Limits chosen by trial on 625 right ways of parts, holes, slots, notches and tongues, none of which comes
# above them. Of 25 wrong ones 12 do, and of those that are more than 0.4 mm off all but two.
MOST = 60.0  # percent of the line
OF_WIDTH = (0.8, 0.9, 1.0, 1.1, 1.25)  # of the line's: pens that are tried
STATION_WIDTHS = 0.25  # between the places at which a way is judged
# between the places that stand for a way: near its edge they are 0.04 px off it
PLACES_PX = 1.0
# endings of lines; those that ran into others, or were lost, may have turned off their ink
JUDGED = "closed", "ended"
TILE_PX = 128  # of what is judged in one
QUICK_PX = 256  # of what is looked through first


class OverLimits(NamedTuple):
    """What may be over on a right way: so much, as much in squared pixels, and so many times what is over on
    most of the line.
    """

    over: float
    specks_px2: float
    of_most: float

    def of(self, half_px: Array) -> Array:
        """The limits for lines of half a width in pixels."""
        return np.maximum(self.over, self.specks_px2 / (2 * half_px) ** 2)


SURE = OverLimits(0.05, specks_px2=2.2, of_most=6.0)  # specks, which a scan has, leave so much
DOUBT = OverLimits(0.015, specks_px2=0.66, of_most=1.8)  # it may be wrong
# a corner cut by a tenth of a width is over by more; the least of all: nothing below it is looked at
NEARLY = OverLimits(0.0075, specks_px2=0.0, of_most=1.8)


class BesideInk(NamedTuple):
    """A stretch of a way beside its ink: the place furthest beside it, how long it is, mm, and whether
    that is sure.
    """

    place_mm: tuple[float, float]
    length_mm: float
    is_sure: bool


Over = tuple[
    NDArray[np.int64], Array
]  # stations, by the numbers of a line's places, and what is over


class _Known(NamedTuple):
    """What is known of lines before some were mended: which were not surely on their ink, what was over on
    each of these by their numbers, and which (n,) have to be judged again.
    """

    doubtful: NDArray[np.bool_]
    over: dict[int, Over]
    asked: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class OwnInk:
    """Some lines of a drawing, which are held against their ink once, for all limits."""

    drawing: Drawing
    lines: Sequence[Line]
    known: _Known | None = None

    def mended(self, lines: Sequence[Line]) -> OwnInk:
        """The lines with some of them mended: what is known of those that lie far from there still holds."""
        pairs = zip(self.lines, lines, strict=True)
        asked = np.array([new is not old for old, new in pairs], bool)
        places_px, pen = self._ways.places_px, self._pen
        for k in np.flatnonzero(asked).tolist():
            off = moved(self.lines[k], lines[k], STEP_WIDTHS)
            if len(off):
                low, high = bounds(_pixels(self.drawing, off))
                is_near = places_px > low - margin_px(pen)
                is_near &= places_px < high + margin_px(pen)
                asked[self._ways.line[is_near.all(axis=1)]] = True
        return OwnInk(self.drawing, lines, _Known(self.doubtful, self._over, asked))

    def beside(self, limits: OverLimits) -> Iterator[BesideInk]:
        """Where lines that closed or ended run beside their ink, by more than some limits; nothing where no
        pen can be told.
        """
        for k, (station, over) in sorted(self._over.items()):
            half_px, usual = self._ways.half_px[k], percentile(over, MOST)
            least, sure = (
                max(float(each.of(half_px)), each.of_most * usual) for each in (limits, SURE)
            )
            first_of_line = int(np.searchsorted(self._ways.line, k))
            for first, last in _stretches(over > least):
                worst = first + int(np.argmax(over[first:last]))
                places = 1 + station[last - 1] - station[first]
                at = first_of_line + station[worst]
                place_mm = _mm(self.drawing, self._ways.places_px[at])
                long_mm = float(places * PLACES_PX * self.drawing.pitch_mm)
                yield BesideInk(place_mm, long_mm, bool(over[worst] > sure))

    @cached_property
    def doubtful(self) -> NDArray[np.bool_]:
        """Which lines, of those that closed or ended, are not surely on their ink."""
        noise, known = self.drawing.noise, self.known
        is_told = bool(self.lines) and noise.softness_px > 0 and not self.drawing.grainy
        if not is_told or not self._ways.judged.any():
            return np.zeros(len(self.lines), bool)
        asked = np.ones(len(self.lines), bool) if known is None else known.asked
        doubtful = _doubtful(self.drawing, self._ways, asked, self._pen)
        return doubtful if known is None else np.where(asked, doubtful, known.doubtful)

    @cached_property
    def _over(self) -> dict[int, Over]:
        """What is over on each line that is not surely on its ink, by its number, in the order of its way."""
        known, asked = self.known, self.doubtful
        over = dict[int, Over]()
        if known is not None:
            over.update(
                (k, known.over[k]) for k in np.flatnonzero(asked & ~known.asked).tolist()
            )
            asked = asked & known.asked
        if not asked.any():
            return over
        found = zip(*_judged(self.drawing, self._ways, asked, self._pen), strict=True)
        line, station, all_over = (np.concatenate(column) for column in found)
        for k in np.flatnonzero(asked).tolist():
            own = np.flatnonzero(line == k)
            own = own[np.argsort(station[own], kind="stable")]
            over[k] = station[own] - np.searchsorted(self._ways.line, k), all_over[own]
        return over

    @cached_property
    def _ways(self) -> Ways:
        """The ways of the lines."""
        return _ways(self.drawing, self.lines)

    @cached_property
    def _pen(self) -> PenOnInk:
        """The pen of most lines."""
        return _pen(self.drawing, self._ways)


def _ways(drawing: Drawing, lines: Sequence[Line]) -> Ways:
    """The ways of lines in pixels of the sheet."""
    pitch_mm = drawing.pitch_mm
    ways = [evenly(line.places_mm, PLACES_PX * pitch_mm) for line in lines]
    return Ways(
        np.vstack([_pixels(drawing, way) for way in ways]),
        np.repeat(np.arange(len(ways), dtype=np.int32), [len(way) for way in ways]),
        np.array([0.5 * line.width_mm / pitch_mm for line in lines]),
        np.array([line.ending in JUDGED and not line.on_edge for line in lines]),
    )


def _pixels(drawing: Drawing, places_mm: Array) -> NDArray[np.float32]:
    """Places (n, 2) mm in columns and rows of the sheet."""
    pitch_mm, rows = drawing.pitch_mm, drawing.darkness.shape[0]
    places = np.column_stack([places_mm[:, 0], rows * pitch_mm - places_mm[:, 1]])
    return (places / pitch_mm - 0.5).astype(np.float32)


def _doubtful(
    drawing: Drawing, ways: Ways, which: NDArray[np.bool_], pen: PenOnInk
) -> NDArray[np.bool_]:
    """Which of some lines are not surely on their ink: most are, and need not be judged."""
    doubtful, least = np.zeros(len(ways.judged), bool), NEARLY.of(ways.half_px)
    is_station = _are_stations(ways, ways.judged & which)
    for part in parts(drawing, ways, is_station, QUICK_PX, pen):
        asked = ~doubtful[ways.line[part.stations]]
        line, at = ways.line[part.stations[asked]], part.at[asked]
        may = np.empty(len(line), bool)
        may_be_over(part.seen, part.ways, at, least[line], part.pen, part.room, may)
        doubtful[line[may]] = True
    return doubtful


def _judged(
    drawing: Drawing, ways: Ways, which: NDArray[np.bool_], pen: PenOnInk
) -> Iterator[tuple[NDArray[np.int32], NDArray[np.int64], Array]]:
    """The stations of some lines, tile by tile: line, number of the place, and what is over."""
    for part in parts(drawing, ways, _are_stations(ways, which), TILE_PX, pen):
        over = over_at(part.seen, part.ways, part.at, part.pen, part.room)
        yield ways.line[part.stations], part.stations, over


def _are_stations(ways: Ways, which: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which places are stations of some lines."""
    is_every = np.arange(len(ways.line)) % _every(ways) == 0
    return np.asarray(which[ways.line] & ~_near_ends(ways) & is_every)


def _near_ends(ways: Ways) -> NDArray[np.bool_]:
    """Which places lie within a width of an end of an open way: many pens come to a point there."""
    # a line that was lost at once has no way
    lines, first, counts = np.unique(ways.line, return_index=True, return_counts=True)
    last = first + counts - 1
    apart_px = np.hypot(*(ways.places_px[last] - ways.places_px[first]).T)
    near = np.where(apart_px > 2 * PLACES_PX, 2 * ways.half_px[lines] / PLACES_PX, 0.0)
    from_first = np.arange(len(ways.line)) - np.repeat(first, counts)
    to_last = np.repeat(counts, counts) - 1 - from_first
    near = np.repeat(near, counts)
    return np.asarray((from_first < near) | (to_last < near))


def _pen(drawing: Drawing, ways: Ways) -> PenOnInk:
    """The pen of most lines; what it draws on paper matters above the least limit."""
    half_px, noise = median(ways.half_px[ways.judged]), drawing.noise
    reach_px, paper = 2 * FAR * half_px, 0.5 * noise.paper**2
    return PenOnInk(half_px, noise.softness_px, reach_px, paper, OF_WIDTH, NEARLY.over)


def _every(ways: Ways) -> int:
    """One place of the ways in so many is a station."""
    return max(1, round(2 * STATION_WIDTHS * float(np.min(ways.half_px)) / PLACES_PX))


def _stretches(above: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """The first and the one after the last of each stretch of stations that are above the limit."""
    edges = np.flatnonzero(np.diff(np.r_[False, above, False].astype(np.int8)))
    return [(int(first), int(last)) for first, last in edges.reshape(-1, 2)]


def _mm(drawing: Drawing, place_px: NDArray[np.float32]) -> tuple[float, float]:
    """A place in pixels, on the sheet in mm."""
    column, row = place_px.tolist()
    rows = drawing.darkness.shape[0]
    return (column + 0.5) * drawing.pitch_mm, (rows - row - 0.5) * drawing.pitch_mm
