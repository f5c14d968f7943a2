"""The normal equations of an arc spline (see `spline`): their band, and their solution.

Signals: segments, each by its ends (mm) and half the angle that it turns (rad), places with the segments that
they belong to, and the breaks of the tangent in; the matrix, the right side and the solution out.

Unknowns that one residual couples stand near each other, in the order of the path:

    half 0 | x 1  y 1  half 1 | x 2  y 2  half 2 | ...        a break couples two segments: BAND unknowns

so the matrix is a band. The break over the seam of a closed line couples the last with the first: it is kept
aside, and brought in when the equations are solved.

Source: Cholesky's factor of a band is the textbook's; J. Sherman and W. Morrison, 1950, for the seam.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.compiled import njit

BREAK_RAD = 1e-4  # a break that weighs as much as a place at the edge of the tolerance
STEP = 1e-7  # mm and rad, of the slopes by differences
BAND = 8  # unknowns that a residual can couple: two segments have at most eight that are free


@njit(cache=True)
def _row(x0, y0, x1, y1, half):  # type: ignore[no-untyped-def]
    """Begin, cosine and sine of the heading there, and curvature of a segment, as in `rows_of`."""
    chord = math.hypot(x1 - x0, y1 - y0)
    heading = math.atan2(y1 - y0, x1 - x0) - half
    length = chord if half == 0.0 else chord * half / math.sin(half)
    return x0, y0, math.cos(heading), math.sin(heading), 2 * half / length


@njit(cache=True)
def _off(row, x, y):  # type: ignore[no-untyped-def]
    """Distance of a place from the circle or line of a row, positive to the left."""
    dx = x - row[0]
    dy = y - row[1]
    square = 2 * (dy * row[2] - dx * row[3]) - row[4] * (dx * dx + dy * dy)
    return square / (1 + math.sqrt(max(1 - row[4] * square, 0.0)))


@njit(cache=True)
def offs(table, places, owner):  # type: ignore[no-untyped-def]
    """Distance of each place from its own segment; the segments' places follow one another."""
    off, last = np.empty(len(places)), -1
    row = (0.0, 0.0, 0.0, 0.0, 0.0)
    for i in range(len(places)):
        if owner[i] != last:
            last = owner[i]
            row = _row(
                table[last, 0], table[last, 1], table[last, 2], table[last, 3], table[last, 4]
            )
        off[i] = _off(row, places[i, 0], places[i, 1])
    return off


@njit(cache=True)
def normal(table, seen, breaks, columns, closed):  # type: ignore[no-untyped-def]
    """The normal equations (see `Spline._linearised`); `seen`: places, their segments, their weights."""
    places, owner, weights = seen
    unknowns = columns.max() + 1
    band = np.zeros((unknowns, BAND))
    pull = np.zeros(unknowns)
    seam = np.zeros(unknowns)
    cost = 0.0
    slope = np.empty(10)
    column = np.empty(10, np.int64)
    # 1. each distance depends on the five numbers of its own segment only
    figures = table.shape[1]
    rows, last = np.empty((figures + 1, figures)), -1
    for i in range(len(places)):
        if owner[i] != last:
            last = owner[i]
            _rows_moved(table[last], rows)
        off = _off(rows[5], places[i, 0], places[i, 1])
        residual = weights[i] * off
        for k in range(figures):
            away = _off(rows[k], places[i, 0], places[i, 1])
            slope[k] = weights[i] * (away - off) / STEP
        cost += residual * residual
        _add(band, pull, slope[:5], columns[last], residual)
    # 2. each break, on those of two segments; one over the seam couples the first and the last
    for j in range(len(breaks)):
        after = (j + 1) % len(table)
        _break_slopes(table[j], 1.0, slope[:5])
        _break_slopes(table[after], -1.0, slope[5:])
        column[:5] = columns[j]
        column[5:] = columns[after]
        cost += breaks[j] * breaks[j]
        if closed and j == len(breaks) - 1:
            for k in range(10):
                if column[k] >= 0:
                    seam[column[k]] += slope[k]
            pull += seam * breaks[j]
        else:
            _add(band, pull, slope, column, breaks[j])
    return cost, band, pull, seam


@njit(cache=True)
def _rows_moved(own, rows):  # type: ignore[no-untyped-def]
    """The row of a segment as it stands, the last of six, and with each of its five numbers moved a step."""
    moved = np.empty_like(own)
    for k in range(len(rows)):
        moved[:] = own
        if k < len(own):
            moved[k] += STEP
        one = _row(moved[0], moved[1], moved[2], moved[3], moved[4])
        for m in range(len(one)):
            rows[k, m] = one[m]


@njit(cache=True)
def _break_slopes(own, sign, slope):  # type: ignore[no-untyped-def]
    """How a break depends on the five numbers of the segment before it (sign 1) or after it (-1): on the
    chord's direction, and on half the angle.
    """
    dx = own[2] - own[0]
    dy = own[3] - own[1]
    square = dx * dx + dy * dy
    slope[0] = -sign * dy / square
    slope[1] = sign * dx / square
    slope[2] = sign * dy / square
    slope[3] = -sign * dx / square
    slope[4] = -1.0
    for k in range(len(own)):
        slope[k] /= BREAK_RAD


@njit(cache=True)
def _add(band, pull, slope, column, residual):  # type: ignore[no-untyped-def]
    """Add one residual to the normal equations."""
    for a in range(len(column)):
        if column[a] < 0:
            continue
        pull[column[a]] += slope[a] * residual
        for b in range(len(column)):
            if 0 <= column[b] <= column[a]:
                band[column[a], column[a] - column[b]] += slope[a] * slope[b]


@njit(cache=True)
def solved(band, seam, pull):  # type: ignore[no-untyped-def]
    """The unknowns: the band's matrix with the seam's squared slopes, against the right side.

    The seam is brought in after J. Sherman and W. Morrison, 1950.
    """
    # 1. Cholesky's factor of the band, in place: by row, the diagonal first
    for i in range(len(band)):
        for k in range(min(i, BAND - 1), -1, -1):
            total = band[i, k]
            for m in range(k + 1, min(i, BAND - 1) + 1):
                if m - k < BAND:
                    total -= band[i, m] * band[i - k, m - k]
            band[i, k] = math.sqrt(total) if k == 0 else total / band[i - k, 0]
    # 2. forward and back, for both right sides
    out, beside = pull.copy(), seam.copy()
    _substitute(band, out)
    _substitute(band, beside)
    return out - beside * ((seam @ out) / (1 + seam @ beside))


@njit(cache=True)
def _substitute(band, x):  # type: ignore[no-untyped-def]
    """Solve for one right side, in its place, by a band's factor."""
    n = len(band)
    for i in range(n):
        for k in range(1, min(i, BAND - 1) + 1):
            x[i] -= band[i, k] * x[i - k]
        x[i] /= band[i, 0]
    for i in range(n - 1, -1, -1):
        for k in range(1, min(n - 1 - i, BAND - 1) + 1):
            x[i] -= band[i + k, k] * x[i + k]
        x[i] /= band[i, 0]
