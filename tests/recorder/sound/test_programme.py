"""Where a recording's programme begins and ends, by its windows of 20 ms."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.recorder.sound.programme import (
    MARGIN,
    SETTLING,
    Programme,
    between_silences,
    programme_within,
    without_silence,
)
from morfax.recorder.sound.source import FileSource

RATE_HZ = 48_000
WINDOW = 960  # 20 ms


def recording(*windows: int) -> np.ndarray:
    """Silence and carriers in turn, each so many windows long, on two tracks."""
    parts = [
        np.full((count * WINDOW, 2), 0.2 * (k % 2), np.float32)
        for k, count in enumerate(windows)
    ]
    return np.concatenate(parts)


def blocks(frames: np.ndarray, size: int) -> Iterator[np.ndarray]:
    """The recording in blocks that fit no window."""
    for first in range(0, len(frames), size):
        yield frames[first : first + size]


@pytest.mark.parametrize("size", [7_001, 1_000_000])
def test_a_programme_begins_0_2_s_behind_its_carriers_and_ends_before_they_fade(
    size: int,
) -> None:
    found = programme_within(blocks(recording(50, 100, 40), size), RATE_HZ)
    assert found == ((50 + SETTLING) * WINDOW, (150 - MARGIN) * WINDOW)


def test_a_recording_without_silence_is_all_programme() -> None:
    assert programme_within(blocks(recording(0, 100), 7_001), RATE_HZ) == (0, 100 * WINDOW)


def test_silence_and_a_click_are_no_programme() -> None:
    assert programme_within(blocks(recording(100), 7_001), RATE_HZ) is None
    assert programme_within(blocks(recording(50, SETTLING - 1, 50), 7_001), RATE_HZ) is None
    assert programme_within(iter([]), RATE_HZ) is None


def test_a_programme_too_short_to_settle_and_to_fade_has_no_frames() -> None:
    first, last = programme_within(blocks(recording(50, SETTLING, 50), 7_001), RATE_HZ)
    assert first == last == (50 + SETTLING) * WINDOW


@pytest.mark.parametrize("size", [7_001, 1_000_000])
def test_what_comes_in_live_is_the_same_programme(size: int) -> None:
    frames = recording(50, 100, 40)
    heard = np.vstack(list(between_silences(blocks(frames, size), RATE_HZ, 9.0, "it")))
    assert len(heard) == (100 - SETTLING - MARGIN) * WINDOW


def opened(file: Path, frames: np.ndarray) -> FileSource:
    """The recording in a sound file."""
    soundfile.write(file, frames, RATE_HZ, subtype="FLOAT")
    return FileSource(file)


def test_a_file_is_read_from_behind_the_silence_to_before_it(tmp_path: Path) -> None:
    file = opened(tmp_path / "a.wav", recording(50, 100, 40))
    heard = without_silence(file)
    assert heard.frames == (100 - SETTLING - MARGIN) * WINDOW
    read = np.concatenate(list(heard.stored_blocks(7_001, 480)))
    assert read.shape == (heard.frames - 480, 2) and (read > 0.19).all()
    heard.close()


@pytest.mark.parametrize("windows", [(0, 100), (100,), (50, SETTLING, 50), (0, 3)])
def test_a_file_without_a_programme_between_silences_stays_as_it_is(
    tmp_path: Path, windows: tuple[int, ...]
) -> None:
    file = opened(tmp_path / "a.wav", recording(*windows))
    assert without_silence(file) is file
    file.close()


def test_a_track_that_is_silent_alone_is_damage_and_stays(tmp_path: Path) -> None:
    frames = recording(0, 100, 40)
    frames[: 30 * WINDOW, 0] = 0
    heard = without_silence(opened(tmp_path / "a.wav", frames))
    assert isinstance(heard, Programme)
    assert heard.frames == (100 - MARGIN) * WINDOW
    assert len(heard.notes) == 1 and "before" not in heard.notes[0]
    heard.close()
