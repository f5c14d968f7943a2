"""Curves: a smooth way between two places and headings, and how fast a way may be run in its bends.

Signals: places (n, 2) mm, headings in rad, speeds in mm/s.

    v² · bend <= acceleration        v falls to the speed at the end by braking (see `speed_limits`)

Source: the cubic between two places and slopes is Hermite's; our own use.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.speed_limits import braked

SPACING_MM = 0.02  # of the places on a curve
REPEATS_MM = 1e-6  # a place that is no further from the one before repeats it
LEAST_STEP_MM = 1e-9  # so that no step is divided by zero
LEAST_BEND_PER_MM = 1e-6  # so that no bend is: a radius of a kilometre is straight


def hermite(start: Array, heading: float, end: Array, end_heading: float) -> Array:
    """The cubic from one place and heading to another, (n, 2) mm."""
    chord = float(np.hypot(*(end - start)))
    t = np.linspace(0, 1, max(2, math.ceil(chord / SPACING_MM) + 1))[:, None]
    leaving = chord * np.array([math.cos(heading), math.sin(heading)])
    arriving = chord * np.array([math.cos(end_heading), math.sin(end_heading)])
    h = t * t * (3 - 2 * t)
    slopes = leaving * t * (1 - t) ** 2 - arriving * t * t * (1 - t)
    return np.asarray(start * (1 - h) + end * h + slopes)


def bends_per_mm(points: Array) -> Array:
    """How much a polyline (n, 2) mm bends at each place between its first and last, 1/mm."""
    steps = np.diff(points, axis=0)
    lengths = np.maximum(np.hypot(*steps.T), LEAST_STEP_MM)
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
    lengths = np.maximum(np.hypot(*np.diff(points, axis=0).T), LEAST_STEP_MM)
    allowed = speeds_in_bends(points, speed_mm_s, acceleration_mm_s2)
    allowed[-1] = min(allowed[-1], end_mm_s)
    return braked(allowed, 2 * acceleration_mm_s2 * lengths)


def distinct(points: Array) -> Array:
    """The polyline without places that repeat the one before."""
    keep = np.r_[True, np.hypot(*np.diff(points, axis=0).T) > REPEATS_MM]
    return points[keep]
