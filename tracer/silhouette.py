"""Silhouettes: the edge of a filled shape as the cells see it behind a mask that passes light on the edge only, so that the head rides on it as on a line.

Signals: grey levels in; out darkness 0..1 of a line of `EDGE_MM` whose middle is where the shape is half as dark as it is inside.

The line is as a round pen would draw it along the edge: dark where the edge is within half the line's width. So corners look as inked corners do, and the head
takes them as it takes those: it finds its way by its own cells, and the mask is not its path.

Source: our own; the patent's follower has lines only. Questions: paper is what is lighter than the best threshold (Otsu), and is taken for even.
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from motion.faults import DrawingFault
from motion.offset import with_places

EDGE_MM = 1.0  # narrower, a corner that the scan has rounded is taken for a round one
SOFT_PX = 0.7  # standard deviation: against the noise of the paper
LEAST_MM = 4.0  # a shorter outline is a speck's
LEAST_CONTRAST = 20.0  # levels


def outlined(grey: NDArray[Any], pitch_mm: float) -> NDArray[np.float32]:
    """Darkness of the line along the edges of filled shapes; raises DrawingFault if there are none."""
    from scipy.spatial import cKDTree
    from skimage.measure import find_contours

    soft = cv2.GaussianBlur(grey.astype(np.float32), (0, 0), SOFT_PX)
    split, _ = cv2.threshold(np.clip(soft, 0, 255).astype(np.uint8), 0, 255, cv2.THRESH_OTSU)
    paper, shape = (
        float(np.median(part)) if part.size else split for part in (soft[soft > split], soft[soft <= split])
    )
    edges = [edge for edge in find_contours(soft, (paper + shape) / 2) if _length_mm(edge, pitch_mm) > LEAST_MM]
    if not edges or paper - shape < LEAST_CONTRAST:
        raise DrawingFault("no filled shape on the drawing: nothing on it has an edge; leave --edge out for lines")
    near = np.zeros(soft.shape, np.uint8)
    reach_px = EDGE_MM / pitch_mm
    for edge in edges:
        points = np.round(edge[:, ::-1]).astype(np.int32)
        cv2.polylines(near, [points], False, 1, 2 * round(reach_px) + 1)
    rows, columns = np.nonzero(near)
    tree = cKDTree(np.vstack([with_places(edge, 0.2) for edge in edges]))
    away_px = tree.query(np.column_stack([rows, columns]))[0]
    darkness = np.zeros(soft.shape, np.float32)
    darkness[rows, columns] = np.clip(0.5 * reach_px - away_px + 0.5, 0, 1)
    return darkness


def _length_mm(edge: NDArray[np.float64], pitch_mm: float) -> float:
    return float(np.hypot(*np.diff(edge, axis=0).T).sum()) * pitch_mm
