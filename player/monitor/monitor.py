"""Following-error monitor: is a servo as far behind its demand as its speed explains, or further?

Signals in: demand and actual position of each axis in mm, at any one rate. Signals out: the limit in mm, a
fault with its state, and whether to stop.

    demand ──► rate of change 35 ──► table 32, 34 ──► + tolerance 38 ──► limit ──┐
    demand − actual ─────────────────────────────────────────────────────► comparator 40 ──► warning, stop

    fault  ⇔  |demand − actual| > table(|d demand / dt|) + tolerance

The table is in following_limit.py.

Source: patent ES 414458, figures 1 and 2 (numbers above). Questions: when the demand stops a servo is still
behind for a while: `settle_s` gives the rate of change that same lag, with which a linear table is exactly
the error of a type-1 servo; 0 is the patent's rule. It also smooths a demand that comes in pulses. A servo of
type 2 is behind after a change of speed and not at one: `hold_s` lets a rate that was count for a while. A
warning is given once, and again after the error was inside the limit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import ROUNDED, Array
from morfax.motion.compiled import njit
from morfax.motion.faults import FollowingFault
from morfax.motion.motion import Motion
from morfax.player.monitor.chart import Chart
from morfax.player.monitor.following_limit import FollowingLimit, allowed_mm, part_at

# columns of the state of an axis; PART: of the table, that the speed was in last
DEMAND, SPEED, COUNTED, FAULTY, LARGEST, SHARE, PART = 0, 1, 2, 3, 4, 5, 6
STRETCH_ROWS = 64  # that are watched axis by axis, as long as none is faulty
NEARLY = 1 - ROUNDED  # of the largest share: beyond it the exact one is made; rounding is 1e-15


class Watching(NamedTuple):
    """A monitor as kernels take it: figures, table, state of the axes before and after some rows, and limits,
    if they are noted, in the rows of a block.
    """

    settings: Array
    table: Array
    state: Array
    after: Array
    limits_mm: Array


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
        self._state = np.zeros((len(self.axes), PART + 1))
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
        watching, row = self._watching(len(demand)), 0
        while row < len(demand):
            row, axis = _watch(demand, actual, row, watching)
            if axis < 0:
                break
            self._warn(axis, row, demand, actual)
            if self.stop:
                break
            row += 1
        self._note(row, demand, actual, watching)
        return row

    def _watching(self, rows: int) -> Watching:
        """What the kernel needs to watch so many rows."""
        limits = np.zeros((0 if self._chart is None else rows, len(self.axes)))
        after = np.zeros_like(self._state)
        return Watching(self._settings, self._table, self._state, after, limits)

    def _note(self, row: int, demand_mm: Array, actual_mm: Array, watching: Watching) -> None:
        """Count the rows up to one, and take them down, that of a fault too."""
        if self._chart is not None:
            noted = slice(min(row + 1, len(demand_mm)))
            rows = demand_mm[noted], actual_mm[noted], watching.limits_mm[noted]
            self._chart.note(self.rows_seen, self.rate_hz, *rows)
        self.rows_seen += row

    def _warn(self, axis: int, row: int, demands_mm: Array, actuals_mm: Array) -> None:
        """Keep the fault of a row of a block with its state."""
        name, time_s = self.axes[axis], (self.rows_seen + row) / self.rate_hz
        speed = float(self._state[axis, COUNTED])
        limit_mm = self.limit.limit_mm(speed)
        demand_mm, actual_mm = float(demands_mm[row, axis]), float(actuals_mm[row, axis])
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
    """The monitor of a playback: its limit, monitor and end of the last run, and a chart if one is put in."""

    limit: FollowingLimit
    monitor: Monitor
    end_mm: Array  # the last good place
    chart: Chart | None = None
    notes: tuple[str, ...] = ()  # on the program, for the operator

    def supervise(self, axes: Sequence[str], rate_hz: float) -> Monitor:
        """Begin to watch a run."""
        self.monitor = Monitor(axes, rate_hz, self.limit, chart=self.chart)
        return self.monitor

    def followed(
        self, demand_mm: Array, actual_mm: Array, places_mm: Array, begin_s: float
    ) -> Iterator[Motion]:
        """The motion (n, axes) of a block as far as the drives followed; raises FollowingFault after it."""
        rows = self.monitor.watch(demand_mm, actual_mm)
        if rows:
            self.end_mm = places_mm[rows - 1].copy()
            yield Motion(places_mm[:rows], self.monitor.rate_hz, begin_s)
        if rows < len(places_mm):
            raise self.monitor.warnings[-1]

    @property
    def following_error_mm(self) -> Array:
        """The largest following error of each axis in the last run, mm."""
        return self.monitor.largest_error_mm


@njit(cache=True, nogil=True, _nrt=False)
def _watch(demand_mm, actual_mm, first, watching):  # type: ignore[no-untyped-def]
    """Watch from a row on; the row and the axis of the next fault, or the number of rows and -1."""
    row = first
    while row < len(demand_mm):
        last = min(row + STRETCH_ROWS, len(demand_mm))
        if _calm(demand_mm, actual_mm, row, last, watching):
            row = last
        while row < last:
            found = _watch_row(demand_mm, actual_mm, row, watching)
            if found >= 0:
                return row, found
            row += 1
    return len(demand_mm), -1


@njit(cache=True, nogil=True, _nrt=False)
def _calm(demand_mm, actual_mm, first, last, watching):  # type: ignore[no-untyped-def]
    """Watch some rows of each axis by itself, if none is faulty there; else nothing is done, and False."""
    table, state, after = watching.table, watching.state, watching.after
    rate_hz, share, fade, tolerance_mm = watching.settings
    for axis in range(len(state)):
        if state[axis, FAULTY] != 0:
            return False
        before, speed, counted = state[axis, DEMAND], state[axis, SPEED], state[axis, COUNTED]
        largest, most, part = state[axis, LARGEST], state[axis, SHARE], int(state[axis, PART])
        before = demand_mm[first, axis] if math.isnan(before) else before
        for row in range(first, last):
            demand = demand_mm[row, axis]
            speed += ((demand - before) * rate_hz - speed) * share
            counted, before = max(abs(speed), counted * fade), demand
            part = part_at(counted, table, part)
            limit = allowed_mm(counted, part, table, tolerance_mm)
            error = abs(demand - actual_mm[row, axis])
            if not error <= limit:
                return False
            largest = max(largest, error)
            # nearly all are less than the largest, and need no division
            if limit > 0 and error > NEARLY * limit * most:
                most = max(most, error / limit)
            if len(watching.limits_mm):
                watching.limits_mm[row, axis] = limit
        after[axis, DEMAND], after[axis, SPEED], after[axis, COUNTED] = before, speed, counted
        after[axis, LARGEST], after[axis, SHARE], after[axis, PART] = largest, most, part
    for axis in range(len(state)):
        for column in range(state.shape[1]):
            state[axis, column] = after[axis, column]
    return True


@njit(cache=True, nogil=True, _nrt=False)
def _watch_row(demand_mm, actual_mm, row, watching):  # type: ignore[no-untyped-def]
    """Watch all axes in a row; the axis of its fault, -1 without one."""
    found, table, state = -1, watching.table, watching.state
    rate_hz, share, fade, tolerance_mm = watching.settings
    for axis in range(len(state)):
        demand, speed = demand_mm[row, axis], state[axis, SPEED]
        before = demand if math.isnan(state[axis, DEMAND]) else state[axis, DEMAND]
        speed += ((demand - before) * rate_hz - speed) * share
        counted = max(abs(speed), state[axis, COUNTED] * fade)
        part = part_at(counted, table, int(state[axis, PART]))
        limit = allowed_mm(counted, part, table, tolerance_mm)
        error = abs(demand - actual_mm[row, axis])
        state[axis, DEMAND], state[axis, SPEED] = demand, speed
        state[axis, COUNTED], state[axis, PART] = counted, part
        state[axis, LARGEST] = max(state[axis, LARGEST], error)
        if limit > 0:
            state[axis, SHARE] = max(state[axis, SHARE], error / limit)
        if len(watching.limits_mm):
            watching.limits_mm[row, axis] = limit
        faulty = not error <= limit  # also where there is no number
        if faulty and state[axis, FAULTY] == 0:
            if found >= 0:
                continue  # one fault at a time: this one is found in the next row
            found = axis
        state[axis, FAULTY] = faulty
    return found
