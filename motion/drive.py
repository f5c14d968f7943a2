"""A velocity servo: amplifier, motor and tachogenerator of one axis, shared by the line follower and the machine.

Signals: speed demand in mm/s in, speed of the screw in mm/s out, one value per period of `dt_s`.

The tacho closes the loop round the motor, so that what is left is one lag, and the amplifier's current limits the acceleration:

    dv/dt = clip((demand - v) / lag, -acceleration, +acceleration)

stepped exactly for the lag: v += clip((demand - v)·(1 - exp(-dt/lag)), ±acceleration·dt).

Source: patent ES 361967, figure 1 (amplifiers DCX and DCY, tachos TX and TY, motors 17 and 12) and figure 5 (amplifier 161, motor 163).
Questions: the patent gives no figures. Chosen: a lag of 1 ms and 5 m/s², a modern servo; the historic set takes 30 ms.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from numba import njit


@dataclass(frozen=True, slots=True)
class Drive:
    """Settings of a velocity servo."""

    lag_s: float = 0.001
    acceleration_mm_s2: float = 5000.0

    def gain(self, dt_s: float) -> float:
        """Share of the speed error made good in one period, 0..1."""
        return 1.0 - math.exp(-dt_s / self.lag_s) if self.lag_s > 0 else 1.0


@njit(cache=True, inline="always")
def drive_step(speed_mm_s, demand_mm_s, gain, largest_change_mm_s):  # type: ignore[no-untyped-def]
    """Speed of the screw after one period, mm/s."""
    change = (demand_mm_s - speed_mm_s) * gain
    return speed_mm_s + min(max(change, -largest_change_mm_s), largest_change_mm_s)
