"""Attacks of what stands between two machines: filters, echoes, levels, other recordings, other clocks."""

from __future__ import annotations

import copy
from collections.abc import Sequence

import numpy as np
from scipy.signal import butter, lfilter, sosfilt, sosfiltfilt

from tests.player.attacks import changes as do
from tests.player.attacks.bench import RATE_HZ, Bench, Frames, Kind
from tests.player.attacks.changes import ALL, Floats, Random
from tests.player.attacks.drawn import US

LEVEL = 0.3  # of full scale: the mean of a carrier without its sign


def all_or_some(random: Random) -> list[int]:
    """All tracks, or one to three of them."""
    return list(ALL) if random.random() < 0.5 else do.some(random)


def louder(tape: Bench, tracks: Sequence[int], gain: Floats) -> Frames:
    """Some tracks at a level that changes: a share for each frame."""
    frames = tape.frames.copy()
    frames[:, list(tracks)] *= gain[:, None].astype(np.float32)
    return frames


def swings(tape: Bench, random: Random, low_hz: float, high_hz: float) -> Floats:
    """A number that swings between 0 and 1."""
    hz = do.log_uniform(random, low_hz, high_hz)
    wave = np.sin(2 * np.pi * (hz * do.times_s(tape) + random.random()))
    return np.asarray(0.5 + 0.5 * wave)


def follows(levels: Floats, time_s: float) -> Floats:
    """The mean of some levels over a time that has gone by."""
    share = 1 / (time_s * RATE_HZ)
    return np.asarray(lfilter([share], [1, share - 1], levels, axis=0))


def older(tape: Bench, random: Random) -> Frames:
    """An earlier recording that was not wholly erased: the same one elsewhere, at times of other tracks."""
    share = 10 ** (-random.uniform(3, 45) / 20)
    beneath = np.roll(tape.frames, int(random.integers(2000, len(tape.frames) - 2000)), axis=0)
    if random.random() < 0.5:
        beneath = beneath[:, random.permutation(len(ALL))]
    return tape.frames + np.float32(share) * beneath


def echoed(tape: Bench, random: Random) -> Frames:
    """An echo of 0.1 to 100 ms, 3 to 40 dB down.

    It turns the carriers of an axis and of the reference by asin(share) each, at standstill one way and under
    way the other: 0.05 cycle in all at 22 dB, and half a cycle at 3 dB.
    """
    share = do.log_uniform(random, 0.01, 0.7) * random.choice([-1, 1])
    late, tracks = int(do.log_uniform(random, 5, 4800)), all_or_some(random)
    frames = tape.frames.copy()
    frames[late:, tracks] += np.float32(share) * tape.frames[:-late, tracks]
    return frames * np.float32(0.58)


def all_pass(tape: Bench, random: Random) -> Frames:
    """One to five all-pass filters: delays that depend on the frequency."""
    corner, tracks = random.uniform(-0.9, 0.9), all_or_some(random)
    frames = tape.frames.astype(np.float64)
    for _ in range(int(random.integers(1, 6))):
        frames[:, tracks] = lfilter([corner, 1], [1, corner], frames[:, tracks], axis=0)
    return frames.astype(np.float32)


def level_control(tape: Bench, random: Random) -> Frames:
    """An automatic level control, fast or slow."""
    level = follows(np.abs(tape.frames), do.log_uniform(random, 0.002, 1)) + 1e-3
    gain = (level / LEVEL) ** -random.uniform(0.2, 0.95)
    return np.clip(tape.frames * gain * 0.6, -1, 1).astype(np.float32)


def treble_by_level(tape: Bench, random: Random) -> Frames:
    """A noise reduction that does not fit: treble is raised or lowered by its own level."""
    treble = sosfilt(butter(2, 3000, "high", fs=RATE_HZ, output="sos"), tape.frames, axis=0)
    level = follows(np.abs(treble), do.log_uniform(random, 0.003, 0.1))
    return (tape.frames + random.uniform(-0.5, 0.8) * (LEVEL - level) * treble).astype(
        np.float32
    )


def treble_swings(tape: Bench, random: Random, *, delays: bool) -> Frames:
    """Treble that comes and goes: without a delay, as where the tape lifts off the head, or by a filter."""
    sections = butter(1, random.uniform(1500, 8000), fs=RATE_HZ, output="sos")
    share = np.zeros((len(tape.frames), len(ALL)))
    share[:, do.some(random)] = swings(tape, random, 0.1, 20)[:, None]
    dull = (sosfilt if delays else sosfiltfilt)(sections, tape.frames, axis=0)
    return (tape.frames * (1 - share) + dull * share).astype(np.float32)


def level_swings(tape: Bench, random: Random) -> Frames:
    """A level that swings by 5 to 98 %."""
    depth = random.uniform(0.05, 0.98)
    return louder(tape, all_or_some(random), 1 - depth * swings(tape, random, 0.3, 200))


