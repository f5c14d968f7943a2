"""The check signal: frames read right in noise, wrong frames taken for right, and playing with it on.

Frames: a tape of standstill and circles is read by the player's own reader, with white noise so many dB below
the carrier; a frame counts as read if its check sum is right, and as wrong if it then says another track,
number or count than was recorded. Random symbols are put before the check sum too.

Playing: the same minutes of circles bare and with the check signal, in turn; processor time, the best.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.rows import Row, best_s, tell
from benchmarks.tape import circles, play_whole
from morfax.player.tape.check_reader import read_ahead, read_check
from morfax.recorder.tape.check_frame import SYMBOLS, from_bits
from morfax.recorder.tape.tape import Tape, TapeFormat, record

NOISES_DB = (40, 26, 15)
RUNS = 4  # of the tape, for each noise
RANDOM_FRAMES = 10_000_000
BATCH = 100_000
SECONDS = 120.0
LEVEL = 0.5


def frames_read(file: Path, noise_db: float, seed: int) -> tuple[int, int, int]:
    """Frames on the tape, those read, and those read wrong."""
    random = np.random.default_rng((seed, int(noise_db)))
    sigma = LEVEL / np.sqrt(2) * 10 ** (-noise_db / 20)
    with Tape.open(file) as tape:
        blocks = (
            (block + random.normal(0, sigma, block.shape)).astype(np.float32)
            for block in tape.blocks()
        )
        check = read_check(read_ahead(blocks, tape.format), tape.format)
        if check is None:
            return 1, 0, 0
        reports = check.reports()
        for block in blocks:
            check.feed(block)
            reports += check.reports()
    with Tape.open(file) as tape:
        clean = read_check(
            read_ahead(iter([np.concatenate(list(tape.blocks()))]), tape.format), tape.format
        )
    wanted = [] if clean is None else clean.reports()
    pairs = [
        (said, told)
        for report, other in zip(reports, wanted, strict=False)
        for said, told in zip(report.said, other.said, strict=True)
    ]
    read = [(said, told) for said, told in pairs if said is not None]
    return len(pairs), len(read), sum(said != told for said, told in read)


def random_frames(count: int) -> int:
    """How many of so many random frames pass the check sum."""
    random = np.random.default_rng(14)
    passed = 0
    for _ in range(0, count, BATCH):
        symbols = random.integers(0, 2, (BATCH, SYMBOLS), dtype=np.int8) * 2 - 1
        passed += sum(frame is not None for frame in from_bits(symbols))
    return passed


def rows() -> list[Row]:
    """All figures of this benchmark."""
    out = []
    with tempfile.TemporaryDirectory() as name:
        bare, checked = Path(name) / "bare.wav", Path(name) / "checked.wav"
        record(circles(SECONDS), bare, TapeFormat())
        record(circles(SECONDS), checked, TapeFormat(checked=True))
        for noise_db in NOISES_DB:
            told = np.sum([frames_read(checked, noise_db, run) for run in range(RUNS)], axis=0)
            out.append(
                Row(f"frames read at {noise_db} dB", 100 * told[1] / told[0], f"% of {told[0]}")
            )
            out.append(Row(f"frames read wrong at {noise_db} dB", float(told[2]), "frames"))
        passed = random_frames(RANDOM_FRAMES)
        out.append(Row("random frames taken for right", float(passed), f"of {RANDOM_FRAMES}"))
        took = best_s(
            {"bare": lambda: play_whole(bare), "checked": lambda: play_whole(checked)},
            time.process_time,
        )
    speed = {name: SECONDS / taken for name, taken in took.items()}
    out.append(Row("playing, bare", speed["bare"], "x real time"))
    out.append(
        Row(
            "playing, with the check signal",
            speed["checked"],
            "x real time",
            speed["checked"] / speed["bare"],
            "bare",
        )
    )
    return out


def main() -> None:
    """Print the figures as a table."""
    tell("check signal: four tracks, 48 kHz, 16 bit", rows())


if __name__ == "__main__":
    main()
