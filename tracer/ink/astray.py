"""Astray: corners within other lines' ink that do not lie on the lines of the legs that lead to them.

    ─────────┐ ·        a corner deep in other ink may lie anywhere, as far as the ink tells; but each leg was
          ╲  │          felt, and leads to it: a way that turns where its leg is clean is none
           ╲ │

Signals: a crossing whose lines go on over corners in; how unlikely these are by its legs, corners, out.

    deviation² = (a share of the width)² + (a leg's turn · how far the corner is ahead of it)²

A leg that bends may lead to its corner straight or as it bends.

Source: our own.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from morfax.motion.arrays import Array
from morfax.motion.plane import direction
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.tangles.redrawing import STROKE

if TYPE_CHECKING:
    from morfax.tracer.ink.crossing import Crossing

# deviations of where a leg leads: on 15 crowded sheets 95 % of 182 legs lead within 1.8 degrees, or 0.08
# widths, of their right corner; to wrong ones 10 degrees off and more
EXACT, TURNED = 0.05, math.radians(1.0)
FAR = 3.0  # deviations: a corner so far from where its leg leads is as unlikely as one corner more


def astray(crossing: Crossing) -> float:
    """How unlikely all corners of a crossing are by where its legs lead, as so many corners more.

    A leg that leads elsewhere altogether was felt wrongly: that is no less likely than a line that ends.
    """
    return sum(
        min((_off(crossing.legs[leg], corner) / FAR) ** 2, STROKE)
        for pair, corners in crossing.solution.corners.items()
        if len(corners)
        for leg, corner in zip(pair, (corners[0], corners[-1]), strict=True)
    )


def _off(leg: Leg, corner: Array) -> float:
    """How far a corner is aside of where its leg leads, deviations."""
    (x, y), (dx, dy) = corner - leg.end_mm, direction(leg.heading_rad)
    ahead_mm, aside_mm = x * dx + y * dy, dx * y - dy * x
    bent_mm = 0.5 * leg.bend_per_mm * ahead_mm**2
    off_mm = max(aside_mm - max(bent_mm, 0.0), min(bent_mm, 0.0) - aside_mm, 0.0)
    return float(off_mm / math.hypot(EXACT * leg.width_mm, TURNED * ahead_mm))
