"""Hairlines: drawn lines of a PDF thinner than three pixels are rendered three pixels wide.

    width in the file         rendered
    0, which CAD writes  ->   3 pixels     else one pixel at any resolution: too few for the head, and a finer
    0.02 mm              ->   3 pixels     page would not help
    0.5 mm               ->   0.5 mm

Signals: a page, and how many pixels a point has, in; the page's lines changed, in memory alone, out.

Source: ISO 32000-1 (PDF 1.7), 8.4.3.2: a line of width 0 is the thinnest that can be rendered; its middle is
what is meant. Questions: lines nearer than three pixels to each other become one, as lines that near are on
one pixel each; a higher resolution parts them.
"""

from __future__ import annotations

import math
from ctypes import c_float, c_int
from typing import TYPE_CHECKING

from morfax.tracer.drawing.coarse import FEWEST_PX

if TYPE_CHECKING:
    from pypdfium2 import PdfObject, PdfPage

LEAST_PX = math.ceil(FEWEST_PX)


def widen(page: PdfPage, per_pt: float) -> None:
    """Make each stroked line of a page `LEAST_PX` wide at so many pixels per point, if it is thinner."""
    import pypdfium2.raw as raw

    for line in page.get_objects([raw.FPDF_PAGEOBJ_PATH]):
        width, fill, is_stroked = c_float(), c_int(), c_int()
        raw.FPDFPath_GetDrawMode(line, fill, is_stroked)
        raw.FPDFPageObj_GetStrokeWidth(line, width)
        wide_px = _times(line) * per_pt
        if is_stroked and wide_px and width.value * wide_px < LEAST_PX:
            raw.FPDFPageObj_SetStrokeWidth(line, LEAST_PX / wide_px)


def _times(line: PdfObject) -> float:
    """How many points of the page one of a line's own units is, if it is the same in X and Y, or between."""
    matrix, form = line.get_matrix(), line.container
    while form is not None:
        matrix, form = matrix.multiply(form.get_matrix()), form.container
    return math.sqrt(abs(matrix.a * matrix.d - matrix.b * matrix.c))
