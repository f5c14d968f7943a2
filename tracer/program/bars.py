"""Bars of ink beside lines: what is joined to a line, and along which no line runs.

Signals: the drawing, the lines on it, and a place on ink beside them in; places (n, 2) mm of the bar out.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.program.unexplained import Unexplained
from morfax.tracer.tangles.seen_ink import middles_mm

OF_WIDTH = 1.3  # about a way ink is the line's own
ABOUT = 2.0  # times as far as the ink reaches from the line, and ...
ABOUT_WIDTHS = 3.0  # ... so much more, its bar is looked for about its furthest place
# widths: the ink of a bay is two lines thick at the least; it may come to a point, and a part of it at the
# mouth counts as the line's own
THICK = 1.2, 4.0
NOTHING = np.empty((0, 2))


def bar_at(
    drawing: Drawing, lines: Sequence[Line], place: Unexplained, width_mm: float
) -> Array:
    """The places of the bar of ink at a place beside the lines; none of a single line's, or of one that
    goes on further away.
    """
    pitch_mm, rows = drawing.pitch_mm, len(drawing.darkness)
    # 1. the ink about the place
    about = int((ABOUT * place.length_mm + ABOUT_WIDTHS * width_mm) / pitch_mm)
    column, row = int(place.place_mm[0] / pitch_mm), int(rows - place.place_mm[1] / pitch_mm)
    left, top = max(column - about, 0), max(row - about, 0)
    part = drawing.darkness[top : row + about + 1, left : column + about + 1]
    bare = (np.asarray(part, float) > INK).astype(np.uint8)
    # 2. without that of the lines
    wide_px = max(1, round(OF_WIDTH * width_mm / pitch_mm))
    for line in lines:
        way = np.column_stack([line.places_mm[:, 0], rows * pitch_mm - line.places_mm[:, 1]])
        way_px = np.round(way / pitch_mm - 0.5 - (left, top)).astype(np.int32)
        cv2.polylines(bare, [way_px.reshape(-1, 1, 2)], line.comes_round, 0, wide_px)
    # 3. what is joined to the place
    _, label = cv2.connectedComponents(bare, connectivity=4)
    i, j = np.nonzero(label)
    if not len(i):
        return NOTHING
    nearest = int(np.argmin(np.hypot(i - (row - top), j - (column - left))))
    i, j = np.nonzero(label == label[i[nearest], j[nearest]])
    goes_on = min(i.min(), j.min()) == 0 or i.max() == len(bare) - 1
    if goes_on or j.max() == bare.shape[1] - 1:
        return NOTHING
    bar = middles_mm(drawing, i + top, j + left)
    return bar if _is_thick(bar, pitch_mm, width_mm) else NOTHING


def _is_thick(bar: Array, pitch_mm: float, width_mm: float) -> bool:
    """Whether a bar is thicker than one line, and no thicker than two with a narrow bay between."""
    sides_mm = cv2.minAreaRect((bar - bar[0]).astype(np.float32))[1]
    thick_mm = len(bar) * pitch_mm**2 / (max(sides_mm) + pitch_mm)
    least, most = THICK
    return least * width_mm < thick_mm < most * width_mm
