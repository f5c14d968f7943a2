"""The interpolator: four registers that make a cubic by additions only.

Signals: words A, A², A³ of each interval and axis in; the position at each of the p steps of the interval
out, all in counts with 3·log2(p) binary digits behind the point, 64-bit integers.

    step n → n+1       I + II  →  I        II + III  →  II        III + IV  →  III        IV stays

All sums are of what the registers held before the step (table I). With the switch open (q > 1) only every
q-th step is such a step, and the q - 1 before it add II to I alone; the words are then those of p/q steps, A
A² A³ over q:

    I  ____╱‾    cubic, q = 1            I  ____/‾     q = 4: straight from one exact place to the next

Register I is loaded once; II, III and IV anew in each interval, so that nothing builds up. The usual control
adds whole words; the historic one makes the same sums digit by digit, in `stores` of the patent's kind.

Source: patent US 3062995, table I, figure 2 (stores I to IV, adders 50, gates 51 and 53) and figure 3
(dividers 58, 59). Questions: the text adds IV to III before III to II, which is not table I; the table holds.
The divider 59 is said to make a ratio p + q; two dividers in a row make p·q. All four registers
have all digits behind the point: with fewer, as the text has them, an interval ends up to 20 counts off at 16
steps, and the next one starts there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.player.cubics import stores

Words = NDArray[np.int64]


class CubicInterpolator:
    """The interpolators of all axes; register I is carried from block to block."""

    def __init__(
        self, start: Words, points: int, linear: int = 1, *, historic: bool = False
    ) -> None:
        self._points, self._linear = points, linear
        self._interpolate = stores.interpolate if historic else _interpolate
        self._digits = CubicInterpolator.digits_for(points)
        self._first = np.array(start, np.int64) << self._digits

    @staticmethod
    def digits_for(points: int) -> int:
        """Binary digits behind the point that make all differences of p steps exact."""
        if points < 2 or points & (points - 1):
            raise ValueError(
                f"{points} steps to an interval are no power of two; give 2, 4, 8, 16 …"
            )
        return 3 * (points.bit_length() - 1)

    def run(self, words: Words) -> Words:
        """Register I after each step (k · p, axes) of the words (k, axes, 3), all digits."""
        if words.ndim != 3 or words.shape[1:] != (len(self._first), 3):
            raise ValueError(
                f"words of shape {words.shape} do not fit; they must be (k, {len(self._first)}, 3)"
            )
        out = np.empty((len(words) * self._points, len(self._first)), np.int64)
        self._interpolate(
            np.ascontiguousarray(words), self._points, self._linear, self._first, out
        )
        return out

    def counts(self, registers: Words) -> Words:
        """The contents of register I in whole counts, rounded."""
        return np.asarray((registers + (1 << self._digits >> 1)) >> self._digits)

    @property
    def at(self) -> Words:
        """The present place of the interpolators, whole counts."""
        return self.counts(self._first)


def ends(words: Words, points: int, linear: int = 1) -> Words:
    """Travel of register I in each interval (k, axes): p A + p(p-1)/2 A² + p(p-1)(p-2)/6 A³."""
    n = points // linear
    first = words[..., 0]
    second = words[..., 1]
    third = words[..., 2]
    pairs = n * (n - 1) // 2
    triples = n * (n - 1) * (n - 2) // 6
    return np.asarray(linear * (n * first + pairs * second + triples * third))


def slopes(words: Words, points: int, linear: int = 1) -> tuple[Words, Words]:
    """Slopes at the start and the end of each interval (k, axes), six times points · the words' unit per
    step.

    The cubic's own slope is not the first difference: x'(0) = A - A²/2 + A³/3 to a step.
    """
    n = points // linear
    first = words[..., 0]
    second = words[..., 1]
    third = words[..., 2]
    start = 6 * first - 3 * second + 2 * third
    gained = 6 * n * second - 6 * n * third + 3 * n * n * third
    return start, start + gained


@njit(cache=True)
def _interpolate(words, points, linear, first, out):  # type: ignore[no-untyped-def]
    """Step all registers through all intervals."""
    for axis in range(words.shape[1]):
        one = first[axis]
        row = 0
        for k in range(len(words)):
            two, three, four = words[k, axis, 0], words[k, axis, 1], words[k, axis, 2]
            if linear == 1:
                for _ in range(points):
                    one, two, three = one + two, two + three, three + four
                    out[row, axis] = one
                    row += 1
                continue
            for step in range(points):
                one += two
                if step % linear == linear - 1:
                    two, three = two + three, three + four
                out[row, axis] = one
                row += 1
        first[axis] = one
