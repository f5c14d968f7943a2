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

    def feed(self, cycles: Array) -> None:
        """Take the next rows (n, axes)."""
        if not len(cycles):
            return
        if self._first is None:
            self._first = cycles[0].copy()
        rows = np.ascontiguousarray(cycles, float)
        for axis, place in enumerate(self._first):
            least, most = _range(rows, axis, -1)
            self._low[axis] = min(self._low[axis], least - place)
            self._high[axis] = max(self._high[axis], most - place)
        open_ = np.flatnonzero(self._apart_high - self._apart_low < STATED_CYCLES)
        for pair in open_.tolist():
            least, most = _range(rows, self._one[pair], self._other[pair])
            self._apart_low[pair] = min(self._apart_low[pair], least)
            self._apart_high[pair] = max(self._apart_high[pair], most)

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
def _range(rows, one, other):  # type: ignore[no-untyped-def]
    """The least and the most of a column, or of its difference from another one (-1: none); nan where one of
    them is none.
    """
    least, most = np.inf, -np.inf
    for k in range(len(rows)):
        value = rows[k, one] - rows[k, other] if other >= 0 else rows[k, one]
        if np.isnan(value):
            return np.nan, np.nan
        least, most = min(least, value), max(most, value)
    return least, most
