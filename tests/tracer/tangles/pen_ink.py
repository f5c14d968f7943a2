"""The ink that a round pen leaves along a way, on pixels with noise, and how far two ways are apart."""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import nearest_mm, with_places
from morfax.tracer.tangles import distances, pen
from morfax.tracer.tangles.seen_ink import SeenInk
from tests.tracer.inked import UM

SOFTNESS_MM, HALF_MM = 0.06, 0.25


def ink_along(
    way: Array, pitch_mm: float, side_px: int, noise: float = 0.0, half_mm: float = HALF_MM
) -> SeenInk:
    """The ink about a way (n, 2) mm, on a square sheet, of a pen that is taken for one of HALF_MM."""
    rows, columns = np.indices((side_px, side_px)).reshape(2, -1)
    places = pitch_mm * np.column_stack([columns + 0.5, rows + 0.5])
    away = distances.away_from(places, way)
    dark = np.empty(len(places))
    pen.ink(away, half_mm, SOFTNESS_MM, dark)
    dark += np.random.default_rng(1).normal(0.0, noise, len(dark))
    near = away < half_mm + 5 * SOFTNESS_MM
    seen = int(near.sum())
    known = np.full(seen, math.inf)
    left_by_noise = seen * noise**2
    return SeenInk(
        places[near], dark[near], known, HALF_MM, SOFTNESS_MM, pitch_mm**2, left_by_noise
    )


def apart_mm(laid: Array, true: Array) -> float:
    """How far one way is from another, and that from it, at most; places are compared 2 um apart."""
    one, other = (with_places(way, 2 * UM) for way in (laid, true))
    return float(max(nearest_mm(one, other).max(), nearest_mm(other, one).max()))
