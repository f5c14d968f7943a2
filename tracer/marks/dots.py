"""Dots: rounds of ink on the line, wider than it, that mark a place to drill.

Signals: places near the line's middle in; the dot's centre out, or that of the dot at which a line ends.

    ───●───      ───●         spokes from its middle end alike all round, but for those along the line

Source: patent ES 361967, section on use: guide lines to drill points. Questions: the patent does not say how
a drill point is drawn. Chosen: the end of a guide line, or a dot at least 1.7 times as wide as the line.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.circle import circle_through
from morfax.motion.median import median
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.marks.sizes import (
    DOT_ALONG,
    DOT_EVEN,
    DOT_FULL,
    DOT_LARGEST_WIDTHS,
    DOT_LEAST_WIDTHS,
    DOT_ROUND,
)
from morfax.tracer.sensing.leg import Leg, turn
from morfax.tracer.sensing.spokes import ANGLES, WAYS, spokes
from morfax.tracer.sensing.view import View

AHEAD = np.arange(
    0.25, DOT_LARGEST_WIDTHS, 0.25
)  # widths beyond a leg's end at which a dot is sought


def disc(view: View, place: Array, along: Array) -> Array | None:
    """The centre of a dot about a place on the line, whose direction there is `along`; None without a dot."""
    found = _disc(view, place)
    if found is None:
        return None
    centre, arms = found
    heading = math.atan2(along[1], along[0])
    ahead = [abs(turn(heading, arm)) for arm in arms]
    back = [abs(turn(heading + math.pi, arm)) for arm in arms]
    off_line = np.minimum(ahead, back)
    return centre if np.all(off_line < DOT_ALONG) else None


def dot_at_end(view: View, incoming: Leg) -> Array | None:
    """The centre of a dot beyond a leg's clean end at which the line ends; None if it does not end so."""
    for along in AHEAD * view.width_mm:
        place = incoming.at(along)
        if not view.dark(place):
            return None
        found = _disc(view, place)
        if found is None:
            continue
        centre, arms = found
        back = incoming.heading_at(float(along)) + math.pi
        if all(abs(turn(back, arm)) < DOT_ALONG for arm in arms):
            return centre
    return None


def dot_ahead(view: View, leg: Leg) -> bool:
    """Whether a leg leads to a dot, at which the line may end or not."""
    for along in AHEAD * view.width_mm:
        place, heading = leg.at(along), leg.heading_at(float(along))
        if not view.dark(place):
            return False
        if disc(view, place, np.array([math.cos(heading), math.sin(heading)])) is not None:
            return True
    return False


def alone(sheet: Sheet, view: View) -> Iterator[tuple[int, Array]]:
    """The dots that stand alone, round patches of ink that no line leaves: the patch and its centre, mm."""
    pitch, patches = sheet.drawing.pitch_mm, sheet.patches
    sides_mm = patches.longer_sides * pitch
    least_mm, largest_mm = (
        2 * widths * view.width_mm for widths in (DOT_LEAST_WIDTHS, DOT_LARGEST_WIDTHS)
    )
    small = (sides_mm > least_mm) & (sides_mm < largest_mm)
    full = patches.areas * pitch**2 > DOT_FULL * sides_mm**2
    chosen = np.flatnonzero(small & full)
    for patch, middle in zip(chosen.tolist(), sheet.middles_mm(chosen), strict=True):
        found = _disc(view, middle)
        if found is not None and not len(found[1]):
            yield patch, found[0]


def _disc(view: View, place: Array) -> tuple[Array, Array] | None:
    """Centre of the round of ink about a place, and the directions in which ink leaves it, rad."""
    largest_mm = DOT_LARGEST_WIDTHS * view.width_mm
    for share in (
        2.5 * DOT_ROUND,
        DOT_ROUND,
        DOT_ROUND,
    ):  # at first the place may be off the middle
        reach = spokes(view, place, largest_mm, 1)[:, 0]
        if np.isfinite(reach).mean() <= DOT_EVEN:
            return None
        usual = median(reach[~np.isnan(reach)])
        even = np.abs(reach - usual) < share * usual
        if usual <= DOT_LEAST_WIDTHS * view.width_mm or even.mean() < DOT_EVEN:
            return None
        place, _, _ = circle_through(place + reach[even, None] * WAYS[even])
    return place, ANGLES[~even & ~(reach < usual)]  # a shorter spoke ends at a speck
