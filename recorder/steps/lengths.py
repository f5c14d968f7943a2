"""Lengths: a leg cut into steps per interval, near its path, near its speed, and in rings where that can be.

Signals in: a leg's places in steps, its speeds in steps per interval. Signals out: the steps (k, 3) of each
interval, -7 … +7 on an axis, no two intervals in succession more than one apart, from rest to rest, from one
whole step to another.

No interval can be chosen for itself, as what is too fast now cannot be stopped later. So a beam of the best
few courses is carried on interval by interval; each is continued in all ways that its motors allow, 3 for
each axis that moves, and the best of all these are kept. A course pays for each interval

    distance of its place from the path          steps²
    0.05 · (way along the path - speed)²         1.0 for what is more than half a step above it
    0.02   where the change is no vector command
    0.5  · (1 - intervals of its leg that it has put behind it)

The last keeps the courses that stand from being the cheapest.

Source: patent ES 443122, page 25 ("calculate each length required to produce a trajectory within the
tolerance"). Questions: the patent leaves the way to the programmer. Widths of 8 to 128 courses came within
0.3 % of each other in distance (root mean square), share of vectors and time, on the sample drawings.
"""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.recorder.steps.rings import LARGEST, commands

Steps = NDArray[np.int64]

WIDTH = 16  # courses of the beam; from 8 on hardly any better (see Questions)
SPARE_LEVELS = 400  # intervals that a course may take beyond twice the leg's own time
_SPEED, _TOO_FAST, _NO_VECTOR, _STANDING = 0.05, 1.0, 0.4, 0.5  # prices of a course, as above
_SLOWEST = 0.7  # steps per interval: near a stop the speed goes to nothing, and a course must still arrive
# columns of a course: place, steps in the interval, nearest place of the leg, the course it goes on from
_PX, _NX, _AT, _FROM, _COLUMNS = 0, 3, 6, 7, 8


class _Task(NamedTuple):
    """A leg in steps: places, speeds, intervals left from each place, changes allowed, vector commands."""

    places: Array
    speeds: Array
    left: Array
    spacing: float
    start: Steps
    end: Steps
    changes: Steps
    table: NDArray[np.int8]


class _Book(NamedTuple):
    """What every course did in every interval: where it comes from, its steps, its distance off the path."""

    parents: NDArray[np.int16]
    taken: NDArray[np.int8]
    off: NDArray[np.float32]


def cut(
    places_steps: Array, speeds: Array, spacing_steps: float, start_steps: Steps
) -> tuple[Steps, Array]:
    """Steps (k, 3) of the intervals of a leg, and the distance of each interval's end from the path, steps.

    The leg starts at the whole steps given and ends at those nearest to its end. Raises ValueError where no
    course arrives: the leg is too fast for its bends.
    """
    end = np.rint(places_steps[-1]).astype(np.int64)
    moves = (np.ptp(places_steps, axis=0) > 0.5) | (end != start_steps)
    if not moves.any():
        return np.zeros((0, 3), np.int64), np.zeros(0)
    own = spacing_steps / np.maximum((speeds[1:] + speeds[:-1]) / 2, _SLOWEST)
    left = np.r_[np.cumsum(own[::-1])[::-1], 0.0]  # intervals from each place to the end
    changes = np.array(
        list(product(*((-1, 0, 1) if axis else (0,) for axis in moves))), np.int64
    )
    places = np.ascontiguousarray(places_steps)
    task = _Task(places, speeds, left, spacing_steps, start_steps, end, changes, commands())
    shape = int(2 * left[0]) + SPARE_LEVELS, WIDTH
    book = _Book(
        np.zeros(shape, np.int16), np.zeros((*shape, 3), np.int8), np.zeros(shape, np.float32)
    )
    last, winner = _search(task, book)
    if last < 0:
        raise ValueError("no course of steps arrives at the end of the leg; run it slower")
    return _traced_back(last, winner, book)


def _traced_back(last: int, winner: int, book: _Book) -> tuple[Steps, Array]:
    """The steps and distances of the winning course, from its start."""
    steps = np.zeros((last + 1, 3), np.int64)
    distances = np.zeros(last + 1)
    for level in range(last, -1, -1):
        steps[level] = book.taken[level, winner]
        distances[level] = book.off[level, winner]
        winner = int(book.parents[level, winner])
    return steps, distances


