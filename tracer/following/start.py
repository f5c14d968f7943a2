"""Putting the head down: where on a line it can start, and what it sees there.

Signals: a drawing and places near the middle of a line in; a stance out: place on the line's centre, heading,
the line's width and darkness.

A ring of cells about a place sees two arcs opposite each other when the place is on a clean line; between
them lies the heading. The line is then felt both ways, and of several places the one is taken from which it
can be felt furthest, and is straightest.

Source: patent ES 361967, section on use: the operator brings the head over the drawing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.head.course import FELT_LEGS
from morfax.tracer.head.stance import Stance
from morfax.tracer.junctions.choice import straight_on
from morfax.tracer.marks.marks import longest_mm
from morfax.tracer.marks.reference import Reference, references
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.leg import Leg, centre_at, leg_of, turn
from morfax.tracer.sensing.probe import end_of, reach_of_ink, stroke_end, strokes_on
from morfax.tracer.sensing.view import LEVEL, View

CATCH_MM = 3.0  # how far from a given place the line may be
APERTURE = 0.3  # of the line's width, within bounds that a scan's noise and a corner set
LEAST_APERTURE_MM, LARGEST_APERTURE_MM = 0.1, 0.24
AT_END_MM = 1.5  # a start nearer to an open end is that end
# at most, from the middle of a reference point to the lead line that comes from it
LEAD_MM = 11.0
# a cross or ring nearer to the reference point that is named is that point, drawn
NAMED_MM = 5.0
LEADS_AWAY = math.radians(45)
SPUR = 2.7  # a line that ends sooner, in widths, is a burr
GROWS, GROWS_PX = (
    0.08,
    0.4,
)  # widths, or pixels: along half of what is felt of it the tip of two lines widens so much
PLACES = 80  # tried along a line
ENDS = 6  # open ends that are tried: a lead line may begin at any
BENT = 0.8  # times a leg's length: a line that bends by more is no parabola over so much of it


def put_down(
    drawing: Drawing | Sheet,
    start_mm: tuple[float, float] | None,
    aperture_mm: float | None,
    line_width_mm: float | None,
    gap_mm: float = 0.5,
    reference_mm: tuple[float, float] | None = None,
) -> Iterator[tuple[Stance, float]]:
    """Put the head down near a place, or on the longest line: where it comes from a reference point, else at
    its open ends if it has any (there), then where it is smooth, the plainest place first; and the line's
    length, mm.

    A reference point that is not given is looked for. Raises LineFault if there is no line near the place, or
    no clean stretch on the line.
    """
    sheet = drawing if isinstance(drawing, Sheet) else Sheet.of(drawing)
    catch_mm = max(CATCH_MM, 12 * sheet.drawing.pitch_mm)
    stroke = sheet.longest() if start_mm is None else sheet.nearest(start_mm, catch_mm)
    view = view_of(sheet, aperture_mm, line_width_mm or stroke.width_mm)
    if start_mm is None:
        at_ends = _at_ends(view, sheet, stroke, gap_mm, reference_mm)
    else:
        ends = stroke.ends_mm()
        near = ends[
            np.hypot(*(ends - np.asarray(start_mm)).T) < max(AT_END_MM, 3 * view.width_mm)
        ]
        at_ends = [
            stance for place in near if (stance := _at_end(view, place, gap_mm)) is not None
        ]
    for stance in at_ends[:ENDS]:
        yield stance, stroke.length_mm
    stances = _stances(view, _tried(stroke, start_mm, 2 * stroke.width_mm))
    if not stances and start_mm is not None:
        stances = _stances(view, _tried(stroke, start_mm, catch_mm))
    stances.sort(key=lambda scored: scored[0], reverse=True)
    for _, stance in stances if start_mm is None else stances[:1]:
        yield stance, stroke.length_mm
    if not stances and not at_ends:
        solid = (
            "follow the edges of a filled shape with --edge, "
            if sheet.are_solid[stroke.patch]
            else ""
        )
        raise LineFault(
            f"no clean stretch of line {view.width_mm:.2f} mm wide to start on;"
            f" {solid}{'give' if line_width_mm is None else 'give another'} --line-width, or --start X,Y at a plain stretch"
        )


def stance_near(view: View, stroke: Stroke, place_mm: tuple[float, float]) -> Stance | None:
    """The plainest stance within two widths of a place of a line; None if the line is clean nowhere there."""
    stances = _stances(view, _tried(stroke, place_mm, 2 * stroke.width_mm))
    return max(stances, key=lambda scored: scored[0])[1] if stances else None


def ends_of(
    sheet: Sheet,
    stroke: Stroke,
    aperture_mm: float | None,
    line_width_mm: float | None,
    gap_mm: float,
    reference_mm: tuple[float, float] | None,
) -> list[tuple[Stance, float]]:
    """Stances at the open ends of one of the lines, and its length, mm."""
    view = view_of(sheet, aperture_mm, line_width_mm or stroke.width_mm)
    at_ends = _at_ends(view, sheet, stroke, gap_mm, reference_mm)
    return [(stance, stroke.length_mm) for stance in at_ends[:ENDS]]


def reference_on(drawing: Drawing) -> tuple[float, float]:
    """The place of the only reference point of a drawing, mm; raises LineFault if there is none, or several."""
    sheet = Sheet.of(drawing)
    line = sheet.longest()
    found = list(references(sheet, view_of(sheet, None, line.width_mm), line))
    if len(found) == 1:
        return found[0].place_mm
    places = "; ".join(
        f"{x:.1f},{y:.1f}" for x, y in (reference.place_mm for reference in found[:8])
    )
    what = f"{len(found)} crosses and rings, at {places}" if found else "no small cross or ring"
    raise LineFault(
        f"no reference point is certain: there is {what}; give its place, X,Y in mm, instead"
    )


def view_of(sheet: Sheet, aperture_mm: float | None, width_mm: float) -> View:
    """The sheet through cells for a line of a width."""
    least_mm = LEAST_APERTURE_MM / sheet.drawing.enlarged
    aperture_mm = aperture_mm or min(max(APERTURE * width_mm, least_mm), LARGEST_APERTURE_MM)
    return View(
        photocell.behind_aperture(sheet.drawing, aperture_mm),
        width_mm,
    )


def _at_ends(
    view: View,
    sheet: Sheet,
    stroke: Stroke,
    gap_mm: float,
    reference_mm: tuple[float, float] | None,
) -> list[Stance]:
    """Stances at the open ends of a line, that which comes from a reference point first."""
    ends = [
        stance
        for place in stroke.ends_mm()
        if (stance := _at_end(view, place, gap_mm)) is not None
    ]
    named = [] if reference_mm is None else _from_reference(reference_mm, ends)
    if named:
        return named
    leading = None if reference_mm is None else _leading_away(view, stroke, reference_mm)
    if leading is not None:
        return [leading]
    for place_mm, lead in _named_first(references(sheet, view, stroke), reference_mm):
        if lead is not None and stroke.is_at(lead.end_mm):
            local = view.like(lead.end_mm, lead.heading_rad)
            return [Stance(lead.end_mm, lead.heading_rad, local, True, place_mm)]
        from_it = _from_reference(place_mm, ends)
        if from_it:
            return from_it
    return ends


def _leading_away(
    view: View, stroke: Stroke, reference_mm: tuple[float, float]
) -> Stance | None:
    """The stance on the only line that leads away from what is drawn about a reference point, whatever that
    is; None if there is no such line.
    """
    place = np.asarray(reference_mm)
    local = _local(view, stroke.middles_mm[np.argmin(np.hypot(*(stroke.middles_mm - place).T))])
    for radius in np.arange(view.width_mm, LEAD_MM, 0.5 * view.width_mm):
        arcs = local.ring(place, radius)
        if len(arcs) != 1:
            continue
        heading = float(arcs.mean())
        start = place + radius * np.array([math.cos(heading), math.sin(heading)])
        seen = local.feel(start, heading, 2 * local.leg_mm)
        if stroke.is_at(start) and (len(seen) - 1) * local.step_mm > 1.5 * local.leg_mm:
            leg = leg_of(seen, False, local.leg_mm)
            return Stance(
                leg.end_mm,
                leg.heading_rad,
                replace(local, width_mm=leg.width_mm),
                True,
                reference_mm,
            )
    return None


def _named_first(
    found: Iterator[Reference], named_mm: tuple[float, float] | None
) -> Iterator[tuple[tuple[float, float], Leg | None]]:
    """Places of reference points and the lead lines drawn from them; of those that the operator's is, his
    place, and before the others.
    """
    for reference in (
        found
        if named_mm is None
        else sorted(found, key=lambda r: math.dist(named_mm, r.place_mm))
    ):
        is_named = named_mm is not None and math.dist(named_mm, reference.place_mm) < NAMED_MM
        yield (
            named_mm if named_mm is not None and is_named else reference.place_mm,
            reference.lead,
        )


def _from_reference(place_mm: tuple[float, float], ends: list[Stance]) -> list[Stance]:
    """The stances at ends that are near a reference point and lead away from it."""
    out = []
    for end in ends:
        way = end.place_mm - np.asarray(place_mm)
        away = float(np.hypot(*way))
        ahead = abs(turn(math.atan2(way[1], way[0]), end.heading_rad)) < LEADS_AWAY
        if away < LEAD_MM and (ahead or away < 0.5 * end.view.width_mm):
            out.append((away, replace(end, reference_mm=place_mm)))
    return [stance for _, stance in sorted(out, key=lambda found: found[0])]


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
        out.append(
            (
                (length, -abs(middle.bend_per_mm)),
                Stance(middle.end_mm, middle.heading_rad, local),
            )
        )
    return out


def _local(view: View, place: Array) -> View:
    """The view with the level at half the darkness of this place."""
    return view.at_level(LEVEL * max(view.darkness_at(place), 0.2))


def _heading(view: View, place: Array) -> float | None:
    """Heading of the line through a place, from the two arcs that a ring sees; None if it does not see two,
    opposite.
    """
    radius = max(0.9 * view.width_mm, 4.5 * view.pitch_mm)
    arcs = view.ring(place, radius)
    if len(arcs) != 2:
        return None
    there, back = arcs.mean(axis=1)
    if abs(turn(there, back + math.pi)) > math.radians(35):
        return None
    return float(there + 0.5 * turn(there, back + math.pi))


def _both_ways(view: View, place: Array, heading: float) -> tuple[Leg, float] | None:
    """The line felt forward and backward from a place as one leg about it, and the length felt on the shorter
    side, mm.
    """
    right, left = view.edges(place, heading, 2 * view.width_mm)
    if not math.isfinite(left - right) or not 0.4 < (left - right) / view.width_mm < 2.5:
        return None
    view = replace(view, width_mm=left - right)
    length = 1.5 * view.leg_mm
    ahead, behind = (
        view.feel(place, heading, length),
        view.feel(place, heading + math.pi, length),
    )
    shorter = min(len(ahead), len(behind))
    if shorter < 6:
        return None
    both = np.vstack([behind[shorter - 1 : 0 : -1], ahead[:shorter]])
    middle = centre_at(both, shorter - 1, 0.6 * view.leg_mm)
    if abs(middle.bend_per_mm) * view.leg_mm > BENT:
        middle = centre_at(both, shorter - 1, FELT_LEGS * view.leg_mm)
    return middle, round((shorter - 1) * view.step_mm, 1)


def _at_end(view: View, place: Array, gap_mm: float) -> Stance | None:
    """A stance at an open end of the line, heading inward; None if there is none at this place."""
    local = _local(view, place)
    radius = max(1.5 * view.width_mm, 6 * view.pitch_mm)
    arcs = strokes_on(local, place, radius)
    if len(arcs) != 1 or arcs[0, 1] - arcs[0, 0] > math.pi / 2:
        return None
    heading = float(arcs.mean())
    inward = place + radius * np.array([math.cos(heading), math.sin(heading)])
    right, left = local.edges(inward, heading, 2 * local.width_mm)
    if not abs(left - right - view.width_mm) < 0.25 * view.width_mm + 0.5 * view.pitch_mm:
        return None
    local = replace(local, width_mm=left - right)
    if not _is_end(local, inward, heading, radius):
        return None
    outward = leg_of(local.feel(inward, heading + math.pi, local.leg_mm), True, local.leg_mm)
    end = end_of(local, outward)
    if end is None or straight_on(local, outward, gap_mm) is not None:
        return None  # the edge of a gap
    local = replace(local, width_mm=outward.width_mm)
    return Stance(
        outward.at(end),
        math.remainder(outward.heading_at(end) + math.pi, math.tau),
        local,
        True,
    )


def _is_end(view: View, inward: Array, heading: float, radius: float) -> bool:
    """Whether a line goes on from its end: not a burr, not the tip of two lines that part, not a mark on
    another line.
    """
    seen = view.feel(inward, heading, max(4 * view.width_mm, view.leg_mm))
    if len(seen) * view.step_mm < SPUR * view.width_mm - radius:
        return False
    middle = seen[len(seen) // 4 : -len(seen) // 4, 2]
    if np.median(middle[-4:]) - np.median(middle[:4]) > max(
        GROWS * view.width_mm, GROWS_PX * view.pitch_mm
    ):
        return False
    return not _is_mark(view, inward, heading, radius)


def _is_mark(view: View, inward: Array, heading: float, radius: float) -> bool:
    """Whether the end of a line is that of a stop mark across another line, or beside it."""
    longest = longest_mm(view)
    seen = view.feel(inward, heading, longest)
    reach = (len(seen) - 1) * view.step_mm + radius
    if len(seen) < 4 or reach > longest:
        return False
    on = leg_of(seen, True, view.leg_mm)
    ink = reach_of_ink(view, on, longest + 2 * view.width_mm)
    if ink is None:
        return False
    if ink < 2 * view.width_mm:
        return reach < longest_mm(view, across=False)
    beyond = (
        straight_on(view, on, 0.0) or on
    )  # the other half, as it is felt, leads to its tip more surely than the first
    return stroke_end(view, beyond, longest + 2 * view.width_mm) is not None
