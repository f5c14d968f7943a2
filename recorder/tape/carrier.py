"""The pick-ups: displacement of the screws -> phase -> samples of the carrier tracks.

Signals: positions in mm in, one row per sample of the motion (6 kHz); frames in float32 out, full scale 1,
one row per sample of the tape (48 kHz), columns reference, X, Y, Z. Sample k of the motion stands at frame 8
k of the carriers.

    phase of the reference = reference · t                                    (cycles)
    phase of a track       = phase of the reference + (position - start) / q  (cycles), q = 1 / cycles per mm
    sample                 = level · sin(2 pi phase)        (or the wave of another pick-up, see pickups.py)

The sector wheel turns at a constant speed, so the phase of the reference follows from the count of samples
alone, and that of a track from the absolute position: nothing is summed up, and nothing drifts. Between two
samples of the motion the phase is a Catmull-Rom cubic, whose slope at each sample is that from its left to
its right neighbour; this leaves no images of the motion rate and no kink in the phase:

    position     p0      p1 ~~~~~~~ p2      p3     frames between p1 and p2 need p0 and p3: the carrier
    motion        |-------|----x----|-------|      holds back two samples from one block to the next

A wave with harmonics is summed up harmonic by harmonic. Each fades out by its own frequency at the moment,
before half the sample rate, so that nothing folds back upon the carrier:

    weight  1 _________                        frequency of the harmonic over the sample rate
                       ╲_____ 0                0.4 ... 0.475

Source: patent ES 361967, figures 2 and 4 (sector wheel 115, motor 116, lamp 119, photocell 141 on arm 118).
Questions: the patent's photocell gives a square wave; recorded sample by sample it aliases (0.16 cycle of
error), so it is band-limited here, and the wave is the sine of a resolver, which the patent names as an
equivalent, unless asked.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from morfax.motion.compiled import njit
from morfax.motion.usual import REFERENCE_HZ, SAMPLE_RATE_HZ, SAMPLES_PER_MOTION
from morfax.recorder.tape.pickups import DEFAULT_PICK_UP, PICK_UPS, SCREW, Sensor

FADE_FROM, FADE_TO = 0.4, 0.475  # of the sample rate, as drawn above
# samples that the next frames still need: the neighbour before, and two not yet played
_HELD_BACK = 3
ROWS_AT_ONCE = 8
CHUNK_PERIODS = 64  # made at a time: they stay in the processor's first cache

Frames = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class PickUp:
    """The figures of wheel and screw; `level` is the amplitude of the fundamental, full scale 1."""

    reference_hz: float = REFERENCE_HZ
    cycles_per_mm: float = SCREW.cycles_per_mm
    sample_rate_hz: int = SAMPLE_RATE_HZ
    samples_per_motion: int = SAMPLES_PER_MOTION
    level: float = 0.5
    sensor: Sensor = PICK_UPS[DEFAULT_PICK_UP]

    @property
    def reference_cycles(self) -> float:
        """Cycles of the reference in one period of the motion rate."""
        return self.reference_hz * self.samples_per_motion / self.sample_rate_hz


class Carrier:
    """The carriers of one tape, block by block; at `start_mm` the tracks have the phase of the reference."""

    def __init__(self, pick_up: PickUp, start_mm: ArrayLike) -> None:
        self._pick_up = pick_up
        self._start_mm = np.atleast_1d(np.asarray(start_mm, np.float64))
        self._starts_mm = np.tile(self._start_mm, ROWS_AT_ONCE)
        self._held = np.empty((0, len(self._start_mm)))  # displacement in cycles
        self._periods = 0
        # a track stays above two thirds of the reference
        lowest = 0.5 * pick_up.reference_hz / pick_up.sample_rate_hz
        self._harmonics = int((FADE_TO / lowest + 1) / 2)

    def frames(self, positions_mm: ArrayLike) -> Frames:
        """Frames (n, 1 + axes) from positions (n, axes) in mm; the last two samples are held back."""
        return self.frames_of(self.displacements(positions_mm))

    def displacements(self, positions_mm: ArrayLike) -> NDArray[np.float64]:
        """How far positions (n, axes) in mm are from the start, cycles."""
        positions = np.ascontiguousarray(positions_mm, np.float64)
        if positions.ndim != 2 or positions.shape[1] != len(self._start_mm):
            raise ValueError(
                f"positions of shape {positions.shape} do not fit; give (n, {len(self._start_mm)}) mm"
            )
        cycles = np.empty(positions.shape)
        cycles_per_mm = self._pick_up.cycles_per_mm
        _displace(positions.ravel(), self._starts_mm, cycles_per_mm, cycles.ravel())
        return cycles

    def frames_of(self, cycles: NDArray[np.float64]) -> Frames:
        """Frames as `frames` makes them, from displacements in cycles."""
        if not len(self._held):
            # the screws stood at the first position before
            cycles = np.vstack([cycles[:1], cycles])
        return self._synthesise(np.vstack([self._held, cycles]))

    def rest(self) -> Frames:
        """The last frames: the screws stand at the last position."""
        if not len(self._held):
            return np.empty((0, 1 + len(self._start_mm)), np.float32)
        return self._synthesise(np.vstack([self._held, self._held[-1:], self._held[-1:]]))

    def _synthesise(self, cycles: NDArray[np.float64]) -> Frames:
        """Frames of all periods but the first and the last two samples, which are held."""
        pick_up, tracks = self._pick_up, 1 + len(self._start_mm)
        periods = max(0, len(cycles) - _HELD_BACK)
        frames = np.empty((periods * pick_up.samples_per_motion, tracks), np.float32)
        turning = self._periods, pick_up.reference_cycles
        if periods and pick_up.sensor.is_sine:
            _write(cycles, *turning, pick_up.level, frames)
        elif periods:
            amplitudes = pick_up.level * pick_up.sensor.amplitudes(self._harmonics)
            _write_wave(cycles, *turning, amplitudes, pick_up.sensor.by_speed, frames)
        self._held = cycles[periods:].copy()
        self._periods += periods
        return frames


@njit(cache=True, nogil=True)
def _displace(positions_mm, start_mm, cycles_per_mm, cycles):  # type: ignore[no-untyped-def]
    """Fill the displacements of positions, row after row; as many at once as `start_mm` is long."""
    for first in range(0, len(positions_mm), len(start_mm)):
        for k in range(min(len(start_mm), len(positions_mm) - first)):
            cycles[first + k] = (positions_mm[first + k] - start_mm[k]) * cycles_per_mm


@njit(cache=True, nogil=True)
def _write(cycles, first_period, reference_cycles, level, frames):  # type: ignore[no-untyped-def]
    """Fill frames (periods · steps, 1 + axes) from displacements (periods + 3, axes) in cycles.

    A track at a time, and in it one of the steps of many periods at a time: these lie side by side in memory,
    so that the compiler makes several sines at once.
    """
    periods, axes = cycles.shape[0] - 3, cycles.shape[1]
    steps = frames.shape[0] // periods
    columns = np.empty((axes + 1, steps, CHUNK_PERIODS), np.float32)
    is_even = (
        np.floor(reference_cycles) == reference_cycles
    )  # all periods of the reference are alike
    turned = np.empty(CHUNK_PERIODS)
    c0, c1 = np.empty(CHUNK_PERIODS), np.empty(CHUNK_PERIODS)
    c2, c3 = np.empty(CHUNK_PERIODS), np.empty(CHUNK_PERIODS)
    for first in range(0, periods, CHUNK_PERIODS):
        count = min(CHUNK_PERIODS, periods - first)
        _turned(first_period + first, reference_cycles, turned)
        if first == 0 or not is_even:
            c1[:], c2[:], c3[:] = reference_cycles / steps, 0.0, 0.0
            for k in range(steps):
                _sines(turned, c1, c2, c3, float(k), level, columns[0, k])
        for axis in range(axes):
            c0[:] = turned
            _cubics(cycles[first : first + count + 3, axis], reference_cycles, c0, c1, c2, c3)
            for k in range(steps):
                _sines(c0, c1, c2, c3, k / steps, level, columns[1 + axis, k])
        _lace(columns, frames[first * steps : (first + count) * steps])


@njit(cache=True, nogil=True)
def _turned(first_period, reference_cycles, turned):  # type: ignore[no-untyped-def]
    """The phase of the reference at the start of each period, 0 to 1 cycle."""
    for i in range(len(turned)):
        cycles = (first_period + i) * reference_cycles
        turned[i] = cycles - np.floor(cycles)


@njit(cache=True, inline="always")
def _cubic(p0, p1, p2, p3):  # type: ignore[no-untyped-def]
    """The cubic from p1 to p2 that has half of what lies about it for its slopes: of u, u² and u³."""
    return (
        0.5 * (p2 - p0),
        p0 - 2.5 * p1 + 2.0 * p2 - 0.5 * p3,
        0.5 * (p3 - p0) + 1.5 * (p1 - p2),
    )


@njit(cache=True, nogil=True)
def _cubics(cycles, reference_cycles, c0, c1, c2, c3):  # type: ignore[no-untyped-def]
    """The phase of an axis in each period as a cubic; the phase of the reference is in `c0` already."""
    for i in range(len(cycles) - 3):
        p0, p1, p2, p3 = cycles[i], cycles[i + 1], cycles[i + 2], cycles[i + 3]
        c0[i] += p1 - np.floor(p1)
        slope, c2[i], c3[i] = _cubic(p0, p1, p2, p3)
        c1[i] = slope + reference_cycles


@njit(cache=True, nogil=True)
def _sines(c0, c1, c2, c3, u, level, column):  # type: ignore[no-untyped-def]
    """The samples of a track at the same place of each period."""
    for i in range(len(column)):
        column[i] = level * _sine(c0[i] + u * (c1[i] + u * (c2[i] + u * c3[i])))


@njit(cache=True, nogil=True)
def _lace(columns, frames):  # type: ignore[no-untyped-def]
    """Put columns (tracks, steps, periods) beside each other as frames."""
    tracks, steps = columns.shape[0], columns.shape[1]
    for track in range(tracks):
        for k in range(steps):
            column = columns[track, k]
            for i in range(len(frames) // steps):
                frames[i * steps + k, track] = column[i]


@njit(cache=True, nogil=True)
def _write_wave(cycles, first_period, reference_cycles, amplitudes, by_speed, frames):  # type: ignore[no-untyped-def]
    """Fill frames as `_write` does, the tracks of the axes with a wave of odd harmonics."""
    periods, axes = cycles.shape[0] - 3, cycles.shape[1]
    steps = frames.shape[0] // periods
    for i in range(periods):
        turned = (first_period + i) * reference_cycles
        turned -= np.floor(turned)
        for k in range(steps):
            frames[i * steps + k, 0] = amplitudes[0] * _sine(
                turned + k * (reference_cycles / steps)
            )
        for j in range(axes):
            p0, p1, p2, p3 = cycles[i, j], cycles[i + 1, j], cycles[i + 2, j], cycles[i + 3, j]
            c0 = turned + (p1 - np.floor(p1))
            slope, c2, c3 = _cubic(p0, p1, p2, p3)
            c1 = slope + reference_cycles
            for k in range(steps):
                u = k / steps
                speed = c1 + u * (
                    2.0 * c2 + u * 3.0 * c3
                )  # cycles per period: the frequency of the track
                wave = _wave(c0 + u * (c1 + u * (c2 + u * c3)), abs(speed) / steps, amplitudes)
                frames[i * steps + k, 1 + j] = (
                    wave * speed / reference_cycles if by_speed else wave
                )


@njit(cache=True, inline="always")
def _wave(cycles, frequency, amplitudes):  # type: ignore[no-untyped-def]
    """Sum of the odd harmonics at a phase; the frequency (over the sample rate) fades the high ones out."""
    fundamental = _sine(cycles)
    before, now = -fundamental, fundamental
    # of the doubled phase; sin((n + 2) x) = 2 cos 2x sin nx - ...
    twice_cosine = 2.0 - 4.0 * fundamental * fundamental
    wave = 0.0
    for k in range(len(amplitudes)):
        fade = ((2 * k + 1) * frequency - FADE_FROM) / (FADE_TO - FADE_FROM)
        if fade >= 1.0:
            break
        fade = max(fade, 0.0)
        wave += amplitudes[k] * now * (1.0 - fade * fade * (3.0 - 2.0 * fade))
        before, now = now, twice_cosine * now - before
    return wave


@njit(cache=True, inline="always")
def _sine(cycles):  # type: ignore[no-untyped-def]
    """sin(2 pi cycles) within 1.1e-7, for a few cycles or fewer.

    x (1 - 4 x²) P(x²) on -1/2 ... 1/2, with P fitted at Chebyshev's points to sin(2 pi x) / (x (1 - 4 x²)):
    it vanishes where the sine does, and needs no table and no branch, so that the compiler makes several at a
    time.
    """
    x = cycles - np.floor(cycles + 0.5)
    t = x * x
    p = 16.761003027494148 + t * (-9.53104500418581 + t * 3.0589825640426778)
    return x * (1.0 - 4.0 * t) * (6.283182604981858 + t * (-16.20867137934099 + t * p))
