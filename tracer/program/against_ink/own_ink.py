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

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from hashlib import sha1
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.median import median, percentile
from morfax.motion.polyline import evenly
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.pen_on_ink import PenOnInk, Room, Ways, over_at
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


class _Tiles(NamedTuple):
    """In which tile of a side each place of the ways is, the places in the order of these, the tiles in that
    order, and tiles in a row.
    """

    side_px: int
    of_place: NDArray[np.int32]
    order: NDArray[np.int64]
    in_order: NDArray[np.int32]
    across: int

    @classmethod
    def of(cls, ways: Ways, side_px: int) -> _Tiles:
        """The tiles of some ways; the last of each row is empty."""
        column, row = np.maximum(ways.places_px.T / side_px, 0).astype(np.int32)
        across = 2 + int(column.max())
        of_place = row * across + column
        order = np.argsort(of_place, kind="stable")
        return cls(side_px, of_place, order, of_place[order], across)

    def about(self, row: int, column: int) -> NDArray[np.int64]:
        """The numbers of the places in a tile and in the eight about it."""
        firsts = (np.arange(row - 1, row + 2) * self.across + column - 1)[:, None]
        edges = (firsts + np.array([0, 3])).astype(np.int32)  # else all would be copied
        ends = np.searchsorted(self.in_order, edges)
        return np.sort(np.concatenate([self.order[a:b] for a, b in ends.tolist()]))


ByTile = dict[bytes, NDArray[Any]]  # what was told of tiles, by all that lies in them


@dataclass(frozen=True, eq=False)
class OwnInk:
    """Some lines of a drawing, which are held against their ink once, for all limits; and what was told of
    tiles of the sheet by all that lies in them.
    """

    drawing: Drawing
    lines: Sequence[Line]
    told: ByTile = field(default_factory=dict)

    def mended(self, lines: Sequence[Line]) -> OwnInk:
        """The lines with some of them mended: tiles in which they are as they were are told of at once."""
        return replace(self, lines=lines)

    def beside(self, limits: OverLimits) -> Iterator[BesideInk]:
        """Where lines that closed or ended run beside their ink, by more than some limits; nothing where no
        pen can be told.
        """
        for half_px, station, over in self.judged:
            usual = percentile(over, MOST)
            least, sure = (
                max(float(each.of(half_px)), each.of_most * usual) for each in (limits, SURE)
            )
            for first, last in stretches_of(over > least):
                worst = first + int(np.argmax(over[first:last]))
                places = 1 + station[last - 1] - station[first]
                place_mm = place_of_mm(self.drawing, self.ways.places_px[station[worst]])
                long_mm = float(places * PLACES_PX * self.drawing.pitch_mm)
                yield BesideInk(place_mm, long_mm, bool(over[worst] > sure))

    @cached_property
    def doubtful(self) -> NDArray[np.bool_]:
        """Which lines, of those that closed or ended, are not surely on their ink."""
        noise = self.drawing.noise
        is_told = bool(self.lines) and noise.softness_px > 0 and not self.drawing.grainy
        if not is_told or not self.ways.judged.any():
            return np.zeros(len(self.lines), bool)
        return _doubtful(self.drawing, self.ways, self.told)

    @cached_property
    def ways(self) -> Ways:
        """The ways of the lines."""
        return _ways(self.drawing, self.lines)

    @cached_property
    def judged(self) -> list[tuple[Array, NDArray[np.int64], Array]]:
        """Of each line that is not surely on its ink half its width in pixels, the stations in the order of
        the way, and what is over there.
        """
        if not self.doubtful.any():
            return []
        ways, doubtful = self.ways, self.doubtful
        found = zip(*_judged(self.drawing, ways, doubtful, self.told), strict=True)
        line, station, over = (np.concatenate(column) for column in found)
        of_line = (np.flatnonzero(line == number) for number in np.flatnonzero(doubtful))
        ordered = [own[np.argsort(station[own], kind="stable")] for own in of_line]
        return [(ways.half_px[line[own[0]]], station[own], over[own]) for own in ordered]


def _ways(drawing: Drawing, lines: Sequence[Line]) -> Ways:
    """The ways of lines in pixels of the sheet."""
    pitch_mm, rows = drawing.pitch_mm, drawing.darkness.shape[0]
    ways = [evenly(line.places_mm, PLACES_PX * pitch_mm) for line in lines]
    places = [np.column_stack([way[:, 0], rows * pitch_mm - way[:, 1]]) for way in ways]
    return Ways(
        np.vstack([(some / pitch_mm - 0.5).astype(np.float32) for some in places]),
        np.repeat(np.arange(len(ways), dtype=np.int32), [len(way) for way in ways]),
        np.array([0.5 * line.width_mm / pitch_mm for line in lines]),
        np.array([line.ending in JUDGED and not line.on_edge for line in lines]),
    )


