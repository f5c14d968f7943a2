"""Putting the head down: where on a line it can start, and what it sees there.

Signals: a drawing and places near the middle of a line in; a stance out: place on the line's centre, heading, the line's width and darkness.

A ring of cells about a place sees two arcs opposite each other when the place is on a clean line; between them lies the heading. The line is then felt
both ways, and of several places the one is taken from which it can be felt furthest, and is straightest.

Source: patent ES 361967, section on use: the operator brings the head over the drawing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from motion.faults import LineFault
from tracer import photocell
from tracer.drawing import Drawing
from tracer.leg import Leg, centre_at, end_of, leg_of, turn
from tracer.lines import Sheet, Stroke
from tracer.survey import straight_on
from tracer.view import LEVEL, Array, View

CATCH_MM = 3.0  # how far from a given place the line may be
APERTURE = 0.3  # of the line's width, within bounds that a scan's noise and a corner set
LEAST_APERTURE_MM, LARGEST_APERTURE_MM = 0.1, 0.24
SPUR = 2.7  # a line that ends sooner, in widths, is a burr
PLACES = 80  # tried along a line


@dataclass(frozen=True, slots=True)
class Stance:
    """The head put down: place on the line, heading along it, and how it sees the line."""

    place_mm: Array
    heading_rad: float
    view: View
    at_end: bool = False


def turned_round(end_mm: Array, heading_rad: float, view: View) -> Stance:
    """The head at the end of a line where it arrived on a heading, to go back along it."""
    return Stance(end_mm, math.remainder(heading_rad + math.pi, math.tau), view, True)


def put_down(
    drawing: Drawing,
    start_mm: tuple[float, float] | None,
    aperture_mm: float | None,
    line_width_mm: float | None,
    gap_mm: float = 0.5,
) -> Iterator[tuple[Stance, float]]:
    """Put the head down near a place, or on the longest line: at an open end if it has one, then where it is smooth; and the line's length, mm.

    Raises LineFault if there is no line near the place, or no clean stretch on the line.
    """
    sheet = Sheet.of(drawing)
    catch_mm = max(CATCH_MM, 12 * drawing.pitch_mm)
    stroke = sheet.longest() if start_mm is None else sheet.nearest(start_mm, catch_mm)
    width_mm = line_width_mm or stroke.width_mm
    aperture_mm = aperture_mm or min(max(APERTURE * width_mm, LEAST_APERTURE_MM), LARGEST_APERTURE_MM)
    view = View(photocell.behind_aperture(drawing, aperture_mm), drawing.pitch_mm, width_mm, LEVEL)
    at_end = _at_an_end(view, stroke, gap_mm) if start_mm is None else None
    if at_end is not None:
        yield at_end, stroke.length_mm
    stances = _stances(view, _tried(stroke, start_mm, 2 * stroke.width_mm))
    if not stances and start_mm is not None:
        stances = _stances(view, _tried(stroke, start_mm, catch_mm))
    if stances:
        yield max(stances, key=lambda s: s[0])[1], stroke.length_mm
    elif at_end is None:
        raise LineFault(
            f"no clean stretch of line to start on, {stroke.length_mm:.0f} mm of line {width_mm:.2f} mm wide;"
            " give --line-width, or --start X,Y at a plain stretch"
        )


def _tried(stroke: Stroke, start_mm: tuple[float, float] | None, about_mm: float) -> Array:
    """Places of a line to try: all along it, or about the place nearest to a start."""
    places = stroke.middles_mm
    if start_mm is not None:
        away = np.hypot(*(places - np.asarray(start_mm)).T)
        places = places[away <= away.min() + about_mm]
    return places[:: max(1, len(places) // PLACES)]


def _stances(view: View, places: Array) -> list[tuple[tuple[float, float], Stance]]:
    """Stances at those places where the line is clean, each with its score: length felt, straightness."""
    out = []
    for place in places:
        local = _local(view, place)
        heading = _heading(local, place)
        if heading is None:
            continue
        felt = _both_ways(local, place, heading)
        if felt is None:
            continue
        middle, length = felt
        local = replace(local, width_mm=middle.width_mm)
        out.append(((length, -abs(middle.bend_per_mm)), Stance(middle.end_mm, middle.heading_rad, local)))
    return out


def _local(view: View, place: Array) -> View:
    """The view with the level at half the darkness of this place."""
    ink = photocell.darkness_at(view.cells, view.pitch_mm, place[0], place[1])
    return replace(view, level=LEVEL * max(ink, 0.2))


def _heading(view: View, place: Array) -> float | None:
    """Heading of the line through a place, from the two arcs that a ring sees; None if it does not see two, opposite."""
    radius = max(0.9 * view.width_mm, 4.5 * view.pitch_mm)
    arcs = photocell.ring(view.cells, view.pitch_mm, place, radius, view.level)
    if len(arcs) != 2:
        return None
    there, back = arcs.mean(axis=1)
    if abs(turn(there, back + math.pi)) > math.radians(35):
        return None
    return float(there + 0.5 * turn(there, back + math.pi))


def _both_ways(view: View, place: Array, heading: float) -> tuple[Leg, float] | None:
    """The line felt forward and backward from a place as one leg about it, and the length felt on the shorter side, mm."""
    right, left = photocell.edges(view.cells, view.pitch_mm, place[0], place[1], heading, 2 * view.width_mm, view.level)
    if not math.isfinite(left - right) or not 0.4 < (left - right) / view.width_mm < 2.5:
        return None
    view = replace(view, width_mm=left - right)
    length = 1.5 * view.leg_mm
    ahead, behind = view.feel(place, heading, length), view.feel(place, heading + math.pi, length)
    shorter = min(len(ahead), len(behind))
    if shorter < 6:
        return None
    both = np.vstack([behind[shorter - 1 : 0 : -1], ahead[:shorter]])
    middle = centre_at(both, shorter - 1, 0.6 * view.leg_mm)
    return middle, round((shorter - 1) * view.step_mm, 1)


def _at_an_end(view: View, stroke: Stroke, gap_mm: float) -> Stance | None:
    """A stance at an open end of the line, heading inward; None if the line has no end."""
    for place in stroke.ends_mm():
        local = _local(view, place)
        radius = max(1.5 * view.width_mm, 6 * view.pitch_mm)
        arcs = photocell.ring(local.cells, local.pitch_mm, place, radius, local.level)
        if len(arcs) != 1 or arcs[0, 1] - arcs[0, 0] > math.pi / 2:
            continue
        heading = float(arcs.mean())
        inward = place + radius * np.array([math.cos(heading), math.sin(heading)])
        right, left = photocell.edges(
            local.cells, local.pitch_mm, inward[0], inward[1], heading, 2 * local.width_mm, local.level
        )
        if not abs(left - right - view.width_mm) < 0.25 * view.width_mm + 0.5 * view.pitch_mm:
            continue
        local = replace(local, width_mm=left - right)
        seen = local.feel(inward, heading, max(4 * local.width_mm, local.leg_mm))
        if len(seen) * local.step_mm < SPUR * local.width_mm - radius:
            continue  # a burr, not an end
        middle = seen[len(seen) // 4 : -len(seen) // 4, 2]
        if np.median(middle[-4:]) > 1.08 * np.median(middle[:4]):
            continue  # the tip of two lines that part, not the end of one
        outward = leg_of(local.feel(inward, heading + math.pi, local.leg_mm), True, local.leg_mm)
        end = end_of(local, outward)
        if end is None or straight_on(local, outward, gap_mm) is not None:
            continue  # the edge of a gap
        local = replace(local, width_mm=outward.width_mm)
        return Stance(outward.at(end), math.remainder(outward.heading_at(end) + math.pi, math.tau), local, True)
    return None
