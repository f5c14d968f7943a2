"""Own motion: which axes stand from start to end, and which run alike, so that their tracks cannot be told
from copies of other tracks.

Signals in: positions or phases of the axes in cycles, row by row, in blocks of any length. Signals out: the
range of each axis, and the range of the difference of each two.

    stands    highest - lowest                  is small: the track is like the reference
    alike     highest - lowest of (one - other) is small, and both move: the tracks are like each other

Source: our own. Questions: noise must not decide, so the recorder states an axis that moves by less than a
cycle, and the player asks for half a cycle (50 us of skew between two tracks are 0.3, noise of 26 dB 0.15).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.recorder.tape.waiting_rows import ROWS_AT_ONCE

STATED_CYCLES = 1.0  # an axis that moves by less is stated
OWN_CYCLES = 0.5  # an axis that moves by less has no motion of its own
MAKES_CONTOUR = ("x", "y")  # a tool's depth and further axes stand in many programs


class OwnMotion:
    """Ranges of the axes of one tape, and of their differences, in cycles."""

    def __init__(self, axes: int) -> None:
        one, other = np.triu_indices(axes, 1)
        self._one, self._other = one, other
        self._low, self._high = np.full(axes, np.inf), np.full(axes, -np.inf)
        self._apart_low, self._apart_high = (
            np.full(len(one), np.inf),
            np.full(len(one), -np.inf),
        )
        self._first: Array | None = None
        self._open = bool(len(one))  # whether any two may still run alike

    def feed(self, cycles: Array) -> None:
        """Take the next rows (n, axes)."""
        if not len(cycles):
            return
        if self._first is None:
            self._first = cycles[0].copy()
        rows = np.ascontiguousarray(cycles, float)
        _widen(rows.ravel(), self._first, self._low, self._high)
        if self._open:
            _widen_apart(rows, (self._one, self._other), self._apart_low, self._apart_high)
            self._open = bool((self._apart_high - self._apart_low < STATED_CYCLES).any())

    @property
    def range_cycles(self) -> Array:
        """How far each axis moves in all, cycles."""
        return np.maximum(self._high - self._low, 0.0)

    @property
    def above_cycles(self) -> Array:
        """How far each axis goes above its first place, cycles."""
        return np.maximum(self._high, 0.0)

    @property
    def below_cycles(self) -> Array:
        """How far each axis goes below its first place, cycles."""
        return np.maximum(-self._low, 0.0)

    def standing(self, names: Sequence[str], below_cycles: float) -> tuple[str, ...]:
        """X and Y, where they move by less than this while another axis moves."""
        still = self.range_cycles < below_cycles
        if still.all():
            return ()
        return tuple(
            name for axis, name in enumerate(names) if still[axis] and name in MAKES_CONTOUR
        )

    def pairs(self, below_cycles: float) -> list[tuple[int, int]]:
        """Pairs of axes that move and whose difference changes by less than this."""
        moves = self.range_cycles >= STATED_CYCLES
        close = self._apart_high - self._apart_low < below_cycles
        return [
            (one, other)
            for one, other, near in zip(
                self._one.tolist(), self._other.tolist(), close.tolist(), strict=True
            )
            if near and moves[one] and moves[other]
        ]

    def told(self, names: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """What the text chunk states: the axes that stand, and those that run like another."""
        alike = {axis for pair in self.pairs(STATED_CYCLES) for axis in pair}
        return self.standing(names, STATED_CYCLES), tuple(
            name for axis, name in enumerate(names) if axis in alike
        )


@njit(cache=True, nogil=True)
def _widen(places, first, low, high):  # type: ignore[no-untyped-def]
    """Widen the ranges of axes, about their first places, by places, axis after axis and row after row.

    An axis with a place that is no number tells nothing. As many rows at once as fill the vectors.
    """
    axes = len(first)
    width = ROWS_AT_ONCE * axes
    least, most, wrong = np.full(width, np.inf), np.full(width, -np.inf), np.zeros(width)
    for begin in range(0, len(places), width):
        some = places[begin : begin + width]
        for k in range(len(some)):
            place = some[k]
            least[k], most[k] = min(least[k], place), max(most[k], place)
            wrong[k] += place - place  # no number, if place is none
    for k in range(axes, width):
        least[k % axes] = min(least[k % axes], least[k])
        most[k % axes] = max(most[k % axes], most[k])
        wrong[k % axes] += wrong[k]
    for axis in range(axes):
        if wrong[axis] == 0.0:
            low[axis] = min(low[axis], least[axis] - first[axis])
            high[axis] = max(high[axis], most[axis] - first[axis])


@njit(cache=True, nogil=True)
def _widen_apart(rows, pairs, low, high):  # type: ignore[no-untyped-def]
    """Widen the ranges of the differences of two axes each, as far as these may still run alike.

    A pair with a place that is no number tells nothing.
    """
    for pair in range(len(low)):
        if high[pair] - low[pair] >= STATED_CYCLES:
            continue
        one, other = pairs[0][pair], pairs[1][pair]
        least, most = np.inf, -np.inf
        for k in range(len(rows)):
            apart = rows[k, one] - rows[k, other]
            if np.isnan(apart):
                break
            least, most = min(least, apart), max(most, apart)
        else:
            low[pair], high[pair] = min(low[pair], least), max(high[pair], most)
