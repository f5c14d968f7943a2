"""Position servos: demand, transducer, comparator, error and servo of each axis, stepped by a program.

Signals in: places demanded in mm. Signals out: positions of the load in mm at the motion rate, by its
transducers, and where the loop has told it to be.

    demand 20 ──► subtractor 22 ──► error ──► amplifier 28 ──► servo unit 30 ──► load ─────┬──► position
                       ▲                                  up, constant, down               │
                       └──── transducer 12, whole increments ◄─────────────────────────────┤
                             counter 60 ◄── one signal for each increment of any axis ◄────┘

Two ways to be told. `follow` takes a place for each period: the speed is gain · error, a servo of type 1.
`go` takes the end of a move, and the modes of the servo unit make its speed:

    counter = -(increments of the move, of all axes together)
    up        each increment that a transducer gives counts 2       speed² = 2 a d e, e the increments risen
    constant  each counts 1                                         speed = the feed
    down      from counter >= 0 on, each takes 1 from e             speed² = 2 a d e
    the speed points from the transducers' place to the end, and is at most gain · error

with d the path of an increment. What is counted is what the load has moved, never what it was told. At the
change to down the increments left are exactly e less what the counter is past zero. On an arc the speed
points along the tangent, and back to the radius; the last increments are run straight to the end.

Source: patent ES 414458, figures 1, 3 and 4 (counter 60, gates 72 and 74, doubler 76, line 78), claims 1 to
4; the computer that steps it under its micro-program is these kernels. Questions: the patent gives no
figures, and no law for the speed in its modes. Chosen: gain 16.667 1/s (1 m/min per mm) for a servo that
follows, 300 1/s for one that goes, increments of 1 um, the drive of `motion.drive`, whose `Condition` says
what may be wrong with it. A counter that several increments of one period take past zero has them taken from
e. An increment too many (an axis that trembles at an end of an arc) lets the load creep the last way, at the
speed of a quarter of an increment.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.drive import SOUND, Drive, as_rows, conditioned_step
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.usual import ACCELERATION_MM_S2, INCREMENT_MM

POSITION, MOVING, TOLD = 0, 1, 2  # columns of the state of an axis: mm, mm/s, mm
COUNTER, RISEN, MODE = 0, 1, 2  # of the counter's registers, shared by all axes
UP, CONSTANT, DOWN, ARRIVED = 1, 0, -1, 2
AT_ONCE = round(MOTION_RATE_HZ)  # rows of a move: a second
CREEP_INCREMENTS = 0.25  # of which the least speed of a move is
# before its end an arc is run straight: 0.05 mm, 0.06 um beside a radius of 5 mm
STRAIGHT_INCREMENTS = 50

Counts = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class PositionServo:
    """Settings of a position servo."""

    gain_per_s: float = 1000 / 60
    increment_mm: float = INCREMENT_MM
    acceleration_mm_s2: float = ACCELERATION_MM_S2  # of the ramps up and down
    drive: Drive = field(default_factory=Drive)

    @property
    def lag_s(self) -> float:
        """Following error over speed of a servo that follows, s."""
        return 1 / self.gain_per_s


class Interpolated(NamedTuple):
    """How a move goes to its end: feed, increments of all axes, and an arc's centre, radius and sense."""

    feed_mm_s: float
    increments: int
    increment_path_mm: float  # d: length over increments
    centre_mm: tuple[float, float] = (0.0, 0.0)
    radius_mm: float = 0.0
    sense: int = 0  # +1 counter-clockwise, -1 clockwise, 0 straight


class PositionServos:
    """The servos of a machine; state is carried over, so a drive may break between two blocks."""

    def __init__(
        self,
        start_mm: Array,
        rate_hz: float = MOTION_RATE_HZ,
        settings: PositionServo | None = None,
    ) -> None:
        self.settings, self.rate_hz = settings or PositionServo(), rate_hz
        self._state = np.zeros((len(start_mm), 3))
        self._state[:, POSITION] = self._state[:, TOLD] = start_mm
        self._registers = np.array([0, 0, ARRIVED])
        self.conditions = [SOUND] * len(start_mm)

    @property
    def seen(self) -> Counts:
        """What the transducers give: whole increments of each axis."""
        return np.rint(self._state[:, POSITION] / self.settings.increment_mm).astype(np.int64)

    @property
    def counter(self) -> int:
        """Counter 60: increments, below zero until the ramp down."""
        return int(self._registers[COUNTER])

    @property
    def mode(self) -> int:
        """Mode of the servo units: UP, CONSTANT, DOWN, or ARRIVED."""
        return int(self._registers[MODE])

    def follow(self, demand_mm: Array) -> Array:
        """Positions (n, axes) of the load in mm, as the transducers have them when each demand comes."""
        demand = np.ascontiguousarray(demand_mm, np.float64)
        if demand.ndim != 2 or demand.shape[1] != len(self._state):
            raise ValueError(
                f"demands of shape {demand.shape} are not for this machine; give (n, {len(self._state)})"
            )
        actual = np.empty_like(demand)
        _follow(demand, self._common(), as_rows(self.conditions), self._state, actual)
        return actual

    def go(self, end_mm: Array, way: Interpolated) -> Iterator[tuple[Array, Array]]:
        """Move to a place: what the axes were told and where they were (n, axes), mm, block by block.

        The counter is set to the increments of the move below zero; the move ends when the transducers give
        its end on all axes.
        """
        end = np.rint(np.asarray(end_mm) / self.settings.increment_mm).astype(np.int64)
        self._registers[:] = -way.increments, 0, UP
        seen = self.seen
        shape = AT_ONCE, len(self._state)
        rows = AT_ONCE
        while rows == AT_ONCE:
            told, actual = np.empty(shape), np.empty(shape)
            rows = _go(
                end,
                way,
                self.settings.acceleration_mm_s2,
                self._common(),
                as_rows(self.conditions),
                self._state,
                self._registers,
                seen,
                told,
                actual,
            )
            yield told[:rows], actual[:rows]

    def _common(self) -> Array:
        """What both kernels take of the settings."""
        s, dt_s = self.settings, 1 / self.rate_hz
        change = s.drive.acceleration_mm_s2 * dt_s
        return np.array([s.gain_per_s, s.drive.gain(dt_s), change, s.increment_mm, dt_s])


