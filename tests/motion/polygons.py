"""Closed lines about which tools go."""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array

UM = 1e-3  # mm


def circle(radius_mm: float, noise_mm: float = 0.0, seed: int = 0) -> Array:
    """A circle as a head would run it: a place every 2 um, with waves of 0.5 to 3 mm as a scan's noise makes
    them.
    """
    angle = np.linspace(0, math.tau, round(math.tau * radius_mm / 0.002) + 1)
    rng, radius = np.random.default_rng(seed), np.full_like(angle, radius_mm)
    for waves in range(20, 120, 10):
        radius += noise_mm * rng.normal() * np.cos(waves * angle + rng.uniform(0, math.tau))
    points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    points[-1] = points[0]
    return points


def polygon(*vertices: tuple[float, float]) -> Array:
    """A closed line that begins in the middle of its first side."""
    points = np.array(vertices, float)
    return np.vstack(
        [(points[0] + points[1]) / 2, points[1:], points[:1], (points[0] + points[1]) / 2]
    )


SQUARE = polygon((0, 0), (20, 0), (20, 20), (0, 20))
