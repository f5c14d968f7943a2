"""Centre crosses: a cross in a part from which an extension line runs out of it is no reference point.

Signals: the junctions of a net and a stance at a reference point on it in; whether that leads nobody in out.

    ╭────────╮
    │   ┼────┼──────┬─     a lead line comes to a contour, and ends there; an extension line begins at a
    ╰────────╯      ▼      middle that is dimensioned, crosses the outline and ends outside

Source: our own; patent ES 361967 has the reference point normally outside the contour, and ISO 129 has
extension lines begin at centre lines.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import nearest_mm
from morfax.tracer.head.stance import Stance
from morfax.tracer.limits import ABOUT_WIDTHS
from morfax.tracer.program.lines.selection import NEW

if TYPE_CHECKING:
    from morfax.tracer.ink.chains import Junctions


def is_centre_cross(junctions: Junctions, stance: Stance) -> bool:
    """Whether the line that begins at a reference point runs out of a closed line about that point."""
    from morfax.tracer.ink.closed_ways import closed_ways

    if stance.reference_mm is None:
        return False
    width_mm = stance.view.width_mm
    end_mm = _far_end_mm(junctions, stance)
    return any(
        _within_mm(around, np.asarray(stance.reference_mm)) > 0
        and _within_mm(around, end_mm) < -ABOUT_WIDTHS * width_mm
        for around in (
            junctions.places_along(way.chain) for way in closed_ways(junctions, set(), NEW)
        )
    )


def _far_end_mm(junctions: Junctions, stance: Stance) -> Array:
    """Where the line that begins at a reference point ends, straight on over the junctions, (x, y) mm."""
    lines = junctions.net.lines
    place = np.asarray([stance.place_mm])
    nearest = int(np.argmin([nearest_mm(place, line.places_mm)[0] for line in lines]))
    chains = (chain for chain in junctions.chains() if nearest in {n for n, _ in chain.links})
    way = junctions.places_along(next(chains))
    return max(way[[0, -1]], key=lambda end: math.dist(end, stance.place_mm))


def _within_mm(around: Array, place: Array) -> float:
    """How far a place lies within a closed way, mm; less than 0 outside."""
    outline = around.astype(np.float32).reshape(-1, 1, 2)
    return cv2.pointPolygonTest(outline, (float(place[0]), float(place[1])), True)
