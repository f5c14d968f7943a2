"""Discriminator: the phases of the X, Y and Z tracks against the reference track, in cycles, at the motion rate.

Signals in: frames of the tape, float32 (n, tracks), track 1 the reference, at the sample rate. Signals out, one row
per `decimation` frames, row i standing at frame i·decimation: cycles (axes), levels (tracks, amplitude), surprise
(axes, cycles: how far a phase lay from the predicted one).

    y(t) = sum over n of  h(n) · exp(-j w n) · x(t + n)          translating filter: h low-pass, w the nominal reference
    cycles = arg( y_axis · conj(y_reference) ) / 2 pi            counted on from the predictor's guess, nearest turn

Both tracks are translated by the same w, so its phase and any error of the tape's speed cancel in the product, and
only the difference is left. It is a phase all the way: nothing is integrated, so nothing drifts. The filter stands
symmetrically about its frame, so the time axis is the tape's own. The rows at the two ends, whose filter would reach
past the tape, hold the nearest full one (the tape stands still there).

The low-pass is 0.6 dB down at 2 kHz from the carrier, 6 dB at 3 kHz and 80 dB from 5 kHz on, which keeps out what the
decimation would fold upon the carrier: its own mirror (12 kHz away), a DC offset and the second harmonic (6 kHz
away). With a lower reference it is as much narrower and longer.

The predictor (position, velocity, acceleration; three equal poles) only chooses the turn; the phase itself is not
smoothed by it.

        position        += (1 - theta³) surprise                      theta = exp(-2 pi f dt)
        velocity · dt   += 1.5 (1 - theta²)(1 - theta) surprise
        acc. · dt² / 2  += 0.5 (1 - theta)³ surprise

Source: patent ES 361967, figure 5 (amplifiers 151, triggers 152, the tape's side of comparator 153). Predictor: E.
Brookner, Tracking and Kalman Filtering Made Easy, 1998, section 1.3 (fading-memory filter).
Questions: the patent compares edges, at best one per cycle of the carrier; here the whole wave is used, which is what
beats the tape's noise. A square-wave trigger would be a hundred times coarser.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

PREDICTOR_HZ = 120.0
STOP_BAND_BETA = 8.0  # Kaiser: stop band 80 dB down
SMALLEST_TAP = 1e-12  # below it products are denormal numbers, which cost a factor of twelve
CHUNK_ROWS = 512  # what the kernel has in the processor's cache at a time

Float32s = NDArray[np.float32]
Float64s = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Phases:
    """A block of rows at the motion rate; row 0 is row `first_row` of the tape."""

    first_row: int
    cycles: Float64s
    surprise: Float32s
    levels: Float32s

    def __len__(self) -> int:
        return len(self.cycles)


def translating_taps(sample_rate_hz: float, reference_hz: float, decimation: int) -> tuple[Float32s, Float32s]:
    """Real and imaginary taps of the filter that moves the reference to 0 Hz and keeps what lies near it."""
    cut_hz = min(sample_rate_hz / decimation, reference_hz) / 2
    half = round(2 * sample_rate_hz / cut_hz)
    n = np.arange(-half, half + 1)
    low_pass = np.sinc(2 * cut_hz / sample_rate_hz * n) * np.kaiser(2 * half + 1, STOP_BAND_BETA)
    taps = low_pass / low_pass.sum() * np.exp(-2j * np.pi * reference_hz / sample_rate_hz * n)
    parts = np.array([taps.real, taps.imag])
    parts[np.abs(parts) < SMALLEST_TAP] = 0.0
    return parts[0].astype(np.float32), parts[1].astype(np.float32)


def predictor_gains(rate_hz: float, natural_hz: float = PREDICTOR_HZ) -> Float64s:
    """Shares of the surprise that go to position, velocity per row and half acceleration per row²."""
    theta = math.exp(-2 * math.pi * natural_hz / rate_hz)
    return np.array([1 - theta**3, 1.5 * (1 - theta**2) * (1 - theta), 0.5 * (1 - theta) ** 3])


class Discriminator:
    """Tracks in, phases out, block by block of any length."""

    def __init__(self, sample_rate_hz: float, reference_hz: float, decimation: int, tracks: int) -> None:
        if not 0 < reference_hz < sample_rate_hz / 2:
            raise ValueError(
                f"reference of {reference_hz:g} Hz cannot be on a tape of {sample_rate_hz:g} samples/s; "
                f"give one between 0 and {sample_rate_hz / 2:g} Hz"
            )
        if tracks < 2:
            raise ValueError(f"{tracks} track(s) hold no displacement; give the reference track and at least one axis")
        self.decimation = decimation
        self._taps_re, self._taps_im = translating_taps(sample_rate_hz, reference_hz, decimation)
        self._half = len(self._taps_re) // 2
        self._gains = predictor_gains(sample_rate_hz / decimation)
        self._state = np.full((tracks - 1, 3), np.nan)
        self._tail = np.zeros((0, tracks), np.float32)
        self._tail_frame = 0  # the tape's frame at which the tail begins
        self._row = 0  # the next row to come out
        self._last: Phases | None = None

    @property
    def filter_frames(self) -> int:
        """Length of the translating filter, frames."""
        return len(self._taps_re)

    def feed(self, frames: Float32s) -> Phases:
        """Take the next frames (n, tracks) of the tape; the rows that are complete by now, perhaps none."""
        frames = np.concatenate([self._tail, frames]) if len(self._tail) else frames
        frames = np.ascontiguousarray(frames, dtype=np.float32)
        row = max(self._row, -(-self._half // self.decimation))
        skipped = row * self.decimation - self._half - self._tail_frame
        count = max((len(frames) - skipped - len(self._taps_re)) // self.decimation + 1, 0)
        keep = skipped + count * self.decimation if count else 0
        self._tail, self._tail_frame = frames[keep:].copy(), self._tail_frame + keep
        if not count:
            return self._held(0)
        phases = self._demodulated(frames[skipped:], count, row)
        self._row, self._last = row + count, phases
        return phases

    def finish(self) -> Phases:
        """The rows at the end of the tape that the filter could not fill: the last one held."""
        return self._held(-(-(self._tail_frame + len(self._tail)) // self.decimation) - self._row)

    def _demodulated(self, frames: Float32s, count: int, row: int) -> Phases:
        """Run the kernel; before the tape's first full row that row is held."""
        tracks = frames.shape[1]
        cycles = np.empty((count, tracks - 1))
        surprise = np.empty((count, tracks - 1), np.float32)
        levels = np.empty((count, tracks), np.float32)
        _demodulate(
            frames, self._taps_re, self._taps_im, self.decimation, self._gains, self._state, cycles, surprise, levels
        )
        lead = ((row - self._row, 0), (0, 0))
        if row > self._row:
            cycles = np.pad(cycles, lead, mode="edge")
            surprise, levels = np.pad(surprise, lead, mode="edge"), np.pad(levels, lead, mode="edge")
        return Phases(self._row, cycles, surprise, levels)

    def _held(self, count: int) -> Phases:
        """The last row, `count` times over."""
        tracks = self._tail.shape[1]
        if self._last is None:
            empty = np.zeros((0, tracks - 1))
            return Phases(0, empty, empty.astype(np.float32), np.zeros((0, tracks), np.float32))
        cycles = np.repeat(self._last.cycles[-1:], count, axis=0)
        surprise = np.repeat(self._last.surprise[-1:], count, axis=0)
        return Phases(self._row, cycles, surprise, np.repeat(self._last.levels[-1:], count, axis=0))


