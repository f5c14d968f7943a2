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
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.sensing.leg import Leg, turn
from morfax.tracer.sensing.spokes import ANGLES, WAYS, spokes
from morfax.tracer.sensing.view import View

LEAST_WIDTHS = 0.85  # radius of a dot
LARGEST_WIDTHS = 6.0
LEAST_FULL = 0.65  # area of a dot over that of its box; a disc has 0.785
ROUND = 0.15  # spokes of a dot differ by less than this share
ALONG = math.radians(50)  # the line leaves a dot within this of its heading


def disc(view: View, place: Array, along: Array) -> Array | None:
    """The centre of a dot about a place on the line, which has the direction `along` there; None if there is
    none.
    """
    found = _disc(view, place)
    if found is None:
        return None
    heading = math.atan2(along[1], along[0])
    on_line = [
        min(abs(turn(heading + k * math.pi, angle)) for k in (0, 1)) for angle in found[1]
    ]
    return found[0] if not on_line or max(on_line) < ALONG else None


def dot_at_end(view: View, incoming: Leg) -> Array | None:
    """The centre of a dot beyond a leg's clean end at which the line ends; None if there is none."""
    for along in np.arange(0.25, LARGEST_WIDTHS, 0.25) * view.width_mm:
        place = incoming.at(along)
        if not view.dark(place):
            return None
        found = _disc(view, place)
        if found is None:
            continue
        centre, arms = found
        heading = incoming.heading_at(float(along))
        if all(abs(turn(heading + math.pi, angle)) < ALONG for angle in arms):
            return centre
    return None


def dot_ahead(view: View, leg: Leg) -> bool:
    """Whether a leg leads to a dot, at which the line may end or not."""
    for along in np.arange(0.25, LARGEST_WIDTHS, 0.25) * view.width_mm:
        place, heading = leg.at(along), leg.heading_at(float(along))
        if not view.dark(place):
            return False
        if disc(view, place, np.array([math.cos(heading), math.sin(heading)])) is not None:
            return True
    return False


def alone(sheet: Sheet, view: View) -> Iterator[Array]:
    """Centres of the dots that stand alone on the paper, mm: round patches of ink that no line leaves."""
    pitch, patches = sheet.drawing.pitch_mm, sheet.patches
    sides = patches.longer_sides * pitch
    small = (sides > 2 * LEAST_WIDTHS * view.width_mm) & (
        sides < 2 * LARGEST_WIDTHS * view.width_mm
    )
    full = patches.areas * pitch**2 > LEAST_FULL * sides**2
    for patch in np.flatnonzero(small & full):
        top, bottom, left, right = patches.box(np.arange(patches.count) == patch)
        middle = (
            np.array(
                [0.5 * (left + right), sheet.drawing.darkness.shape[0] - 0.5 * (top + bottom)]
            )
            * pitch
        )
        found = _disc(view, middle)
        if found is not None and not len(found[1]):
            yield found[0]


def _disc(view: View, place: Array) -> tuple[Array, Array] | None:
    """Centre of the round of ink about a place, and the directions in which ink leaves it, rad."""
    for share in (2.5 * ROUND, ROUND, ROUND):  # the place may be beside the middle at first
        reach = spokes(view, place, LARGEST_WIDTHS * view.width_mm)[:, 0]
        usual = float(np.nanmedian(reach)) if np.isfinite(reach).mean() > 0.6 else math.inf
        even = np.abs(reach - usual) < share * usual
        if not LEAST_WIDTHS * view.width_mm < usual < math.inf or even.mean() < 0.6:
            return None
        place, _, _ = circle_through(place + reach[even, None] * WAYS[even])
    return place, ANGLES[~even & ~(reach < usual)]  # a shorter spoke ends at a speck
