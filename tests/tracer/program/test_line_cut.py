"""Ramps, holding tabs and pecks against their closed forms: a rectangle, a circle, an open line, a hole."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.jobs.depths import of_tabs
from morfax.motion.arrays import Array
from morfax.motion.faults import MotionFault
from morfax.motion.feed import run_along
from morfax.motion.motion import MOTION_RATE_HZ, join
from morfax.motion.polyline import lengths_mm, nearest_mm, with_places
from morfax.motion.ramp import Ramp
from morfax.tracer.following.line import Leads, Line
from morfax.tracer.marks.marks import Mark
from morfax.tracer.operator.card import Card
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Tabs, Work
from morfax.tracer.program.program import Trace
from morfax.tracer.program.tool_height import rapid

UM = 1e-3
SPEED_MM_S = 10.0
NODE_MM = 0.05  # between the places of a line here
RECTANGLE = [(0, 20), (0, 0), (60, 0), (60, 40), (0, 40), (0, 20)]
RADIUS_MM = 20.0


def line(places: list[tuple[float, float]] | Array, ending: str = "closed") -> Line:
    """A line as a head runs it that makes no error."""
    way = with_places(np.asarray(places, float), NODE_MM)
    xy_mm = run_along(way, SPEED_MM_S, 500.0)
    return Line(xy_mm, ending, 0.5, float(lengths_mm(xy_mm)[-1]))


def circle(radius_mm: float = RADIUS_MM, centre_mm: tuple[float, float] = (0, 0)) -> Line:
    angles = np.linspace(0, 2 * math.pi, max(90, int(2 * math.pi * radius_mm / NODE_MM)))
    return line(
        np.asarray(centre_mm) + radius_mm * np.column_stack([np.cos(angles), np.sin(angles)])
    )


def cut(work: Work, *lines: Line) -> Array:
    """X, Y, Z of a program, (n, 3) mm; nothing in it leaps."""
    positions_mm = join(Trace(lines, Operator(work))).positions_mm
    steps = np.abs(np.diff(positions_mm, axis=0)) * MOTION_RATE_HZ
    in_work = positions_mm[1:, 2] < work.clearance_mm - 1 * UM
    assert np.hypot(*steps[in_work, :2].T).max() < 1.02 * SPEED_MM_S
    assert steps[:, 2].max() < 1.02 * work.feed_mm_s
    return positions_mm


def slopes(positions_mm: Array) -> Array:
    """Z to the way of X and Y, of the steps in which both move; where X and Y hardly move it is not felt."""
    steps = np.diff(positions_mm, axis=0)
    across = np.hypot(*steps[:, :2].T)
    felt = (across > 0.1 * UM) & (np.abs(steps[:, 2]) > 1e-9)
    return steps[felt, 2] / across[felt]


def at_depth(positions_mm: Array, depth_mm: float) -> Array:
    return positions_mm[np.abs(positions_mm[:, 2] + depth_mm) < 1e-9, :2]


# tabs


def test_tabs_of_a_rectangle_stand_evenly_and_as_high_and_wide_as_asked() -> None:
    """Four shares of 50 mm from the middle of the left side: the first share's middle is 5 mm from a corner,
    which leaves 0.5 mm more than the tab of 3 mm and the cutter's half mm need.
    """
    work = Work(5.0, tabs=Tabs(4), cutter_mm=2.0)
    outline = line(RECTANGLE)
    positions_mm = cut(work, outline)
    trace = Trace((outline,), Operator(work))
    places_mm = [tab.place_mm for tab in trace.tabs[0]]
    expected_mm = [(5, 0), (55, 0), (55, 40), (5, 40)]
    assert np.abs(np.subtract(places_mm, expected_mm)).max() < 1 * UM
    on_top = at_depth(positions_mm, 4.0)
    for x_mm, y_mm in expected_mm:
        here = on_top[np.hypot(*(on_top - (x_mm, y_mm)).T) < 10]
        assert np.ptp(here[:, 0]) == pytest.approx(3.0 + 2.0, abs=1 * UM)
        assert here[:, 0].mean() == pytest.approx(x_mm, abs=0.2)
        assert np.ptp(here[:, 1]) == 0 and here[0, 1] == y_mm
    assert len(slopes(positions_mm)) == 0  # Z goes up and down while X and Y stand
    assert positions_mm[:, 2].min() == -5.0


def test_a_tab_in_a_corner_is_moved_along_until_it_is_clear_of_it() -> None:
    """Begun 15 mm from a corner, the shares' middles are 10 mm beyond the corners; 10 mm more and they would
    be in them.
    """
    begun = [
        (25, 0),
        (60, 0),
        (60, 40),
        (0, 40),
        (0, 0),
        (25, 0),
    ]  # middles at 25, 75, 125, 175 mm
    tabs = Trace((line(begun),), Operator(Work(5.0, tabs=Tabs(4, width_mm=8.0)))).tabs[0]
    assert np.abs(np.subtract(tabs[0].place_mm, (50, 0))).max() < 1 * UM
    in_corner = [
        (35, 0),
        (60, 0),
        (60, 40),
        (0, 40),
        (0, 0),
        (35, 0),
    ]  # the first at the corner itself
    tabs = Trace((line(in_corner),), Operator(Work(5.0, tabs=Tabs(4, width_mm=8.0)))).tabs[0]
    for tab in tabs:
        away_mm = np.abs(np.subtract(tab.place_mm, [[0, 0], [60, 0], [60, 40], [0, 40]]))
        assert np.hypot(*away_mm.T).min() > 4.0 + 0.9


@pytest.mark.parametrize(("path_radius_mm", "remarks"), [(1.4, 0), (1.6, 1)])
def test_a_hole_that_the_cutter_mills_away_needs_no_tabs(
    path_radius_mm: float, remarks: int
) -> None:
    """A cutter of 3 mm reaches the middle of a circle of 1.4 mm radius; 1.6 mm leave a core of 0.1 mm."""
    work = Work(tabs=Tabs(4, 3.0, 1.0), cutter_mm=3.0)
    hole = circle(path_radius_mm, (5.0, 5.0))
    told = list(of_tabs(Trace([hole, circle()], Operator(work))))
    assert len(told) == remarks and all("come loose" in text for text in told)


def test_tabs_of_a_circle_stand_evenly_and_only_in_the_passes_below_their_top() -> None:
    work = Work(4.0, passes_mm=(2.0,), tabs=Tabs(3, width_mm=6.0, height_mm=1.5))
    positions_mm = cut(work, circle())
    on_top = at_depth(positions_mm, 2.5)
    angles = np.degrees(np.arctan2(*on_top.T[::-1])) % 360
    half_deg = math.degrees(3.0 / RADIUS_MM)
    for middle_deg in (60, 180, 300):
        here = angles[np.abs(angles - middle_deg) < 30]
        assert here.min() == pytest.approx(middle_deg - half_deg, abs=0.01)
        assert here.max() == pytest.approx(middle_deg + half_deg, abs=0.01)
    # the pass at 2 mm goes round without a rest on a tab
    first_pass = at_depth(positions_mm, 2.0)
    assert np.hypot(*np.diff(first_pass, axis=0).T).max() < 2 * UM


@pytest.mark.parametrize(
    ("tabs", "cutter_mm", "says"),
    [
        (Tabs(4, width_mm=80.0), 0.0, "4 tabs of 80 mm would hold more than half of line 1"),
        (Tabs(20, width_mm=3.0), 3.0, "which is 200.0 mm round; give --tabs 16, or narrower"),
        (Tabs(1, width_mm=300.0), 0.0, "a tab of 300 mm would hold more than half of line 1"),
        (
            Tabs(4, height_mm=5.0),
            0.0,
            "tabs of 5 mm are not lower than line 1 is cut deep, 5 mm",
        ),
    ],
)
def test_tabs_without_room_are_refused_in_one_line(
    tabs: Tabs, cutter_mm: float, says: str
) -> None:
    with pytest.raises(MotionFault) as refused:
        cut(Work(5.0, tabs=tabs, cutter_mm=cutter_mm), line(RECTANGLE))
    assert says in str(refused.value) and "\n" not in str(refused.value)


def test_a_star_of_short_sides_has_no_place_clear_of_its_corners() -> None:
    angles = np.linspace(0, 2 * math.pi, 25)
    radii = np.where(np.arange(25) % 2, 16.0, 20.0)  # sides of 6.1 mm
    star = line(np.column_stack([radii * np.cos(angles), radii * np.sin(angles)]))
    narrow = Trace((star,), Operator(Work(5.0, tabs=Tabs(4, width_mm=1.5))))
    assert len(narrow.tabs[0]) == 4
    with pytest.raises(
        MotionFault, match=r"tab 1 of line 1 has no place about .* clear of corners"
    ):
        cut(Work(5.0, tabs=Tabs(4), cutter_mm=3.0), star)


def test_a_hole_gets_as_many_tabs_as_it_has_room_for_and_none_where_all_is_milled_away() -> (
    None
):
    outline, hole = (
        line(RECTANGLE),
        circle(6.0, (20, 20)),
    )  # 37.7 mm round: half of it for 3 tabs of 6
    small = circle(2.0, (45, 20))  # the path of a cutter of 6 mm in a hole of 10
    holes = replace(hole, number=2), replace(small, number=3)
    trace = Trace((*holes, outline), Operator(Work(5.0, tabs=Tabs(4), cutter_mm=3.0)))
    assert [len(tabs) for tabs in trace.tabs] == [3, 0, 4]
    wide = Trace((*holes, outline), Operator(Work(5.0, tabs=Tabs(4, 1.0), cutter_mm=6.0)))
    assert [len(tabs) for tabs in wide.tabs] == [2, 0, 4]


# ramps


@pytest.mark.parametrize("passes_mm", [(), (1.0, 2.0)])
def test_a_ramp_goes_round_at_its_angle_and_leaves_nothing_above_depth(
    passes_mm: tuple[float, ...],
) -> None:
    work = Work(3.0, passes_mm=passes_mm, ramp_rad=math.radians(3))
    positions_mm = cut(work, circle())
    assert np.degrees(np.arctan(slopes(positions_mm))) == pytest.approx(-3.0, abs=0.02)
    for depth_mm in work.depths_mm[-1:]:
        deep = at_depth(positions_mm, depth_mm)
        assert nearest_mm(circle().xy_mm, deep).max() < 5 * UM
    down = positions_mm[:, 2] < 0
    assert np.diff(positions_mm[down, 2][: np.argmin(positions_mm[down, 2])]).max() <= 1e-12


def test_a_ramp_longer_than_the_line_goes_round_and_round() -> None:
    """1 mm at 2 degrees are 28.6 mm of a circle of 12.6 mm: 2.28 rounds down, and a whole round at depth."""
    work = Work(1.0, ramp_rad=math.radians(2))
    positions_mm = cut(work, circle(2.0))
    sloping = positions_mm[(positions_mm[:, 2] < -1e-9) & (positions_mm[:, 2] > -1.0 + 1e-9)]
    assert lengths_mm(sloping[:, :2])[-1] == pytest.approx(
        1.0 / math.tan(math.radians(2)), rel=2e-3
    )
    assert nearest_mm(circle(2.0).xy_mm, at_depth(positions_mm, 1.0)).max() < 5 * UM


def test_a_steep_ramp_is_run_no_faster_than_the_feed_of_z_allows() -> None:
    work = Work(3.0, feed_mm_s=2.0, ramp_rad=math.radians(20))
    positions_mm = cut(work, circle())
    assert np.degrees(np.arctan(slopes(positions_mm))) == pytest.approx(-20, abs=0.1)
    rate_mm_s = np.abs(np.diff(positions_mm[:, 2])) * MOTION_RATE_HZ
    assert rate_mm_s.max() == pytest.approx(2.0, rel=0.01)


def test_an_open_line_is_entered_to_and_fro_at_its_start_in_every_pass() -> None:
    straight = line([(0, 0), (30, 0)], "ended")
    work = Work(2.0, passes_mm=(1.0,), ramp_rad=math.radians(5))
    positions_mm = cut(work, straight)
    assert np.abs(slopes(positions_mm)) == pytest.approx(math.tan(math.radians(5)), rel=2e-3)
    stroke_mm = 0.5 * 1.0 / math.tan(math.radians(5))
    sloping = positions_mm[:-1][np.diff(positions_mm[:, 2]) < -1e-9]
    sloping = sloping[(sloping[:, 2] < -1 * UM) & (sloping[:, 0] > 0)]
    assert sloping[:, 0].max() == pytest.approx(stroke_mm, abs=5 * UM)
    for depth_mm in (1.0, 2.0):
        assert np.ptp(at_depth(positions_mm, depth_mm)[:, 0]) == pytest.approx(30, abs=1 * UM)


def test_a_ramp_has_strokes_no_longer_than_a_short_line() -> None:
    positions_mm = cut(Work(1.0, ramp_rad=math.radians(5)), line([(0, 0), (2, 0)], "ended"))
    assert positions_mm[:, 0].max() == pytest.approx(2, abs=1 * UM)
    steps = np.diff(positions_mm[:, 0])
    reversals = np.count_nonzero(np.diff(np.sign(steps[np.abs(steps) > 1e-9])) == -2)
    assert reversals == 3  # 11.4 mm in six strokes
    with pytest.raises(
        MotionFault, match=r"the tool has 0\.05 mm to go down a ramp at 0\.0,0\.0"
    ):
        cut(Work(1.0, ramp_rad=math.radians(5)), line([(0, 0), (0.05, 0)], "ended"))


def test_where_the_head_stops_on_the_ramp_the_tool_is_at_depth_before_the_stop() -> None:
    """A tick 10 mm from the start, a ramp of 28.6 mm: the tool goes to and fro over those 10 mm."""
    round_line = circle()
    at = int(np.searchsorted(lengths_mm(round_line.xy_mm), 10.0))
    tick = Mark("tick", round_line.place(at), float(at))
    positions_mm = cut(Work(1.5, ramp_rad=math.radians(3)), replace(round_line, marks=(tick,)))
    stands = np.flatnonzero(np.hypot(*np.diff(positions_mm[:, :2], axis=0).T) == 0)
    longest = np.split(stands, np.flatnonzero(np.diff(stands) > 1) + 1)
    stop = next(
        run
        for run in longest
        if len(run) > 0.45 * MOTION_RATE_HZ and positions_mm[run[0], 2] < 0
    )
    assert positions_mm[stop, 2] == pytest.approx(-1.5)
    assert np.hypot(*(positions_mm[stop[0], :2] - tick.place_mm)) < 5 * UM
    assert nearest_mm(round_line.xy_mm, at_depth(positions_mm, 1.5)).max() < 5 * UM


def test_a_ramp_passes_over_the_tabs_and_the_line_is_deep_between_them() -> None:
    work = Work(3.0, tabs=Tabs(3), ramp_rad=math.radians(3))
    positions_mm = cut(work, circle())
    over = Trace((circle(),), Operator(work)).tabs[0]
    deep = at_depth(positions_mm, 3.0)
    for tab in over:
        assert np.hypot(*(deep - tab.place_mm).T).min() > 1.5 - 0.01
    away_mm = nearest_mm(circle().xy_mm, deep)
    assert (away_mm > 5 * UM).mean() == pytest.approx(
        3 * 3.0 / (2 * math.pi * RADIUS_MM), rel=0.02
    )


def test_with_leads_the_ramp_begins_on_the_lead_in_and_the_lead_out_comes_last() -> None:
    round_line = circle()
    lead_in, lead_out = line([(20, -5), (20, 0)]).xy_mm, line([(20, 0), (20, 5)]).xy_mm
    xy_mm = np.vstack([lead_in, round_line.xy_mm[1:], lead_out[1:]])
    first, last = len(lead_in) - 1, len(lead_in) + len(round_line.xy_mm) - 2
    leads = Leads(first, last, 5.0, 5.0)
    positions_mm = cut(
        Work(2.0, ramp_rad=math.radians(3)), replace(round_line, xy_mm=xy_mm, leads=leads)
    )
    assert np.degrees(np.arctan(slopes(positions_mm))) == pytest.approx(-3, abs=0.05)
    assert nearest_mm(round_line.xy_mm, at_depth(positions_mm, 2.0)).max() < 5 * UM
    assert positions_mm[-1] == pytest.approx([20, 5, 2], abs=1 * UM)


def test_a_smooth_entry_longer_than_the_line_goes_on_round_until_it_is_down() -> None:
    card = Card.parse('entry = "200mm"')  # the circle is 125.7 mm round
    work = Work(2.0)
    positions_mm = join(Trace((circle(),), Operator(work, card))).positions_mm
    steps = np.abs(np.diff(positions_mm, axis=0)) * MOTION_RATE_HZ
    assert steps[:, 2].max() < 1.02 * work.feed_mm_s  # nothing leaps
    assert nearest_mm(circle().xy_mm, at_depth(positions_mm, 2.0)).max() < 5 * UM


# holes


def test_a_hole_is_drilled_in_pecks_and_the_drill_comes_up_in_between() -> None:
    hole = Line.of_dot(np.array([7.0, 8.0]), 0.5, 1)
    z_mm = cut(Work(5.0, peck_mm=2.0, rapid_mm_s=5.0), hole)[:, 2]
    turns = (
        np.flatnonzero(np.diff(np.sign(np.diff(z_mm[np.r_[True, np.diff(z_mm) != 0]]))) != 0)
        + 1
    )
    heights = z_mm[np.r_[True, np.diff(z_mm) != 0]][turns]
    assert heights == pytest.approx([-2, 2, -4, 2, -5], abs=1e-9)


def test_a_rapid_takes_as_long_as_its_speed_and_its_ramps() -> None:
    work = Work(5.0, rapid_mm_s=40.0)
    way = rapid(work, (0.0, 0.0, 2.0), (80.0, 60.0, 2.0), MOTION_RATE_HZ)
    lasts_s = 100 / 40 + 40 / Ramp().acceleration_mm_s2
    assert (len(way) - 1) / MOTION_RATE_HZ == pytest.approx(lasts_s, abs=0.002)
    assert (
        100 / 50
        < (
            len(rapid(Work(5.0), (0.0, 0.0, 2.0), (80.0, 60.0, 2.0), MOTION_RATE_HZ))
            / MOTION_RATE_HZ
        )
        < 100 / 50 + 0.2
    )
