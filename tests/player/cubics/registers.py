"""Registers worked out beside the compiled ones: table I, registers with fewer digits, and the scales."""

from __future__ import annotations

import numpy as np

from morfax.player.cubics.interpolator import CubicInterpolator
from morfax.player.cubics.scales import Scales, joined, read_scales
from morfax.player.cubics.time_base import TimeBase


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


def _moved(word: int, digits: int, to_digits: int) -> int:
    """A word with other digits behind the point; lower digits are dropped."""
    return word << to_digits - digits if to_digits >= digits else word >> digits - to_digits


def codes(positions: np.ndarray, scales: Scales) -> np.ndarray:
    """What the historic control reads at positions in counts, each in the middle of its count."""
    settings = scales.table(TimeBase())
    found = [read_scales(x + 0.5, 0.0, 0.0, settings) for x in positions]
    return np.array([(*both, joined(*both, scales.pitch_counts)) for both in found])
