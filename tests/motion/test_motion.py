"""Motion and Path: thinning keeps its tolerance, and a path gives its motion back."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.motion import (
    MOTION_RATE_HZ,
    THINNING_TOLERANCE_MM,
    Motion,
    Path,
    join,
    thin,
    thinned,
)

ROUNDING_MM = 1e-9  # of float64 slopes over some 10 000 samples and some 100 mm


def wander(seed: int, samples: int, largest_mm_s: float = 30.0) -> np.ndarray:
    """A motion of three axes with random bends, stops and straight pieces, (samples, 3) mm."""
    random = np.random.default_rng(seed)
    knots = random.uniform(-largest_mm_s, largest_mm_s, (8, 3)) * (random.random((8, 1)) > 0.3)
    at = np.linspace(0, 7, samples)
    speed = np.column_stack([np.interp(at, np.arange(8), column) for column in knots.T])
    return np.cumsum(speed, axis=0) / MOTION_RATE_HZ


def in_blocks(positions: np.ndarray, sizes: list[int], start_s: float = 0.0) -> list[Motion]:
    cuts = np.clip(np.cumsum([0, *sizes, len(positions)]), 0, len(positions))
    return [
        Motion(positions[a:b], MOTION_RATE_HZ, start_s + a / MOTION_RATE_HZ)
        for a, b in pairwise(cuts)
    ]


@given(st.integers(0, 10_000), st.integers(1, 3000), st.lists(st.integers(0, 1500), max_size=4))
def test_thinning_gives_every_sample_back(seed: int, samples: int, sizes: list[int]) -> None:
    positions = wander(seed, samples)
    path = thin(in_blocks(positions, sizes))
    t_s = np.arange(samples) / MOTION_RATE_HZ
    again = np.column_stack(
        [np.interp(t_s, path.t_s, column) for column in path.positions_mm.T]
    )
    assert np.abs(again - positions).max() <= THINNING_TOLERANCE_MM + ROUNDING_MM


@given(st.integers(0, 10_000), st.lists(st.integers(0, 1500), max_size=4))
def test_thinning_does_not_depend_on_the_blocks(seed: int, sizes: list[int]) -> None:
    positions = wander(seed, 2000)
    whole, cut = thin([Motion(positions)]), thin(in_blocks(positions, sizes))
    assert np.array_equal(whole.t_s, cut.t_s)
    assert np.array_equal(whole.positions_mm, cut.positions_mm)


def test_thinning_holds_no_more_than_a_block() -> None:
    """The pieces come with the blocks: each before the next but one is asked for."""
    asked: list[int] = []

    def stream() -> Iterator[Motion]:
        for number, block in enumerate(in_blocks(wander(3, 4000), [1000, 1000, 1000])):
            asked.append(number)
            yield block

    for piece in thinned(stream()):
        assert piece.t_s[-1] * MOTION_RATE_HZ >= 1000 * (len(asked) - 1) - 1000
    assert asked == [0, 1, 2, 3]


def test_a_straight_motion_needs_two_points() -> None:
    line = np.outer(np.arange(50_000) / MOTION_RATE_HZ, [10.0, -3.0, 0.0])
    assert len(thin([Motion(line)]).t_s) == 2


def test_thinning_a_circle_saves_what_its_sagitta_allows() -> None:
    # a chord of a circle keeps within ±e where it spans sqrt(16 e R) at most, here 0.25 mm of the 80 mm
    t_s = np.arange(48_000) / MOTION_RATE_HZ
    circle = 20 * np.column_stack([np.cos(t_s / 2), np.sin(t_s / 2), 0 * t_s])
    path = thin([Motion(circle)])
    chord_mm = np.sqrt(16 * THINNING_TOLERANCE_MM * 20)
    assert len(path.t_s) <= 2.5 * 80 / chord_mm


def test_the_start_time_stays() -> None:
    path = thin([Motion(np.zeros((10, 3)), MOTION_RATE_HZ, 5.0)])
    assert path.t_s[0] == 5.0
    assert path.t_s[-1] == pytest.approx(5.0 + 9 / MOTION_RATE_HZ)


def test_a_stream_of_nothing_is_misuse() -> None:
    with pytest.raises(ValueError, match="empty"):
        thin([])
    with pytest.raises(ValueError, match="empty"):
        join([])


@given(st.integers(0, 10_000), st.integers(1, 5000))
def test_a_path_streams_as_the_motion_that_it_was(seed: int, block_samples: int) -> None:
    positions = wander(seed, 3000)
    again = join(thin([Motion(positions)]).motion(block_samples=block_samples))
    assert again.positions_mm.shape == positions.shape
    assert np.abs(again.positions_mm - positions).max() <= THINNING_TOLERANCE_MM + ROUNDING_MM


def test_runs_are_what_the_tool_does_in_the_work() -> None:
    z = np.array([2.0, -5.0, -5.0, 2.0, 2.0, 0.05, 0.0])
    path = Path(np.arange(7.0), np.column_stack([np.arange(7.0), np.zeros(7), z]))
    assert [run[:, 0].tolist() for run in path.runs()] == [[1.0, 2.0], [5.0, 6.0]]


def test_times_and_duration() -> None:
    block = Motion(np.zeros((6000, 3)), start_s=1.0)
    assert block.duration_s == 1.0
    assert block.times_s[0] == 1.0
    assert block.times_s[-1] == pytest.approx(1.0 + 5999 / 6000)
