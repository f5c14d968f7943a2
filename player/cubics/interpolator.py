"""The interpolator: four registers that make a cubic by additions only.

Signals: words A, A², A³ of each interval and axis in; the position at each of the p steps of the interval
out, all in counts with 3·log2(p) binary digits behind the point, 64-bit integers.

    step n → n+1       I + II  →  I        II + III  →  II        III + IV  →  III        IV stays

All sums are of what the registers held before the step (table I). With the switch open (q > 1) only every
q-th step is such a step, and the q - 1 before it add II to I alone; the words are then those of p/q steps, A
A² A³ over q:

    I  ____╱‾    cubic, q = 1            I  ____/‾     q = 4: straight from one exact place to the next

Register I is loaded once; II, III and IV anew in each interval, so that nothing builds up.

Source: patent US 3062995, table I, figure 2 (stores I to IV, adders 50, gates 51 and 53) and figure 3
(dividers 58, 59). Questions: the text adds IV to III before III to II, which is not table I; the table holds.
The divider 59 is said to make a ratio p + q; two dividers in a row make p·q. Registers with fewer digits to
the left, as claim 9 has them, end up to 20 counts off at 16 steps, and the next interval starts there
(`truncated_end`); all four have all digits here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

Words = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class TimeBase:
    """The common time base 14: fast pulses and their dividers (figure 3's own figures)."""

    fast_hz: float = 3500.0
    word_digits: int = 16  # divider 56, n
    words_per_reading: int = 2  # divider 57, k
    readings_per_step: int = 16  # divider 58, p
    steps_per_cubic: int = 4  # divider 59, q
    steps_per_block: int = 32  # divider 60, r

    @property
    def word_hz(self) -> float:
        """Words of the registers, Hz."""
        return self.fast_hz / self.word_digits

    @property
    def reading_hz(self) -> float:
        """Readings of the position, Hz."""
        return self.word_hz / self.words_per_reading

    @property
    def carrier_hz(self) -> float:
        """Supply of the resolvers, after the flip-flop 62, Hz."""
        return self.reading_hz / 2

    @property
    def counts_per_period(self) -> int:
        """Fast pulses in a period of the carrier: counts in a pitch of the scale."""
        return 2 * self.words_per_reading * self.word_digits

    @property
    def step_hz(self) -> float:
        """Steps of the interpolator, Hz."""
        return self.reading_hz / self.readings_per_step

    @property
    def cubic_hz(self) -> float:
        """Steps that are cubic while the switch 61 is open, Hz."""
        return self.step_hz / self.steps_per_cubic

    @property
    def block_s(self) -> float:
        """Time between two blocks of the tape, s."""
        return self.steps_per_block / self.step_hz


class CubicInterpolator:
    """The interpolators of all axes; register I is carried from block to block."""

    def __init__(self, start: Words, points: int, linear: int = 1) -> None:
        self._points, self._linear = points, linear
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
        _interpolate(np.ascontiguousarray(words), self._points, self._linear, self._first, out)
        return out

    def counts(self, registers: Words) -> Words:
        """The contents of register I in whole counts, rounded."""
        return np.asarray((registers + (1 << self._digits >> 1)) >> self._digits)

    @property
    def at(self) -> Words:
        """The present place of the interpolators, whole counts."""
        return self.counts(self._first)


def table(
    start: int, words: tuple[int, int, int], steps: int
) -> list[tuple[int, int, int, int]]:
    """Table I: the four registers before the first step and after each, in whole units."""
    one, two, three, four = start, *words
    rows = [(one, two, three, four)]
    for _ in range(steps):
        one, two, three = one + two, two + three, three + four
        rows.append((one, two, three, four))
    return rows


def truncated_end(
    start: int, words: tuple[int, int, int], steps: int, digits: tuple[int, int, int, int]
) -> float:
    """End of an interval, in counts, in registers of these digits; lower digits are dropped on the way.

    The words are given with 3 log2(steps) digits, as ever.
    """
    full = CubicInterpolator.digits_for(steps)
    held = [
        start << digits[0],
        *(_moved(word, full, own) for word, own in zip(words, digits[1:], strict=True)),
    ]
    for _ in range(steps):
        for i in range(3):
            held[i] += _moved(held[i + 1], digits[i + 1], digits[i])
    return held[0] / 2 ** digits[0]


def ends(words: Words, points: int, linear: int = 1) -> Words:
    """Travel of register I in each interval (k, axes): p A + p(p-1)/2 A² + p(p-1)(p-2)/6 A³."""
    n = points // linear
    first, second, third = words[..., 0], words[..., 1], words[..., 2]
    return np.asarray(
        linear * (n * first + n * (n - 1) // 2 * second + n * (n - 1) * (n - 2) // 6 * third)
    )


def slopes(words: Words, points: int, linear: int = 1) -> tuple[Words, Words]:
    """Slopes at the start and the end of each interval (k, axes), six times points · the words' unit per
    step.

    The cubic's own slope is not the first difference: x'(0) = A - A²/2 + A³/3 to a step.
    """
    n = points // linear
    first, second, third = words[..., 0], words[..., 1], words[..., 2]
    start = 6 * first - 3 * second + 2 * third
    return start, start + 6 * n * second - 6 * n * third + 3 * n * n * third


def _moved(word: int, digits: int, to_digits: int) -> int:
    """A word with other digits behind the point; lower digits are dropped."""
    return word << to_digits - digits if to_digits >= digits else word >> digits - to_digits


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
