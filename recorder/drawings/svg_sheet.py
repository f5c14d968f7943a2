"""The sheet of an SVG: how large the file says that the drawing is, and where it lies.

Signals in: the root of an SVG. Signals out: the drawing's scale and its place, from the lower left corner of
the sheet, or from where the file says its zero is (`data-lower-left-mm`, which morfax writes).

    width="210mm" viewBox="0 0 210 297"     one unit of the drawing is 210 mm / 210
    width="210mm", no viewBox               one unit is 1/96 inch (CSS)
    width="794", in px or in percent        says nothing: refused, unless the unit is given

Source: SVG 1.1, 7.7 viewBox, 7.8 preserveAspectRatio; CSS 2.1, 4.3.2 lengths. Questions: a drawing on a sheet
of another shape is in its middle (xMidYMid), whatever it says.
"""

from __future__ import annotations

import math
import re
from pathlib import Path as FilePath
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np

from morfax.motion.arrays import AS_WRITTEN, Array
from morfax.motion.faults import DrawingFault
from morfax.motion.units import MM_PER_INCH
from morfax.recorder.drawings.drawn_units import NO_UNIT, UNITS_MM, ZERO, unit_mm

LENGTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-zA-Z%]*)\s*")
PHYSICAL_MM = {"mm": 1.0, "cm": 10.0, "in": MM_PER_INCH, "pt": MM_PER_INCH / 72, "pc": MM_PER_INCH / 6,
               "q": 0.25}  # fmt: skip


class SvgSheet(NamedTuple):
    """How the drawing lies on its sheet: mm per unit in X and Y, and where its zero comes to lie, mm."""

    x_mm: float
    y_mm: float
    left_mm: float
    top_mm: float

    def placed(self, places: Array) -> Array:
        """Places of the drawing, in its units and Y down, on the sheet, mm and Y up."""
        x, y = places.T
        return np.column_stack([self.left_mm + self.x_mm * x, self.top_mm - self.y_mm * y])


def sheet_of(file: FilePath, root: ElementTree.Element, unit: str | None) -> SvgSheet:
    """How the drawing lies on its sheet; raises DrawingFault if the file does not say how large it is."""
    box = _view_box(file, root)
    width, height = (_length(root.get(name)) for name in ("width", "height"))
    if unit is not None:
        box = box or (0.0, 0.0, 0.0, height[0] if height else 0.0)
        return _from_zero(root, _in_units(box, unit_mm(unit)))
    width_mm, high_mm = _physical_mm(width), _physical_mm(height)
    if width_mm is None or not width_mm > 0:
        raise _without_width(file, root)
    if box is None:
        px_mm = UNITS_MM["px"]
        return _from_zero(root, SvgSheet(px_mm, px_mm, 0.0, high_mm or 0.0))
    if high_mm is None:
        high_mm = width_mm * box[3] / box[2]
    if not high_mm > 0:
        raise DrawingFault(f"{file}: height is {root.get('height')!r}; it must be above zero")
    return _from_zero(root, _laid(root, box, width_mm, high_mm))


def stated_mm(file: FilePath, root: ElementTree.Element) -> float | None:
    """Length of the unit that the file states; None if it states none."""
    try:
        return sheet_of(file, root, None).x_mm
    except DrawingFault:
        return None


def _physical_mm(length: tuple[float, str] | None) -> float | None:
    """A length of the file, mm; None if there is none, or in a unit that is no length on paper."""
    known = length is not None and length[1] in PHYSICAL_MM
    return length[0] * PHYSICAL_MM[length[1]] if length and known else None


def _without_width(file: FilePath, root: ElementTree.Element) -> DrawingFault:
    """What is said of a file that does not tell how wide it is."""
    got = f"its width is {root.get('width')!r}" if root.get("width") else "it has no width"
    return DrawingFault(NO_UNIT.format(file=file, why=got))


def _in_units(box: tuple[float, float, float, float], one_mm: float) -> SvgSheet:
    """How a view box lies on a sheet if one of its units is so long."""
    left, top, _, high = box
    return SvgSheet(one_mm, one_mm, -left * one_mm, (top + high) * one_mm)


def _laid(
    root: ElementTree.Element,
    box: tuple[float, float, float, float],
    wide_mm: float,
    high_mm: float,
) -> SvgSheet:
    """How a view box lies on a sheet."""
    left, top, wide, high = box
    x_mm, y_mm = wide_mm / wide, high_mm / high
    how = root.get("preserveAspectRatio", "")
    if "none" not in how and abs(x_mm / y_mm - 1) > AS_WRITTEN:
        x_mm = y_mm = max(x_mm, y_mm) if "slice" in how else min(x_mm, y_mm)
    aside_mm = (wide_mm - wide * x_mm) / 2
    down_mm = (high_mm - high * y_mm) / 2
    return SvgSheet(x_mm, y_mm, aside_mm - left * x_mm, high_mm - down_mm + top * y_mm)


def _from_zero(root: ElementTree.Element, sheet: SvgSheet) -> SvgSheet:
    """The sheet moved to where the file says that its lower left corner is."""
    try:
        left_mm, low_mm = (float(word) for word in root.get(ZERO, "").split())
    except ValueError:
        return sheet
    return sheet._replace(left_mm=sheet.left_mm + left_mm, top_mm=sheet.top_mm + low_mm)


def _length(text: str | None) -> tuple[float, str] | None:
    """A length and its unit, None if it is none."""
    found = LENGTH.fullmatch(text or "")
    return (float(found[1]), found[2].lower()) if found else None


def _view_box(
    file: FilePath, root: ElementTree.Element
) -> tuple[float, float, float, float] | None:
    """Left, top, width and height of the view box, None if there is none."""
    text = root.get("viewBox")
    if text is None:
        return None
    try:
        left, top, wide, high = (float(word) for word in text.replace(",", " ").split())
    except ValueError:
        left = top = wide = high = math.nan
    if not (math.isfinite(left + top) and 0 < wide < math.inf and 0 < high < math.inf):
        raise DrawingFault(
            f"{file}: viewBox is {text[:40]!r}; it must be four numbers, the last two above zero"
        )
    return left, top, wide, high
