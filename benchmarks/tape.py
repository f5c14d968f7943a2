"""Tapes: decoding against the analytic signal of scipy and against merely reading; playing against real
time.

All run in turn, three times, and the best of each counts, so that other load hits all alike. The tape is
a minute of circles at 50 mm/s, four tracks of 48 kHz and 16 bit; ten minutes of it, bare and with the check
signal, are played by the clock on the wall and by the processors' time of both threads. Memory is the most
that Python and numpy hold at once, for a minute and for ten.
"""

from __future__ import annotations

import tempfile
import time
import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import soundfile
from numpy.typing import NDArray

from benchmarks.rows import Row, best_s, tell
from morfax.motion.motion import MOTION_RATE_HZ, Motion
from morfax.player.tape.discriminator import Discriminator, discriminate
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import Tape, TapeFormat, record

MINUTE_S = 60.0
BLOCK_FRAMES = 65536


def circles(seconds: float) -> Iterator[Motion]:
    """Motion round a circle of 20 mm at 50 mm/s, started and stopped within two seconds, in blocks of a
    second.
    """
    rate = int(MOTION_RATE_HZ)
    for second in range(round(seconds)):
        t_s = second + np.arange(rate) / rate
        way_mm = (
            np.where(t_s < 2, 12.5 * t_s**2, 50 * (t_s - 1))
            - 12.5 * np.clip(t_s - (seconds - 2), 0, None) ** 2
        )
        angle = way_mm / 20
        columns = [20 * np.sin(angle), 20 * (1 - np.cos(angle)), 0 * angle]
        yield Motion(np.column_stack(columns), MOTION_RATE_HZ, float(second))


def read_only(file: Path) -> None:
    """Read the file as float32 and do nothing with it."""
    with soundfile.SoundFile(file) as sound:
        while len(sound.read(BLOCK_FRAMES, dtype="float32")):
            pass


def write_only(block: NDArray[np.float32], file: Path) -> None:
    """Write frames that are there already, as 16 bit."""
    soundfile.write(file, block, 48000, subtype="PCM_16")


def decode(file: Path) -> None:
    """File to phases with the player's discriminator."""
    with Tape.open(file) as tape:
        fmt = tape.format
        organ = Discriminator(
            fmt.sample_rate_hz, fmt.reference_hz, fmt.samples_per_motion, fmt.tracks
        )
        for _ in discriminate(tape.stored_blocks(BLOCK_FRAMES), organ):
            pass


def decode_by_hilbert(file: Path) -> None:
    """File to phases by the analytic signal of each block, as one would first write it."""
    from scipy.signal import hilbert

    with soundfile.SoundFile(file) as sound:
        while len(frames := sound.read(BLOCK_FRAMES, dtype="float32")):
            analytic = hilbert(frames, axis=0)
            np.unwrap(np.angle(analytic[:, 1:] * analytic[:, :1].conj()), axis=0)[::8] / (
                2 * np.pi
            )


def play_whole(file: Path) -> None:
    """File to the machine's motion, drives and all."""
    for _ in play(file):
        pass


def peak_bytes(task: Callable[[], None]) -> int:
    """The most memory that a task holds at once."""
    tracemalloc.start()
    task()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak


def speed_rows(folder: Path) -> list[Row]:
    """Times over one tape."""
    file, again = folder / "minute.wav", folder / "again.wav"
    record(circles(MINUTE_S), file, TapeFormat())
    with Tape.open(file) as tape:
        frames, seconds = tape.frames, tape.duration_s
    motion = list(circles(MINUTE_S))
    block = np.tile(np.float32(0.1), (frames, 4))
    play_whole(file)  # kernels from their cache
    took = best_s(
        {
            "read": lambda: read_only(file),
            "decode": lambda: decode(file),
            "hilbert": lambda: decode_by_hilbert(file),
            "record": lambda: _record(motion, again),
            "write": lambda: write_only(block, again),
            "play": lambda: play_whole(file),
        }
    )
    return _rows_of(took, frames, seconds)


def _rows_of(took: dict[str, float], frames: int, seconds: float) -> list[Row]:
    """Speeds, and each as a share of what it is compared with, from times in s."""
    mega = {name: frames / taken / 1e6 for name, taken in took.items()}
    both = took["record"] + took["play"]

    def through(what: str, name: str, than: str = "", called: str = "") -> Row:
        """A row of so many million frames/s."""
        share = (mega[name] / mega[than], called) if than else ()
        return Row(what, mega[name], "million frames/s", *share)

    decoded = took["play"] / took["decode"]
    return [
        through("reading as float32", "read"),
        through("decoding, file to phases", "decode", "read", "reading"),
        through("scipy.signal.hilbert, blocks", "hilbert"),
        through("decoding", "decode", "hilbert", "hilbert"),
        through("writing float32 as 16 bit", "write"),
        through("recording, motion to file", "record", "write", "writing"),
        Row(
            "playing, drives and all",
            seconds / took["play"],
            "x real time",
            decoded,
            "decoding",
        ),
        Row("recording and playing", seconds / both, "x real time"),
    ]


def playing_rows(folder: Path) -> list[Row]:
    """Playing and recording of ten minutes: wall time and processor time, against decoding alone."""
    bare, checked = folder / "bare.wav", folder / "checked.wav"
    motion = list(circles(10 * MINUTE_S))
    for file, fmt in ((bare, TapeFormat()), (checked, TapeFormat(checked=True))):
        record(motion, file, fmt)
        play_whole(file)
    again = folder / "again.wav"
    tasks = {
        "decoding a bare tape": lambda: decode(bare),
        "playing a bare tape": lambda: play_whole(bare),
        "playing, with the checks": lambda: play_whole(checked),
        "recording a bare tape": lambda: _record(motion, again),
        "recording, with the check signal": lambda: _record(motion, again, checked=True),
    }
    rows = []
    for how, clock in (("wall", time.perf_counter), ("processor", time.process_time)):
        took = best_s(tasks, clock)
        decoding, playing = took["decoding a bare tape"], took["playing a bare tape"]
        ratios = {
            "playing a bare tape": (playing / decoding, "decoding's time"),
            "playing, with the checks": (
                playing / took["playing, with the checks"],
                "the speed of a bare one",
            ),
        }
        rows += [
            Row(f"{what}, {how}", 10 * MINUTE_S / took_s, "x real time", *ratios.get(what, ()))
            for what, took_s in took.items()
        ]
    return rows


def memory_rows(folder: Path) -> list[Row]:
    """Memory of play for a minute and for ten."""
    peaks = []
    for minutes in (1, 10):
        file = folder / f"{minutes}.wav"
        record(circles(minutes * MINUTE_S), file, TapeFormat())
        peaks.append(peak_bytes(lambda file=file: play_whole(file)) / 1e6)  # type: ignore[misc]
        file.unlink()
    return [
        Row("memory, 1 min played", peaks[0], "MB"),
        Row("memory, 10 min played", peaks[1], "MB", peaks[1] / peaks[0], "1 min"),
    ]


def rows() -> list[Row]:
    """All figures of this benchmark."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        return speed_rows(place) + playing_rows(place) + memory_rows(place)


def main() -> None:
    """Print the figures as a table."""
    tell("tape: four tracks, 48 kHz, 16 bit", rows())


def _record(motion: list[Motion], file: Path, *, checked: bool = False) -> None:
    """Record over whatever was there."""
    file.unlink(missing_ok=True)
    record(motion, file, TapeFormat(checked=checked))


if __name__ == "__main__":
    main()
