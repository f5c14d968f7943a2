"""The pilot: plans the way from where the head is through the knot ahead, as the legs and the edges tell it.

Signals: the view, where the head stands, its trail, and the legs that the survey found in; stretches and the
outgoing leg out.

Source: our own (see `knot`, `course` and `riding`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from morfax.motion import curves
from morfax.motion.arrays import Array
from morfax.motion.polyline import with_places
from morfax.tracer.head import course
from morfax.tracer.head.planned import Planned
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.trail import Trail
from morfax.tracer.junctions import corner
from morfax.tracer.junctions.choice import Way, caught_again, straight_on
from morfax.tracer.junctions.edge_following import Ride, ride_past, to_vertex
from morfax.tracer.junctions.rings import corner_in
from morfax.tracer.junctions.width_change import Onward
from morfax.tracer.sensing.leg import Leg, Meeting, goes_straight, leg_of, meet, turn
from morfax.tracer.sensing.view import View

SMOOTH = math.radians(14)  # a smaller change of heading is no corner
LEAST_GAP_PX = 2.5  # a scan can lose this much of a line
FAINTER = 0.5  # a line that becomes lighter at once goes on with so much of its darkness
AS_FELT = 0.65  # pixels that single stations are off
SPECK_PX = 4.5  # between stations of a line that is clean but for a speck
TIGHT_LEGS = 0.75  # of a leg's length: a round of a smaller radius is averaged away by feeling
LEG_STATIONS = 12  # make a leg beside a round
FAR_WIDTHS = 4.0  # to where the line goes on clean


@dataclass(frozen=True, slots=True)
class Pilot:
    """What a way is planned by: the view, where the head stands (place, heading), where it has been, and its
    settings.
    """

    view: View
    stands: tuple[Array, float]
    trail: Trail
    settings: Settings

    def along_legs(self, incoming: Leg, way: Way) -> tuple[Planned | None, int]:
        """The way through a knot that the legs alone tell, and how many there were to choose from."""
        outgoing, legs_mm, choices = way
        if outgoing is not None:
            planned = self._course(incoming, outgoing, legs_mm)
            if course.on_ink(self.view, planned.stretches):
                is_sharp = len(planned.stretches) > 1 and not self._is_round(
                    incoming, outgoing, legs_mm
                )
                return planned if is_sharp else self._past_speck(
                    planned, incoming, outgoing
                ) or planned, choices
            choices = 0  # that leg is another line's
        gap_mm = max(self.settings.gap_mm, LEAST_GAP_PX * self.view.pitch_mm)
        outgoing = straight_on(self.view, incoming, gap_mm)
        if outgoing is None and not choices:
            outgoing = straight_on(
                self.view.at_level(FAINTER * self.view.level), incoming, gap_mm
            )
        if outgoing is None and not choices:
            outgoing = straight_on(
                self.view.through_larger(incoming.seen, incoming.heading_rad), incoming, gap_mm
            )
            if outgoing is not None and self._blank_mm(incoming, outgoing) > gap_mm:
                outgoing = None
        if outgoing is not None and choices and self._goes_back(outgoing.seen):
            return None, choices
        if outgoing is None and self.settings.recatch_mm > 0:
            outgoing = caught_again(self.view, incoming, self.trail, self.settings.recatch_mm)
        return None if outgoing is None else self._course(incoming, outgoing, None), choices

    def onward(self, incoming: Leg, other: Onward) -> Planned | None:
        """The way onto a line of another width; None if there is no ink all along it."""
        leg, legs_mm = other.leg, other.legs_mm
        planned = self._course(incoming, leg, None)
        if legs_mm is not None and self._is_corner(incoming, leg, legs_mm):
            end_mm = max(0.05 - legs_mm[1], 0.0)
            stretches = corner.sharp_corner(self.stands, incoming, leg, legs_mm, end_mm)
            planned = Planned(stretches, leg.shifted(end_mm, leg.seen))
        return planned if course.on_ink(self.view, planned.stretches) else None

    def _blank_mm(self, incoming: Leg, outgoing: Leg) -> float:
        """The longest stretch without any ink across the line, on the way from one leg's clean end straight
        to another's.
        """
        view, step = self.view, 0.35 * self.view.pitch_mm
        along = np.arange(0.0, course.ahead_mm(incoming.end_mm, outgoing), step)
        across = np.linspace(-0.5, 0.5, 7) * view.width_mm
        aside = np.array([-math.sin(incoming.heading_rad), math.cos(incoming.heading_rad)])
        lighter = view.at_level(FAINTER * view.level)
        blank = longest = 0.0
        for place in incoming.at(along):
            blank = (
                0.0 if any(lighter.dark(place + u * aside) for u in across) else blank + step
            )
            longest = max(longest, blank)
        return longest

    def past(self, incoming: Leg, way: Way) -> Planned | None:
        """The way past ink that runs beside the line, felt along an edge; None if the line goes on straight
        before, or if there is no such way.
        """
        outgoing, _, choices = way
        straight = goes_straight(incoming, outgoing)
        ride = (
            None
            if straight and not self._far(incoming, outgoing)
            else ride_past(self.view, incoming)
        )
        if (
            ride is None
            or (straight and ride.back is None)
            or (choices and self._goes_back(ride.seen))
        ):
            return None
        return self._ride(incoming, ride)

    def _course(self, incoming: Leg, outgoing: Leg, legs_mm: Meeting | None) -> Planned:
        """Stretches from where the head is to the outgoing leg's clean end, and that leg."""
        if legs_mm is not None and self._is_corner(incoming, outgoing, legs_mm):
            arriving, leaving, met = to_vertex(self.view, incoming, outgoing, legs_mm)
            end_mm = max(0.05 - met[1], course.ahead_mm(leaving.end_mm, outgoing))
            stretches = corner.through_corner(
                self.view, self.stands, arriving, leaving, met, end_mm
            )
            return Planned(stretches, leaving.shifted(end_mm, leaving.seen))
        limit = float(np.hypot(*(outgoing.end_mm - incoming.end_mm)))
        way, along = course.onto(*self.stands, incoming, 0.5 * limit)
        start, heading = incoming.at(along), incoming.heading_at(along)
        through = curves.hermite(start, heading, outgoing.end_mm, outgoing.heading_rad)
        return Planned([np.vstack([way, through])], outgoing)

    def _is_corner(self, incoming: Leg, outgoing: Leg, legs_mm: Meeting) -> bool:
        """Whether two legs that meet make a corner, and do not run into one another smoothly, or meet behind
        their clean ends.
        """
        deflection = abs(turn(incoming.heading_rad, outgoing.heading_rad))
        return deflection > SMOOTH and min(legs_mm) > -self.view.width_mm

    def _past_speck(self, planned: Planned, incoming: Leg, outgoing: Leg) -> Planned | None:
        """A way without a corner once more, felt along it: None if the line is not clean there but for a
        speck.
        """
        way = curves.distinct(np.vstack(planned.stretches))
        beyond = [
            course.ahead_mm(place, outgoing) > 0 and course.ahead_mm(place, incoming) < 0
            for place in way
        ]
        seen = self.view.feel_along(way[beyond])
        there = np.vstack([incoming.seen, seen, outgoing.seen])
        if np.hypot(*np.diff(there[:, :2], axis=0).T).max() > SPECK_PX * self.view.pitch_mm:
            return None
        nodes, leg = course.nodes_along(self.view, self.stands, there)
        if leg is None:
            return None
        felt = curves.distinct(course.through_nodes(nodes))
        averaged = curves.bends_per_mm(felt).max() * course.FELT_LEGS * self.view.leg_mm > 1
        return None if averaged else Planned([felt], leg, there)

    def _is_round(self, incoming: Leg, outgoing: Leg, legs_mm: Meeting | None) -> bool:
        """Whether the legs, or the ink where they meet, show a round and no corner."""
        if legs_mm is None:
            return False
        touch_mm = corner.rounding(self.view, incoming, outgoing, legs_mm)[1]
        return touch_mm > 0 or self._bend_on(incoming, outgoing, legs_mm)

    def _bend_on(self, incoming: Leg, outgoing: Leg, legs_mm: Meeting) -> bool:
        """Whether two legs meet at no greater angle than one of them makes by bending on over the stations
        between them.
        """
        bends = max(abs(incoming.bend_per_mm), abs(outgoing.bend_per_mm))
        return (
            corner.deflection(incoming, outgoing, legs_mm)
            < SMOOTH + bends * corner.HIDDEN * self.view.step_mm
        )

    def round_corner(self, seen: Array, here: int) -> Planned | None:
        """The way round a corner that the line was felt clean round, as it is obtuse or a tight round; None
        if there is none, or if its ink shows neither.
        """
        longer = self._felt_on(seen)
        i = corner_in(longer, here + 4)
        return (
            None
            if i is None or i > len(seen) - LEG_STATIONS
            else self._obtuse(longer, i) or self._tight(longer, i)
        )

    def _felt_on(self, seen: Array) -> Array:
        """What was felt of a line, (n, 3), with a leg's length more of it where that is clean: the corner in
        it may be near the end.
        """
        way = seen[3, :2] - seen[0, :2]
        length_mm = len(seen) * self.view.step_mm + self.view.leg_mm
        more = self.view.feel(seen[0, :2], math.atan2(way[1], way[0]), length_mm)
        return more if len(more) > len(seen) else seen

    def _obtuse(self, seen: Array, i: int) -> Planned | None:
        """The way by the vertex of a corner at a station, if its ink shows it to be sharp."""
        incoming = leg_of(seen[: i - 2], True, self.view.leg_mm)
        outgoing = leg_of(seen[i + 3 :], False, self.view.leg_mm)
        legs_mm = meet(incoming, outgoing)
        if (
            legs_mm is None or min(legs_mm) < self.view.step_mm
        ):  # the bend is not between the legs
            return None
        if self._bend_on(incoming, outgoing, legs_mm):
            return None
        if not corner.is_sharp(self.view, incoming, outgoing, legs_mm):
            return None
        planned = self._course(incoming, outgoing, legs_mm)
        return (
            planned
            if self._as_felt(
                planned, seen, abs(turn(incoming.heading_rad, outgoing.heading_rad))
            )
            else None
        )

    def _tight(self, seen: Array, i: int) -> Planned | None:
        """The way by an arc between two straight legs about a station, each felt up to where its ink shows
        that the round begins; None if there is none.

        What is felt of a round is averaged over more of the line than the round is long.
        """
        last, first = i - 3, i + 3
        while last + 1 >= LEG_STATIONS and first <= len(seen) - LEG_STATIONS:
            incoming = leg_of(seen[: last + 1], True, self.view.leg_mm)
            outgoing = leg_of(seen[first:], False, self.view.leg_mm)
            legs_mm = meet(incoming, outgoing)
            if legs_mm is None:
                return None
            touch_mm = corner.rounding(self.view, incoming, outgoing, legs_mm)[1]
            back, on = (
                2 if leg.bend_per_mm else max(0, math.ceil((touch_mm - mm) / self.view.step_mm))
                for leg, mm in zip((incoming, outgoing), legs_mm, strict=True)
            )
            if not back and not on:
                planned = self._by_arc(incoming, outgoing, legs_mm, touch_mm)
                turned = corner.deflection(incoming, outgoing, legs_mm)
                return (
                    planned
                    if planned is not None and self._as_felt(planned, seen, turned)
                    else None
                )
            last, first = last - back, first + on
        return None

    def _by_arc(
        self, incoming: Leg, outgoing: Leg, legs_mm: Meeting, touch_mm: float
    ) -> Planned | None:
        """The way by the arc that touches two straight legs so far from their vertex; None if it is sharp,
        slight or wide, or if the head is in it.
        """
        deflection = corner.deflection(incoming, outgoing, legs_mm)
        widest_mm = TIGHT_LEGS * self.view.leg_mm * math.tan(deflection / 2)
        before_mm = legs_mm[0] + course.ahead_mm(self.stands[0], incoming)
        if deflection < corner.SLIGHT or not 0 < touch_mm < min(widest_mm, before_mm):
            return None
        end_mm = max(0.05 - legs_mm[1], 0.0)
        way = corner.rounded_corner(self.stands, incoming, outgoing, legs_mm, touch_mm, end_mm)
        return Planned([way], outgoing.shifted(end_mm, outgoing.seen))

    def _as_felt(self, planned: Planned, seen: Array, deflection: float) -> bool:
        """Whether a way round a corner is where the line was felt, but for the vertex: there the middle of
        the ink is inside of it.

        A pen of width w that turns by d about a vertex leaves the inner edge of its ink w/2/cos(d/2) from it,
        and the outer one w/2 before the lens rounds it.
        """
        inside_mm = 0.5 * self.view.width_mm * (1 / max(math.cos(deflection / 2), 0.5) - 1)
        away_mm = cKDTree(with_places(seen[:, :2], curves.SPACING_MM)).query(
            np.vstack(planned.stretches)
        )[0]
        return bool(away_mm.max() < inside_mm + AS_FELT * self.view.pitch_mm)

    def _ride(self, incoming: Leg, ride: Ride) -> Planned | None:
        """Stretches along a line that was felt on one edge; round the tip and back, if that is how it went;
        None if it is too short.
        """
        there = np.vstack([incoming.seen, ride.seen])
        if ride.back is None:
            nodes, leg = course.nodes_along(self.view, self.stands, there)
            return (
                None if leg is None else Planned([course.through_nodes(nodes)], leg, ride.seen)
            )
        to_tip, felt = course.nodes_along(self.view, self.stands, there, 0.0)
        tip = ride.back[0, :2]
        from_tip, leg = course.nodes_along(
            self.view, (tip, to_tip[-1][1] + math.pi), ride.back, 0.0
        )
        if leg is None or felt is None:
            return None
        onto_tip = [*to_tip[:-1], (tip, to_tip[-1][1])]
        return Planned([course.through_nodes(onto_tip), course.through_nodes(from_tip)], leg)

    def _goes_back(self, seen: Array) -> bool:
        """Whether what was felt from a knot on, from a width behind it, has been followed already, and the
        other way.
        """
        beyond = seen[min(round(self.view.width_mm / self.view.step_mm), len(seen) - 4) :]
        leg, trail = leg_of(beyond, False, self.view.leg_mm), self.trail
        return trail.holds(leg, self.view.width_mm) and trail.comes_back(leg)

    def _far(self, incoming: Leg, outgoing: Leg | None) -> bool:
        """Whether the ink runs beside the line for so long that it may be the line's own way back."""
        return (
            outgoing is not None
            and course.ahead_mm(incoming.end_mm, outgoing) > FAR_WIDTHS * self.view.width_mm
        )