@njit(cache=True, nogil=True)
def _follow(demand_mm, common, conditions, state, actual_mm):  # type: ignore[no-untyped-def]
    """Step all axes through a block of demands."""
    gain_per_s, share, largest_change, increment_mm, dt_s = common
    for axis in range(len(state)):
        position, speed, _ = state[axis]
        for row in range(len(demand_mm)):
            seen = round(position / increment_mm) * increment_mm
            actual_mm[row, axis] = seen
            wanted = gain_per_s * (demand_mm[row, axis] - seen)
            speed = conditioned_step(speed, wanted, share, largest_change, conditions[axis])
            position += speed * dt_s
        state[axis, POSITION], state[axis, MOVING] = position, speed
        if len(demand_mm):
            state[axis, TOLD] = demand_mm[-1, axis]


@njit(cache=True, nogil=True)
def _go(end, way, acceleration, common, conditions, state, registers, seen, told_mm, actual_mm):  # type: ignore[no-untyped-def]
    """Step a move until the load is at its end or the block is full; the rows used."""
    gain_per_s, share, largest_change, increment_mm, dt_s = common
    counter, risen, mode = registers
    axes = len(state)
    wanted = np.empty(axes)
    for row in range(len(told_mm)):
        # 1. the transducers, and the signals that they give for each increment
        moved, left = _look(end, state, increment_mm, seen)
        # 2. the counter, and the mode that it sets
        counter, risen, mode = _count(counter, risen, mode, moved)
        is_straight = way.sense == 0 or (mode == DOWN and risen <= STRAIGHT_INCREMENTS)
        if mode == DOWN and is_straight and left == 0:
            registers[COUNTER], registers[RISEN], registers[MODE] = counter, risen, ARRIVED
            return row
        # 3. the speed of the mode, and which way it points
        speed, mode = _speed(way, acceleration, risen, mode)
        _point(end, seen, way, is_straight, speed, gain_per_s, increment_mm, wanted)
        # 4. the servo units
        for axis in range(axes):
            told_mm[row, axis] = state[axis, TOLD]
            actual_mm[row, axis] = seen[axis] * increment_mm
            state[axis, TOLD] += wanted[axis] * dt_s
            state[axis, MOVING] = conditioned_step(
                state[axis, MOVING], wanted[axis], share, largest_change, conditions[axis]
            )
            state[axis, POSITION] += state[axis, MOVING] * dt_s
    registers[COUNTER], registers[RISEN], registers[MODE] = counter, risen, mode
    return len(told_mm)


@njit(cache=True, inline="always")
def _look(end, state, increment_mm, seen):  # type: ignore[no-untyped-def]
    """Have the transducers look: increments that all axes moved, and those that are left to the end."""
    moved, left = 0, 0
    for axis in range(len(end)):
        now = round(state[axis, POSITION] / increment_mm)
        moved += abs(now - seen[axis])
        seen[axis] = now
        left += abs(end[axis] - now)
    return moved, left


@njit(cache=True, inline="always")
def _count(counter, risen, mode, moved):  # type: ignore[no-untyped-def]
    """Count increments by the rule of the mode; the counter, how far the speed has risen, mode."""
    if mode == UP:
        counter, risen = counter + 2 * moved, risen + moved
    elif mode == CONSTANT:
        counter += moved
    else:
        risen -= moved
    if mode != DOWN and counter >= 0:
        mode, risen = DOWN, risen - counter
    return counter, risen, mode


@njit(cache=True, inline="always")
def _speed(way, acceleration, risen, mode):  # type: ignore[no-untyped-def]
    """The speed that an even acceleration reaches over the increments risen, mm/s, and the mode: at the feed
    it is constant.
    """
    least = CREEP_INCREMENTS if mode == DOWN else 1.0
    speed = np.sqrt(2 * acceleration * way.increment_path_mm * max(float(risen), least))
    if mode == UP and speed >= way.feed_mm_s:
        mode = CONSTANT
    return way.feed_mm_s if mode == CONSTANT else min(speed, way.feed_mm_s), mode


@njit(cache=True, inline="always")
def _point(end, seen, way, is_straight, speed, gain_per_s, increment_mm, wanted):  # type: ignore[no-untyped-def]
    """The speed demanded of each axis: along the error, or along an arc's tangent and back to its radius."""
    if is_straight:
        error_mm = 0.0
        for axis in range(len(end)):
            wanted[axis] = (end[axis] - seen[axis]) * increment_mm
            error_mm += wanted[axis] ** 2
        error_mm = np.sqrt(error_mm)
        speed = min(speed, gain_per_s * error_mm)
        for axis in range(len(end)):
            wanted[axis] *= speed / error_mm if error_mm > 0 else 0.0
        return
    out_x = seen[0] * increment_mm - way.centre_mm[0]
    out_y = seen[1] * increment_mm - way.centre_mm[1]
    radius_mm = np.sqrt(out_x**2 + out_y**2)
    back = gain_per_s * (way.radius_mm - radius_mm)
    wanted[:] = 0
    wanted[0] = (-way.sense * out_y * speed + out_x * back) / radius_mm
    wanted[1] = (way.sense * out_x * speed + out_y * back) / radius_mm
