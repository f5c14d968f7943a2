"""A drawing with the operator's corrections on it: ink rubbed out and drawn, and the rest for the head.

Signals: a Drawing, the size of its picture and Corrections in; the drawing out whose darkness has the
corrections' ink, and which carries their turns, stops and start in sheet mm (`corrected`).

Levels are not taken anew: what is rubbed out or drawn changes no ink elsewhere on the sheet.

Source: our own. Questions: the edges of filled shapes are a line that was made from the picture, so the
rubber and the pen cannot serve there: the picture itself has to be changed.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from morfax.motion.faults import CardFault
from morfax.tracer.corrections.corrections import RUBBED, Corrections
from morfax.tracer.corrections.on_sheet import OnSheet, SheetSize
from morfax.tracer.corrections.rubber_and_pen import DrawingPen, Easel
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.levelling import Shapes

# where no line shows how wide the pen is and how soft its edges are: a drawing pen at 300 dpi
USUAL = DrawingPen(0.5, 0.05)


def corrected(
    drawing: Drawing, corrections: Corrections, size_px: tuple[int, int] | None = None
) -> Drawing:
    """A drawing with corrections; `size_px` are columns and rows of its picture, if it is not as it was read.

    Raises CardFault for corrections of another picture, and for ink on the edges of filled shapes.
    """
    rows, columns = drawing.darkness.shape
    size = SheetSize(drawing.width_mm, drawing.height_mm, *(size_px or (columns, rows)))
    laid = size.laid(corrections)
    if not laid.strokes:
        return replace(drawing, corrected=laid)
    if drawing.edges_mm:
        raise CardFault(
            f"{corrections.file or 'the file of corrections'} rubs out or draws ink, which does not work"
            " with --edge: change the picture itself, or leave --edge or those corrections out"
        )
    darkness = drawing.darkness.copy()
    changed = Easel(darkness, drawing.pitch_mm, _pen(drawing)).drawn(laid.strokes)
    return replace(
        drawing,
        darkness=darkness,
        shapes=_shapes(drawing, laid),
        corrected=replace(laid, ink_changed=changed),
        bare=drawing if changed else None,
        drawn=None,  # nothing was rubbed out there
    )


def _pen(drawing: Drawing) -> DrawingPen:
    """The drawing's usual pen."""
    noise = drawing.noise
    if not (math.isfinite(noise.width_mm) and math.isfinite(noise.softness_mm)):
        return USUAL
    return DrawingPen(noise.width_mm, noise.softness_mm)


def _shapes(drawing: Drawing, laid: OnSheet) -> Shapes | None:
    """Where filled shapes are, without those that were rubbed out."""
    if drawing.shapes is None:
        return None
    rubbed = tuple(stroke for stroke in laid.strokes if stroke.do in RUBBED)
    left = drawing.shapes.astype(np.float32)
    pitch_mm = drawing.pitch_mm * math.ceil(len(drawing.darkness) / len(left))
    Easel(left, pitch_mm, USUAL).drawn(rubbed)
    return np.asarray(left > 0.5)
