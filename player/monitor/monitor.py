"""Following-error monitor: is a servo as far behind its demand as its speed explains, or further?

Signals in: demand and actual position of each axis in mm, at any one rate. Signals out: the limit in mm, a
fault with its state, and whether to stop.

    demand ──► rate of change 35 ──► table 32, 34 ──► + tolerance 38 ──► limit ──┐
    demand − actual ─────────────────────────────────────────────────────► comparator 40 ──► warning, stop

    fault  ⇔  |demand − actual| > table(|d demand / dt|) + tolerance

The table is a linear function (a servo of type 1 is behind by its lag times its speed) or empirical points,
straight in between. One limit for all speeds must be as wide as full speed wants it, and is blind at low
speed.

Source: patent ES 414458, figures 1 and 2 (numbers above). Questions: the patent gives no figures. Chosen: lag
0.06 s (1 m/min per mm) and tolerance 0.1 mm. Beyond its last point an empirical table holds its value. When
the demand stops a servo is still behind for a while: `settle_s` gives the rate of change that same lag, with
which a linear table is exactly the error of a type-1 servo; 0 is the patent's rule. It also smooths a demand
that comes in pulses. A servo of type 2 is behind after a change of speed and not at one: `hold_s` lets a rate
that was count for a while. A warning is given once, and again after the error was inside the limit.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.faults import FollowingFault
from morfax.player.monitor.chart import Chart

DEMAND, SPEED, COUNTED, FAULTY, LARGEST, SHARE = range(6)  # columns of the state of an axis
NEARLY = 1 - 1e-9  # of the largest share: beyond it the exact one is made; rounding is 1e-15


@dataclass(frozen=True, slots=True)
class FollowingLimit:
    """The limit: points (mm/s, mm) from 0 mm/s on, slope beyond them in s, tolerance, settling, hold."""

    points: tuple[tuple[float, float], ...] = ((0.0, 0.0),)
    beyond_s: float = 0.06
    tolerance_mm: float = 0.1
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
        cls, lag_s: float = 0.06, tolerance_mm: float = 0.1, settle_s: float = 0.0
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
        return float(allowed_mm(speed_mm_s, self.rows, self.tolerance_mm))

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


class Monitor:
    """Watches the axes of a machine; state is carried from block to block.

    `warnings` are the faults so far. With `stop`, the rows after the first one are not sound. `rows_seen` may
    be set where a run begins later than at 0 s. A `chart` is a pen on each axis.
    """

    def __init__(
        self,
        axes: Sequence[str],
        rate_hz: float,
        limit: FollowingLimit | None = None,
        *,
        stop: bool = True,
        chart: Chart | None = None,
    ) -> None:
        self.axes, self.rate_hz, self.limit, self.stop = (
            tuple(axes),
            rate_hz,
            limit or FollowingLimit(),
            stop,
        )
        self.warnings: list[FollowingFault] = []
        self.rows_seen = 0
        self._chart = chart
        if chart is not None:
            chart.begin(self.axes)
        share = 1 - self._fade(self.limit.settle_s)
        fade = self._fade(self.limit.hold_s)
        self._settings = np.array([rate_hz, share, fade, self.limit.tolerance_mm])
        self._table = self.limit.rows
        self._state = np.zeros((len(self.axes), 6))
        self._state[:, DEMAND] = np.nan

    def _fade(self, constant_s: float) -> float:
        """The share left after a row of a quantity that fades with a time constant."""
        return math.exp(-1 / (self.rate_hz * constant_s)) if constant_s > 0 else 0.0

    @property
    def largest_error_mm(self) -> Array:
        """The largest following error of each axis so far, mm."""
        return self._state[:, LARGEST].copy()

    @property
    def largest_share(self) -> Array:
        """The largest share of its limit that the error of each axis reached; above 1 is a fault."""
        return self._state[:, SHARE].copy()

    def watch(self, demand_mm: Array, actual_mm: Array) -> int:
        """Watch a block (n, axes); the number of rows before a stop."""
        demand, actual = (
            np.ascontiguousarray(demand_mm, np.float64),
            np.ascontiguousarray(actual_mm, np.float64),
        )
        if (
            demand.shape != actual.shape
            or demand.ndim != 2
            or demand.shape[1] != len(self.axes)
        ):
            raise ValueError(
                f"demand {demand.shape} and actual {actual.shape}: both must be (n, {len(self.axes)})"
            )
        limits = np.zeros((0 if self._chart is None else len(demand), len(self.axes)))
        row = 0
        while row < len(demand):
            row, axis = _watch(
                demand, actual, row, self._settings, self._table, self._state, limits
            )
            if axis < 0:
                break
            limit_mm = self.limit.limit_mm(float(self._state[axis, COUNTED]))
            self._warn(
                axis,
                self.rows_seen + row,
                float(demand[row, axis]),
                float(actual[row, axis]),
                limit_mm,
            )
            if self.stop:
                break
            row += 1
        if self._chart is not None:  # the row of a fault too
            noted = min(row + 1, len(demand))
            self._chart.note(
                self.rows_seen, self.rate_hz, demand[:noted], actual[:noted], limits[:noted]
            )
        self.rows_seen += row
        return row

    def _warn(
        self, axis: int, row: int, demand_mm: float, actual_mm: float, limit_mm: float
    ) -> None:
        """Keep a fault with its state."""
        name, time_s, speed = (
            self.axes[axis],
            row / self.rate_hz,
            float(self._state[axis, COUNTED]),
        )
        self.warnings.append(
            FollowingFault(
                f"the drive of {name.upper()} does not follow at {time_s:.3f} s: demand "
                f"{demand_mm:.3f} mm, actual "
                f"{actual_mm:.3f} mm, error {demand_mm - actual_mm:+.3f} mm, allowed ±{limit_mm:.3f} mm at "
                f"{speed:.3g} mm/s; free the axis, or ask for less speed",
                axis=name,
                time_s=time_s,
                demand_mm=demand_mm,
                actual_mm=actual_mm,
                limit_mm=limit_mm,
            )
        )


class Supervised:
    """The monitor of a playback: its limit, the monitor of the last run, and a chart if one is put in."""

    limit: FollowingLimit
    monitor: Monitor
    chart: Chart | None = None
    notes: tuple[str, ...] = ()  # on the program, for the operator

    def supervise(self, axes: Sequence[str], rate_hz: float) -> Monitor:
        """Begin to watch a run."""
        self.monitor = Monitor(axes, rate_hz, self.limit, chart=self.chart)
        return self.monitor

    @property
    def following_error_mm(self) -> Array:
        """The largest following error of each axis in the last run, mm."""
        return self.monitor.largest_error_mm


@njit(cache=True, inline="always", _nrt=False)
def allowed_mm(speed_mm_s, table, tolerance_mm):  # type: ignore[no-untyped-def]
    """The limit at a speed of the demand, mm; for the kernels of all controls."""
    speed, row = abs(speed_mm_s), len(table) - 1
    while row > 0 and not speed >= table[row, 0]:
        row -= 1
    return table[row, 1] + (speed - table[row, 0]) * table[row, 2] + tolerance_mm


@njit(cache=True, nogil=True, _nrt=False)
def _watch(demand_mm, actual_mm, first, settings, table, state, limits_mm):  # type: ignore[no-untyped-def]
    """Watch from a row on; the row and the axis of the next fault, or the number of rows and -1."""
    rate_hz, share, fade, tolerance_mm = settings
    for row in range(first, len(demand_mm)):
        found = -1
        for axis in range(len(state)):
            demand, speed = demand_mm[row, axis], state[axis, SPEED]
            before = demand if math.isnan(state[axis, DEMAND]) else state[axis, DEMAND]
            speed += ((demand - before) * rate_hz - speed) * share
            counted = max(abs(speed), state[axis, COUNTED] * fade)
            limit = allowed_mm(counted, table, tolerance_mm)
            error = abs(demand - actual_mm[row, axis])
            state[axis, DEMAND], state[axis, SPEED] = demand, speed
            state[axis, COUNTED] = counted
            state[axis, LARGEST] = max(state[axis, LARGEST], error)
            # nearly all are less than the largest, and need no division
            if limit > 0 and error > NEARLY * limit * state[axis, SHARE]:
                state[axis, SHARE] = max(state[axis, SHARE], error / limit)
            if len(limits_mm):
                limits_mm[row, axis] = limit
            faulty = not error <= limit  # also where there is no number
            if faulty and state[axis, FAULTY] == 0:
                if found >= 0:
                    continue  # one fault at a time: this one is found in the next row
                found = axis
            state[axis, FAULTY] = faulty
        if found >= 0:
            return row, found
    return len(demand_mm), -1
