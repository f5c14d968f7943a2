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

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.median import median, percentile
from morfax.motion.neighbours import Neighbours
from morfax.motion.polyline import evenly
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.moved import MOVED, moved
from morfax.tracer.program.against_ink.pen_on_ink import PenOnInk, Ways, over_at
from morfax.tracer.program.against_ink.sheet_parts import margin_px, parts
from morfax.tracer.program.against_ink.surely_on_ink import may_be_over
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


class _Over(NamedTuple):
    """What is over on a line: at its stations, by the numbers of its places; and where these are, pixels."""

    station: NDArray[np.int64]
    over: Array
    places_px: NDArray[np.float32]


class _Known(NamedTuple):
    """What is known of lines some of which were mended: in their boxes; which were not surely on their ink
    before, and by the number of each of these what was over on it; and where they have moved, pixels (n, 2).
    """

    boxed: BoxedLines
    doubtful: NDArray[np.bool_]
    over: dict[int, _Over]
    moved_px: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class OwnInk:
    """Some lines of a drawing, which are held against their ink once, for all limits."""

    drawing: Drawing
    lines: Sequence[Line]
    known: _Known | None = None

    def mended(self, lines: Sequence[Line]) -> OwnInk:
        """The lines with some of them mended: what is known of places far from there still holds."""
        pairs = zip(self.lines, lines, strict=True)
        moved_mm = [moved(old, new, MOVED) for old, new in pairs if new is not old]
        moved_px = _pixels(self.drawing, np.vstack([np.empty((0, 2)), *moved_mm]))
        known = _Known(self.boxed.changed(lines), self.doubtful, self._over, moved_px)
        return OwnInk(self.drawing, lines, known)

    def beside(self, limits: OverLimits) -> Iterator[BesideInk]:
        """Where lines that closed or ended run beside their ink, by more than some limits; nothing where no
        pen can be told.
        """
        for k, (station, over, places_px) in sorted(self._over.items()):
            half_px, usual = self._ways.half_px[k], percentile(over, MOST)
            least, sure = (
                max(float(each.of(half_px)), each.of_most * usual) for each in (limits, SURE)
            )
            for first, last in _stretches(over > least):
                worst = first + int(np.argmax(over[first:last]))
                places = 1 + station[last - 1] - station[first]
                place_mm = _mm(self.drawing, places_px[worst])
                long_mm = float(places * PLACES_PX * self.drawing.pitch_mm)
                yield BesideInk(place_mm, long_mm, bool(over[worst] > sure))

    @cached_property
    def doubtful(self) -> NDArray[np.bool_]:
        """Which lines, of those that closed or ended, are not surely on their ink; or were not before they
        were mended.
        """
        noise = self.drawing.noise
        is_told = bool(self.lines) and noise.softness_px > 0 and not self.drawing.grainy
        doubtful = np.zeros(len(self.lines), bool)
        if not is_told or not self._ways.judged.any():
            return doubtful
        if self.known is not None:
            doubtful |= self.known.doubtful
        is_station = _are_stations(self._ways, self._ways.judged & ~doubtful) & self._is_new
        return doubtful | _doubtful(self.drawing, self._ways, is_station, self._pen)

    @cached_property
    def _over(self) -> dict[int, _Over]:
        """What is over on each line that is not surely on its ink, by its number, in the order of its way."""
        known = {} if self.known is None else self.known.over
        if not self.doubtful.any():
            return {}
        ways, is_station = self._ways, _are_stations(self._ways, self.doubtful)
        is_known = np.zeros(len(self.lines), bool)
        is_known[list(known)] = True
        is_asked = is_station & (self._is_new | ~is_known[ways.line])
        over = np.empty(len(ways.line))
        for station, some in _judged(self.drawing, ways, is_asked, self._pen):
            over[station] = some
        found = dict[int, _Over]()
        for k in np.flatnonzero(self.doubtful).tolist():
            first, last = np.searchsorted(ways.line, (k, k + 1)).tolist()
            station = first + np.flatnonzero(is_station[first:last])
            old = station[~is_asked[station]]
            if len(old):
                nearest = Neighbours(known[k].places_px).nearest(ways.places_px[old])[1]
                over[old] = known[k].over[nearest]
            found[k] = _Over(station - first, over[station], ways.places_px[station])
        return found

    @cached_property
    def _is_new(self) -> NDArray[np.bool_]:
        """Which places of the ways are near to where one has moved; all of lines that are new."""
        places_px = self._ways.places_px
        if self.known is None:
            return np.ones(len(places_px), bool)
        side_px = margin_px(self._pen)
        every = np.vstack([places_px, self.known.moved_px])
        column, row = np.maximum(every.T / side_px, 0).astype(np.int32)
        moved_at = np.zeros((row.max() + 1, column.max() + 1), np.uint8)
        moved_at[row[len(places_px) :], column[len(places_px) :]] = 1
        is_near = cv2.dilate(moved_at, np.ones((3, 3), np.uint8))
        return np.asarray(is_near[row[: len(places_px)], column[: len(places_px)]] > 0)

    @cached_property
    def boxed(self) -> BoxedLines:
        """The lines in their boxes."""
        return BoxedLines.of(self.lines) if self.known is None else self.known.boxed

    @cached_property
    def _ways(self) -> Ways:
        """The ways of the lines."""
        pitch_mm = self.drawing.pitch_mm
        ways = [evenly(places, PLACES_PX * pitch_mm) for places in self.boxed.places_mm]
        return Ways(
            np.vstack([_pixels(self.drawing, way) for way in ways]),
            np.repeat(np.arange(len(ways), dtype=np.int32), [len(way) for way in ways]),
            np.array([0.5 * line.width_mm / pitch_mm for line in self.lines]),
            np.array([line.ending in JUDGED and not line.on_edge for line in self.lines]),
        )

    @cached_property
    def _pen(self) -> PenOnInk:
        """The pen of most lines."""
        return _pen(self.drawing, self._ways)


def _pixels(drawing: Drawing, places_mm: Array) -> NDArray[np.float32]:
    """Places (n, 2) mm in columns and rows of the sheet."""
    pitch_mm, rows = drawing.pitch_mm, drawing.darkness.shape[0]
    places = np.column_stack([places_mm[:, 0], rows * pitch_mm - places_mm[:, 1]])
    return (places / pitch_mm - 0.5).astype(np.float32)


def _doubtful(
    drawing: Drawing, ways: Ways, is_station: NDArray[np.bool_], pen: PenOnInk
) -> NDArray[np.bool_]:
    """Which lines are not surely on their ink at some stations: most are, and need not be judged."""
    doubtful, least = np.zeros(len(ways.judged), bool), NEARLY.of(ways.half_px)
    for part in parts(drawing, ways, is_station, QUICK_PX, pen):
        asked = ~doubtful[ways.line[part.stations]]
        line, at = ways.line[part.stations[asked]], part.at[asked]
        may = np.empty(len(line), bool)
        may_be_over(part.seen, part.ways, at, least[line], part.pen, part.room, may)
        doubtful[line[may]] = True
    return doubtful


def _judged(
    drawing: Drawing, ways: Ways, is_station: NDArray[np.bool_], pen: PenOnInk
) -> Iterator[tuple[NDArray[np.int64], Array]]:
    """Some stations, tile by tile: number of the place, and what is over."""
    for part in parts(drawing, ways, is_station, TILE_PX, pen):
        yield part.stations, over_at(part.seen, part.ways, part.at, part.pen, part.room)


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
