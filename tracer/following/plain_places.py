"""Plain places: where on a line the head can be put down, and what it sees there.

Signals: places near the middle of a line in (mm); stances out: place on the line's middle, heading, the
line's width and darkness.

A ring of cells about a place sees two arcs opposite each other where the line is clean; the heading lies
between them. The line is then felt both ways: a place is the plainer, the further the line can be felt from
it, and the straighter it is.

Source: patent ES 361967, section on use: the operator brings the head over the drawing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.head.course import FELT_LEGS
from morfax.tracer.head.stance import Stance
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.leg import ABOUT_LEGS, FACING, Leg, centre_at, turn
from morfax.tracer.sensing.parabola import leg_about
from morfax.tracer.sensing.photocell import (
    LEVEL,
    Cells,
    darkness_at,
    looks_round,
    ring_along,
    ways_round,
)
from morfax.tracer.sensing.ray import edges
from morfax.tracer.sensing.scout import felt, leg_mm
from morfax.tracer.sensing.view import OtherInk, View

# All limits below were chosen by trial on the test drawings.
APERTURE = 0.3  # of the line's width, within bounds that a scan's noise and a corner set
LEAST_APERTURE_MM, LARGEST_APERTURE_MM = 0.1, 0.24
# a finer cell sees the steps of large pixels, and not the line: so many of the scan's own pixels, and no more
# than so much of the line's width, which would pale. The second pair is for pixels that are paper or ink
# alone, with steps that no lens has softened. By trial on outlines of 1 to 4 pixels, grey and of two levels
STEPS_PX, STEPS_WIDTHS = 1.3, 0.45
HARD_STEPS_PX, HARD_STEPS_WIDTHS = 1.4, 1.0
EDGE_APERTURE_PX = 2.8  # on an edge: a spot of 0.7 pixels, standard deviation
PLACES = 80  # tried along a line
ROUND_WIDTHS = 2.0  # to either side of a place that was asked for, places are tried
FAINTEST = 0.2  # darkness: fainter ink is taken for this dark
RING_WIDTHS, RING_PX = 0.9, 4.5  # radius of the ring of cells about a place: the larger
NARROWEST = 0.4  # times the line's width, or the line's of that: a line of another width is another line
WIDEST = 1 / NARROWEST
FEWEST_STATIONS = 6  # felt to either side
CENTRED = 0.6  # of a leg's length to either side makes the leg about the place
BENT = 0.8  # rad in a leg's length: a line that bends by more is no parabola over that length


def view_of(sheet: Sheet, aperture_mm: float | None, width_mm: float) -> View:
    """The sheet through cells for a line of a width."""
    aperture_mm = aperture_mm or aperture_for(sheet.drawing, width_mm)
    # a line's ends and its plain places are looked for in turn: its sheet is made once for both
    if aperture_mm not in sheet.seen:
        sheet.seen.clear()
        cells = photocell.behind_aperture(sheet.drawing, aperture_mm, window=sheet.window)
        sheet.seen[aperture_mm] = cells
    cells, drawing = sheet.seen[aperture_mm], sheet.drawing
    others = OtherInk(sheet.taken, sheet.patch_at) if sheet.taken else None
    return View(cells, width_mm, parted=drawing.finer, grainy=drawing.grainy, others=others)


def edge_view_of(drawing: Drawing, aperture_mm: float | None) -> View:
    """The filled shapes of a sheet through cells for their edges."""
    from morfax.tracer.drawing.spacing import EDGE_MM

    assert drawing.shade is not None
    pitch_mm = drawing.pitch_mm * drawing.enlarged
    aperture_mm = aperture_mm or EDGE_APERTURE_PX * pitch_mm
    if aperture_mm not in drawing.edge_cells:
        shade = replace(drawing, darkness=drawing.shade, pitch_mm=pitch_mm)
        drawing.edge_cells[aperture_mm] = photocell.behind_aperture(shade, aperture_mm)
    return View(drawing.edge_cells[aperture_mm], EDGE_MM, on_edge=True)


def aperture_for(drawing: Drawing, width_mm: float) -> float:
    """The aperture of the cells for a line of a width, mm."""
    least_mm = LEAST_APERTURE_MM / drawing.enlarged
    usual_mm = min(max(APERTURE * width_mm, least_mm), LARGEST_APERTURE_MM)
    steps_px, widths = STEPS_PX, STEPS_WIDTHS
    if drawing.is_hard:
        steps_px, widths = HARD_STEPS_PX, HARD_STEPS_WIDTHS
    steps_mm = steps_px * drawing.finer * drawing.pitch_mm
    return max(usual_mm, min(steps_mm, widths * width_mm))


def local_view(view: View, place: Array) -> View:
    """The view with the level at half the darkness of this place."""
    return view.at_level(LEVEL * max(view.darkness_at(place), FAINTEST))


def stance_near(view: View, stroke: Stroke, place_mm: tuple[float, float]) -> Stance | None:
    """The plainest stance near a place of a line; None if the line is clean nowhere there."""
    about_mm = ROUND_WIDTHS * stroke.width_mm
    return next(plainest_first(view, places_of(stroke, place_mm, about_mm)), None)


def stands_near(view: View, stroke: Stroke, place_mm: tuple[float, float]) -> bool:
    """Whether there is such a stance: the first that is found will do."""
    places = places_of(stroke, place_mm, ROUND_WIDTHS * stroke.width_mm)
    if view.on_edge:
        return any(_stance_at(view, place) is not None for place in places)
    return any(_scores(view, places[k : k + 1])[0, 0] > 0 for k in range(len(places)))


def places_of(
    stroke: Stroke, start_mm: tuple[float, float] | None, about_mm: float = 0.0
) -> Array:
    """Places of a line to try: all along it, or about the place nearest to a start."""
    places = stroke.middles_mm
    if start_mm is not None:
        away = np.hypot(*(places - np.asarray(start_mm)).T)
        places = places[away <= away.min() + about_mm]
    return places[:: max(1, len(places) // PLACES)]


def plainest_first(view: View, places: Array) -> Iterator[Stance]:
    """Stances at those places where the line is clean, the plainest first.

    A place is the plainer, the further the line was felt to the shorter side; then, the less it bends.
    """
    if view.on_edge:
        found = [each for place in places if (each := _stance_at(view, place)) is not None]
        found.sort(key=lambda each: each[1:], reverse=True)
        yield from (stance for stance, _, _ in found)
        return
    # the kernel only tells in which order they come
    scores = _scores(view, places)
    felt_mm, bends = np.round(scores[:, 0], 1).tolist(), scores[:, 1].tolist()
    clean = np.flatnonzero(scores[:, 0] > 0).tolist()
    for k in sorted(clean, key=lambda k: (felt_mm[k], -bends[k]), reverse=True):
        if (found_there := _stance_at(view, places[k])) is not None:
            yield found_there[0]


def _scores(view: View, places: Array) -> Array:
    """How far the line is felt to the shorter side of each place, mm, 0 where it is not clean; and its bend
    there, 1/mm.
    """
    scores = np.empty((len(places), 2))
    _score(view.cells, np.ascontiguousarray(places), (view.width_mm, view.step_mm), scores)
    return scores


def _stance_at(view: View, place: Array) -> tuple[Stance, float, float] | None:
    """The stance at a place, how far the line was felt to the shorter side (mm), and less its bend."""
    local = view if view.on_edge else local_view(view, place)
    heading = _heading(local, place)
    felt_there = None if heading is None else _both_ways(local, place, heading)
    if felt_there is None:
        return None
    middle, length_mm = felt_there
    own = replace(local, width_mm=middle.width_mm)
    stance = Stance(middle.end_mm, middle.heading_rad, own)
    return stance, length_mm, -abs(middle.bend_per_mm)


def _heading(view: View, place: Array) -> float | None:
    """Heading of the line through a place; None if the ring does not see two arcs opposite each other."""
    if view.on_edge:
        found = view.edge_at(place)
        return None if found is None else found[1]
    radius = max(RING_WIDTHS * view.width_mm, RING_PX * view.pitch_mm)
    arcs = view.ring(place, radius)
    if len(arcs) != 2:
        return None
    there, back = arcs.mean(axis=1)
    bend = turn(there, back + math.pi)
    return None if abs(bend) > FACING else float(there + 0.5 * bend)


def _both_ways(view: View, place: Array, heading: float) -> tuple[Leg, float] | None:
    """The line felt both ways from a place as one leg, and the length felt on the shorter side, mm."""
    if not view.on_edge:
        right, left = view.edges(place, heading, 2 * view.width_mm)
        width_mm = left - right
        if not math.isfinite(width_mm) or not NARROWEST < width_mm / view.width_mm < WIDEST:
            return None
        view = replace(view, width_mm=width_mm)
    ahead = view.feel(place, heading, ABOUT_LEGS * view.leg_mm)
    behind = view.feel(place, heading + math.pi, ABOUT_LEGS * view.leg_mm)
    shorter = min(len(ahead), len(behind))
    if shorter < FEWEST_STATIONS:
        return None
    both = np.vstack([behind[shorter - 1 : 0 : -1], ahead[:shorter]])
    middle = centre_at(both, shorter - 1, CENTRED * view.leg_mm)
    if abs(middle.bend_per_mm) * view.leg_mm > BENT:
        middle = centre_at(both, shorter - 1, FELT_LEGS * view.leg_mm)
    return middle, round((shorter - 1) * view.step_mm, 1)


@njit(cache=True)
def _score(cells, places, sizes_mm, out):  # type: ignore[no-untyped-def]
    """Fill `out` with how far the line is felt to the shorter side of each place, mm, and its bend there,
    1/mm; 0 where it is not clean. `sizes_mm`: the line's width, and the distance of stations.
    """
    radius_mm = max(RING_WIDTHS * sizes_mm[0], RING_PX * cells.pitch_mm)
    ways = ways_round(looks_round(cells, radius_mm))
    for k in range(len(places)):
        x, y = places[k, 0], places[k, 1]
        level = LEVEL * max(darkness_at(cells, x, y), FAINTEST)
        now = Cells(cells.darkness, cells.pitch_mm, level, cells.tiles, cells.beyond)
        arcs = ring_along(now, places[k], radius_mm, ways)
        out[k, 0], out[k, 1] = _felt_about(now, places[k], arcs, sizes_mm)


@njit(cache=True)
def _felt_about(cells, place, arcs, sizes_mm):  # type: ignore[no-untyped-def]
    """The same of one place and the arcs of a ring about it, with the steps of `_heading` and
    `_both_ways`.
    """
    (usual_mm, step_mm), pitch_mm = sizes_mm, cells.pitch_mm
    # 1. two arcs of ink opposite each other
    if len(arcs) != 2:
        return 0.0, 0.0
    there, back = 0.5 * (arcs[0, 0] + arcs[0, 1]), 0.5 * (arcs[1, 0] + arcs[1, 1])
    turned = back + math.pi - there
    turned -= math.tau * round(turned / math.tau)
    if abs(turned) > FACING:
        return 0.0, 0.0
    heading = there + 0.5 * turned
    # 2. the line felt both ways
    right, left = edges(cells, place[0], place[1], heading, 2.0 * usual_mm)
    width_mm = left - right
    if not NARROWEST < width_mm / usual_mm < WIDEST:
        return 0.0, 0.0
    own_mm = leg_mm(width_mm, pitch_mm)
    along_mm = step_mm, ABOUT_LEGS * own_mm
    ahead = felt(cells, (place[0], place[1], heading), width_mm, along_mm)
    behind = felt(cells, (place[0], place[1], heading + math.pi), width_mm, along_mm)
    shorter = min(len(ahead), len(behind))
    if shorter < FEWEST_STATIONS:
        return 0.0, 0.0
    # 3. its bend
    both = np.empty((2 * shorter - 1, 3))
    for n in range(shorter):
        for column in range(3):
            both[shorter - 1 - n, column] = behind[n, column]
            both[shorter - 1 + n, column] = ahead[n, column]
    bend = abs(leg_about(both, shorter - 1, CENTRED * own_mm)[3])
    if bend * own_mm > BENT:
        bend = abs(leg_about(both, shorter - 1, FELT_LEGS * own_mm)[3])
    return (shorter - 1) * step_mm, bend
