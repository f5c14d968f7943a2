"""The delay of one track against the reference, and its rows put right by it.

Signals in: rows of the tape and the delays told there, s, eight or nine a second; phases in cycles. Signals
out: phases without the delay.

    settled   the mean of seven that are told, three before and three behind, or of the middle three where
              that lies off it by more than noise does; at both ends of the tape a straight line through seven
    used      follows what is settled as far as leaves a dead zone of 0.5 us; a straight line between, and
              beyond the first and the last as fast as the seven there change
    doubt     three standard errors of the straight line, at the last row of the tape:
              3 s sqrt(1/7 + x² / sum x_i²),   x from the middle of seven, s of one told delay
    cycles   += used · (reference + speed of the axis)        the carrier's own delay, and that of the motion

A tape without delays stays as it is, to the last digit. Behind the last delay told the line runs on for up to
half a second, and an error of those told (a tone beside the subcarrier, of 3 % of the carrier, turns each by
4 us) counts there one and a half times.

Source: our own. Questions: seven tell 0.4 us at 26 dB, that is 0.003 cycle; a delay that swings faster than
once in two seconds is not followed.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import OUTLIERS
from morfax.player.tape.phases import Phases
from morfax.recorder.tape.check_signal import GAUGE_S

WINDOW = 7  # of the delays told, 0.84 s: drift of 50 us/s is straight within it
HALF = WINDOW // 2
NEAR = (1 / 3 - 1 / WINDOW) ** 0.5  # standard error of the difference, for one told delay of 1
DEAD_ZONE_S = 0.5e-6  # noise of 26 dB tells 0.4; half a us is 0.003 cycle
KEPT = 40  # delays: more than rows are held for
HELD_ERRORS = 2  # of frames: seven delays come from two


class Delay:
    """The delay of one track; `settled_row`: up to where it is known."""

    def __init__(self, reference_hz: float, rate_hz: float) -> None:
        self._reference_hz, self._rate_hz = reference_hz, rate_hz
        self.span = max(round(GAUGE_S * rate_hz), 1)
        self._rows: list[float] = []
        self._told: list[float] = []
        self._used: list[float] = []
        self._errors_s = deque([0.0], HELD_ERRORS)
        self._is_whole = True  # until the first that were told are no longer held
        self.moves = False  # whether a delay above the dead zone was ever told

    @property
    def settled_row(self) -> float:
        """The row up to which the delay will not be told otherwise."""
        return self._rows[len(self._used) - 1] if self._used else 0.0

    @property
    def told_row(self) -> float:
        """The last row at which the delay was told."""
        return self._rows[-1] if self._rows else 0.0

    def add(
        self,
        rows: list[float],
        delays_s: list[float],
        errors_s: Sequence[float],
        *,
        is_calm: bool = False,
    ) -> None:
        """Take the next rows at which the delay is told, and the standard errors of it, frame by frame.

        `is_calm`: none is above the dead zone.
        """
        self._errors_s.extend(errors_s)
        self._rows += rows
        self._told += delays_s
        if not (self.moves or is_calm):
            self.moves = max(map(abs, delays_s)) > DEAD_ZONE_S
        settled = len(self._told) - HALF if len(self._told) >= WINDOW else 0
        if not self.moves:
            self._used += [0.0] * (settled - len(self._used))
        while len(self._used) < settled:
            last = self._used[-1] if self._used else 0.0
            self._used.append(_towards(last, self._settled(len(self._used))))
        gone = min(len(self._used), len(self._rows) - WINDOW) - KEPT
        if gone > 0:
            self._is_whole = False
            del self._rows[:gone], self._told[:gone], self._used[:gone]

    def corrected(self, cycles: Array, first_row: int) -> Array:
        """The phases of some rows without the delay; the first and last rows only lend their speed."""
        if not self.moves:
            return cycles
        used = self._used + self._rest()
        numbers = first_row + np.arange(len(cycles))
        padded = np.pad(cycles, self.span, mode="edge")
        speed = padded[2 * self.span :] - padded[: -2 * self.span]
        speed *= self._rate_hz / (2 * self.span)
        rows = self._rows[: len(used)]
        delay_s = np.interp(numbers, rows, used)
        delay_s += self._slope(-WINDOW) * np.maximum(numbers - rows[-1], 0)
        if self._is_whole:
            delay_s += self._slope(0) * np.minimum(numbers - rows[0], 0)
        return np.asarray(cycles + delay_s * (self._reference_hz + speed))

    def off_s(self) -> float:
        """The largest of what was told last, off the straight line through it, s: what is not followed.

        0 while no delay was above the dead zone.
        """
        if len(self._told) < WINDOW or not self.moves:
            return 0.0
        told = np.array(self._told[-WINDOW:])
        rows = np.array(self._rows[-WINDOW:])
        line = told.mean() + self._slope(-WINDOW) * (rows - rows.mean())
        return float(np.abs(told - line).max())

    def doubt_s(self, row: float) -> float:
        """How far the delay at a row, on the straight line through the seven told last, may be off, s."""
        if len(self._told) < WINDOW:
            return 0.0
        rows = np.array(self._rows[-WINDOW:])
        middle = float(rows.mean())
        spread = float(((rows - middle) ** 2).sum())
        return (
            OUTLIERS
            * max(self._errors_s)
            * math.sqrt(1 / WINDOW + (row - middle) ** 2 / spread)
        )

    def _slope(self, first: int) -> float:
        """How fast the delay changes in seven that were told, from one on, s per row."""
        last = first + WINDOW or None
        told = np.array(self._told[first:last])
        rows = np.array(self._rows[first:last])
        off = rows - rows.mean()
        spread = float(off @ off)
        return float(off @ told) / spread if len(told) == WINDOW and spread else 0.0

    def _rest(self) -> list[float]:
        """What would be used for those that are not settled, if none came after them."""
        used: list[float] = []
        last = self._used[-1] if self._used else 0.0
        for at in range(len(self._used), len(self._told)):
            last = _towards(last, self._settled(at))
            used.append(last)
        return used

    def _settled(self, at: int) -> float:
        """The delay at one of those told: the mean around it, or a straight line at the ends, s."""
        first = min(max(at - HALF, 0), max(len(self._told) - WINDOW, 0))
        told = self._told[first : first + WINDOW]
        mean_s = sum(told) / len(told)
        if len(told) < WINDOW:
            return mean_s
        if at - first == HALF:
            near_s = sum(told[HALF - 1 : HALF + 2]) / 3
            # standard errors of the difference of seven and three
            is_bent = abs(near_s - mean_s) > OUTLIERS * NEAR * max(self._errors_s)
            return near_s if is_bent else mean_s
        middle = float(np.mean(self._rows[first : first + WINDOW]))
        return float(mean_s + self._slope(first) * (self._rows[at] - middle))


def _towards(used_s: float, settled_s: float) -> float:
    """A delay that follows another to within the dead zone, s."""
    return min(max(used_s, settled_s - DEAD_ZONE_S), settled_s + DEAD_ZONE_S)


def corrected(rows: Phases, delays: Sequence[Delay]) -> Phases:
    """Rows without the delays of their tracks."""
    if not any(delay.moves for delay in delays):
        return rows
    columns = [
        delay.corrected(column, rows.first_row)
        for delay, column in zip(delays, rows.cycles.T, strict=True)
    ]
    return replace(rows, cycles=np.column_stack(columns))
