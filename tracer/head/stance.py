"""The stance: how the head is put down on a line, before it follows."""

from __future__ import annotations

import math
from dataclasses import dataclass

from morfax.motion.arrays import Array
from morfax.tracer.sensing.leg import FEWEST_STATIONS, Leg, leg_of
from morfax.tracer.sensing.view import View


@dataclass(frozen=True, slots=True)
class Stance:
    """The head put down: place on the line, heading along it, and how it sees the line."""

    place_mm: Array
    heading_rad: float
    view: View
    at_end: bool = False  # of a line
    # the reference point that the line starts from
    reference_mm: tuple[float, float] | None = None

    def leg_ahead(self) -> Leg:
        """The line ahead, as felt."""
        place, heading, view = self.place_mm, self.heading_rad, self.view
        seen = view.feel(place, heading, view.leg_mm)
        leg = leg_of(seen, False, view.leg_mm) if len(seen) >= FEWEST_STATIONS else None
        bend = leg.bend_per_mm if leg is not None else 0.0
        return Leg(place, heading, bend, view.width_mm, seen)


def turned_round(end_mm: Array, heading_rad: float, view: View) -> Stance:
    """The head at the end of a line where it arrived on a heading, to go back along it."""
    return Stance(end_mm, math.remainder(heading_rad + math.pi, math.tau), view, True)
