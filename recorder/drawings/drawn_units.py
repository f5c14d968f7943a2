"""Units of drawings from CAD: what --unit takes when a file does not say its own.

Source: the international inch (1959), 25.4 mm; CSS 2.1, 4.3.2: a px is 1/96 inch, a pt 1/72.
"""

from __future__ import annotations

INCH_MM = 25.4
UNITS_MM = {
    "um": 1e-3,
    "mm": 1.0,
    "cm": 10.0,
    "m": 1e3,
    "in": INCH_MM,
    "ft": 12 * INCH_MM,
    "pt": INCH_MM / 72,
    "px": INCH_MM / 96,
}
# an SVG's own attribute, which morfax writes: where its lower left corner is in the motion's coordinates, mm
ZERO = "data-lower-left-mm"
NO_UNIT = "{file} does not say its unit ({why}); give it with --unit mm, or --unit in"


def unit_mm(unit: str) -> float:
    """Length of a unit, mm; raises ValueError for one that is not known."""
    if unit not in UNITS_MM:
        raise ValueError(f"{unit!r} is no unit of drawings; give one of {', '.join(UNITS_MM)}")
    return UNITS_MM[unit]
