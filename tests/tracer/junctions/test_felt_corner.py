"""Corners felt round: a way round a corner that the line was felt round is where it was felt."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from morfax.motion import curves
from morfax.motion.arrays import Array
from morfax.tracer.head.plan import Plan
from morfax.tracer.junctions.felt_corner import is_as_felt
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.leg import leg_of, turn
from morfax.tracer.sensing.view import View
from tests.tracer.inked import arc, inked, polyline

WIDTH_MM = 0.3
DEFLECTION = math.radians(60)


def line(radius_mm: float) -> Array:
    """A line along X that turns left at x = 8 mm, sharply or along a round."""
    touch_mm = radius_mm * math.tan(DEFLECTION / 2)
    vertex, way = np.array([8.0, 5.0]), np.array([math.cos(DEFLECTION), math.sin(DEFLECTION)])
    if radius_mm == 0:
        return polyline((3, 5), (8, 5), (*(vertex + 5 * way),))
    bend = arc((8 - touch_mm, 5 + radius_mm), radius_mm, -90, -90 + math.degrees(DEFLECTION))
    return np.vstack([[3.0, 5.0], bend, vertex + 5 * way])


def felt(radius_mm: float) -> tuple[View, Array]:
    """The view of that line, and its stations from 1.5 mm before the vertex on."""
    drawing = inked(line(radius_mm), width_mm=WIDTH_MM, seed=1)
    view = View(photocell.behind_aperture(drawing, 0.1), WIDTH_MM)
    seen = view.feel(np.array([6.5, 5.0]), 0.0, 3.0)
    assert len(seen) > 55  # clean all the way round
    return view, seen


@pytest.mark.parametrize(
    ("radius_mm", "is_felt"), [(0.0, True), (0.3, True), (0.9, False), (1.3, False)]
)
def test_a_way_by_the_vertex_is_taken_only_where_the_line_was_felt_there(
    radius_mm: float, is_felt: bool
) -> None:
    """The vertex is 46 um off a round of 0.3 mm, and 139 um off one of 0.9 mm: r·(1/cos 30° - 1).

    Of a sharp corner it may be 78 um off: 23 um that the middle of its ink may be inside, and 55 um of single
    stations.
    """
    view, seen = felt(radius_mm)
    legs = leg_of(seen[:16], True, view.leg_mm), leg_of(seen[-16:], False, view.leg_mm)
    way = polyline(
        (6.5, 5), (8, 5), (8 + 0.7 * math.cos(DEFLECTION), 5 + 0.7 * math.sin(DEFLECTION))
    )
    stretches = [np.linspace(a, b, 40) for a, b in pairwise(way)]
    deflection = abs(turn(legs[0].heading_rad, legs[1].heading_rad))
    assert deflection == pytest.approx(DEFLECTION, abs=math.radians(2))
    assert is_as_felt(view, Plan(stretches, legs[1]), seen, deflection) is is_felt
    assert is_as_felt(view, Plan([curves.distinct(seen[:, :2])], legs[1]), seen, deflection)
