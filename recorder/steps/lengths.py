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

import numpy as np
from numba import njit
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.recorder.steps.rings import LARGEST, commands

Steps = NDArray[np.int64]

WIDTH = 16
SPARE_LEVELS = 400  # intervals that a course may take beyond twice the leg's own time
_SPEED, _TOO_FAST, _NO_VECTOR, _STANDING = 0.05, 1.0, 0.4, 0.5
_SLOWEST = 0.7  # steps per interval: near a stop the speed goes to nothing, and a course must still arrive
_PX, _NX, _AT = (
    0,
    3,
    6,
)  # columns of a course: place, steps in the interval, nearest place of the leg


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
    levels = int(2 * left[0]) + SPARE_LEVELS
    shape = (levels, WIDTH)
    parents, taken = np.zeros(shape, np.int16), np.zeros((*shape, 3), np.int8)
    off = np.zeros(shape, np.float32)
    course = np.array([spacing_steps, WIDTH])
    last, winner = _search(
        np.ascontiguousarray(places_steps),
        speeds,
        left,
        course,
        start_steps,
        end,
        moves,
        commands(),
        parents,
        taken,
        off,
    )
    if last < 0:
        raise ValueError("no course of steps arrives at the end of the leg; run it slower")
    return _traced_back(last, winner, parents, taken, off)


def _traced_back(
    last: int,
    winner: int,
    parents: NDArray[np.int16],
    taken: NDArray[np.int8],
    off: NDArray[np.float32],
) -> tuple[Steps, Array]:
    """The steps and distances of the winning course, from its start."""
    steps, distances = np.zeros((last + 1, 3), np.int64), np.zeros(last + 1)
    for level in range(last, -1, -1):
        steps[level], distances[level] = taken[level, winner], off[level, winner]
        winner = int(parents[level, winner])
    return steps, distances


@njit(cache=True)
def _nearest(places, first, guess, x, y, z):  # type: ignore[no-untyped-def]
    """The leg's place nearest to a point, searched downhill from a guess, and the squared distance."""
    n = len(places)
    at = min(max(guess, first), n - 1)
    best = (places[at, 0] - x) ** 2 + (places[at, 1] - y) ** 2 + (places[at, 2] - z) ** 2
    for way in (1, -1):
        while first <= at + way < n:
            p = places[at + way]
            other = (p[0] - x) ** 2 + (p[1] - y) ** 2 + (p[2] - z) ** 2
            if other >= best:
                break
            at, best = at + way, other
    return at, best


@njit(cache=True)
def _keep(beam, costs, origin, count, course, cost, parent):  # type: ignore[no-untyped-def]
    """Put a course among the best ones; of two at one place and speed the cheaper stays."""
    width = len(costs)
    if count == width and cost >= costs[width - 1]:
        return count
    at = count
    for i in range(count):
        if beam[i, 0] == course[0] and beam[i, 1] == course[1] and beam[i, 2] == course[2]:
            same = (
                beam[i, 3] == course[3] and beam[i, 4] == course[4] and beam[i, 5] == course[5]
            )
            if same:
                if costs[i] <= cost:
                    return count
                at = i
                break
    if at == count:
        if count < width:
            count += 1
        at = count - 1
    while at > 0 and costs[at - 1] > cost:
        beam[at], costs[at], origin[at] = beam[at - 1], costs[at - 1], origin[at - 1]
        at -= 1
    beam[at], costs[at], origin[at] = course, cost, parent
    return count


@njit(cache=True)
def _search(places, speeds, left, settings, start, end, moves, table, parents, taken, off):  # type: ignore[no-untyped-def]
    """Carry the beam on until a course stands at the end; its last level and its row, or -1."""
    spacing, width = settings[0], int(settings[1])
    beam, new = np.zeros((width, 7), np.int64), np.zeros((width, 7), np.int64)
    costs, new_costs, origin = np.zeros(width), np.zeros(width), np.zeros(width, np.int64)
    course = np.zeros(7, np.int64)
    beam[0, :3] = start
    count = 1
    near = (
        len(places) - 1 - int(1 / spacing)
    )  # the end itself may lie up to half a step off the whole steps
    low, high = np.where(moves, -1, 0), np.where(moves, 1, 0)
    for level in range(len(parents)):
        new_count = 0
        for b in range(count):
            for dx in range(low[0], high[0] + 1):
                for dy in range(low[1], high[1] + 1):
                    for dz in range(low[2], high[2] + 1):
                        course[3], course[4], course[5] = (
                            beam[b, 3] + dx,
                            beam[b, 4] + dy,
                            beam[b, 5] + dz,
                        )
                        if max(abs(course[3]), abs(course[4]), abs(course[5])) > LARGEST:
                            continue
                        for axis in range(3):
                            course[axis] = beam[b, axis] + course[3 + axis]
                        way = np.sqrt(course[3] ** 2 + course[4] ** 2 + course[5] ** 2)
                        guess = beam[b, 6] + int(way / spacing)
                        at, squared = _nearest(
                            places, beam[b, 6], guess, course[0], course[1], course[2]
                        )
                        course[6] = at
                        wanted = max((speeds[beam[b, 6]] + speeds[at]) / 2, _SLOWEST)
                        excess = way - wanted
                        cost = (
                            costs[b]
                            + squared
                            + (_TOO_FAST if excess > 0.5 else _SPEED) * excess**2
                        )
                        cost += _STANDING * (1 - left[beam[b, 6]] + left[at])
                        if (
                            dz != 0
                            or table[beam[b, 3] + LARGEST, beam[b, 4] + LARGEST, dx + 1, dy + 1]
                            < 0
                        ):
                            cost += _NO_VECTOR
                        new_count = _keep(
                            new, new_costs[:width], origin, new_count, course, cost, b
                        )
        for b in range(new_count):
            beam[b], costs[b] = new[b], new_costs[b]
            parents[level, b] = origin[b]
            taken[level, b] = new[b, 3:6]
            p = places[new[b, 6]]
            off[level, b] = np.sqrt(
                (p[0] - new[b, 0]) ** 2 + (p[1] - new[b, 1]) ** 2 + (p[2] - new[b, 2]) ** 2
            )
        count = new_count
        for b in range(count):
            arrived = beam[b, 0] == end[0] and beam[b, 1] == end[1] and beam[b, 2] == end[2]
            if (
                arrived
                and beam[b, 3] == 0
                and beam[b, 4] == 0
                and beam[b, 5] == 0
                and beam[b, 6] >= near
            ):
                return level, b
    return -1, 0
