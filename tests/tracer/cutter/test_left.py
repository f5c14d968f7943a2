"""What a cutter leaves: stretches in corners in closed form, and whole lines; on lines of exact shape."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.faults import MotionFault
from morfax.motion.polyline import at_lengths, lengths_mm
from morfax.tracer.cutter.cutter import LEFT_MM, Cutter, Left, with_cutter
from morfax.tracer.following.line import Line
from morfax.tracer.marks.marks import Mark
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.program import Trace
from tests.tracer.inked import UM
from tests.tracer.program.test_program import WORK

FEED_MM_S = 10.0
STEP_MM = 10.0 / 6000  # of a head at 10 mm/s
LOOKED_AT_MM = 0.02  # of a line: at places so far apart
SQUARE = np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]])


def closed(corners: Array, number: int = 1, begin: float = 0.5) -> Line:
    """A closed line through corners, begun at a share of its first side."""
    start = corners[0] + begin * (corners[1] - corners[0])
    way = np.vstack([start, corners[1:], corners[:1], start])
    long_mm = lengths_mm(way)[-1]
    xy_mm = at_lengths(way, np.linspace(0, long_mm, round(long_mm / STEP_MM) + 1))
    return Line(xy_mm, "closed", 0.5, long_mm, number=number)


def left_by(diameter_mm: float, *lines: Line) -> Left:
    """What a cutter leaves of pockets."""
    return with_cutter(Trace(lines), Cutter(diameter_mm, "inside"), FEED_MM_S)[1]


@pytest.mark.parametrize("begin", [0.0, 0.003, 0.5])
def test_what_is_left_in_a_corner_is_as_long_as_the_tool_is_off_it(begin: float) -> None:
    """At t beyond the place where it touches a side the tool of radius r is t²/2r off; begun in a corner the
    line has four corners still.
    """
    left, radius_mm = left_by(6.0, closed(SQUARE, begin=begin)), 3.0
    touches_mm = math.sqrt(2 * radius_mm * LEFT_MM)
    assert len(left.stretches) == 4 and not left.lines
    for stretch in left.stretches:
        assert stretch.left_mm == pytest.approx(radius_mm * (math.sqrt(2) - 1), abs=1 * UM)
        assert stretch.length_mm == pytest.approx(
            2 * (radius_mm - touches_mm), abs=2 * LOOKED_AT_MM
        )
        assert stretch.of_mm == pytest.approx(80.0, abs=1 * UM)
    corners = sorted(tuple(round(x, 2) + 0.0 for x in each.place_mm) for each in left.stretches)
    assert corners == [(0, 0), (0, 20), (20, 0), (20, 20)]


def rounded(radius_mm: float) -> Array:
    """The square with one round corner, about its middle."""
    turn = np.linspace(0, math.pi / 2, 100)
    middle = 20 - radius_mm
    arc = middle + radius_mm * np.column_stack([np.cos(turn), np.sin(turn)])
    return np.vstack([SQUARE[:2], arc, SQUARE[3:]])


@pytest.mark.parametrize(("left_um", "listed"), [(7, False), (13, True)])
def test_a_stretch_of_which_ten_micrometres_are_left_is_listed_and_less_is_not(
    left_um: float, listed: bool
) -> None:
    """In a round corner of r - d a tool of radius r leaves (√2 - 1) d."""
    off_mm = left_um * UM / (math.sqrt(2) - 1)
    left = left_by(6.0, closed(rounded(3.0 - off_mm)))
    assert len(left.stretches) == 3 + listed
    depths = [stretch.left_mm for stretch in left.stretches]
    assert depths == sorted(depths, reverse=True)
    if listed:
        assert depths[-1] == pytest.approx(left_um * UM, abs=0.5 * UM)


def test_lines_that_are_left_are_listed_by_their_numbers_each_with_its_room() -> None:
    small = [
        closed(np.array([30.0, 0.0]) + side / 20 * SQUARE, number)
        for side, number in ((5.0, 7), (4.0, 3))
    ]
    small[1] = closed(np.array([60.0, 0.0]) + 4 / 20 * SQUARE, 3)
    left = left_by(6.0, small[0], small[1], closed(SQUARE, 5))
    assert [out.line for out in left.lines] == [3, 7]
    assert [out.length_mm for out in left.lines] == pytest.approx([16.0, 20.0])
    rooms = [out.room.wide_mm for out in left.lines if out.room is not None]
    assert rooms == pytest.approx([4.0, 5.0], abs=2 * UM)


def test_a_cutter_that_goes_nowhere_is_told_the_widest_that_goes_somewhere() -> None:
    lines = closed(0.2 * SQUARE, 1), closed(np.array([30.0, 0.0]) + 0.3 * SQUARE, 2)
    with pytest.raises(
        MotionFault, match=r"12 mm has no room inside of any line.* up to 5\.95 mm"
    ):
        left_by(12.0, *lines)


@pytest.mark.parametrize("has_stop", [False, True])
def test_a_line_that_the_cutter_only_passes_by_may_have_no_stops(has_stop: bool) -> None:
    """A block of 4 mm stands 1 mm off the square: a cutter of 6 mm goes round both, along the square."""
    block = closed(np.array([21.0, 8.0]) + 0.2 * SQUARE, 2)
    marks = (Mark("tick", block.place(3000), 3000.0),) if has_stop else ()
    beside = Line(block.xy_mm, "closed", 0.5, 16.0, number=2, marks=marks)
    trace = Trace((closed(SQUARE), beside), Operator(WORK))
    if has_stop:
        with pytest.raises(
            MotionFault, match=r"of line 2 only passes it on its way .*smaller --cutter"
        ):
            with_cutter(trace, Cutter(6.0), FEED_MM_S)
    else:
        made, _ = with_cutter(trace, Cutter(6.0), FEED_MM_S)
        assert [line.number for line in made.lines] == [1]
        assert made.lines[0].xy_mm[:, 0].max() == pytest.approx(28.0, abs=1 * UM)


def test_a_pocket_with_a_neck_too_narrow_is_cut_in_closed_pieces() -> None:
    """Two rooms of 10 mm and a neck of 2 mm between them, for a tool of 4 mm."""
    rooms = np.array(
        [(0, 0), (10, 0), (10, 4), (14, 4), (14, 0), (24, 0),
         (24, 10), (14, 10), (14, 6), (10, 6), (10, 10), (0, 10)], float
    )  # fmt: skip
    made, left = with_cutter(Trace((closed(rooms),)), Cutter(4.0, "inside"), FEED_MM_S)
    assert [line.ending for line in made.lines] == ["closed", "closed"]
    assert [line.number for line in made.lines] == [1, 1]
    middles = sorted(float(line.xy_mm[:, 0].mean()) for line in made.lines)
    assert middles == pytest.approx([5.0, 19.0], abs=0.1) and not left.lines
