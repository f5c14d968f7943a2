"""The way home: how the head comes back to the place where it began.

Signals: the head's place, heading and travel (mm, rad), and planned courses in; the course home out.

Source: our own. Patent ES 361967 has an operator who stops the head where it began.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from morfax.motion import curves
from morfax.motion.arrays import Array
from morfax.tracer.following.faint_corner import TipPose
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.kernel import HOME_COSINE
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import Home
from morfax.tracer.junctions.line_ahead import AHEAD
from morfax.tracer.limits import NEAR
from morfax.tracer.sensing.leg import Leg, turn


@dataclass(frozen=True, slots=True)
class WayHome:
    """Where the head began, and how far it travels before it looks out for home, mm."""

    stance: Stance
    away_mm: float

    def for_kernel(self) -> Home:
        """Home as the head's kernel takes it."""
        x_mm, y_mm = self.stance.place_mm
        return Home(x_mm, y_mm, self.stance.heading_rad, self.away_mm)

    def way_from(self, carriage: Carriage) -> Array:
        """The curve from where the head stands onto home, (n, 2) mm."""
        return curves.hermite(*carriage.stands(), self.stance.place_mm, self.stance.heading_rad)

    def on_course(
        self, stretches: list[Array], travel_mm: float, width_mm: float
    ) -> list[Array] | None:
        """The course up to home, if it passes home on home's heading."""
        if travel_mm < self.away_mm:
            return None
        home, heading = self.stance.place_mm, self.stance.heading_rad
        distinct = [
            curves.distinct(way) for way in stretches
        ]  # a step of length 0 has no heading
        for k, way in enumerate(distinct):
            near = int(np.argmin(np.hypot(*(way - home).T)))
            step = way[min(near + 1, len(way) - 1)] - way[min(near, len(way) - 2)]
            over_home = np.hypot(*(way[near] - home)) < NEAR * width_mm
            ahead_rad = math.atan2(step[1], step[0])
            if over_home and near > 0 and math.cos(ahead_rad - heading) > HOME_COSINE:
                return [*distinct[:k], np.vstack([way[:near], home])]
        return None

    @property
    def tip(self) -> TipPose:
        """Home as an end of the line."""
        return TipPose(self.stance.place_mm, self.stance.heading_rad + math.pi)

    def is_across(self, incoming: Leg, end_mm: float, within_mm: float) -> bool:
        """Whether home is an open end that lies across a gap, straight ahead of the end of a leg."""
        way = self.stance.place_mm - incoming.at(end_mm)
        if not self.stance.at_end or np.hypot(*way) > within_mm:
            return False
        on = incoming.heading_at(end_mm)
        to_home_rad = math.atan2(way[1], way[0])
        return all(abs(turn(on, a)) < AHEAD for a in (to_home_rad, self.stance.heading_rad))
