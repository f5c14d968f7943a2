"""Rounds: dots and rings, felt by spokes of cells from their middle.

Signals: a place on the sheet in; out how far ink or paper reaches from it all round, and the circle through
places (mm).

Source: our own.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from morfax.motion.arrays import Array
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.view import View

SPOKES = 72
ANGLES = np.arange(SPOKES) * math.tau / SPOKES
WAYS = np.column_stack([np.cos(ANGLES), np.sin(ANGLES)])


def spokes(view: View, place: Array, reach_mm: float) -> Array:
    """Where ink and paper change first and second along each spoke, (SPOKES, 2) mm from the place; NaN beyond
    reach.
    """
    return np.asarray(_changes(view.cells, view.pitch_mm, place, WAYS, reach_mm, view.level))


@njit(cache=True)
def _changes(cells, pitch_mm, place, ways, reach_mm, level):  # type: ignore[no-untyped-def]
    """The first two changes along each of some ways from a place, mm."""
    out = np.full((len(ways), 2), math.nan)
    step = 0.35 * pitch_mm
    for k in range(len(ways)):
        before = photocell.darkness_at(cells, pitch_mm, place[0], place[1])
        found, r = 0, step
        while r <= reach_mm and found < 2:
            now = photocell.darkness_at(
                cells, pitch_mm, place[0] + r * ways[k, 0], place[1] + r * ways[k, 1]
            )
            if (now >= level) != (before >= level):
                out[k, found] = r - step * (level - now) / (before - now)
                found += 1
            before = now
            r += step
    return out


def circle_through(places: Array) -> tuple[Array, float, float]:
    """Centre, radius and misfit (root mean square), mm, of the circle through places (n, 2), least squares."""
    middle = places.mean(axis=0)
    d = places - middle
    squares = np.sum(d * d, axis=1)
    a, b, c = np.linalg.lstsq(np.column_stack([2 * d, np.ones(len(d))]), squares, rcond=None)[0]
    radius = math.sqrt(max(c + a * a + b * b, 0.0))
    misfit = np.sqrt(np.mean((np.hypot(*(d - [a, b]).T) - radius) ** 2))
    return middle + np.array([a, b]), radius, float(misfit)
