"""Plain samples: the frames as libsndfile has them, from any place; a file that gets shorter meanwhile."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.faults import TapeFault
from morfax.recorder.sound.plain import PlainSamples
from morfax.recorder.sound.source import FileSource

FRAMES = np.random.default_rng(3).uniform(-1, 1, (1000, 4)).astype(np.float32)


def written(file: Path, container: str, sample: str) -> Path:
    """A sound file with a text chunk in front of its frames."""
    with soundfile.SoundFile(file, "w", 48000, 4, sample, format=container) as sound:
        sound.comment = "odd"
        sound.write(FRAMES)
    return file


@pytest.mark.parametrize("container", ["WAV", "WAVEX", "RF64"])
@pytest.mark.parametrize(("sample", "kind"), [("PCM_16", "int16"), ("FLOAT", "float32")])
def test_frames_are_those_of_libsndfile(
    tmp_path: Path, container: str, sample: str, kind: str
) -> None:
    file = written(tmp_path / "a.wav", container, sample)
    wanted = soundfile.read(file, dtype=kind)[0]
    source = FileSource(file)
    assert source._plain is not None
    for first in (0, 7, 999):
        blocks = list(source.stored_blocks(64, first))
        assert (np.concatenate(blocks) == wanted[first:]).all()
        assert {block.dtype for block in blocks} == {np.dtype(kind)}
    source.close()


@pytest.mark.parametrize(
    ("container", "sample"), [("WAV", "PCM_24"), ("FLAC", "PCM_16"), ("AIFF", "PCM_16")]
)
def test_other_kinds_are_left_to_libsndfile(
    tmp_path: Path, container: str, sample: str
) -> None:
    file = written(tmp_path / "a.snd", container, sample)
    assert PlainSamples.of(file, container, sample, 4) is None


def test_a_file_cut_short_under_way_is_a_fault(tmp_path: Path) -> None:
    source = FileSource(written(tmp_path / "a.wav", "WAV", "PCM_16"))
    assert source.name == str(tmp_path / "a.wav")  # by which its faults call it
    blocks = source.stored_blocks(500)
    next(blocks)
    os.truncate(source.file, source.file.stat().st_size - 400 * 8 - 3)
    held = next(blocks)
    assert len(held) == 99  # whole frames of 8 bytes that are left: 100 less three bytes
    with pytest.raises(TapeFault, match="cut short"):
        next(blocks)
    source.close()


def test_a_flac_that_ends_early_is_cut_short(tmp_path: Path) -> None:
    noise = np.random.default_rng(1).uniform(-0.5, 0.5, (20_000, 2)).astype(np.float32)
    soundfile.write(tmp_path / "a.flac", noise, 48_000, "PCM_16")
    whole = FileSource(tmp_path / "a.flac")
    assert whole.frames == len(noise)
    whole.close()
    data = (tmp_path / "a.flac").read_bytes()
    (tmp_path / "a.flac").write_bytes(data[: len(data) // 2])
    with pytest.raises(TapeFault, match="cut short"):
        FileSource(tmp_path / "a.flac")


def test_a_file_cut_short_says_how_long_it_is_and_how_long_it_should_be(tmp_path: Path) -> None:
    file = tmp_path / "a.wav"
    soundfile.write(file, np.zeros((48_000, 4)), 24_000, "PCM_16")
    whole = file.stat().st_size
    os.truncate(file, whole - 36_000 * 8)
    with pytest.raises(TapeFault, match=r"0\.5\d* s.* 2\.0*"):
        FileSource(file)


@pytest.mark.parametrize(("sample", "kind"), [("PCM_16", np.int16), ("PCM_24", np.float32)])
def test_samples_of_16_bit_come_as_they_are_stored_and_others_as_floats(
    tmp_path: Path, sample: str, kind: type
) -> None:
    source = FileSource(written(tmp_path / "a.flac", "FLAC", sample))
    assert {block.dtype for block in source.stored_blocks(400)} == {np.dtype(kind)}
    source.close()
