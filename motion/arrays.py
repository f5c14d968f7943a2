"""What the packages call arrays: the one short name for an array of float64, and what is often done."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit

Array = NDArray[np.float64]
NOT_ZERO = 1e-12  # what divides is this at least: a length, a share, a time
ROUNDED_SQUARE = 1e-14  # share of a sum of squares that rounding leaves of none
AS_WRITTEN = 1e-6  # share of a figure by which it is rounded where it is written, at the most
ROUNDED = 1e-9  # share of a figure, or of a step, that rounding adds at the most


def bounds(rows: NDArray[np.floating]) -> tuple[Array, Array]:
    """The lowest and the highest of each column of rows (n, columns).

    Row by row in a kernel: along the rows of two columns numpy takes thirty times as long. Raises ValueError
    if there is none.
    """
    if not len(rows):
        raise ValueError("no rows have no lowest and no highest; there must be one at least")
    ends = np.empty((2, rows.shape[1]))
    _ends(np.ascontiguousarray(rows, float), ends)
    return ends[0], ends[1]


@njit(cache=True, _nrt=False)
def _ends(rows, ends):  # type: ignore[no-untyped-def]
    """Fill in the lowest and the highest of each column; nan where one of it is."""
    for column in range(rows.shape[1]):
        low = high = rows[0, column]
        for k in range(len(rows)):
            value = rows[k, column]
            if np.isnan(value):
                low = high = value
                break
            low, high = min(low, value), max(high, value)
        ends[0, column], ends[1, column] = low, high


def between(values: Array, at: float) -> float:
    """The value at a place, counted from the first: straight between two, and beyond the ends theirs."""
    place = min(max(at, 0.0), len(values) - 1.0)
    low = min(int(place), max(len(values) - 2, 0))
    high = min(low + 1, len(values) - 1)
    return float(values[low] + (place - low) * (values[high] - values[low]))


@njit(cache=True, nogil=True)
def median(values):  # type: ignore[no-untyped-def]
    """The median of some values, for kernels; nan where one is."""
    count = len(values)
    for value in values:
        if np.isnan(value):
            return np.nan
    if count < 2:
        return float(values[0]) if count else np.nan
    ordered, half = values.copy(), count // 2
    upper = float(_settled(ordered, half))
    if count % 2:
        return upper
    largest = float(ordered[0])
    for at in range(1, half):
        largest = max(largest, float(ordered[at]))
    return (largest + upper) / 2


@njit(cache=True, nogil=True)
def _settled(values, at):  # type: ignore[no-untyped-def]
    """The value at a place of the ordered values, which are moved so that none before it is larger."""
    first, last = 0, len(values) - 1
    while first < last:
        # 1. the smaller ones to the front, without a branch: which way it goes cannot be foreseen
        pivot, low = values[(first + last) // 2], first
        for k in range(first, last + 1):
            value, values[k] = values[k], values[low]
            values[low] = value
            low += value < pivot
        if at < low:
            last = low - 1
            continue
        # 2. then those that are as large
        high = low
        for k in range(low, last + 1):
            value, values[k] = values[k], values[high]
            values[high] = value
            high += value <= pivot
        if at < high:
            break
        first = high
    return values[at]
