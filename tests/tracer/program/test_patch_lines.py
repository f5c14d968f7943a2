"""Lines of a patch: a line that was followed alone is what it is beside the others of its ink."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.polyline import area_mm2, nearest_mm, with_places
from morfax.tracer.following.direction import Direction
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program import patch_lines, trace
from morfax.tracer.program.patch_lines import among_others
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import arc, inked, polyline

OFF_MM = 0.06  # of a line that shares its ink: what it asks for of any outline


def inscribed() -> tuple[Array, Array]:
    """A triangle, and the circle within it that touches its sides."""
    corners = np.array([(6.0, 5.0), (34.0, 8.0), (15.0, 30.0)])
    sides = np.array([math.dist(corners[k - 2], corners[k - 1]) for k in range(3)])
    middle = sides @ corners / sides.sum()
    radius_mm = 2 * abs(area_mm2(corners)) / sides.sum()
    places = [(float(x), float(y)) for x, y in (*corners, corners[0])]
    return polyline(*places), arc((float(middle[0]), float(middle[1])), float(radius_mm))


def along() -> tuple[Array, Array]:
    """Two plates that have a part of a side in common."""
    left = polyline((5, 5), (18, 5), (18, 24), (5, 24), (5, 5))
    return left, polyline((18, 10), (34, 10), (34, 20), (18, 20), (18, 10))


def crossed() -> tuple[Array, Array]:
    """A circle, and a line that goes from its middle out beyond it."""
    return arc((16, 16), 9), polyline((16, 16), (34, 22))


def off_mm(line: Line, drawn: Array) -> float:
    """How far a line and what was drawn are apart at the worst."""
    there = nearest_mm(line.loop_mm, with_places(drawn, 0.02)).max()
    back = nearest_mm(with_places(drawn, 0.02), line.loop_mm).max()
    return float(max(there, back))


@pytest.mark.parametrize("direction", ["cw", "ccw"])
@pytest.mark.parametrize("drawn", [inscribed(), along()], ids=["in", "along"])
def test_a_plain_trace_of_lines_that_share_ink_is_one_of_them(
    drawn: tuple[Array, Array], direction: Direction
) -> None:
    found = trace.trace(inked(*drawn, seed=3), operator=Operator(direction=direction))
    (line,) = found.lines
    assert line.ending == "closed" and line.number == 1
    assert min(off_mm(line, each) for each in drawn) < OFF_MM
    assert (area_mm2(line.loop_mm) > 0) == (direction == "ccw")
    assert any(place.kind == "ink" for place in found.unexplained)  # the other one is told


def test_where_the_head_comes_by_an_open_line_the_closed_one_is_taken() -> None:
    circle, out = crossed()
    (line,) = trace.trace(inked(circle, out, seed=3)).lines
    assert line.ending == "closed" and off_mm(line, circle) < OFF_MM


@pytest.mark.parametrize("direction", ["cw", "ccw"])
def test_contours_that_share_ink_go_the_way_round_that_is_asked_for(
    direction: Direction,
) -> None:
    lines = trace_lines(
        inked(*inscribed(), seed=3), operator=Operator(direction=direction)
    ).lines
    assert [line.ending for line in lines] == ["closed"] * 2
    assert all((area_mm2(line.loop_mm) > 0) == (direction == "ccw") for line in lines)


def test_lines_that_leave_ink_which_it_explains_do_not_go_before_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    setup = Setup(inked(*inscribed(), seed=3).sheet)
    lines = trace_lines(setup.sheet.drawing).lines
    alone, other = sorted(lines, key=lambda line: -line.length_mm)
    monkeypatch.setattr(patch_lines, "lines_of_patch", lambda *_: [other])
    assert among_others(setup, alone) is None
    monkeypatch.setattr(patch_lines, "lines_of_patch", lambda *_: [alone, other])
    told = among_others(setup, alone)
    assert told is not None and off_mm(told[0], inscribed()[0]) < OFF_MM
