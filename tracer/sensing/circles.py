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
from morfax.tracer.sensing.photocell import STEP_PX
from morfax.tracer.sensing.ray import Ray, crossing_mm
from morfax.tracer.sensing.view import View

SPOKES = 72
ANGLES = np.arange(SPOKES) * math.tau / SPOKES
WAYS = np.column_stack([np.cos(ANGLES), np.sin(ANGLES)])


def spokes(view: View, place: Array, reach_mm: float) -> Array:
    """Where ink and paper change first and second along each spoke, (SPOKES, 2) mm from the place; NaN beyond
    reach.
    """
    return np.asarray(_changes(view.cells, place, WAYS, reach_mm))


@njit(cache=True)
def _changes(cells, place, ways, reach_mm):  # type: ignore[no-untyped-def]
    """The first two changes along each of some ways from a place, mm."""
    out = np.full((len(ways), 2), math.nan)
    step = STEP_PX * cells.pitch_mm
    for k in range(len(ways)):
        spoke = Ray(place[0], place[1], ways[k, 0], ways[k, 1], 0.0)
        first = crossing_mm(cells, spoke, 0.0, reach_mm - step, 0.0)
        if math.isnan(first):
            continue
        behind = step * (math.floor(first / step) + 1)  # the sample that is past the change
        out[k, 0] = first
        out[k, 1] = crossing_mm(cells, spoke, behind, reach_mm - step, 0.0)
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
