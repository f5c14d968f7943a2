"""The follower: the head follows a line through its junctions until the line closes, ends or is lost.

Signals: a drawing, a place and a heading in; out what the head did (see `followed`): positions of the X and Y
screws (n, 2) mm at the motion rate, and the ending.

Between junctions the head's kernel steers by the swinging cell. At a junction `junctions` says which legs
there are, `course` draws the way through, and the head runs that way from memory until the swinging cell
stands on the clean outgoing leg.

Source: patent ES 361967, figure 1. Questions: see `tracer.head` and `tracer.junctions`.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from morfax.motion.faults import LineFault
from morfax.tracer.following import clean_line, lost
from morfax.tracer.following.agreement import Agreement
from morfax.tracer.following.felt_line import (
    Anchor,
    clean_from,
    felt_ahead,
    nearest_station,
    slow_stretch,
    trail_behind,
)
from morfax.tracer.following.followed import Followed, without_repeat
from morfax.tracer.following.way_home import WayHome
from morfax.tracer.following.ways_out import (
    STRAIGHT_ON,
    Turns,
    WaysOut,
    aimed_at,
    leads_to_dot,
)
from morfax.tracer.head import course
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.leaders import STATIONS
from morfax.tracer.head.plan import Plan
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import CHANGED, HOME, MORE
from morfax.tracer.junctions.choice import Choice
from morfax.tracer.junctions.felt_corner import round_corner
from morfax.tracer.junctions.planner import Planner
from morfax.tracer.junctions.width_change import of_another_pen
from morfax.tracer.marks.dots import dot_at_end
from morfax.tracer.sensing.leg import FEWEST_STATIONS, Leg, goes_straight, leg_of
from morfax.tracer.sensing.probe import end_of
from morfax.tracer.tangles.memory import Tangles
from morfax.tracer.tangles.solution import Approach

# the share of a change of a clean line's width that the head takes over at once; by trial
SWELLS = 0.5
AWAY_LEADS, AWAY_WIDTHS = 4.0, 3.0  # the head is away from home after this travel


class Follower:
    """A head on a line of a drawing."""

    def __init__(
        self, stance: Stance, settings: Settings, rate_hz: float, turns: Turns = STRAIGHT_ON
    ) -> None:
        """Put a head down at a stance, and tell it how to leave the junctions."""
        self.view, self.settings = stance.view, settings
        self._ways_out = WaysOut(turns, stance.reference_mm is not None)
        self._at_tip = self._went_slowly = False
        self.carriage = Carriage(stance, settings, rate_hz)
        self._tangles = Tangles()
        self._agreement = Agreement(by_stations=turns.by_stations)
        by_lead_mm = AWAY_LEADS * self.carriage.tuning.lead_mm
        self._home = WayHome(stance, max(by_lead_mm, AWAY_WIDTHS * self.view.width_mm))
        self._aim(stance.leg_ahead())

    def take_up(self, turns: Turns) -> None:
        """Take up an earlier run where its copy was kept, and tell the head other turns."""
        self._ways_out.turns = turns
        self.carriage.taken_up()

    def follow(
        self,
        longest_mm: float,
        told: Callable[[float], None] | None = None,
        keep: Callable[[Follower], None] | None = None,
    ) -> Followed:
        """Follow until the line closes, ends or is lost; `told` hears the travel, mm, `keep` may copy."""
        home, on_mm = self._home.for_kernel(), 0.0 if keep is not None else longest_mm
        if not (self.carriage.hears(self.view) or self.settings.direct_rad_s_mm > 0):
            return self._lost(lost.CONTRADICT, lost.CHECK_CELL)
        while self.carriage.travel_mm < longest_mm:
            if keep is not None:
                keep(self)
            knows = clean_line.Knows(home, self._anchor, self._ways_out.turns, on_mm)
            self.view, why = clean_line.follow(self.carriage, self.view, knows)
            if told is not None:
                told(self.carriage.travel_mm)
            ending = self._after(why)
            if ending is not None:
                return ending
        return self._lost("the head has gone round without coming back to its start")

    def _after(self, why: int) -> Followed | None:
        """What the head does where its carriage has stopped; returns what it did, if that was the end."""
        if why == HOME:
            return self._go_home()
        # before a junction that is known
        if self.carriage.trail.comes_again(self.view.width_mm):
            return self._done("joined")
        if why == CHANGED:
            self.view = self.view.like(*self.carriage.stands(), follows=SWELLS)
            self.carriage.retune(self.view)
        if why in (CHANGED, MORE):
            return None
        if self.settings.direct_rad_s_mm > 0:
            return self._lost(lost.NO_GUARDS, lost.SLOWER)
        return self._through_junction()

    def _through_junction(self) -> Followed | None:
        """Take the head through the junction ahead; returns what the head did, if that was the end."""
        self.carriage.says("at a junction")
        # 1. feel the line ahead; the axis has been on the line even where none is clean behind it
        self.view, seen = felt_ahead(self.view, self.carriage, self._anchor)
        if len(seen) < FEWEST_STATIONS or self.carriage.ahead(seen[-1, :2]) < 0:
            seen = trail_behind(self.view, self.carriage)
        here = nearest_station(seen, self.carriage.stands()[0])
        if (len(seen) - here) * self.view.step_mm <= self.view.leg_mm:
            return self._through_legs(leg_of(seen, True, self.view.leg_mm))
        # 2. a place of which the operator has said how to go on, a fork, or ink beside the line
        fork = self._ways_out.fork(self.view, seen, here, self.carriage)
        if fork is not None:
            return self._through_legs(leg_of(seen[: fork + 1], True, self.view.leg_mm))
        # 3. a corner that can be felt round
        corner = round_corner(self._planner(), seen, here)
        if corner is not None:
            return self._pass(corner)
        # 4. clean line
        if self._agreement.goes_on(self.carriage, self.view, seen):
            return None
        if self._agreement.contradict:
            return self._lost(lost.CONTRADICT, lost.CHECK_CELL)
        nodes, leg = course.nodes_along(self.view, self.carriage.stands(), seen)
        if leg is not None:
            return self._pass(Plan([course.through_nodes(nodes)], leg, seen, STATIONS))
        return self._through_legs(leg_of(seen, True, self.view.leg_mm))

    def _through_legs(self, incoming: Leg) -> Followed | None:
        """Take the head from an incoming leg out of the junction; returns what it did, if no leg leads on."""
        told = self._ways_out.as_told(self._planner(), incoming, self.carriage)
        if told is not None:
            return self._pass(told)
        choice, asked = self._ways_out.chosen(self.view, incoming, self.carriage)
        # 1. a dot at the end of the line, and a line drawn with another pen
        goes_on = goes_straight(incoming, choice.leg)
        dot = None if goes_on else dot_at_end(self.view, incoming)
        if dot is not None:
            return self._end(aimed_at(incoming, dot), math.dist(incoming.end_mm, dot))
        plan = self._planner().by_another_pen(incoming, choice)
        if plan is not None:
            return self._pass(plan)
        # 2. by the legs, or past what they do not explain
        plan, choices = self._by_legs(incoming, choice, asked=asked)
        return self._at_end(incoming, choices) if plan is None else self._pass(plan)

    def _by_legs(
        self, incoming: Leg, choice: Choice, *, asked: bool
    ) -> tuple[Plan | None, int]:
        """The way that the legs show, a better one where they are a tangle; and how many legs there were."""
        plan, choices = self._planner().along_legs(incoming, choice)
        explained = leads_to_dot(self.view, incoming, choice.leg)
        if not (asked or explained):
            plan, explained = self._out_of_tangle(incoming, plan)
        # nothing leads on with this pen
        if plan is None and not choices:
            plan = self._with_another_pen(incoming)
            if plan is not None:
                return plan, choices
        # past what nothing explains
        if not explained:
            plan = self._planner().past(incoming, choice) or plan
        return plan, choices

    def _with_another_pen(self, incoming: Leg) -> Plan | None:
        """The way on along a line of another width, which the head takes up, if there is one."""
        other = of_another_pen(self.view, incoming, self.carriage.trail)
        plan = None if other is None else self._planner().onward(incoming, other)
        if other is not None and plan is not None:
            self.view = other.view
        return plan

    def _out_of_tangle(self, incoming: Leg, plan: Plan | None) -> tuple[Plan | None, bool]:
        """The way out of a tangle, or the plan if this is none; and whether the tangle explains the way."""
        self.carriage.says("in a tangle")
        number = self._ways_out.junctions.next(self.carriage.travel_mm)
        way_in, rank = self.carriage.stands(), self._ways_out.turns.other.count(number)
        approach = Approach(incoming, self.carriage.trail, way_in, plan, number, rank)
        return self._tangles.way_out(self.view, approach)

    def _planner(self) -> Planner:
        """What plans the way on from where the head stands."""
        return Planner(self.view, self.carriage.stands(), self.carriage.trail, self.settings)

    def _at_end(self, incoming: Leg, choices: int) -> Followed | None:
        """Run to the end of the line, or to where it meets what was followed before."""
        end = end_of(self.view, incoming)
        if end is None and choices:
            end = 0.0  # all that leads on has been followed
        if end is None:
            return self._lost("no clean line leads on through the ink ahead")
        if self._home.is_across(incoming, end, self.settings.recatch_mm):
            # across the paper, to the end at which the head began
            way = [course.to_end(self.carriage.stands(), incoming, end)]
            self.carriage.run(way, self.settings.speed_mm_s, STATIONS)
            return self._go_home()
        return self._end(incoming, end, joined=choices > 0)

    def _end(self, incoming: Leg, end_mm: float, *, joined: bool = False) -> Followed | None:
        """Run to an end of the line; and back, if it is a guide line's end, or a tip where two lines end."""
        self.carriage.run(
            [course.to_end(self.carriage.stands(), incoming, end_mm)], leader=STATIONS
        )
        self._at_tip = self._tangles.goes_back(
            self.carriage.stands()[0], self.carriage.trail, self.view.width_mm
        )
        to_tip = self._at_tip and self._ways_out.turns.back_from_tips
        if joined and not to_tip:
            return self._done("joined")
        on_guide = self._ways_out.junctions.turn_round(self.carriage.count)
        if not on_guide and not to_tip:
            return self._done("ended")
        self.carriage.swivel(incoming.heading_at(end_mm) + math.pi)
        way_back = [course.along_leg(incoming, end_mm, 0.0)]
        self.carriage.run(way_back, self.settings.speed_mm_s, STATIONS)
        self._aim(incoming.turned_round())
        return None

    def _go_home(self) -> Followed:
        """Run onto the place where the head began."""
        self.carriage.run([self._home.way_from(self.carriage)])
        return self._done("closed")

    def _pass(self, plan: Plan) -> Followed | None:
        """Run a course and go on following at its end; or stop at home if the course passes home."""
        cut = self._home.on_course(plan.stretches, self.carriage.travel_mm, self.view.width_mm)
        if cut is not None:
            self.carriage.run(cut, leader=plan.leader)
            return self._done("closed")
        why = self._by_cell(plan)
        if why is not None:
            return self._go_home() if why == HOME else None
        self.carriage.run(plan.stretches, self.settings.speed_mm_s, plan.leader)
        clean = None if plan.seen is None else clean_from(self.view, self.carriage, plan)
        self._aim(plan.leg, clean)
        return None

    def _by_cell(self, plan: Plan) -> int | None:
        """Why the cell stopped that went a way which stations would lead; None if it does not keep to it."""
        stretch = slow_stretch(self.view, self.carriage, plan)
        if stretch is None or self._ways_out.turns.by_stations:
            return None
        why = self.carriage.follow_slowly(self.view, self._home.for_kernel(), stretch)
        self._went_slowly |= why is not None
        return why

    def _aim(self, leg: Leg, clean_from: Anchor | None = None) -> None:
        """Follow from the clean end of a leg; the line is clean from there, or from further back."""
        self.carriage.aim(self.view, leg)
        self._anchor = clean_from or (leg.end_mm, leg.heading_rad, self.carriage.travel_mm)

    def _done(self, ending: str, fault: LineFault | None = None) -> Followed:
        """What the head did in all."""
        positions, junctions = self.carriage.positions_mm, self._ways_out.junctions
        done = Followed(
            positions,
            ending,
            self.carriage.heading_rad,
            self.carriage.travel_mm,
            self.view,
            tuple(junctions.places_mm),
            fault,
            guides=junctions.guides(positions),
            at_tip=self._at_tip,
            went_slowly=self._went_slowly,
            led=self.carriage.led,
            served=frozenset(self._ways_out.served),
            doubts=self._tangles.doubts(self.carriage.trail, self.view.width_mm),
        )
        return done if ending != "joined" else without_repeat(done)

    def _lost(self, why: str, instead: str = lost.BRIDGE) -> Followed:
        """The end of a line that was lost: the fault says where, and what to do instead."""
        self.carriage.says(f"lost: {why}")
        stands, travel_mm = self.carriage.stands(), self.carriage.travel_mm
        because = f"{why}; look at the drawing there, {instead}"
        return self._done(
            "lost", lost.line_lost(stands, travel_mm, self.view.enlarged, because)
        )
