"""Why a line was lost: the reasons, and what to do instead, as the fault says them.

Signals: place (mm), heading (rad) and travel (mm) of the head, and a reason in; the fault out.
"""

from __future__ import annotations

import math

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault

NO_GUARDS = "the swinging cell sees no more ink, and this head has no guard cells to find on by"
SLOWER = "go slower there with --speed, or follow with --head precise"
CONTRADICT = "the swinging cell and the line felt ahead disagree"
CHECK_CELL = "and at the settings of the head's cell, or scan at a higher resolution"
BRIDGE = "bridge a gap with --gap, or scan at a higher resolution"


def line_lost(
    stands: tuple[Array, float], travel_mm: float, times: float, why: str
) -> LineFault:
    """The fault of a line that was lost where the head stands, with the reason and what to do.

    Place and travel are those of a drawing that the head sees so many `times` as large.
    """
    (x, y), heading_rad = (stands[0] / times).tolist(), stands[1]
    degrees, come_mm = round(math.degrees(heading_rad)) % 360, travel_mm / times
    return LineFault(
        f"line lost at {x:.2f},{y:.2f} mm, heading {degrees} degrees, after {come_mm:.1f} mm: {why}",
        x_mm=x,
        y_mm=y,
        heading_rad=heading_rad,
    )


def by_its_cell(fault: LineFault) -> bool:
    """Whether the head's cell and the line felt ahead disagreed, or the cell saw no more ink."""
    return CONTRADICT in str(fault) or NO_GUARDS in str(fault)
