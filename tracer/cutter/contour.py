"""The contour and the cutter's paths beside it, and which places of the paths belong to places drawn on the
contour.

Signals: a line as it was followed, and paths of the cutter's middle, mm, in; out where the contour begins,
and places of the paths: which path, and which of its points, fractions included.

    ───┼──── contour        the foot of a stop mark: the arm of the cutter's radius stands on the contour at
       │arm                 the mark, across its heading; where the cutter cannot reach (in an inner corner),
    ───●──── path           the nearest place of the paths

The contour is what is cut of a line: without the lead line to it, and without the guide lines off it. Where
the head took a guide line and came back, the contour goes straight on.

Source: our own; the heading at a place is that of a cubic through the places about it, least squares.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from morfax.motion.crossings import crossings
from morfax.motion.curves import hermite
from morfax.motion.long_array import LongArray, is_mapped
from morfax.motion.plane import CORNER_RAD, NOTHING_MM2, heading_of, left_of
from morfax.motion.polyline import (
    APART_MM,
    at_places,
    evenly,
    length_mm,
    lengths_by_blocks,
    lengths_mm,
    with_places,
)
from morfax.tracer.following.line import Line
from morfax.tracer.sensing.leg import turn

if TYPE_CHECKING:
    from morfax.motion.arrays import Array
    from morfax.motion.offset import OffsetPath
    from morfax.tracer.operator.operator import Operator
    from morfax.tracer.operator.work import Halt
    from morfax.tracer.program.program import Trace

# All limits below were chosen by trial on the test drawings.
# the heading at a place is felt so far to either side, the furthest over which the contour is a cubic ...
ABOUT_MM = (3.0, 2.0, 1.0)
STRAIGHT_MM = 0.015  # ... within this: about a tick the head wavers by some um
MET_MM = 1.0  # over this a contour's beginning and end are brought together
LEFT_OUT_MM = 0.5  # left out beside the junction of a guide line: the head swivelled there
# the heading there is that of a parabola over so much of the contour; of a chord where half of it is missing
FELT_MM = 1.0
NEAR = 0.05  # of the radius: a path that the arm meets further from its end is another path


class PathPlace(NamedTuple):
    """A place of the cutter's paths: the number of the path, and which of its points, fractions included."""

    path: int
    at: float


@dataclass(frozen=True, slots=True)
class Cut:
    """What is cut of a line: places (n, 2) mm from `first` on, no guide lines, and its stops."""

    line: Line
    first: int
    places_mm: Array
    closed: bool
    stops: tuple[Halt, ...]
    down_at: float | None  # the position of the tick at which the tool goes down

    @property
    def length_mm(self) -> float:
        """How long the contour is, mm."""
        return length_mm(self.places_mm)

    @classmethod
    def of(cls, line: Line, operator: Operator, number: int) -> Cut | None:
        """What an operator cuts of a line, its stops numbered from `number` on.

        None if nothing is cut, as of a guide line without a tick.
        """
        down_at = operator.down_at(line, number)
        if len(line.xy_mm) < 2 or line.is_dot or (line.is_guide and down_at is None):
            return None
        first = _first_cut(line, down_at)
        closed = line.is_lead or line.ending == "closed"
        places_mm = _places(line, first)
        if closed:
            places_mm = _closed(places_mm)
        return cls(line, first, places_mm, closed, tuple(operator.stops(line, number)), down_at)


def _first_cut(line: Line, down_at: float | None) -> int:
    """The first position of a line that is cut: where the tool goes down, or the end of the lead line."""
    if line.is_guide and down_at is not None:
        return math.ceil(down_at)
    return (line.loop_from or 0) if line.is_lead else 0


def planned(trace: Trace) -> list[tuple[Line, Cut | None]]:
    """The lines with the numbers of their stops, each with what is cut of it."""
    found, first = list[tuple[Line, Cut | None]](), 1
    for line in trace.lines:
        halts = trace.operator.stops(line, first)
        line = replace(line, numbers=tuple(halt.number or 0 for halt in halts))
        found.append((line, Cut.of(line, trace.operator, first)))
        first += len(halts)
    return found


def _places(line: Line, first: int) -> Array:
    """Places of a line from a position on, straight on where guide lines leave it, (n, 2) mm."""
    guides = [guide for guide in line.guides if guide.leave > first]
    begins = [first, *(guide.back for guide in guides)]
    ends = [*(guide.leave for guide in guides), len(line.xy_mm) - 1]
    if not guides:
        return line.xy_mm[first:]
    whole = np.empty((0, 2))
    for k, (a, b) in enumerate(zip(begins, ends, strict=True)):
        part = line.xy_mm[a : b + 1]
        lengths = lengths_mm(part)
        low = LEFT_OUT_MM if k > 0 else 0.0
        high = lengths[-1] - (LEFT_OUT_MM if k < len(guides) else 0.0)
        part = part[(lengths >= low) & (lengths <= high)]
        if len(part) < 2:
            continue  # two guide lines leave at about one place: one bridge over both
        whole = np.vstack([whole, _bridge(whole, part), part]) if len(whole) else part
    return whole


def _bridge(before: Array, after: Array) -> Array:
    """A cubic from the end of some places (n, 2) mm to the beginning of others; nothing at a corner."""
    arrives = _end_heading(before)
    leaves = _end_heading(after[::-1]) + math.pi
    if abs(turn(arrives, leaves)) > CORNER_RAD:
        return np.empty((0, 2))
    return hermite(before[-1], arrives, after[0], leaves)[1:-1]


