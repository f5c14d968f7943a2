"""Beside a contour: the ways of the cutter along it, and the places of them that belong to what is drawn on
the contour and to it.

Signals: a line as it was followed and ways of the cutter's middle, mm, in; out where the contour begins, and
places of the ways: which way, and which of its points, fractions included.

    ───┼──── contour        the foot of a stop mark: the arm of the cutter's radius stands on the contour at the mark, across its heading;
       │arm                 where the cutter cannot come to it (in an inner corner), the place of the ways that is nearest
    ───●──── way

The contour is what is cut of a line: not the lead line to it, and not the guide lines off it. Where a guide
line was left for and come back from, the contour goes straight on.

Source: our own; the heading at a place is that of a cubic through the places about it, least squares.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial

from morfax.motion.arrays import Array
from morfax.motion.curves import hermite
from morfax.motion.offset import Way
from morfax.motion.polyline import APART_MM, crossings, lengths_mm, with_places
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Halt
from morfax.tracer.sensing.leg import turn

ABOUT_MM = (
    3.0,
    2.0,
    1.0,
)  # to either side of a place its heading is felt: as far as the contour is a cubic there,
STRAIGHT_MM = 0.015  # within this; about a tick the head wavers by some um
MET_MM = 1.0  # over this a contour's beginning and end are brought together
LEFT_OUT_MM = 0.5  # to either side of where a guide line leaves: the head swivelled there
FELT = 200  # positions, a third of a millimetre, by which the heading there is felt
CORNER = math.radians(20)
NEAR = 0.05  # of the radius: a way that is crossed by the arm further from its end is another's


class Place(NamedTuple):
    """A place of the cutter's ways: the number of the way, and which of its points, fractions included."""

    way: int
    at: float


@dataclass(frozen=True, slots=True)
class Cut:
    """What is cut of a line: from its position `first` on, (n, 2) mm without guide lines, closed if it comes
    back there; and the line's stops.
    """

    line: Line
    first: int
    places_mm: Array
    closed: bool
    stops: tuple[Halt, ...]
    down_at: float | None  # the position of the tick at which the tool goes down

    @property
    def length_mm(self) -> float:
        """How long the contour is, mm."""
        return float(lengths_mm(self.places_mm)[-1])

    @classmethod
    def of(cls, line: Line, operator: Operator, number: int) -> Cut | None:
        """What an operator cuts of a line, its stops numbered from one on; None if nothing, as of a guide
        line without a tick.
        """
        down_at = operator.down_at(line, number)
        if len(line.xy_mm) < 2 or line.is_dot or (line.is_guide and down_at is None):
            return None
        first = (
            math.ceil(down_at or 0)
            if line.is_guide
            else (line.loop_from or 0)
            if line.is_lead
            else 0
        )
        closed, places_mm = line.is_lead or line.ending == "closed", _places(line, first)
        if closed:
            places_mm = _closed(places_mm)
        return cls(line, first, places_mm, closed, tuple(operator.stops(line, number)), down_at)


def _places(line: Line, first: int) -> Array:
    """Places of a line from a position on, straight on where guide lines leave it, (n, 2) mm."""
    guides = [guide for guide in line.guides if guide.leave > first]
    begins = [first, *(guide.back for guide in guides)]
    ends = [*(guide.leave for guide in guides), len(line.xy_mm) - 1]
    whole = np.empty((0, 2))
    for k, (a, b) in enumerate(zip(begins, ends, strict=True)):
        part = line.xy_mm[a : b + 1]
        lengths = lengths_mm(part)
        low = LEFT_OUT_MM if k > 0 else 0.0
        high = lengths[-1] - (LEFT_OUT_MM if k < len(guides) else 0.0)
        part = part[(lengths >= low) & (lengths <= high)]
        whole = np.vstack([whole, _bridge(whole, part), part]) if k else part
    return whole


def _bridge(before: Array, after: Array) -> Array:
    """A cubic from the end of some places (n, 2) mm to the beginning of others, on their headings; nothing
    where those are a corner's.
    """
    ways = [
        before[-1] - before[max(0, len(before) - FELT)],
        after[min(FELT, len(after)) - 1] - after[0],
    ]
    headings = [math.atan2(way[1], way[0]) for way in ways]
    if abs(turn(*headings)) > CORNER:
        return np.empty((0, 2))
    return hermite(before[-1], headings[0], after[0], headings[1])[1:-1]


