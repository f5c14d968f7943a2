"""What the packages call arrays: the one short name for an array of float64, and what is often done."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit

Array = NDArray[np.float64]


def moved(rows: Array, by: Array, scale: float = 1.0) -> Array:
    """Rows (n, columns) times a scale, and moved by a length for each column.

    numpy takes eight times as long: it goes over rows of three columns one by one.
    """
    out = np.empty(rows.shape)
    _move(rows, by, scale, out)
    return out


def between(values: Array, at: float) -> float:
    """The value at a place, counted from the first: straight between two, and beyond the ends theirs."""
    place = min(max(at, 0.0), len(values) - 1.0)
    low = min(int(place), max(len(values) - 2, 0))
    return float(
        values[low] + (place - low) * (values[min(low + 1, len(values) - 1)] - values[low])
    )


@njit(cache=True, nogil=True)
def _move(rows, by, scale, out):  # type: ignore[no-untyped-def]
    """Fill `out`."""
    for column in range(rows.shape[1]):
        for row in range(len(rows)):
            out[row, column] = rows[row, column] * scale + by[column]


@njit(cache=True, nogil=True)
def median(values):  # type: ignore[no-untyped-def]
    """The median of some values, for kernels; nan where one is."""
    half, largest = len(values) // 2, -np.inf
    for value in values:
        if np.isnan(value):
            return np.nan
    if not half:
        return float(values[0]) if len(values) else np.nan
    ordered = np.partition(values, half)
    if len(values) % 2:
        return float(ordered[half])
    for value in ordered[:half]:
        largest = max(largest, float(value))
    return (largest + ordered[half]) / 2
