"""The watch: whether track 1 is the reference, skew and shaking are small enough, and no two tracks are one.

Signals in: blocks of frames (n, tracks) and rows of phases; out: nothing, or a fault.

    reference     the frequency of each track at 64 moments of a block, against that at standstill; all tracks
                  share the tape's speed. The reference is the steadiest track: one twice as steady as track 1
                  is it. At the end any steadier track is: flutter may hide how much steadier
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
from morfax.motion.faults import Fault, LockFault, TapeFault
from morfax.player.tape.band_filter import translating_taps
from morfax.player.tape.discriminator import Frames, Phases
from morfax.player.tape.standstill import ALLOWED_CYCLES, Bearings, track_name
from morfax.player.tape.warrant import StandsMm
from morfax.recorder.tape.format import TapeFormat

MOMENTS = 64  # in a block
STEADIER = 4.0  # of the mean square, before another track is taken for the reference
LEAST_MOTION_HZ = 8.0  # of track 1, RMS: 0.4 mm/s; 30 dB of noise leave 3
FEWEST_MOMENTS = 64  # one block, before the watch says anything
MOVED = 2.0  # of the mean square at standstill: a track that moved against track 1
LEAST_APART_HZ = 1.0  # RMS: 0.05 mm/s, below which a track stands against track 1
SHAKE_S = 0.096  # 576 rows at 6 kHz
SHAKE_STRIDE = 4  # rows: the filter spans eight, so the rows between say little more
# 26 dB of noise shake by 0.0033, and seldom by 0.0045; a corner shakes less than half of the window
SHAKE_CYCLES = 0.0047
# of full scale and of the carrier: below it noise may be the rounding of the samples
STUCK_NOISE = 1e-4
NEARLY = 1 - 1e-9  # of a limit: beyond it the exact sum is made; rounding is 1e-15

Float32s = NDArray[np.float32]


class Watch:
    """Keeps watch over one tape, block by block."""

    def __init__(self, fmt: TapeFormat, bearings: Bearings) -> None:
        self._format, self._bearings = fmt, bearings
        re, im = translating_taps(fmt.sample_rate_hz, fmt.reference_hz, fmt.samples_per_motion)
        self._taps = np.array([re, im], np.float64)
        self._still_hz = bearings.reference_hz
        self.takes_skew = True  # False: the check signal tells it, and it is taken out
        self._sums, self._apart, self._moments = np.zeros(fmt.tracks), np.zeros(fmt.tracks), 0
        # mean square of a frequency less that of track 1, at standstill
        self._noise: Array | None = None

    def wrong_reference(self, frames: Frames, time_s: float) -> TapeFault | None:
        """The fault of a track 1 that moves more than another; takes the frames of one block."""
        found = self._frequencies(frames)
        self._sums += np.square(found - self._still_hz).sum(axis=0)
        self._moments += len(found)
        apart = np.square(found - found[:, :1])
        self._apart += apart.sum(axis=0)
        if self._noise is None and len(apart):
            self._noise = apart[: len(apart) // 2].mean(axis=0)
        if self._moments < FEWEST_MOMENTS:
            return None
        mean = self._sums / self._moments
        steadiest = int(np.argmin(mean))
        if mean[0] < LEAST_MOTION_HZ**2 or mean[0] < STEADIER * mean[steadiest]:
            return None
        return self._elsewhere(steadiest, mean, time_s)

    @property
    def steadiest(self) -> int:
        """The track that has moved least so far, from 0."""
        return int(np.argmin(self._sums))

    @property
    def reference_is_steady(self) -> bool:
        """Whether another track has moved, and far more than track 1."""
        most = float(self._sums.max()) / max(self._moments, 1)
        return most >= LEAST_MOTION_HZ**2 and most >= STEADIER * float(self._sums[0]) / max(
            self._moments, 1
        )

    def doubtful_reference(self, time_s: float) -> Fault | None:
        """The fault of a track that moved against track 1 and was steadier over the whole tape."""
        if self._moments < FEWEST_MOMENTS or self._noise is None:
            return None
        mean, apart = self._sums / self._moments, self._apart / self._moments
        steadier = (mean < mean[0]) & (apart > MOVED * self._noise + LEAST_APART_HZ**2)
        return (
            self._elsewhere(int(np.argmin(np.where(steadier, mean, np.inf))), mean, time_s)
            if steadier.any()
            else None
        )

    def _elsewhere(self, steadiest: int, mean: Array, time_s: float) -> TapeFault:
        """The fault of a reference that is on another track; `mean` squares in Hz²."""
        name = track_name(steadiest, self._format.axes)
        return TapeFault(
            f"track 1 moves by {np.sqrt(mean[0]):.0f} Hz and track {steadiest + 1} ({name}) stands at "
            f"{np.sqrt(mean[steadiest]):.0f} Hz, so the reference is on track {steadiest + 1}, "
            f"found at {time_s:.3f} s, or "
            f"missing, and then no place can be known; "
            f"say which tracks are reference, {', '.join(axis.upper() for axis in self._format.axes)} "
            f"(--tracks {steadiest + 1},...)",
            time_s=time_s,
        )

    def _frequencies(self, frames: Frames) -> Array:
        """Frequency of each track at some moments, Hz (moments, tracks)."""
        step = self._format.samples_per_motion
        spare = len(frames) - self._taps.shape[1] - step
        if spare < MOMENTS:
            return np.zeros((0, frames.shape[1]))
        starts = np.linspace(0, spare, MOMENTS).astype(np.int64)
        first, after = filtered = np.empty((2, MOMENTS, frames.shape[1]), np.complex128)
        _filtered(frames, starts, step, self._taps, filtered)
        rate_hz, hz = self._format.sample_rate_hz / step, self._format.reference_hz
        # the taps do not turn along
        turned = np.angle(after * first.conj()) / (2 * np.pi) - hz / rate_hz
        return np.asarray(hz + (turned - np.round(turned)) * rate_hz)

    def first_fault(self, phases: Phases, stands_mm: StandsMm) -> tuple[int, Fault] | None:
        """The first row that skew or shaking make uncertain, with its fault."""
        found = [
            f
            for f in (self.skewed(phases, stands_mm), self.unsteady(phases, stands_mm))
            if f is not None
        ]
        return min(found, key=lambda one: one[0], default=None)

    def skewed(self, phases: Phases, stands_mm: StandsMm) -> tuple[int, Fault] | None:
        """The first row with an axis too fast for the skew of its track, and the fault."""
        if (
            not self.takes_skew or len(phases) < 2 or not self._format.dwell_s
        ):  # another's tape may start at any phase
            return None
        offset = np.abs(self._bearings.zero_cycles - np.round(self._bearings.zero_cycles))
        skew_s = np.minimum(offset, np.abs(0.5 - offset)) / self._bearings.reference_hz
        rate_hz = self._format.motion_rate_hz
        stride = max(round(rate_hz * 0.002), 1)  # speeds over 2 ms, above the noise
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
        return row, LockFault(
            f"{name.upper()} moves at {speed[row, axis] * self._format.mm_per_cycle:.3g} mm/s at "
            f"{time_s:.3f} s, and its "
            f"track is {skew_s[axis] * 1e6:.0f} us off the reference: that is "
            f"{speed[row, axis] * skew_s[axis]:.2f} cycle, "
            f"{ALLOWED_CYCLES:g} is allowed; copy the tape with the head set straight",
            axis=name,
            time_s=time_s,
            error_cycles=float(speed[row, axis] * skew_s[axis]),
            position_mm=stands_mm()[axis],
        )

    def unsteady(self, phases: Phases, stands_mm: StandsMm) -> tuple[int, Fault] | None:
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
        name, time_s = (
            self._format.axes[axis],
            (phases.first_row + at * window) / self._format.motion_rate_hz,
        )
        return at * window, LockFault(
            f"the phase of {name.upper()} shakes by {shakes[at, axis]:.4f} cycle (median) at {time_s:.3f} s, "
            f"{SHAKE_CYCLES:g} is allowed: noise, crosstalk or print-through, which the motors "
            "cannot follow; copy the tape "
            f"on a better machine",
            axis=name,
            time_s=time_s,
            error_cycles=float(shakes[at, axis]),
            position_mm=stands_mm()[axis],
        )


# The order of the sums is free (reassoc, contract), so that they run in vectors.
@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def _filtered(frames, starts, step, taps, out):  # type: ignore[no-untyped-def]
    """The tracks through a filter (re and im, taps) that begins at some frames, and `step` further on.

    `out` (2, moments, tracks).
    """
    length = taps.shape[1]
    seen = np.empty(length + step)
    for moment in range(len(starts)):
        for track in range(frames.shape[1]):
            for k in range(len(seen)):
                seen[k] = frames[starts[moment] + k, track]
            for late in range(2):
                re, im = 0.0, 0.0
                for k in range(length):
                    re += taps[0, k] * seen[late * step + k]
                    im += taps[1, k] * seen[late * step + k]
                out[late, moment, track] = complex(re, im)


@njit(cache=True, nogil=True)
def _any_skewed(cycles, stride, travel_s, skew_s):  # type: ignore[no-untyped-def]
    """Whether an axis travels, in so many rows, so far that its skew makes `travel_s` of it, cycles · s."""
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
        for other in range(one):
            if float(np.std(equal[:, one] - equal[:, other])) * levels[one] < 0.05 * floor:
                raise TapeFault(
                    f"tracks {other + 1} ({track_name(other, names)}) and {one + 1} "
                    f"({track_name(one, names)}) carry the "
                    f"same signal, noise and all; look to the cables, and copy the tape again"
                )


def _noise(samples: Float32s) -> float:
    """White noise of a track, RMS: from the weakest tenth of the spectrum, free of tones and flutter."""
    window = np.hanning(len(samples))
    lines = np.abs(np.fft.rfft(samples * window)) ** 2 / np.sum(window**2)
    return float(np.sqrt(np.percentile(lines, 10) / -np.log(0.9)))
