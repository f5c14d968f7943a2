"""Attacks whose numbers are drawn at random: where, how long, how much."""

from __future__ import annotations

import numpy as np
from scipy.signal import hilbert

from tests.player.attacks import changes as do
from tests.player.attacks.bench import RATE_HZ, Bench, Frames
from tests.player.attacks.changes import ALL, Random, X, Y, Z

US = 1e-6
AXES = (X, Y, Z)


def axis(random: Random) -> int:
    """Any track of an axis."""
    return int(random.choice(AXES))


def signed(random: Random, low: float, high: float) -> float:
    """A number between two, of either sign."""
    return float(random.uniform(low, high) * random.choice([-1, 1]))


def azimuth(tape: Bench, random: Random) -> Frames:
    """The head tilts: each track further out is later."""
    each = signed(random, 0, 60) * US
    return do.late(tape, {track: each * track for track in ALL})


def drifting(tape: Bench, random: Random, track: int) -> Frames:
    """A track whose delay grows or shrinks."""
    slope = signed(random, 5, 45) * US
    return do.late(tape, {track: slope * do.times_s(tape)})


def swinging(tape: Bench, random: Random, low_hz: float, high_hz: float) -> Frames:
    """An axis whose delay swings by up to 60 us."""
    hz, size_s = do.log_uniform(random, low_hz, high_hz), random.uniform(1, 60) * US
    return do.late(tape, {axis(random): size_s * np.sin(2 * np.pi * hz * do.times_s(tape))})


def stepping(tape: Bench, random: Random) -> Frames:
    """A track whose delay steps."""
    at = do.moment(tape, random) / RATE_HZ
    return do.late(
        tape, {do.track(random): signed(random, 17, 150) * US * (do.times_s(tape) > at)}
    )


def lost(tape: Bench, random: Random, counts: tuple[int, int], tracks: list[int]) -> Frames:
    """Some samples lost."""
    count = round(do.log_uniform(random, *counts))
    return do.removed(tape, do.moment(tape, random, count), count, tracks)


def again(tape: Bench, random: Random, counts: tuple[int, int], tracks: list[int]) -> Frames:
    """Some samples twice."""
    count = round(do.log_uniform(random, *counts))
    return do.repeated(tape, do.moment(tape, random, count), count, tracks)


def exchanged(tape: Bench, random: Random) -> Frames:
    """Two buffers one behind the other exchanged."""
    count = round(do.log_uniform(random, 8, 4800))
    return do.exchanged(tape, do.moment(tape, random, 2 * count), count)


def pasted(tape: Bench, random: Random, tracks: list[int]) -> Frames:
    """A buffer in another place too."""
    count = round(do.log_uniform(random, 480, 24000))
    source = do.moment(tape, random, count)
    return do.pasted(tape, do.moment(tape, random, count), count, source, tracks)


def hole(
    tape: Bench, random: Random, lengths_s: tuple[float, float], tracks: list[int]
) -> Frames:
    """A dropout of any depth."""
    count = round(do.log_uniform(random, *lengths_s) * RATE_HZ)
    share = float(random.choice([0.0, 0.003, 0.05, 0.2, 0.4, 0.6]))
    return do.scaled(tape, do.moment(tape, random, count), count, tracks, share)


def holes(tape: Bench, random: Random) -> Frames:
    """Many dropouts, each on any track."""
    frames = tape.frames.copy()
    for _ in range(int(random.integers(3, 30))):
        count = round(do.log_uniform(random, 0.0003, 0.02) * RATE_HZ)
        at = do.moment(tape, random, count)
        frames[at : at + count, do.track(random)] *= np.float32(random.choice([0.0, 0.1, 0.4]))
    return frames


def early_hole(tape: Bench, random: Random) -> Frames:
    """A dropout in the first 50 ms."""
    count = round(do.log_uniform(random, 0.001, 0.04) * RATE_HZ)
    share = float(random.choice([0.0, 0.1, 0.4, 0.6, 0.75]))
    return do.scaled(tape, int(random.integers(0, 2400)), count, [do.track(random)], share)


def noisy_hole(tape: Bench, random: Random) -> Frames:
    """A dropout in which noise as loud as the carrier stands."""
    count = round(do.log_uniform(random, 0.0005, 0.3) * RATE_HZ)
    at, track = do.moment(tape, random, count), do.track(random)
    frames = tape.frames.copy()
    frames[at : at + count, track] = random.normal(0, 0.35, count).astype(np.float32)
    return frames


