"""Two lines that come nearer to each other than a pen's width."""

from __future__ import annotations

import numpy as np

from tests.tracer.inked import WIDTH_MM, Points, polyline

LONG_MM = 40.0
CLEAR = polyline((5, 40), (55, 40))  # a line by itself


def near_lines(crossed: bool) -> tuple[Points, Points]:
    """Two lines apart by three widths at their ends, by 0.8 widths and less for 25 mm in between.

    They change sides in the middle, or they touch there.
    """
    along = np.linspace(-1, 1, 400)
    apart_mm = WIDTH_MM * (2.4 * along**5 + 0.8 * along)
    if not crossed:
        apart_mm = WIDTH_MM * (2.2 * along**6 + 0.8 * along**2)
    x = 30 + 0.5 * LONG_MM * along
    return (
        np.column_stack([x, 20 + 0.5 * apart_mm]),
        np.column_stack([x, 20 - 0.5 * apart_mm]),
    )
