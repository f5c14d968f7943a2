"""The bench: a checked tape in memory, played after a change, and the judgement of what was played."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from unittest import mock

import numpy as np
from numpy.typing import NDArray
from scipy.signal import resample_poly
from scipy.spatial import cKDTree

from morfax.motion.faults import Fault
from morfax.motion.motion import Motion, join
from morfax.player.tape.playback import play
from morfax.recorder.sound.source import FileSource
from morfax.recorder.tape import check_signal
from morfax.recorder.tape.tape import record
from tests.player.worn import corners, program

RATE_HZ, MOTION_RATE_HZ = 48000, 6000
RIGHT_CYCLES = 0.05
CYCLES_PER_MM = 20
GRAIN_MM = 1e-5  # rows closer than that are one place: 0.0002 cycle
FINER = 8  # samples of the finer tape to one: a straight line between them is true to 0.2 %

Frames = NDArray[np.float32]
Change = Callable[["Bench", np.random.Generator], Frames]

RIGHT, EITHER, FAULT = "right", "right or fault", "fault"


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of attack: what is done, what must come of it, and whether it leaves the moments as they are."""

    name: str
    change: Change
    must: str
    timed: bool = True


@dataclass(frozen=True, slots=True)
class Verdict:
    """What came of a tape: the largest error of what was played, cycles, and the fault that ended it."""

    error_cycles: float
    fault: Fault | None

    @property
    def silently_wrong(self) -> bool:
        """Whether something was played that is off by more than a twentieth of a cycle."""
        return self.error_cycles > RIGHT_CYCLES

    def keeps(self, must: str) -> bool:
        """Whether it is what must come."""
        if self.silently_wrong:
            return False
        return must == EITHER or (must == FAULT) == (self.fault is not None)


class MemorySource:
    """Frames in memory as a source of sound."""

    container, sample, name = "WAV", "16", "changed.wav"

    def __init__(self, stored: NDArray[np.int16], text: str, rate_hz: int = RATE_HZ) -> None:
        self._stored = stored
        self.tracks, self.rate_hz, self.text = stored.shape[1], rate_hz, text

    @property
    def frames(self) -> int:
        """Frames in it."""
        return len(self._stored)

    def stored_blocks(self, frames: int = 65536, first: int = 0) -> Iterator[NDArray[np.int16]]:
        """The frames in blocks."""
        for at in range(first, len(self._stored), frames):
            yield self._stored[at : at + frames]

    def close(self) -> None:
        """Nothing to let go of."""


def as_stored(frames: Frames) -> NDArray[np.int16]:
    """Frames as a file of 16 bit holds them; what is no number is silence."""
    scaled = frames * np.float32(32768)
    if not np.isfinite(scaled).all():
        scaled = np.nan_to_num(scaled)
    return np.clip(np.rint(scaled, out=scaled), -32768, 32767).astype(np.int16)


class Bench:
    """A checked tape of a motion: its frames, and what is played of it when nothing is done to it."""

    def __init__(self, folder: object, positions_mm: NDArray[np.float64]) -> None:
        tape = f"{folder}/bench.wav"
        record(Motion(positions_mm), tape)
        source = FileSource(tape)
        self.text = source.text
        stored = np.concatenate(list(source.stored_blocks())).astype(np.float32)
        self.put(stored / np.float32(32768))
        source.close()
        self.clean = join(play(tape)).positions_mm
        # rows that stand still are one: a tree of thousands of rows in one place is as slow as a list
        moves = np.abs(np.diff(np.rint(self.clean / GRAIN_MM), axis=0)).max(axis=1) > 0
        self._way = self.clean[np.r_[True, moves]]
        self._tree = cKDTree(self._way)

    def put(self, frames: Frames) -> None:
        """Take other frames for the tape's."""
        self.frames = frames
        finer = resample_poly(frames.astype(np.float64), FINER, 1, axis=0)
        self._finer = finer.astype(np.float32)

    def at(self, places: NDArray[np.float64], track: int | None = None) -> Frames:
        """The frames of all tracks, or of one, at places between them."""
        numbers = np.clip(places, 0, len(self.frames) - 1) * FINER
        below = np.minimum(numbers.astype(np.int64), len(self._finer) - 2)
        share = (numbers - below)[:, None].astype(np.float32)
        columns = self._finer if track is None else self._finer[:, track : track + 1]
        out: Frames = columns[below] * (1 - share) + columns[below + 1] * share
        return out

    def tried(self, kind: Kind, seed: int) -> Verdict:
        """Play the tape after one attack."""
        random = np.random.default_rng(seed)
        stored = as_stored(kind.change(self, random))
        blocks, fault = [], None
        try:
            for block in play(lambda: MemorySource(stored, self.text)):
                blocks.append(block.positions_mm)
        except Fault as met:
            fault = met.with_traceback(
                None
            )  # which would hold the frames of every tape that was tried
        went = np.concatenate(blocks) if blocks else np.zeros((0, 3))
        return Verdict(self._error(went, kind.timed, fault), fault)

    def _error(self, went: NDArray[np.float64], timed: bool, fault: Fault | None) -> float:
        """The largest error, cycles: at the same moments, or off the path; and of the end."""
        ended = 0.0
        if fault is None:
            ended = float(np.abs(went[-1] - self.clean[-1]).max()) if len(went) else np.inf
        if timed:
            rows = min(len(went), len(self.clean))
            off = np.abs(went[:rows] - self.clean[:rows]).max(initial=0.0)
        else:
            off = self._off_path(went)
        return max(float(off), ended) * CYCLES_PER_MM

    def _off_path(self, went: NDArray[np.float64]) -> float:
        """The largest distance off the clean path, mm."""
        if not len(went):
            return 0.0
        stands = np.abs(np.diff(np.rint(went / GRAIN_MM), axis=0)).max(axis=1) == 0
        went = went[np.r_[True, ~stands]]
        nearest, at = self._tree.query(went)
        far = nearest > RIGHT_CYCLES / CYCLES_PER_MM / 10
        best = np.where(far, np.inf, nearest)
        for step in (-1, 1):
            one = self._way[at]
            other = self._way[np.clip(at + step, 0, len(self._way) - 1)]
            along = other - one
            share = ((went - one) * along).sum(axis=1) / np.maximum(
                (along**2).sum(axis=1), 1e-30
            )
            foot = one + np.clip(share, 0, 1)[:, None] * along
            best = np.minimum(best, np.linalg.norm(went - foot, axis=1))
        return float(best.max())


def earlier_benches(folder: object) -> tuple[Bench, Bench]:
    """The same as `benches`, of tapes whose counts are sixteenths of a cycle."""
    with mock.patch.object(check_signal, "VERSION", 1):
        return benches(folder)


def benches(folder: object) -> tuple[Bench, Bench]:
    """A circle at 60 mm/s, and a square that stops at its corners from 40 mm/s; Z moves too."""
    fast, square = program(10.0, 60.0), corners(6.0, 40.0)
    fast[:, 2] = 2 - 1.5 * fast[:, 1] / 10.0
    square[:, 2] = 2 - 2 * np.clip(np.arange(len(square)) / 1500, 0, 1)
    return Bench(folder, fast), Bench(folder, square)
