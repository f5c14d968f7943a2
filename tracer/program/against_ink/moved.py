"""Moved: where a line that was mended runs elsewhere than before.

Signals: a line before and after in; places out.

Source: our own.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import nearest_mm
from morfax.tracer.following.line import Line
from morfax.tracer.tangles.pen import away_from

MOVED = 0.01  # widths: a way is looked at again where it was laid by so much


def moved(old: Line, new: Line, off_widths: float) -> Array:
    """The places (n, 2) mm of two states of a line off the other's way, by more than so many widths."""
    if new is old:
        return np.empty((0, 2))
    off_mm = off_widths * new.width_mm
    old_mm, new_mm = old.places_mm, new.places_mm
    return np.vstack([_off(old_mm, new_mm, off_mm), _off(new_mm, old_mm, off_mm)])


def _off(places_mm: Array, way_mm: Array, off_mm: float) -> Array:
    """Those of some places (n, 2) mm that are further off a way (m, 2) mm."""
    far_mm = places_mm[nearest_mm(places_mm, way_mm) > off_mm]  # from its places; soon told
    return far_mm[away_from(far_mm, way_mm) > off_mm]
