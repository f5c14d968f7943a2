"""Lines and rims: a drawing of lines and solid areas as a program for both runs along its ink.

Signals: a Drawing that was read for both in; out a Drawing of lines alone: those of the sheet, and for each
solid area a line along its edge, as broad as the others; or the lines without the solid areas, and these.

    ━━━━━━●      ━━━━━━○      so that the middle of the ink is measured for outlines as it is for strokes

Source: our own; the measures of `compare` know nothing but lines.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.drawing.depth import depth_px
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.shapes import NoShape, ShapeCut, pen_along
from morfax.tracer.drawing.shapes_among_lines import edges_of, has_lines
from morfax.tracer.drawing.solids import usual_width_px
from morfax.tracer.ink.left_out import Area, InkLeft, ink_left


def lines_and_rims(drawing: Drawing) -> Drawing:
    """A drawing of both with lines in place of solid areas; any other as it is."""
    if not drawing.both:
        return drawing
    if not has_lines(drawing):
        return edges_of(drawing)
    left = ink_left(drawing.sheet)
    darkness = left.drawing.darkness
    rims = _rims_px(drawing, left)
    if rims:
        width_px = usual_width_px(depth_px(left.ink))
        darkness = np.maximum(darkness, pen_along(rims, darkness.shape, width_px))
    return replace(drawing, darkness=darkness, both=False)


def lines_and_areas(drawing: Drawing) -> tuple[Drawing, tuple[Area, ...]]:
    """A drawing of both without its solid areas, and these; of silhouettes their edges."""
    if not has_lines(drawing):
        return edges_of(drawing), ()
    left = ink_left(drawing.sheet)
    areas = tuple(area for area in left.areas if area.what == "solid area")
    return replace(left.drawing, both=False), areas


def _rims_px(drawing: Drawing, left: InkLeft) -> list[Array]:
    """The edges (n, 2) of the solid areas, rows and columns."""
    if not left.packed_solid.any():
        return []
    try:
        edges_mm = edges_of(drawing, left.solid).edges_mm
    except (NoShape, ShapeCut):
        return []
    rows, pitch_mm = len(drawing.darkness), drawing.pitch_mm
    return [
        np.column_stack([rows - edge[:, 1] / pitch_mm, edge[:, 0] / pitch_mm]) - 0.5
        for edge in edges_mm
    ]
