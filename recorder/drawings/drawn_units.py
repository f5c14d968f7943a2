"""Units of drawings from CAD: what --unit takes when a file does not say its own.

Source: the international inch (1959), 25.4 mm; CSS 2.1, 4.3.2: a px is 1/96 inch, a pt 1/72.
"""

from __future__ import annotations

import math
from pathlib import Path as FilePath

from morfax.motion.units import MM_PER_INCH

UNITS_MM = {
    "um": 1e-3,
    "mm": 1.0,
    "cm": 10.0,
    "m": 1e3,
    "in": MM_PER_INCH,
    "ft": 12 * MM_PER_INCH,
    "pt": MM_PER_INCH / 72,
    "px": MM_PER_INCH / 96,
}
# an SVG's own attribute, which morfax writes: where its lower left corner is in the motion's coordinates, mm
ZERO = "data-lower-left-mm"
NO_UNIT = "{file} does not say its unit ({why}); give it with --unit mm, or --unit in"


def unit_mm(unit: str) -> float:
    """Length of a unit, mm; raises ValueError for one that is not known."""
    if unit not in UNITS_MM:
        raise ValueError(f"{unit!r} is no unit of drawings; give one of {', '.join(UNITS_MM)}")
    return UNITS_MM[unit]


def overruled(file: FilePath, unit: str | None, stated_mm: float | None) -> list[str]:
    """The note on a drawing whose own unit, so many mm, is not the one that is given by hand; or none."""
    if (
        unit is None
        or stated_mm is None
        or math.isclose(unit_mm(unit), stated_mm, rel_tol=1e-6)
    ):
        return []
    own = next(
        (name for name, mm in UNITS_MM.items() if math.isclose(mm, stated_mm)), "another unit"
    )
    times = unit_mm(unit) / stated_mm
    return [
        f"{file} says that it is in {own}: --unit {unit} makes it {times:.4g} times as large as it says; "
        "leave --unit out to have it as it says"
    ]
