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

from morfax.motion import arrays
from morfax.motion.arrays import Array
from morfax.motion.circle import circle_through
from morfax.motion.compiled import njit
from morfax.motion.median import median
from morfax.motion.plane import direction, heading_of
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
from morfax.tracer.sensing.photocell import darkness_at
from morfax.tracer.sensing.spokes import ANGLES, WAYS, changes_along, spokes
from morfax.tracer.sensing.view import View

AT_FIRST = 2.5  # times as much a spoke may differ: the place may be off the middle
# widths beyond a leg's end at which a dot is sought
AHEAD = np.arange(0.25, DOT_LARGEST_WIDTHS, 0.25)


def disc(view: View, place: Array, along: Array) -> Array | None:
    """The centre of a dot about a place on the line, whose direction there is `along`; None without a dot."""
    found = _disc(view, place)
    if found is None:
        return None
    centre, arms = found
    heading = heading_of(along)
    ahead = [abs(turn(heading, arm)) for arm in arms]
    back = [abs(turn(heading + math.pi, arm)) for arm in arms]
    off_line = np.minimum(ahead, back)
    return centre if np.all(off_line < DOT_ALONG) else None


def dot_at_end(view: View, incoming: Leg) -> Array | None:
    """The centre of a dot beyond a leg's clean end at which the line ends; None if it does not end so."""
    for along, place in _rounds_ahead(view, incoming):
        found = _disc(view, place)
        if found is None:
            continue
        centre, arms = found
        back = incoming.heading_at(along) + math.pi
        if all(abs(turn(back, arm)) < DOT_ALONG for arm in arms):
            return centre
    return None


def dot_ahead(view: View, leg: Leg) -> bool:
    """Whether a leg leads to a dot, at which the line may end or not."""
    for along, place in _rounds_ahead(view, leg):
        heading = leg.heading_at(along)
        if disc(view, place, direction(heading)) is not None:
            return True
    return False


def _rounds_ahead(view: View, leg: Leg) -> Iterator[tuple[float, Array]]:
    """Places beyond a leg's end about which `_disc` finds a round at first, and how far on they are, mm.

    As far as there is ink; nearly all lines have no dot, and no such place.
    """
    along_mm = AHEAD * view.width_mm
    places = leg.at(along_mm)
    sizes_mm = DOT_LEAST_WIDTHS * view.width_mm, DOT_LARGEST_WIDTHS * view.width_mm
    at = _first_round(view.cells, places, 0, WAYS, sizes_mm)
    while at < len(places) and view.dark(places[at]):
        yield float(along_mm[at]), places[at]
        at = _first_round(view.cells, places, at + 1, WAYS, sizes_mm)


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
    for share in (AT_FIRST * DOT_ROUND, DOT_ROUND, DOT_ROUND):
        reach = spokes(view, place, largest_mm, 1)[:, 0]
        if np.isfinite(reach).mean() <= DOT_EVEN:
            return None
        usual = median(reach[~np.isnan(reach)])
        even = np.abs(reach - usual) < share * usual
        if usual <= DOT_LEAST_WIDTHS * view.width_mm or even.mean() < DOT_EVEN:
            return None
        place, _, _ = circle_through(place + reach[even, None] * WAYS[even])
    return place, ANGLES[~even & ~(reach < usual)]  # a shorter spoke ends at a speck


@njit(cache=True)
def _first_round(cells, places, first, ways, sizes_mm):  # type: ignore[no-untyped-def]
    """The first of some places, from one on, that is on paper or that `_is_round`; how many if none is.

    `sizes_mm`: the least radius of a dot, and the largest.
    """
    reach_mm = np.empty((len(ways), 1))
    for k in range(first, len(places)):
        if not darkness_at(cells, places[k, 0], places[k, 1]) > cells.level:
            return k
        reach_mm[:] = math.nan
        changes_along(cells, places[k], ways, sizes_mm[1], reach_mm)
        if _is_round(reach_mm[:, 0], sizes_mm[0]):
            return k
    return len(places)


@njit(cache=True)
def _is_round(reach_mm, least_mm):  # type: ignore[no-untyped-def]
    """Whether ink ends alike all round, as far as `_disc` asks for at first."""
    ends_mm = reach_mm[~np.isnan(reach_mm)]
    if len(ends_mm) / len(reach_mm) <= DOT_EVEN:
        return False
    usual_mm = arrays.median(ends_mm)
    even = 0
    for end_mm in ends_mm:
        even += abs(end_mm - usual_mm) < AT_FIRST * DOT_ROUND * usual_mm
    return usual_mm > least_mm and even / len(reach_mm) >= DOT_EVEN
