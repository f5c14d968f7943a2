"""Parabolas: what a leg's kernels fit to stations of a line.

Signals: stations of the line (n, 3: centre x, y and width, mm), in the order of travel, in; place, heading
(rad), bend (1/mm) and width of the line at one of them out.

    y(x) = offset + slope·x + bend/2·x²         x, y: along and across a chord of the stations

Source: our own (see `leg`).
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import NOT_ZERO
from morfax.motion.arrays import median as median_of
from morfax.motion.compiled import njit
from morfax.motion.median import OUTLIERS, ROBUST
from morfax.motion.moments import LEAST_WEIGHT, bend_of
from morfax.motion.plane import heading_between, length_between
from morfax.motion.usual import INCREMENT_MM

BITTEN = 0.06  # of the width: more than a scan's noise
FEWEST = 8  # stations: a parabola through fewer follows their noise
# standard errors: neighbouring stations share their ink, so that a bend has to stand out further than three
BEND_STANDS_OUT = 5.0
BLOT = 0.03  # of the width: a blot at the junction shows by more
# times the misfit of the nearest part: a longer stretch that fits no worse is one leg
MISFIT = 1.3


@njit(cache=True)
def leg_through(seen, last, length_mm):  # type: ignore[no-untyped-def]
    """(x, y, heading, bend, width) of the leg through stations, and the first and the last + 1 of those that
    it has; its clean end is at the `last` of them or the first.

    The leg takes in as long a stretch as one parabola fits about as well as it fits the nearest part.
    """
    begin, stop = _without_blot(seen, last)
    clean = seen[begin:stop]
    end = clean[-1] if last else clean[0]
    best, limit = _leg(clean, end, 0.5 * length_mm)
    for share in (0.75, 1.0):
        longer, misfit = _leg(clean, end, share * length_mm)
        if misfit > MISFIT * limit + INCREMENT_MM:
            break
        best, limit = longer, misfit
    return best, begin, stop


@njit(cache=True)
def _without_blot(seen, last):  # type: ignore[no-untyped-def]
    """The first and the last + 1 of the stations without those next to the junction whose width shows its
    ink: a third at most.
    """
    count = len(seen)
    usual = median_of(seen[:, 2])
    spread = ROBUST * median_of(np.abs(seen[:, 2] - usual))
    within = max(OUTLIERS * spread, BLOT * usual)
    most = count // 3
    spoilt = most
    for k in range(most + 1):
        station = count - 1 - k if last else k
        if abs(seen[station, 2] - usual) < within:
            spoilt = k
            break
    spoilt = min(spoilt + 1, most)
    return (0, count - spoilt) if last else (spoilt, count)


@njit(cache=True)
def _leg(seen, end, within_mm):  # type: ignore[no-untyped-def]
    """(x, y, heading, bend, width) of the line at its end through the stations so near to it, and their root
    mean square distance from it, mm.
    """
    # 1. the stations, along and across their chord
    near = np.empty(len(seen), np.int64)
    count = 0
    for k in range(len(seen)):
        if math.hypot(seen[k, 0] - end[0], seen[k, 1] - end[1]) <= within_mm:
            near[count] = k
            count += 1
    first, last = near[0], near[count - 1]
    heading = heading_between(seen, first, last)
    c, s = math.cos(heading), math.sin(heading)
    x = np.empty(count)
    y = np.empty(count)
    widths = np.empty(count)
    for k in range(count):
        dx = seen[near[k], 0] - end[0]
        dy = seen[near[k], 1] - end[1]
        x[k] = _along(dx, dy, c, s)
        y[k] = _across(dx, dy, c, s)
        widths[k] = seen[near[k], 2]
    # 2. the parabola
    (slope, offset, bend), misfit = fit(x, y)
    curvature = bend_of(slope, bend)
    place = end[0] + offset * -s, end[1] + offset * c
    leg = place[0], place[1], heading + math.atan(slope), curvature, median_of(widths)
    return leg, misfit


@njit(cache=True, fastmath={"contract"})
def _along(dx, dy, c, s):  # type: ignore[no-untyped-def]
    """How far a step goes along a direction; rounded once, as in numpy's matrix products."""
    return dx * c + dy * s


@njit(cache=True, fastmath={"contract"})
def _across(dx, dy, c, s):  # type: ignore[no-untyped-def]
    """How far it goes to the left of the direction, rounded in the same way."""
    return -(dx * s - dy * c)


