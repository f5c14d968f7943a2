"""Weighing: the lengths of lines that are nearly of one length, by all of their darkness.

    length = darkness of the line's ink, added up, over the pen's width; less the two round ends of an open
             line, which are ink beyond its length

Where ink ends, a scan shows a corner or a narrow bay a little fuller at another size or angle, so that the
pixels that are darker than half are up to 6 % more or fewer. Their darkness stays within about 1 %, since no
lens makes ink more or less.

Signals: a sheet's patches of ink and their lengths by area, mm, in; their lengths, mm, out.

Source: our own. Questions: the ink of a net's junctions counts once, as in the lengths by area.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.tracer.drawing.components import FRINGE_PX
from morfax.tracer.drawing.holes import holes_in
from morfax.tracer.effort import MANY
from morfax.tracer.limits import ROUND

if TYPE_CHECKING:
    from morfax.tracer.drawing.strokes import Sheet

# share by which lengths by area may be off against each other, and as much again
NEAR = 0.1


class Weight(NamedTuple):
    """The darkness of a patch of ink, added up, mm2, and whether it goes round nothing."""

    weight_mm2: float
    is_open: bool


def weighed_mm(sheet: Sheet, patches: NDArray[np.int64], lengths_mm: Array) -> Array:
    """The lengths of some patches: of those that have others of nearly their length, by weight."""
    order = np.argsort(lengths_mm)
    is_near = np.diff(lengths_mm[order]) < NEAR * lengths_mm[order][:-1]
    near = order[np.r_[is_near, False] | np.r_[False, is_near]]
    if not 2 <= len(near) <= MANY:
        return lengths_mm
    # 1. their ink over the width that the lengths by area were taken with
    areas_mm2 = sheet.lengths_mm[patches[near]] * sheet.widths_mm[patches[near]]
    pens_mm = areas_mm2 / lengths_mm[near]
    inks = [_ink_of(sheet, int(patch)) for patch in patches[near]]
    weights_mm2 = np.array([ink.weight_mm2 for ink in inks])
    is_open = np.array([ink.is_open for ink in inks])
    by_weight_mm = weights_mm2 / pens_mm - np.where(is_open, ROUND * pens_mm, 0.0)
    # 2. the scan's own levels make all of them longer or shorter alike
    weighed = lengths_mm.copy()
    weighed[near] = by_weight_mm * median(lengths_mm[near] / by_weight_mm)
    return weighed


def _ink_of(sheet: Sheet, patch: int) -> Weight:
    """The weight of a patch of ink; kept, as it is asked for again and again."""
    if patch not in sheet.weights:
        sheet.weights[patch] = _weigh(sheet, patch)
    return sheet.weights[patch]


def _weigh(sheet: Sheet, patch: int) -> Weight:
    """Weigh a patch of ink."""
    rows, columns = sheet.drawing.darkness.shape
    top, bottom, left, right = sheet.patches.boxes[patch].tolist()
    top, left = max(0, top - FRINGE_PX), max(0, left - FRINGE_PX)
    bottom, right = min(rows, bottom + FRINGE_PX), min(columns, right + FRINGE_PX)
    ink = np.asarray(sheet.patches.painted(patch, top, bottom, left, right), np.uint8)
    about = cv2.dilate(ink, np.ones((2 * FRINGE_PX + 1,) * 2, np.uint8)) > 0
    dark = np.asarray(sheet.drawing.darkness[top:bottom, left:right])
    weight_mm2 = float(dark[about].sum()) * sheet.drawing.pitch_mm**2
    return Weight(weight_mm2, not holes_in(sheet.patches, patch))
