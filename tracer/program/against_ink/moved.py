"""Moved: where a line that was mended runs elsewhere than before.

Signals: a line before and after in; places out.

Source: our own.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import nearest_mm
from morfax.tracer.following.line import Line


def moved(old: Line, new: Line, off_widths: float) -> Array:
    """The places (n, 2) mm of two states of a line off the other's way, by more than so many widths."""
    if new is old:
        return np.empty((0, 2))
    off_mm = off_widths * new.width_mm
    old_mm, new_mm = old.places_mm, new.places_mm
    gone = old_mm[nearest_mm(old_mm, new_mm) > off_mm]
    return np.vstack([gone, new_mm[nearest_mm(new_mm, old_mm) > off_mm]])
