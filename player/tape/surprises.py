"""Surprises: rows at which an axis moves as its program never does, though the level of its track is right.

Signals in: how far each phase lay from the predicted one (predictor.py), cycles; the levels of the tracks;
the most that the check signal tells of the axis' acceleration, cycles/row². Signals out: the rows that are
lost, as in a dropout.

    motion of acceleration a(t)   surprises by   sum of h(k) · a(t - k),    h: what a jump of the speed does
    so at most by                 A · sum of |h|                            41.3 row² at 6 kHz
    a row is lost at              |surprise| > A · sum of |h| + 6 sigma of noise,  and at least by 0.005 cycle

A tone as loud as the carrier, and nearly in phase with it, leaves the level as it is, and may lie between the
windows through which the check signal is seen (2 ms). Nothing else shows it.

A program that jumps from speed to speed surprises as much itself. Where that hides a twentieth of a cycle, a
row is lost as well where the level dips for a moment: where two waves meet that are e cycles apart, it falls
by 1 - cos(pi e), 1.2 % for a twentieth.

    dip   = 1 - level[k] / mean(level[k - 10], level[k + 10]),   lost beyond 6 sigma of noise or 1 %,
                                                                 and what the jump itself makes

Source: our own; the bound is that of any linear filter (M. Vidyasagar, Nonlinear Systems Analysis, 1993:
largest output over largest input is the integral of the impulse response's size). Questions: a bare tape
tells no acceleration; there only a quarter of a cycle is a fault (standstill.py).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array, median
from morfax.motion.compiled import njit
from morfax.motion.median import ROBUST
from morfax.player.tape.phases import Phases
from morfax.player.tape.predictor import count_turns
from morfax.player.tape.standstill import SILENT_LEVEL
from morfax.player.tape.told_bounds import ToldBounds
from morfax.recorder.tape.check_signal import GAUGE_S
from morfax.recorder.tape.format import TapeFormat

# behind a jump: 65 ms at 6 kHz; what is left of the response is 1e-6 of its largest
SETTLED_ROWS = 400
SMALL_CYCLES = 1e-3  # of the jump that is tried, so that no turn is miscounted
NOISE_SIGMAS = 6.0  # one row in 5e8
# A tenth of what is allowed: rounding, what the band filter bends at a corner, and the end of an MP3 of 128
# kbit/s, 0.0044.
LEAST_CYCLES = 0.005
STRIDE = 8  # rows from one that tells the noise to the next: the filter spans as many
# a step of a twentieth of a cycle surprises by 0.03, less what noise of 40 dB adds
HIDDEN_CYCLES = 0.02
DIP_ROWS = 10  # 1.7 ms at 6 kHz: the filter blurs a moment over eight
LEAST_DIP = 0.01  # of the level; flutter of 0.2 % makes 0.0016
# of the square of a jump in cycles/row: 2.3 was the most that jumps of 160 to 1600 Hz made the level dip
KINK = 2.5
SLOW = 0.2  # of the reference: the band filter is 0.08 % down there, and 1.3 % a fifteenth further off
ENOUGH_ROWS = 600  # 0.1 s: fewer tell the noise too roughly


class Surprises:
    """Finds the surprising rows of the axes of one tape; holds how noisy they are."""

    def __init__(self, gains: Array, fmt: TapeFormat) -> None:
        self._gauge_rows = GAUGE_S * fmt.motion_rate_hz
        self._slow = SLOW * fmt.reference_hz / fmt.motion_rate_hz
        self._gain_rows2 = acceleration_gain(gains)
        self._held_noise: Array = np.zeros(len(fmt.axes))
        # some of the last rows that were enough, as long as nobody has asked how noisy they are
        self._untold: NDArray[np.float32] | None = None

    def rows(self, rows: Phases, bounds: Sequence[ToldBounds]) -> NDArray[np.bool_] | None:
        """Which rows of the axes (n, axes) are lost, or None; `bounds`: what the tape tells of each axis."""
        some = rows.surprise[::STRIDE].copy()
        if len(rows) >= ENOUGH_ROWS:
            self._untold = some
        else:
            self._held_noise = np.maximum(_noise(np.abs(some)), self._noise_cycles)
        may_jump = self._may_jump(bounds)
        if not may_jump and not _loud(rows.surprise.ravel(), LEAST_CYCLES):
            return None
        least = np.maximum(self._noise_cycles, LEAST_CYCLES).astype(np.float64)
        if not may_jump and not _any_beyond(rows.surprise, least):
            return None
        told = np.empty((2, *rows.cycles.shape))
        for axis, bound in enumerate(bounds):
            bound.tell(rows.first_row, told[:, :, axis])
        lost, jumps = np.empty((2, *rows.surprise.shape), bool)
        if _beyond(rows.surprise, told, (self._gain_rows2, self._slow), least, (lost, jumps)):
            accelerations = told[0]
            dips = _dips(rows.levels)
            own = KINK * (accelerations * self._gauge_rows) ** 2
            lost |= jumps & (np.maximum(dips[:, :1], dips[:, 1:]) > own)
        return np.asarray(lost)

    @property
    def _noise_cycles(self) -> Array:
        """How far the rows of each axis lie off by noise; told only where somebody asks."""
        if self._untold is not None:
            self._held_noise, self._untold = _noise(np.abs(self._untold)), None
        return self._held_noise

    def _may_jump(self, bounds: Sequence[ToldBounds]) -> bool:
        """Whether any axis was told of accelerations that hide a jump."""
        return any(self._gain_rows2 * bound.largest > HIDDEN_CYCLES for bound in bounds)

    def noise(self, axis: int) -> float:
        """How far a row of an axis may lie off by noise, or by what a sound tape does itself, cycles."""
        return max(float(self._noise_cycles[axis]), LEAST_CYCLES)


@njit(cache=True, nogil=True)
def _loud(surprise, least):  # type: ignore[no-untyped-def]
    """How many surprises are larger than those of any sound tape; counted, so that it runs in vectors."""
    loud = 0
    for k in range(len(surprise)):
        loud += abs(surprise[k]) > least
    return loud


@njit(cache=True, nogil=True)
def _any_beyond(surprise, least):  # type: ignore[no-untyped-def]
    """Whether any row of an axis surprises by more than a sound tape does itself."""
    for axis in range(surprise.shape[1]):
        for row in range(len(surprise)):
            if abs(surprise[row, axis]) > least[axis]:
                return True
    return False


@njit(cache=True, nogil=True)
def _beyond(surprise, told, limits, least, marks):  # type: ignore[no-untyped-def]
    """Mark the rows that surprise by more than told, and those where the program jumps; whether any does.

    `told` (2, n, axes): largest acceleration, cycles/row², and speed, cycles/row; nan where none is told.
    `limits`: of the surprise for a told acceleration, and of the speed at which jumps are looked for.
    """
    lost, jumps = marks
    any_jumps = False
    for row in range(len(surprise)):
        for axis in range(surprise.shape[1]):
            by_program = told[0, row, axis] * limits[0]
            lost[row, axis] = abs(surprise[row, axis]) > by_program + least[axis]
            jumps[row, axis] = by_program > HIDDEN_CYCLES and told[1, row, axis] < limits[1]
            any_jumps |= jumps[row, axis]
    return any_jumps


def _noise(sizes: NDArray[np.float32]) -> Array:
    """So many standard deviations of each column, told by its median."""
    medians = np.empty(sizes.shape[1], np.float32)
    _medians(sizes, medians)
    return np.asarray(medians * (NOISE_SIGMAS * ROBUST))


@njit(cache=True, nogil=True)
def _medians(sizes, medians):  # type: ignore[no-untyped-def]
    """Fill the median of each column."""
    for column in range(len(medians)):
        medians[column] = median(sizes[:, column].copy())


def _dips(levels: NDArray[np.float32]) -> Array:
    """By how much each level dips, or rises, for a moment, beyond noise; below zero where it does not."""
    dips = np.full(levels.shape, -1.0)
    if len(levels) > 2 * DIP_ROWS:
        beside = (levels[: -2 * DIP_ROWS] + levels[2 * DIP_ROWS :]) / 2
        size = np.abs(levels[DIP_ROWS:-DIP_ROWS] / np.maximum(beside, SILENT_LEVEL) - 1)
        dips[DIP_ROWS:-DIP_ROWS] = size - np.maximum(_noise(size[::STRIDE]), LEAST_DIP)
    return dips


def acceleration_gain(gains: Array) -> float:
    """The largest surprise of a motion for each cycle/row² of its largest acceleration, rows²."""
    ramp = SMALL_CYCLES * np.arange(float(SETTLED_ROWS))[None]
    surprise = np.empty((SETTLED_ROWS, 1), np.float32)
    count_turns(ramp, gains, np.zeros((1, 3)), np.empty(surprise.shape), surprise)
    return float(np.abs(surprise).sum()) / SMALL_CYCLES
