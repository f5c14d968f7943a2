"""The cutter beside the lines: sides by nesting and by travel, corners rolled round, what is left in corners
listed.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.contour import distance
from morfax.motion.faults import MotionFault
from morfax.motion.motion import thin
from morfax.tracer.cutter.cutter import Cutter, CutterSide, Left, with_cutter
from morfax.tracer.drawing.deviation import deviation, touched
from morfax.tracer.following.line import Line
from morfax.tracer.marks.marks import Mark
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import UM, arc, inked, polyline
from tests.tracer.program.test_program import WORK, run_through

shapely = pytest.importorskip("shapely")

FEED_MM_S = 10.0
FOLLOWED_MM = 25 * UM  # as the head follows a corner or a circle on a scan
SQUARE = polyline((12, 8), (20, 8), (20, 24), (8, 24), (8, 8), (12, 8))


@pytest.mark.parametrize(("side", "radius_mm"), [("outside", 12.0), ("inside", 6.0)])
def test_beside_a_circle_runs_the_circle_that_is_larger_or_smaller_by_the_radius(
    side: str, radius_mm: float
) -> None:
    drawing = inked(arc((16, 16), 9), seed=1)
    beside, left = with_cutter(trace(drawing), Cutter(6, side), FEED_MM_S)  # type: ignore[arg-type]
    assert distance(thin(beside), arc((16, 16), radius_mm)).hausdorff_mm < FOLLOWED_MM
    assert left == Left() and beside.ending == "closed"
    found = deviation(drawing, touched(drawing, thin(beside), 3))
    assert found.rms_mm < 4 * UM and found.missed_share == 0


def test_inside_a_square_four_corners_are_left_and_listed() -> None:
    beside, left = with_cutter(trace(inked(SQUARE, seed=2)), Cutter(6, "inside"), FEED_MM_S)
    assert len(left.stretches) == 4 and not left.lines
    for stretch in left.stretches:
        assert stretch.left_mm == pytest.approx(3 * (math.sqrt(2) - 1), abs=FOLLOWED_MM)
        assert stretch.length_mm == pytest.approx(
            6, abs=0.5
        )  # from where the cutter touches one leg to the other
        assert min(np.hypot(*(SQUARE - stretch.place_mm).T)) < FOLLOWED_MM
    assert (
        distance(
            thin(beside), np.array([[11, 11], [17, 11], [17, 21], [11, 21], [11.0, 11]])
        ).hausdorff_mm
        < FOLLOWED_MM
    )
    _, outside = with_cutter(trace(inked(SQUARE, seed=2)), Cutter(6), FEED_MM_S)
    assert outside == Left()


def test_outside_of_a_part_is_the_inside_of_its_holes() -> None:
    part = inked(arc((26, 20), 16), arc((20, 20), 5), arc((34, 20), 4), seed=3)
    beside, _ = with_cutter(trace_lines(part), Cutter(3), FEED_MM_S)
    radii = [line.length_mm / math.tau for line in beside.lines]
    assert radii == pytest.approx([3.5, 2.5, 17.5], abs=FOLLOWED_MM) or radii == pytest.approx(
        [2.5, 3.5, 17.5], abs=FOLLOWED_MM
    )
    pocket, _ = with_cutter(trace_lines(part), Cutter(3, "inside"), FEED_MM_S)
    assert sorted(line.length_mm / math.tau for line in pocket.lines) == pytest.approx(
        [5.5, 6.5, 14.5], abs=0.05
    )


def test_a_cutter_wider_than_the_hole_is_refused_in_one_line() -> None:
    with pytest.raises(
        MotionFault,
        match="a cutter of 12 mm has no room inside of any line; give a smaller --cutter",
    ):
        with_cutter(trace(inked(arc((9, 9), 5))), Cutter(12, "inside"), FEED_MM_S)


def test_an_open_line_has_a_left_and_a_right_and_no_outside() -> None:
    line = trace(inked(polyline((4, 6), (24, 9)), seed=1))
    with pytest.raises(
        MotionFault,
        match="line 1 is open: it has no outside; close it, on paper or by --gap; or give",
    ):
        with_cutter(line, Cutter(4), FEED_MM_S)
    plate = closed(run_through((0, 0), (20, 0), (20, 20), (0, 20), (0, 0)))
    both = Trace((replace(plate, number=4), replace(line.lines[0], number=7)))
    with pytest.raises(
        MotionFault, match=r"line 7 is open.*, or outside of the others alone by --lines 4$"
    ):
        with_cutter(both, Cutter(4), FEED_MM_S)
    # type: ignore[arg-type]
    ways = {
        side: thin(with_cutter(line, Cutter(4, side), FEED_MM_S)[0])
        for side in ("left", "right")
    }
    middle = 0.5 * (ways["left"].runs()[0].mean(axis=0) + ways["right"].runs()[0].mean(axis=0))
    assert middle == pytest.approx([14, 7.5], abs=0.3)
    assert distance(ways["left"], ways["right"]).hausdorff_mm == pytest.approx(4, abs=0.05)
    round_it = closed(run_through((4, 4), (6, 4), (6, 5), (4, 5), (4, 4)))
    odd = replace(line.lines[0], xy_mm=run_through((0, 0), (9, 0), (9, 9), (0, 9)), number=2)
    inner = Trace((plate, replace(round_it, number=3), odd))
    with pytest.raises(MotionFault, match=r"line 2 .*alone by --lines 3 --side inside$"):
        with_cutter(inner, Cutter(4), FEED_MM_S)


def test_a_hole_too_small_is_left_out_and_listed_with_the_cutter_that_would_go_in() -> None:
    plate = inked(
        polyline((8, 8), (44, 8), (44, 28), (8, 28), (8, 8)),
        arc((18, 18), 4),
        arc((34, 18), 1.6),
        seed=4,
    )
    beside, left = with_cutter(trace_lines(plate), Cutter(4), FEED_MM_S)
    assert [line.number for line in beside.lines] == [2, 1] and not left.stretches
    (out,) = left.lines
    assert (
        out.line == 3
        and out.length_mm == pytest.approx(math.tau * 1.6, abs=2 * FOLLOWED_MM)
        and out.room is not None
    )
    assert out.room.place_mm == pytest.approx((34, 18), abs=FOLLOWED_MM)
    assert out.room.wide_mm == pytest.approx(3.2, abs=2 * FOLLOWED_MM)
    assert out.room.passes_mm == pytest.approx(3.15)
    whole, left = with_cutter(trace_lines(plate), Cutter(out.room.passes_mm), FEED_MM_S)
    assert not left.lines and sorted(line.number for line in whole.lines) == [1, 2, 3]


def test_a_line_that_is_left_out_takes_its_stops_along_and_the_others_keep_their_numbers() -> (
    None
):
    rings = [
        closed(run_through((0, 0), (6, 0), (6, 6), (0, 6), (0, 0))),
        closed(run_through((20, 0), (60, 0), (60, 40), (20, 40), (20, 0))),
    ]
    lines = [
        replace(line, number=k, marks=(Mark("tick", line.place(900), 900.0),))
        for k, line in enumerate(rings, 1)
    ]
    beside, left = with_cutter(
        Trace(tuple(lines), Operator(WORK)), Cutter(8.0, "inside"), FEED_MM_S
    )
    assert [line.number for line in beside.lines] == [2] and beside.lines[0].numbers == (2,)
    assert [(out.line, out.stops) for out in left.lines] == [(1, (1,))]


def closed(way: Array) -> Line:
    """A way that comes back to its beginning, as a line."""
    return Line(way, "closed", 0.5, float(np.hypot(*np.diff(way, axis=0).T).sum()))


T = np.linspace(0, math.tau, 12001)
CROSSING_THEMSELVES = {
    "figure eight": (18 * np.sin(T), 9 * np.sin(2 * T)),
    "limacon": ((8 + 14 * np.cos(T)) * np.cos(T), (8 + 14 * np.cos(T)) * np.sin(T)),
    "three lobes": (8 * np.sin(T) + 16 * np.sin(2 * T), 8 * np.cos(T) - 16 * np.cos(2 * T)),
    "three in a row": (
        30 * np.cos(T),
        10 * np.sin(3 * T),
    ),  # turns once round in all, as one that does not cross itself
    "pretzel": (20 * np.cos(T) + 9 * np.cos(3 * T + 1), 20 * np.sin(T) - 9 * np.sin(2 * T)),
}


@pytest.mark.parametrize("side", ["outside", "inside"])
@pytest.mark.parametrize("name", CROSSING_THEMSELVES)
def test_a_line_that_crosses_itself_has_no_outside(name: str, side: CutterSide) -> None:
    line = closed(np.column_stack(CROSSING_THEMSELVES[name]))
    with pytest.raises(
        MotionFault, match=f"line 1 crosses itself: it has no {side}; give --side left or right"
    ):
        with_cutter(Trace((line,)), Cutter(2, side), FEED_MM_S)


@pytest.mark.parametrize("name", CROSSING_THEMSELVES)
@pytest.mark.parametrize("side", ["left", "right"])
def test_on_a_side_of_a_line_that_crosses_itself_nothing_is_gouged_and_what_is_not_cut_is_listed(
    name: str, side: CutterSide
) -> None:
    line = closed(np.column_stack(CROSSING_THEMSELVES[name]))
    try:
        beside, left = with_cutter(Trace((line,)), Cutter(2, side), FEED_MM_S)
    except MotionFault as fault:
        assert "has no room" in str(fault)
        return
    ways, true = (
        shapely.MultiLineString([each.xy_mm[::5] for each in beside.lines]),
        shapely.LineString(line.xy_mm),
    )
    assert true.distance(ways) > 1 - 1 * UM
    touched_mm = true.intersection(ways.buffer(1 + 2 * UM, quad_segs=500)).length
    assert sum(u.length_mm for u in left.stretches) == pytest.approx(
        true.length - touched_mm, abs=0.5
    )


@pytest.mark.parametrize("begin", [0, math.pi])  # begun inside of the other circle, and outside
@pytest.mark.parametrize("side", ["outside", "inside"])
def test_lines_that_cross_each_other_are_cut_round_both_or_within_both(
    begin: float, side: CutterSide
) -> None:
    circles = [
        arc((30, 30), 25),
        (
            arc((0, 0), 8)
            @ np.array(
                [[math.cos(begin), math.sin(begin)], [-math.sin(begin), math.cos(begin)]]
            )
        )
        + (52, 30),
    ]
    lines = [replace(closed(circle), number=k) for k, circle in enumerate(circles, 1)]
    (way,) = with_cutter(Trace(tuple(lines)), Cutter(4, side), FEED_MM_S)[0].lines
    one, other = (shapely.Polygon(circle) for circle in circles)
    true = (
        one.union(other).buffer(2, quad_segs=500)
        if side == "outside"
        else one.intersection(other).buffer(-2, quad_segs=500)
    )
    assert distance(way.xy_mm, np.array(true.exterior.coords)).hausdorff_mm < 2 * UM
