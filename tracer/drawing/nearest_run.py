"""The nearest run: which of a sheet's runs of ink has the pixel that is nearest to a place.

Signals: runs by rows (see `components`) and a place, sheet mm, in; the distance, the pixel's centre, mm, and
the run's number out.

Source: our own.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.compiled import njit


@njit(cache=True, _nrt=False)
def nearest_run(runs, place_mm, sheet, among):  # type: ignore[no-untyped-def]
    """Distance, mm, of the pixel of some runs that is nearest to a place, its centre (x, y) mm, and the run's
    number; the first run, infinitely far, if none is `among` the patches that count.

    `runs`: row, begin, end and patch of each; `sheet`: how many rows it has, and the pixels' pitch, mm.
    """
    (row, begin, end, patch), (x_mm, y_mm), (rows, pitch_mm) = runs, place_mm, sheet
    column, best, least_mm = round(x_mm / pitch_mm - 0.5), 0, np.inf
    x, y = np.nan, np.nan
    # from the place's row down, then up, as far as a row may be nearer
    begins = np.searchsorted(row, math.floor(rows - y_mm / pitch_mm))
    for way, first, stop in ((1, begins, len(row)), (-1, begins - 1, -1)):
        for k in range(first, stop, way):
            own_y = (rows - row[k] - 0.5) * pitch_mm
            if abs(own_y - y_mm) > least_mm:
                break
            if not among[patch[k]]:
                continue
            own_x = (min(max(column, begin[k]), end[k] - 1) + 0.5) * pitch_mm
            away_mm = math.hypot(own_x - x_mm, own_y - y_mm)
            if away_mm < least_mm or (away_mm == least_mm and k < best):
                best, least_mm, x, y = k, away_mm, own_x, own_y
    return least_mm, x, y, best
