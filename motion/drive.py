"""A velocity servo: amplifier, motor and tachogenerator of one axis, shared by the line follower and the
machine.

Signals: speed demand in mm/s in, speed of the screw in mm/s out, one value per period of `dt_s`.

The tacho closes the loop round the motor, so that one lag is left; the amplifier's current limits the
acceleration:

    dv/dt = clip((demand - v) / lag, -acceleration, +acceleration)

stepped exactly for the lag: v += clip((demand - v)·(1 - exp(-dt/lag)), ±acceleration·dt).

What may be wrong with a drive is its `Condition`: only a share of the demand is left, friction takes a part
of that, a runaway adds to it, and a stuck axis does not turn.

Source: patent ES 361967, figure 1 (amplifiers DCX and DCY, tachos TX and TY, motors 17 and 12) and figure 5
(amplifier 161, motor 163). Questions: the patent gives no figures. Chosen: a lag of 1 ms and 5 m/s², a modern
servo; the historic set takes 30 ms. Conditions are in no patent; they are what a monitor is for.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit


@dataclass(frozen=True, slots=True)
class Drive:
    """Settings of a velocity servo; the top speed is that of a machine's motors, and none of a follower's."""

    lag_s: float = 0.001
    acceleration_mm_s2: float = 5000.0
    top_speed_mm_s: float = math.inf

    def gain(self, dt_s: float) -> float:
        """Share of the speed error made good in one period, 0..1."""
        return 1.0 - math.exp(-dt_s / self.lag_s) if self.lag_s > 0 else 1.0


@dataclass(frozen=True, slots=True)
class Condition:
    """What is wrong with a drive: the share of its gain left, its friction, the speed of a runaway."""

    gain_share: float = 1.0
    friction_mm_s: float = 0.0
    runaway_mm_s: float = 0.0
    stuck: bool = False


SOUND = Condition()


def as_rows(conditions: Sequence[Condition]) -> NDArray[np.float64]:
    """Conditions as `conditioned_step` takes them, a row for each axis."""
    return np.array(
        [[c.gain_share, c.friction_mm_s, c.runaway_mm_s, not c.stuck] for c in conditions],
        np.float64,
    )


@njit(cache=True, inline="always")
def limited(value, least, most):  # type: ignore[no-untyped-def]
    """A value within limits. It seldom is not, and a branch that is not taken keeps no later step waiting."""
    if least <= value <= most:
        return value
    return min(max(value, least), most)


@njit(cache=True, inline="always")
def drive_step(speed_mm_s, demand_mm_s, gain, largest_change_mm_s):  # type: ignore[no-untyped-def]
    """Speed of the screw after one period, mm/s."""
    change = (demand_mm_s - speed_mm_s) * gain
    return speed_mm_s + limited(change, -largest_change_mm_s, largest_change_mm_s)


@njit(cache=True, inline="always")
def conditioned_step(speed_mm_s, demand_mm_s, gain, largest_change_mm_s, condition):  # type: ignore[no-untyped-def]
    """Speed of the screw after one period, mm/s, with what is wrong with the drive."""
    left = demand_mm_s * condition[0]
    if condition[1] != 0.0:
        left -= min(max(left, -condition[1]), condition[1])
    wanted = left + condition[2]
    return drive_step(speed_mm_s, wanted, gain, largest_change_mm_s) * condition[3]
