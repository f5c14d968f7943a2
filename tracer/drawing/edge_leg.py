"""A leg of a corner of an edge, felt where the lens has left it in its place.

Signals: places (n, 2) of an outline and the part of them that is a leg in; out the leg as a straight line or
a parabola, and where it meets another.

Source: our own.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import cross, left_of, meeting, unit
from morfax.tracer.effort import ROUNDS
from morfax.tracer.limits import NEARLY_PARALLEL

BENT = 0.7  # of what is left by a straight leg: a parabola has to leave less than this share


class EdgeLeg(NamedTuple):
    """A leg of a corner: its near end, the direction towards the corner, and a polynomial across it."""

    origin: Array
    along: Array
    across: Array

    @classmethod
    def felt(cls, places: Array, at: int, near: float, far: float) -> EdgeLeg:
        """A leg as a parabola seen from its near end, or as a straight line if that fits about as well."""
        first, last = round(min(near, far)), round(max(near, far))
        rows = np.arange(first, last + 1) + at
        leg = places[rows % len(places)]
        origin, end = (leg[-1], leg[0]) if near < 0 else (leg[0], leg[-1])
        along = unit(origin - end)
        out = leg - origin
        u, v = out @ along, out @ left_of(along)
        straight, bent = fitted(u, v)
        off = [float(np.std(v - np.polyval(each[::-1], u))) for each in (straight, bent)]
        return cls(origin, along, bent if off[1] < BENT * off[0] else straight)

    def beside(self, place: Array) -> tuple[Array, Array]:
        """The leg beside a place, and its direction there."""
        u = float((place - self.origin) @ self.along)
        left = left_of(self.along)
        powers = np.arange(len(self.across))
        slope = float(np.sum(powers[1:] * self.across[1:] * u ** powers[:-1]))
        direction = self.along + slope * left
        beside = self.origin + u * self.along + float(np.sum(self.across * u**powers)) * left
        return beside, unit(direction)

    def met(self, other: EdgeLeg) -> tuple[Array, Array, Array] | None:
        """Where two legs meet, and their directions there, towards the corner; None if they do not."""
        place = 0.5 * (self.origin + other.origin)
        for _ in range(ROUNDS):
            (p, t), (q, w) = self.beside(place), other.beside(place)
            if abs(cross(t, w)) < NEARLY_PARALLEL:
                return None
            place = meeting(p, t, q, w)
        reach = 4 * float(np.hypot(*(self.origin - other.origin)))
        for leg in (self, other):
            beyond = place - leg.origin
            if np.hypot(*beyond) > reach or beyond @ leg.along < 0:
                return None
        return place, t, w


def fitted(u: Array, v: Array) -> tuple[Array, Array]:
    """The straight line and the parabola through places, each as its powers' shares, from the lowest on.

    Of polynomials that stand at right angles on these places each share is a quotient: there are thousands of
    legs on a rough edge.
    """
    middle = float(u.mean())
    first = u - middle
    square = float(first @ first)
    slope = float(first @ v) / square
    straight = np.array([float(v.mean()) - slope * middle, slope])
    # the second: first² - skew · first - spread
    spread, skew = square / len(u), float(first @ first**2) / square
    second = first * first - skew * first - spread
    bend = float(second @ v) / float(second @ second)
    bent = bend * np.array([middle * middle + skew * middle - spread, -2 * middle - skew, 1.0])
    return straight, bent + np.append(straight, 0.0)
