"""The changes: what an attack does to the frames of a tape; most are made from a few numbers drawn at random.

Moments are drawn between the standstills that each tape has at both ends.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, hilbert, sosfiltfilt

from tests.player.attacks.bench import (
    CYCLES_PER_MM,
    MOTION_RATE_HZ,
    RATE_HZ,
    RIGHT_CYCLES,
    Bench,
    Frames,
)

REFERENCE, X, Y, Z = range(4)
ALL = (REFERENCE, X, Y, Z)
Random = np.random.Generator
Floats = NDArray[np.float64]


def moment(tape: Bench, random: Random, spare: int = 0) -> int:
    """A frame between the standstills; the circle begins to run 0.1 s behind the first of them."""
    return int(
        random.integers(round(1.2 * RATE_HZ), len(tape.frames) - round(1.4 * RATE_HZ) - spare)
    )


def under_way(tape: Bench, random: Random) -> int:
    """A frame before the last standstill at which an axis is off its start by more than is right.

    The circle stands still until 1.3 s: a tape whose start is cut before that is whole.
    """
    return int(random.integers(begins(tape), len(tape.frames) - round(1.4 * RATE_HZ)))


def begins(tape: Bench) -> int:
    """The first frame at which an axis is further from its start than a tape may be wrong."""
    off = np.abs(tape.clean - tape.clean[0]).max(axis=1) * CYCLES_PER_MM
    return int(np.argmax(off > RIGHT_CYCLES)) * (RATE_HZ // MOTION_RATE_HZ)


def track(random: Random) -> int:
    """Any track."""
    return int(random.integers(len(ALL)))


def some(random: Random) -> list[int]:
    """One to three of the four tracks."""
    return [int(one) for one in random.permutation(len(ALL))[: random.integers(1, 4)]]


def log_uniform(random: Random, low: float, high: float) -> float:
    """A number whose logarithm is even between two."""
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def late(tape: Bench, delays_s: dict[int, Floats | float]) -> Frames:
    """Some tracks later by a delay, which may change."""
    frames, numbers = tape.frames.copy(), np.arange(len(tape.frames), dtype=np.float64)
    for one, delay_s in delays_s.items():
        frames[:, one] = tape.at(numbers - delay_s * RATE_HZ, one)[:, 0]
    return frames


def times_s(tape: Bench) -> Floats:
    """The moments of all frames."""
    return np.arange(len(tape.frames)) / RATE_HZ


def removed(tape: Bench, at: int, count: int, tracks: Sequence[int]) -> Frames:
    """Some tracks without some frames; what is missing at their end is standstill."""
    if len(tracks) == len(ALL):
        return np.delete(tape.frames, slice(at, at + count), axis=0)
    frames = tape.frames.copy()
    for one in tracks:
        rest = np.delete(frames[:, one], slice(at, at + count))
        more = frames[len(frames) - 8000 : len(frames) - 8000 + count, one]
        frames[:, one] = np.concatenate([rest, more])
    return frames


def repeated(tape: Bench, at: int, count: int, tracks: Sequence[int]) -> Frames:
    """Some tracks with some frames played twice."""
    if len(tracks) == len(ALL):
        return np.insert(tape.frames, at, tape.frames[at - count : at], axis=0)
    frames = tape.frames.copy()
    for one in tracks:
        twice = np.insert(frames[:, one], at, frames[at - count : at, one])
        frames[:, one] = twice[: len(frames)]
    return frames


def exchanged(tape: Bench, at: int, count: int) -> Frames:
    """Two buffers in each other's places."""
    frames = tape.frames.copy()
    frames[at : at + count] = tape.frames[at + count : at + 2 * count]
    frames[at + count : at + 2 * count] = tape.frames[at : at + count]
    return frames


def pasted(tape: Bench, at: int, count: int, source: int, tracks: Sequence[int]) -> Frames:
    """Some frames of some tracks in another place too."""
    frames = tape.frames.copy()
    for one in tracks:
        frames[at : at + count, one] = tape.frames[source : source + count, one]
    return frames


def scaled(tape: Bench, at: int, count: int, tracks: Sequence[int], share: float) -> Frames:
    """Some frames of some tracks at another level."""
    frames = tape.frames.copy()
    frames[at : at + count, list(tracks)] *= np.float32(share)
    return frames


def turned(tape: Bench, one: int, cycles: Floats) -> Frames:
    """One track with its phase turned on, carrier and check signal alike."""
    frames = tape.frames.copy()
    analytic = hilbert(frames[:, one].astype(np.float64))
    frames[:, one] = (analytic * np.exp(2j * np.pi * cycles)).real
    return frames


def at_speed(tape: Bench, speed: Floats) -> Frames:
    """The tape run at another speed, which may change: a share for each frame."""
    places = np.cumsum(speed) - speed[0]
    return tape.at(places[places < len(tape.frames) - 1])


def with_noise(tape: Bench, random: Random, noise_db: float) -> Frames:
    """White noise so many dB below the carrier's power."""
    sigma = 0.5 / np.sqrt(2) * 10 ** (-noise_db / 20)
    noise = random.standard_normal(tape.frames.shape, np.float32) * np.float32(sigma)
    return tape.frames + noise


def with_tone(
    tape: Bench, random: Random, hz: float, level: float, tracks: Sequence[int]
) -> Frames:
    """A tone of another source on some tracks; `level` of the carrier's peak."""
    frames = tape.frames.copy()
    wave = 0.5 * level * np.sin(2 * np.pi * (hz * times_s(tape) + random.random()))
    frames[:, list(tracks)] += wave[:, None].astype(np.float32)
    return frames


def filtered(tape: Bench, kind: str, hz: float, order: int = 2) -> Frames:
    """The tape through a filter without delay."""
    sections = butter(order, hz, kind, fs=RATE_HZ, output="sos")
    return sosfiltfilt(sections, tape.frames, axis=0).astype(np.float32)


def low_band(frames: Frames) -> Frames:
    """What lies beneath the carriers: the check signal."""
    sections = butter(6, 2000, "lowpass", fs=RATE_HZ, output="sos")
    return sosfiltfilt(sections, frames, axis=0).astype(np.float32)
