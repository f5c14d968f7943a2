"""Hollow lines: stretches of a path where the ink is paler in its middle than on both sides.

    pieces    3 mm each or 24 pixels, all along the path
    profile   darkness across the path, the mean of a piece; its darkest place on each side, and the palest
              between these

        darkness │   ╱‾╲_╱‾╲        two lines that the scan hardly parts: the path runs between them
                 │__╱       ╲__

Grain, a speck or a scratch differs from station to station, so a piece is hollow only where the stations' own
spread makes its paler middle certain.

Signals: a drawing and a path, sheet mm, in; how much of the path is hollow, where the longest stretch of that
is, and how far the two dark rows are apart there, mm, out.

Source: our own. Questions: some pens (worn ball pens, markers) leave the middle of a line paler; there the
path is right. Two lines of which the scan shows one flat top are not told from one line.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from morfax.motion.long_array import one_in
from morfax.motion.polyline import lengths_mm
from morfax.tracer.drawing.deviation import darkness_across

if TYPE_CHECKING:
    from morfax.motion.arrays import Array
    from morfax.tracer.drawing.drawing import Drawing

PIECE_MM, PIECE_PX = 3.0, 24.0
THINNED = 30  # one position in 30 shows where a path runs: every 50 um at 10 mm/s
FEWEST_PIECES = 2  # in a row: one alone is where a line crosses, or a wall's end
APART_PX = 2.0  # stations: pixels so far apart have noise of their own
OFFSETS = np.arange(-8, 9) / 16  # of the line's width, to the left
BESIDE = 2 / 16  # of the width: the dark rows are further from the path
PALER = 0.06  # of the ink's darkness; the middle of a line of one pen is paler by 0.02 at most
CERTAIN = 4.0  # standard deviations of a piece's mean


class Hollow(NamedTuple):
    """How much of a path is hollow, mm; the middle of its longest hollow stretch, and how far the dark rows
    are apart there, mm.
    """

    length_mm: float
    place_mm: tuple[float, float]
    apart_mm: float


def hollow(drawing: Drawing, path_mm: Array, width_mm: float) -> Hollow | None:
    """The hollow stretches of a path (n, 2) mm along ink of a width; None if there are none."""
    places = one_in(path_mm, THINNED)
    come_mm = lengths_mm(places)
    piece_mm = max(PIECE_MM, PIECE_PX * drawing.pitch_mm)
    count = int(piece_mm / (APART_PX * drawing.pitch_mm))
    shares = (np.arange(count) + 0.5) / count
    apart_mm = width_mm * np.array(
        [
            _apart(drawing, _stations(places, come_mm, piece_mm * (k + shares)), width_mm)
            for k in range(int(come_mm[-1] / piece_mm))
        ]
    )
    ends = np.flatnonzero(np.diff(np.r_[False, np.isfinite(apart_mm), False].astype(np.int8)))
    rows = [(a, b) for a, b in ends.reshape(-1, 2).tolist() if b - a >= FEWEST_PIECES]
    if not rows:
        return None
    first, last = max(rows, key=lambda row: row[1] - row[0])
    middle = int(np.searchsorted(come_mm, 0.5 * (first + last) * piece_mm))
    place_mm = float(places[middle, 0]), float(places[middle, 1])
    length_mm = piece_mm * sum(b - a for a, b in rows)
    return Hollow(length_mm, place_mm, float(np.median(apart_mm[first:last])))


def _stations(places: Array, come_mm: Array, at_mm: Array) -> tuple[Array, Array]:
    """Where a way is at some lengths from its start, (n, 2) mm, and its headings there."""
    there = np.column_stack([np.interp(at_mm, come_mm, column) for column in places.T])
    way = np.gradient(there, axis=0)
    return there, np.arctan2(way[:, 1], way[:, 0])


def _apart(drawing: Drawing, stations: tuple[Array, Array], width_mm: float) -> float:
    """How far the dark rows of a piece are apart, widths; NaN where it is not hollow."""
    seen = darkness_across(drawing, *stations, width_mm * OFFSETS)
    mean = seen.mean(axis=0)
    right, left = (
        int(np.argmax(np.where(side * OFFSETS > BESIDE, mean, -1.0))) for side in (-1, 1)
    )
    middle = right + int(np.argmin(mean[right : left + 1]))
    paler = np.minimum(seen[:, right], seen[:, left]) - seen[:, middle]
    certain = CERTAIN * float(paler.std()) / math.sqrt(len(paler))
    if paler.mean() < max(PALER * float(mean.max()), certain):
        return math.nan
    return float(OFFSETS[left] - OFFSETS[right])
