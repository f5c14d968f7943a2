"""Felt along one of its edges a line goes on past what runs beside it, and turns back only where two lines
ran together to a tip.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.contour import distance
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.program.trace import trace
from tests.tracer.inked import DPI, UM, inked, polyline

PIXEL_MM = MM_PER_INCH / DPI


def test_the_blunt_corner_of_a_tooth_is_no_tip_at_which_the_line_turns_back() -> None:
    """The ink ends ahead of it as at a tip, but the way back would be that by which the head came: from the
    sixth tooth it went back along it, and ended 15 mm before its end.
    """
    pitch_mm = 2.64
    teeth = [
        (k * pitch_mm + x, y)
        for k in range(8)
        for x, y in ((0.0, 0.0), (0.6, 1.9), (1.04, 1.9), (1.64, 0.0))
    ]
    places = np.array([(-4.0, 0.0), *teeth, (8 * pitch_mm + 4, 0.0)])
    c, s = np.cos(2.0), np.sin(2.0)
    places = places @ np.array([[c, s], [-s, c]])
    line = polyline(*(places - places.min(axis=0) + 5))
    run = trace(inked(line, width_mm=0.7, seed=3)).lines[0]
    assert distance(line, run.xy_mm).path_to_reference.max_mm < 1.5 * PIXEL_MM
    assert distance(run.xy_mm, line).path_to_reference.rms_mm < 20 * UM
