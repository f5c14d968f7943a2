"""Stations along a guide lie on the middle of the ink, wherever the guide lies in it."""

from __future__ import annotations

import numpy as np

from morfax.tracer.ink.felt import feel_along
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, polyline, together

Y_MM = 10.0


def test_where_a_line_is_thinner_its_stations_lie_on_its_middle() -> None:
    """A guide of pixels lies up to half a pixel beside: the stations stayed on it, 60 um off. Where the ink
    is broader than the line another line may join it, and stations do not follow that.
    """
    pieces = (
        (polyline((4, Y_MM), (14, Y_MM)), WIDTH_MM),
        (polyline((18, Y_MM), (28, Y_MM)), WIDTH_MM),
    )
    thin = polyline((13, Y_MM), (19, Y_MM)), 0.5 * WIDTH_MM
    beside = polyline((8, Y_MM + 0.35), (9, Y_MM + 0.35)), WIDTH_MM
    drawing = together(*pieces, thin, beside, seed=1)
    view = View(photocell.behind_aperture(drawing, 0.1), WIDTH_MM)
    felt = feel_along(view, polyline((5, Y_MM + 60 * UM), (27, Y_MM + 60 * UM)))
    x, off_mm = felt.places_mm[:, 0], np.abs(felt.places_mm[:, 1] - Y_MM)
    assert off_mm[(x > 15) & (x < 17)].max() < 15 * UM  # noise of two rims
    assert off_mm[(x > 20) & (x < 26)].max() < 15 * UM
    assert off_mm[(x > 8.3) & (x < 8.7)].max() < 80 * UM
