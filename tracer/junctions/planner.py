"""The planner: the way from where the head stands through the junction ahead, as legs and edges tell it.

Signals: the view, where the head stands, its trail, and the legs that the survey found in; stretches and the
outgoing leg out.

Source: our own (see `rings`, `course` and `edge_following`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from morfax.motion import curves
from morfax.motion.arrays import Array
from morfax.motion.plane import direction, left_of
from morfax.tracer.head import course
from morfax.tracer.head.leaders import STATIONS
from morfax.tracer.head.plan import Plan
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.trail import Trail
from morfax.tracer.junctions.choice import Choice
from morfax.tracer.junctions.corner import (
    Corner,
    bends_on,
    rounding,
    sharp_corner,
    through_corner,
)
from morfax.tracer.junctions.edge_following import EdgeRun, follow_edge, to_vertex
from morfax.tracer.junctions.line_ahead import (
    caught_again,
    looks_mm,
    straight_on,
)
from morfax.tracer.junctions.width_change import OtherWidth, another_pen
from morfax.tracer.limits import LONGER_WIDTHS
from morfax.tracer.sensing.leg import FEWEST_STATIONS, Leg, goes_straight, leg_of, turn
from morfax.tracer.sensing.photocell import STEP_PX
from morfax.tracer.sensing.probe import END_WIDTHS
from morfax.tracer.sensing.view import View

# Chosen by trial on the test drawings.
LEAST_GAP_PX = 2.5  # a scan can lose this much of a line
FAINTER = 0.5  # of the level: a line may become lighter at once by half
ACROSS = np.linspace(-0.5, 0.5, 7)  # of the width: where a faint line's ink is looked for
SPECK_PX = 4.5  # between stations of a line that is clean but for a speck
BEYOND_MM = 0.05  # a course ends at least so far beyond the vertex


@dataclass(frozen=True, slots=True)
class Planner:
    """What a way is planned by: the view, where the head stands (place, heading), its trail and settings."""

    view: View
    stands: tuple[Array, float]
    trail: Trail
    settings: Settings

    def along_legs(self, incoming: Leg, choice: Choice) -> tuple[Plan | None, int]:
        """The way through a junction that the legs alone tell, and how many there were to choose from."""
        count = choice.choices
        # 1. by the leg that was chosen, unless that is another line's
        if choice.leg is not None:
            plan = self._by_choice(incoming, choice.leg, choice.corner)
            if plan is not None:
                only_on = count <= 1 and goes_straight(incoming, choice.leg)
                return (plan._replace(leader=STATIONS) if only_on else plan), count
            count = 0
        # 2. straight on
        outgoing = self._straight_on(incoming, others=count > 0)
        if outgoing is not None and count and self._goes_back(outgoing.seen):
            return None, count
        # 3. to the line that is met first
        if outgoing is None:
            outgoing = self._met_first(incoming)
        if outgoing is None:
            return None, count
        return self.through(incoming, outgoing, None)._replace(leader=STATIONS), count

    def by_another_pen(self, incoming: Leg, choice: Choice) -> Plan | None:
        """The way onto the leg that was chosen, where another pen has drawn it."""
        if choice.leg is None or not another_pen(self.view, choice.leg):
            return None
        return self.onward(incoming, OtherWidth(self.view, choice.leg, choice.corner))

    def _met_first(self, incoming: Leg) -> Leg | None:
        """The line that is met first beyond the end of a leg, where the settings have one looked for."""
        if not self.settings.recatch_mm > 0:
            return None
        return caught_again(self.view, incoming, self.trail, self.settings.recatch_mm)

    def as_told(self, incoming: Leg, choice: Choice, *, straight: bool) -> Plan | None:
        """The way by the leg that the operator asks for, or straight on across what lies there; None if there
        is no such way.
        """
        leg = choice.leg
        if leg is not None and (goes_straight(incoming, leg) or not straight):
            return self._by_choice(incoming, leg, choice.corner)
        if not straight:
            return None
        farthest_mm = END_WIDTHS * self.view.width_mm
        gap_mm = max(self.settings.gap_mm, farthest_mm)
        wider = replace(self, settings=replace(self.settings, gap_mm=gap_mm))
        outgoing = wider._straight_on(incoming, others=False)
        return None if outgoing is None else self.through(incoming, outgoing, None)

    def _by_choice(self, incoming: Leg, outgoing: Leg, corner: Corner | None) -> Plan | None:
        """The way by the leg that was chosen; None if there is no ink all along it."""
        plan = self.through(incoming, outgoing, corner)
        if not course.on_ink(self.view, plan.stretches):
            return None
        if len(plan.stretches) > 1 and not self._is_round(corner):
            return plan
        return self._past_speck(plan, incoming, outgoing) or plan

    def _straight_on(self, incoming: Leg, *, others: bool) -> Leg | None:
        """The line straight ahead; unless there are `others`, also a fainter one, and one in grain."""
        view = self.view
        gap_mm = max(self.settings.gap_mm, LEAST_GAP_PX * view.pitch_mm)
        outgoing = straight_on(view, incoming, gap_mm)
        if outgoing is None and not others:
            outgoing = straight_on(view.at_level(FAINTER * view.level), incoming, gap_mm)
        if outgoing is None and not others:
            seen, heading_rad = incoming.seen, incoming.heading_rad
            larger = view.through_larger(seen, heading_rad, partial(looks_mm, gap_mm=gap_mm))
            outgoing = straight_on(larger, incoming, gap_mm)
            if outgoing is not None and self._blank_mm(incoming, outgoing) > gap_mm:
                return None
        return outgoing

    def _blank_mm(self, incoming: Leg, outgoing: Leg) -> float:
        """The longest stretch without any ink across the line, straight from one leg's end to another's."""
        view, step = self.view, STEP_PX * self.view.pitch_mm
        along = np.arange(0.0, course.ahead_mm(incoming.end_mm, outgoing), step)
        left = left_of(direction(incoming.heading_rad))
        across = ACROSS[:, None] * view.width_mm * left
        lighter = view.at_level(FAINTER * view.level)
        blank = longest = 0.0
        for place in incoming.at(along):
            inked = any(lighter.dark(place + aside) for aside in across)
            blank = 0.0 if inked else blank + step
            longest = max(longest, blank)
        return longest

    def onward(self, incoming: Leg, other: OtherWidth) -> Plan | None:
        """The way onto a line of another width; None if there is no ink all along it."""
        leg, corner = other.leg, other.corner
        plan = self.through(incoming, leg, None)
        if corner is not None and self._turns(corner):
            end_mm = max(BEYOND_MM - corner.before_mm, 0.0)
            stretches = sharp_corner(self.stands, corner, end_mm)
            plan = Plan(stretches, leg.shifted(end_mm, leg.seen))
        return plan if course.on_ink(self.view, plan.stretches) else None

    def past(self, incoming: Leg, choice: Choice) -> Plan | None:
        """The way past ink that runs beside the line, felt along an edge.

        None if the line goes on straight before, or if there is no such way.
        """
        straight = goes_straight(incoming, choice.leg)
        if straight and not self._is_far(incoming, choice.leg):
            return None
        run = follow_edge(self.view, incoming)
        if run is None or (straight and run.back is None):
            return None
        if choice.choices and self._goes_back(run.seen):
            return None
        return self._along_edge(incoming, run)

    def through(self, incoming: Leg, outgoing: Leg, corner: Corner | None) -> Plan:
        """Stretches from where the head stands to the outgoing leg's clean end, and that leg."""
        # 1. by the corner
        if corner is not None and self._turns(corner):
            felt = to_vertex(self.view, corner)
            leaving = felt.outgoing
            end_mm = max(
                BEYOND_MM - felt.before_mm, course.ahead_mm(leaving.end_mm, outgoing), 0.0
            )
            stretches = through_corner(self.view, self.stands, felt, end_mm)
            return Plan(stretches, leaving.shifted(end_mm, leaving.seen))
        # 2. by a cubic
        limit = float(np.hypot(*(outgoing.end_mm - incoming.end_mm)))
        way, along = course.onto(*self.stands, incoming, 0.5 * limit)
        start, heading = incoming.at(along), incoming.heading_at(along)
        cubic = curves.hermite(start, heading, outgoing.end_mm, outgoing.heading_rad)
        return Plan([np.vstack([way, cubic])], outgoing)

    def _turns(self, corner: Corner) -> bool:
        """Whether two legs that meet make a corner.

        They do not where they run into one another smoothly, or meet behind their clean ends.
        """
        angle = abs(turn(corner.incoming.heading_rad, corner.outgoing.heading_rad))
        return angle > course.SMOOTH and corner.nearest_mm > -self.view.width_mm

    def _past_speck(self, plan: Plan, incoming: Leg, outgoing: Leg) -> Plan | None:
        """A way without a corner once more, felt along it; None if the line is not clean but for a speck."""
        # 1. the stations of the line, with those between its legs
        way = curves.distinct(np.vstack(plan.stretches))
        is_behind = (outgoing.end_mm - way) @ direction(outgoing.heading_rad) > 0
        is_ahead = (incoming.end_mm - way) @ direction(incoming.heading_rad) < 0
        seen = self.view.feel_along(way[is_behind & is_ahead])
        there = np.vstack([incoming.seen, seen, outgoing.seen])
        widest_mm = np.hypot(*np.diff(there[:, :2], axis=0).T).max()
        if widest_mm > SPECK_PX * self.view.pitch_mm:
            return None
        # 2. cubics along them, unless the line bends more than they can
        nodes, leg = course.nodes_along(self.view, self.stands, there)
        if leg is None:
            return None
        felt = curves.distinct(course.through_nodes(nodes))
        averaged_mm = course.FELT_LEGS * self.view.leg_mm
        return (
            None
            if curves.bends_per_mm(felt).max() * averaged_mm > 1
            else Plan([felt], leg, there, STATIONS)
        )

    def _is_round(self, corner: Corner | None) -> bool:
        """Whether the legs, or the ink where they meet, show a round and no corner."""
        if corner is None:
            return False
        return rounding(self.view, corner)[1] > 0 or bends_on(self.view, corner)

    def _along_edge(self, incoming: Leg, run: EdgeRun) -> Plan | None:
        """Stretches along a line felt on one edge, and round the tip and back; None if it is too short."""
        there = np.vstack([incoming.seen, run.seen])
        if run.back is None:
            nodes, leg = course.nodes_along(self.view, self.stands, there)
            if leg is None:
                return None
            return Plan([course.through_nodes(nodes)], leg, run.seen, STATIONS)
        to_tip, felt = course.nodes_along(self.view, self.stands, there, 0.0)
        tip = run.back[0, :2]
        onto_tip_rad = to_tip[-1][1]
        from_tip, leg = course.nodes_along(
            self.view, (tip, onto_tip_rad + math.pi), run.back, 0.0
        )
        if leg is None or felt is None:
            return None
        onto_tip = [*to_tip[:-1], (tip, onto_tip_rad)]
        return Plan([course.through_nodes(onto_tip), course.through_nodes(from_tip)], leg)

    def _goes_back(self, seen: Array) -> bool:
        """Whether what was felt from a width behind a junction on has been followed the other way."""
        width_mm = self.view.width_mm
        first = min(round(width_mm / self.view.step_mm), len(seen) - FEWEST_STATIONS)
        leg = leg_of(seen[first:], False, self.view.leg_mm)
        return self.trail.holds(leg, width_mm) and self.trail.comes_back(leg)

    def _is_far(self, incoming: Leg, outgoing: Leg | None) -> bool:
        """Whether the ink runs beside the line for so long that it may be the line's own way back."""
        if outgoing is None:
            return False
        return course.ahead_mm(incoming.end_mm, outgoing) > LONGER_WIDTHS * self.view.width_mm
