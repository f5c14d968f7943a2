"""Where outlines touch, or one nearly touches itself, each side keeps to its own rim."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from morfax.tracer.following.line import Line
from morfax.tracer.program.laid import touches
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import Points, inked, polyline

WIDTH_MM = 0.5
UM = 1e-3
LEVEL = math.radians(7)


def circle(x: float, y: float, radius_mm: float) -> Points:
    """A circle."""
    angles = np.linspace(0, math.tau, 361)
    return np.column_stack([x + radius_mm * np.cos(angles), y + radius_mm * np.sin(angles)])


def turned(points: Points) -> Points:
    """Points turned by a few degrees about (20, 15): no line runs along the pixels."""
    c, s = math.cos(LEVEL), math.sin(LEVEL)
    return (points - [20, 15]) @ np.array([[c, s], [-s, c]]) + [20, 15]


def plate() -> Points:
    """A plate of 28 x 20 mm."""
    return polyline((6, 5), (34, 5), (34, 25), (6, 25), (6, 5))


def peanut(apart_mm: float) -> Points:
    """A figure of two lobes whose sides come so near to each other."""
    lobes = (
        shapely.Point(12, 15)
        .buffer(7, quad_segs=90)
        .union(shapely.Point(28, 15).buffer(7, quad_segs=90))
    )
    whole = lobes.union(shapely.box(12, 12, 28, 18)).difference(
        shapely.Point(20, 15 + 8 + apart_mm / 2).buffer(8, quad_segs=90)
    )
    whole = whole.difference(shapely.Point(20, 15 - 8 - apart_mm / 2).buffer(8, quad_segs=90))
    return polyline(*((float(x), float(y)) for x, y in whole.exterior.coords))


def closed(*drawn: Points, width_mm: float = WIDTH_MM, dpi: float = 300) -> list[Line]:
    """The closed contours of a sheet, the longest first."""
    trace = trace_lines(inked(*drawn, width_mm=width_mm, dpi=dpi, seed=1))
    lines = [line for line in trace.lines if line.ending == "closed"]
    return sorted(lines, key=lambda line: -line.length_mm)


def off_mm(line: Line, truth: Points) -> float:
    """How far the line is from a true one, or that from it."""
    return float(shapely.LinearRing(line.loop_mm).hausdorff_distance(shapely.LineString(truth)))


@pytest.mark.parametrize("apart_widths", [0.05, 0.4, 0.75, 0.95])
def test_a_hole_that_touches_the_outline_from_within_keeps_to_its_rim(
    apart_widths: float,
) -> None:
    """Within 80 um, a pixel of 300 dpi; where the head goes over to the other it is 0.15 mm off or more."""
    radius_mm = 7.0
    drawn = [plate(), circle(19, 5 + radius_mm + apart_widths * WIDTH_MM, radius_mm)]
    truths = [turned(each) for each in drawn]
    lines = closed(*truths)
    assert len(lines) == 2
    for line, truth in zip(lines, truths, strict=True):
        assert off_mm(line, truth) < 80 * UM


def test_an_outline_that_comes_near_to_itself_does_not_go_over_to_its_other_side() -> None:
    """Within 60 um, half a pixel of 200 dpi; a figure of eight is 0.2 mm off."""
    truth = turned(peanut(0.42))
    (line,) = closed(truth, width_mm=0.35, dpi=200)
    assert off_mm(line, truth) < 60 * UM


def test_circles_that_cross_at_a_small_angle_still_cross(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two circles of 8 mm whose middles are 1.4 mm apart: they cross at 10 degrees. The head's ways explain
    their ink, and no rims are felt.
    """
    monkeypatch.setattr(touches, "_rims", None)
    truths = [turned(circle(19, 15, 8)), turned(circle(20.4, 15, 8))]
    lines = closed(*truths)
    assert len(lines) == 2
    first, second = (shapely.LinearRing(line.loop_mm) for line in lines)
    crossings = first.intersection(second)
    assert isinstance(crossings, shapely.MultiPoint) and len(crossings.geoms) == 2
