"""Nesting: which closed line lies inside which.

Signals: lines (n, 2) mm in; yes or no for each pair out.

Source: our own. Questions: lines that cross each other lie in neither; the one that reaches less far is asked
by its first place only.
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array, bounds


def nested(lines_mm: Sequence[Array], round_about: Sequence[bool]) -> NDArray[np.bool_]:
    """Which line (n, 2) mm lies inside which: `nested[i, j]` if j goes round about and i lies inside it."""
    inside = np.zeros((len(lines_mm), len(lines_mm)), bool)
    if not len(lines_mm):
        return inside
    # a line can only lie in one that reaches further, and whose box its first place is in
    firsts = np.array([line[0] for line in lines_mm], np.float32)
    wide_mm, high_mm = np.array([size_mm(line) for line in lines_mm]).T.copy()
    x_mm, y_mm = firsts.T.copy()
    outlines = [np.asarray(line, np.float32) for line in lines_mm]
    for j, outline in enumerate(outlines):
        if not round_about[j]:
            continue
        (left_mm, low_mm), (right_mm, top_mm) = bounds(outline)
        may = (wide_mm < wide_mm[j]) & (high_mm < high_mm[j])
        may &= (x_mm >= left_mm) & (x_mm <= right_mm) & (y_mm >= low_mm) & (y_mm <= top_mm)
        for i in np.flatnonzero(may):
            inside[i, j] = lies_inside(lines_mm[int(i)], lines_mm[j])
    return inside


def lies_inside(inner_mm: Array, outer_mm: Array) -> bool:
    """Whether a line begins inside another, taken for closed, and reaches less far than that one."""
    x = float(inner_mm[0, 0])
    y = float(inner_mm[0, 1])
    # two lines cannot each lie in the other: otherwise no order of cutting would do
    if not (size_mm(inner_mm) < size_mm(outer_mm)).all():
        return False
    return cv2.pointPolygonTest(np.asarray(outer_mm, np.float32), (x, y), False) > 0


def size_mm(line_mm: Array) -> Array:
    """How wide and how high a line (n, 2) mm is, (2,) mm."""
    low, high = bounds(line_mm)
    return high - low
