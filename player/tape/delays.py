"""The delay of one track against the reference, and its rows put right by it.

Signals in: rows of the tape and the delays told there, s, eight or nine a second; phases in cycles. Signals
out: phases without the delay.

    settled   the mean of seven that are told, three before and three behind; at both ends of the tape a
              straight line through seven
    used      follows what is settled as far as leaves a dead zone of 0.5 us; a straight line between
    cycles   += used · (reference + speed of the axis)        the carrier's own delay, and that of the motion

A tape without delays stays as it is, to the last digit.

Source: our own. Questions: seven tell 0.4 us at 26 dB, that is 0.003 cycle; a delay that swings faster than
once in two seconds is not followed.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array

WINDOW = 7  # of the delays told, 0.84 s: drift of 50 us/s is straight within it
HALF = WINDOW // 2
DEAD_ZONE_S = 0.5e-6  # noise of 26 dB tells 0.4; half a us is 0.003 cycle
KEPT = 40  # delays: more than rows are held for
SPEED_S = 0.002  # to either side, over which a speed is told


class Delay:
    """The delay of one track; `settled_row`: up to where it is known."""

    def __init__(self, reference_hz: float, rate_hz: float) -> None:
        self._reference_hz, self._rate_hz = reference_hz, rate_hz
        self.span = max(round(SPEED_S * rate_hz), 1)
        self._rows: list[float] = []
        self._told: list[float] = []
        self._used: list[float] = []
        self.moves = False  # whether a delay above the dead zone was ever told

    @property
    def settled_row(self) -> float:
        """The row up to which the delay will not be told otherwise."""
        return self._rows[len(self._used) - 1] if self._used else 0.0

    def add(self, rows: list[float], delays_s: list[float]) -> None:
        """Take the next rows at which the delay is told."""
        self._rows += rows
        self._told += delays_s
        self.moves = self.moves or max(map(abs, delays_s)) > DEAD_ZONE_S
        while len(self._told) - len(self._used) > HALF and len(self._told) >= WINDOW:
            last = self._used[-1] if self._used else 0.0
            settled = self._settled(len(self._used)) if self.moves else 0.0
            self._used.append(_towards(last, settled))
        gone = max(min(len(self._used), len(self._rows) - WINDOW) - KEPT, 0)
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
        delay_s = np.interp(numbers, self._rows[: len(used)], used)
        return np.asarray(cycles + delay_s * (self._reference_hz + speed))

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
        if at - first == HALF or len(told) < WINDOW:
            return mean_s
        rows = np.array(self._rows[first : first + WINDOW])
        off = rows - rows.mean()
        slope = float(off @ np.array(told) / (off @ off))
        return float(mean_s + slope * (self._rows[at] - rows.mean()))


def _towards(used_s: float, settled_s: float) -> float:
    """A delay that follows another to within the dead zone, s."""
    return min(max(used_s, settled_s - DEAD_ZONE_S), settled_s + DEAD_ZONE_S)
