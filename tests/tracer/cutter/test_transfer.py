"""A drawn program under a cutter: lead line, stops, guide lines and the way back, on lines of known geometry
and on scanned drawings.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.tracer.cutter.cutter import CutterSide
from morfax.tracer.following.line import Line
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.marks.marks import Mark
from tests.tracer.cutter.drawn_parts import (
    FROM,
    LEFT_TO,
    NEARER_MM,
    OUT,
    SAMPLE_MM,
    WAY,
    beside,
    least_mm,
    marked,
)
from tests.tracer.inked import UM
from tests.tracer.program.test_program import EXACT_MM, WORK, at, in_work, run_through


@pytest.mark.parametrize(
    ("side", "begin"),
    [("outside", (8, 4)), ("inside", (12, 4)), ("left", (8, 4)), ("right", (12, 4))],
)
def test_the_lead_line_comes_to_the_way_and_goes_back_to_the_reference_point(
    side: CutterSide, begin: tuple[float, float]
) -> None:
    positions, stops, made = beside(marked(), side)
    for end in (positions[0], positions[-1]):
        assert end == pytest.approx([-3.0, 4.0, WORK.clearance_mm], abs=EXACT_MM)
    line = made.lines[0]
    assert line.is_lead and line.loop_from is not None
    assert line.xy_mm[line.loop_from] == pytest.approx(begin, abs=1 * UM)
    assert line.xy_mm[-1] == pytest.approx(begin, abs=1 * UM)
    assert least_mm(positions, marked().xy_mm[FROM:], 2.0) > -NEARER_MM
    assert stops[2].place_mm == pytest.approx(
        (20 if begin == (8, 4) else 16, 3), abs=2 * SAMPLE_MM
    )
    steps = np.diff(positions, axis=0)
    assert not np.any((steps[:, 2] != 0) & np.any(steps[:, :2] != 0, axis=1))
    assert np.abs(steps).max() * 6000 < WORK.rapid_mm_s * 1.01


@pytest.mark.parametrize(
    ("tick_mm", "side", "down"),
    [(5.0, "outside", 5.0), (9.0, "outside", 8.0), (5.0, "inside", 12.0)],
)
def test_the_tool_goes_down_at_the_tick_if_it_is_clear_there_and_else_on_the_way(
    tick_mm: float, side: CutterSide, down: float
) -> None:
    positions, stops, _ = beside(marked(tick_mm), side)
    assert stops[1].place_mm == pytest.approx((down, 4), abs=2 * SAMPLE_MM)
    assert in_work(positions)[0] == pytest.approx((down, 4), abs=2 * SAMPLE_MM)


def test_a_hole_on_the_lead_line_beyond_the_way_is_drilled_where_it_was_drawn() -> None:
    """The lead line crosses the way at 8 mm, 1 mm before the hole: the tool goes on to the contour first."""
    line = marked()
    hole = Mark("dot", (9.0, 4.0), float(at(WAY[:FROM], (9, 4))))
    positions, stops, _ = beside(replace(line, marks=(hole, *line.marks[1:])), "outside")
    assert stops[1].kind == "dot"
    assert stops[1].place_mm == pytest.approx((9, 4), abs=2 * SAMPLE_MM)
    beyond = (np.abs(positions[:, 1] - 4) < UM) & (positions[:, 0] > 9.9)
    assert np.any(beyond & (positions[:, 0] < 10.1))


@pytest.mark.parametrize("side", ["outside", "inside"])
def test_a_guide_line_is_run_raised_as_drawn_and_its_hole_is_where_it_was_drawn(
    side: CutterSide,
) -> None:
    positions, stops, made = beside(marked(guide=True), side, passes_mm=(1.0,))
    assert [stops[k].kind for k in (1, 2, 3)] == ["tick", "hole", "tick"]
    assert stops[2].place_mm == tuple(WAY[OUT])
    assert (
        least_mm(positions, marked().xy_mm[FROM:], 2.0) > -NEARER_MM
    )  # on no pass does it cut along the guide line
    on_guide = positions[
        (np.abs(positions[:, 0] - 14) < UM) & (positions[:, 1] > 5) & (positions[:, 1] < 5.9)
    ]
    assert len(on_guide) and np.all(on_guide[:, 2] == WORK.clearance_mm)
    (guide,) = made.lines[0].guides
    y_mm = 10 if side == "outside" else 6
    for position in (guide.leave, guide.back):
        assert made.lines[0].xy_mm[position] == pytest.approx((14, y_mm), abs=SAMPLE_MM)


@pytest.mark.parametrize(("side", "far_mm"), [("inside", 1.0), ("outside", 5.0)])
def test_a_guide_line_is_joined_where_it_crosses_the_way_and_else_from_the_foot(
    side: CutterSide, far_mm: float
) -> None:
    """From a square's upper side 3 mm in: the way inside of it is crossed at 2 mm, never the one outside."""
    _, _, made = beside(marked(guide=True), side)
    line = made.lines[0]
    (guide,) = line.guides
    off_it = line.xy_mm[guide.leave : guide.back + 1]
    assert np.ptp(off_it[:, 0]) < UM
    length_mm = np.abs(np.diff(off_it[:, 1])).sum()
    assert length_mm == pytest.approx(2 * far_mm, abs=2 * SAMPLE_MM)


def test_a_guide_line_that_crosses_the_part_is_joined_on_its_own_side() -> None:
    """It runs from the upper side through the part to a hole 4 mm below it: not from the lower way."""
    way = run_through(
        (0, 4), (10, 4), (10, 8), LEFT_TO, (14, -4), LEFT_TO, (18, 8), (18, 0), (10, 0), (10, 4 - SAMPLE_MM)
    )  # fmt: skip
    from_, tip = at(way, (10, 4)), at(way, (14, -4))
    back = tip + at(way[tip:], LEFT_TO)
    guide = GuideLine(at(way[:tip], LEFT_TO), tip, back)
    line = Line(
        way, "joined", 0.5, 66.0, loop_from=from_, guides=(guide,), reference_mm=(-3.0, 4.0)
    )
    _, stops, made = beside(line, "outside")
    (run,) = made.lines[0].guides
    assert made.lines[0].xy_mm[run.leave] == pytest.approx((14, 10), abs=SAMPLE_MM)
    assert next(iter(stops.values())).place_mm == pytest.approx((14, -4), abs=SAMPLE_MM)


def test_stops_keep_their_numbers_where_the_cutter_comes_to_them_in_another_order() -> None:
    way = run_through((4, -8), (10, 4), (10, 8), (18, 8), (18, 0), (10, 0), (10, 4 - SAMPLE_MM))
    from_ = at(
        way, (10, 4)
    )  # the lead line meets the cutter's way below the corner, on the lower side's
    near, far = (float(from_ + at(way[from_:], place)) for place in ((10, 7), (10, 1)))
    ticks = (Mark("tick", (10.0, 7.0), near), Mark("tick", (10.0, 1.0), far))
    line = Line(
        way, "joined", 0.5, 40.0, loop_from=from_, marks=ticks, reference_mm=(3.0, -10.0)
    )
    _, stops, made = beside(line, "outside", 8.0, "[[stop]]\nnumber = 2\ndwell = 3\n")
    assert made.lines[0].numbers == (2, 1)
    assert stops[2].place_mm == pytest.approx((6, 1), abs=2 * SAMPLE_MM)
    assert [a.moves[-1].dwell_s for a in made.actions[0] if a.halt.number == 2] == [3.0]
