"""The trail: where the axis has been, as the head remembers it.

Signals: positions of the screws (n, 2) mm in, of which a place every step is kept; places behind the head,
and whether a leg has been followed already, out.

    ┌────────┐┌────────┐┌──         every `BOXED` places have a box about them: what is asked of one place of
    │ · · · ·││· · · · ││ · ·       a long trail is asked of the places in the few boxes that are near to it,
    └────────┘└────────┘└──         so that a line of 100 m costs 300 times as much as one of 0.3 m

Source: our own.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.plane import heading_between
from morfax.tracer.head import loop
from morfax.tracer.limits import NEAR, PIECE_MM
from morfax.tracer.sensing.leg import Leg

# Chosen by trial on the test drawings.
MEMORY_MM = 8.0  # how far back the rings know the way in: more than they grow
ROOM = 1024  # places to begin with
BOXED = 256  # places to a box: 7 mm of travel
CHORD = 4  # places that a heading is taken over
MOSTLY = 0.5  # of a leg's first third: so many of its places


class Marks(NamedTuple):
    """A trail as kernels take it: its places, of which `marked` (1,) are there, and the boxes about them."""

    places: Array
    marked: NDArray[np.int64]
    boxes: Array
    boxed: int
    step_mm: float


class Trail:
    """Places of the axis, one every `step_mm` of travel."""

    def __init__(self, place: Array, step_mm: float) -> None:
        self.step_mm = step_mm
        self._places = np.empty((ROOM, 2))
        self._places[0] = place
        self._count = 1
        # lowest x, y and highest x, y of each full box
        self._boxes = np.empty((ROOM // BOXED, 4))
        self._boxed = 0

    def __deepcopy__(self, memo: dict[int, Any]) -> Trail:
        """A trail that goes on by itself. The places so far and their boxes, which are never changed, are
        shared: it has no room for more, and makes its own.
        """
        copied = Trail(self._places[0], self.step_mm)
        copied._places, copied._count = self._places[: self._count], self._count
        copied._boxes, copied._boxed = self._boxes[: self._boxed], self._boxed
        return copied

    def add(self, positions: Array) -> None:
        """Remember positions (n, 2) in the order of travel."""
        if not len(positions):
            return
        marks = self.marks(len(positions))
        mark_along(marks, np.asarray(positions, float))
        self.took(marks)

    def marks(self, room: int) -> Marks:
        """The trail for a kernel, with room for so many more places."""
        if self._count + room > len(self._places):
            self._places = _longer(self._places, self._count + room)
        count = np.array([self._count])
        return Marks(self._places, count, self._boxes, self._boxed, self.step_mm)

    def took(self, marks: Marks) -> None:
        """Remember what a kernel has marked."""
        self._count = int(marks.marked[0])
        self._box_up()

    def _box_up(self) -> None:
        """Have a box about each full set of places."""
        full = self._count // BOXED
        groups = self._places[self._boxed * BOXED : full * BOXED].reshape(-1, BOXED, 2)
        if full > len(self._boxes):
            self._boxes = _longer(self._boxes, full)
        if len(groups):
            self._boxes[self._boxed : full, :2] = groups.min(axis=1)
            self._boxes[self._boxed : full, 2:] = groups.max(axis=1)
            self._boxed = full

    def places(self) -> Array:
        """All places so far, (n, 2)."""
        return self._places[: self._count].copy()

    def recent(self) -> Array:
        """The last few mm (n, 2), newest last."""
        return self._places[max(0, self._count - round(MEMORY_MM / self.step_mm)) : self._count]

    def back(self, distance_mm: float) -> tuple[Array, float]:
        """Place and heading of the axis a distance ago."""
        x, y, heading = place_back(self.marks(0), float(distance_mm))
        return np.array([x, y]), heading

    def comes_again(self, width_mm: float) -> bool:
        """Whether the axis runs along its own trail, in the same sense."""
        if not is_near_itself(self.marks(0), float(width_mm)):
            return False
        return loop.comes_again(self._places[: self._count], self.step_mm, width_mm)

    def comes_back(self, leg: Leg) -> bool:
        """Whether the head followed a leg, which it has followed already, in the other sense."""
        i = int(np.argmin(np.hypot(*(self._places[: self._count - 1] - leg.end_mm).T)))
        way = self._places[i + 1] - self._places[i]
        return bool(way @ [math.cos(leg.heading_rad), math.sin(leg.heading_rad)] < 0)

    def began_on(self, leg: Leg, width_mm: float) -> bool:
        """Whether the trail begins on a leg and goes along it: the leg leads home."""
        from_home = np.hypot(*(leg.seen[:, :2] - self._places[0]).T)
        return bool(from_home.min() < NEAR * width_mm) and not self.comes_back(leg)

    def holds(self, leg: Leg, width_mm: float) -> bool:
        """Whether the beginning of a leg has been followed already, in either sense."""
        first = np.array(leg.seen[: max(3, len(leg.seen) // 3), :2])
        near = np.zeros(len(first), np.bool_)
        come_near(self.marks(0), first, float(width_mm), near)
        return bool(np.mean(near) > MOSTLY)


def _longer(rows: Array, room: int) -> Array:
    """The same rows with room for so many, and as many more; it takes no memory before it is used."""
    longer = np.empty((max(2 * len(rows), room), rows.shape[1]))
    longer[: len(rows)] = rows
    return longer


@njit(cache=True, _nrt=False)
def mark_along(marks, positions):  # type: ignore[no-untyped-def]
    """Mark a place every step along positions (n, 2), from the newest place on."""
    places, count = marks.places, marks.marked[0]
    x, y = places[count - 1, 0], places[count - 1, 1]
    come_mm = steps = 0.0
    for k in range(len(positions)):
        dx, dy = positions[k, 0] - x, positions[k, 1] - y
        come_mm += math.sqrt(dx * dx + dy * dy)
        x, y = positions[k, 0], positions[k, 1]
        now = math.floor(come_mm / marks.step_mm)
        if now > steps:
            places[count, 0], places[count, 1] = x, y
            count += 1
        steps = now
    marks.marked[0] = count


@njit(cache=True, _nrt=False)
def place_back(marks, distance_mm):  # type: ignore[no-untyped-def]
    """Place and heading of the axis a distance ago: (x mm, y mm, rad)."""
    places, count = marks.places, marks.marked[0]
    first = max(0, count - round(MEMORY_MM / marks.step_mm))
    i = max(first, count - 1 - round(distance_mm / marks.step_mm))
    j = min(i + CHORD, count - 1)
    before = max(first, j - CHORD)
    heading = heading_between(places, before, j)
    return places[i, 0], places[i, 1], heading


@njit(cache=True, _nrt=False)
def is_near_itself(marks, width_mm):  # type: ignore[no-untyped-def]
    """Whether an earlier place of the trail is near to the newest: it may run along itself."""
    places, boxes, beside_mm = marks.places, marks.boxes, 2 * NEAR * width_mm
    x, y = places[marks.marked[0] - 1, 0], places[marks.marked[0] - 1, 1]
    end = marks.marked[0] - 2 * round(PIECE_MM / marks.step_mm)
    k = 0
    while k < end:
        box = k // BOXED
        # 1. a box that is far away
        if box < marks.boxed and not (
            boxes[box, 0] < x + beside_mm
            and boxes[box, 1] < y + beside_mm
            and boxes[box, 2] > x - beside_mm
            and boxes[box, 3] > y - beside_mm
        ):
            k = (box + 1) * BOXED
            continue
        # 2. the places in it
        if abs(places[k, 0] - x) < beside_mm and abs(places[k, 1] - y) < beside_mm:
            return True
        k += 1
    return False


@njit(cache=True, _nrt=False)
def come_near(marks, places, width_mm, near):  # type: ignore[no-untyped-def]
    """Note to which of some places (n, 2) the trail came near, but for its newest piece."""
    trail, boxes, near_mm = marks.places, marks.boxes, NEAR * width_mm
    left, low, right, high = math.inf, math.inf, -math.inf, -math.inf
    for i in range(len(places)):
        left, right = min(left, places[i, 0] - width_mm), max(right, places[i, 0] + width_mm)
        low, high = min(low, places[i, 1] - width_mm), max(high, places[i, 1] + width_mm)
    k, end = 0, marks.marked[0] - round(PIECE_MM / marks.step_mm)
    while k < end:
        box = k // BOXED
        # 1. a box that is far away
        if box < marks.boxed and not (
            boxes[box, 0] < right
            and boxes[box, 1] < high
            and boxes[box, 2] > left
            and boxes[box, 3] > low
        ):
            k = (box + 1) * BOXED
            continue
        # 2. the places in it
        if left < trail[k, 0] < right and low < trail[k, 1] < high:
            for i in range(len(places)):
                away_mm = math.hypot(trail[k, 0] - places[i, 0], trail[k, 1] - places[i, 1])
                near[i] |= away_mm < near_mm
        k += 1