@njit(cache=True)
def _search(task, book):  # type: ignore[no-untyped-def]
    """Carry the beam on until a course stands at the end; its last level and its row, or -1."""
    # once: a tuple is slow in a loop
    places, speeds, left, spacing, start, end, changes, table = task
    parents, taken, off = book
    width = off.shape[1]
    beam = np.zeros((width, _COLUMNS), np.int64)
    new = np.zeros((width, _COLUMNS), np.int64)
    costs, new_costs = np.zeros(width), np.zeros(width)
    course = np.zeros(_COLUMNS, np.int64)
    beam[0, :3] = start
    count = 1
    near = len(places) - 1 - int(1 / spacing)  # the end may lie half a step off the whole steps
    for level in range(len(off)):
        # 1. continue every course in all ways that the motors allow, and keep the best
        new_count = 0
        for b in range(count):
            for k in range(len(changes)):
                if not _continued(beam, b, changes, k, course):
                    continue
                first = beam[b, _AT]
                at = _nearest(places, first, first + int(_way(course) / spacing), course)
                course[_AT] = at
                cost = costs[b] + _squared(places, at, course)
                cost += _speed_price(course, (speeds[first] + speeds[at]) / 2)
                cost += _STANDING * (1 - left[first] + left[at])
                if not _is_vector(table, beam, b, course):
                    cost += _NO_VECTOR
                new_count = _keep(new, new_costs, new_count, course, cost)
        # 2. take them down
        count = new_count
        for b in range(count):
            beam[b] = new[b]
            costs[b] = new_costs[b]
            parents[level, b] = new[b, _FROM]
            taken[level, b] = new[b, _NX:_AT]
            off[level, b] = np.sqrt(_squared(places, new[b, _AT], new[b]))
        # 3. stop where one has arrived
        for b in range(count):
            if beam[b, _AT] >= near and _arrived(beam, b, end):
                return level, b
    return -1, 0


@njit(cache=True)
def _continued(beam, b, changes, k, course):  # type: ignore[no-untyped-def]
    """Set a course that goes on from course b by change k of its steps; False where it is too fast."""
    for axis in range(3):
        steps = beam[b, _NX + axis] + changes[k, axis]
        if abs(steps) > LARGEST:
            return False
        course[_NX + axis] = steps
        course[_PX + axis] = beam[b, _PX + axis] + steps
    course[_FROM] = b
    return True


@njit(cache=True)
def _speed_price(course, speed):  # type: ignore[no-untyped-def]
    """The price of an interval that is not as long as the speed asks for."""
    excess = _way(course) - max(speed, _SLOWEST)
    return (_TOO_FAST if excess > 0.5 else _SPEED) * excess**2


@njit(cache=True)
def _is_vector(table, beam, b, course):  # type: ignore[no-untyped-def]
    """Whether a vector command leads from course b to the steps of a course."""
    if course[_NX + 2] != beam[b, _NX + 2]:
        return False
    x = beam[b, _NX]
    y = beam[b, _NX + 1]
    to_x = course[_NX] - x + 1
    to_y = course[_NX + 1] - y + 1
    return table[x + LARGEST, y + LARGEST, to_x, to_y] >= 0


@njit(cache=True)
def _keep(beam, costs, count, course, cost):  # type: ignore[no-untyped-def]
    """Put a course among the best ones; of two at one place and speed the cheaper stays."""
    width = len(costs)
    if count == width and cost >= costs[width - 1]:
        return count
    at = count
    for i in range(count):
        if _alike(beam, i, course):
            if costs[i] <= cost:
                return count
            at = i
            break
    if at == count:
        count = min(count + 1, width)
        at = count - 1
    while at > 0 and costs[at - 1] > cost:
        beam[at] = beam[at - 1]
        costs[at] = costs[at - 1]
        at -= 1
    beam[at], costs[at] = course, cost
    return count


@njit(cache=True)
def _alike(beam, i, course):  # type: ignore[no-untyped-def]
    """Whether a course is at the place of course i with the same steps."""
    for column in range(_AT):  # noqa: SIM110  (numba takes no generators)
        if beam[i, column] != course[column]:
            return False
    return True


@njit(cache=True)
def _arrived(beam, b, end):  # type: ignore[no-untyped-def]
    """Whether course b stands at the end of the leg."""
    for axis in range(3):  # noqa: SIM110
        if beam[b, _PX + axis] != end[axis] or beam[b, _NX + axis] != 0:
            return False
    return True


@njit(cache=True)
def _nearest(places, first, guess, course):  # type: ignore[no-untyped-def]
    """The leg's place nearest to a course's, searched downhill from a guess and not before `first`."""
    n = len(places)
    at = min(max(guess, first), n - 1)
    best = _squared(places, at, course)
    for way in (1, -1):
        while first <= at + way < n:
            other = _squared(places, at + way, course)
            if other >= best:
                break
            at, best = at + way, other
    return at


@njit(cache=True)
def _squared(places, at, course):  # type: ignore[no-untyped-def]
    """Squared distance of a course's place from a place of the leg, steps²."""
    x = places[at, 0] - course[0]
    y = places[at, 1] - course[1]
    z = places[at, 2] - course[2]
    return x**2 + y**2 + z**2


@njit(cache=True)
def _way(course):  # type: ignore[no-untyped-def]
    """Length of a course's last interval, steps."""
    return np.sqrt(course[_NX] ** 2 + course[_NX + 1] ** 2 + course[_NX + 2] ** 2)
