"""The median of a few numbers, quickly.

Signals in: numbers, (n,). Signals out: the middle one, or the mean of the two in the middle.

numpy's median takes as long for ten numbers as the head takes for a tenth of a millimetre. The result is the
same to the bit, also where a number is none.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike


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
