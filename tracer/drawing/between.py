"""Between pixels: the darkness of a sheet at any place, straight from each pixel to the next.

Signals in: darkness (rows, columns), and rows and columns of places, in pixels from the middle of the first
one. Signals out: the darkness there. Beyond the outermost pixels is paper, or what lies at the edge.

    D = (1-v)·(1-u)·D[i, j] + (1-v)·u·D[i, j+1] + v·(1-u)·D[i+1, j] + v·u·D[i+1, j+1]

Source: our own; the sum is taken in the order of scipy's `map_coordinates` of order 1, so that both give the
same to the bit on the sheet. That one takes longer to import than numpy. Questions: none.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.tracer.drawing.tiles import Tiles


def between(
    darkness: NDArray[Any] | Tiles, rows: Array, columns: Array, *, edge_goes_on: bool
) -> Array:
    """Darkness at places, of any shape; beyond the sheet that at its edge, or paper (0).

    Where a place is not a number, the darkness is none either.
    """
    if isinstance(darkness, Tiles):
        return darkness.between(rows, columns)
    at = np.column_stack([np.ravel(rows), np.ravel(columns)])
    return between_at(darkness, at, edge_goes_on=edge_goes_on).reshape(np.shape(rows))


def between_at(darkness: NDArray[Any] | Tiles, places: Array, *, edge_goes_on: bool) -> Array:
    """The same at places (…, 2), rows and columns, which lie together."""
    if isinstance(darkness, Tiles):
        return darkness.between(places[..., 0], places[..., 1])
    out = np.empty(places.shape[:-1])
    at = places.reshape(-1, 2)
    _read(np.ascontiguousarray(darkness), at, edge_goes_on, out.reshape(-1))
    return out


@njit(cache=True, nogil=True)
def _read(darkness: NDArray[Any], at: Array, edge_goes_on: bool, out: Array) -> None:
    """Fill in the darkness at places (n, 2), rows and columns."""
    last_row, last_column = darkness.shape[0] - 1, darkness.shape[1] - 1
    for k in range(len(out)):
        if np.isnan(at[k, 0] + at[k, 1]):
            out[k] = np.nan
            continue
        row = min(max(at[k, 0], 0.0), float(last_row))
        column = min(max(at[k, 1], 0.0), float(last_column))
        if not edge_goes_on and (row != at[k, 0] or column != at[k, 1]):
            out[k] = 0.0
            continue
        i, j = int(row), int(column)
        v, u = row - i, column - j
        below, right = min(i + 1, last_row), min(j + 1, last_column)
        seen = 0.0 + darkness[i, j] * (1 - v) * (1 - u)
        seen += darkness[i, right] * (1 - v) * u
        seen += darkness[below, j] * v * (1 - u)
        seen += darkness[below, right] * v * u
        out[k] = seen
