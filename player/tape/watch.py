"""The watch: whether skew and shaking are small enough, and no two tracks are one.

Signals in: rows of phases, and the first frames (n, tracks); out: nothing, or a fault.

    skew          a track that is late by s seconds stands s · reference off at standstill, and is wrong by
                  s · deviation under way:       |zero| / reference · speed / q  <  0.05 cycle
    shaking       the median of the predictor's surprise within 96 ms: noise, crosstalk and print-through beat
                  against the carrier, and beyond 0.0047 cycle bring the motors to the limit of their current
    stuck         two tracks with the same noise, sample for sample, are one signal

Source: patent ES 361967, figure 5 (fault circuit 162). Questions: half a cycle of zero is a track with the
other polarity and no skew. A skew of a quarter of the reference's period and more (42 us at 6 kHz) cannot be
told from a smaller one with it, and one of a half not from none.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.faults import LockFault, TapeFault
from morfax.player.monitor.monitor import NEARLY
from morfax.player.tape.phases import Phases, Uncertain
from morfax.player.tape.standstill import ALLOWED_CYCLES, Bearings, track_name
from morfax.player.tape.warrant import StandsMm
from morfax.recorder.tape.check_signal import GAUGE_S
from morfax.recorder.tape.format import TapeFormat

SHAKE_S = 0.096  # 576 rows at 6 kHz
SHAKE_STRIDE = 4  # rows: the filter spans eight, so the rows between say little more
# 26 dB of noise shake by 0.0033, and seldom by 0.0045; a corner shakes less than half of the window
SHAKE_CYCLES = 0.0047
QUIETEST = 10.0  # percent of the lines of a spectrum, which are noise alone
# of full scale and of the carrier: below it noise may be the rounding of samples of 16 bit
STUCK_NOISE = 1e-4
ROUNDED = 1.0  # steps of coarser samples: rounding makes 0.29, and it is the same on all tracks at standstill

Float32s = NDArray[np.float32]


class Watch:
    """Keeps watch over one tape, block by block."""

    def __init__(self, fmt: TapeFormat, bearings: Bearings) -> None:
        self._format, self._bearings = fmt, bearings
        self.takes_skew = True  # False: the check signal tells it, and it is taken out

    def first_fault(self, phases: Phases, stands_mm: StandsMm) -> Uncertain | None:
        """The first row that skew or shaking make uncertain, with its fault."""
        found = [
            f
            for f in (self.skewed(phases, stands_mm), self.unsteady(phases, stands_mm))
            if f is not None
        ]
        return min(found, key=lambda one: one.row, default=None)

    def skewed(self, phases: Phases, stands_mm: StandsMm) -> Uncertain | None:
        """The first row with an axis too fast for the skew of its track, and the fault."""
        if (
            not self.takes_skew or len(phases) < 2 or not self._format.dwell_s
        ):  # another's tape may start at any phase
            return None
        offset = np.abs(self._bearings.zero_cycles - np.round(self._bearings.zero_cycles))
        skew_s = np.minimum(offset, np.abs(0.5 - offset)) / self._bearings.reference_hz
        rate_hz = self._format.motion_rate_hz
        stride = max(round(rate_hz * GAUGE_S), 1)  # speeds over 2 ms, above the noise
        if not _any_skewed(
            phases.cycles, stride, NEARLY * ALLOWED_CYCLES * stride / rate_hz, skew_s
        ):
            return None
        speed = np.abs(phases.cycles[stride:] - phases.cycles[:-stride]) * (rate_hz / stride)
        wrong = speed * skew_s > ALLOWED_CYCLES
        if not wrong.any():
            return None
        row, axis = (int(i) for i in np.argwhere(wrong)[0])
        name = self._format.axes[axis]
        time_s = (phases.first_row + row) / rate_hz
        error_cycles = float(speed[row, axis] * skew_s[axis])
        speed_mm_s = speed[row, axis] * self._format.mm_per_cycle
        fault = LockFault(
            f"{name.upper()} moves at {speed_mm_s:.3g} mm/s at {time_s:.3f} s, and its track is "
            f"{skew_s[axis] * 1e6:.0f} us off the reference: that is {error_cycles:.2f} cycle, "
            f"{ALLOWED_CYCLES:g} is allowed; copy the tape with the head set straight",
            axis=name,
            time_s=time_s,
            error_cycles=error_cycles,
            position_mm=stands_mm()[axis],
        )
        return Uncertain(row, fault)

    def unsteady(self, phases: Phases, stands_mm: StandsMm) -> Uncertain | None:
        """The first row of a window in which the phase of an axis shakes, and the fault."""
        window = shake_rows(self._format.motion_rate_hz)
        whole = len(phases) // window * window
        if not _any_shaking(phases.surprise[:whole], window):
            return None
        parts = np.abs(phases.surprise[:whole:SHAKE_STRIDE]).reshape(
            whole // window, -1, phases.surprise.shape[1]
        )
        shakes = np.median(parts, axis=1)
        if not (shakes > SHAKE_CYCLES).any():
            return None
        at, axis = (int(i) for i in np.argwhere(shakes > SHAKE_CYCLES)[0])
        name = self._format.axes[axis]
        time_s = (phases.first_row + at * window) / self._format.motion_rate_hz
        fault = LockFault(
            f"the phase of {name.upper()} shakes by {shakes[at, axis]:.4f} cycle (median) at {time_s:.3f} s, "
            f"{SHAKE_CYCLES:g} is allowed: noise, crosstalk or print-through, which the motors cannot "
            "follow; copy the tape on a better machine",
            axis=name,
            time_s=time_s,
            error_cycles=float(shakes[at, axis]),
            position_mm=stands_mm()[axis],
        )
        return Uncertain(at * window, fault)


@njit(cache=True, nogil=True)
def _any_skewed(cycles, stride, travel_s, skew_s):  # type: ignore[no-untyped-def]
    """Whether an axis travels, in so many rows, so far that its skew makes `travel_s` of it, cycles · s."""
    # 1. one loop for all, in vectors, with the largest skew
    places, apart, skewed = cycles.ravel(), stride * cycles.shape[1], 0
    most_s = skew_s.max()
    for k in range(len(places) - apart):
        skewed += abs(places[k + apart] - places[k]) * most_s > travel_s
    if skewed == 0:
        return False
    # 2. each axis with its own
    skewed = 0
    for axis in range(cycles.shape[1]):
        for row in range(len(cycles) - stride):
            way = abs(cycles[row + stride, axis] - cycles[row, axis])
            skewed += way * skew_s[axis] > travel_s
    return skewed > 0


@njit(cache=True, nogil=True)
def _any_shaking(surprise, window):  # type: ignore[no-untyped-def]
    """Whether half of the rows of any window, every `SHAKE_STRIDE`-th, lie beyond what is allowed."""
    enough = window // SHAKE_STRIDE / 2
    for first in range(0, len(surprise), window):
        for axis in range(surprise.shape[1]):
            shaken = 0
            for row in range(first, first + window, SHAKE_STRIDE):
                shaken += abs(surprise[row, axis]) > SHAKE_CYCLES
            if shaken >= enough:
                return True
    return False


def shake_rows(rate_hz: float) -> int:
    """Rows of the window in which the phase of an axis may not shake."""
    return max(round(SHAKE_S * rate_hz / SHAKE_STRIDE), 1) * SHAKE_STRIDE


def demand_apart(frames: Float32s, levels: Array, names: Sequence[str]) -> None:
    """Raise TapeFault for two tracks with the same noise, in frames of standstill."""
    equal = frames / levels.astype(np.float32)
    for one in range(1, frames.shape[1]):
        floor = _noise(frames[:, one])
        if floor < max(STUCK_NOISE, STUCK_NOISE * float(levels[one])):
            continue
        if floor < ROUNDED * _step(frames[:, one]):
            continue
        for other in range(one):
            apart = float(np.std(equal[:, one] - equal[:, other])) * levels[one]
            if apart < 0.05 * floor:
                raise TapeFault(
                    f"tracks {other + 1} ({track_name(other, names)}) and {one + 1} "
                    f"({track_name(one, names)}) carry the "
                    f"same signal, noise and all; look to the cables, and copy the tape again"
                )


def _step(samples: Float32s) -> float:
    """The least step between samples, of full scale: 1/128 of 8 bit."""
    return float(np.diff(np.unique(samples)).min(initial=1.0))


def _noise(samples: Float32s) -> float:
    """White noise of a track, RMS: from the quietest of the spectrum, free of tones and flutter."""
    window = np.hanning(len(samples))
    lines = np.abs(np.fft.rfft(samples * window)) ** 2 / np.sum(window**2)
    return float(np.sqrt(np.percentile(lines, QUIETEST) / -np.log(1 - QUIETEST / 100)))
