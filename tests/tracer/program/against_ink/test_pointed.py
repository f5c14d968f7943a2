"""Pointed tips: a way is looked at for them only where it turns by as much anywhere.

Broken on purpose, with the first look turned round, a circle is looked at and a tip is not.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.polyline import evenly, length_mm, with_places
from morfax.tracer.following.line import Line
from morfax.tracer.limits import TIP_RAD
from morfax.tracer.program.against_ink.pointed import LEG, _turns_by, points_of
from tests.tracer.inked import WIDTH_MM, polyline
from tests.tracer.sensing.kernels import COMPILED_AND_PLAIN, kernel


@COMPILED_AND_PLAIN
@pytest.mark.parametrize("share", [0.7, 0.98, 1.02, 1.3])
def test_a_way_turns_by_an_angle_or_does_not(share: float, plain: bool) -> None:
    asked_rad = TIP_RAD
    turns = np.linspace(0.0, math.tau, 2000)
    circle = np.column_stack([np.cos(turns), np.sin(turns)])[:-1]
    # on a circle each chord turns by its angle from the middle
    leg = round(share * asked_rad / (turns[1] - turns[0]))
    assert kernel(_turns_by, plain)(circle, leg, asked_rad) == (share > 1)


def test_only_lines_with_sharp_corners_have_tips() -> None:
    turns = np.linspace(0.0, math.tau, 400)
    circle = 5.0 * np.column_stack([np.cos(turns), np.sin(turns)])
    spike = polyline((0.0, 0.0), (10.0, 2.5), (0.0, 5.0), (0.0, 0.0))
    for way, tips in ((circle, 0), (spike, 1)):
        fine = with_places(way, 0.01)
        line = Line(fine, "closed", WIDTH_MM, length_mm(fine))
        sides = list(points_of(line))
        assert len(sides) == 2 * tips
        assert _turns_by(evenly(fine, 0.125 * WIDTH_MM), LEG, TIP_RAD) == bool(tips)
