"""Ramp counter: a positioning move speeds up, holds its feed, and comes to rest exactly where it was sent.

Signals in: the demanded place in mm, a feed in mm/s, one acceleration in mm/s² for all changes of speed.
Signals out: positions in mm at the motion rate.

    feed        ___________
               /           \\            counter, set to -N, the increments of the move of all axes together:
              /             \\             +2 for each increment while the speed rises (it, and its braking)
        _____/               \\_____       +1 for each at constant speed, 0 while the speed falls
             +2    +1       0 ^ 0        ramp down as soon as the counter is no longer negative

With one acceleration a and increments d the square of the speed is a whole number of steps, v² = 2 a d e:
each increment of a ramp up adds one to e, each of a ramp down takes one. At zero the increments left are
exactly e, as

    left = N - up - const - down  and  0 = -N + 2 up + const  give  left = up - down = e,

whatever changes of speed there were on the way. No division, and no second comparison per increment.

Source: patent ES 414458, figures 3 and 4 (counter 60, gates 72 and 74, pulse doubler 76, line 78), claims 2
to 4. Questions: the patent leaves out what follows. A move too short to reach its feed turns from ramp up to
ramp down; if N is odd there the counter goes from -1 to +1 within one increment, so the test is for >= 0, and
that one increment is run half up, half down. Several axes have one counter and keep the ratio of their
distances, as only then each of them ends exactly. The first feed is reached after a whole number of
increments: the acceleration is lowered slightly for that; later feeds are the next lower whole numbers. A new
demand on the way sets the counter to -N + e.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import ROUNDED, Array
from morfax.motion.compiled import njit
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.plane import NOTHING_MM
from morfax.motion.usual import ACCELERATION_MM_S2, INCREMENT_MM

UP, CONSTANT, DOWN = 1, 0, -1
_LARGEST_COUNT = 1 << 40  # 1000 km in increments of 1 um: the counter is a 64-bit integer


Counts = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Ramp:
    """Settings: the one acceleration along the path, and the increment of the position transducers."""

    acceleration_mm_s2: float = ACCELERATION_MM_S2
    increment_mm: float = INCREMENT_MM

    def __post_init__(self) -> None:
        for name, value in (
            ("acceleration", self.acceleration_mm_s2),
            ("increment", self.increment_mm),
        ):
            if not 0 < value < math.inf:
                raise ValueError(
                    f"a ramp's {name} of {value:g} moves nothing; give one above zero and finite"
                )


@dataclass(frozen=True, slots=True)
class Profile:
    """A counted move: rows (mode, half increments), where the counter reached zero, and its count then."""

    pieces: Counts
    increments: int
    moving: int
    down_from: int
    count_then: int

    def at_rest(self) -> tuple[int, int]:
        """Half increments travelled, and the square of the speed in them, at the end: (2 N, 0) if exact."""
        modes, halves = self.pieces.T
        return int(halves.sum()), 2 * self.moving + int((modes * halves).sum())


def count_ramp(
    increments: int, speeds: Sequence[int], changes_at: Sequence[int] = (), *, moving: int = 0
) -> Profile:
    """Run the counter over a move of so many increments, of all axes together.

    A speed is given as the increments that a ramp from rest needs to reach it; `speeds[i + 1]` begins after
    `changes_at[i]` increments. `moving` is the speed at a new demand on the way. Raises ValueError if the
    move is too short.
    """
    if not 0 <= moving <= increments <= _LARGEST_COUNT:
        raise ValueError(
            f"{increments} increments are too few to stop in from a speed that needs {moving}; "
            f"give {moving} to {_LARGEST_COUNT}, or stop first and come back"
        )
    if len(speeds) != len(changes_at) + 1 or min(speeds) < 1:
        raise ValueError(
            f"{len(changes_at)} changes need one speed more, each 1 increment or more; got {list(speeds)}"
        )
    pieces = np.empty((4 * len(speeds) + 4, 2), np.int64)
    rows, down_from, count = _count(
        increments, moving, np.array(changes_at, np.int64), np.array(speeds, np.int64), pieces
    )
    return Profile(pieces[:rows].copy(), increments, moving, down_from, count)


def positions_mm(
    start_mm: Sequence[float] | Array,
    end_mm: Sequence[float] | Array,
    feed_mm_s: float,
    ramp: Ramp | None = None,
    *,
    changes: Sequence[tuple[float, float]] = (),
    rate_hz: float = MOTION_RATE_HZ,
) -> Array:
    """Positions (n, axes) in mm of a straight move at the motion rate: the start first, the end exactly last.

    `changes` holds (mm along the path, new feed in mm/s). A move of length 0 is one row.
    """
    # 1. the move in increments
    ramp = ramp or Ramp()
    start = np.asarray(start_mm, np.float64)
    end = np.asarray(end_mm, np.float64)
    feeds = [feed_mm_s, *(feed for _, feed in changes)]
    _check(start, end, feeds, rate_hz)
    length_mm = math.dist(start, end)
    if length_mm < NOTHING_MM:  # its square is still a number
        return np.array([start, end])[: 1 + bool((start != end).any())]
    increments = max(1, int(np.rint(np.abs(end - start) / ramp.increment_mm).sum()))
    mm_per_count = length_mm / increments
    # 2. what the counter makes of it
    speeds, acceleration_mm_s2 = _speeds(
        feeds, mm_per_count, ramp.acceleration_mm_s2, increments
    )
    changes_at = [round(min(max(at_mm / mm_per_count, 0), increments)) for at_mm, _ in changes]
    profile = count_ramp(increments, speeds, changes_at)
    # 3. places at each period
    travelled = _sample(profile, acceleration_mm_s2 / mm_per_count, rate_hz) / increments
    positions = start + travelled[:, None] * (end - start)
    positions[-1] = end
    return positions


def _check(start: Array, end: Array, feeds: Sequence[float], rate_hz: float) -> None:
    """Raise ValueError if a move has no two places, or would never arrive."""
    if start.ndim != 1 or start.shape != end.shape or not np.isfinite([start, end]).all():
        raise ValueError(
            f"a move from {start} to {end} is no move; give two places, finite mm for the same axes"
        )
    for name, value in [("feed", feed) for feed in feeds] + [("rate", rate_hz)]:
        if not 0 < value < math.inf:
            raise ValueError(
                f"a {name} of {value:g} never arrives; give one above zero and finite"
            )


def _speeds(
    feeds: Sequence[float], mm_per_count: float, acceleration_mm_s2: float, increments: int
) -> tuple[list[int], float]:
    """Feeds as increments of a ramp from rest, and the acceleration that makes the first of them whole.

    A speed that takes all increments of the move is never reached, and stands for all speeds above it.
    """
    exactly = feeds[0] ** 2 / (2 * acceleration_mm_s2 * mm_per_count)
    if exactly < increments:
        acceleration_mm_s2 *= exactly / max(1, math.ceil(exactly * (1 - ROUNDED)))
    squares = [
        feed**2 / (2 * acceleration_mm_s2 * mm_per_count) * (1 + ROUNDED) for feed in feeds
    ]
    return [
        max(1, math.floor(min(square, increments))) for square in squares
    ], acceleration_mm_s2


def _sample(profile: Profile, acceleration_s2: float, rate_hz: float) -> Array:
    """Increments travelled at each period of the motion rate, for an acceleration in increments/s²."""
    modes, halves = profile.pieces.T
    # squares of the speed, in half increments
    squares = 2 * profile.moving + _summed(modes * halves)
    speed = np.sqrt(acceleration_s2 * squares)  # increments/s
    # a piece's mean speed is the mean of the speeds at its ends, both exact
    took_s = halves / (speed[:-1] + speed[1:])
    begins_s = _summed(took_s)
    t_s = np.arange(math.ceil(begins_s[-1] * rate_hz - ROUNDED) + 1) / rate_hz
    piece = np.clip(np.searchsorted(begins_s, t_s, "right") - 1, 0, len(modes) - 1)
    since_s = np.minimum(t_s - begins_s[piece], took_s[piece])
    begins = _summed(halves)[piece] / 2
    gained = acceleration_s2 * modes[piece] / 2 * since_s
    return begins + (speed[piece] + gained) * since_s


def _summed(steps: NDArray[Any]) -> NDArray[Any]:
    """The sum of all steps before each, and of all."""
    sums = np.zeros(len(steps) + 1, steps.dtype)
    np.cumsum(steps, out=sums[1:])
    return sums


@njit(cache=True)
def _count(increments, square, changes_at, speeds, pieces):  # type: ignore[no-untyped-def]
    """Counter 60 over one move: the rows of `pieces` used, where zero was reached, and the count then.

    Increment by increment: a move of 300 mm on three axes has a million of them.
    """
    counter, travelled, change, rows = square - increments, 0, 0, 0
    pieces[0] = 0
    while counter < 0:
        while change < len(changes_at) and travelled >= changes_at[change]:
            change += 1
        if square < speeds[change] and counter == -1:
            # the odd increment: half up, half down, and the speed is kept
            rows = _add(pieces, rows, 1, 1)
            rows = _add(pieces, rows, -1, 1)
            counter += 2
        elif square < speeds[change]:
            rows = _add(pieces, rows, 1, 2)
            counter, square = counter + 2, square + 1
        elif square > speeds[change]:
            rows = _add(pieces, rows, -1, 2)
            square -= 1
        else:
            rows = _add(pieces, rows, 0, 2)
            counter += 1
        travelled += 1
    if square > 0:
        rows = _add(pieces, rows, -1, 2 * square)
    return rows, travelled, counter


@njit(cache=True, inline="always")
def _add(pieces, rows, mode, halves):  # type: ignore[no-untyped-def]
    """Lengthen the last piece, or begin another; the rows now used."""
    if rows == 0 or pieces[rows - 1, 0] != mode:
        pieces[rows, 0], pieces[rows, 1] = mode, 0
        rows += 1
    pieces[rows - 1, 1] += halves
    return rows
