"""Curves: a smooth way between two places and headings, and how fast a way may be run in its bends.

Signals: places (n, 2) mm, headings in rad, speeds in mm/s.

    v² · bend <= acceleration        v falls to the speed at the end by braking (see `speed_limits`)

Source: the cubic between two places and slopes is Hermite's; our own use.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.plane import NOTHING_MM, SAME_MM, length_between
from morfax.motion.polyline import APART_MM
from morfax.motion.speed_limits import braked

LEAST_BEND_PER_MM = 1e-6  # so that no bend is: a radius of a kilometre is straight


def hermite(start: Array, heading: float, end: Array, end_heading: float) -> Array:
    """The cubic from one place and heading to another, (n, 2) mm."""
    chord = float(np.hypot(*(end - start)))
    leaving = chord * math.cos(heading), chord * math.sin(heading)
    arriving = chord * math.cos(end_heading), chord * math.sin(end_heading)
    return cubic(start, leaving, end, arriving, max(2, math.ceil(chord / APART_MM) + 1))


def bow(start: Array, heading: float, end: Array, end_heading: float) -> Array:
    """The cubic from one place and heading to another that is an arc, to 2e-4 of its radius up to a quarter
    turn, where an arc would have these headings, (n, 2) mm.

    An arc that turns by 2a has slopes that are 1 / cos²(a/2) times as long as its chord.
    """
    turned = math.remainder(end_heading - heading, math.tau)
    chord = float(np.hypot(*(end - start)))
    long = chord / math.cos(0.25 * turned) ** 2
    slopes = [(long * math.cos(at), long * math.sin(at)) for at in (heading, end_heading)]
    return cubic(start, slopes[0], end, slopes[1], max(2, math.ceil(chord / APART_MM) + 1))


def cubic(
    start: Array, leaving: Sequence[float], end: Array, arriving: Sequence[float], count: int
) -> Array:
    """So many places of the cubic from one place to another, by its slopes there in mm, (n, 2) mm."""
    ends = float(start[0]), float(start[1]), float(end[0]), float(end[1])
    out = np.empty((count, 2))
    _cubic(ends, (*leaving, *arriving), out)
    return out


def through(nodes: Sequence[tuple[Array, float]]) -> Array:
    """The cubics from each of some places and headings to the next, (n, 2) mm."""
    poses = np.array([(place[0], place[1], heading) for place, heading in nodes], float)
    out = np.empty((_places_through(poses), 2))
    _cubics(poses, out)
    return out


@njit(cache=True, _nrt=False)
def _places_through(poses):  # type: ignore[no-untyped-def]
    """How many places the cubics through some poses (n, 3) have."""
    count = 0
    for k in range(len(poses) - 1):
        chord = length_between(poses, k, k + 1)
        count += max(2, math.ceil(chord / APART_MM) + 1)
    return count


@njit(cache=True, _nrt=False)
def _cubics(poses, out):  # type: ignore[no-untyped-def]
    """Fill `out` with the cubics through some poses, each as `hermite` has it."""
    begin = 0
    for k in range(len(poses) - 1):
        x, y, heading = poses[k, 0], poses[k, 1], poses[k, 2]
        end_x, end_y, end_heading = poses[k + 1, 0], poses[k + 1, 1], poses[k + 1, 2]
        chord = math.hypot(end_x - x, end_y - y)
        end = begin + max(2, math.ceil(chord / APART_MM) + 1)
        leaving = chord * math.cos(heading), chord * math.sin(heading)
        arriving = chord * math.cos(end_heading), chord * math.sin(end_heading)
        _cubic((x, y, end_x, end_y), (*leaving, *arriving), out[begin:end])
        begin = end


@njit(cache=True, _nrt=False)
def _cubic(ends, slopes, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, 2) with a cubic from place to place, by its slopes there."""
    last = len(out) - 1
    step = 1.0 / last
    for k in range(last + 1):
        t = k * step if k < last else 1.0
        h = t * t * (3.0 - 2.0 * t)
        leaves = (1.0 - t) * (1.0 - t)
        arrives = 1.0 - t
        for i in range(2):
            slope = slopes[i] * t * leaves - slopes[2 + i] * t * t * arrives
            out[k, i] = ends[i] * (1.0 - h) + ends[2 + i] * h + slope


def bends_per_mm(points: Array) -> Array:
    """How much a polyline (n, 2) mm bends at each place between its first and last, 1/mm."""
    steps = np.diff(points, axis=0)
    lengths = np.maximum(np.hypot(*steps.T), NOTHING_MM)
    headings = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    return np.asarray(np.abs(np.diff(headings)) / (0.5 * (lengths[1:] + lengths[:-1])))


def speeds_in_bends(points: Array, speed_mm_s: float, acceleration_mm_s2: float) -> Array:
    """Speed allowed at each place of a polyline: no more than asked, and slower in its bends; mm/s."""
    allowed = np.full(len(points), speed_mm_s)
    if len(points) > 2:
        bends = np.maximum(bends_per_mm(points), LEAST_BEND_PER_MM)
        allowed[1:-1] = np.minimum(speed_mm_s, np.sqrt(acceleration_mm_s2 / bends))
    return allowed


def speeds(
    points: Array, speed_mm_s: float, acceleration_mm_s2: float, end_mm_s: float
) -> Array:
    """Highest speed at each place of a stretch: what bends and braking allow, `end_mm_s` at its end; mm/s."""
    lengths = np.maximum(np.hypot(*np.diff(points, axis=0).T), NOTHING_MM)
    allowed = speeds_in_bends(points, speed_mm_s, acceleration_mm_s2)
    allowed[-1] = min(allowed[-1], end_mm_s)
    return braked(allowed, 2 * acceleration_mm_s2 * lengths)


def distinct(points: Array) -> Array:
    """The polyline without places that repeat the one before."""
    keep = np.ones(len(points), bool)
    steps = points[1:] - points[:-1]
    keep[1:] = np.hypot(steps[:, 0], steps[:, 1]) > SAME_MM
    return points[keep]
