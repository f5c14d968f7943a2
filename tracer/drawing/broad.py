"""Broad lines: stretches of a path whose ink is twice as wide as the sheet's pen draws.

    pieces    3 mm each or 24 pixels, all along the path
    width     of a piece's ink: its darkness added up across the path. Neither the lens nor the paper between
              two lines changes that, so two lines have twice the width of one, however near they are.

        width │ ______                        two lines nearer to each other than the scan can part
              │       ╲______________         the pen's own width, elsewhere on the sheet

Signals: the darkness of a sheet and a path, sheet mm, in, and the widths that the sheet's ink shows; out the
pen's width, and how much of the path is as wide as two of its lines, where the longest stretch of that is,
and how wide it is there, mm.

Source: our own. Questions: a pen twice as broad leaves such ink, too, and the scan shows no difference.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.median import median
from morfax.motion.plane import heading_of
from morfax.motion.polyline import at_lengths
from morfax.tracer.drawing.hollow import FEWEST_PIECES, Seen, rows_of
from morfax.tracer.effort import FINE_WIDTHS, SOME_PLACES
from morfax.tracer.limits import PAPER, WIDER

# All limits below were chosen by trial on pairs of lines, and on line art.
ACROSS = np.arange(-1.5, 1.5 + FINE_WIDTHS, FINE_WIDTHS)  # of the line's width, to the left
INK = 0.5  # of the darkest: a place on the path that is paler is not on its ink
TWO = (1.8, 2.15)  # widths of the pen
# of the ink: a path with so much more on one side than on the other does not run between two lines, of which
# the one that it follows leaves 0.45 more on the other's side
ASIDE = 0.25
SHORT_WIDTHS = 30.0  # widths of the pen: a shorter stretch alone does not tell its width
LEAST_SHARE = 0.15  # of the ink is the pen's
ABOUT_WIDTHS = 2.0  # of its middle places so near to each tell its heading


class Broad(NamedTuple):
    """How much of a path is as wide as two lines, mm; the middle of its longest such stretch, and how wide
    the ink is there, mm.
    """

    length_mm: float
    place_mm: tuple[float, float]
    width_mm: float


def widths_along(seen: Seen, places: Array, width_mm: float, pitch_mm: float) -> Array:
    """The width of the ink along each piece of a path through places (n, 2) mm, along ink of about a width,
    mm; NaN where it has no edges, as where another line crosses. Gaps in the ink do not count.
    """
    rows = rows_of(seen, places, width_mm * ACROSS, pitch_mm)
    profiles = [_on_ink(dark) for dark in rows]
    return width_mm * inks(np.vstack(profiles)) if profiles else np.empty(0)


def _on_ink(dark: Array) -> Array:
    """The profile of each piece (pieces, rows), by its stations with ink (pieces, stations, rows)."""
    darkest = dark.max(axis=2)
    inked = (darkest > INK * darkest.max(axis=1, keepdims=True))[:, :, None]
    return np.asarray((dark * inked).sum(axis=1) / np.maximum(inked.sum(axis=1), 1))


def width_of(seen: Seen, middles: Array, width_mm: float) -> float:
    """The usual width of a line that was not followed, by places (n, 2) mm near its middle, or NaN."""
    some = middles[:: max(1, len(middles) // SOME_PLACES)]
    headings = np.empty(len(some))
    for k, place in enumerate(some):
        near = middles[np.hypot(*(middles - place).T) < ABOUT_WIDTHS * width_mm]
        along = np.linalg.svd(near - near.mean(axis=0), full_matrices=False)[2][0]
        headings[k] = heading_of(along)
    widths = width_mm * inks(seen(some, headings, width_mm * ACROSS))
    known = widths[np.isfinite(widths)]
    return median(known) if len(known) else math.nan


def inks(profiles: Array) -> Array:
    """The ink of profiles in rows `ACROSS` a path, widths; NaN if it does not end, or the path is off it, or
    within one side of it.
    """
    middle = len(ACROSS) // 2
    left, right = _beside(profiles[:, middle:]), _beside(profiles[:, middle::-1])
    inked = left + right - profiles[:, middle]
    return FINE_WIDTHS * np.where(np.abs(left - right) < ASIDE * inked, inked, np.nan)


def _beside(outward: Array) -> Array:
    """The darkness of each profile added up from the path outward, to where its ink ends."""
    darkest = outward.max(axis=1, keepdims=True)
    is_paper = outward < PAPER * darkest
    is_own = np.cumsum(is_paper, axis=1) == 0
    on_ink = outward[:, 0] > INK * darkest[:, 0]
    total = np.where(is_own, outward, 0.0).sum(axis=1)
    return np.where(is_paper.any(axis=1) & on_ink, total, np.nan)


def pen_of(widths_mm: Array, lengths_mm: Array) -> float:
    """The narrowest width that a good share of a sheet's ink has, mm; NaN if there is none, as of a brush."""
    order = np.argsort(widths_mm)
    widths, lengths = widths_mm[order], lengths_mm[order]
    sums = np.r_[0.0, np.cumsum(lengths)]
    last = np.searchsorted(widths, WIDER * widths, "right")
    shares = (sums[last] - sums[:-1]) / max(sums[-1], NOT_ZERO)
    enough = np.flatnonzero(shares >= LEAST_SHARE)
    if not len(enough):
        return math.nan
    first = int(enough[0])
    return float(np.average(widths[first : last[first]], weights=lengths[first : last[first]]))


def broad(places: Array, widths_mm: Array, piece_mm: float, pen_mm: float) -> Broad | None:
    """The stretches of a path that are as wide as two lines of a pen, by the widths of its pieces; None if
    there are none, or the pen is not known.
    """
    if not pen_mm > 0:
        return None
    shares = widths_mm / pen_mm
    is_broad = (shares > TWO[0]) & (shares < TWO[1])
    ends = np.flatnonzero(np.diff(np.r_[False, is_broad, False].astype(np.int8)))
    least = max(FEWEST_PIECES, math.ceil(SHORT_WIDTHS * pen_mm / piece_mm))
    rows = [(a, b) for a, b in ends.reshape(-1, 2).tolist() if b - a >= least]
    if not rows:
        return None
    first, last = max(rows, key=lambda row: row[1] - row[0])
    x, y = at_lengths(places, np.array([0.5 * (first + last) * piece_mm]))[0].tolist()
    broad_mm = piece_mm * sum(b - a for a, b in rows)
    return Broad(broad_mm, (x, y), median(widths_mm[first:last]))
