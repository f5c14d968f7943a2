"""The pick-ups: displacement of the screws -> phase -> samples of the carrier tracks.

Signals: positions in mm in, one row per sample of the motion (6 kHz); frames out, float32 of full scale 1 or
16 bit, one row per sample of the tape (48 kHz), columns reference, X, Y, Z. Sample k of the motion stands at
frame 8 k of the carriers.

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
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from morfax.motion.arrays import Array
from morfax.motion.compiled import keeps_kinds, njit
from morfax.motion.usual import REFERENCE_HZ, SAMPLE_RATE_HZ, SAMPLES_PER_MOTION
from morfax.recorder.sound.source import Stored
from morfax.recorder.tape.lacing import (
    BARE,
    CHUNK_PERIODS,
    Beneath,
    LacingRoom,
    finish,
    lace,
    words_of,
)
from morfax.recorder.tape.pickups import DEFAULT_PICK_UP, PICK_UPS, SCREW, Sensor
from morfax.recorder.tape.waiting_rows import WaitingRows

FADE_FROM, FADE_TO = 0.4, 0.475  # of the sample rate, as drawn above
# P below: of 1, x², x⁴ and so on
SINE = (
    6.283182604981858, -16.20867137934099, 16.761003027494148, -9.53104500418581, 3.0589825640426778,
)  # fmt: skip
_HELD_BACK = 2  # samples behind the last frame that it needs: those that its cubic goes to
_NO_BITS = np.empty((0, 0))  # of a bare tape


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


class _Figures(NamedTuple):
    reference_cycles: float
    amplitudes: Array
    by_speed: bool


@keeps_kinds
class _Wave(_Figures):
    """The waves of the tracks: cycles of the reference in a period of the motion; amplitudes of the axes'
    harmonics, and whether they grow with the speed.
    """


class Carrier:
    """The carriers of one tape, block by block; at `start_mm` the tracks have the phase of the reference.

    `samples`: float32 of full scale 1, or int16.
    """

    def __init__(
        self, pick_up: PickUp, start_mm: ArrayLike, samples: type[np.generic] = np.float32
    ) -> None:
        self._pick_up, self._samples = pick_up, samples
        start = np.atleast_1d(np.asarray(start_mm, np.float64))
        self._axes = len(start)
        self.rows = WaitingRows(start, pick_up.cycles_per_mm)
        self.done = 0  # frames that are made
        sensor = pick_up.sensor
        # a track stays above two thirds of the reference
        lowest = 0.5 * pick_up.reference_hz / pick_up.sample_rate_hz
        harmonics = 1 if sensor.is_sine else int((FADE_TO / lowest + 1) / 2)
        amplitudes = pick_up.level * sensor.amplitudes(harmonics)
        self._wave = _Wave(pick_up.reference_cycles, amplitudes, sensor.by_speed)
        self._room = LacingRoom.of(1 + self._axes, pick_up.samples_per_motion)

    def frames(self, positions_mm: ArrayLike) -> Stored:
        """Frames (n, 1 + axes) from positions (n, axes) in mm; the last two samples are held back."""
        self.feed(positions_mm)
        return self.ready()

    def feed(self, positions_mm: ArrayLike) -> Array:
        """Take positions (n, axes) in mm; how far they are from the start, cycles, until more come."""
        positions = np.asarray(positions_mm, np.float64)
        if positions.ndim != 2 or positions.shape[1] != self._axes:
            raise ValueError(
                f"positions of shape {positions.shape} do not fit; give (n, {self._axes}) mm"
            )
        return self.rows.feed(positions)

    def ready(self) -> Stored:
        """All frames that can be made by now, without a check signal."""
        return self.until(self._frame_of(max(self.rows.end - _HELD_BACK, 0)))

    def rest(self) -> Stored:
        """The last frames: the screws stand at the last position."""
        return self.until(self.whole)

    @property
    def whole(self) -> int:
        """The frames of a tape that ends with the rows that have come."""
        return self._frame_of(self.rows.end)

    def _frame_of(self, row: int) -> int:
        """The frame at which a row stands."""
        return row * self._pick_up.samples_per_motion

    def until(self, frame: int, beneath: Beneath = BARE, bits: Array = _NO_BITS) -> Stored:
        """The frames from those that are made to one, with the check signal beneath the periods that they
        are in, and what its tracks say there (symbols, tracks).
        """
        steps, tracks = self._pick_up.samples_per_motion, 1 + self._axes
        first, end = self.done // steps, -(-frame // steps)
        frames = np.empty(((end - first) * steps, tracks), self._samples)
        if len(frames):
            rows = self.rows.around(first - 1, end + _HELD_BACK)
            words = words_of(frames)
            _write(rows, first, self._wave, beneath, bits, self._room, frames, words)
        frames = frames[self.done - first * steps :][: frame - self.done]
        self.done = frame
        self.rows.drop(frame // steps - 1)
        return frames


@njit(cache=True, nogil=True, _nrt=False)
def _write(rows, first_period, wave, beneath, bits, room, frames, words):  # type: ignore[no-untyped-def]
    """Fill frames (periods · steps, 1 + axes) from displacements (periods + 3, axes) in cycles.

    A track at a time, and in it one of the steps of many periods at a time (lacing.py).
    """
    reference_cycles, amplitudes, by_speed = wave
    periods, axes = rows.shape[0] - 3, rows.shape[1]
    steps, in_16_bit = frames.shape[0] // periods, frames.itemsize == 2
    columns, turned, cubics = room.columns, room.turned, room.cubics
    c0, c1, c2, c3 = cubics[0], cubics[1], cubics[2], cubics[3]
    as_they_are = not in_16_bit and len(beneath.waves) == 0
    # all periods of the reference are alike, and so are those of an axis that stands
    is_even = np.floor(reference_cycles) == reference_cycles
    room.stands[:] = False
    for first in range(0, periods, CHUNK_PERIODS):
        count = min(CHUNK_PERIODS, periods - first)
        _turned(first_period + first, reference_cycles, turned)
        if first == 0 or not is_even:
            c1[:], c2[:], c3[:] = reference_cycles / steps, 0.0, 0.0
            for k in range(steps):
                _sines(turned, c1, c2, c3, float(k), amplitudes[0], columns[0, k])
        for axis in range(axes):
            places, stood = rows[first : first + count + 3, axis], room.stands[axis]
            room.stands[axis] = is_even and _are_alike(places)
            if stood and room.stands[axis]:
                continue  # its columns are those of the periods before
            _cubics(places, reference_cycles, turned, cubics)
            for k in range(steps):
                column = columns[1 + axis, k]
                if len(amplitudes) == 1 and not by_speed:
                    _sines(c0, c1, c2, c3, k / steps, amplitudes[0], column)
                else:
                    _waves((c0, c1, c2, c3), k / steps, steps, wave, column)
        if not as_they_are:
            finish(room, first, count, beneath, bits, in_16_bit)
        laced, span = columns if as_they_are else room.finished, first * steps
        piece = slice(span, span + count * steps)
        lace(laced, room.packed, frames[piece], words[piece])


@njit(cache=True, nogil=True, _nrt=False)
def _are_alike(places):  # type: ignore[no-untyped-def]
    """Whether all are the same number."""
    others = 0
    for k in range(len(places)):
        others += places[k] != places[0]
    return others == 0


@njit(cache=True, nogil=True, _nrt=False)
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


@njit(cache=True, nogil=True, _nrt=False)
def _cubics(cycles, reference_cycles, turned, cubics):  # type: ignore[no-untyped-def]
    """The phase of an axis in each period as a cubic, from its displacements and the reference's phase."""
    c0, c1, c2, c3 = cubics[0], cubics[1], cubics[2], cubics[3]
    for i in range(len(cycles) - 3):
        p0, p1, p2, p3 = cycles[i], cycles[i + 1], cycles[i + 2], cycles[i + 3]
        c0[i] = turned[i] + (p1 - np.floor(p1))
        slope, c2[i], c3[i] = _cubic(p0, p1, p2, p3)
        c1[i] = slope + reference_cycles


