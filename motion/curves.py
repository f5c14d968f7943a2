"""Curves: a smooth way between two places and headings, and how fast a way may be run for its bends."""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array

SPACING_MM = 0.02


def hermite(start: Array, heading: float, end: Array, end_heading: float) -> Array:
    """The cubic from one place and heading to another, (n, 2) mm."""
    chord = float(np.hypot(*(end - start)))
    t = np.linspace(0, 1, max(2, math.ceil(chord / SPACING_MM) + 1))[:, None]
    a = chord * np.array([math.cos(heading), math.sin(heading)])
    b = chord * np.array([math.cos(end_heading), math.sin(end_heading)])
    h = t * t * (3 - 2 * t)
    return np.asarray(start * (1 - h) + end * h + a * t * (1 - t) ** 2 - b * t * t * (1 - t))


def bends_per_mm(points: Array) -> Array:
    """How much a polyline (n, 2) mm bends at each place between its first and last, 1/mm."""
    steps = np.diff(points, axis=0)
    lengths = np.maximum(np.hypot(*steps.T), 1e-9)
    headings = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    return np.asarray(np.abs(np.diff(headings)) / (0.5 * (lengths[1:] + lengths[:-1])))


def speeds(
    points: Array, speed_mm_s: float, acceleration_mm_s2: float, end_mm_s: float
) -> Array:
    """Highest speed at each place of a stretch: what bends and braking allow, `end_mm_s` at its end; mm/s."""
    lengths = np.maximum(np.hypot(*np.diff(points, axis=0).T), 1e-9)
    allowed = np.full(len(points), speed_mm_s)
    if len(points) > 2:
        bends = np.maximum(bends_per_mm(points), 1e-6)
        allowed[1:-1] = np.minimum(speed_mm_s, np.sqrt(acceleration_mm_s2 / bends))
    allowed[-1] = min(allowed[-1], end_mm_s)
    for i in range(len(points) - 2, -1, -1):
        allowed[i] = min(
            allowed[i], math.sqrt(allowed[i + 1] ** 2 + 2 * acceleration_mm_s2 * lengths[i])
        )
    return allowed


def distinct(points: Array) -> Array:
    """The polyline without places that repeat the one before."""
    keep = np.r_[True, np.hypot(*np.diff(points, axis=0).T) > 1e-6]
    return points[keep]