def level_steps(tape: Bench, random: Random) -> Frames:
    """A level that is lower from a moment on."""
    behind = np.arange(len(tape.frames)) >= do.moment(tape, random)
    lower = 10 ** (-random.uniform(1, 26) / 20)
    return louder(tape, all_or_some(random), np.where(behind, lower, 1.0))


def faded(tape: Bench, random: Random) -> Frames:
    """A level that fades away, and at times comes back."""
    at, count = do.moment(tape, random), int(do.log_uniform(random, 500, 100000))
    gone = (np.arange(len(tape.frames)) - at) / count
    back = gone - 1 if random.random() < 0.5 else np.zeros(len(gone))
    gain = np.clip(np.maximum(1 - gone, back), 0.0, 1.0)
    return louder(tape, all_or_some(random), gain)


def buzz(tape: Bench, random: Random) -> Frames:
    """Mains with many harmonics."""
    most = int(random.integers(2, 160))
    numbers, phases = np.arange(1, most)[:, None], random.random((most - 1, 1))
    period = np.arange(RATE_HZ // 50) / RATE_HZ
    wave = (np.sin(2 * np.pi * (50 * numbers * period + phases)) / numbers).sum(axis=0)
    wave = random.uniform(0.02, 0.4) * np.resize(wave, len(tape.frames))
    return (tape.frames + wave[:, None]).astype(np.float32)


def thump(tape: Bench, random: Random) -> Frames:
    """A low tone that dies away."""
    frames, count = tape.frames.copy(), int(do.log_uniform(random, 50, 20000))
    at, hz, n = do.moment(tape, random, count), do.log_uniform(random, 5, 300), np.arange(count)
    wave = (
        random.uniform(0.1, 1) * np.exp(-5 * n / count) * np.sin(2 * np.pi * hz * n / RATE_HZ)
    )
    frames[at : at + count] += wave[:, None].astype(np.float32)
    return np.clip(frames, -1, 1)


def second_harmonic(tape: Bench, random: Random) -> Frames:
    """A bent curve: a second harmonic."""
    return tape.frames + np.float32(random.uniform(0.05, 1)) * tape.frames**2


def jittered(tape: Bench, random: Random) -> Frames:
    """Samples taken at moments that jitter by up to two of them."""
    numbers = np.arange(len(tape.frames))
    return tape.at(numbers + random.normal(0, do.log_uniform(random, 0.01, 2), len(numbers)))


def another_take(tape: Bench, random: Random) -> Frames:
    """From a moment on another take, up to 6 ms before or behind, faded over."""
    at, over = do.moment(tape, random), int(do.log_uniform(random, 1, 2000))
    numbers = np.arange(len(tape.frames))
    share = np.clip((numbers - at + over / 2) / over, 0, 1)[:, None].astype(np.float32)
    return tape.frames * (1 - share) + tape.at(numbers + random.uniform(-300, 300)) * share


def other_track(tape: Bench, random: Random) -> Frames:
    """Another track's signal in the place of one's own, for 1 ms to 0.6 s."""
    frames, count = tape.frames.copy(), int(do.log_uniform(random, 50, 30000))
    at, (one, other) = do.moment(tape, random, count), random.permutation(len(ALL))[:2]
    share = np.float32(random.uniform(0.3, 1))
    frames[at : at + count, one] = share * tape.frames[at : at + count, other]
    return frames


def stuck(tape: Bench, random: Random) -> Frames:
    """A buffer that is played two to thirty times in the place of others."""
    frames, count = tape.frames.copy(), int(do.log_uniform(random, 16, 2400))
    times = min(int(random.integers(2, 31)), 40000 // count)  # most of a second
    at, tracks = do.moment(tape, random, count * times), all_or_some(random)
    held = tape.frames[at : at + count, tracks]
    frames[at : at + count * times, tracks] = np.tile(held, (times, 1))
    return frames


def drifts_from(tape: Bench, random: Random, us_per_s: float) -> Frames:
    """A track whose delay grows or shrinks from a moment on, by so many us/s."""
    since_s = np.clip(do.times_s(tape) - do.moment(tape, random) / RATE_HZ, 0, None)
    slope = us_per_s * US * float(random.choice([-1, 1]))
    return do.late(tape, {do.track(random): slope * since_s})


def phase_swings(tape: Bench, random: Random) -> Frames:
    """A track whose phase swings, the check signal's alike."""
    size, hz = random.uniform(0.05, 3), do.log_uniform(random, 0.1, 50)
    wave = np.asarray(size * np.sin(2 * np.pi * hz * do.times_s(tape)))
    return do.turned(tape, do.track(random), wave)


def several(tape: Bench, random: Random, kinds: Sequence[Kind]) -> Frames:
    """Two or three attacks one behind the other; those that leave too little of a tape are passed over."""
    changed = copy.copy(tape)
    for _ in range(int(random.integers(2, 4))):
        try:
            frames = kinds[int(random.integers(len(kinds)))].change(changed, random)
        except ValueError:  # the tape is too short for it by now
            continue
        if frames.shape[1] == len(ALL) and len(frames) > len(tape.frames) // 2:
            changed.put(frames)
    return changed.frames
