"""A line that becomes broader or thinner is clean line at each of its widths, if it keeps that."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.ink.felt import feel_along, judged
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, polyline, together

Y_MM = 10.0


@pytest.mark.parametrize("times", [0.6, 1.7])
def test_a_line_that_goes_on_with_another_pen_is_clean_on_either_side(times: float) -> None:
    other_mm = times * WIDTH_MM
    drawing = together(
        (polyline((4, Y_MM), (16, Y_MM)), WIDTH_MM),
        (polyline((16, Y_MM), (32, Y_MM)), other_mm),
    )
    view = View(photocell.behind_aperture(drawing, 0.1), WIDTH_MM)
    felt = judged(feel_along(view, polyline((5, Y_MM), (31, Y_MM))), WIDTH_MM)
    runs, _ = felt.runs()
    first, second = sorted(runs, key=lambda run: run.places_mm[0, 0])
    assert np.median(first.widths_mm) == pytest.approx(WIDTH_MM, abs=30 * UM)
    assert np.median(second.widths_mm) == pytest.approx(other_mm, abs=30 * UM)
    assert second.view.width_mm == pytest.approx(other_mm, abs=30 * UM)
    # each of them up to a few stations from where the pen was changed
    assert first.places_mm[-1, 0] > 15.0 and second.places_mm[0, 0] < 17.0
