"""Open ends: where a line begins on the paper, and which of its ends comes from a reference point.

Signals: a line and the places of its ends in (mm); stances at the ends out, heading into the line.

An end is no place to begin if it is a burr, the tip of two lines that part, the edge of a gap, or the end of
a stop mark. A lead line begins at a reference point: at the one that the operator names, or at a small cross
or ring on the drawing.

Source: patent ES 361967, section on use: the lead line begins at the reference point.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.motion.plane import direction
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.following.plain_places import local_view
from morfax.tracer.head.stance import Stance
from morfax.tracer.junctions.line_ahead import straight_on
from morfax.tracer.limits import AHEAD_RAD, CLEAR_WIDTHS, DETAIL_PX
from morfax.tracer.marks.marks import longest_mm
from morfax.tracer.marks.reference import Reference, may_lead, reach_mm, references
from morfax.tracer.sensing.leg import FEWEST_STATIONS, leg_of, turn
from morfax.tracer.sensing.probe import end_of, reach_of_ink, stroke_end, strokes_on
from morfax.tracer.sensing.view import View

# All limits below were chosen by trial on the test drawings.
LEAD_MM = 11.0  # at most, from the middle of a reference point to its lead line
NAMED_MM = 5.0  # a cross or ring nearer to the named reference point is that point, drawn
AT_IT = 0.5  # widths: an end as near to the reference point begins at it, whatever its heading
LEAD_LEGS = 1.5  # lengths of a leg: a lead line is longer than this
WIDTH_OFF, WIDTH_OFF_PX = 0.25, 0.5  # of the width, and pixels: the end is as wide as the line
SPUR_WIDTHS = 2.7  # a line that ends sooner is a burr
BEYOND_WIDTHS = 2.0  # ink that reaches no further beyond an end leaves a stop mark on one side
# the tip of two lines widens so much, in widths or pixels, along half of what is felt of it
GROWS, GROWS_PX = 0.08, 0.4


def at_ends(
    view: View,
    sheet: Sheet,
    stroke: Stroke,
    gap_mm: float,
    reference_mm: tuple[float, float] | None,
) -> list[Stance]:
    """Stances at the open ends of a line, or only that which comes from a reference point."""
    ends = list(stances_at(view, stroke.ends_mm, gap_mm))
    # 1. from the reference point that the operator names
    if reference_mm is not None:
        named = from_reference(reference_mm, ends)
        if named:
            return named
        leading = _leading_away(view, stroke, reference_mm)
        if leading is not None:
            return [leading]
    elif not ends and not may_lead(sheet, stroke):
        return []
    # 2. from one that is drawn; one further away has neither a lead line here nor an end of this line near it
    about_mm = reach_mm(view.width_mm, view.pitch_mm)
    about_mm += LEAD_MM + NAMED_MM if ends else 0.0
    drawn = references(sheet, view, stroke, about_mm)
    for found in _named_first(drawn, reference_mm):
        from_it = _from_drawn(view, stroke, found, ends)
        if from_it and (reference_mm is not None or found.is_sure(sheet, stroke.patch)):
            return from_it
    return ends


def _from_drawn(
    view: View, stroke: Stroke, found: Reference, ends: list[Stance]
) -> list[Stance]:
    """The stances on a line at a reference point: at the lead line drawn from it, or at an end near it."""
    lead = found.lead
    if lead is None or not stroke.is_at(lead.end_mm):
        return from_reference(found.place_mm, ends)
    local = view.like(lead.end_mm, lead.heading_rad)
    return [Stance(lead.end_mm, lead.heading_rad, local, True, found.place_mm)]


def stances_at(view: View, places: Iterable[Array], gap_mm: float) -> Iterator[Stance]:
    """The stances at those places that are open ends, heading into the line."""
    for place in places:
        stance = _at_end(view, place, gap_mm)
        if stance is not None:
            yield stance


def _leading_away(
    view: View, stroke: Stroke, reference_mm: tuple[float, float]
) -> Stance | None:
    """The stance on the only line that leads away from a reference point; None if no single line does.

    It does not matter what is drawn about the point.
    """
    place = np.asarray(reference_mm)
    nearest = np.argmin(np.hypot(*(stroke.middles_mm - place).T))
    local = local_view(view, stroke.middles_mm[nearest])
    for radius in np.arange(view.width_mm, LEAD_MM, 0.5 * view.width_mm):
        arcs = local.ring(place, radius)
        if len(arcs) != 1:
            continue
        heading = float(arcs.mean())
        start = place + radius * direction(heading)
        seen = local.feel(start, heading, 2 * local.leg_mm)
        is_line = (len(seen) - 1) * local.step_mm > LEAD_LEGS * local.leg_mm
        if stroke.is_at(start) and is_line:
            leg = leg_of(seen, False, local.leg_mm)
            own = replace(local, width_mm=leg.width_mm)
            return Stance(leg.end_mm, leg.heading_rad, own, True, reference_mm)
    return None


def _named_first(
    found: Iterator[Reference], named_mm: tuple[float, float] | None
) -> Iterator[Reference]:
    """Reference points, those near the named point first.

    A point that is the named one has the place that the operator gave.
    """
    if named_mm is None:
        yield from found
        return
    for reference in sorted(found, key=lambda r: math.dist(named_mm, r.place_mm)):
        is_named = math.dist(named_mm, reference.place_mm) < NAMED_MM
        yield replace(reference, place_mm=named_mm) if is_named else reference


def from_reference(place_mm: tuple[float, float], ends: list[Stance]) -> list[Stance]:
    """The stances at ends that are near a reference point and lead away from it, the nearest first."""
    found = []
    for end in ends:
        way = end.place_mm - np.asarray(place_mm)
        away = float(np.hypot(*way))
        ahead = abs(turn(math.atan2(way[1], way[0]), end.heading_rad)) < AHEAD_RAD
        if away < LEAD_MM and (ahead or away < AT_IT * end.view.width_mm):
            found.append((away, replace(end, reference_mm=place_mm)))
    return [stance for _, stance in sorted(found, key=lambda each: each[0])]


def _at_end(view: View, place: Array, gap_mm: float) -> Stance | None:
    """A stance at an open end of the line, heading inward; None if this place is no open end."""
    # 1. one stroke leads away from the place, as wide as the line
    local = local_view(view, place)
    radius = max(CLEAR_WIDTHS * view.width_mm, DETAIL_PX * view.pitch_mm)
    arcs = strokes_on(local, place, radius)
    if len(arcs) != 1 or arcs[0, 1] - arcs[0, 0] > math.pi / 2:
        return None
    heading = float(arcs.mean())
    inward = place + radius * direction(heading)
    right, left = local.edges(inward, heading, 2 * local.width_mm)
    width_mm, off_mm = left - right, WIDTH_OFF * view.width_mm + WIDTH_OFF_PX * view.pitch_mm
    if not abs(width_mm - view.width_mm) < off_mm:
        return None
    # 2. that stroke is a line and goes on
    local = replace(local, width_mm=width_mm)
    if not _is_end(local, inward, heading, radius):
        return None
    # 3. the line ends there, and not at a gap
    outward = leg_of(local.feel(inward, heading + math.pi, local.leg_mm), True, local.leg_mm)
    end = end_of(local, outward)
    if end is None or straight_on(local, outward, gap_mm) is not None:
        return None
    own = replace(local, width_mm=outward.width_mm)
    back_rad = math.remainder(outward.heading_at(end) + math.pi, math.tau)
    return Stance(outward.at(end), back_rad, own, True)


def _is_end(view: View, inward: Array, heading: float, radius: float) -> bool:
    """Whether a line goes on from its end: it is no burr, no tip of two lines that part, no mark."""
    seen = view.feel(inward, heading, max(4 * view.width_mm, view.leg_mm))
    long_mm = len(seen) * view.step_mm
    if len(seen) < FEWEST_STATIONS or long_mm < SPUR_WIDTHS * view.width_mm - radius:
        return False
    widths = seen[len(seen) // 4 : -len(seen) // 4, 2]
    grows_mm = median(widths[-4:]) - median(widths[:4])
    if grows_mm > max(GROWS * view.width_mm, GROWS_PX * view.pitch_mm):
        return False
    return not _is_mark(view, inward, heading, radius)


def _is_mark(view: View, inward: Array, heading: float, radius: float) -> bool:
    """Whether the end is that of a stop mark across another line, or beside it."""
    longest = longest_mm(view)
    seen = view.feel(inward, heading, longest)
    reach = (len(seen) - 1) * view.step_mm + radius
    if len(seen) < 4 or reach > longest:
        return False
    beyond_mm = BEYOND_WIDTHS * view.width_mm
    on = leg_of(seen, True, view.leg_mm)
    ink = reach_of_ink(view, on, longest + beyond_mm)
    if ink is None:
        return False
    if ink < beyond_mm:
        return reach < longest_mm(view, across=False)
    # the other half, as it is felt, leads to its tip more surely than the first
    beyond = straight_on(view, on, 0.0) or on
    return stroke_end(view, beyond, longest + beyond_mm) is not None
