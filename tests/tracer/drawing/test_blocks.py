"""Blocks: what a spot sees near dark blocks is what OpenCV's sees everywhere, to the bit."""

import cv2
import numpy as np
import pytest

from morfax.tracer.drawing import blocks
from morfax.tracer.drawing.blocks import Blocks, darkest, in_parts, near, runs_behind_spot
from morfax.tracer.drawing.components import runs_of

BY = 16


def sheet(rows: int = 333, columns: int = 517) -> np.ndarray:
    """Paper with noise, and a few lines; some meet the edges."""
    chance = np.random.default_rng(5)
    picture = chance.normal(0, 0.05, (rows, columns)).astype(np.float32)
    for x0, y0, x1, y1 in ((0, 10, 516, 300), (400, 0, 400, 332), (20, 320, 90, 332)):
        cv2.line(picture, (x0, y0), (x1, y1), 1.0, 5)
    return picture


@pytest.mark.parametrize("spread_px", [0.7, 1.0])
@pytest.mark.parametrize("level", [0.3, 0.5])
def test_runs_are_those_of_a_whole_blur(spread_px: float, level: float) -> None:
    picture = sheet()
    dark = near(darkest(picture, BY) > level)
    assert 0 < dark.mean() < 0.9  # some blocks hold paper alone
    soft = cv2.GaussianBlur(picture, (0, 0), spread_px)
    expected = runs_of(soft > np.float32(level), 0)
    for one, other in zip(
        expected, runs_behind_spot(picture, dark, BY, spread_px, level), strict=True
    ):
        assert np.array_equal(one, other)


def test_two_threads_see_what_one_sees(monkeypatch: pytest.MonkeyPatch) -> None:
    picture = sheet()
    dark = near(darkest(picture, BY) > 0.5)
    alone = runs_behind_spot(picture, dark, BY, 0.7, 0.5)
    monkeypatch.setattr(blocks, "FEW_PX", 1)
    for one, other in zip(alone, runs_behind_spot(picture, dark, BY, 0.7, 0.5), strict=True):
        assert np.array_equal(one, other)


def test_a_fault_of_the_other_thread_is_raised(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blocks, "FEW_PX", 1)

    def work(first: int, last: int) -> None:
        if first:
            raise MemoryError

    with pytest.raises(MemoryError):
        in_parts(100, 10, work)


@pytest.mark.parametrize("by", [4, 5, 16])
def test_means_repeat_the_last_pixels(by: int) -> None:
    grey = np.random.default_rng(1).integers(0, 256, (101, 67)).astype(np.uint8)
    whole = np.pad(grey, ((0, -101 % by), (0, -67 % by)), mode="edge")
    squares = whole.reshape(len(whole) // by, by, -1, by).swapaxes(1, 2)
    found = Blocks.of(grey, by)
    # float32 has 24 bits: a level of 255 is rounded by 1.5e-5 at most
    assert np.abs(found.mean - squares.mean((2, 3))).max() < 2e-5
    assert np.array_equal(found.low, squares.min((2, 3)))
    assert np.array_equal(found.high, squares.max((2, 3)))
