"""Gouges: places where a cutter's program would cut into the part.

Signals: a Trace of the cutter's middle and the lines that it runs beside in; a fault out, where the tool is
in the work and nearer to a line than its radius.

Source: our own.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.faults import MotionFault
from morfax.motion.polyline import Nearest
from morfax.tracer.head.slow_cell import CHECKED
from morfax.tracer.program.program import Trace

GOUGE_MM = 0.005  # nearer to a line than the radius by more is a gouge: WITHIN_MM and the feed's smoothing


def refuse_gouges(beside: Trace, near: Nearest, diameter_mm: float) -> None:
    """Raise MotionFault if the tool cuts into a line, as where a card lowers it on the way to a contour."""
    nearest_mm = 0.5 * diameter_mm - GOUGE_MM
    for block in beside:
        moves = np.any(np.diff(block.positions_mm[:, :2], axis=0) != 0, axis=1)
        moving = block.positions_mm[:-1][moves]
        cutting = moving[moving[:, 2] < 0, :2][::CHECKED]
        if not len(cutting):
            continue
        away_mm = near.distances_mm(cutting)
        if away_mm.min() < nearest_mm:
            x, y = cutting[int(np.argmin(away_mm))]
            raise MotionFault(
                f"a cutter of {diameter_mm:g} mm would cut into the part at {x:.1f},{y:.1f} mm, where"
                " a stop's moves leave it in the work; raise it there on the card, or pass the stop by with"
                " --stop-override"
            )
