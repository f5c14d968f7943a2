"""The median of numbers, quickly.

Signals in: numbers, (n,). Signals out: the middle one, or the mean of the two in the middle.

numpy's median takes as long for ten numbers as the head takes for a tenth of a millimetre, and it imports
numpy's masked arrays. The result is the same to the bit, also where a number is none.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray


def median(values: ArrayLike) -> float:
    """The median of numbers (n,); not a number if one of them is none, or if there are none."""
    ordered = np.sort(values)
    if not len(ordered):
        return math.nan
    last = float(ordered[-1])  # numbers that are none come last
    if math.isnan(last):
        return last
    count = len(ordered)
    return 0.5 * (float(ordered[(count - 1) // 2]) + float(ordered[count // 2]))


def medians(values: NDArray[np.floating]) -> NDArray[np.floating]:
    """The medians of numbers (…, n) along their last axis; none of them is no number."""
    ordered, count = np.sort(values, axis=-1), values.shape[-1]
    return 0.5 * (ordered[..., (count - 1) // 2] + ordered[..., count // 2])
