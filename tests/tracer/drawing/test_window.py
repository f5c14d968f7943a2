"""A window on a sheet: what the cells see there is what they see of the whole sheet, to the rounding."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.sensing import photocell

PITCH_MM = 25.4 / 300
ROUNDING = 2.4e-7  # of darkness 1: two units in the last place of float32; sums are taken in other parts


@pytest.mark.parametrize("window", [(301, 207, 503, 411), (0, 0, 90, 60), (560, 610, 600, 700)])
@pytest.mark.parametrize("aperture_mm", [0.05, 0.1, 0.1733, 0.24])
def test_cells_see_the_same_in_a_window(
    aperture_mm: float, window: tuple[int, int, int, int]
) -> None:
    sheet = Drawing(np.random.default_rng(3).random((600, 700), np.float32), PITCH_MM)
    top, left, bottom, right = window
    whole = photocell.behind_aperture(sheet, aperture_mm).darkness
    part = photocell.behind_aperture(sheet, aperture_mm, window=window).darkness
    assert part.shape == whole.shape
    off = np.abs(part[top:bottom, left:right] - whole[top:bottom, left:right])
    assert off.max() <= ROUNDING
    if aperture_mm > 0.1:  # a smaller one changes nothing, and the sheet itself is handed out
        part[top:bottom, left:right] = 0
        assert not part.any()
