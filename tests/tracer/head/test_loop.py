"""Lead lines and their loops: found where the run comes back onto its own way."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.faults import LineFault
from morfax.tracer.head.loop import comes_again, loop_in
from morfax.tracer.operator.operator import Operator
from tests.tracer.inked import UM, arc, inked, polyline, tick
from tests.tracer.marked import trace

STEP_MM = 0.01
WIDTH_MM = 0.5


def run_of(lead_mm: float, round_again_mm: float, radius_mm: float = 8.0) -> np.ndarray:
    """A straight lead line onto a circle, round it once, and on along what was run before."""
    turns = np.arange(0, 2 * np.pi + round_again_mm / radius_mm, STEP_MM / radius_mm)
    loop = np.column_stack([-radius_mm * np.cos(turns), radius_mm * np.sin(turns)])
    lead = np.column_stack(
        [
            np.arange(-lead_mm - radius_mm, -radius_mm, STEP_MM),
            np.zeros(round(lead_mm / STEP_MM)),
        ]
    )
    return np.vstack([lead, loop])


@pytest.mark.parametrize("round_again_mm", [0.5, 3.0, 9.0])
def test_the_loop_is_found_however_far_it_was_run_again(round_again_mm: float) -> None:
    way = run_of(10.0, round_again_mm)
    found = loop_in(way, WIDTH_MM)
    assert found is not None
    first, last = found
    assert (
        math.dist(way[first], (-8, 0)) < 0.3 and math.dist(way[last], (-8, 0)) < 0.3
    )  # half a width: one corner's blot
    assert math.dist(way[first], way[last]) < 30 * UM


def test_a_way_that_does_not_come_back_has_no_loop() -> None:
    assert loop_in(run_of(10.0, 0.0)[:4000], WIDTH_MM) is None


@pytest.mark.parametrize("beyond_mm", [0.06, 0.4])
def test_a_run_that_ends_beyond_its_own_lead_line_is_cut_off_there(beyond_mm: float) -> None:
    steps = [
        polyline((0, 0), (30, 0)),
        polyline((30, 0), (30, 20)),
        polyline((30, 20), (10, -beyond_mm)),
    ]
    way = np.vstack([a + np.linspace(0, 1, 3001)[:, None] * (b - a) for a, b in steps])
    found = loop_in(way, WIDTH_MM)
    assert found is not None
    true = (10 + 20 * beyond_mm / (20 + beyond_mm), 0.0)
    assert (
        max(math.dist(way[at], true) for at in found) < 15 * UM
    )  # positions are 10 um apart here


def test_coming_again_needs_a_stretch_in_the_same_sense() -> None:
    once = run_of(10.0, 0.0)[::5]
    again = run_of(10.0, 4.0)[::5]
    back = np.vstack([once[:400], once[399::-1]])
    assert comes_again(again, 5 * STEP_MM, WIDTH_MM)
    assert not comes_again(once, 5 * STEP_MM, WIDTH_MM) and not comes_again(
        back, 5 * STEP_MM, WIDTH_MM
    )


CIRCLE = arc((34, 16), 10)


@pytest.mark.parametrize("angle_deg", [90.0, 50.0, 35.0])
def test_a_lead_line_joins_its_loop_at_any_angle(angle_deg: float) -> None:
    a = math.radians(90 - angle_deg)
    start = (24 - 16 * math.cos(a), 16 - 12 * math.sin(a))
    at = (24 - 5 * math.cos(a), 16 - 5 * math.sin(a) * 12 / 16)
    line = trace(
        inked(CIRCLE, polyline(start, (24, 16)), tick(at, math.degrees(a)), seed=5),
    ).lines[0]
    assert line.is_lead and line.loop_from is not None
    assert math.dist(line.place(line.loop_from), line.xy_mm[-1]) < 50 * UM  # it closes
    loop_mm = np.hypot(*np.diff(line.xy_mm[line.loop_from :], axis=0).T).sum()
    assert loop_mm == pytest.approx(20 * math.pi, abs=0.5)  # once round


def test_a_guide_line_soon_after_the_join_does_not_lead_off_the_second_time() -> None:
    a = math.radians(
        212
    )  # 5.6 mm beyond the join; on less than 3 mm the head cannot tell that it has been here
    foot = (34 + 10 * math.cos(a), 16 - 10 * math.sin(a))
    guide = polyline(foot, (34 + 3 * math.cos(a), 16 - 3 * math.sin(a)))
    line = trace(
        inked(CIRCLE, polyline((8, 16), (24, 16)), tick((18, 16)), guide, seed=5),
    ).lines[0]
    assert line.is_lead and line.length_mm == pytest.approx(16 + 20 * math.pi, abs=1.0)


@pytest.mark.parametrize("join", [(22.0, 6.0), (22.0, 26.0)])
def test_a_lead_line_in_line_with_the_side_of_a_corner(join: tuple[float, float]) -> None:
    square = polyline((22, 6), (42, 6), (42, 26), (22, 26), (22, 6))
    line = trace(
        inked(square, polyline((6, join[1]), join), tick((14, join[1])), seed=5),
    ).lines[0]
    assert line.is_lead and line.length_mm == pytest.approx(16 + 80, abs=1.0)
    loop = line.xy_mm[line.loop_from :]
    assert (
        min(np.hypot(*(loop - corner).T).min() for corner in ([42, 6], [42, 26])) < 50 * UM
    )  # true corners


def test_of_several_open_ends_the_lead_line_is_begun_at() -> None:
    lines = [
        polyline((8, 16), (24, 16)),
        tick((18, 16)),
        polyline((44, 16), (36, 16)),
        polyline((34, 26), (34, 19)),
    ]
    line = trace(inked(CIRCLE, *lines, seed=5)).lines[0]
    assert line.is_lead and math.dist(line.start_mm, (8, 16)) < 50 * UM


def test_two_lead_lines_without_a_reference_point_are_asked_about() -> None:
    """Each bears a tick: nothing on the drawing says which leads, but the operator may."""
    lines = [
        polyline((8, 16), (24, 16)),
        tick((18, 16)),
        polyline((60, 16), (44, 16)),
        tick((50, 16)),
    ]
    drawing = inked(CIRCLE, *lines, seed=5)
    with pytest.raises(
        LineFault,
        match=r"2 lines with a tick lead to the contour, .* draw a cross or ring .* --start",
    ):
        trace(drawing)
    for start in ((8, 16), (60, 16)):
        assert math.dist(trace(drawing, start).lines[0].start_mm, start) < 50 * UM
        named = trace(drawing, operator=Operator(reference_mm=start))
        assert math.dist(named.lines[0].start_mm, start) < 50 * UM


@pytest.mark.parametrize("width_mm", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("slant_deg", [-40, 0, 40])
def test_a_lead_line_with_a_tick_near_its_join_goes_to_the_very_place_and_comes_back_there(
    slant_deg: float, width_mm: float
) -> None:
    """A corner's vertex is right to 50 um, though between tick and contour only a millimetre of line is
    clean.
    """
    a = math.radians(slant_deg)
    way = np.array([math.cos(a), math.sin(a)])
    join = np.array([24.0, 16.0])
    near = tuple(join - (1.5 + width_mm) * way)
    drawing = inked(
        CIRCLE,
        polyline(tuple(join - 14 * way), tuple(join)),
        tick(near, slant_deg),
        width_mm=width_mm,
        seed=5,
    )
    line = trace(drawing).lines[0]
    assert line.is_lead and line.loop_from is not None and len(line.marks) == 1
    assert math.dist(line.marks[0].place_mm, near) < 50 * UM
    assert np.hypot(*(line.xy_mm - join).T).min() < 50 * UM
    assert line.length_mm == pytest.approx(14 + 20 * math.pi, abs=1.0)
