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
import pickle
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from morfax.tracer.following import clean_line, lost
from morfax.tracer.following.agreement import Agreement
from morfax.tracer.following.felt_line import (
    clean_from,
    felt_ahead,
    nearest_station,
    slow_stretch,
    trail_behind,
)
from morfax.tracer.following.followed import Followed
from morfax.tracer.following.hidden_corner import hides_corner
from morfax.tracer.following.run_ends import RunEnds
from morfax.tracer.following.two_corners import or_two_before, or_two_corners
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
from morfax.tracer.junctions.choice import Choice, WayIn, survey
from morfax.tracer.junctions.felt_corner import corner_ahead, round_corner
from morfax.tracer.junctions.planner import FAINTER, Planner
from morfax.tracer.junctions.width_change import of_another_pen
from morfax.tracer.marks.dots import dot_at_end
from morfax.tracer.sensing.leg import FEWEST_STATIONS, Leg, goes_straight, leg_of
from morfax.tracer.sensing.probe import end_of
from morfax.tracer.tangles.memory import Tangles

# the share of a change of a clean line's width that the head takes over at once; by trial
SWELLS = 0.5
AWAY_LEADS = 4.0  # the head is away from home after this travel

Before = Callable[["Follower"], Followed | None]


class Follower(RunEnds):
    """A head on a line of a drawing."""

    def __init__(
        self, stance: Stance, settings: Settings, rate_hz: float, turns: Turns = STRAIGHT_ON
    ) -> None:
        """Put a head down at a stance, and tell it how to leave the junctions."""
        self.view, self.settings = stance.view, settings
        self._ways_out = WaysOut(turns, stance.reference_mm is not None)
        self._at_tip = self._went_slowly = self._at_junction = False
        self._tip = None
        self.carriage = Carriage(stance, settings, rate_hz)
        self._tangles = Tangles()
        self._agreement = Agreement(by_stations=turns.by_stations)
        self._home = WayHome(stance, AWAY_LEADS * self.carriage.tuning.lead_mm)
        self._aim(stance.leg_ahead())

    @property
    def junction(self) -> int:
        """The number of a junction to which the head comes here."""
        return self._ways_out.junctions.next(self.carriage.travel_mm)

    @property
    def asked_at(self) -> set[int]:
        """The numbers of the junctions so far at which another turn would have led another way."""
        return self._ways_out.asked_at

    def take_up(self, turns: Turns, *, at_junction: bool = False) -> None:
        """Take up an earlier run where its copy was kept, or at its end, and tell the head other turns."""
        self._ways_out.turns, self._at_junction = turns, at_junction
        self.carriage.taken_up()

    @property
    def junctions_mm(self) -> tuple[tuple[float, float], ...]:
        """The places of the junctions so far."""
        return tuple(self._ways_out.junctions.places_mm)

    def goes_on_as(self, other: Follower) -> bool:
        """Whether all that decides the way on, but the turns, is what it is for a head of the same stance."""
        if not np.array_equal(self.carriage.positions_mm, other.carriage.positions_mm):
            return False
        return pickle.dumps(self._state()) == pickle.dumps(other._state())

    def _state(self) -> tuple[Any, ...]:
        """What decides the way on from here, but positions, turns and the sheet."""
        view, guides = self.view, replace(self._ways_out.junctions, places_mm=[])
        seen = id(view.cells.darkness), view.level, view.width_mm, view.usual_mm
        memory = self.junction, guides, self._tangles.state, self._agreement, self._anchor
        return self.carriage.mark(), seen, memory, self._at_tip, self._went_slowly

    def follow(
        self,
        longest_mm: float,
        told: Callable[[float], None] | None = None,
        keep: Callable[[Follower], None] | None = None,
        before: Before | None = None,
    ) -> Followed:
        """Follow until the line closes, ends or is lost; `told` hears the travel, mm; `keep` may copy the
        head on its way, `before` before each junction: it may know what the run comes to from there.
        """
        home, on_mm = self._home.for_kernel(), 0.0 if keep is not None else longest_mm
        if not (self.carriage.hears(self.view) or self.settings.direct_rad_s_mm > 0):
            return self._lost(lost.CONTRADICT, lost.CHECK_CELL)
        ending = self._on_from_there()
        while ending is None and self.carriage.travel_mm < longest_mm:
            if keep is not None:
                keep(self)
            knows = clean_line.Knows(home, self._anchor, self._ways_out.turns, on_mm)
            self.view, why = clean_line.follow(self.carriage, self.view, knows)
            if told is not None:
                told(self.carriage.travel_mm)
            ending = self._after(why, before)
        return ending or self._lost("the head has gone round without coming back to its start")

    def _on_from_there(self) -> Followed | None:
        """Go on where an earlier run was taken up, if that was at a junction or at a tip."""
        if self._at_junction:
            self._at_junction = False
            return self._through_junction()
        self._on_from_tip()
        return None

    def _after(self, why: int, before: Before | None) -> Followed | None:
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
        known = None if before is None else before(self)
        return known or self._through_junction()

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
        # 3. a corner that can be felt round, or that its ink alone shows to be sharp
        felt = corner_ahead(self.view, seen, here)
        corner = None if felt is None else round_corner(self._planner(), felt)
        if felt is not None:
            corner = or_two_corners(self._planner(), felt, corner)
            if corner is not None:
                return self._pass(corner)
            if hides_corner(self.view, felt):
                return self._through_legs(felt.legs(self.view)[0])
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
        plan, choices = self._planner().by_another_pen(incoming, choice), 0
        # 2. by the legs, or past what they do not explain
        if plan is None:
            plan, choices = self._by_legs(incoming, choice, asked=asked)
        if plan is None:
            return self._at_end(incoming, choices)
        # 3. not onto another line: this one ends before that
        if self.view.is_others(plan.leg.end_mm):
            return self._end(incoming, end_of(self.view, incoming) or 0.0)
        return self._pass(plan)

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
            plan = self._with_another_pen(incoming) or self._on_paler_ink(incoming)
            if plan is not None:
                return plan, choices
        # past what nothing explains
        if not explained:
            plan = self._planner().past(incoming, choice) or plan
        # by two corners, of which the line was felt round the first
        if plan is not None and choices == 1 and not asked:
            _, seen = felt_ahead(self.view, self.carriage, self._anchor)
            plan = or_two_before(self._planner(), seen, choice, plan)
        return plan, choices

    def _with_another_pen(self, incoming: Leg) -> Plan | None:
        """The way on along a line of another width, which the head takes up, if there is one."""
        other = of_another_pen(self.view, incoming, self.carriage.trail)
        plan = None if other is None else self._planner().onward(incoming, other)
        if other is not None and plan is not None:
            self.view = other.view
        return plan

    def _on_paler_ink(self, incoming: Leg) -> Plan | None:
        """The way by a corner of which little ink is left, as of a pencil's line; None without one."""
        if not self.view.grainy:
            return None
        paler = replace(self._planner(), view=self.view.at_level(FAINTER * self.view.level))
        choice = survey(WayIn(paler.view, incoming, self.carriage.trail))
        plan = paler.along_legs(incoming, choice)[0] if choice.choices == 1 else None
        return plan if plan is not None and course.on_ink(self.view, plan.stretches) else None

    def _out_of_tangle(self, incoming: Leg, plan: Plan | None) -> tuple[Plan | None, bool]:
        """The way out of a tangle, or the plan if this is none; and whether the tangle explains the way."""
        from morfax.tracer.tangles.solution import Approach

        self.carriage.says("in a tangle")
        number = self._ways_out.junctions.next(self.carriage.travel_mm)
        way_in, rank = self.carriage.stands(), self._ways_out.rank(number)
        approach = Approach(incoming, self.carriage.trail, way_in, plan, number, rank)
        return self._tangles.way_out(self.view, approach)

    def _planner(self) -> Planner:
        """What plans the way on from where the head stands."""
        return Planner(self.view, self.carriage.stands(), self.carriage.trail, self.settings)

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