def toned_hole(tape: Bench, random: Random) -> Frames:
    """A dropout in which a steady tone near the reference stands, as loud as the carrier."""
    count = round(do.log_uniform(random, 0.0005, 0.3) * RATE_HZ)
    at, track = do.moment(tape, random, count), do.track(random)
    frames, turns = tape.frames.copy(), random.uniform(5800, 6200) * np.arange(count) / RATE_HZ
    frames[at : at + count, track] = 0.5 * np.sin(2 * np.pi * (turns + random.random()))
    return frames


def tone_in_phase(tape: Bench, random: Random) -> Frames:
    """A short tone as loud as the carrier, nearly as fast, and up to a fifth of a cycle beside it."""
    count = round(do.log_uniform(random, 0.0005, 0.006) * RATE_HZ)
    at, track = do.moment(tape, random, count), do.track(random)
    frames, around = tape.frames.copy(), tape.frames[at - 480 : at + 480, track]
    phases = np.unwrap(np.angle(hilbert(around.astype(np.float64)))) / (2 * np.pi)
    hz = (phases[600] - phases[360]) / 240 * RATE_HZ + random.uniform(-60, 60)
    turns = phases[480] + random.uniform(-0.2, 0.2) + hz * np.arange(count) / RATE_HZ
    frames[at : at + count, track] = 0.5 * np.cos(2 * np.pi * turns)
    return frames


def clicks(tape: Bench, random: Random) -> Frames:
    """A few samples at full scale or at none."""
    frames = tape.frames.copy()
    for _ in range(int(random.integers(1, 20))):
        at, count = do.moment(tape, random), int(random.integers(1, 6))
        frames[at : at + count, do.some(random)] = float(random.choice([-1, 1, 0]))
    return frames


def bursts(tape: Bench, random: Random) -> Frames:
    """Short bursts of noise on all tracks."""
    frames = tape.frames.copy()
    for _ in range(int(random.integers(1, 8))):
        count = round(do.log_uniform(random, 0.0002, 0.05) * RATE_HZ)
        at, loud = do.moment(tape, random, count), random.uniform(0.02, 0.5)
        noise = random.normal(0, loud, (count, len(ALL))).astype(np.float32)
        frames[at : at + count] += noise
    return frames


def order(tape: Bench, random: Random) -> Frames:
    """The tracks in another order."""
    orders = [one for one in (random.permutation(4) for _ in range(9)) if any(one != range(4))]
    return np.ascontiguousarray(tape.frames[:, orders[0]])


def copied(tape: Bench, random: Random) -> Frames:
    """One track a copy of another."""
    one, other = random.permutation(4)[:2]
    frames = tape.frames.copy()
    frames[:, one] = frames[:, other] * np.float32(random.uniform(0.5, 1))
    return frames


def order_from(tape: Bench, random: Random) -> Frames:
    """Two axes change places under way."""
    one, other = random.permutation(3)[:2] + 1
    at, frames = do.moment(tape, random), tape.frames.copy()
    frames[at:, [one, other]] = frames[at:, [other, one]]
    return frames


def silent(tape: Bench, random: Random) -> Frames:
    """A track that is not, or hardly, there."""
    frames = tape.frames.copy()
    frames[:, do.track(random)] *= np.float32(random.choice([0.0, 1e-4, 5e-4]))
    return frames


def part_backwards(tape: Bench, random: Random) -> Frames:
    """A stretch that runs backwards."""
    count = round(do.log_uniform(random, 0.01, 0.5) * RATE_HZ)
    at, frames = do.moment(tape, random, count), tape.frames.copy()
    frames[at : at + count] = frames[at : at + count][::-1]
    return frames


def wavering(tape: Bench, random: Random, hz: tuple[float, float], most: float) -> Frames:
    """A speed that wavers."""
    size, at_hz = do.log_uniform(random, 1e-4, most), do.log_uniform(random, *hz)
    phase = random.random()
    waves = np.sin(2 * np.pi * (at_hz * do.times_s(tape) + phase))
    return do.at_speed(tape, 1 + size * waves)


