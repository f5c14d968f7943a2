"""Stepping motors: a step for each pulse, as long as the rate of the pulses does not change too quickly.

Signals: whole pulses of each interval in, signed by their line; steps out, at even parts of the interval.

A motor's torque can change its rate by `acceleration` steps/s², which over an interval T is

    most = acceleration · T²      steps more or less than in the interval before

What is asked beyond that is not done: of pulses that come too quickly the rest is lost, and where they stop too quickly
the load overruns. A lost step stays lost, as nothing tells the control.

    pulses  0 3 3 3 3 0        most = 1
    steps   0 1 2 3 3 2        lost 2 + 1, overrun 2

Source: patent ES 443122, pages 12 to 14 (25 600 steps/s²; the same at all speeds).
Questions: the patent reckons by whole intervals only, and so does this. A real motor that falls out of step may stall
altogether; here it runs on at the rate that its torque allows, which loses the least.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

ACCELERATION_STEPS_S2 = 25600.0  # one step more in each 1/160 s, page 13


@dataclass(frozen=True, slots=True)
class Motor:
    """What a motor with its load can do."""

    acceleration_steps_s2: float = ACCELERATION_STEPS_S2

    def most(self, interval_s: float) -> int:
        """Steps by which two intervals in succession may differ."""
        return int(self.acceleration_steps_s2 * interval_s**2 + 1e-6)


class Motors:
    """The motors of a machine; state is carried from block to block."""

    def __init__(self, axes: int, interval_s: float, motor: Motor | None = None) -> None:
        self._most = (motor or Motor()).most(interval_s)
        self._state = np.zeros((axes, 3), np.int64)  # steps of the last interval, all steps, all pulses
        self.largest_lost = np.zeros(axes)

    def run(self, pulses: NDArray[np.int64], ticks: NDArray[np.int64], samples: int) -> NDArray[np.int64]:
        """Steps (samples · k, axes) for pulses (k, axes), at the end of each of so many even parts of an interval.

        `ticks` is the table of the pulses that have come by each tick.
        """
        if pulses.ndim != 2 or pulses.shape[1] != len(self._state):
            raise ValueError(f"pulses of shape {pulses.shape} do not fit; they must be (k, {len(self._state)})")
        out = np.empty((len(pulses) * samples, len(self._state)), np.int64)
        _run(pulses, ticks, samples, self._most, self._state, self.largest_lost, out)
        return out

    @property
    def steps(self) -> NDArray[np.int64]:
        """Steps made so far, plus or minus."""
        return self._state[:, 1].copy()

    @property
    def lost(self) -> NDArray[np.int64]:
        """Pulses so far that no step came of; minus where the load overran."""
        return self._state[:, 2] - self._state[:, 1]


@njit(cache=True)
def _run(pulses, ticks, samples, most, state, largest_lost, out):  # type: ignore[no-untyped-def]
    """Make the steps of all intervals."""
    part = (ticks.shape[1] - 1) // samples
    for k in range(len(pulses)):
        for axis in range(len(state)):
            asked = pulses[k, axis]
            before = state[axis, 0]
            made = min(max(asked, before - most), before + most)
            size, sign = abs(made), 1 if made > 0 else -1
            for i in range(samples):
                out[k * samples + i, axis] = state[axis, 1] + sign * ticks[size, (i + 1) * part]
            state[axis, 0] = made
            state[axis, 1] += made
            state[axis, 2] += asked
            largest_lost[axis] = max(largest_lost[axis], abs(state[axis, 2] - state[axis, 1]))
