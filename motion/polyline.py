"""Polylines: how long they are, how far places are from them, and the same with fewer or more places.

Signals: polylines (n, 2) mm in; lengths, distances and polylines in mm out.

Source: our own; fewer places as by Douglas and Peucker, The Canadian Cartographer 10 (1973).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.compiled import njit
from morfax.motion.long_array import blocks
from morfax.motion.neighbours import Neighbours

UM = 1e-3  # mm
APART_MM = 0.02  # between places that stand for a line, or at which it is looked
STEPS_AT_A_TIME = (
    50_000  # of a line: those of the processor's cache; of a long line few are there at a time
)
WITHIN_MM = 0.05 * UM  # distances from a line are true to this
# a way that turns by more at a place is run up to there, and on from there; chosen
STOPS_RAD = math.radians(25.0)


def steps_mm(line_mm: Array) -> Array:
    """Lengths of the straight pieces of a polyline, (n - 1,) mm."""
    lengths = np.empty(max(0, len(line_mm) - 1))
    for first in range(0, len(lengths), STEPS_AT_A_TIME):
        some = line_mm[first : first + STEPS_AT_A_TIME + 1]
        steps = some[1:] - some[:-1]  # np.diff takes twice the time of a short line
        np.hypot(steps[:, 0], steps[:, 1], out=lengths[first : first + len(steps)])
    return lengths


def lengths_mm(line_mm: Array) -> Array:
    """Length of a polyline up to each of its places, (n,) mm."""
    lengths = np.zeros(max(1, len(line_mm)))
    _add_up(np.ascontiguousarray(line_mm, float), lengths)
    return lengths


@njit(cache=True)
def _add_up(line_mm, lengths):  # type: ignore[no-untyped-def]
    """Fill in the length up to each place, from that up to the first one on."""
    for k in range(1, len(line_mm)):
        dx = line_mm[k, 0] - line_mm[k - 1, 0]
        dy = line_mm[k, 1] - line_mm[k - 1, 1]
        lengths[k] = lengths[k - 1] + math.hypot(dx, dy)


@njit(cache=True, _nrt=False)
def come_to(place_mm, line_mm, length_mm):  # type: ignore[no-untyped-def]
    """The first place of a line so far from a place before it, along the line; their count if none is."""
    x, y = place_mm[0], place_mm[1]
    come_mm = 0.0
    for k in range(len(line_mm)):
        come_mm += math.hypot(line_mm[k, 0] - x, line_mm[k, 1] - y)
        if come_mm >= length_mm:
            return k
        x, y = line_mm[k, 0], line_mm[k, 1]
    return len(line_mm)


def lengths_by_blocks(line_mm: Array) -> Iterator[tuple[int, Array, Array]]:
    """The number of a block's first place, its places, and the length up to each, mm; one block of a line
    that is in memory. Each block begins with the last place of the one before.
    """
    first, come_mm = 0, 0.0
    for places in blocks(line_mm, before=1):
        lengths = np.full(max(1, len(places)), come_mm)
        _add_up(np.ascontiguousarray(places, float), lengths)
        yield first, places, lengths
        first += len(places) - 1
        come_mm = float(lengths[-1])


def length_mm(line_mm: Array) -> float:
    """Length of a polyline, mm."""
    return float(steps_mm(line_mm).sum())


def area_mm2(line_mm: Array) -> float:
    """Area inside a line taken for closed, mm²: positive if it goes round counter-clockwise."""
    x, y = (line_mm - line_mm[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def broad_mm(line_mm: Array) -> float:
    """How broad a long area within a polyline taken for closed is, in the mean, mm."""
    return 2 * abs(area_mm2(line_mm)) / max(length_mm(line_mm), NOT_ZERO)


def closed_up(line_mm: Array) -> Array:
    """A polyline with its first place once more at its end."""
    return np.vstack([line_mm, line_mm[:1]])


def between_corners(way: Array) -> list[Array]:
    """The stretches of a way (n, 2) mm between its sharp corners."""
    steps = np.diff(way, axis=0)
    headings = np.arctan2(steps[:, 1], steps[:, 0])
    turned = np.abs(np.remainder(np.diff(headings) + math.pi, math.tau) - math.pi)
    sharp = 1 + np.flatnonzero(turned > STOPS_RAD)
    ends = [0, *sharp.tolist(), len(way) - 1]
    return [way[begin : end + 1] for begin, end in pairwise(ends)]


def nearest_mm(places_mm: Array, others_mm: Array) -> Array:
    """Distance of each place (n, 2) from the nearest of others (m, 2), mm; infinite where there is none."""
    return Neighbours(others_mm).nearest(places_mm)[0]


def plain(line_mm: Array, within_mm: float) -> Array:
    """A polyline with the fewest of its places from which no place left out is further than this."""
    return line_mm[_kept(np.ascontiguousarray(line_mm, float), within_mm)]


def turned_rad(line_mm: Array, *, is_closed: bool = False) -> float:
    """By how much a polygon (n, 2), closed up if it is closed, turns to either side in all, rad."""
    steps = np.diff(line_mm, axis=0)
    headings = np.arctan2(steps[:, 1], steps[:, 0])
    turns = np.diff(headings, append=headings[:is_closed])
    return float(np.abs(turns - math.tau * np.round(turns / math.tau)).sum())


def at_places(line_mm: Array, at: Array) -> Array:
    """Where a polyline is at places between its own, numbered with shares, (n, 2) mm; before its first place
    and beyond its last it is at these.
    """
    at = np.clip(at, 0, len(line_mm) - 1)
    before = at.astype(np.int64)
    after = np.minimum(before + 1, len(line_mm) - 1)
    share = (at - before)[:, None]
    return np.asarray((line_mm[after] - line_mm[before]) * share + line_mm[before])


def begun_at(line_mm: Array, at: float) -> Array:
    """A closed polyline from one of its places on, numbered with shares, and round to it again, (n, 2) mm."""
    at = at or len(line_mm) - 1
    place = at_places(line_mm, np.array([at]))
    return np.vstack([place, line_mm[math.floor(at) + 1 :], line_mm[1 : math.ceil(at)], place])


def at_lengths(line_mm: Array, at_mm: Array) -> Array:
    """Where a polyline is at some lengths from its start, (n, 2) mm; raises ValueError if it has no place."""
    if not len(line_mm):
        raise ValueError("a polyline without places is nowhere; it must have one at least")
    return _placed(line_mm, lengths_mm(line_mm), at_mm)


def _placed(line_mm: Array, lengths: Array, at_mm: Array) -> Array:
    """The same with the length up to each of its places."""
    places = np.empty((len(at_mm), 2))
    line_mm, at_mm = np.ascontiguousarray(line_mm, float), np.ascontiguousarray(at_mm, float)
    _at_lengths(line_mm, lengths, at_mm, places)
    return places


@njit(cache=True, _nrt=False)
def _at_lengths(line_mm, lengths, at_mm, places):  # type: ignore[no-untyped-def]
    """Fill in the places as `np.interp` would, to the last bit, and walk along the line as the lengths do."""
    last, i = len(lengths) - 1, 0
    for k in range(len(at_mm)):
        at = min(max(at_mm[k], lengths[0]), lengths[last])
        # the last of the places that are no further on: a head that stands has several at one length
        if at < lengths[i]:
            i = 0
        while i < last and lengths[i + 1] <= at:
            i += 1
        for column in range(2):
            places[k, column] = line_mm[i, column]
            if at > lengths[i]:
                step = line_mm[i + 1, column] - line_mm[i, column]
                slope = step / (lengths[i + 1] - lengths[i])
                places[k, column] += slope * (at - lengths[i])


def evenly(line_mm: Array, apart_mm: float) -> Array:
    """Places of a polyline from its start on, this far from each to the next along it, (n, 2) mm."""
    lengths = lengths_mm(line_mm)
    return _placed(line_mm, lengths, np.arange(0.0, lengths[-1], apart_mm))


def with_places(line_mm: Array, apart_mm: float) -> Array:
    """A polyline with more places on it, none further apart than this."""
    s = lengths_mm(line_mm)
    keep = np.r_[True, np.diff(s) > 0]
    s, line_mm = s[keep], line_mm[keep]
    counts = np.maximum(1, np.ceil(np.diff(s) / apart_mm)).astype(int)
    firsts = np.r_[0, np.cumsum(counts)]
    at = np.interp(np.arange(firsts[-1] + 1), firsts, s)
    return np.column_stack([np.interp(at, s, column) for column in line_mm.T])


class Nearest:
    """Finds how far places are from lines, true to `WITHIN_MM` for places a radius away."""

    def __init__(self, lines_mm: Sequence[Array], radius_mm: float) -> None:
        # half for the places left out, and half for the sagitta between those that stand for the line
        share_mm = 0.5 * WITHIN_MM
        apart_mm = math.sqrt(8 * radius_mm * share_mm)
        self._lines = np.vstack(
            [with_places(plain(line, share_mm), apart_mm) for line in lines_mm]
        )
        self._neighbours = Neighbours(self._lines)

    def distances_mm(self, places_mm: Array) -> Array:
        """Distance of each place (n, 2) from the nearest line, mm."""
        return self._neighbours.nearest(places_mm)[0]

    def set_back(self, places_mm: Array, distance_mm: float) -> Array:
        """The places (n, 2), those nearer than a distance moved out to it, straight away from the line."""
        away, index = self._neighbours.nearest(places_mm)
        lines = self._lines[index]
        out = np.maximum(1.0, distance_mm / np.maximum(away, UM))
        return np.asarray(lines + (places_mm - lines) * out[:, None])


@njit(cache=True)
def _kept(points, tolerance):  # type: ignore[no-untyped-def]
    """Which points of a polyline to keep so that none is further than this from the straight pieces."""
    kept = np.zeros(len(points), np.bool_)
    kept[0] = kept[-1] = True
    stack = np.empty((len(points) + 1, 2), np.int64)
    stack[0, 0], stack[0, 1] = 0, len(points) - 1
    count = 1
    while count > 0:
        count -= 1
        first = stack[count, 0]
        last = stack[count, 1]
        wx = points[last, 0] - points[first, 0]
        wy = points[last, 1] - points[first, 1]
        length2 = wx * wx + wy * wy
        worst, at = 0.0, -1
        for k in range(first + 1, last):
            dx = points[k, 0] - points[first, 0]
            dy = points[k, 1] - points[first, 1]
            share = min(max((dx * wx + dy * wy) / length2, 0.0), 1.0) if length2 > 0 else 0.0
            off = (dx - share * wx) ** 2 + (dy - share * wy) ** 2
            if off > worst:
                worst, at = off, k
        if worst > tolerance * tolerance:
            kept[at] = True
            stack[count, 0], stack[count, 1] = first, at
            stack[count + 1, 0], stack[count + 1, 1] = at, last
            count += 2
    return kept