def changed_speed(tape: Bench, random: Random) -> Frames:
    """A speed that becomes another in 0.2 s."""
    at, share = do.moment(tape, random), signed(random, 0.001, 0.08)
    smooth = 1 / (1 + np.exp(-(np.arange(len(tape.frames)) - at) / 2400))
    return do.at_speed(tape, 1 + share * smooth)


def inverted_from(tape: Bench, random: Random, tracks: list[int]) -> Frames:
    """Some tracks inverted from a moment on."""
    at, frames = do.moment(tape, random), tape.frames.copy()
    frames[at:, tracks] *= -1
    return frames


def uneven(tape: Bench, random: Random) -> Frames:
    """A level that wavers on some tracks."""
    size_db, hz = random.uniform(0.2, 1.0), do.log_uniform(random, 0.3, 30)
    waves = size_db * np.sin(2 * np.pi * (hz * do.times_s(tape) + random.random()))
    frames = tape.frames.copy()
    frames[:, do.some(random)] *= (10 ** (waves / 20)).astype(np.float32)[:, None]
    return frames


def crossed(tape: Bench, random: Random) -> Frames:
    """Each track on all others."""
    share = 10 ** (-random.uniform(15, 55) / 20)
    mixed = np.full((4, 4), share, np.float32) + np.eye(4, dtype=np.float32) * np.float32(
        1 - share
    )
    return tape.frames @ mixed


def printed(tape: Bench, random: Random) -> Frames:
    """The layers above and below on the tape."""
    share, turn = (
        10 ** (-random.uniform(20, 55) / 20),
        round(random.uniform(0.2, 1.5) * RATE_HZ),
    )
    frames = tape.frames + np.float32(share) * np.roll(tape.frames, turn, axis=0)
    return frames + np.float32(share) * np.roll(tape.frames, -turn, axis=0)


def distorted(tape: Bench, random: Random) -> Frames:
    """A third harmonic."""
    frames = tape.frames.copy()
    return frames - np.float32(random.uniform(0.01, 0.3) * 4) * frames**3


def clipped(tape: Bench, random: Random) -> Frames:
    """Peaks cut off."""
    most = np.float32(random.uniform(0.2, 0.6))
    return np.clip(tape.frames, -most, most)


def coarse(tape: Bench, random: Random) -> Frames:
    """Fewer bits."""
    steps = np.float32(2 ** int(random.integers(3, 10)))
    return np.rint(tape.frames * steps) / steps


def other_check(tape: Bench, random: Random) -> Frames:
    """The check signal from another place of the tape beneath the carriers of this."""
    low, turn = do.low_band(tape.frames), int(random.integers(4800, len(tape.frames) // 2))
    return tape.frames - low + np.roll(low, turn, axis=0)


def spliced(tape: Bench, random: Random) -> Frames:
    """A piece cut out."""
    one, other = sorted(do.moment(tape, random) for _ in range(2))
    return np.concatenate([tape.frames[:one], tape.frames[max(other, one + 960) :]])


def slipped(tape: Bench, random: Random, cycles: float) -> Frames:
    """A phase that turns on by some cycles, in 0.5 to 50 ms or at once."""
    at = do.moment(tape, random, 2400)
    over = max(round(do.log_uniform(random, 0.0002, 0.05) * RATE_HZ), 1)
    share = np.clip((np.arange(len(tape.frames)) - at) / over, 0, 1)
    return do.turned(tape, do.track(random), cycles * share)


def hole_and_slip(tape: Bench, random: Random) -> Frames:
    """A dropout behind which a track is some samples or cycles further on."""
    count = round(do.log_uniform(random, 0.002, 0.05) * RATE_HZ)
    at, one = do.moment(tape, random, count), do.track(random)
    frames = do.removed(tape, at + count // 2, int(random.integers(1, 40)), [one])
    frames[at : at + count, one] *= np.float32(0.003)
    return frames


def hole_at_speed(tape: Bench, random: Random) -> Frames:
    """A dropout of all tracks while the tape changes its speed."""
    frames = changed_speed(tape, random)
    count = round(do.log_uniform(random, 0.01, 0.6) * RATE_HZ)
    at = int(random.integers(60000, max(len(frames) - count - 60000, 60001)))
    frames[at : at + count] *= np.float32(0.003)
    return frames
