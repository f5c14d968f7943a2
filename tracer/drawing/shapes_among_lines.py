"""Shapes among lines: a scan read for both, its lines and the edges of its solid areas.

Signals: grey levels in; out a drawing of lines on which solid areas are as dark as lines, whether that has
lines at all, and a drawing of edges: those of its solid areas, or of all.

    ━━━━━━━━━▶      the line is followed along its middle, and ends at the arrowhead; the arrowhead is cut
                    off from it, and has an outline of its own

Ink is a drawing of lines if most of its middle line lies in ink that is about as wide as is usual, and no
broader than pens draw. All other drawings are silhouettes: their thin parts belong to the shapes.

Source: our own. Questions: with the edges of all that is on a sheet, lines would be shapes too, and be gone
round on both sides.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from morfax.tracer.drawing.border import border_note, without_border
from morfax.tracer.drawing.components import FRINGE_PX, INK, SOFTENED_PX, Mask
from morfax.tracer.drawing.depth import depth_px
from morfax.tracer.drawing.discs import disc
from morfax.tracer.drawing.drawing import Darkness, Drawing
from morfax.tracer.drawing.inks import Ink, grey_of
from morfax.tracer.drawing.lengths import ONE_PEN
from morfax.tracer.drawing.reading import Reading
from morfax.tracer.drawing.ruling import PaperKind
from morfax.tracer.drawing.scale import Scale, on_square_pixels
from morfax.tracer.drawing.scan import Scan
from morfax.tracer.drawing.shapes import outlined, shade_of
from morfax.tracer.drawing.solids import ridge_of, usual_width_px

BLACK = 255.0  # grey levels between paper and shape
BROADEST_MM = 2.0  # of a line: the broadest of ISO 128-2
MOST = 0.6  # of the middle line, which is in lines; by trial
MOSTLY_SHAPES = (
    "most of the ink is filled shapes, broader than lines, and their insides are left out: --edge follows "
    "their outlines"
)


def drawing_of_both(scan: Scan, scale: Scale, ink: Ink | None = None) -> Drawing:
    """Read a scan for its lines and its solid areas; raises DrawingFault for a missing scale, and without
    anything that is darker than paper.
    """
    pitch_mm, pitch_down_mm = scale.pitches_mm(scan)
    grey = grey_of(scan.pixels, ink, None)
    grey = on_square_pixels(grey, (pitch_mm, pitch_down_mm))
    darkness = shade_of(grey, pitch_mm)
    notes = (*scan.notes, *scale.notes(scan))
    edges = without_border(darkness)
    if edges:
        notes = (*notes, border_note(edges))
    file, is_rendered = scan.file, scan.is_rendered
    return Drawing(darkness, pitch_mm, file, notes=notes, both=True, is_rendered=is_rendered)


def drawing_of_all_ink(
    scan: Scan, scale: Scale, ink: Ink | None, printed: PaperKind
) -> Drawing:
    """Read a scan of lines for all its ink; filled shapes among lines are ink, too, if there are lines.

    Raises what `Drawing.of` raises.
    """
    reading = Reading(printed=printed, shapes_are_ink=True, pale_is_ink=True)
    drawing = Drawing.of(scan, scale, ink, reading)
    if not drawing.has_shapes or has_lines(drawing):
        return drawing
    lines = Drawing.of(scan, scale, ink, reading._replace(shapes_are_ink=False))
    return replace(lines, notes=(*lines.notes, MOSTLY_SHAPES))


def has_lines(drawing: Drawing) -> bool:
    """Whether a drawing of lines is one, and no sheet of silhouettes."""
    ink = (drawing.darkness > INK).view(np.uint8)
    depth = depth_px(ink)
    usual_px = usual_width_px(depth)
    if usual_px * drawing.pitch_mm > BROADEST_MM:
        return False
    widths_px = 2 * ridge_of(depth) - 1
    if not len(widths_px):
        return False
    return bool(np.mean(np.abs(widths_px - usual_px) < ONE_PEN * usual_px + 1) > MOST)


def edges_of(drawing: Drawing, solid: Mask | None = None) -> Drawing:
    """The edges of the solid areas of a drawing of lines, or of all; raises NoShape if what is there is too
    small for --edge, and ShapeCut if the border of the sheet cuts it.
    """
    share = drawing.darkness if solid is None else _only(drawing.darkness, solid)
    rims = outlined(np.asarray(BLACK * (1 - share), np.float32), drawing.pitch_mm)
    pitch_mm = drawing.pitch_mm / rims.finer
    return Drawing(
        rims.darkness,
        pitch_mm,
        drawing.file,
        rims.finer,
        rims.edges_mm,
        rims.shade,
        notes=rims.notes,
    )


def _only(darkness: Darkness, solid: Mask) -> Darkness:
    """The darkness of solid areas with their soft rims, and without the lines that end at them."""
    about = np.asarray(cv2.dilate(solid, disc(FRINGE_PX)), np.uint8)
    lines = (darkness > INK).view(np.uint8) & about & (1 - solid)
    lines = np.asarray(cv2.dilate(lines, np.ones((3, 3), np.uint8)), np.uint8)
    kept = (about & (1 - lines)) | solid
    return np.asarray(cv2.GaussianBlur(kept.astype(np.float32), (0, 0), SOFTENED_PX) * darkness)
