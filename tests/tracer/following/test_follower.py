"""The follower on whole lines with knots in them: each one path, on the line that was drawn, to its end.

Bounds: 25 um at any place of a plain line, as the issue allows; the end of a line is half a width within the
pen's round, seen by an aperture of 0.15 mm, so the path may be 30 um short of it; at a rounded corner or a
speck the line is known only from ink that is not the line's own.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.contour import pointwise
from morfax.tracer.program.trace import trace
from tests.tracer.following.followed import LINE_MM, SEEDS, followed
from tests.tracer.inked import UM, corner, inked


@pytest.mark.parametrize("deflection_deg", [90, 150])
@pytest.mark.parametrize("shift_mm", [(0.0, 0.0), (0.0, 0.03), (0.03, 0.03)])
def test_a_white_speck_on_the_vertex_does_not_round_it(
    deflection_deg: float, shift_mm: tuple[float, float]
) -> None:
    """One pixel without ink, wherever the vertex lies in it."""
    line = corner(deflection_deg) + shift_mm
    drawing = inked(line, seed=1)
    column, row = (line[1] / drawing.pitch_mm).astype(int)
    drawing.darkness[len(drawing.darkness) - 1 - row, column] = 0
    path = trace(drawing).lines[0].xy_mm
    assert np.hypot(*(path - line[1]).T).min() < 60 * UM


@SEEDS
@pytest.mark.parametrize("deflection_deg", [30.0, 60.0, 90.0, 120.0])
def test_a_sharp_corner(deflection_deg: float, seed: int | None) -> None:
    assert (
        followed(corner(deflection_deg), inked(corner(deflection_deg), seed=seed)).ending
        == "ended"
    )


@SEEDS
def test_an_acute_tip_of_36_degrees(seed: int | None) -> None:
    """The inks of the legs separate only 0.8 mm from the vertex; from there on each must be right, the tip to
    a tenth of that.
    """
    line = corner(144)
    run = followed(line, inked(line, seed=seed), within_mm=80 * UM)
    places, off_mm = pointwise(run.xy_mm[::4], line)
    clean = np.hypot(*(places - line[1]).T) > 0.8
    assert off_mm[clean].max() < LINE_MM
    assert np.hypot(*(run.xy_mm - line[1]).T).min() < 80 * UM


@SEEDS
@pytest.mark.parametrize("width_mm", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("radius_mm", [0.3, 0.5, 0.7, 1.0, 1.5])
def test_a_rounded_corner(radius_mm: float, width_mm: float, seed: int | None) -> None:
    """A sharp one would be off by 0.41 of the radius, 124 um and more; ink tells the radius to the noise of
    an edge, 5 um as a rule.
    """
    line = corner(90, radius_mm)
    followed(line, inked(line, width_mm=width_mm, seed=seed), within_mm=15 * UM)


@pytest.mark.parametrize("radius_mm", [1.0, 1.5])
@pytest.mark.parametrize("inside_mm", [0.1, 0.17, 0.24])
def test_a_white_speck_in_the_edge_of_a_round_does_not_move_the_line_aside(
    radius_mm: float, inside_mm: float
) -> None:
    """One pixel without ink, half-way round; seen through the aperture it moves the middle of the ink by a
    quarter of a pixel, 21 um.
    """
    line = corner(90, radius_mm)
    drawing = inked(line, seed=1)
    half_way = line[len(line) // 2] + (0.25 - inside_mm) * np.array(
        [math.sqrt(0.5), -math.sqrt(0.5)]
    )
    column, row = (half_way / drawing.pitch_mm).astype(int)
    drawing.darkness[len(drawing.darkness) - 1 - row, column] = 0
    followed(line, drawing)
