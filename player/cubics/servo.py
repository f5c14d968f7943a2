"""The servo of an axis: difference, register, decoder with its speed modulus, and motor.

Signals: predicted places in counts and the scales in; the place of the table in mm out, once for each point.

    difference 29 ─► register 34 ─► decoder 35 ─► amplifier 36, motor 9
     counts, limited to the register's digits      × modulus, mm/s

    speed demand = modulus · (predicted place of the next point - present place)

Source: patent US 3062995, figures 1 and 3, claims 6 to 8. Questions: register 34 has 12 digits and a sign:
4095 counts, 2 mm at 2000 counts per mm; beyond, the drive is lost, and the patent's register would have been
full. The limit's tolerance is a tenth of the lag at 10 mm/s, by choice.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from morfax.motion.compiled import njit
from morfax.motion.drive import Drive, conditioned_step
from morfax.player.cubics.scales import Scales, measured
from morfax.player.monitor.following_limit import FollowingLimit

REGISTER_DIGITS = 12  # of register 34, sign apart
_TOLERANCE_MM = 0.005  # of following: a tenth of the lag at 10 mm/s


@dataclass(frozen=True, slots=True)
class Servo:
    """Settings: modulus in mm/s per mm (None: the program's), lowest digits dropped, scales, motor."""

    modulus_per_s: float | None = None
    dropped_digits: int = 0
    register_digits: int = REGISTER_DIGITS
    scales: Scales = field(default_factory=Scales)
    drive: Drive = field(default_factory=Drive)
    seed: int = 0

    def limit(
        self, modulus_per_s: float, counts_per_mm: float, point_rate_hz: float
    ) -> FollowingLimit:
        """The allowed following error.

        It is the lag of modulus, motor and one point, as the next one is predicted, and what scales and
        dropped digits add.
        """
        lag_s, settle_s = (
            1 / modulus_per_s + self.drive.lag_s + 1 / point_rate_hz,
            1 / modulus_per_s,
        )
        added = 2**self.dropped_digits + 2 * self.scales.fine_noise_counts
        return FollowingLimit.linear(lag_s, _TOLERANCE_MM + added / counts_per_mm, settle_s)


@njit(cache=True)
def run_servos(predicted, noise, scales, register, drive, conditions, state, seen, moved_mm):  # type: ignore[no-untyped-def]
    """Run the servos of all axes through a block; the rows done before a difference was too large."""
    counts_per_mm, largest, dropped = register
    modulus, gain, change, dt_s = drive
    for row in range(len(predicted)):
        for axis in range(len(state)):
            jitter = noise[min(row, len(noise) - 1), axis]
            present = measured(
                state[axis, 0] * counts_per_mm + 0.5, jitter[0], jitter[1], scales
            )
            difference = predicted[row, axis] - present  # adder 29
            if abs(difference) >= largest:  # register 34 is full
                return row
            seen[row, axis] = present
            kept = np.trunc(difference / dropped) * dropped
            demand = modulus * kept / counts_per_mm  # decoder 35 at its reference voltage
            speed = conditioned_step(state[axis, 1], demand, gain, change, conditions[axis])
            state[axis, 0] += (state[axis, 1] + speed) / 2 * dt_s
            state[axis, 1] = speed
            moved_mm[row, axis] = state[axis, 0]
    return len(predicted)
