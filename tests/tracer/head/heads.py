"""States of the head that are made by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.state import at_rest
from morfax.tracer.sensing.photocell import LEVEL, Cells

PLACE = np.array([12.0, 8.0])
SPEED_MM_S = Settings().speed_mm_s
LEAD_MM = 0.85  # of the precise head on a line of 0.5 mm at 300 dpi


def moving(heading: float = 0.0) -> Any:
    """A head that moves along a heading at its speed, on its line."""
    state = at_rest(PLACE, LEAD_MM)
    state.heading_rad, state.speed_mm_s, state.guard_ahead = heading, SPEED_MM_S, 1.0
    state.vx_mm_s, state.vy_mm_s = (
        SPEED_MM_S * math.cos(heading),
        SPEED_MM_S * math.sin(heading),
    )
    return state


def remembered(state: Any, along_mm: Array, aside_mm: Array) -> None:
    """Put places on the drum, along and to the left of the head's heading."""
    c, s = math.cos(state.heading_rad), math.sin(state.heading_rad)
    places = np.column_stack([along_mm * c - aside_mm * s, along_mm * s + aside_mm * c]) + PLACE
    state.drum_mm[: len(places)] = places
    state.places = len(places)


def white(darkness: float = 0.0) -> Cells:
    """A sheet of one darkness."""
    return Cells(np.full((300, 300), darkness, np.float32), 0.1, LEVEL)
