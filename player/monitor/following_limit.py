"""Following limit: how far a servo may be behind its demand at a speed of the demand.

Signals in: speed of the demand, mm/s. Signals out: the limit, mm.

    limit │        ╱ beyond_s                 table 32, 34: empirical points, or a slope alone
          │    ___╱                           tolerance 38: added to it
          │___╱
          └────────► speed

The table is a linear function (a servo of type 1 is behind by its lag times its speed) or empirical points,
straight in between. One limit for all speeds must be as wide as full speed wants it, and is blind at low
speed.

Source: patent ES 414458, figures 1 and 2 (numbers above). Questions: the patent gives no figures. Chosen: lag
0.06 s (1 m/min per mm) and tolerance 0.1 mm. Beyond its last point an empirical table holds its value.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit

LAG_S, TOLERANCE_MM = 0.06, 0.1  # of the position servos


@dataclass(frozen=True, slots=True)
class FollowingLimit:
    """The limit: points (mm/s, mm) from 0 mm/s on, slope beyond them in s, tolerance, settling, hold."""

    points: tuple[tuple[float, float], ...] = ((0.0, 0.0),)
    beyond_s: float = LAG_S
    tolerance_mm: float = TOLERANCE_MM
    settle_s: float = 0.0
    hold_s: float = 0.0

    def __post_init__(self) -> None:
        speeds, errors_mm = np.array(self.points, np.float64).reshape(-1, 2).T
        if (
            not len(speeds)
            or speeds[0] != 0
            or not (np.diff(speeds) > 0).all()
            or not np.isfinite(speeds).all()
        ):
            raise ValueError(
                f"speeds {speeds.tolist()} are no table; give finite ones that start at 0 mm/s and grow"
            )
        settings = [*errors_mm, self.beyond_s, self.tolerance_mm, self.settle_s, self.hold_s]
        if not all(0 <= value < math.inf for value in settings):
            shown = ", ".join(f"{value:g}" for value in settings)
            raise ValueError(
                f"a limit has the settings {shown}; errors, slope, tolerance and times must be 0 or more"
            )

    @classmethod
    def linear(
        cls, lag_s: float = LAG_S, tolerance_mm: float = TOLERANCE_MM, settle_s: float = 0.0
    ) -> FollowingLimit:
        """The limit of a servo with a constant lag."""
        return cls(((0.0, 0.0),), lag_s, tolerance_mm, settle_s)

    @classmethod
    def table(
        cls,
        points: Sequence[tuple[float, float]],
        tolerance_mm: float,
        settle_s: float = 0.0,
        hold_s: float = 0.0,
    ) -> FollowingLimit:
        """The limit of empirical points (mm/s, mm); the last one holds for all speeds beyond."""
        return cls(
            tuple((float(speed), float(error)) for speed, error in points),
            0.0,
            tolerance_mm,
            settle_s,
            hold_s,
        )

    def limit_mm(self, speed_mm_s: float) -> float:
        """The limit at a speed of the demand, mm."""
        rows, speed = self.rows, abs(speed_mm_s)
        return float(allowed_mm(speed, part_at(speed, rows, 0), rows, self.tolerance_mm))

    @property
    def rows(self) -> Array:
        """The table as the kernel takes it: (n, 3), mm/s, mm, and the slope behind that in s."""
        speeds, errors_mm = np.array(self.points, np.float64).reshape(-1, 2).T
        return np.column_stack(
            [speeds, errors_mm, np.r_[np.diff(errors_mm) / np.diff(speeds), self.beyond_s]]
        )


def learn_table(
    demand_mm: Array, actual_mm: Array, rate_hz: float, speeds_mm_s: Sequence[float]
) -> tuple[tuple[float, float], ...]:
    """Empirical points from a run of a sound servo: the largest error up to the next speed, mm."""
    speed = np.abs(np.diff(demand_mm, axis=0, prepend=demand_mm[:1])) * rate_hz
    error = np.abs(demand_mm - actual_mm)
    upto = [*speeds_mm_s[1:], np.inf]
    return tuple(
        (float(v), float(error[speed <= u].max(initial=0.0)))
        for v, u in zip(speeds_mm_s, upto, strict=True)
    )


@njit(cache=True, inline="always", _nrt=False)
def part_at(speed_mm_s, table, part):  # type: ignore[no-untyped-def]
    """The part of the table for a speed, looked for from another part on: speeds seldom leave theirs."""
    while part > 0 and not speed_mm_s >= table[part, 0]:
        part -= 1
    while part < len(table) - 1 and speed_mm_s >= table[part + 1, 0]:
        part += 1
    return part


@njit(cache=True, inline="always", _nrt=False)
def allowed_mm(speed_mm_s, part, table, tolerance_mm):  # type: ignore[no-untyped-def]
    """The limit at a speed of the demand, which is in a part of the table, mm."""
    return table[part, 1] + (speed_mm_s - table[part, 0]) * table[part, 2] + tolerance_mm
