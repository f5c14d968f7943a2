"""The felt line: the stations that the head feels along its line, behind the axis and ahead of it.

Signals: a view, the carriage and a place from which the line is clean in; stations (n, 3), x, y and width in
sheet mm, out; and a stretch of them for the slow cell (see `head.slow_cell`).

Source: our own; an operator looks along the line in the same way.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.plane import heading_between
from morfax.motion.polyline import at_lengths, between_corners, length_mm, lengths_mm
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.leaders import STATIONS
from morfax.tracer.head.plan import Plan
from morfax.tracer.head.slow_cell import FeltStretch, keeps_mm, keeps_straight_mm, rough_mm
from morfax.tracer.head.windows import shortest_lead_mm
from morfax.tracer.limits import CLEAR_WIDTHS
from morfax.tracer.sensing.leg import FEWEST_STATIONS, Leg, leg_of
from morfax.tracer.sensing.ray import edges
from morfax.tracer.sensing.scout import REACH, REACH_PX
from morfax.tracer.sensing.view import View

FROM_BEHIND = (1.0, 0.6, 0.3)  # legs behind the axis: nearer, if a speck spoils the first place
# of the lead, before what stops the slow cell: room to plan, as a fast head has it; by trial
ROOM_LEADS = 0.4
# where a line is wider something leaves it: of its width, and wider by so many standard deviations of the
# middle of a rough line, whose edges differ by twice as much; by trial
STUB_ROUGH = 8.0
Anchor = tuple[Array, float, float]  # where the line begins to be clean: place, heading, travel


def felt_ahead(view: View, carriage: Carriage, anchor: Anchor) -> tuple[View, Array]:
    """The view of the line, and its stations from behind the axis forward until it is no longer clean."""
    come_mm = carriage.travel_mm - anchor[2]
    for share in FROM_BEHIND:
        back_mm = share * view.leg_mm
        if come_mm > back_mm:
            place, heading = carriage.trail.back(back_mm)
        else:
            (place, heading, _), back_mm = anchor, come_mm
        view = view.like(place, heading)
        length_mm = back_mm + carriage.tuning.guard_lead_mm + view.leg_mm
        seen = view.feel(place, heading, length_mm)
        if len(seen) >= FEWEST_STATIONS:
            break
    return view, seen


def slow_stretch(view: View, carriage: Carriage, plan: Plan) -> FeltStretch | None:
    """What the slow cell is to keep to along a plan that stations made; None along any other."""
    if plan.leader != STATIONS or len(plan.stretches) != 1 or view.on_edge:
        return None
    seen = plan.leg.seen if plan.seen is None else plan.seen
    # a stub that the way ends before may still be a leg of a junction that is not known yet
    stretch = bare_stretch(view, carriage, plan.stretches[0], seen)
    return stretch if stretch is not None and stretch.way is plan.stretches[0] else None


def bare_stretch(view: View, carriage: Carriage, way: Array, seen: Array) -> FeltStretch | None:
    """The part of a way (n, 2) mm along which nothing leaves the line; None if that is too short."""
    clear_mm = math.inf
    bare_mm = _bare_mm(view, way, seen)
    if bare_mm < length_mm(way):
        clear_mm = shortest_lead_mm(carriage.tuning)
        way = way[lengths_mm(way) < bare_mm - clear_mm]
    if len(way) < 2:
        return None
    room_mm = ROOM_LEADS * carriage.tuning.lead_mm
    return FeltStretch(way, keeps_mm(view, seen), room_mm, keeps_straight_mm(view), clear_mm)


def bare_from_mm(view: View, way: Array, seen: Array) -> float | None:
    """From where on along a way (n, 2) mm nothing leaves the line any more, mm; None if nothing does at all,
    or to the way's end.
    """
    way_mm = length_mm(way)
    from_mm = way_mm - _bare_mm(view, way[::-1], seen)
    return from_mm if 0.0 < from_mm < way_mm else None


def _bare_mm(view: View, way: Array, seen: Array) -> float:
    """For how far nothing leaves a line along a way (n, 2) mm, as a stub that draws the cell aside."""
    places = at_lengths(way, np.arange(0.0, length_mm(way), view.step_mm))
    reach_mm = REACH * view.width_mm + REACH_PX * view.pitch_mm
    width_mm = max(view.width_mm, view.usual_mm or 0.0)
    broadest_mm = max(CLEAR_WIDTHS * width_mm, width_mm + STUB_ROUGH * rough_mm(seen))
    bare = int(_bare(view.cells, places, float(reach_mm), float(broadest_mm)))
    return length_mm(way) if bare == len(places) - 1 else bare * view.step_mm


@njit(cache=True, _nrt=False)
def _bare(cells, places, reach_mm, broadest_mm):  # type: ignore[no-untyped-def]
    """Along how many steps of a way (n, 2) mm, at their ends, the line is no broader than so much."""
    for k in range(len(places) - 1):
        heading = heading_between(places, k, k + 1)
        right, left = edges(cells, places[k + 1, 0], places[k + 1, 1], heading, reach_mm)
        if not left - right <= broadest_mm:  # NaN: no edge in reach
            return k
    return len(places) - 1


def clean_from(view: View, carriage: Carriage, plan: Plan) -> Anchor:
    """The place about a leg's length behind the end of a course from which the line was felt clean."""
    seen = plan.seen
    assert seen is not None
    here = nearest_station(seen, plan.leg.end_mm)
    i = max(0, here - round(view.leg_mm / view.step_mm))
    way = seen[i + 2, :2] - seen[i, :2]
    travel_mm = carriage.travel_mm - (here - i) * view.step_mm
    return seen[i, :2], math.atan2(way[1], way[0]), travel_mm


def trail_behind(view: View, carriage: Carriage) -> Array:
    """The last stretch of the trail as stations of the line, (n, 3): not round a corner."""
    stations = round(view.leg_mm / view.step_mm)
    places = np.vstack([carriage.trail.recent()[-stations:], carriage.stands()[0]])
    straight = between_corners(places)[-1]
    if len(straight) >= FEWEST_STATIONS:
        places = straight
    return np.column_stack([places, np.full(len(places), view.width_mm)])


def station_before(view: View, seen: Array, here: int, guard_mm: float) -> tuple[int, Leg]:
    """The station before ink beside a clean line, the guard cells' lead ahead, and the leg up to there."""
    station = here + round(guard_mm / view.step_mm) - 3
    return station, leg_of(seen[: station + 1], True, view.leg_mm)


def nearest_station(seen: Array, place_mm: Array) -> int:
    """Which station of a felt line (n, 3) is nearest to a place."""
    return int(np.argmin(np.hypot(*(seen[:, :2] - place_mm).T)))
