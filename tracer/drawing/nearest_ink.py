"""Nearest ink: the run of ink that is nearest to a place, among those of some patches.

    row − 1   ━━━━      ━━━          of each row the next run to either side counts;
    row       ━━    ●       ━━━      rows are looked through from the place outwards,
    row + 1        ━━━━━━            as far as one may still be nearer

Signals: runs of ink by rows, the patch of each (see `components`), and a place, mm, in; the nearest pixel,
its distance, mm, and its run out.

Source: our own.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.compiled import njit


@njit(cache=True, _nrt=False)
def nearest_run(runs, firsts, place_mm, sheet, among):  # type: ignore[no-untyped-def]
    """Distance, mm, of the pixel of some runs that is nearest to a place, its centre (x, y) mm, and the run's
    number; the first run, infinitely far, if none is `among` the patches that count.

    `runs`: begin, end and patch of each, and the `firsts` of each row; `sheet`: how many rows it has, and the
    pixels' pitch, mm.
    """
    (begin, end, patch), (x_mm, y_mm), (rows, pitch_mm) = runs, place_mm, sheet
    column, last = round(x_mm / pitch_mm - 0.5), len(firsts) - 2
    middle = min(max(rows - 1 - math.floor(y_mm / pitch_mm), 0), last)
    best, least_mm, x, y = 0, np.inf, np.nan, np.nan
    for off in range(last + 1):
        is_near = False
        for row in (middle - off, middle + off):
            own_y = (rows - row - 0.5) * pitch_mm
            if row < 0 or row > last or abs(own_y - y_mm) > least_mm:
                continue
            is_near = True
            # the next run to either side that counts
            ahead = _first_beyond(end, firsts[row], firsts[row + 1], column)
            for begins_at, step in ((ahead, 1), (ahead - 1, -1)):
                k = begins_at
                while firsts[row] <= k < firsts[row + 1] and not among[patch[k]]:
                    k += step
                if firsts[row] <= k < firsts[row + 1]:
                    own_x = (min(max(column, begin[k]), end[k] - 1) + 0.5) * pitch_mm
                    away_mm = math.hypot(own_x - x_mm, own_y - y_mm)
                    if away_mm < least_mm or (away_mm == least_mm and k < best):
                        best, least_mm, x, y = k, away_mm, own_x, own_y
        if not is_near:
            break
    return least_mm, x, y, best


@njit(cache=True)
def _first_beyond(end, first, last, column):  # type: ignore[no-untyped-def]
    """The number of the first run, of some of one row, that ends beyond a column; the one after the last of
    them if none does.
    """
    while first < last:
        middle = (first + last) // 2
        if end[middle] > column:
            last = middle
        else:
            first = middle + 1
    return first
