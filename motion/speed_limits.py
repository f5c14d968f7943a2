"""Speed limits along a way: the highest speeds that one acceleration can reach from place to place.

Signals: the speed allowed at each of n places, mm/s, and what the square of the speed can gain from each
place to the next, mm²/s² (one number, or n - 1 of them); the speeds that can be reached, mm/s, out.

    allowed    ‾‾‾‾‾‾|__|‾‾‾‾‾‾‾|          v² of a place is at most v² of its neighbour and the gain:
    braked     ‾‾‾‾╲ |__|‾‾‾‾‾╲ |          gain = 2 · acceleration · distance
    reachable  ╱‾‾‾╲_|__|╱‾‾‾‾╲_|

Source: the backward and the forward pass that are usual in controls.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit


def braked(allowed_mm_s: Array, gain_mm2_s2: Array | float) -> Array:
    """The highest speeds from which braking reaches each next one; mm/s."""
    return _bounded(allowed_mm_s, gain_mm2_s2, both_ways=False)


def reachable(allowed_mm_s: Array, gain_mm2_s2: Array | float) -> Array:
    """The highest speeds that are reached from each one before, and braked from to each next one; mm/s."""
    return _bounded(allowed_mm_s, gain_mm2_s2, both_ways=True)


def _bounded(allowed_mm_s: Array, gain_mm2_s2: Array | float, *, both_ways: bool) -> Array:
    """The highest speeds within the gains from place to place, mm/s."""
    squared = allowed_mm_s**2
    gains = np.empty(len(allowed_mm_s) - 1)
    gains[:] = gain_mm2_s2
    _passes(squared, gains, both_ways)
    return np.asarray(np.sqrt(squared))


@njit(cache=True)
def _passes(squared, gains, both_ways):  # type: ignore[no-untyped-def]
    """Bound squares of speeds, in place: from first to last if `both_ways`, then from last to first."""
    if both_ways:
        for i in range(len(gains)):
            squared[i + 1] = min(squared[i + 1], squared[i] + gains[i])
    for i in range(len(gains) - 1, -1, -1):
        squared[i] = min(squared[i], squared[i + 1] + gains[i])
