"""Runs: clean stations of a line in the order of travel, and the legs at their ends.

Signals: stations in, each with its place on the middle of the line (mm), heading (rad), bend (1/mm) and width
(mm); the same along the parabolas through the stations about each out, as the head does with its drum.

Source: our own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.circle import circle_through
from morfax.motion.compiled import njit
from morfax.motion.moments import (
    NO_PLACES,
    bend_of,
    parabola_of,
    straight_of,
    with_place,
)
from morfax.tracer.head.course import FELT_LEGS
from morfax.tracer.sensing.leg import Leg, leg_of
from morfax.tracer.sensing.parabola import BLOT
from morfax.tracer.sensing.view import View

LEAST_PLACES = 5  # for a parabola of their own; by trial
LEAST_WEIGHT = 0.01  # of a place at the window's end: a line that is bent counts there too


@dataclass(frozen=True, slots=True)
class Run:
    """Clean stations of a line in the order of travel: places (n, 2) mm, headings rad, bends 1/mm, widths mm.

    The view is the head's of that line. A strand is one of two lines that share their ink, in which no cell
    feels its edges.
    """

    places_mm: Array
    headings_rad: Array
    bends_per_mm: Array
    widths_mm: Array
    view: View
    legs_mm: float = 0.0  # how long the legs at its ends are, if longer than the view's
    is_strand: bool = False
    about: Run | None = None  # the same run the other way, if that was there first
    _legs: dict[bool, Leg] = field(
        default_factory=dict
    )  # as they were felt: the last, and the first

    def __len__(self) -> int:
        return len(self.places_mm)

    @property
    def length_mm(self) -> float:
        """Its length."""
        return (len(self) - 1) * self.view.step_mm

    def turned_round(self) -> Run:
        """The same, to be run the other way."""
        about = np.remainder(self.headings_rad[::-1] + 2 * math.pi, 2 * math.pi) - math.pi
        return Run(
            self.places_mm[::-1],
            about,
            -self.bends_per_mm[::-1],
            self.widths_mm[::-1],
            self.view,
            self.legs_mm,
            self.is_strand,
            self,
        )

    def part(self, first: int, last: int) -> Run:
        """Its stations from one on up to another, that not included."""
        part = slice(first, last)
        return Run(
            self.places_mm[part],
            self.headings_rad[part],
            self.bends_per_mm[part],
            self.widths_mm[part],
            self.view,
            self.legs_mm,
            self.is_strand,
        )

    def stations(self) -> Array:
        """Centres and widths, (n, 3)."""
        return np.column_stack([self.places_mm, self.widths_mm])

    def leg_in(self) -> Leg:
        """The leg that its last stations make."""
        return self._leg(True)

    def leg_out(self) -> Leg:
        """The leg that its first stations make."""
        return self._leg(False)

    def _leg(self, last: bool) -> Leg:
        if self.about is not None:
            return self.about._leg(not last).turned_round()
        if last not in self._legs:
            count = self._leg_stations
            near = self.stations()[-count:] if last else self.stations()[:count]
            leg = leg_of(near, last, self._leg_mm)
            is_long = self._leg_mm > self.view.leg_mm
            self._legs[last] = with_arc(leg) if is_long and leg.bend_per_mm else leg
        return self._legs[last]

    @property
    def _leg_mm(self) -> float:
        return max(self.legs_mm, self.view.leg_mm)

    @property
    def _leg_stations(self) -> int:
        return round(self._leg_mm / self.view.step_mm) + 1


def with_arc(leg: Leg) -> Leg:
    """A leg with the bend of the arc through its stations, if these lie on one."""
    if len(leg.seen) < LEAST_PLACES:
        return leg
    _, radius_mm, misfit_mm = circle_through(leg.seen[:, :2])
    if misfit_mm > BLOT * leg.width_mm:
        return leg
    return replace(leg, arc_per_mm=math.copysign(1 / radius_mm, leg.bend_per_mm))


def smooth(run: Run) -> Run:
    """A run whose places lie on the parabolas through the stations about each, with headings and bends."""
    half_mm = FELT_LEGS * run.view.leg_mm
    places, headings, bends = parabolas(run.places_mm, half_mm, run.view.step_mm)
    # a speck within a run has no width of its own
    widths = np.where(np.isfinite(run.widths_mm), run.widths_mm, run.view.width_mm)
    return Run(places, headings, bends, widths, run.view, run.legs_mm, run.is_strand)


@njit(cache=True)
def parabolas(places, half_mm, step_mm):  # type: ignore[no-untyped-def]
    """Places, headings and bends of the parabolas through the places about each, weighted to the middle.

    Few places make a straight line.
    """
    count, reach = len(places), int(half_mm / step_mm) + 1
    smooth, headings, bends = np.empty((count, 2)), np.empty(count), np.zeros(count)
    for n in range(count):
        first, last = max(0, n - reach), min(count - 1, n + reach)
        dx, dy = places[last, 0] - places[first, 0], places[last, 1] - places[first, 1]
        long = max(math.hypot(dx, dy), NOT_ZERO)
        c, s = dx / long, dy / long
        # the window is as long at the ends of the line, but to one side
        half = max(half_mm, max(last - n, n - first) * step_mm * 1.01)
        sums = NO_PLACES
        for k in range(first, last + 1):
            x = (places[k, 0] - places[n, 0]) * c + (places[k, 1] - places[n, 1]) * s
            y = (places[k, 1] - places[n, 1]) * c - (places[k, 0] - places[n, 0]) * s
            sums = with_place(sums, max(1.0 - (x / half) ** 2, LEAST_WEIGHT), x, y)
        is_one, p0, p1, p2 = parabola_of(sums)
        one_sided = n - first < 2 or last - n < 2
        if last - first + 1 < LEAST_PLACES or one_sided or not is_one:
            p0, p1, p2 = straight_of(sums)
        smooth[n, 0], smooth[n, 1] = places[n, 0] - p0 * s, places[n, 1] + p0 * c
        headings[n] = math.atan2(s, c) + math.atan(p1)
        bends[n] = bend_of(p1, 2.0 * p2)
    return smooth, headings, bends
