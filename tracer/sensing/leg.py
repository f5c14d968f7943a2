"""Legs: clean stretches of line, as parabolas through the stations that were felt on them.

Signals: stations of the line (n, 3: centre x, y and width, mm) in; place, heading (rad) and bend (1/mm) of
the line out, and where two legs meet.

    place(s) = end + s·t + bend/2·s²·n          t, n: along and across the heading at the leg's clean end

Source: our own (see `rings`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.arrays import median as median_of
from morfax.motion.compiled import njit
from morfax.motion.median import median

# straight on is within this, and a leg turns off to a side by more than that
STRAIGHT, TURNS_OFF = math.radians(40), math.radians(20)
FARTHEST_MM = 10.0  # legs that meet further away do not meet
NEARLY_PARALLEL = 0.02  # sine of the angle between two legs that do not meet
BITTEN = 0.06  # of the width: more than a scan's noise
ROBUST = 1.4826  # standard deviations to a median absolute deviation of normal noise
OUTLIERS = 3.0  # standard deviations: what is further off is left out
LEAST_OFF_MM = 0.001  # of a station: nearer ones stay in
FEWEST_STATIONS, LEAST_WIDTHS = 4, 0.8  # of clean line make a leg; by trial
FEWEST = 8  # stations: a parabola through fewer follows their noise
# standard errors: neighbouring stations share their ink, so that a bend has to stand out further than three
BEND_STANDS_OUT = 5.0

# how far two legs meet beyond the one's clean end and before the other's, mm
Meeting = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Leg:
    """A clean stretch of line at a junction, with its stations `seen`.

    `end_mm` is its clean end; the heading there and the bend are along the travel.
    """

    end_mm: Array
    heading_rad: float
    bend_per_mm: float
    width_mm: float
    seen: Array

    def at(self, along_mm: float | Array) -> Array:
        """Places (…, 2) at distances from the clean end along the travel (negative: before it)."""
        if isinstance(along_mm, (float, int)):
            return np.array(self.place(along_mm))
        s = np.asarray(along_mm, float)[..., None]
        t = np.array([math.cos(self.heading_rad), math.sin(self.heading_rad)])
        n = np.array([-t[1], t[0]])
        return self.end_mm + s * t + 0.5 * self.bend_per_mm * s * s * n

    def place(self, along_mm: float) -> tuple[float, float]:
        """The place at one distance, as `at` has it to the bit: an array of two takes ten times as long."""
        x, y = self.end_mm.tolist()
        c, s = math.cos(self.heading_rad), math.sin(self.heading_rad)
        aside = 0.5 * float(self.bend_per_mm) * along_mm * along_mm
        return x + along_mm * c + aside * -s, y + along_mm * s + aside * c

    def shifted(self, along_mm: float, seen: Array) -> Leg:
        """The same line from a place further along it, with the stations that were felt from there."""
        heading = self.heading_at(along_mm)
        return Leg(self.at(along_mm), heading, self.bend_per_mm, self.width_mm, seen)

    def turned_round(self) -> Leg:
        """The same leg, to go back along it."""
        heading = math.remainder(self.heading_rad + math.pi, math.tau)
        return Leg(self.end_mm, heading, -self.bend_per_mm, self.width_mm, self.seen[::-1])

    def heading_at(self, along_mm: float) -> float:
        """Heading at a distance from the clean end, rad."""
        return self.heading_rad + math.atan(self.bend_per_mm * along_mm)


# fitting


def leg_of(seen: Array, last: bool, length_mm: float) -> Leg:
    """Fit a leg to stations (n, 3) in the order of travel; its clean end is at the `last` or the first one.

    The leg takes in as long a stretch as one parabola fits about as well as it fits the nearest part.
    """
    seen = _without_blot(seen, last)
    end = seen[-1] if last else seen[0]
    away = np.hypot(*(seen[:, :2] - end[:2]).T)
    best, limit = _leg(seen[away <= 0.5 * length_mm], end, seen)
    for share in (0.75, 1.0):
        leg, misfit = _leg(seen[away <= share * length_mm], end, seen)
        if misfit > 1.3 * limit + LEAST_OFF_MM:
            break
        best, limit = leg, misfit
    return best


def _without_blot(seen: Array, last: bool) -> Array:
    """The stations without those next to the junction whose width shows its ink: a third at most."""
    widths = seen[::-1, 2] if last else seen[:, 2]
    usual = median(widths)
    spread = ROBUST * median(np.abs(widths - usual))
    most = len(seen) // 3
    clean = np.abs(widths[: most + 1] - usual) < max(OUTLIERS * spread, 0.03 * usual)
    first = int(np.argmax(clean)) if clean.any() else most
    first = min(first + 1, most)
    return seen[: len(seen) - first] if last else seen[first:]


def _leg(near: Array, end: Array, seen: Array) -> tuple[Leg, float]:
    """The leg through some stations, and their root mean square distance from it, mm."""
    heading, t, n = _chord(near[-1, :2] - near[0, :2])
    d = near[:, :2] - end[:2]
    (slope, offset, bend), misfit = _fit(d @ t, d @ n)
    curvature = bend / (1 + slope * slope) ** 1.5
    width = median(near[:, 2])
    leg = Leg(end[:2] + offset * n, heading + math.atan(slope), curvature, width, seen)
    return leg, misfit


def _chord(chord: Array) -> tuple[float, Array, Array]:
    """Heading of a chord, and the unit vectors along it and to its left."""
    heading = math.atan2(chord[1], chord[0])
    t = np.array([math.cos(heading), math.sin(heading)])
    return heading, t, np.array([-t[1], t[0]])


@njit(cache=True)
def _fit(x, y):  # type: ignore[no-untyped-def]
    """(slope, offset, bend) at x = 0 of y(x), and the misfit, without outliers.

    The line is straight unless its bend stands out from the uncertainty of independent stations.
    """
    degree = 2 if len(x) >= FEWEST else min(1, len(x) - 1)
    found, unsure = _parabola(x, y, np.ones(len(x)), degree)
    # 1. without outliers
    for _ in range(2):
        away = np.abs(y - found[0] - found[1] * x - found[2] * x * x)
        good = away <= OUTLIERS * max(ROBUST * np.median(away), LEAST_OFF_MM)
        if good.all() or good.sum() < FEWEST:
            break
        x, y = x[good], y[good]
        found, unsure = _parabola(x, y, np.ones(len(x)), degree)
    # 2. straight, if it may be
    rest = y - found[0] - found[1] * x - found[2] * x * x
    if degree == 2:
        noise = math.sqrt(max(np.sum(rest * rest) / (len(x) - 3), 1e-7))
        if abs(found[2]) < BEND_STANDS_OUT * unsure * noise:
            found, _ = _parabola(x, y, np.ones(len(x)), 1)
            rest = y - found[0] - found[1] * x
    return (found[1], found[0], 2 * found[2]), math.sqrt(np.mean(rest * rest))


@njit(cache=True)
def _parabola(x, y, weights, degree):  # type: ignore[no-untyped-def]
    """Coefficients of 1, x, x² of the weighted parabola, straight line or mean, by its degree.

    And the uncertainty of the last coefficient per unit of noise in y.
    """
    n = degree + 1
    sums, right = np.zeros((n, n)), np.zeros(n)
    for k in range(len(x)):
        for i in range(n):
            right[i] += weights[k] * y[k] * x[k] ** i
            for j in range(n):
                sums[i, j] += weights[k] * x[k] ** (i + j)
    inverse = _inverse(sums + 1e-12 * np.eye(n))
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


def centre_at(seen: Array, i: int, half_mm: float) -> Leg:
    """The line about station i: the parabola through the stations within `half_mm`, weighted to the middle.

    A station whose width differs is spoiled by a speck on one edge, and counts less.
    """
    d = seen[:, :2] - seen[i, :2]
    near = np.flatnonzero(np.hypot(*d.T) < half_mm)
    heading, t, n = _chord(d[near[-1]] - d[near[0]])
    x, y = d[near] @ t, d[near] @ n
    width = median(seen[near, 2])
    off = np.abs(seen[near, 2] / width - 1)
    usual = max(OUTLIERS * ROBUST * median(off), BITTEN)
    weights = np.maximum(1 - (x / half_mm) ** 2, 0.05) / (1 + (off / usual) ** 4)
    offset, slope, bend = _parabola(x, y, weights, 2)[0]
    curvature = 2 * bend / (1 + slope * slope) ** 1.5
    place = seen[i, :2] + offset * n
    return Leg(place, heading + math.atan(slope), curvature, width, seen[i:])


@njit(cache=True)
def bend_at(seen, i, half_mm):  # type: ignore[no-untyped-def]
    """The bend of `centre_at`, 1/mm, for kernels: to rounding the same."""
    # 1. the stations about it
    near = np.empty(len(seen), np.int64)
    count = 0
    for k in range(len(seen)):
        if math.hypot(seen[k, 0] - seen[i, 0], seen[k, 1] - seen[i, 1]) < half_mm:
            near[count] = k
            count += 1
    first, last = near[0], near[count - 1]
    heading = math.atan2(seen[last, 1] - seen[first, 1], seen[last, 0] - seen[first, 0])
    c, s = math.cos(heading), math.sin(heading)
    # 2. their weights
    x, y, weights = np.empty(count), np.empty(count), np.empty(count)
    for k in range(count):
        weights[k] = seen[near[k], 2]
    width = median_of(weights)
    for k in range(count):
        weights[k] = abs(weights[k] / width - 1.0)
    usual = max(OUTLIERS * ROBUST * median_of(weights), BITTEN)
    for k in range(count):
        dx, dy = seen[near[k], 0] - seen[i, 0], seen[near[k], 1] - seen[i, 1]
        x[k], y[k] = dx * c + dy * s, dy * c - dx * s
        spoiled = (weights[k] / usual) ** 4
        weights[k] = max(1.0 - (x[k] / half_mm) ** 2, 0.05) / (1.0 + spoiled)
    # 3. the parabola
    found = _parabola(x, y, weights, 2)[0]
    return 2.0 * found[2] / (1.0 + found[1] * found[1]) ** 1.5


# two legs


def heading_of(step: Array) -> float:
    """Heading of a step (x, y), rad."""
    return math.atan2(step[1], step[0])


def turn(a: float, b: float) -> float:
    """Angle from heading a to heading b, -pi..pi."""
    return math.remainder(b - a, math.tau)


def meet(incoming: Leg, outgoing: Leg) -> Meeting | None:
    """Distances (beyond the incoming leg's end, before the outgoing leg's) where they cross, mm, or None."""
    s = u = 0.0
    for _ in range(6):
        a, b = incoming.heading_at(s), outgoing.heading_at(-u)
        cross = math.sin(turn(a, b))
        if abs(cross) < NEARLY_PARALLEL:
            return None
        (to_x, to_y), (x, y) = outgoing.place(-u), incoming.place(s)
        gap_x, gap_y = to_x - x, to_y - y
        ds = (gap_x * math.sin(b) - gap_y * math.cos(b)) / cross
        du = (gap_x * math.sin(a) - gap_y * math.cos(a)) / cross
        s, u = s + ds, u - du
        if max(abs(s), abs(u)) > FARTHEST_MM:
            return None
    return s, u


def turns_off(incoming: Leg, leg: Leg) -> bool:
    """Whether a leg turns off from another so far that it is certain where they meet."""
    return abs(turn(incoming.heading_rad, leg.heading_rad)) > TURNS_OFF


def goes_straight(incoming: Leg, outgoing: Leg | None) -> bool:
    """Whether a leg goes on straight from another."""
    if outgoing is None:
        return False
    return abs(turn(incoming.heading_rad, outgoing.heading_rad)) < STRAIGHT
