"""Stations along a guide lie on the middle of the ink, wherever the guide lies in it."""

from __future__ import annotations

import numpy as np

from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.felt import feel_along, judged
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.stretches import FeltSheet
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


def test_ink_that_tapers_on_a_clean_sheet_is_no_rough_line() -> None:
    """Two lines come together, and one ends in the other: the ink is clean line where it is as narrow as one.

    (The taper was taken for roughness, and its last 3.6 mm for clean line.)
    """
    end, slope = np.array([16.0, Y_MM + 0.05]), 0.06
    other = np.array([end - 12 * np.array([np.cos(slope), -np.sin(slope)]), end])
    drawing = together((polyline((4, Y_MM), (26, Y_MM)), WIDTH_MM), (other, WIDTH_MM), seed=1)
    view = View(photocell.behind_aperture(drawing, 0.1), WIDTH_MM)
    guide = np.array([(12, Y_MM + 0.145), (16, Y_MM + 0.025), (16.2, Y_MM), (19.5, Y_MM)])
    felt = judged(feel_along(view, guide), WIDTH_MM, is_smooth=True)
    # a fifth of the width broader, and half a pixel, at 14.6 mm
    assert felt.stations.places_mm[felt.clean, 0].min() > 14.5


def test_two_lines_with_a_slit_between_are_as_broad_as_to_their_rims() -> None:
    """The slit is lighter than their ink: a level of half of it lay 0.05 mm outside of either rim."""
    apart_mm = 1.2 * WIDTH_MM
    lines = (polyline((5, y), (35, y)) for y in (Y_MM, Y_MM + apart_mm))
    left = ink_left(together(*((line, WIDTH_MM) for line in lines), seed=1).sheet, 0.0)
    (felt,) = FeltSheet.of(left.drawing, Settings(), left.ink).measured
    assert abs(felt.width_mm - WIDTH_MM - apart_mm) < 0.04  # one line is felt 0.02 too broad
