"""Legs: clean stretches of line, as parabolas through the stations that were felt on them.

Signals: stations of the line (n, 3: centre x, y and width, mm) in; place, heading (rad) and bend (1/mm) of
the line out, and where two legs meet.

    place(s) = end + s·t + bend/2·s²·n          t, n: along and across the heading at the leg's clean end

Source: our own (see `rings`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.plane import CORNER_RAD, direction, left_of
from morfax.tracer.effort import ROUNDS
from morfax.tracer.limits import AHEAD_RAD, BACK_RAD, NEARLY_PARALLEL
from morfax.tracer.sensing.parabola import leg_about, leg_through
from morfax.tracer.sensing.scout import FEWEST

# straight on is within this, and a leg turns off to a side by more than that
STRAIGHT, TURNS_OFF = AHEAD_RAD, CORNER_RAD
# legs that turn by more lie beside each other: a tip, or a line that comes back; by trial
TURNS_BACK = BACK_RAD
# two ends whose headings are so near to one line face each other; by trial
FACING = math.radians(35)
FARTHEST_MM = 10.0  # legs that meet further away do not meet
FEWEST_STATIONS, LEAST_WIDTHS = FEWEST, 0.8  # of clean line make a leg; by trial
ABOUT_LEGS = 1.5  # lengths of a leg: so much is felt of a line to show a leg in the midst of it

# how far two legs meet beyond the one's clean end and before the other's, mm
Meeting = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Leg:
    """A clean stretch of line at a junction, with its stations `seen`.

    `end_mm` is its clean end; the heading there and the bend are along the travel. Of a long leg `arc_per_mm`
    is the bend of the arc over all of it: where it turns far, a parabola bends too little at its ends.
    """

    end_mm: Array
    heading_rad: float
    bend_per_mm: float
    width_mm: float
    seen: Array
    arc_per_mm: float | None = None

    @property
    def bends_on_per_mm(self) -> float:
        """The bend with which its line goes on far beyond its end, 1/mm."""
        return self.bend_per_mm if self.arc_per_mm is None else self.arc_per_mm

    def at(self, along_mm: float | Array) -> Array:
        """Places (…, 2) at distances from the clean end along the travel (negative: before it)."""
        if isinstance(along_mm, (float, int)):
            return np.array(self.place(along_mm))
        s = np.asarray(along_mm, float)[..., None]
        t = direction(self.heading_rad)
        n = left_of(t)
        return self.end_mm + s * t + 0.5 * self.bend_per_mm * s * s * n

    def place(self, along_mm: float) -> tuple[float, float]:
        """The place at one distance, as `at` has it to the bit: an array of two takes ten times as long."""
        return _place.py_func(self._line, along_mm)  # type: ignore[no-any-return]

    @property
    def _line(self) -> tuple[float, float, float, float]:
        """Its clean end, its heading and its bend, as kernels take them."""
        x, y = self.end_mm.tolist()
        return x, y, self.heading_rad, float(self.bend_per_mm)

    def shifted(self, along_mm: float, seen: Array) -> Leg:
        """The same line from a place further along it, with the stations that were felt from there."""
        heading = self.heading_at(along_mm)
        return Leg(self.at(along_mm), heading, self.bend_per_mm, self.width_mm, seen)

    def turned_round(self) -> Leg:
        """The same leg, to go back along it."""
        heading = math.remainder(self.heading_rad + math.pi, math.tau)
        arc = None if self.arc_per_mm is None else -self.arc_per_mm
        seen = self.seen[::-1]
        return Leg(self.end_mm, heading, -self.bend_per_mm, self.width_mm, seen, arc)

    def heading_at(self, along_mm: float) -> float:
        """Heading at a distance from the clean end, rad."""
        return self.heading_rad + math.atan(self.bend_per_mm * along_mm)


# fitting


def leg_of(seen: Array, last: bool, length_mm: float) -> Leg:
    """Fit a leg to stations (n, 3) in the order of travel; its clean end is at the `last` or the first one.

    The leg takes in as long a stretch as one parabola fits about as well as it fits the nearest part.
    """
    found, begin, stop = leg_through(np.ascontiguousarray(seen), last, length_mm)
    x, y, heading, bend, width = found
    return Leg(np.array([x, y]), heading, bend, width, seen[begin:stop])


def centre_at(seen: Array, i: int, half_mm: float) -> Leg:
    """The line about station i, seen within `half_mm` to both sides (see `parabola.leg_about`)."""
    x, y, heading, bend, width = leg_about(np.ascontiguousarray(seen), i, half_mm)
    return Leg(np.array([x, y]), heading, bend, width, seen[i:])


# two legs


def turn(a: float, b: float) -> float:
    """Angle from heading a to heading b, -pi..pi."""
    return math.remainder(b - a, math.tau)


def half_turn_rad(one: Leg, out: Leg, long_mm: float) -> float:
    """By how much an arc that bends as two legs do turns from its beginning onto its chord, rad; a quarter
    turn where no such arc has so long a chord.
    """
    across = 0.25 * long_mm * (one.bends_on_per_mm + out.bends_on_per_mm)
    return math.asin(min(max(across, -1.0), 1.0))


def meet(incoming: Leg, outgoing: Leg) -> Meeting | None:
    """Distances (beyond the incoming leg's end, before the outgoing leg's) where they cross, mm, or None."""
    they_meet, s, u = _meet(incoming._line, outgoing._line)
    return (s, u) if they_meet else None


@njit(cache=True, _nrt=False)
def _meet(incoming, outgoing):  # type: ignore[no-untyped-def]
    """Whether two lines (x, y, heading, bend) meet, and those distances, by Newton's steps."""
    s = u = 0.0
    for _ in range(ROUNDS):
        a = incoming[2] + math.atan(incoming[3] * s)
        b = outgoing[2] + math.atan(outgoing[3] * -u)
        turned = b - a
        turned -= math.tau * round(turned / math.tau)
        cross = math.sin(turned)
        if abs(cross) < NEARLY_PARALLEL:
            return False, s, u
        from_x, from_y = _place(incoming, s)
        to_x, to_y = _place(outgoing, -u)
        dx, dy = to_x - from_x, to_y - from_y
        ds = (dx * math.sin(b) - dy * math.cos(b)) / cross
        du = (dx * math.sin(a) - dy * math.cos(a)) / cross
        s, u = s + ds, u - du
        if max(abs(s), abs(u)) > FARTHEST_MM:
            return False, s, u
    return True, s, u


@njit(cache=True, _nrt=False)
def _place(line, along_mm):  # type: ignore[no-untyped-def]
    """The place at a distance along a line (x, y, heading, bend)."""
    x, y, heading, bend = line
    c, s = math.cos(heading), math.sin(heading)
    aside = 0.5 * bend * along_mm * along_mm
    return x + along_mm * c + aside * -s, y + along_mm * s + aside * c


def turns_off(incoming: Leg, leg: Leg) -> bool:
    """Whether a leg turns off from another so far that it is certain where they meet."""
    return abs(turn(incoming.heading_rad, leg.heading_rad)) > TURNS_OFF


def goes_straight(incoming: Leg, outgoing: Leg | None) -> bool:
    """Whether a leg goes on straight from another."""
    if outgoing is None:
        return False
    return abs(turn(incoming.heading_rad, outgoing.heading_rad)) < STRAIGHT
