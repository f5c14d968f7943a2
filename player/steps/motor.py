"""Stepping motors: a step for each pulse, as long as the rate of the pulses does not change too quickly.

Signals: whole pulses of each interval in, signed by their line; steps out, at even parts of the interval.

A motor's torque can change its rate by `acceleration` steps/s², which over an interval T is

    most = acceleration · T²      steps more or less than in the interval before

What is asked beyond that is not done: of pulses that come too quickly the rest is lost, and where they stop
too quickly the load overruns. A lost step stays lost, as nothing tells the control.

    pulses  0 3 3 3 3 0        most = 1
    steps   0 1 2 3 3 2        lost 2 + 1, overrun 2

Source: patent ES 443122, pages 12 to 14 (25 600 steps/s²; the same at all speeds). Questions: the patent
reckons by whole intervals only, and so does this. A real motor that falls out of step may stall altogether;
here it runs on at the rate that its torque allows, which loses the least. A rotor swings behind its field by
less than a step and comes back by itself; what does not come back is whole steps, and so they are the
following error of such a drive, at every speed the same. What may be wrong with a motor, `MotorCondition`, is
in no patent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit

ACCELERATION_STEPS_S2 = 25600.0  # one step more in each 1/160 s, page 13


@dataclass(frozen=True, slots=True)
class Motor:
    """Limits of a motor with its load."""

    acceleration_steps_s2: float = ACCELERATION_STEPS_S2

    def most(self, interval_s: float) -> int:
        """Largest difference in steps between two intervals in succession."""
        return int(self.acceleration_steps_s2 * interval_s**2 + 1e-6)


@dataclass(frozen=True, slots=True)
class MotorCondition:
    """What is wrong with a motor: share of torque left, share taken by friction, stray steps/s."""

    torque_share: float = 1.0
    friction_share: float = 0.0
    stray_hz: float = 0.0
    stuck: bool = False

    def row(self, most: int, interval_s: float) -> tuple[float, float, float, float]:
        """The condition for the kernel: changes of rate up and down, stray steps per interval, if free."""
        rise, fall = (
            self.torque_share - self.friction_share,
            self.torque_share + self.friction_share,
        )
        return most * max(rise, 0.0), most * fall, self.stray_hz * interval_s, not self.stuck


SOUND = MotorCondition()


class Motors:
    """The motors of a machine; state is carried over, so a motor may break between two blocks."""

    def __init__(self, axes: int, interval_s: float, motor: Motor | None = None) -> None:
        self._most, self._interval_s = (motor or Motor()).most(interval_s), interval_s
        # steps of the last interval, all steps (with what broken ones leave), pulses
        self._state = np.zeros((axes, 3))
        self.conditions: Sequence[MotorCondition] = [SOUND] * axes

    def run(
        self, pulses: NDArray[np.int64], ticks: NDArray[np.int64], samples: int
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Pulses and steps so far (samples · k, axes) for pulses (k, axes), at even parts of each interval.

        `ticks` is the table of the pulses that have come by each tick.
        """
        if pulses.ndim != 2 or pulses.shape[1] != len(self._state):
            raise ValueError(
                f"pulses of shape {pulses.shape} do not fit; they must be (k, {len(self._state)})"
            )
        told = np.empty((len(pulses) * samples, len(self._state)), np.int64)
        made = np.empty_like(told)
        wrong = np.array(
            [condition.row(self._most, self._interval_s) for condition in self.conditions],
            np.float64,
        )
        _run(pulses, ticks, samples, wrong, self._state, told, made)
        return told, made

    @property
    def lost(self) -> NDArray[np.int64]:
        """Pulses so far that made no step; negative where the load overran."""
        return np.rint(self._state[:, 2] - self._state[:, 1]).astype(np.int64)


@njit(cache=True)
def _run(pulses, ticks, samples, conditions, state, told, made):  # type: ignore[no-untyped-def]
    """Make the steps of all intervals."""
    part = (ticks.shape[1] - 1) // samples
    for k in range(len(pulses)):
        for axis in range(len(state)):
            rise, fall, stray, free = conditions[axis]
            before, steps, asked_all = state[axis]
            asked = float(pulses[k, axis])
            most = rise if abs(asked) > abs(before) else fall
            rate = min(max(asked, before - most), before + most) * free + stray
            whole, whole_all = round(steps + rate) - round(steps), round(steps)
            _spread(asked, asked_all, ticks, part, told[k * samples : (k + 1) * samples, axis])
            _spread(whole, whole_all, ticks, part, made[k * samples : (k + 1) * samples, axis])
            state[axis, 0], state[axis, 1], state[axis, 2] = (
                rate,
                steps + rate,
                asked_all + asked,
            )


@njit(cache=True, inline="always")
def _spread(change, before, ticks, part, out):  # type: ignore[no-untyped-def]
    """The count at the end of each part of an interval in which it changes by `change`."""
    size, sign = min(int(abs(change)), len(ticks) - 1), 1 if change > 0 else -1
    for i in range(len(out)):
        out[i] = int(before) + sign * ticks[size, (i + 1) * part]
