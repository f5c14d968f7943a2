"""Entered squares: about which small marks a line passes, and how near.

Signals: places of a line (n, 2) mm, and squares by their middles (m, 2) and reach to each side (m,), mm, in;
the numbers of the squares that the line enters out.

Source: our own.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit


def entered(line_mm: Array, middles_mm: Array, reach_mm: NDArray[Any]) -> NDArray[np.int64]:
    """The numbers of the squares, by middle and reach to each side, that a line enters."""
    low_mm, high_mm = line_mm.min(axis=0), line_mm.max(axis=0)
    away_mm = np.abs(middles_mm - np.clip(middles_mm, low_mm, high_mm)).max(axis=1)
    near = np.flatnonzero(away_mm <= reach_mm)
    if not len(near):
        return near  # as of most lines
    enters = np.zeros(len(near), np.bool_)
    _enters(line_mm, middles_mm[near], reach_mm[near], enters)
    return near[enters]


@njit(cache=True, _nrt=False)
def _enters(line_mm, middles_mm, reach_mm, enters):  # type: ignore[no-untyped-def]
    """Tell which squares hold a place of a line."""
    for k in range(len(middles_mm)):
        for n in range(len(line_mm)):
            x, y = line_mm[n, 0] - middles_mm[k, 0], line_mm[n, 1] - middles_mm[k, 1]
            if max(abs(x), abs(y)) <= reach_mm[k]:
                enters[k] = True
                break
