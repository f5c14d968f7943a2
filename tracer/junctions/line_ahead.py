"""Lines ahead: where the ink ends or is a blot, the head looks for the line that goes on from there.

Straight on, through a blot or across a gap that is no wider than allowed; or, where the line is lost, in
widening arcs ahead of its end.

Signals: the view and the incoming leg in; the leg ahead, in sheet mm, out.

Source: our own.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.circle import circle_through
from morfax.motion.plane import cross, direction, heading_of
from morfax.tracer.head.trail import Trail
from morfax.tracer.limits import CLEAR_WIDTHS
from morfax.tracer.sensing.leg import Leg, goes_straight, leg_of, turn
from morfax.tracer.sensing.parabola import FEWEST
from morfax.tracer.sensing.photocell import STEP_PX
from morfax.tracer.sensing.probe import END_WIDTHS, reach_of_ink
from morfax.tracer.sensing.scout import REACH, REACH_PX
from morfax.tracer.sensing.view import View

# Chosen by trial on the test drawings.
AHEAD = math.radians(75)  # a lost line is looked for within this of its heading
BEGIN = 0.5  # of the width: a leg begins no further from the place where it is sought
ARCS_APART = 0.5  # widths
WIDE_GAP_MM = 1.0  # twice the usual gap: over less a leg's own bend will do
LOOKS_BACK = 2.0  # gaps: so much of the line shows on what circle it goes on
# of the width: the line has been a circle if it lies within this, root mean square
OFF_CIRCLE = 0.1


class Ahead:
    """What lies straight ahead of a leg: each place is looked at once, however many gaps are asked for."""

    def __init__(self, view: View, incoming: Leg) -> None:
        self._view, self._incoming = view, incoming
        straight = replace(incoming, bend_per_mm=0.0)
        self._ways = _Way(view, incoming), _Way(view, straight)

    def over(self, gap_mm: float) -> Leg | None:
        """The clean line straight ahead, through a blot or across a gap no wider than allowed; or None.

        The head goes on along the leg's bend, or else with its heading held: the bend of a dash two or three
        millimetres long is uncertain. Across a wide gap it goes on, at last, along the circle of the line
        before that.
        """
        for way in self._ways:
            if (found := way.met(gap_mm)) is not None:
                return found
        if gap_mm <= WIDE_GAP_MM:
            return None
        round_about = _round_about(self._view, self._incoming, gap_mm)
        return None if round_about is None else _Way(self._view, round_about).met(gap_mm)


def straight_on(view: View, incoming: Leg, gap_mm: float) -> Leg | None:
    """The clean line straight ahead of a leg (see `Ahead`); None if there is none."""
    return Ahead(view, incoming).over(gap_mm)


def looks_mm(view: View, gap_mm: float) -> float:
    """How far from a leg's end it is looked for the line straight ahead, or felt back, mm."""
    ahead_mm = END_WIDTHS * view.width_mm + gap_mm + view.leg_mm
    beside_mm = (REACH + BEGIN) * view.width_mm + (REACH_PX + 1) * view.pitch_mm
    return max(ahead_mm, LOOKS_BACK * gap_mm) + beside_mm


def _round_about(view: View, incoming: Leg, gap_mm: float) -> Leg | None:
    """The leg on the circle that the line has been before its end, over twice a gap; None if it was none."""
    back_rad = incoming.heading_rad + math.pi
    seen = view.feel(incoming.end_mm, back_rad, LOOKS_BACK * gap_mm)[::-1]
    if len(seen) * view.step_mm < gap_mm:
        return None
    centre, radius_mm, off_mm = circle_through(seen[:, :2])
    if off_mm > OFF_CIRCLE * view.width_mm or not radius_mm > gap_mm:
        return None
    out = incoming.end_mm - centre
    ahead = direction(incoming.heading_rad)
    side = math.copysign(1.0, cross(out, ahead))  # 1: counter-clockwise
    end_mm = centre + out * (radius_mm / float(np.hypot(*out)))
    heading_rad = heading_of(out) + side * math.pi / 2
    return replace(
        incoming, end_mm=end_mm, heading_rad=heading_rad, bend_per_mm=side / radius_mm
    )


