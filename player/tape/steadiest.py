"""The steadiest track: whether it is track 1, the reference, as it should be.

Signals in: blocks of frames (n, tracks). Signals out: nothing, or a fault.

    frequency   of each track at 64 moments of a block, against that at standstill; all tracks share the
                tape's speed
    wrong       a track twice as steady as track 1 is the reference
    doubtful    at the end any steadier track is: flutter may hide how much steadier

Source: patent ES 361967, figure 5 (fault circuit 162). Questions: none.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.faults import Fault, TapeFault
from morfax.player.tape.band_filter import translating_taps
from morfax.player.tape.discriminator import Frames
from morfax.player.tape.standstill import track_name
from morfax.recorder.tape.format import TapeFormat

MOMENTS = 64  # in a block: before one is full, nothing is said
STEADIER = 4.0  # of the mean square, before another track is taken for the reference
LEAST_MOTION_HZ = 8.0  # of track 1, RMS: 0.4 mm/s; 30 dB of noise leave 3
MOVED = 2.0  # of the mean square at standstill: a track that moved against track 1
LEAST_APART_HZ = 1.0  # RMS: 0.05 mm/s, below which a track stands against track 1


class Steadiest:
    """Keeps watch over the frequencies of one tape, block by block; `still_hz`: of track 1 at standstill."""

    def __init__(self, fmt: TapeFormat, still_hz: float) -> None:
        self._format = fmt
        re, im = translating_taps(fmt.sample_rate_hz, fmt.reference_hz, fmt.samples_per_motion)
        self._taps = np.array([re, im], np.float64)
        self._clock = fmt.samples_per_motion, float(fmt.sample_rate_hz), fmt.reference_hz
        self._still_hz = still_hz
        self._found = np.zeros((MOMENTS, fmt.tracks))  # Hz, in the last block
        # sums of the squares against standstill, and against track 1
        self._sums = np.zeros((2, fmt.tracks))
        self._moments = 0
        # mean square of a frequency less that of track 1, at standstill
        self._noise: Array | None = None

    def wrong(self, frames: Frames, time_s: float) -> TapeFault | None:
        """The fault of a track 1 that moves more than another; takes the frames of one block."""
        if len(frames) - self._taps.shape[1] - self._format.samples_per_motion >= MOMENTS:
            _frequencies(frames, self._clock, self._taps, self._found)
            _add_squares(self._found, self._still_hz, self._sums)
            self._moments += MOMENTS
            if self._noise is None:
                first = self._found[: MOMENTS // 2]
                self._noise = np.square(first - first[:, :1]).mean(axis=0)
        if self._moments < MOMENTS:
            return None
        sums = self._sums[0].tolist()
        least = min(sums)
        if sums[0] < LEAST_MOTION_HZ**2 * self._moments or sums[0] < STEADIER * least:
            return None
        return self._elsewhere(self.track, time_s)

    @property
    def track(self) -> int:
        """The track that has moved least so far, from 0."""
        return int(np.argmin(self._sums[0]))

    @property
    def is_reference(self) -> bool:
        """Whether another track has moved, and far more than track 1."""
        most = float(self._sums[0].max()) / max(self._moments, 1)
        still = float(self._sums[0, 0]) / max(self._moments, 1)
        return most >= LEAST_MOTION_HZ**2 and most >= STEADIER * still

    def doubtful(self, time_s: float) -> Fault | None:
        """The fault of a track that moved against track 1 and was steadier over the whole tape."""
        if self._moments < MOMENTS or self._noise is None:
            return None
        mean, apart = self._sums / self._moments
        steadier = (mean < mean[0]) & (apart > MOVED * self._noise + LEAST_APART_HZ**2)
        if not steadier.any():
            return None
        return self._elsewhere(int(np.argmin(np.where(steadier, mean, np.inf))), time_s)

    def _elsewhere(self, steadiest: int, time_s: float) -> TapeFault:
        """The fault of a reference that is on another track."""
        name = track_name(steadiest, self._format.axes)
        moves_hz = np.sqrt(self._sums[0] / self._moments)
        return TapeFault(
            f"track 1 moves by {moves_hz[0]:.0f} Hz and track {steadiest + 1} ({name}) stands at "
            f"{moves_hz[steadiest]:.0f} Hz, so the reference is on track {steadiest + 1}, "
            f"found at {time_s:.3f} s, or "
            f"missing, and then no place can be known; "
            f"say which tracks are reference, {', '.join(axis.upper() for axis in self._format.axes)} "
            f"(--tracks {steadiest + 1},...)",
            time_s=time_s,
        )


# The order of the sums is free (reassoc, contract), so that they run in vectors.
@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def _frequencies(frames, clock, taps, found):  # type: ignore[no-untyped-def]
    """Fill the frequency of each track at some moments of a block (moments, tracks), Hz.

    Each is told by how far the phase turns in a row: the tracks go through a filter (re and im, taps) that
    begins at some frame, and through the same a row further on. `clock`: frames in a row, sample rate and
    reference, Hz.
    """
    step, sample_rate_hz, reference_hz = clock
    length, moments, rate_hz = taps.shape[1], len(found), sample_rate_hz / step
    spare = len(frames) - length - step
    seen, filtered = np.empty(length + step), np.empty((2, 2))
    for moment in range(moments):
        start = int(moment * (spare / (moments - 1))) if moment < moments - 1 else spare
        for track in range(frames.shape[1]):
            for k in range(len(seen)):
                seen[k] = frames[start + k, track]
            for late in range(2):
                re, im = 0.0, 0.0
                for k in range(length):
                    re += taps[0, k] * seen[late * step + k]
                    im += taps[1, k] * seen[late * step + k]
                filtered[late, 0], filtered[late, 1] = re, im
            (re, im), (re_after, im_after) = filtered[0], filtered[1]
            along, across = re * re_after + im * im_after, re * im_after - im * re_after
            # the taps do not turn along
            turned = math.atan2(across, along) / (2 * math.pi) - reference_hz / rate_hz
            found[moment, track] = reference_hz + (turned - np.rint(turned)) * rate_hz


@njit(cache=True, nogil=True)
def _add_squares(found, still_hz, sums):  # type: ignore[no-untyped-def]
    """Add the squares of frequencies (moments, tracks) against that at standstill, and against track 1."""
    for moment in range(len(found)):
        for track in range(found.shape[1]):
            sums[0, track] += (found[moment, track] - still_hz) ** 2
            sums[1, track] += (found[moment, track] - found[moment, 0]) ** 2
