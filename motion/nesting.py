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

from morfax.motion.arrays import Array


def nested(lines_mm: Sequence[Array], round_about: Sequence[bool]) -> NDArray[np.bool_]:
    """Which line (n, 2) mm lies inside which: `nested[i, j]` if j goes round about and i lies inside it."""
    inside = np.zeros((len(lines_mm), len(lines_mm)), bool)
    for j, outer in enumerate(lines_mm):
        for i, inner in enumerate(lines_mm):
            inside[i, j] = round_about[j] and i != j and lies_inside(inner, outer)
    return inside


def lies_inside(inner_mm: Array, outer_mm: Array) -> bool:
    """Whether a line begins inside another, taken for closed, and reaches less far than that one."""
    x, y = float(inner_mm[0, 0]), float(inner_mm[0, 1])
    # two lines cannot each lie in the other: otherwise no order of cutting would do
    if not (np.ptp(inner_mm, axis=0) < np.ptp(outer_mm, axis=0)).all():
        return False
    return cv2.pointPolygonTest(np.asarray(outer_mm, np.float32), (x, y), False) > 0