def _end_heading(places_mm: Array) -> float:
    """The heading at the last of some places (n, 2) mm, rad."""
    from numpy.polynomial import polynomial

    lengths = lengths_mm(places_mm)
    away_mm = lengths - lengths[-1]
    near = away_mm >= -FELT_MM
    degree = 2 if away_mm[near][0] < -FELT_MM / 2 else 1
    slope = polynomial.polyfit(away_mm[near], places_mm[near], degree)[1]
    return heading_of(slope)


def _closed(places_mm: Array) -> Array:
    """Places of a closed contour (n, 2) mm, brought together where it begins and ends some um apart."""
    in_memory = None if is_mapped(places_mm) else list(lengths_by_blocks(places_mm))
    for _, _, lengths in in_memory or lengths_by_blocks(places_mm):
        whole_mm = lengths[-1]
    gap_mm, closed = 0.5 * (places_mm[-1] - places_mm[0]), LongArray()
    for first, places, lengths in in_memory or lengths_by_blocks(places_mm):
        moved, left = places.copy(), whole_mm - lengths
        near = np.flatnonzero((lengths < MET_MM) | (left < MET_MM))
        after = np.clip(1 - lengths[near] / MET_MM, 0.0, 1.0)
        before = np.clip(1 - left[near] / MET_MM, 0.0, 1.0)
        moved[near] += (after - before)[:, None] * gap_mm
        closed.add(moved[1:] if first else moved)
    return closed.whole()


@dataclass(frozen=True, slots=True)
class Beside:
    """The paths of a cutter along a contour, on its left or right; a closed path ends where it begins.

    Paths that are `turned` run against the contour; without a cutter the contour itself is the path.
    """

    cut: Cut
    left: bool
    radius_mm: float
    paths: list[OffsetPath]
    turned: bool = False
    _every: Array = field(init=False)  # places of the contour, `APART_MM` from each to the next

    def __post_init__(self) -> None:
        object.__setattr__(self, "_every", evenly(self.cut.places_mm, APART_MM))

    def mm(self, place: PathPlace) -> Array:
        """Where a place is, (2,) mm."""
        return at_places(self.paths[place.path].points_mm, np.array([place.at]))[0]

    def foot(self, place_mm: Array) -> PathPlace:
        """The place of the paths for a place on the contour: at the end of the arm, or the nearest."""
        arm = self._arm(place_mm)
        if arm is not None:
            way = with_places(np.array([place_mm, place_mm + (1 + NEAR) * arm]), APART_MM)
            met = list(self.met(way))
            if met and met[0][0] >= (1 - NEAR) / (1 + NEAR) * (len(way) - 1):
                return met[0][1]
        nearest = [
            nearest_place(path.points_mm, place_mm, k) for k, path in enumerate(self.paths)
        ]
        return min(nearest, key=lambda found: found[0])[1]

    def met(self, line_mm: Array) -> Iterator[tuple[float, PathPlace]]:
        """Where a line (n, 2) mm crosses the paths, in its order: which of its positions, and the place."""
        found = list[tuple[float, PathPlace]]()
        for k, path in enumerate(self.paths):
            for at, there in crossings(line_mm, path.points_mm):
                found.append((float(at), PathPlace(k, float(there))))
        yield from sorted(found)

    def _arm(self, place_mm: Array) -> Array | None:
        """The arm from a place of the contour across its heading, (2,) mm; None at a corner."""
        here = int(np.argmin(np.hypot(*(self._every - place_mm).T)))
        way = heading(self._every, here, self.cut.closed)
        if way is None:
            return None
        across = left_of(way)
        return np.asarray((self.radius_mm if self.left else -self.radius_mm) * across)


def heading(every: Array, here: int, closed: bool) -> Array | None:
    """The heading of a line at one of its places, which are `APART_MM` apart, (2,); None at a corner."""
    from numpy.polynomial import polynomial

    for about_mm in ABOUT_MM:
        near, at_mm = _about(every, here, round(about_mm / APART_MM), closed)
        if len(near) < 4:
            return None
        cubics = polynomial.polyfit(at_mm, near, 3)
        if np.abs(polynomial.polyval(at_mm, cubics).T - near).max() < STRAIGHT_MM:
            return np.asarray(cubics[1] / np.hypot(*cubics[1]))
    return None


def _about(every: Array, here: int, reach: int, closed: bool) -> tuple[Array, Array]:
    """Places of a line about one of them, (n, 2) mm, and how far along it they are from that, mm."""
    index = np.arange(here - reach, here + reach + 1)
    if not closed:
        index = index[(index >= 0) & (index < len(every))]
    at_mm = APART_MM * (index - here).astype(float)
    return every[index % len(every)], at_mm


def nearest_place(path_mm: Array, place_mm: Array, number: int) -> tuple[float, PathPlace]:
    """How far a path is from a place at its nearest, mm, and where that is."""
    steps = np.diff(path_mm, axis=0)
    # no step of length 0
    squared = np.maximum(np.einsum("ij,ij->i", steps, steps), NOTHING_MM2)
    share = np.einsum("ij,ij->i", place_mm - path_mm[:-1], steps) / squared
    share = np.clip(share, 0.0, 1.0)
    away = np.hypot(*(path_mm[:-1] + share[:, None] * steps - place_mm).T)
    best = int(np.argmin(away))
    return float(away[best]), PathPlace(number, best + float(share[best]))
