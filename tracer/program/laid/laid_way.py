"""A laid way: a stretch of a line that the head runs along from memory, in pieces between sharp corners.

Signals: the pieces (n, 2) mm, from where the head leaves the line to where it comes back to it, in; the whole
way, its direction and its length out.

Source: our own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import length_mm


class LaidWay(NamedTuple):
    """A way as stretches (n, 2) mm between sharp corners, half the pen's width, mm, and its misfit."""

    between_corners: tuple[Array, ...]
    half_mm: float
    misfit: float = math.inf

    @property
    def way(self) -> Array:
        """The way (n, 2) mm."""
        return np.vstack(self.between_corners)

    @property
    def ahead(self) -> Array:
        """From its first place to the next, (x, y) mm."""
        places = self.between_corners[0]
        return np.asarray(places[1] - places[0])

    @property
    def length_mm(self) -> float:
        """The length of the way."""
        return length_mm(self.way)

    def stretches(self) -> list[Array]:
        """The way as stretches (n, 2) mm between sharp corners."""
        return list(self.between_corners)

    def turned_round(self) -> LaidWay:
        """The same from its last place to its first."""
        return self._replace(between_corners=tuple(s[::-1] for s in self.between_corners[::-1]))
