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


def spokes(view: View, place: Array, reach_mm: float, changes: int = 2) -> Array:
    """Where ink and paper change first, second … along each spoke, (SPOKES, changes) mm; NaN beyond reach."""
    out = np.full((SPOKES, changes), math.nan)
    changes_along(view.cells, place, WAYS, reach_mm, out)
    return out


@njit(cache=True, _nrt=False)
def changes_along(cells, place, ways, reach_mm, out):  # type: ignore[no-untyped-def]
    """Fill `out` with the first changes along each of some ways from a place, mm."""
    step = STEP_PX * cells.pitch_mm
    last_mm = reach_mm - step  # the sample after this is the last within reach
    for k in range(len(ways)):
        spoke = Ray(place[0], place[1], ways[k, 0], ways[k, 1], 0.0)
        begin_mm = 0.0
        for change in range(out.shape[1]):
            found = crossing_mm(cells, spoke, begin_mm, last_mm, 0.0)
            if math.isnan(found):
                break
            out[k, change] = found
            begin_mm = step * (math.floor(found / step) + 1)  # the sample that is past it
