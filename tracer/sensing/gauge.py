"""The gauge: the line's width and darkness about a place, for a line that swells and fades.

Signals: the cells, a pose on the line (mm, rad) and the line's widths so far (mm) in; level and widths out.

    ink     the median darkness of `PLACES` places ahead: more of them than a speck spoils
    level   half of that ink; across each place, the distance of the two edges is the width

Source: our own; an operator looks along the line in the same way.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import median
from morfax.motion.compiled import njit
from morfax.tracer.sensing.photocell import LEVEL, Cells, darkness_at
from morfax.tracer.sensing.ray import edges

PLACES = 5  # two stations apart; by trial
REACH, REACH_PX = 1.5, 2  # widths and pixels, within which the edges are
NARROWEST, WIDEST = 0.5, 1.6  # of the usual width: another width is another line's; by trial
DARKEST = 4  # times the level so far


@njit(cache=True)
def gauge(cells, pose, widths_mm, step_mm, follows):  # type: ignore[no-untyped-def]
    """The level, width and usual width (mm) about a pose; NaN where the line is not like the one before.

    The usual width follows by a share of how far the width differs from it.
    """
    x_mm, y_mm, heading = pose
    width_mm, usual_mm = widths_mm
    c, s = math.cos(heading), math.sin(heading)
    # 1. the level, by the ink
    found = np.empty(PLACES)
    for k in range(PLACES):
        ahead_mm = 2 * k * step_mm
        found[k] = darkness_at(cells, x_mm + ahead_mm * c, y_mm + ahead_mm * s)
    ink = median(found)
    level = LEVEL * min(max(ink, cells.level), DARKEST * cells.level)
    here = Cells(cells.darkness, cells.pitch_mm, level, cells.tiles, cells.beyond)
    # 2. the width at that level
    reach_mm = REACH * width_mm + REACH_PX * cells.pitch_mm
    for k in range(PLACES):
        ahead_mm = 2 * k * step_mm
        right, left = edges(here, x_mm + ahead_mm * c, y_mm + ahead_mm * s, heading, reach_mm)
        found[k] = left - right
        if math.isnan(found[k]):  # no edge in reach
            return math.nan, math.nan, math.nan
    width_mm = median(found)
    if not NARROWEST < width_mm / usual_mm < WIDEST:
        return math.nan, math.nan, math.nan
    return level, width_mm, usual_mm + follows * (width_mm - usual_mm)
