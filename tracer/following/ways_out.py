"""Ways out: by which leg the head leaves a junction, and which turns the operator asks for.

Signals: the legs around a junction, the head's travel (mm) and count of positions in; the leg to leave by
out, and whether the operator chose it. The junctions are counted here, and the guide lines taken there.

Source: patent ES 361967, section on use: guide lines to drill points, taken at the operator's wish.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import chain
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import direction
from morfax.tracer.corrections.on_sheet import REACH_MM, REACH_WIDTHS, TurnAt
from morfax.tracer.following.felt_line import nearest_station, station_before
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.plan import Plan
from morfax.tracer.junctions.choice import Asked, Choice, WayIn, is_aside, survey
from morfax.tracer.junctions.guides import AGAIN_MM, PassedJunctions
from morfax.tracer.junctions.planner import Planner
from morfax.tracer.junctions.rings import fork_in
from morfax.tracer.marks.dots import disc, dot_ahead
from morfax.tracer.sensing.leg import FEWEST_STATIONS, Leg, goes_straight, leg_of, turns_off
from morfax.tracer.sensing.side import SIDES, Side
from morfax.tracer.sensing.view import View

# cosine of 60 degrees: a head so far off the side that a correction names is another's
COMES_FROM = 0.5


class Turns(NamedTuple):
    """How the head is to leave the junctions, numbered from 0.

    At the junctions in `other` it takes the second straightest leg, the third where a number stands twice. At
    the first, the second … it turns off to its side in `sides`, where there is one, and comes back if the
    line that it takes ends; with `back_from_tips` also from where two lines end together. At the places `at`
    it goes as the operator's corrections say, and comes back from nowhere. With
    `by_stations` the slow cell does not lead.
    """

    other: tuple[int, ...] = ()
    sides: tuple[Side | None, ...] = ()
    back_from_tips: bool = False
    by_stations: bool = False
    at: tuple[TurnAt, ...] = ()


STRAIGHT_ON = Turns()


@dataclass(slots=True)
class WaysOut:
    """Chooses the leg by which the head leaves a junction."""

    turns: Turns
    from_reference: bool  # the head sets out from a reference point
    junctions: PassedJunctions = field(default_factory=PassedJunctions)
    served: set[int] = field(
        default_factory=set
    )  # numbers of the corrections that the head went by
    # numbers of the junctions at which other turns were asked for, or would have been
    asked_at: set[int] = field(default_factory=set)

    def fork(self, view: View, seen: Array, here: int, carriage: Carriage) -> int | None:
        """The station of a felt line (n, 3), ahead of `here`, from which the head goes on by legs; None if
        the line runs on clean.
        """
        told = self.told_station(view, seen, here)
        fork = fork_in(view, seen, here) if told is None else told
        if fork is not None or not carriage.ink_beside:
            return fork
        station, incoming = station_before(view, seen, here, carriage.tuning.guard_lead_mm)
        return station if self.leaves_beside(view, incoming, carriage) else None

    def told_station(self, view: View, seen: Array, here: int) -> int | None:
        """The station of a felt line (n, 3), ahead of `here`, at which a leg ends before a junction of which
        the operator has said how to go through; None without one.
        """
        back = round(view.width_mm / view.step_mm)
        for turn_at in self.turns.at:
            station = nearest_station(seen, np.array(turn_at.place_mm))
            before = max(station - back, FEWEST_STATIONS)
            is_ahead = here < station and before < len(seen)
            if is_ahead and _told_by(
                view, leg_of(seen[: before + 1], True, view.leg_mm), turn_at
            ):
                return before
        return None

    def as_told(self, planner: Planner, incoming: Leg, carriage: Carriage) -> Plan | None:
        """The way out of a junction of which the operator has said how to go through; None without one."""
        view = planner.view
        told = [one for one in self.turns.at if _told_by(view, incoming, one)]
        if not told:
            return None
        one = min(told, key=lambda each: math.dist(each.place_mm, incoming.end_mm))
        side: Side | None = None if one.do not in SIDES else one.do
        way_in = WayIn(view, incoming, carriage.trail)
        found = survey(way_in, Asked(side=side, straight=side is None))
        if side is not None and (found.leg is None or not is_aside(incoming, found.leg, side)):
            return None
        plan = planner.as_told(incoming, found, straight=side is None)
        if plan is not None:
            self.served.add(one.number)
            if found.choices > 1:
                self.junctions.come_to(partial(_place_of, way_in, found), carriage.travel_mm)
        return plan

    def chosen(self, view: View, incoming: Leg, carriage: Carriage) -> tuple[Choice, bool]:
        """The way out of a junction, and whether the operator asked for it."""
        trail, travel_mm = carriage.trail, carriage.travel_mm
        if self.comes_back(view, incoming):
            self.junctions.is_back(carriage.count, travel_mm)
            return survey(WayIn(view, incoming, trail)), True
        number = self.junctions.next(travel_mm)
        side = self.turns.sides[number] if number < len(self.turns.sides) else None
        leads = number == 0 and self.from_reference
        rank = self.rank(number)
        way_in = WayIn(view, incoming, trail)
        found = survey(way_in, Asked(rank, side, leads))
        if found.choices > 1:
            self.junctions.come_to(partial(_place_of, way_in, found), travel_mm)
            turns_aside = side is not None and not goes_straight(incoming, found.leg)
            if turns_aside and goes_straight(incoming, survey(way_in).leg):
                self.junctions.take(_place_of(way_in, found), carriage.count)
        return found, side is not None

    def leaves_beside(self, view: View, incoming: Leg, carriage: Carriage) -> bool:
        """Whether the head leaves a clean line where ink turns off beside it; else counts the junction."""
        number = self.junctions.next(carriage.travel_mm)
        asked = self.rank(number) > 0 or any(self.turns.sides[number : number + 1])
        if asked or self.comes_back(view, incoming):
            return True
        way_in = WayIn(view, incoming, carriage.trail)
        found = survey(way_in)
        if found.choices > 1:
            self.junctions.come_to(partial(_place_of, way_in, found), carriage.travel_mm)
        return False

    def rank(self, number: int) -> int:
        """Which leg the head takes at a junction: 0 the straightest, 1 the second straightest …"""
        self.asked_at.add(number)
        return self.turns.other.count(number)

    def comes_back(self, view: View, incoming: Leg) -> bool:
        """Whether the head is back at the junction where it took a guide line: a speck may end the clean line
        before it.
        """
        return self.junctions.comes_back(incoming.end_mm, 2 * view.width_mm + AGAIN_MM)


def _place_of(way_in: WayIn, found: Choice) -> Array:
    """Where a junction is: where the way in meets the way out, or else a line that turns off."""
    incoming = way_in.incoming
    turned = (survey(way_in, Asked(side=side)) for side in SIDES)
    for leg, corner, _ in chain([found], turned):
        if corner is not None and leg is not None and turns_off(incoming, leg):
            return corner.vertex_mm
    return incoming.end_mm


def _told_by(view: View, incoming: Leg, turn_at: TurnAt) -> bool:
    """Whether a correction is about the junction ahead of a leg, and about a head that comes by that leg."""
    reach_mm = max(REACH_MM, REACH_WIDTHS * view.width_mm)
    way = turn_at.place_mm - incoming.end_mm
    ahead = direction(incoming.heading_rad)
    along, aside = float(way @ ahead), abs(float(way[1] * ahead[0] - way[0] * ahead[1]))
    if not -view.width_mm < along < 2 * reach_mm or aside > reach_mm:
        return False
    if turn_at.coming_from_mm is None:
        return True
    come = np.subtract(turn_at.place_mm, turn_at.coming_from_mm)
    return bool(come @ ahead > COMES_FROM * float(np.hypot(*come)))


def leads_to_dot(view: View, incoming: Leg, outgoing: Leg | None) -> bool:
    """Whether a junction is a dot, or the leg out leads to one: no pen's width explains that ink."""
    if outgoing is None:
        return False
    if dot_ahead(view, outgoing):
        return True
    if not goes_straight(incoming, outgoing):
        return False
    way = outgoing.end_mm - incoming.end_mm
    return disc(view, incoming.end_mm + 0.5 * way, way) is not None


def aimed_at(incoming: Leg, dot: Array) -> Leg:
    """The leg from its clean end straight to a dot."""
    way = dot - incoming.end_mm
    return replace(incoming, heading_rad=math.atan2(way[1], way[0]), bend_per_mm=0.0)
