"""Formats of paper: their names, and their sides in mm.

Source: ISO 216 (A series), ANSI/ASME Y14.1 (letter, legal, tabloid). Questions: all sheets of the A series
have sides as 1 to the root of 2, so a photograph cannot tell one from the other.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from morfax.motion.units import parse_length_mm


class Format(NamedTuple):
    """A rectangle of paper, upright or lying, mm."""

    name: str
    width_mm: float
    height_mm: float

    @property
    def turned(self) -> Format:
        """The same paper, a quarter turned."""
        return Format(self.name, self.height_mm, self.width_mm)


FORMATS = {
    each.name: each
    for each in (
        Format("a4", 210.0, 297.0),
        Format("letter", 215.9, 279.4),
        Format("a3", 297.0, 420.0),
        Format("a5", 148.0, 210.0),
        Format("a2", 420.0, 594.0),
        Format("a6", 105.0, 148.0),
        Format("legal", 215.9, 355.6),
        Format("tabloid", 279.4, 431.8),
    )
}
LEAST_SIDE_MM, LARGEST_SIDE_MM = 20.0, 5000.0  # chosen: a smaller or larger sheet is a slip
_SIDES = re.compile(r"([\d.]+)\s*([a-z]*)\s*[x×]\s*([\d.]+)\s*([a-z]*)")


def parsed(text: str) -> Format:
    """A format by its name, or by its sides, such as "148x105mm"; raises ValueError for another text."""
    word = text.strip().lower()
    if word in FORMATS:
        return FORMATS[word]
    found = _SIDES.fullmatch(word)
    if found is not None:
        unit = found[4] or found[2] or "mm"
        try:
            width_mm = parse_length_mm(found[1] + (found[2] or unit))
            height_mm = parse_length_mm(found[3] + unit)
        except ValueError:
            width_mm = height_mm = 0.0
        if all(LEAST_SIDE_MM <= side <= LARGEST_SIDE_MM for side in (width_mm, height_mm)):
            return Format(f"{width_mm:g}x{height_mm:g}mm", width_mm, height_mm)
    raise ValueError(
        f"{text.strip()[:40]!r} is no format of paper; give {', '.join(FORMATS)},"
        f" or sides of {LEAST_SIDE_MM:g} mm to {LARGEST_SIDE_MM / 1000:g} m such as 148x105mm"
    )
