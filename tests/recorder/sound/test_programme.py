"""Where a recording's programme begins and ends, by its windows of 20 ms."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from morfax.recorder.sound.programme import (
    MARGIN,
    SETTLING,
    between_silences,
    programme_within,
)

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