def _closed(places_mm: Array) -> Array:
    """Places of a closed contour (n, 2) mm, brought together where it begins and ends: the head came there
    twice, some um apart.
    """
    lengths = lengths_mm(places_mm)
    gap_mm = 0.5 * (places_mm[-1] - places_mm[0])
    after, before = (
        np.clip(1 - mm / MET_MM, 0.0, 1.0) for mm in (lengths, lengths[-1] - lengths)
    )
    return np.asarray(places_mm + (after - before)[:, None] * gap_mm)


@dataclass(frozen=True, slots=True)
class Beside:
    """The ways (n, 2) mm of a cutter along a contour, on its left or its right; a closed way ends where it
    begins.
    """

    cut: Cut
    left: bool
    radius_mm: float
    ways: list[Way]
    _every: Array = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_every", _evenly(self.cut.places_mm))

    def mm(self, place: Place) -> Array:
        """Where a place is, (2,) mm."""
        way = self.ways[place.way].points_mm
        return np.array([np.interp(place.at, np.arange(len(way)), column) for column in way.T])

    def foot(self, place_mm: Array) -> Place:
        """The place of the ways that belongs to one on the contour: at the end of the arm, or the nearest."""
        arm = self._arm(place_mm)
        if arm is not None:
            way = with_places(np.array([place_mm, place_mm + (1 + NEAR) * arm]), APART_MM)
            met = list(self.met(way))
            if met and met[0][0] >= (1 - NEAR) / (1 + NEAR) * (len(way) - 1):
                return met[0][1]
        return min(
            (_nearest(way.points_mm, place_mm, k) for k, way in enumerate(self.ways)),
            key=lambda found: found[0],
        )[1]

    def met(self, line_mm: Array) -> Iterator[tuple[float, Place]]:
        """Where a line (n, 2) mm crosses the ways, in its order: which of its positions, and the place."""
        found = [
            (float(at), Place(k, float(there)))
            for k, way in enumerate(self.ways)
            for at, there in crossings(line_mm, way.points_mm)
        ]
        yield from sorted(found)

    def _arm(self, place_mm: Array) -> Array | None:
        """The arm from a place of the contour across its heading, (2,) mm; None at a corner."""
        here = int(np.argmin(np.hypot(*(self._every - place_mm).T)))
        for about_mm in ABOUT_MM:
            near, at_mm = self._about(here, round(about_mm / APART_MM))
            if len(near) < 4:
                return None
            cubics = polynomial.polyfit(at_mm, near, 3)
            if np.abs(polynomial.polyval(at_mm, cubics).T - near).max() < STRAIGHT_MM:
                across = np.array([-cubics[1, 1], cubics[1, 0]]) / np.hypot(*cubics[1])
                return np.asarray((self.radius_mm if self.left else -self.radius_mm) * across)
        return None

    def _about(self, here: int, reach: int) -> tuple[Array, Array]:
        """Places of the contour about one of them, (n, 2) mm, and how far along it they are from that, mm."""
        index = np.arange(here - reach, here + reach + 1)
        if self.cut.closed:
            return self._every[index % len(self._every)], APART_MM * (index - here).astype(
                float
            )
        index = index[(index >= 0) & (index < len(self._every))]
        return self._every[index], APART_MM * (index - here).astype(float)


def _evenly(line_mm: Array) -> Array:
    """Places of a polyline, `APART_MM` from each to the next."""
    lengths = lengths_mm(line_mm)
    at_mm = np.arange(0.0, lengths[-1], APART_MM)
    return np.column_stack([np.interp(at_mm, lengths, column) for column in line_mm.T])


def _nearest(way_mm: Array, place_mm: Array, number: int) -> tuple[float, Place]:
    """How far a way is from a place at its nearest, mm, and where that is."""
    steps = np.diff(way_mm, axis=0)
    share = np.einsum("ij,ij->i", place_mm - way_mm[:-1], steps) / np.maximum(
        np.einsum("ij,ij->i", steps, steps), 1e-18
    )
    share = np.clip(share, 0.0, 1.0)
    away = np.hypot(*(way_mm[:-1] + share[:, None] * steps - place_mm).T)
    best = int(np.argmin(away))
    return float(away[best]), Place(number, best + float(share[best]))
