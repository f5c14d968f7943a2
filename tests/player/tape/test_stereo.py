"""A tape in two stereo files: joined by its check signal, whatever their clocks and starts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.arrays import Array
from morfax.motion.contour import distances_mm
from morfax.motion.faults import TapeFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.playback import TapePlayback, play
from morfax.player.tape.stereo import StereoSource
from morfax.recorder.sound.source import FileSource, Source
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.tape.halves import half_names, record_halves
from morfax.recorder.wear.settings import Wear
from morfax.recorder.wear.transport import age
from tests.player.worn import program

UM = 1e-3
MOTION = Motion(program(5.0))


@pytest.fixture(scope="module")
def halves(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A tape in two files."""
    file = tmp_path_factory.mktemp("halves") / "a.wav"
    record_halves(MOTION, file, TapeFormat(checked=True))
    return half_names(file)


def played(one: Path, other: Path) -> TapePlayback:
    """The machine with both files in it."""

    def opened() -> Source:
        return StereoSource(FileSource(one), FileSource(other))

    return play(opened)


def off_um(path_mm: Array) -> float:
    """The largest distance of a path from the motion's own line, um."""
    return float(distances_mm(path_mm[::31, :2], MOTION.positions_mm[:, :2]).max()) / UM


def later(source: Path, target: Path, seconds: float) -> Path:
    """The file of a recorder that was started sooner: hiss before it and behind it, the same text."""
    frames, rate_hz = soundfile.read(source)
    hiss = np.random.default_rng(3).normal(0, 1e-4, (round(seconds * rate_hz), 2))
    with (
        soundfile.SoundFile(source) as old,
        soundfile.SoundFile(target, "w", rate_hz, 2) as new,
    ):
        new.comment = old.comment
        new.write(np.vstack([hiss, frames, hiss]))
    return target


def test_two_halves_are_the_tape(halves: tuple[Path, Path]) -> None:
    playback = played(*halves)
    path_mm = join(playback).positions_mm
    # um: the delay that the player measures against the other file, true to 0.1 us of 6 kHz, and the drives
    assert off_um(path_mm) < 1.0
    assert playback.end_error_mm is not None and np.abs(playback.end_error_mm).max() < 1 * UM


@pytest.mark.parametrize("turned", [False, True])
def test_clocks_and_starts_may_differ(
    halves: tuple[Path, Path], tmp_path: Path, turned: bool
) -> None:
    age(halves[1], tmp_path / "fast.wav", Wear(speed=2e-4))
    one = later(halves[0], tmp_path / "one.wav", 0.3)
    other = later(tmp_path / "fast.wav", tmp_path / "other.wav", 0.75)
    playback = played(other, one) if turned else played(one, other)
    assert off_um(join(playback).positions_mm) < 1.0


def test_two_files_that_are_no_halves(halves: tuple[Path, Path], tmp_path: Path) -> None:
    with pytest.raises(TapeFault, match="no two halves of a tape"):
        played(halves[0], halves[0])
    record_halves(MOTION, tmp_path / "bare.wav", TapeFormat())
    with pytest.raises(TapeFault, match="no check signal that can be read"):
        played(halves[0], half_names(tmp_path / "bare.wav")[1])
    soundfile.write(tmp_path / "still.wav", np.zeros((96_000, 2)), 48_000)
    with pytest.raises(TapeFault, match="holds no carriers"):
        played(halves[0], tmp_path / "still.wav")


def test_a_transport_that_flutters_by_itself_is_refused(
    halves: tuple[Path, Path], tmp_path: Path
) -> None:
    age(halves[1], tmp_path / "worn.wav", Wear(wow=2e-3))
    with pytest.raises(TapeFault, match=r"flutter|wander"):
        join(played(halves[0], tmp_path / "worn.wav"))