# Rounded once where it multiplies and adds (contract): no sample of 16 bit is another one by that.
@njit(cache=True, nogil=True, _nrt=False, fastmath={"contract"})
def _sines(c0, c1, c2, c3, u, level, column):  # type: ignore[no-untyped-def]
    """The samples of a track at the same place of each period."""
    for i in range(len(column)):
        column[i] = level * sine(c0[i] + u * (c1[i] + u * (c2[i] + u * c3[i])))


@njit(cache=True, nogil=True, _nrt=False)
def _waves(cubic, u, steps, wave, column):  # type: ignore[no-untyped-def]
    """The same of a wave with harmonics, with so many steps in a period."""
    (c0, c1, c2, c3), (reference_cycles, amplitudes, by_speed) = cubic, wave
    for i in range(len(column)):
        # cycles per period: the frequency of the track
        speed = c1[i] + u * (2.0 * c2[i] + u * 3.0 * c3[i])
        cycles = c0[i] + u * (c1[i] + u * (c2[i] + u * c3[i]))
        sample = _wave(cycles, abs(speed) / steps, amplitudes)
        column[i] = sample * speed / reference_cycles if by_speed else sample


@njit(cache=True, inline="always")
def _wave(cycles, frequency, amplitudes):  # type: ignore[no-untyped-def]
    """Sum of the odd harmonics at a phase; the frequency (over the sample rate) fades the high ones out."""
    fundamental = sine(cycles)
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
def sine(cycles):  # type: ignore[no-untyped-def]
    """sin(2 pi cycles) within 1.1e-7, for a few cycles or fewer.

    x (1 - 4 x²) P(x²) on -1/2 ... 1/2, with P fitted at Chebyshev's points to sin(2 pi x) / (x (1 - 4 x²)):
    it vanishes where the sine does, and needs no table and no branch, so that the compiler makes several at a
    time.
    """
    x = cycles - np.rint(cycles)
    t = x * x
    a, b, c, d, e = SINE
    return x * (1.0 - 4.0 * t) * (a + t * (b + t * (c + t * (d + t * e))))
