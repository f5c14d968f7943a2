"""A checked tape, and what may be done to its tracks."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import soundfile

from morfax.motion.faults import Fault
from morfax.motion.motion import Motion, join
from morfax.player.tape.playback import TapePlayback, play
from morfax.recorder.tape.tape import record
from tests.player.worn import program

RATE_HZ = 48000
UM = 1e-3  # mm
RIGHT_UM = 1.0  # of the path, with any delay up to 200 us
AT = 76923  # the frame at which samples are lost: at 1.6 s, where X and Y run at 60 mm/s
REFERENCE, X, Y, Z = range(4)
ALL = (REFERENCE, X, Y, Z)
Frames = np.ndarray
Change = Callable[[Frames], Frames]


class Bench:
    """A circle at 60 mm/s on a tape with a check signal, and what of it is played after a change."""

    def __init__(self, folder: Path) -> None:
        positions = program(10.0, 60.0)
        positions[:, 2] = 2 - 1.5 * positions[:, 1] / 10.0
        self.tape, self.changed = folder / "fast.wav", folder / "changed.wav"
        record(Motion(positions), self.tape)
        self.clean = join(play(self.tape)).positions_mm
        with soundfile.SoundFile(self.tape) as sound:
            self.frames, self.text = sound.read(dtype="float32"), sound.comment

    def written(self, change: Change) -> Path:
        """The tape with its frames changed, its text as it was."""
        with soundfile.SoundFile(self.changed, "w", RATE_HZ, 4, "PCM_16") as out:
            out.comment = self.text
            out.write(np.clip(change(self.frames.copy()), -1, 1))
        return self.changed

    def played(self, change: Change) -> tuple[np.ndarray, Fault | None]:
        """What was played, and the fault that ended it."""
        return run(play(self.written(change)))

    def error_um(self, went: np.ndarray) -> float:
        """The largest error at the same moments, um."""
        return float(np.abs(went - self.clean[: len(went)]).max(initial=0.0) / UM)


def run(playback: TapePlayback) -> tuple[np.ndarray, Fault | None]:
    """Play to the end or to a fault."""
    blocks = []
    try:
        for block in playback:
            blocks.append(block)
    except Fault as fault:
        return join(blocks).positions_mm if blocks else np.zeros((0, 3)), fault
    return join(blocks).positions_mm, None


def delayed(track: int, delay_s: Callable[[np.ndarray], np.ndarray]) -> Change:
    """Play one track later by a delay that may change, to 1e-4 of full scale (24 samples of a sinc)."""

    def change(frames: Frames) -> Frames:
        numbers = np.arange(len(frames))
        places = numbers - delay_s(numbers / RATE_HZ) * RATE_HZ
        whole = np.floor(places).astype(int)
        late = np.zeros(len(frames))
        for k in range(-23, 25):
            apart = places - whole - k
            window = np.cos(np.pi * np.clip(apart / 24, -1, 1) / 2) ** 2
            at = np.clip(whole + k, 0, len(frames) - 1)
            late += frames[at, track] * np.sinc(apart) * window
        frames[:, track] = late
        return frames

    return change


def lost(tracks: tuple[int, ...], count: int) -> Change:
    """Leave out some samples of some tracks."""

    def change(frames: Frames) -> Frames:
        if tracks == ALL:
            return np.delete(frames, slice(AT, AT + count), axis=0)
        for track in tracks:
            rest = np.delete(frames[:, track], slice(AT, AT + count))
            # what comes last is standstill, a whole number of cycles of 8 samples
            more = frames[len(frames) - 8000 : len(frames) - 8000 + count, track]
            frames[:, track] = np.concatenate([rest, more])
        return frames

    return change


def repeated(tracks: tuple[int, ...], count: int) -> Change:
    """Play some samples of some tracks twice."""

    def change(frames: Frames) -> Frames:
        for track in tracks:
            twice = np.insert(frames[:, track], AT, frames[AT - count : AT, track])
            frames[:, track] = twice[: len(frames)]
        return frames

    return change