def discriminate(blocks: Iterable[Float32s], discriminator: Discriminator) -> Iterator[Phases]:
    """Phases of a whole tape, from its blocks of frames; blocks without a row are left out."""
    for frames in blocks:
        phases = discriminator.feed(frames)
        if len(phases):
            yield phases
    rest = discriminator.finish()
    if len(rest):
        yield rest


@njit(cache=True, nogil=True)
def _demodulate(frames, taps_re, taps_im, decimation, gains, state, cycles, surprise, levels):  # type: ignore[no-untyped-def]
    """Fill `cycles`, `surprise` and `levels` from frames, the first filter beginning at frame 0."""
    tracks = frames.shape[1]
    lines = np.zeros((tracks, decimation, CHUNK_ROWS + len(taps_re) // decimation + 1), np.float32)
    re, im = np.empty((tracks, CHUNK_ROWS), np.float32), np.empty((tracks, CHUNK_ROWS), np.float32)
    for first in range(0, len(cycles), CHUNK_ROWS):
        last = min(first + CHUNK_ROWS, len(cycles))
        _unlace(frames[first * decimation :], lines)
        for track in range(tracks):
            _translate(lines[track], taps_re, taps_im, re[track, : last - first], im[track, : last - first])
            for k in range(last - first):
                levels[first + k, track] = 2 * math.sqrt(re[track, k] ** 2 + im[track, k] ** 2)
        _count(re, im, gains, state, cycles[first:last], surprise[first:last])


@njit(cache=True, nogil=True)
def _unlace(frames, lines):  # type: ignore[no-untyped-def]
    """Lay frames (n, tracks) out as (track, frame within a row, row), so that a tap meets its samples side by side."""
    tracks, decimation, rows = lines.shape
    for row in range(min(rows, len(frames) // decimation)):
        for i in range(decimation):
            for track in range(tracks):
                lines[track, i, row] = frames[row * decimation + i, track]
    for i in range(len(frames) % decimation):
        if len(frames) // decimation < rows:
            for track in range(tracks):
                lines[track, i, len(frames) // decimation] = frames[len(frames) // decimation * decimation + i, track]


# The order of the sum is free (reassoc, contract), so that it runs in vectors; nan and inf keep their meaning.
@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def _translate(line, taps_re, taps_im, re, im):  # type: ignore[no-untyped-def]
    """Filter one track's line (frame within a row, row) with complex taps, one output per row."""
    decimation = line.shape[0]
    re[:] = 0
    im[:] = 0
    for n in range(len(taps_re)):
        tap_re, tap_im = taps_re[n], taps_im[n]
        samples = line[n % decimation, n // decimation : n // decimation + len(re)]
        for k in range(len(re)):
            re[k] += tap_re * samples[k]
            im[k] += tap_im * samples[k]


@njit(cache=True, nogil=True)
def _count(re, im, gains, state, cycles, surprise):  # type: ignore[no-untyped-def]
    """Phases of tracks 1… against track 0, counted on by the predictor; `state` (axes, 3) is carried."""
    for axis in range(len(state)):
        place, speed, bend = state[axis]  # cycles, cycles/row, half of cycles/row²
        for k in range(len(cycles)):
            x_re, x_im = float(re[axis + 1, k]), float(im[axis + 1, k])
            r_re, r_im = float(re[0, k]), float(im[0, k])
            phase = math.atan2(x_im * r_re - x_re * r_im, x_re * r_re + x_im * r_im) / (2 * math.pi)
            if math.isnan(place):  # the first row of the tape
                place, speed, bend = phase, 0.0, 0.0
            place, speed = place + speed + bend, speed + 2 * bend
            error = phase - place
            error -= np.rint(error)
            cycles[k, axis] = place + error
            surprise[k, axis] = error
            place += gains[0] * error
            speed += gains[1] * error
            bend += gains[2] * error
        state[axis, 0], state[axis, 1], state[axis, 2] = place, speed, bend
