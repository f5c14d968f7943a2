"""Hollow lines: stretches of a path where the ink is paler in its middle than on both sides.

    pieces    3 mm each or 24 pixels, all along the path
    profile   darkness across the path, the mean of a piece; its darkest place on each side, and the palest
              between these

        darkness │   ╱‾╲_╱‾╲        two lines that the scan hardly parts: the path runs between them
                 │__╱       ╲__

Grain, a speck or a scratch differs from station to station, so a piece is hollow only where the stations' own
spread makes its paler middle certain.

Signals: the darkness of a sheet and a path, sheet mm, in; how much of the path is hollow, where the longest
stretch of that is, and how far the two dark rows are apart there, mm, out.

Source: our own. Questions: some pens (worn ball pens, markers) leave the middle of a line paler; there the
path is right. Two lines of which the scan shows one flat top are not told from one line.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import at_lengths, length_mm
from morfax.tracer.effort import FINE_WIDTHS
from morfax.tracer.limits import PIECE_MM

# darkness (n, k) at places (n, 2) mm, across their headings (n,) rad, at distances (k,) mm to the left
Seen = Callable[[Array, Array, Array], Array]

PIECE_PX = 24.0
AT_ONCE = 256  # pieces that are looked at in one go
FEWEST_PIECES = 2  # in a row: one alone is where a line crosses, or a wall's end
APART_PX = 2.0  # stations: pixels so far apart have noise of their own
OFFSETS = np.arange(-0.5, 0.5 + FINE_WIDTHS, FINE_WIDTHS)  # of the line's width, to the left
BESIDE = 2 * FINE_WIDTHS  # of the width: the dark rows are further from the path
PALER = 0.05  # of the ink's darkness; the middle of a line of one pen is paler by 0.02 at most
CERTAIN = 4.0  # standard deviations of a piece's mean


class Hollow(NamedTuple):
    """How much of a path is hollow, mm; the middle of its longest hollow stretch, and how far the dark rows
    are apart there, mm.
    """

    length_mm: float
    place_mm: tuple[float, float]
    apart_mm: float


def hollow(seen: Seen, places: Array, width_mm: float, pitch_mm: float) -> Hollow | None:
    """The hollow stretches of a path through places (n, 2) mm, along ink of a width on pixels of a pitch, mm;
    None if there are none.
    """
    apart = [np.empty(0)]
    for dark in rows_of(seen, places, width_mm * OFFSETS, pitch_mm):
        apart.append(_apart(dark))
    apart_mm = width_mm * np.concatenate(apart)
    ends = np.flatnonzero(np.diff(np.r_[False, np.isfinite(apart_mm), False].astype(np.int8)))
    rows = [(a, b) for a, b in ends.reshape(-1, 2).tolist() if b - a >= FEWEST_PIECES]
    if not rows:
        return None
    first, last = max(rows, key=lambda row: row[1] - row[0])
    piece_mm = pieces_mm(pitch_mm)
    x, y = at_lengths(places, np.array([0.5 * (first + last) * piece_mm]))[0].tolist()
    hollow_mm = piece_mm * sum(b - a for a, b in rows)
    return Hollow(hollow_mm, (x, y), float(np.median(apart_mm[first:last])))


def pieces_mm(pitch_mm: float) -> float:
    """How long the pieces of a path are."""
    return max(PIECE_MM, PIECE_PX * pitch_mm)


def rows_of(seen: Seen, places: Array, across_mm: Array, pitch_mm: float) -> Iterator[Array]:
    """Darkness (pieces, stations, rows) along the pieces of a path, some at a time, in rows across it."""
    piece_mm = pieces_mm(pitch_mm)
    count = int(piece_mm / (APART_PX * pitch_mm))
    shares = (np.arange(count) + 0.5) / count
    pieces = int(length_mm(places) / piece_mm)
    for first in range(0, pieces, AT_ONCE):
        numbers = np.arange(first, min(first + AT_ONCE, pieces))
        at_mm = piece_mm * (numbers[:, None] + shares).ravel()
        dark = seen(*_stations(places, at_mm), across_mm)
        yield dark.reshape(len(numbers), count, -1)


def _stations(places: Array, at_mm: Array) -> tuple[Array, Array]:
    """Where a way is at some lengths from its start, (n, 2) mm, and its headings there."""
    there = at_lengths(places, at_mm)
    way = np.gradient(there, axis=0)
    return there, np.arctan2(way[:, 1], way[:, 0])


def _apart(dark: Array) -> Array:
    """How far the dark rows of pieces are apart, widths, by their darkness (pieces, stations, rows): NaN
    where a piece is not hollow.
    """
    # 1. the darkest row on each side of the path, and the palest between them
    mean, rows = dark.mean(axis=1), np.arange(dark.shape[2])
    right, left = (
        np.argmax(np.where(side * OFFSETS > BESIDE, mean, -1.0), axis=1)[:, None]
        for side in (-1, 1)
    )
    between = (rows >= right) & (rows <= left)
    middle = np.argmin(np.where(between, mean, np.inf), axis=1)[:, None]
    # 2. how much paler, and whether that is certain
    at_right, at_left, at_middle = (
        np.take_along_axis(dark, row[:, None], axis=2)[:, :, 0] for row in (right, left, middle)
    )
    # at each station the lesser of two is the less by their noise: so the means are compared
    sides = np.minimum(at_right.mean(axis=1), at_left.mean(axis=1))
    spread = (np.minimum(at_right, at_left) - at_middle).std(axis=1)
    certain = CERTAIN * spread / math.sqrt(dark.shape[1])
    paler = sides - at_middle.mean(axis=1)
    is_hollow = paler >= np.maximum(PALER * mean.max(axis=1), certain)
    return np.where(is_hollow, OFFSETS[left[:, 0]] - OFFSETS[right[:, 0]], math.nan)
