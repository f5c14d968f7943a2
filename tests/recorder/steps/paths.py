"""Paths that are recorded in steps."""

from __future__ import annotations

import numpy as np

from morfax.motion.motion import Path

STEP_MM = 0.01


def circle(radius_mm: float, speed_mm_s: float, turns: float = 1.0) -> Path:
    """Round a circle at a speed, from the start at once."""
    angle = np.linspace(0, 2 * np.pi * turns, 2001)
    xy = radius_mm * np.column_stack([np.sin(angle), 1 - np.cos(angle)])
    return Path(angle * radius_mm / speed_mm_s, np.column_stack([xy, 0 * angle]))


def polyline(*points: tuple[float, float, float], speed_mm_s: float = 10.0) -> Path:
    """Straight from point to point at a speed, corners and all."""
    places = np.array(points, float)
    lengths = np.sqrt((np.diff(places, axis=0) ** 2).sum(axis=1))
    return Path(np.r_[0, np.cumsum(lengths)] / speed_mm_s, places)


SQUARE = polyline((0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0), (0, 0, 0))