def _doubtful(drawing: Drawing, ways: Ways, told: ByTile) -> NDArray[np.bool_]:
    """Which lines are not surely on their ink: most are, and need not be judged."""
    doubtful = np.zeros(len(ways.judged), bool)
    least, pen = NEARLY.of(ways.half_px), pen_of(drawing, ways)
    for part in parts(drawing, ways, _are_stations(ways, ways.judged), QUICK_PX, pen):
        asked = ~doubtful[ways.line[part.stations]]
        line, at = ways.line[part.stations[asked]], part.at[asked]
        key = part.key(at, least[line])
        if key not in told:
            told[key] = np.empty(len(line), bool)
            may_be_over(part.seen, part.ways, at, least[line], part.pen, part.room, told[key])
        doubtful[line[told[key]]] = True
    return doubtful


def _judged(
    drawing: Drawing, ways: Ways, which: NDArray[np.bool_], told: ByTile
) -> Iterator[tuple[NDArray[np.int32], NDArray[np.int64], Array]]:
    """The stations of some lines, tile by tile: line, number of the place, and what is over."""
    pen = pen_of(drawing, ways)
    for part in parts(drawing, ways, _are_stations(ways, which), TILE_PX, pen):
        key = part.key(part.at)
        if key not in told:
            told[key] = over_at(part.seen, part.ways, part.at, part.pen, part.room)
        yield ways.line[part.stations], part.stations, told[key]


class Part(NamedTuple):
    """A tile of the sheet with what lies about it: the darkness, the ways as they are seen from its corner,
    the numbers of the stations in the tile and their pixels, the pen, room to work in, and the corner.
    """

    seen: NDArray[np.float32]
    ways: Ways
    stations: NDArray[np.int64]
    at: NDArray[np.int64]
    pen: PenOnInk
    room: Room
    corner: NDArray[np.float32]

    def key(self, *asked: NDArray[Any]) -> bytes:
        """What tells the tile, with all that lies in it, from every other; and what is asked of it."""
        line, ways = self.ways.line, self.ways
        every: list[NDArray[Any]] = [self.corner, ways.places_px, line, *asked]
        every += [ways.half_px[line], ways.judged[line]]
        pen = repr((self.pen, self.seen.shape)).encode()
        return sha1(b"".join([pen, *(each.tobytes() for each in every)])).digest()


def parts(
    drawing: Drawing, ways: Ways, is_station: NDArray[np.bool_], side_px: int, pen: PenOnInk
) -> Iterator[Part]:
    """The tiles of a side in which some of the places that stand for ways are stations."""
    tiles = _Tiles.of(ways, side_px)
    margin = math.ceil(2 * (FAR + 1) * pen.half_px) + 1
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
        at = np.minimum(np.maximum(at, 0), np.array(seen.shape)[::-1] - 1)
        yield Part(seen, ways.seen_from(corner, near), stations, at, pen, room, corner)


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


def pen_of(drawing: Drawing, ways: Ways) -> PenOnInk:
    """The pen of most lines; what it draws on paper matters above the least limit."""
    half_px, noise = median(ways.half_px[ways.judged]), drawing.noise
    reach_px, paper = 2 * FAR * half_px, 0.5 * noise.paper**2
    return PenOnInk(half_px, noise.softness_px, reach_px, paper, OF_WIDTH, NEARLY.over)


def _every(ways: Ways) -> int:
    """One place of the ways in so many is a station."""
    return max(1, round(2 * STATION_WIDTHS * float(np.min(ways.half_px)) / PLACES_PX))


def stretches_of(above: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """The first and the one after the last of each stretch of stations that are above the limit."""
    edges = np.flatnonzero(np.diff(np.r_[False, above, False].astype(np.int8)))
    return [(int(first), int(last)) for first, last in edges.reshape(-1, 2)]


def place_of_mm(drawing: Drawing, place_px: NDArray[np.float32]) -> tuple[float, float]:
    """A place in pixels, on the sheet in mm."""
    column, row = place_px.tolist()
    rows = drawing.darkness.shape[0]
    return (column + 0.5) * drawing.pitch_mm, (rows - row - 0.5) * drawing.pitch_mm