class _Way:
    """The way on along a leg, and what was looked at along it: whether there is ink at a place, the clean
    line that is met there, and whether that is another's.
    """

    def __init__(self, view: View, incoming: Leg) -> None:
        self._view, self._incoming = view, incoming
        self._seen: dict[float, tuple[bool, Leg | None]] = {}
        self._others: dict[float, bool] = {}

    def met(self, gap_mm: float) -> Leg | None:
        """The clean line met by going on along the leg; across paper not that of others."""
        view = self._view
        paper_mm, step, is_across = 0.0, STEP_PX * view.pitch_mm, False
        farthest_mm = END_WIDTHS * view.width_mm + gap_mm
        for along in np.arange(0.5 * view.width_mm, farthest_mm, step).tolist():
            is_dark, leg = self._at(along)
            paper_mm = 0.0 if is_dark else paper_mm + step
            if paper_mm > gap_mm + step:
                return None
            is_across |= not is_dark
            if leg is not None and not (is_across and self._is_others(along, leg)):
                return leg
        return None

    def _at(self, along: float) -> tuple[bool, Leg | None]:
        """Whether there is ink at a place along the leg, and the clean line that goes straight on there."""
        if along not in self._seen:
            is_dark = self._view.dark(self._incoming.at(along))
            self._seen[along] = is_dark, self._felt(along) if is_dark else None
        return self._seen[along]

    def _felt(self, along: float) -> Leg | None:
        """The clean line that goes straight on at a place along the leg."""
        view, incoming = self._view, self._incoming
        place = incoming.at(along)
        seen = view.feel(place, incoming.heading_at(along), view.leg_mm)
        if len(seen) < FEWEST or np.hypot(*(seen[0, :2] - place)) > BEGIN * view.width_mm:
            return None
        leg = leg_of(seen, False, view.leg_mm)
        return leg if goes_straight(incoming, leg) else None

    def _is_others(self, along: float, leg: Leg) -> bool:
        """Whether the line met at a place along the leg is another's."""
        if along not in self._others:
            self._others[along] = self._view.is_others(leg.end_mm)
        return self._others[along]


def caught_again(view: View, incoming: Leg, trail: Trail, within_mm: float) -> Leg | None:
    """The line that the head meets first in widening arcs ahead of where it lost its line; or None.

    Only a line that has not been followed, and that leads on ahead.
    """
    end = incoming.at(reach_of_ink(view, incoming, view.width_mm) or 0.0)

    def off_heading(heading: float) -> float:
        """Angle between a heading and the incoming leg's, rad."""
        return abs(turn(incoming.heading_rad, heading))

    for radius in np.arange(view.width_mm, within_mm, ARCS_APART * view.width_mm):
        legs = []
        for middle in view.ring(end, radius).mean(axis=1):
            if off_heading(float(middle)) < AHEAD:
                met = end + radius * direction(middle)
                legs += [leg for leg in _from(view, met) if not trail.holds(leg, view.width_mm)]
        legs = [leg for leg in legs if not view.is_others(leg.end_mm)]
        legs = [leg for leg in legs if off_heading(leg.heading_rad) < AHEAD]
        if legs:
            return min(legs, key=lambda leg: off_heading(leg.heading_rad))
    return None


def _from(view: View, place: Array) -> list[Leg]:
    """The clean legs that leave a place on ink."""
    found, away_mm = [], CLEAR_WIDTHS * view.width_mm
    for arc in view.ring(place, away_mm):
        heading = float(arc.mean())
        start = place + away_mm * direction(heading)
        seen = view.feel(start, heading, view.leg_mm)
        if len(seen) >= FEWEST:
            found.append(leg_of(seen, False, view.leg_mm))
    return found
