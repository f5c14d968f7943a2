"""A rim's way: a closed way within a rim, as it is compared with others of its patch of ink.

Signals: a closed way in; where it turns sharply, and whether it does so where another one lies, out.

Source: our own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.plane import BEND_RAD
from morfax.motion.polyline import nearest_mm
from morfax.tracer.program.laid.kept_parts import KeptWay
from morfax.tracer.sensing.view import STEP_WIDTHS

KINK_OVER = 1.0  # widths to either side of a place, by how much a way turns there


class RimWay(NamedTuple):
    """A closed way (n, 2) mm, not closed up, with the parts of lines that it keeps; at a step from place to
    place; how far the ink's places are from it; by how much it turns in all; and at which of its places it
    has a kink.
    """

    way: Array
    kept: KeptWay
    even: Array
    away_mm: Array
    turned_rad: float
    kinks: NDArray[np.int64]

    def has_kink_on(self, other: RimWay, near_mm: float, beyond: int) -> bool:
        """Whether a kink lies on another way, or on this one further on by so many places."""
        if other is not self:
            return bool((nearest_mm(self.even[self.kinks], other.even) < near_mm).any())
        count = len(self.even)
        for kink in self.kinks.tolist():
            further = self.even[(kink + np.arange(beyond, count - beyond)) % count]
            if nearest_mm(self.even[kink : kink + 1], further).min(initial=math.inf) < near_mm:
                return True
        return False

    def without_kinks(self, gone: NDArray[np.bool_]) -> RimWay:
        """It without some of its kinks."""
        return self._replace(kinks=self.kinks[~gone])


def kinks_of(even: Array) -> NDArray[np.int64]:
    """The places of a closed way (n, 2) at which it turns more than about them."""
    over, count = round(KINK_OVER / STEP_WIDTHS), len(even)
    if count <= 4 * over:
        return np.empty(0, np.int64)
    ahead = np.roll(even, -over, axis=0) - even
    turns = np.arctan2(ahead[:, 1], ahead[:, 0])
    turns = turns - np.roll(turns, over)
    turns -= math.tau * np.round(turns / math.tau)
    about = 0.5 * (np.roll(turns, -2 * over) + np.roll(turns, 2 * over))
    return np.flatnonzero(np.abs(turns) - np.abs(about) > BEND_RAD)
