"""Stalks, slits, keyholes and necks: an outline that nearly touches itself is one line, as it is drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import Points, inked, polyline

WIDTH_MM = 0.5
UM = 1e-3


def contours(*drawn: Points) -> list[Line]:
    """The contours of a sheet."""
    return list(trace_lines(inked(*drawn, width_mm=WIDTH_MM, dpi=300, seed=1)).lines)


def points_of(shape: shapely.Polygon) -> Points:
    """The outline of a shape."""
    return polyline(*((float(x), float(y)) for x, y in shape.exterior.coords))


def off_mm(line: Line, truth: Points) -> float:
    """How far the line is from a true one, or that from it."""
    return float(shapely.LinearRing(line.loop_mm).hausdorff_distance(shapely.LineString(truth)))


def bent(radius_mm: float, wide_mm: float) -> shapely.Polygon:
    """A strip of a width along a third of a circle about (20, 12), with round ends."""
    angles = np.linspace(0.6, 2.6, 80)
    middle = np.column_stack([20 + radius_mm * np.cos(angles), 12 + radius_mm * np.sin(angles)])
    return shapely.LineString(middle).buffer(0.5 * wide_mm, quad_segs=16)


def disc(x: float, y: float, radius_mm: float) -> shapely.Polygon:
    """A disc."""
    return shapely.Point(x, y).buffer(radius_mm, quad_segs=90)


def bar(wide_mm: float, x: float, y: float, u: float, v: float) -> shapely.Polygon:
    """A straight strip of a width from place to place."""
    return shapely.LineString([(x, y), (u, v)]).buffer(0.5 * wide_mm, cap_style="flat")


def shapes(wide_mm: float) -> dict[str, shapely.Polygon]:
    """Shapes with two sides so near to each other."""
    plate = shapely.box(5, 5, 40, 25)
    return {
        "bent stalk": disc(31, 18.5, 6).union(bent(12, wide_mm)),
        "bent slit": plate.difference(bent(8, wide_mm)).difference(bar(wide_mm, 26.6, 16.52, 36.5, 2.0)),
        "keyhole": plate.difference(disc(15, 14, 4)).difference(bar(wide_mm, 15, 14, 45, 16)),
        "slit ring": disc(20, 15, 11).difference(disc(20, 15, 8)).difference(bar(wide_mm, 20, 15, 33, 20)),
        "neck": disc(12, 15, 6).union(disc(30, 15, 7)).union(bar(wide_mm, 12, 15, 30, 15)),
    }  # fmt: skip


@pytest.mark.parametrize("widths", [0.5, 0.9, 1.2])
@pytest.mark.parametrize("name", list(shapes(1.0)))
def test_an_outline_that_nearly_touches_itself_is_one_line(name: str, widths: float) -> None:
    """Within 0.1 mm, a pixel and a bit of 300 dpi; without the bar it is off by several mm."""
    truth = points_of(shapes(widths * WIDTH_MM)[name])
    (line,) = contours(truth)
    assert line.ending == "closed" and off_mm(line, truth) < 100 * UM


def test_the_head_follows_the_lines_that_a_bar_joins() -> None:
    """Only the sides of the bar are run from memory: twice 21 mm, and a leg at each of their ends."""
    (line,) = contours(points_of(shapes(0.5 * WIDTH_MM)["keyhole"]))
    redrawn_mm = line.led.lengths_mm(line.xy_mm)[REDRAWN]
    assert 2 * 20 < redrawn_mm < 2 * 26


def test_a_bar_of_one_line_between_two_is_none() -> None:
    ring, hole = points_of(disc(20, 15, 11)), points_of(disc(20, 15, 5))
    lines = contours(ring, hole, polyline((25, 15), (31, 15)))
    assert sorted(round(line.length_mm / math.tau) for line in lines) == [5, 11]


def test_a_bar_of_a_broader_pen_is_none_where_that_pen_has_drawn_a_line() -> None:
    """The bar is 0.7 mm broad, and so is a line that stands alone."""
    broad = (polyline((25, 15), (31, 15)), polyline((5, 28), (35, 28)))
    twice = [
        polyline(*((x, y + side * 0.1) for x, y in way)) for way in broad for side in (1, -1)
    ]
    ring, hole = points_of(disc(20, 15, 11)), points_of(disc(20, 15, 5))
    closed = [line for line in contours(ring, hole, *twice) if line.ending == "closed"]
    assert len(closed) == 2
