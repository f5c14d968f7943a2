"""The median of numbers, quickly.

Signals in: numbers, (n,). Signals out: the middle one, or the mean of the two in the middle.

numpy's median takes as long for ten numbers as the head takes for a tenth of a millimetre, and it imports
numpy's masked arrays. The result is the same to the bit, also where a number is none.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

ROBUST = 1.4826  # standard deviations to a median absolute deviation of normal noise
MIDDLE = 50.0  # percentile: the median
ONE_BELOW = 15.87  # percentile one standard deviation below it, ...
ONE_ABOVE = 2 * MIDDLE - ONE_BELOW  # ... and above
TWO_BELOW = 2.28  # two below
NEARLY_ALL = 95.0  # percentile: what lies above are the exceptions
OUTLIERS = 3.0  # robust standard deviations: what is further off is left out
MANY = 500  # numbers: to find their middle takes less time than to put them in order


def median(values: ArrayLike) -> float:
    """The median of numbers (n,); not a number if one of them is none, or if there are none."""
    if isinstance(values, np.ndarray) and len(values) > MANY:
        return _middle(values)
    ordered = np.sort(values)
    if not len(ordered):
        return math.nan
    last = float(ordered[-1])  # numbers that are none come last
    if math.isnan(last):
        return last
    count = len(ordered)
    return 0.5 * (float(ordered[(count - 1) // 2]) + float(ordered[count // 2]))


def _middle(values: NDArray[np.floating]) -> float:
    """The same of many numbers: only the middle one finds its place."""
    half = len(values) // 2
    parted = np.partition(values, half)
    if math.isnan(parted[half:].max()):  # numbers that are none come last
        return math.nan
    upper = float(parted[half])
    lower = upper if len(values) % 2 else float(parted[:half].max())
    return 0.5 * (lower + upper)


def percentile(
    values: NDArray[np.floating], percent: float, kind: type[np.floating] | None = None
) -> float:
    """The number below which so many percent of numbers (n,) lie: straight between two; n is not 0.

    numpy calculates in the type of the numbers, which may be given otherwise.
    """
    kind = kind or values.dtype.type
    at = (len(values) - 1) * (percent / 100)
    below = int(at)
    parted = np.partition(values, below)
    low = parted[below]
    high = parted[below + 1 :].min() if below + 1 < len(parted) else low
    step, share = kind(high - low), at - below
    if share < 0.5:
        return float(kind(low) + step * share)
    return float(kind(high) - step * (1 - share))


def medians(values: NDArray[np.floating]) -> NDArray[np.floating]:
    """The medians of numbers (…, n) along their last axis; none of them is no number."""
    ordered = np.sort(values, axis=-1)
    count = values.shape[-1]
    return 0.5 * (ordered[..., (count - 1) // 2] + ordered[..., count // 2])


def weighted_median(values: list[float], weights: list[float]) -> float | None:
    """The value below which lies half of the weight; None of none."""
    if not values:
        return None
    order = np.argsort(values)
    sums = np.cumsum(np.asarray(weights)[order])
    return float(np.asarray(values)[order][np.searchsorted(sums, 0.5 * sums[-1])])
