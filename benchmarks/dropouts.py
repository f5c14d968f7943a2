"""Dropouts on checked tapes: how many are ridden over, how many are picked up behind, and how many are wrong.

A tape of circles, or of squares with a stop at each corner, gets a dropout of one length every few seconds,
at random moments, on one random track or on all, down to 50 dB, with 46 dB of noise. It is read as for
mending.

    ridden       the player does not stop at it
    picked up    the way within is not known, and behind it the axis is where it should be
    wrong        beyond 0.05 cycle where the player would have gone on, or behind the dropout

`python -m benchmarks dropouts [N]`: N dropouts of each kind; a thousand take a quarter of an hour.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import soundfile

from morfax.motion.arrays import Array
from morfax.motion.faults import Fault
from morfax.motion.motion import Motion
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import record

RATE_HZ, MOTION_RATE_HZ = 48000, 6000
LENGTHS_MS = (5.0, 10.0, 50.0, 500.0)
APART_S = 3.0  # from dropout to dropout, and up to 0.5 s more
AT_ONCE = 50  # dropouts on a tape
LEFT = 0.003  # of the level
NOISE = 0.5 / np.sqrt(2) * 10 ** (-46 / 20)
RIGHT_CYCLES = 0.05
DEFAULT = 100


def circles(seconds: float) -> Array:
    """Round a circle of 10 mm at 10 mm/s, gone into with 0.5 m/s²; Z goes up and down by 1 mm."""
    t = np.arange(round(seconds * MOTION_RATE_HZ)) / MOTION_RATE_HZ
    way = np.where(t < 0.02, 250 * t**2, 10 * t - 0.1) / 10.0
    return np.column_stack([10 * np.sin(way), 10 - 10 * np.cos(way), np.cos(way) - 1])


def squares(seconds: float) -> Array:
    """Round a square of 10 mm at 10 mm/s, with a stop at each corner, 0.5 m/s²."""
    t = np.arange(round(seconds * MOTION_RATE_HZ)) / MOTION_RATE_HZ
    leg_s, rise_s = 1.02, 0.02
    leg, u = np.divmod(t, leg_s)
    way = np.where(u < rise_s, 250 * u**2, 10 * u - 0.1)
    way = np.where(u > leg_s - rise_s, 10 - 250 * (leg_s - u) ** 2, way)
    side = leg.astype(int) % 4
    x = np.choose(side, [way, 10 + 0 * way, 10 - way, 0 * way])
    y = np.choose(side, [0 * way, way, 10 + 0 * way, 10 - way])
    return np.column_stack([x, y, 0 * x])


PROGRAMS: dict[str, Callable[[float], Array]] = {"circles": circles, "squares": squares}


class Tally:
    """What became of the dropouts of one kind."""

    def __init__(self) -> None:
        self.all = self.ridden = self.picked_up = self.wrong = 0

    def __str__(self) -> str:
        left = self.all - self.ridden
        picked = f"{100 * self.picked_up / left:6.1f}" if left else "     -"
        return (
            f"{self.all:6d}  ridden {100 * self.ridden / self.all:6.1f} %  picked up of the others {picked} %"
            f"  wrong {self.wrong}"
        )


def _rows(file: Path) -> tuple[Array, list[tuple[int, int]], int, Fault | None]:
    """The rows of a tape read as for mending, cycles; gaps that were laid (rows), all gaps, and a fault."""
    playback = play(file)
    reader, blocks, fault = playback.reader, [], None
    reader.mends = True
    for phases, bearings, found in reader.read(lambda: playback.start_mm.tolist()):
        blocks.append(phases.cycles - bearings.zero_cycles)
        if found is not None:
            fault = found[1]
            break
    laid = [(gap.first, gap.last) for gap, *_ in reader.mended]
    return np.concatenate(blocks), laid, len(reader.bridged), fault


def _holes(random: np.random.Generator, count: int, length_s: float) -> Iterator[int]:
    """The first frame of each dropout."""
    at_s = 3.0
    for _ in range(count):
        at_s += APART_S + float(random.uniform(0, 0.5)) + length_s
        yield round(at_s * RATE_HZ)


def tried(
    tape: Path, clean: Array, length_ms: float, every: bool, seed: int, tally: Tally
) -> None:
    """Play one tape with dropouts, and tally them."""
    random = np.random.default_rng((seed, round(length_ms), int(every)))
    with soundfile.SoundFile(tape) as sound:
        frames, text = sound.read(dtype="float32"), sound.comment
    frames += random.normal(0, NOISE, frames.shape).astype(np.float32)
    length = round(length_ms * RATE_HZ / 1e3)
    firsts = list(_holes(random, AT_ONCE, length_ms / 1e3))
    for first in firsts:
        tracks = slice(None) if every else int(random.integers(frames.shape[1]))
        frames[first : first + length, tracks] *= LEFT
    worn = tape.with_name("worn.wav")
    with soundfile.SoundFile(worn, "w", RATE_HZ, frames.shape[1], "PCM_16") as out:
        out.comment = text
        out.write(frames)
    rows, laid, _, fault = _rows(worn)
    off = np.abs(rows - clean[: len(rows)]).max(axis=1)
    for first, last in laid:
        off[first:last] = 0.0
    if fault is not None:
        print(f"    {fault}")
    places = [first * MOTION_RATE_HZ // RATE_HZ for first in firsts]
    for place, after in zip(places, [*places[1:], len(clean)], strict=True):
        stopped = any(place - 60 <= first < after for first, _ in laid)
        known = after <= len(rows) or fault is None
        right = known and off[place - 60 : after].max(initial=0.0) < RIGHT_CYCLES
        tally.all += 1
        tally.ridden += known and not stopped
        tally.picked_up += stopped and right
        tally.wrong += known and not right


def main(words: list[str] | None = None) -> None:
    """Print the table."""
    count = int(words[0]) if words else DEFAULT
    print("dropouts on checked tapes, 46 dB of noise")
    with tempfile.TemporaryDirectory() as name:
        for program, positions in PROGRAMS.items():
            tape = Path(name) / "clean.wav"
            seconds = AT_ONCE * (APART_S + 0.5 + max(LENGTHS_MS) / 1e3) + 6.0
            record(Motion(positions(seconds)), tape)
            clean = _rows(tape)[0]
            for length_ms in LENGTHS_MS:
                for every in (False, True):
                    tally = Tally()
                    for run in range(-(-count // AT_ONCE)):
                        tried(tape, clean, length_ms, every, run, tally)
                    tracks = "all tracks" if every else "one track "
                    print(f"  {program}  {length_ms:5.0f} ms  {tracks} {tally}", flush=True)


if __name__ == "__main__":
    main()
