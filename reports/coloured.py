"""The error along a contour in colours, drawn as few long lines.

Signals in: points along a contour, mm, the error at each, mm, and the part of the sheet that is shown. Out:
lines for a plate, and its scale of colours.

    points closer than half a dot of the picture are one, with the largest error among them
    64 colours; all pieces of one colour are one line with gaps, the largest errors on top

A line is drawn a hundred times as fast as as many pieces of which each has a colour of its own.

Source: our own. Questions: none.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.reports.canvas import DPI, SMALLEST_UM, UM_PER_MM, WIDTH_IN
from morfax.reports.looks import ON_PATHS
from morfax.reports.plate import Colours, Polyline, View, shades

COLOURS = ("#1f5fa8", "#5fa8d3", "#f2a65a", "#c1121f")  # no error … largest error
SHADES = 64  # from no error to the largest: neighbours look alike
BESIDE = 0.1  # of a view: points this far outside of it still belong to what is seen


def error_lines(
    points_mm: Array, error_mm: Array, view: View, line_pt: float
) -> tuple[list[Polyline], Colours]:
    """The error along the points as lines, where it is a number; and what their colours mean."""
    error_um = np.abs(error_mm) * UM_PER_MM
    most_um = max(float(np.nanmax(error_um)), SMALLEST_UM)
    # a wider step is a way with the tool up
    way_mm = np.hypot(*np.diff(points_mm, axis=0).T)
    joined = way_mm <= 10 * np.median(way_mm) + 0.05
    starts = _seen(points_mm, np.r_[way_mm, 0.0], view)
    largest = np.fmax.reduceat(error_um, starts)
    larger = np.fmax(largest[:-1], largest[1:])
    whole = np.logical_and.reduceat(joined, starts[:-1]) if len(starts) > 1 else joined[:0]
    ends = np.stack([points_mm[starts[:-1]], points_mm[starts[1:]]], axis=1)
    shown = whole & np.isfinite(larger) & _within(ends, view)
    numbers = np.minimum(larger[shown] * (SHADES / most_um), SHADES - 1).astype(int)
    there, lines = _lines(ends[shown], numbers, np.flatnonzero(shown))
    colours = [f"#{shade:06x}" for shade in shades(COLOURS, SHADES)]
    drawn = [
        Polyline(places, colours[shade], line_pt, order=ON_PATHS)
        for shade, places in zip(there, lines, strict=True)
    ]
    return drawn, Colours(COLOURS, most_um, "error, µm")


def _seen(points: Array, way: Array, view: View) -> NDArray[np.int64]:
    """The first of each group of points that look like one in a view."""
    half_dot = max(view[1] - view[0], view[3] - view[2]) / (2 * DPI * WIDTH_IN)
    inside = _within(np.stack([points, points], axis=1), view)
    # outside of the view one point in a thousand is enough
    fine = np.where(inside, way / half_dot, way / half_dot / 1000)
    groups = np.floor(np.cumsum(fine) - fine)
    return np.flatnonzero(np.r_[True, np.diff(groups) > 0] | _edges(inside))


def _edges(inside: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Where a run inside begins or has just ended."""
    changes = np.diff(inside, prepend=inside[:1])
    return np.asarray(changes)


def _within(ends: Array, view: View) -> NDArray[np.bool_]:
    """Which pieces (n, 2 ends, 2) have an end in a view, or beside it."""
    x = ends[..., 0]
    y = ends[..., 1]
    beside = BESIDE * max(view[1] - view[0], view[3] - view[2])
    inside = (x > view[0] - beside) & (x < view[1] + beside)
    inside &= (y > view[2] - beside) & (y < view[3] + beside)
    return np.asarray(inside.any(axis=1))


def _lines(
    pieces: Array, shades: NDArray[np.int64], numbers: NDArray[np.int64]
) -> tuple[NDArray[np.int64], list[Array]]:
    """The shades that there are, the largest last, and a line with gaps for each; pieces by their number."""
    order = np.argsort(shades, kind="stable")
    pieces = pieces[order]
    shades = shades[order]
    numbers = numbers[order]
    goes_on = np.zeros(len(pieces), bool)
    goes_on[1:] = (np.diff(numbers) == 1) & (np.diff(shades) == 0)
    # a gap, the begin of a piece, its end; a piece that goes on from the one before needs its end only
    gap = np.full((len(pieces), 1, 2), np.nan)
    places = np.concatenate([gap, pieces], axis=1)
    kept = np.column_stack([~goes_on, ~goes_on, np.ones_like(goes_on)])
    counts = kept.sum(axis=1).cumsum()
    there, firsts = np.unique(shades, return_index=True)
    cuts = counts[firsts[1:] - 1]
    return there, [line[1:] for line in np.split(places[kept], cuts)]
