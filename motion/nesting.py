"""Nesting: which closed line lies inside which."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array


def nested(lines_mm: Sequence[Array], round_about: Sequence[bool]) -> NDArray[np.bool_]:
    """Which line (n, 2) mm lies inside which: `nested[i, j]` if i lies inside j, and j goes round about
    something.
    """
    inner = [
        [
            round_j and a is not b and lies_inside(a, b)
            for b, round_j in zip(lines_mm, round_about, strict=True)
        ]
        for a in lines_mm
    ]
    return np.array(inner, bool).reshape(len(lines_mm), len(lines_mm))


def lies_inside(inner_mm: Array, outer_mm: Array) -> bool:
    """Whether a line begins inside another, whose end is joined to its start, and reaches less far than that
    one.
    """
    x, y = float(inner_mm[0, 0]), float(inner_mm[0, 1])
    if not (np.ptp(inner_mm, axis=0) < np.ptp(outer_mm, axis=0)).all():
        return False  # lines that cross are in neither's inside: an order there must be
    return cv2.pointPolygonTest(np.asarray(outer_mm, np.float32), (x, y), False) > 0
