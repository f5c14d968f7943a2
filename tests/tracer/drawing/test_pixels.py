"""Pixels: how many are ink, and a picture of oblong ones on square ones."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.scale import on_square_pixels


@pytest.mark.parametrize("seed", [1, 2])
def test_the_ink_of_a_sheet_is_each_pixel_darker_than_half(seed: int) -> None:
    """Counted block by block, with much bare paper between, and to the last row and column."""
    draw = np.random.default_rng(seed)
    darkness = np.zeros((333, 471), np.float32)
    darkness[10:40, 300:] = draw.uniform(0, 1, (30, 171))
    darkness[320:, :25] = draw.uniform(0, 1, (13, 25))
    assert Drawing(darkness, 0.1).ink_px == np.count_nonzero(darkness > 0.5) > 1000


@pytest.mark.parametrize("pitch_mm", [(0.1, 0.2), (0.1, 0.05), (0.125, 0.13)])
def test_a_picture_on_square_pixels_is_as_high_as_before(pitch_mm: tuple[float, float]) -> None:
    """It keeps its columns; a row's place stays where it was, mm."""
    grey = np.repeat(np.linspace(0, 255, 200, dtype=np.float32)[:, None], 60, axis=1)
    square = on_square_pixels(grey, pitch_mm)
    across_mm, down_mm = pitch_mm
    assert square.shape[1] == 60
    assert square.shape[0] * across_mm == pytest.approx(200 * down_mm, abs=across_mm)
    middle = square[len(square) // 2 - 1 : len(square) // 2 + 1, 30].mean()
    assert middle == pytest.approx(127.5, abs=1.5)
