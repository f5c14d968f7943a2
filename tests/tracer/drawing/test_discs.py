"""Discs: a picture without strokes that are narrower, to the bit as OpenCV closes and opens it."""

import cv2
import numpy as np
import pytest

from morfax.tracer.drawing import discs
from morfax.tracer.drawing.discs import disc, without_dark, without_light


def paper(rows: int, columns: int) -> np.ndarray:
    return np.random.default_rng(1).normal(200, 20, (rows, columns)).astype(np.float32)


@pytest.mark.parametrize("radius_px", [0, 1, 5, 8, 12, 17])
@pytest.mark.parametrize("shape", [(60, 81), (7, 9), (1, 60), (40, 1)])
def test_it_is_the_same_to_the_bit(radius_px: int, shape: tuple[int, int]) -> None:
    levels = paper(*shape)
    for kind, without in (cv2.MORPH_CLOSE, without_dark), (cv2.MORPH_OPEN, without_light):
        expected = cv2.morphologyEx(levels, kind, disc(radius_px))
        assert np.array_equal(without(levels, radius_px), expected)


def test_a_stroke_is_gone_and_what_is_broader_than_the_disc_stays() -> None:
    levels = np.full((60, 60), 240, np.float32)
    levels[:, 10:15] = 30
    levels[20:40, 30:50] = 60
    expected = np.where(levels == 60, np.float32(60), np.float32(240))
    closed = without_dark(levels, 4)
    differs = closed != expected  # the square's corners are rounded
    assert np.array_equal(differs, differs & (expected == 60))
    assert closed[:, 10:15].min() == 240
    assert closed[22:38, 32:48].max() == 60


def test_the_kernel_is_what_its_plain_function_says(monkeypatch: pytest.MonkeyPatch) -> None:
    levels, expected = paper(9, 12), without_dark(paper(9, 12), 2)
    for name in ("_widened", "_raise"):
        monkeypatch.setattr(discs, name, getattr(discs, name).py_func)
    assert np.array_equal(without_dark(levels, 2), expected)
