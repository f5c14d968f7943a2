"""The follower: the head put down on a line, following it, taken through its knots, until the line closes,
ends or is lost.

Signals: a drawing, a place and a heading in; positions of the X and Y screws (n, 2) mm at the motion rate
out, with the ending:

    closed    the head is back where it began, on the same heading
    ended     the line ended
    joined    the line ran into what the head has followed already: a lead line, and the loop that it led to (see `loop`)
    lost      no clean line could be found on from there

Between knots the kernel `head.follow` steers by the swinging cell. At a knot, `knot` says which legs there
are, `course` draws the way through, and the head runs it from memory until the swinging cell stands on the
clean outgoing leg.

Source: patent ES 361967, figure 1. Questions: see `head`, `knot` and `course`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from morfax.motion import curves
from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.tracer.head import course
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.loop import loop_in
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import CHANGED, HOME, MORE, Home
from morfax.tracer.junctions.choice import AHEAD, Way, survey
from morfax.tracer.junctions.guides import Guide, Junctions
from morfax.tracer.junctions.planner import Pilot
from morfax.tracer.junctions.rings import fork_in
from morfax.tracer.junctions.width_change import Onward, another_pen, of_another_pen
from morfax.tracer.marks.dots import disc, dot_ahead, dot_at_end
from morfax.tracer.sensing.leg import Leg, goes_straight, leg_of, turn, turns_off
from morfax.tracer.sensing.probe import end_of
from morfax.tracer.sensing.side import SIDES, Side
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.memory import Tangles

SWELLS = 0.5  # of the change of a clean line's width is usual from then on
# a junction that the head comes back to is no further ahead: a speck may end the clean line before it
BACK_MM = 4.0


@dataclass(slots=True)
class Followed:
    """What the head did: positions (n, 2) mm at the motion rate, how it ended, and the fault if the line was
    lost.
    """

    positions_mm: Array
    ending: str
    heading_rad: float
    travel_mm: float
    view: View
    junctions_mm: tuple[
        tuple[float, float], ...
    ]  # places of the junctions, in the order in which the head came to them
    fault: LineFault | None = None
    # the position at which the loop of a joined line begins: before it is the lead line
    loop_from: int | None = None
    guides: tuple[Guide, ...] = ()
    at_tip: bool = False  # it ended where another line, that has not been followed, ends too
    doubts: tuple[
        tuple[int, int], ...
    ] = ()  # where another way would have done as well: the junction, and the way's rank


Anchor = tuple[
    Array, float, float
]  # a place from which on the line is clean, the heading there, and the travel


class Follower:
    """A head on a line of a drawing."""

    def __init__(
        self,
        stance: Stance,
        settings: Settings,
        rate_hz: float,
        turns: tuple[int, ...] = (),
        sides: tuple[Side | None, ...] = (),
        tips: bool = False,
    ) -> None:
        """Put a head down at a stance.

        At the junctions numbered in `turns` it takes the second straightest leg, the third where a number
        stands twice. At the first, the second … it turns off to its side in `sides`, where there is one, and
        comes back if the line that it takes ends; with `tips` also from where two lines end together.
        """
        self.view, self.settings, self.stance = stance.view, settings, stance
        self._junctions, self._turns, self._sides, self._tips = Junctions(), turns, sides, tips
        self._at_tip = False
        self.carriage = Carriage(stance, settings, rate_hz)
        self._tangles = Tangles()
        self._away_mm = max(4 * self.carriage.tuning.lead_mm, 3.0 * self.view.width_mm)
        self._aim(self._first_leg(stance))

    def follow(
        self, longest_mm: float, told: Callable[[float], None] | None = None
    ) -> Followed:
        """Follow until the line closes, ends or is lost; `told` hears the travel in mm. `longest_mm` bounds a
        run in circles.
        """
        x_mm, y_mm = self.stance.place_mm
        home = Home(x_mm, y_mm, self.stance.heading_rad, self._away_mm)
        while self.carriage.travel_mm < longest_mm:
            why = self.carriage.follow(self.view, home)
            if told is not None:
                told(self.carriage.travel_mm)
            if why == HOME:
                self.carriage.run([self._way_home()])
                return self._done("closed")
            if self.carriage.trail.comes_again(self.view.width_mm):
                return self._done(
                    "joined"
                )  # before the next junction, whose other legs have been followed
            if why == CHANGED:
                self.view = self.view.like(*self.carriage.stands(), follows=SWELLS)
                self.carriage.retune(self.view)
                continue
            if why != MORE and self.settings.direct_rad_s_mm > 0:
                why_lost = "the swinging cell sees no more ink, and this head has no guard cells to find on by"
                return self._lost(
                    why_lost, "go slower there with --speed, or follow with --head precise"
                )
            if why != MORE:
                ending = self._through_knot()
                if ending is not None:
                    return ending
        return self._lost("the head has gone round without coming back to its start")

    def _through_knot(self) -> Followed | None:
        """Take the head through the knot ahead; what it did in all, if that was the end."""
        seen = self._feel_ahead()
        if len(seen) < 4 or self.carriage.ahead(seen[-1, :2]) < 0:
            seen = (
                self._trail_behind()
            )  # not clean even behind the axis, but that has been on the line
        here = int(np.argmin(np.hypot(*(seen[:, :2] - self.carriage.stands()[0]).T)))
        if (len(seen) - here) * self.view.step_mm > self.view.leg_mm:
            fork = fork_in(self.view, seen, here)
            if fork is None and self.carriage.ink_beside:
                fork = self._turn_off(seen, here)
            if fork is not None:
                return self._through_legs(leg_of(seen[: fork + 1], True, self.view.leg_mm))
            sharp = self._pilot().round_corner(seen, here)
            if sharp is not None:
                return self._pass(*sharp)
            nodes, leg = course.nodes_along(self.view, self.carriage.stands(), seen)
            if leg is not None:
                return self._pass([course.through_nodes(nodes)], leg, seen)
        return self._through_legs(leg_of(seen, True, self.view.leg_mm))

    def _through_legs(self, incoming: Leg) -> Followed | None:
        """Take the head from an incoming leg out of the knot, by a leg that leads on; what it did in all, if
        there is none.
        """
        way, asked = self._survey(incoming)
        dot = None if goes_straight(incoming, way[0]) else dot_at_end(self.view, incoming)
        if dot is not None:
            return self._end(_aimed_at(incoming, dot), math.dist(incoming.end_mm, dot))
        if way[0] is not None and another_pen(self.view, way[0]):
            plan = self._pilot().onward(incoming, Onward(self.view, way[0], way[1]))
            if plan is not None:
                return self._pass(*plan)
        plan, choices = self._pilot().along_legs(incoming, way)
        explained = self._is_dot(incoming, way[0])
        if not asked and not explained:
            number, way_in = (
                self._junctions.next(self.carriage.travel_mm),
                self.carriage.stands(),
            )
            plan, explained = self._tangles.way_out(
                self.view,
                incoming,
                self.carriage.trail,
                way_in,
                plan,
                number,
                self._turns.count(number),
            )
        if plan is None and not choices:
            other = of_another_pen(self.view, incoming, self.carriage.trail)
            plan = None if other is None else self._pilot().onward(incoming, other)
            if other is not None and plan is not None:
                self.view = other.view
                return self._pass(*plan)
        if not explained:
            plan = self._pilot().past(incoming, way) or plan
        return self._at_end(incoming, choices) if plan is None else self._pass(*plan)

    def _is_dot(self, incoming: Leg, outgoing: Leg | None) -> bool:
        """Whether the knot between two legs that go straight on is a dot on the line, or the leg out of it
        leads to one: no pen drew that by its width.
        """
        if outgoing is None or dot_ahead(self.view, outgoing):
            return outgoing is not None
        if not goes_straight(incoming, outgoing):
            return False
        way = outgoing.end_mm - incoming.end_mm
        return disc(self.view, incoming.end_mm + 0.5 * way, way) is not None

    def _pilot(self) -> Pilot:
        """Who plans the way on from where the head is."""
        return Pilot(self.view, self.carriage.stands(), self.carriage.trail, self.settings)

    def _feel_ahead(self) -> Array:
        """The line felt from behind the axis forward until it is no longer clean, (n, 3)."""
        leg_mm, come_mm = self.view.leg_mm, self.carriage.travel_mm - self._anchor[2]
        for share in (1.0, 0.6, 0.3):  # nearer, if a speck spoils the first place
            back_mm = share * leg_mm
            if come_mm > back_mm:
                place, heading = self.carriage.trail.back(back_mm)
            else:
                (place, heading, _), back_mm = self._anchor, come_mm
            self.view = self.view.like(place, heading)
            seen = self.view.feel(
                place, heading, back_mm + self.carriage.tuning.guard_lead_mm + leg_mm
            )
            if len(seen) >= 4:
                break
        return seen

    def _trail_behind(self) -> Array:
        """The last stretch of the trail as stations of the line, (n, 3)."""
        places = np.vstack(
            [
                self.carriage.trail.recent()[-round(self.view.leg_mm / self.view.step_mm) :],
                self.carriage.stands()[0],
            ]
        )
        return np.column_stack([places, np.full(len(places), self.view.width_mm)])

    def _survey(self, incoming: Leg) -> tuple[Way, bool]:
        """The way out of a knot, as the operator has it at a junction, and whether it is the operator's."""
        trail, went = self.carriage.trail, self.carriage.count
        if self._comes_back(incoming):
            self._junctions.is_back(went, self.carriage.travel_mm)
            return survey(self.view, incoming, trail), True
        number = self._junctions.next(self.carriage.travel_mm)
        side = self._sides[number] if number < len(self._sides) else None
        leads = number == 0 and self.stance.reference_mm is not None
        found = outgoing, _, choices = survey(
            self.view, incoming, trail, self._turns.count(number), side, leads=leads
        )
        if choices > 1:
            place = self._place_of(incoming, found)
            self._junctions.come_to(place, self.carriage.travel_mm)
            if (
                side is not None
                and not goes_straight(incoming, outgoing)
                and self._goes_on(incoming)
            ):
                self._junctions.take(place, went)
        return found, side is not None

    def _goes_on(self, incoming: Leg) -> bool:
        """Whether a line goes straight on at a junction."""
        return goes_straight(incoming, survey(self.view, incoming, self.carriage.trail)[0])

    def _turn_off(self, seen: Array, here: int) -> int | None:
        """The station before ink beside a clean line, if the head is to leave the line there; None to go by."""
        station = here + round(self.carriage.tuning.guard_lead_mm / self.view.step_mm) - 3
        incoming = leg_of(seen[: station + 1], True, self.view.leg_mm)
        number = self._junctions.next(self.carriage.travel_mm)
        if (
            number in self._turns
            or any(self._sides[number : number + 1])
            or self._comes_back(incoming)
        ):
            return station
        found = survey(self.view, incoming, self.carriage.trail)
        if found[2] > 1:
            self._junctions.come_to(self._place_of(incoming, found), self.carriage.travel_mm)
        return None

    def _comes_back(self, incoming: Leg) -> bool:
        """Whether the head is back at the junction at which it took a guide line."""
        return self._junctions.comes_back(incoming.end_mm, 2 * self.view.width_mm + BACK_MM)

    def _place_of(self, incoming: Leg, found: Way) -> Array:
        """Where a junction is: where the way out, or else a line that turns off from it, meets the way in."""
        ways = [
            found,
            *(survey(self.view, incoming, self.carriage.trail, side=side) for side in SIDES),
        ]
        met = [
            legs_mm
            for leg, legs_mm, _ in ways
            if legs_mm is not None and leg is not None and turns_off(incoming, leg)
        ]
        return incoming.at(met[0][0]) if met else incoming.end_mm

    def _at_end(self, incoming: Leg, choices: int) -> Followed | None:
        """Run to the end of the line, or to where it meets what was followed before."""
        end = end_of(self.view, incoming)
        if end is None and choices:
            end = 0.0  # all that leads on has been followed
        if end is None:
            return self._lost("no clean line leads on through the ink ahead")
        if self._catches_home(incoming, end):
            return self._across_to_home(incoming, end)
        return self._end(incoming, end, joined=choices > 0)

    def _catches_home(self, incoming: Leg, end_mm: float) -> bool:
        """Whether the end at which the head began is ahead of the end of the line, no further than the line
        may be caught again.
        """
        home, heading = self.stance.place_mm, self.stance.heading_rad
        way = home - incoming.at(end_mm)
        if not self.stance.at_end or np.hypot(*way) > self.settings.recatch_mm:
            return False
        on = incoming.heading_at(end_mm)
        return all(
            abs(turn(on, ahead)) < AHEAD for ahead in (math.atan2(way[1], way[0]), heading)
        )

    def _across_to_home(self, incoming: Leg, end_mm: float) -> Followed:
        """Run to the end of the line, and across the paper to the end at which the head began."""
        way, along = course.onto(*self.carriage.stands(), incoming, end_mm)
        self.carriage.run(
            [np.vstack([way, course.along_leg(incoming, along, end_mm)])],
            self.settings.speed_mm_s,
        )
        self.carriage.run([self._way_home()])
        return self._done("closed")

    def _end(self, incoming: Leg, end_mm: float, *, joined: bool = False) -> Followed | None:
        """Run to an end of the line; back from there, if it is a guide line's, or a tip in which two lines
        have run together.
        """
        way, along = course.onto(*self.carriage.stands(), incoming, end_mm)
        self.carriage.run([np.vstack([way, course.along_leg(incoming, along, end_mm)])])
        self._at_tip = self._tangles.goes_back(
            self.carriage.stands()[0], self.carriage.trail, self.view.width_mm
        )
        to_tip = self._at_tip and self._tips
        if joined and not to_tip:
            return self._done("joined")
        if not self._junctions.turn_round(self.carriage.count) and not to_tip:
            return self._done("ended")
        back = incoming.turned_round()
        self.carriage.swivel(incoming.heading_at(end_mm) + math.pi)
        self.carriage.run([course.along_leg(incoming, end_mm, 0.0)], self.settings.speed_mm_s)
        self._aim(back)
        return None

    def _way_home(self) -> Array:
        """The way onto the place where the head began."""
        return curves.hermite(
            *self.carriage.stands(), self.stance.place_mm, self.stance.heading_rad
        )

    def _pass(
        self, stretches: list[Array], outgoing: Leg, seen: Array | None = None
    ) -> Followed | None:
        """Run a course and go on following at its end; or stop at home if the course passes there. `seen` is
        what was clean on the way.
        """
        cut = self._home_on(stretches)
        if cut is not None:
            self.carriage.run(cut)
            return self._done("closed")
        self.carriage.run(stretches, self.settings.speed_mm_s)
        self._aim(outgoing, None if seen is None else self._clean_from(outgoing, seen))
        return None

    def _clean_from(self, leg: Leg, seen: Array) -> Anchor:
        """The place about a leg's length behind the end of a course from which on the line was felt clean."""
        back = np.hypot(*(seen[:, :2] - leg.end_mm).T)
        here = int(np.argmin(back))
        i = max(0, here - round(self.view.leg_mm / self.view.step_mm))
        way = seen[i + 2, :2] - seen[i, :2]
        return (
            seen[i, :2],
            math.atan2(way[1], way[0]),
            self.carriage.travel_mm - (here - i) * self.view.step_mm,
        )

    def _home_on(self, stretches: list[Array]) -> list[Array] | None:
        """The course up to home, if it passes home on home's heading."""
        if self.carriage.travel_mm < self._away_mm:
            return None
        home, heading = self.stance.place_mm, self.stance.heading_rad
        stretches = [
            curves.distinct(way) for way in stretches
        ]  # a step of no length has no heading
        for k, way in enumerate(stretches):
            near = int(np.argmin(np.hypot(*(way - home).T)))
            step = way[min(near + 1, len(way) - 1)] - way[min(near, len(way) - 2)]
            on_it = np.hypot(*(way[near] - home)) < 0.3 * self.view.width_mm
            if on_it and near > 0 and math.cos(math.atan2(step[1], step[0]) - heading) > 0.8:
                return [*stretches[:k], np.vstack([way[:near], home])]
        return None

    def _first_leg(self, stance: Stance) -> Leg:
        """The line ahead of a stance, as felt."""
        place, heading = stance.place_mm, stance.heading_rad
        seen = self.view.feel(place, heading, self.view.leg_mm)
        leg = leg_of(seen, False, self.view.leg_mm) if len(seen) >= 4 else None
        bend = leg.bend_per_mm if leg is not None else 0.0
        return Leg(place, heading, bend, self.view.width_mm, seen)

    def _aim(self, leg: Leg, clean_from: Anchor | None = None) -> None:
        """Follow from the clean end of a leg; the line is clean from there, or from further back."""
        self.carriage.aim(self.view, leg)
        self._anchor = clean_from or (leg.end_mm, leg.heading_rad, self.carriage.travel_mm)

    def _done(self, ending: str, fault: LineFault | None = None) -> Followed:
        positions = self.carriage.positions_mm
        done = Followed(
            positions,
            ending,
            self.carriage.heading_rad,
            self.carriage.travel_mm,
            self.view,
            tuple(self._junctions.places_mm),
            fault,
            guides=self._junctions.guides(positions),
            at_tip=self._at_tip,
            doubts=self._tangles.doubts(self.carriage.trail, self.view.width_mm),
        )
        return done if ending != "joined" else _without_repeat(done)

    def _lost(
        self, why: str, instead: str = "bridge a gap with --gap, or scan at a higher resolution"
    ) -> Followed:
        """The end of a line that was lost: the fault says where, and what may be done instead."""
        place_mm, heading = self.carriage.stands()
        x, y = place_mm / self.view.enlarged
        travel_mm = self.carriage.travel_mm / self.view.enlarged
        degrees = round(math.degrees(heading)) % 360
        fault = LineFault(
            f"line lost at {x:.2f},{y:.2f} mm, heading {degrees} degrees, after {travel_mm:.1f} mm: {why};"
            f" look at the drawing there, {instead}",
            x_mm=float(x),
            y_mm=float(y),
            heading_rad=heading,
        )
        return self._done("lost", fault)


def _aimed_at(incoming: Leg, dot: Array) -> Leg:
    """The leg from its clean end straight to a dot."""
    way = dot - incoming.end_mm
    return replace(incoming, heading_rad=math.atan2(way[1], way[0]), bend_per_mm=0.0)


def _without_repeat(run: Followed) -> Followed:
    """A joined run cut off where it came back to its own way, with the loop that it made."""
    found = loop_in(run.positions_mm, run.view.width_mm)
    if found is None:
        return run
    first, last = found
    kept = run.positions_mm[: last + 1]
    travel_mm = float(np.hypot(*np.diff(kept, axis=0).T).sum())
    return replace(run, positions_mm=kept, travel_mm=travel_mm, loop_from=first)
