"""Closed lines that touch, each within its own rim."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.polyline import nearest_mm, with_places
from morfax.tracer.following.line import Line
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import UM, Points, arc, inked, polyline

WIDTH_MM = 0.45


def off_mm(line: Line, truth: Points) -> float:
    """How far a closed line is from the truth, or that from it, at most, mm."""
    way, true = with_places(line.loop_mm, 0.02), with_places(np.asarray(truth), 0.02)
    return max(nearest_mm(way, true).max(), nearest_mm(true, way).max())


def triangle_about(radius_mm: float, apart_mm: float) -> Points:
    """A triangle whose sides are so far from a circle about (10, 10)."""
    normals = [math.radians(a) for a in (5, 130, 250)]
    sides = np.array([[math.cos(a), math.sin(a)] for a in normals])
    reach = np.full(2, radius_mm + apart_mm)
    corners = [np.linalg.solve(sides[[k, (k + 1) % 3]], reach) for k in range(3)]
    return polyline(
        *[(10 + x, 10 + y) for x, y in corners], (10 + corners[0][0], 10 + corners[0][1])
    )


@pytest.mark.parametrize("apart_mm", [0.0, 0.2])
def test_a_circle_and_the_triangle_whose_sides_it_touches_are_both_traced(
    apart_mm: float,
) -> None:
    """Each within 60 um, and nothing is told: the circle was missing, and the triangle 150 um off."""
    circle = arc((10, 10), 3.0, 0, 360)
    triangle = triangle_about(3.0, apart_mm)
    trace = trace_lines(inked(triangle, circle, width_mm=WIDTH_MM, seed=1), "contours")
    outer, inner = sorted(trace.lines, key=lambda line: -line.length_mm)
    assert (outer.ending, inner.ending) == ("closed", "closed")
    assert off_mm(outer, triangle) < 60 * UM
    assert off_mm(inner, circle) < 60 * UM
    assert not trace.unexplained
