"""The wear of a signal's strength by tape and amplifiers; each part works block by block with its own memory.

Signals: frames float32 (n, tracks), full scale 1, in and out. Every part gives the same frames however the
tape is cut into blocks: a filter carries its state, a random part draws in the order of the frames.

    print-through    y(n) = x(n) + g x(n - d) + g x(n + d)    d one turn of the reel
    distortion       y = x - 4 h (x³ / peak² - 3/4 x)     h third harmonic over the fundamental, at the peak
    dropouts         gain 1 ... depth ... 1 with flanks of 0.1 ms; a Poisson process, lengths log-normal
    level            gain by tones of 0.2 to 8 Hz, on each track its own

Source: IEC 60094 (tape recording: print-through, crosstalk, dropouts, distortion at reference level).
Questions: saturation also compresses and shifts the bias; only the third harmonic is made, which is what is
left of it in the band of the carriers' neighbours.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, sosfilt

from morfax.motion.arrays import Array
from morfax.recorder.wear.timebase import Tones

FLANK_S = 1e-4  # of a dropout
UNEVEN_HZ = (0.2, 8.0)  # of the tones of the level
TELEPHONE_ORDER = 8  # 39 dB down at 6 kHz; chosen
HIGHEST = 0.49  # of the sample rate: no filter ends higher; chosen
SPREAD = 0.5  # of the logarithm of a dropout's length


Frames = NDArray[np.float32]


def gain(db: float) -> float:
    """The amplitude ratio of a level in decibels."""
    return float(10 ** (db / 20))


class PrintThrough:
    """The neighbouring layers of the reel, heard before and after; one turn is held back."""

    def __init__(self, level: float, frames: int, tracks: int) -> None:
        self._level, self._delay = np.float32(level), frames
        self._held = np.zeros((frames, tracks), np.float32)

    def feed(self, frames: Frames) -> Frames:
        """The next frames of the output."""
        held = np.concatenate([self._held, frames])
        self._held = held[-2 * self._delay :]
        count = max(len(held) - 2 * self._delay, 0)
        middle = held[self._delay : self._delay + count]
        return middle + self._level * (
            held[:count] + held[2 * self._delay : 2 * self._delay + count]
        )

    def rest(self) -> Frames:
        """The last turn, after which there is blank tape."""
        return self.feed(np.zeros((self._delay, self._held.shape[1]), np.float32))


class BandLimit:
    """Filters of the second order on all tracks, one after the other."""

    def __init__(self, sections: Array, tracks: int) -> None:
        self._sos = sections
        self._state = np.zeros((len(sections), 2, tracks))

    @classmethod
    def below(cls, hz: float, rate_hz: float, tracks: int) -> BandLimit:
        """A low-pass of the second order."""
        return cls(butter(2, min(hz, HIGHEST * rate_hz), fs=rate_hz, output="sos"), tracks)

    @classmethod
    def telephone(cls, band_hz: tuple[float, float], rate_hz: float, tracks: int) -> BandLimit:
        """A steep band-pass of the eighth order at either end, as of a telephone line."""
        edges = (band_hz[0], min(band_hz[1], HIGHEST * rate_hz))
        return cls(butter(TELEPHONE_ORDER, edges, "bandpass", fs=rate_hz, output="sos"), tracks)

    def feed(self, frames: Frames) -> Frames:
        """The next frames of the output."""
        out, self._state = sosfilt(self._sos, frames, axis=0, zi=self._state)
        return np.asarray(out, np.float32)


@dataclass(frozen=True, slots=True)
class Dropout:
    """A dropout: start and length in s of programme time, gain left, track (-1: all)."""

    start_s: float
    length_s: float
    left: float
    track: int


class Dropouts:
    """Dropouts at random places, drawn in the order of the tape; `met` are those so far."""

    def __init__(
        self,
        per_minute: float,
        length_s: float,
        left: float,
        all_tracks: bool,
        seed: tuple[int, int],
    ) -> None:
        self._every_s, self._length_s, self._left = 60 / per_minute, length_s, left
        self._all, self._random = all_tracks, np.random.default_rng(seed)
        self._next = self._drawn(0.0)
        self.met: list[Dropout] = []

    def _drawn(self, after_s: float) -> Dropout:
        """The next dropout after a moment."""
        start_s = after_s + self._random.exponential(self._every_s)
        length_s = self._length_s * float(np.exp(self._random.normal(0, SPREAD)))
        track = self._random.random()
        return Dropout(start_s, length_s, self._left, -1 if self._all else int(track * 2**20))

    def gains(self, first_s: float, count: int, rate_hz: float, tracks: int) -> Array | None:
        """Gains (count, tracks) of a block; None for a block without a dropout."""
        last_s = first_s + count / rate_hz
        while self._next.start_s < last_s:
            self.met.append(self._next)
            self._next = self._drawn(self._next.start_s + self._next.length_s)
        near = [d for d in self.met[-1000:] if d.start_s + d.length_s + FLANK_S > first_s]
        if not near:
            return None
        gains = np.ones((count, tracks))
        t_s = first_s + np.arange(count) / rate_hz
        for dropout in near:
            inside = (
                np.minimum(t_s - dropout.start_s, dropout.start_s + dropout.length_s - t_s)
                / FLANK_S
            )
            curve = 1 - (1 - dropout.left) * np.clip(inside + 0.5, 0, 1)
            columns = slice(None) if dropout.track < 0 else [dropout.track % tracks]
            gains[:, columns] *= curve[:, None]
        return gains


class Unevenness:
    """The level of each track, rising and falling slowly by this many dB RMS."""

    def __init__(self, db: float, tracks: int, seed: tuple[int, int]) -> None:
        random = np.random.default_rng(seed)
        self._tones = [Tones.drawn(db, UNEVEN_HZ, random) for _ in range(tracks)]

    def gains(self, first: int, count: int, rate_hz: float) -> Array:
        """Gains (count, tracks) of a block."""
        t_s = np.arange(first, first + count) / rate_hz
        knots = np.arange(first // 64, (first + count) // 64 + 2) * (64 / rate_hz)
        return np.column_stack(
            [
                10 ** (np.interp(t_s, knots, tones.value(knots.astype(np.float64))) / 20)
                for tones in self._tones
            ]
        )


def distorted(frames: Frames, share: float, peak: float) -> Frames:
    """Frames with a third harmonic of this share at a carrier of this peak."""
    return np.asarray(frames - 4 * share * (frames**3 / peak**2 - 0.75 * frames), np.float32)


def crosstalk(level: float, tracks: int) -> Frames:
    """Crosstalk matrix: each track hears its neighbours at `level`, the next ones at its square."""
    apart = np.abs(np.subtract.outer(np.arange(tracks), np.arange(tracks)))
    return np.asarray(level**apart, np.float32)


def hum(first: int, count: int, rate_hz: float, hz: float, level: float) -> Array:
    """Hum with a third harmonic at a third of it, peak `level`."""
    w_t = 2 * np.pi * hz * np.arange(first, first + count) / rate_hz
    return np.asarray(level * (0.75 * np.sin(w_t) + 0.25 * np.sin(3 * w_t)))
