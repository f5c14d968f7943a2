"""Spokes: how far ink or paper reaches all round from the middle of a dot or a ring.

Signals: a place on the sheet in; the distances at which ink and paper change along each spoke (mm) out.

Source: our own.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.tracer.sensing.photocell import STEP_PX
from morfax.tracer.sensing.ray import Ray, crossing_mm
from morfax.tracer.sensing.view import View

SPOKES = 72  # one every five degrees: a line that leaves a dot covers several
ANGLES = np.arange(SPOKES) * math.tau / SPOKES
WAYS = np.column_stack([np.cos(ANGLES), np.sin(ANGLES)])


def spokes(view: View, place: Array, reach_mm: float) -> Array:
    """Where ink and paper change first and second along each spoke, (SPOKES, 2) mm; NaN beyond reach."""
    return np.asarray(_changes(view.cells, place, WAYS, reach_mm))


@njit(cache=True)
def _changes(cells, place, ways, reach_mm):  # type: ignore[no-untyped-def]
    """The first two changes along each of some ways from a place, mm."""
    out = np.full((len(ways), 2), math.nan)
    step = STEP_PX * cells.pitch_mm
    last_mm = reach_mm - step  # the sample after this is the last within reach
    for k in range(len(ways)):
        spoke = Ray(place[0], place[1], ways[k, 0], ways[k, 1], 0.0)
        first = crossing_mm(cells, spoke, 0.0, last_mm, 0.0)
        if math.isnan(first):
            continue
        behind = step * (math.floor(first / step) + 1)  # the sample that is past the change
        out[k, 0] = first
        out[k, 1] = crossing_mm(cells, spoke, behind, last_mm, 0.0)
    return out