@njit(cache=True)
def fit(x, y):  # type: ignore[no-untyped-def]
    """(slope, offset, bend) at x = 0 of y(x), and the misfit, without outliers.

    The line is straight unless its bend stands out from the uncertainty of independent stations.
    """
    degree = 2 if len(x) >= FEWEST else min(1, len(x) - 1)
    found, unsure = parabola(x, y, np.ones(len(x)), degree)
    # 1. without outliers
    for _ in range(2):
        away = np.abs(y - found[0] - found[1] * x - found[2] * x * x)
        good = away <= OUTLIERS * max(ROBUST * median_of(away), INCREMENT_MM)
        if good.all() or good.sum() < FEWEST:
            break
        x, y = x[good], y[good]
        found, unsure = parabola(x, y, np.ones(len(x)), degree)
    # 2. straight, if it may be
    rest = y - found[0] - found[1] * x - found[2] * x * x
    if degree == 2:
        noise = math.sqrt(max(np.sum(rest * rest) / (len(x) - 3), 1e-7))
        if abs(found[2]) < BEND_STANDS_OUT * unsure * noise:
            found, _ = parabola(x, y, np.ones(len(x)), 1)
            rest = y - found[0] - found[1] * x
    return (found[1], found[0], 2 * found[2]), math.sqrt(np.mean(rest * rest))


@njit(cache=True)
def parabola(x, y, weights, degree):  # type: ignore[no-untyped-def]
    """Coefficients of 1, x, x² of the weighted parabola, straight line or mean, by its degree.

    And the uncertainty of the last coefficient per unit of noise in y.
    """
    n = degree + 1
    moments = np.zeros(5)
    right = np.zeros(3)
    powers = np.ones(5)
    for k in range(len(x)):
        powers[1] = x[k]
        powers[2] = x[k] * x[k]
        powers[3], powers[4] = x[k] * powers[2], powers[2] * powers[2]
        for i in range(n):
            right[i] += weights[k] * y[k] * powers[i]
        for i in range(2 * n - 1):
            moments[i] += weights[k] * powers[i]
    sums = np.empty((n, n))
    for i in range(n):
        for j in range(n):
            sums[i, j] = moments[i + j]
    inverse = _inverse(sums + NOT_ZERO * np.eye(n))
    found = np.zeros(3)
    for i in range(n):
        for j in range(n):
            found[i] += inverse[i, j] * right[j]
    return found, math.sqrt(abs(inverse[n - 1, n - 1]))


@njit(cache=True)
def _inverse(matrix):  # type: ignore[no-untyped-def]
    """Inverse of a small matrix, by elimination; numpy's own would have numba load scipy.linalg (0.2 s)."""
    n = len(matrix)
    left, right = matrix.copy(), np.eye(n)
    for k in range(n):
        # 1. the largest of the column comes up
        best = k + np.argmax(np.abs(left[k:, k]))
        for j in range(n):
            left[k, j], left[best, j] = left[best, j], left[k, j]
            right[k, j], right[best, j] = right[best, j], right[k, j]
        # 2. its row, with 1 in the column, is taken off the others
        pivot = left[k, k]
        for j in range(n):
            left[k, j] /= pivot
            right[k, j] /= pivot
        for i in range(n):
            share = left[i, k] if i != k else 0.0
            for j in range(n):
                left[i, j] -= share * left[k, j]
                right[i, j] -= share * right[k, j]
    return right


@njit(cache=True)
def leg_about(seen, i, half_mm):  # type: ignore[no-untyped-def]
    """(x, y, heading, bend, width) of the line about station i: the parabola through the stations within
    `half_mm`, weighted to the middle.

    A station whose width differs is spoiled by a speck on one edge, and counts less.
    """
    # 1. the stations about it, along and across their chord
    near = np.empty(len(seen), np.int64)
    count = 0
    for k in range(len(seen)):
        if length_between(seen, i, k) < half_mm:
            near[count] = k
            count += 1
    places = np.empty((count, 2))
    weights = np.empty(count)
    for k in range(count):
        places[k, 0] = seen[near[k], 0] - seen[i, 0]
        places[k, 1] = seen[near[k], 1] - seen[i, 1]
        weights[k] = seen[near[k], 2]
    heading = heading_between(places, 0, count - 1)
    c, s = math.cos(heading), math.sin(heading)
    # 2. their weights
    width = median_of(weights)
    for k in range(count):
        weights[k] = abs(weights[k] / width - 1.0)
    usual = max(OUTLIERS * ROBUST * median_of(weights), BITTEN)
    x = np.empty(count)
    y = np.empty(count)
    for k in range(count):
        x[k] = _along(places[k, 0], places[k, 1], c, s)
        y[k] = _across(places[k, 0], places[k, 1], c, s)
        spoiled = (weights[k] / usual) ** 4
        weights[k] = max(1.0 - (x[k] / half_mm) ** 2, LEAST_WEIGHT) / (1.0 + spoiled)
    # 3. the parabola
    offset, slope, second = parabola(x, y, weights, 2)[0]
    place = seen[i, 0] + offset * -s, seen[i, 1] + offset * c
    return place[0], place[1], heading + math.atan(slope), bend_of(slope, 2.0 * second), width
