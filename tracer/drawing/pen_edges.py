"""The edges of the ink that a pen leaves along a path, at places of the path itself.

    ────────────────────╮         outside a corner a pen's ink is round, and inside it the other leg's ink is
                         ╲        added: there the middle between the edges is not the path
    ─ ─ ─ ─ ─ ─ ─ ─ ┐     │
                    ·     │       ·: the pen's way turns here
    ────────────┐   ·     │

Signals: lines (n, 2) mm, the pen's width, places on the lines and headings, rad, in; how far to the left of
each place the middle of the pen's ink is, mm, out.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.neighbours import Neighbours
from morfax.motion.plane import left_of_headings
from morfax.motion.polyline import with_places
from morfax.tracer.effort import FINE_WIDTHS

STEPS = np.arange(0.5, 1.0, 0.01)  # widths outward, among which the ink ends
INKED = 0.495  # widths from a line: more than half of one, less what rounding leaves, is paper


class PenEdges:
    """The edges of a pen's ink along lines (n, 2) mm."""

    def __init__(self, lines_mm: Sequence[Array], width_mm: float) -> None:
        self._width_mm = width_mm
        self._near = Neighbours(
            np.vstack([with_places(line[:, :2], FINE_WIDTHS * width_mm) for line in lines_mm])
        )

    def middle_mm(self, places_mm: Array, headings_rad: Array) -> Array:
        """How far to the left of places (n, 2) on the lines the middle of the ink is, mm (n,)."""
        left = left_of_headings(headings_rad)
        return 0.5 * (self._edge_mm(places_mm, left) - self._edge_mm(places_mm, -left))

    def _edge_mm(self, places_mm: Array, outward: Array) -> Array:
        """How far outward of places (n, 2) the ink ends, mm (n,): half a width, or where other ink ends."""
        steps = np.full(len(places_mm), len(STEPS) - 1)
        going = np.arange(len(places_mm))
        for k, widths in enumerate(STEPS):
            ahead_mm = places_mm[going] + widths * self._width_mm * outward[going]
            is_inked = self._near.nearest(ahead_mm)[0] < INKED * self._width_mm
            steps[going[~is_inked]] = k
            going = going[is_inked]
        return STEPS[steps] * self._width_mm
