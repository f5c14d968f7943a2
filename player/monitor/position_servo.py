"""Position servo: demand, transducer, subtractor, amplifier, servo unit and load, stepped at regular
intervals.

Signals in: demanded positions in mm at the motion rate. Signals out: positions of the load in mm.

    demand 20 ──► subtractor 22 ──► amplifier 28 ──► servo unit 30 ──► load 10 ──┬──► position
                       ▲                                                         │
                       └────────────── transducer 12, whole increments ◄─────────┘

    speed demanded = gain · (demand - round(position / increment) · increment)

A servo of type 1: at constant speed it is behind by speed / gain, the following error that `monitor` watches.

Source: patent ES 414458, figure 1 and claim 1; the computer that steps it under its micro-program is this
kernel. Questions: the patent gives no figures. Chosen: gain 16.667 1/s (1 m/min per mm), increments of 1 um,
the drive of `motion.drive`, whose `Condition` says what may be wrong with it.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numba import njit

from morfax.motion.arrays import Array
from morfax.motion.drive import SOUND, Drive, as_rows, conditioned_step
from morfax.motion.motion import MOTION_RATE_HZ

POSITION, MOVING = range(2)  # columns of the state of an axis: mm and mm/s


@dataclass(frozen=True, slots=True)
class PositionServo:
    """Settings of a position servo."""

    gain_per_s: float = 1000 / 60
    increment_mm: float = 0.001
    drive: Drive = field(default_factory=Drive)

    @property
    def lag_s(self) -> float:
        """Following error over speed, s."""
        return 1 / self.gain_per_s


class PositionServos:
    """The servos of a machine; state is carried over, so a drive may break between two blocks."""

    def __init__(
        self,
        start_mm: Array,
        rate_hz: float = MOTION_RATE_HZ,
        settings: PositionServo | None = None,
    ) -> None:
        self.settings, self.rate_hz = settings or PositionServo(), rate_hz
        self._state = np.zeros((len(start_mm), 2))
        self._state[:, POSITION] = start_mm
        self.conditions = [SOUND] * len(start_mm)

    def follow(self, demand_mm: Array) -> Array:
        """Positions (n, axes) of the load in mm, as the transducers have them when each demand comes."""
        demand = np.ascontiguousarray(demand_mm, np.float64)
        if demand.ndim != 2 or demand.shape[1] != len(self._state):
            raise ValueError(
                f"demands of shape {demand.shape} are not for this machine; give (n, {len(self._state)})"
            )
        drive, dt_s = self.settings.drive, 1 / self.rate_hz
        common = np.array(
            [
                drive.gain(dt_s),
                drive.acceleration_mm_s2 * dt_s,
                self.settings.increment_mm,
                dt_s,
            ],
            np.float64,
        )
        actual = np.empty_like(demand)
        _follow(
            demand,
            self.settings.gain_per_s,
            common,
            as_rows(self.conditions),
            self._state,
            actual,
        )
        return actual


@njit(cache=True, nogil=True)
def _follow(demand_mm, gain_per_s, common, conditions, state, actual_mm):  # type: ignore[no-untyped-def]
    """Step all axes through a block."""
    share, largest_change, increment_mm, dt_s = common
    for axis in range(len(state)):
        position, speed = state[axis]
        for row in range(len(demand_mm)):
            seen = round(position / increment_mm) * increment_mm
            actual_mm[row, axis] = seen
            wanted = gain_per_s * (demand_mm[row, axis] - seen)
            speed = conditioned_step(speed, wanted, share, largest_change, conditions[axis])
            position += speed * dt_s
        state[axis, POSITION], state[axis, MOVING] = position, speed
