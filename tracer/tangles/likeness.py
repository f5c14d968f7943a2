"""Likeness: how well the pen's ink along a way explains the ink of a patch of the sheet.

Signals: the view, a place and a leg that shows the pen in; the misfit of a way (n, 2) mm out.

Source: our own (see `pen`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles import distances, pen
from morfax.tracer.tangles.sketch import softness_of
from morfax.tracer.tangles.tangle import DARKEST


class Pen(NamedTuple):
    """Half the width of a pen's line, and its softness, mm."""

    half_mm: float
    softness_mm: float

    @classmethod
    def of(cls, view: View, leg: Leg) -> Pen:
        """The pen that drew a leg."""
        return cls(0.5 * leg.width_mm, softness_of(view, leg))


@dataclass(frozen=True, slots=True)
class Patch:
    """The ink within reach of a place: places (n, 2), darkness (n,), half the pen's width and softness."""

    places_mm: Array
    darkness: Array
    half_mm: float
    softness_mm: float

    @classmethod
    def about(cls, view: View, place_mm: Array, reach_mm: float, pen_mm: Pen) -> Patch:
        """The patch within reach of a place, mm, and the pen that is to explain it."""
        pitch, rows = view.pitch_mm, view.cells.shape[0]
        left, right = (int((place_mm[0] + side * reach_mm) / pitch) for side in (-1, 1))
        top, bottom = (int(rows - (place_mm[1] + side * reach_mm) / pitch) for side in (1, -1))
        top, left = max(top, 0), max(left, 0)
        seen = view.cells.window(top, bottom + 1, left, right + 1)
        i, j = np.indices(seen.shape).reshape(2, -1)
        places = np.column_stack([j + left + 0.5, rows - i - top - 0.5]) * pitch
        within = np.hypot(*(places - place_mm).T) < reach_mm
        darkness = np.minimum(seen[i, j][within] / (2 * view.level), DARKEST).astype(float)
        return cls(places[within], darkness, *pen_mm)

    def misfit(self, way: Array) -> float:
        """Mean square of what a pen on a way (n, 2) mm draws too dark or too light, 1 for ink or none."""
        return float(np.mean(self.wrong(way) ** 2))

    def wrong(self, way: Array) -> Array:
        """What a pen on a way (n, 2) mm draws too dark or too light at each place, 1 for ink or none."""
        distance, drawn = (
            distances.away_from(self.places_mm, way),
            np.empty(len(self.places_mm)),
        )
        pen.ink(distance, self.half_mm, self.softness_mm, drawn)
        return drawn - self.darkness

    def for_kernel(self) -> pen.Ink:
        """The same for kernels; nothing is drawn there anyway."""
        known_mm = np.full(len(self.darkness), distances.NOWHERE_MM)
        places = np.ascontiguousarray(self.places_mm)
        return pen.Ink(places, self.darkness, known_mm, self.half_mm, self.softness_mm)
