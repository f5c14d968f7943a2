"""The time base of a worn transport: which moment of the programme passes the head of each track at a moment
of play.

Signals: time of play in s in; programme time in s out, per track; and frames read off at those moments.

    programme(t, track) = (1 + speed) t + sum over tones of  a / (2 pi f) · (sin(2 pi f t + phi) - sin phi)
                          - track · (skew + weave(t))

The flutter is a sum of tones, so its displacement has a closed form and never drifts; a third of the tones
each lie in the bands of wow, flutter and scrape, evenly over the logarithm of the frequency, each at a random
phase:

    wow 0.5 ... 4 Hz        flutter 4 ... 100 Hz        scrape 100 ... 2000 Hz

Frames between the samples are read by a windowed sinc (32 taps, Kaiser window, -85 dB up to 18 kHz of 48).

Source: IEC 60386 (wow below and flutter above 4 Hz); AES6; for scrape the usual range of tape over a fixed
head. Questions: a real spectrum has lines at capstan, pinch roller and reels; here it is even, so that no
line misses the part of the player that it would trouble.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit

WOW_HZ, FLUTTER_HZ, SCRAPE_HZ, WEAVE_HZ = (0.5, 4.0), (4.0, 100.0), (100.0, 2000.0), (0.3, 20.0)
TONES = 8  # to a band
HALF_TAPS = 16  # of the sinc, to either side
KAISER_BETA = 8.5  # -85 dB up to 18 kHz of 48
PARTS = 512  # of a sample, between which the filter is interpolated
KNOT_FRAMES = 8  # the slow curves are laid through every eighth frame


Frames = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Tones:
    """A sum of tones; amplitudes in the unit of the sum."""

    hz: Array
    amplitude: Array
    phase_rad: Array

    @classmethod
    def drawn(
        cls, rms: float, band_hz: tuple[float, float], random: np.random.Generator
    ) -> Tones:
        """Tones of a band, drawn by chance, with this root mean square in all."""
        hz = np.geomspace(*band_hz, TONES) * random.uniform(0.95, 1.05, TONES)
        share = random.uniform(0.5, 1.5, TONES)
        return cls(
            hz,
            rms * np.sqrt(2) * share / np.linalg.norm(share),
            random.uniform(0, 2 * np.pi, TONES),
        )

    def value(self, t_s: Array) -> Array:
        """The sum at moments in s."""
        return self.amplitude @ np.sin(
            2 * np.pi * self.hz[:, None] * t_s + self.phase_rad[:, None]
        )

    def integral_s(self, t_s: Array) -> Array:
        """The sum's integral from 0 to moments in s."""
        w = 2 * np.pi * self.hz
        begun = np.cos(self.phase_rad)[:, None]
        now = np.cos(w[:, None] * t_s + self.phase_rad[:, None])
        return (self.amplitude / w) @ (begun - now)


@dataclass(frozen=True, slots=True)
class Timebase:
    """Speed error (share), tones of speed (shares), skew from track to track in s, and tones of it."""

    speed: float
    flutter: tuple[Tones, ...]
    skew_s: float
    weave: Tones
    start_s: float = 0.0

    def programme_s(self, t_s: Array) -> Array:
        """Programme time under the head of the first track, s."""
        return (
            self.start_s
            + (1 + self.speed) * t_s
            + sum((tones.integral_s(t_s) for tones in self.flutter), 0.0 * t_s)
        )

    def lag_s(self, t_s: Array) -> Array:
        """The lag of each track behind the one before it, s."""
        return self.skew_s + self.weave.value(t_s)

    def places(self, first: int, count: int, rate_hz: float, tracks: int) -> Array:
        """Frames of the programme, with fractions, at frames of play (count, tracks)."""
        knots = (
            np.arange(first // KNOT_FRAMES, (first + count) // KNOT_FRAMES + 2) * KNOT_FRAMES
        )
        frame = np.arange(first, first + count)
        place = np.interp(frame, knots, self.programme_s(knots / rate_hz))
        lag = np.interp(frame, knots, self.lag_s(knots / rate_hz))
        return np.asarray((place[:, None] - lag[:, None] * np.arange(tracks)) * rate_hz)


class Head:
    """Reads frames at fractional places that move on; holds the frames that the next places may need."""

    def __init__(self, tracks: int) -> None:
        self._held = np.zeros((HALF_TAPS, tracks), np.float32)
        self._first = -HALF_TAPS  # the programme's frame at which the held ones begin
        self._taps = _taps()

    @property
    def reach(self) -> int:
        """The furthest programme frame that a place may ask for now."""
        return self._first + len(self._held) - HALF_TAPS

    def take(self, frames: Frames) -> None:
        """Take the next frames of the programme."""
        self._held = np.concatenate([self._held, frames])

    def read(self, places: Array) -> Frames:
        """Frames at places (n, tracks); frames further behind than the skew are dropped."""
        out = np.empty(places.shape, np.float32)
        _read(self._held, places - self._first, self._taps, out)
        done = int(places[-1].min()) - self._first - HALF_TAPS - 64 if len(places) else 0
        if done > 0:
            self._held, self._first = self._held[done:].copy(), self._first + done
        return out


def _taps() -> Frames:
    """The windowed sinc at each part of a sample (parts + 1, taps)."""
    shift = np.arange(PARTS + 1)[:, None] / PARTS
    n = np.arange(-HALF_TAPS + 1, HALF_TAPS + 1) - shift
    round_off = np.sqrt(np.clip(1 - (n / HALF_TAPS) ** 2, 0, None))
    window = np.i0(KAISER_BETA * round_off) / np.i0(KAISER_BETA)
    taps = np.sinc(n) * window
    return np.asarray(taps / taps.sum(axis=1, keepdims=True), np.float32)


@njit(cache=True, nogil=True)
def _read(held, places, taps, out):  # type: ignore[no-untyped-def]
    """Interpolate each track at its places; beyond the frames held the tape is blank."""
    parts = len(taps) - 1
    half = taps.shape[1] // 2
    for i in range(len(places)):
        for track in range(places.shape[1]):
            whole = int(np.floor(places[i, track]))
            part = (places[i, track] - whole) * parts
            row = min(int(part), parts - 1)
            share = np.float32(part - row)
            total = np.float32(0.0)
            for n in range(2 * half):
                at = whole + n - half + 1
                if 0 <= at < len(held):
                    total += held[at, track] * (
                        taps[row, n] + share * (taps[row + 1, n] - taps[row, n])
                    )
            out[i, track] = total
