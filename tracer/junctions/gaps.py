"""Gaps: where a line ends, or was lost, and ink goes on in line with it behind a wider gap than is allowed.

Signals: the view of a line and the way of the head along it in; the ends of that way from which ink goes on
straight ahead, and how wide a gap must be allowed to get there (mm) out.

    ━━━━━━━━━●   1.2 mm   ━━━━━━━━        as of a dashed line: the operator may allow it with `--gap`

Source: our own. The head goes across a wider gap as it does across one that is allowed (see
`line_ahead`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from morfax.motion import long_array
from morfax.motion.arrays import Array
from morfax.motion.plane import heading_of
from morfax.tracer.effort import LOOKED_MM
from morfax.tracer.junctions.line_ahead import Ahead
from morfax.tracer.sensing.leg import ABOUT_LEGS, leg_of
from morfax.tracer.sensing.parabola import FEWEST
from morfax.tracer.sensing.probe import END_WIDTHS
from morfax.tracer.sensing.view import View


class Break(NamedTuple):
    """An end of a line from which ink goes on straight ahead, and how wide the gap before that is, mm."""

    place_mm: tuple[float, float]
    gap_mm: float


def breaks(view: View, way_mm: Array, at_start: bool) -> tuple[Break, ...]:
    """The breaks at the end of a way (n, 2) mm, and at its start if that is an end too."""
    ends = [way_mm, way_mm[::-1]] if at_start else [way_mm]
    found = [(end[-1], _gap_mm(view, end)) for end in ends]
    return tuple(
        Break((float(x), float(y)), gap_mm) for (x, y), gap_mm in found if gap_mm is not None
    )


def _gap_mm(view: View, way_mm: Array) -> float | None:
    """The gap that must be allowed to go on straight from the end of a way; None if no ink goes on there."""
    felt_mm = ABOUT_LEGS * view.leg_mm
    place = _last_beyond(way_mm, felt_mm)
    if place is None:
        return None
    along = way_mm[-1] - place
    seen = view.feel(place, heading_of(along), felt_mm)
    if len(seen) < FEWEST:
        return None
    ahead = Ahead(view, leg_of(seen, True, view.leg_mm))
    most_mm = END_WIDTHS * view.width_mm
    if ahead.over(most_mm) is None:
        return None
    gaps = np.arange(LOOKED_MM, most_mm, LOOKED_MM)
    return next((round(float(gap), 1) for gap in gaps if ahead.over(gap) is not None), None)


def _last_beyond(way_mm: Array, away_mm: float) -> Array | None:
    """The last place of a way that is further than this from its end; None if none is."""
    for end in range(len(way_mm), 0, -long_array.BLOCK_ROWS):
        some = way_mm[max(0, end - long_array.BLOCK_ROWS) : end]
        beyond = np.flatnonzero(np.hypot(*(some - way_mm[-1]).T) > away_mm)
        if len(beyond):
            return np.asarray(some[beyond[-1]])
    return None
