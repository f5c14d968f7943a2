"""Ramps down into the work, and holes drilled in pecks."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.faults import MotionFault
from morfax.motion.motion import MOTION_RATE_HZ, join
from morfax.motion.polyline import lengths_mm, nearest_mm
from morfax.motion.ramp import Ramp
from morfax.tracer.following.line import Leads, Line
from morfax.tracer.marks.marks import Mark
from morfax.tracer.operator.card import Card
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Tabs, Work
from morfax.tracer.program.passes.tool_height import rapid
from morfax.tracer.program.program import Trace
from tests.tracer.program.passes.cuts import (
    RADIUS_MM,
    UM,
    at_depth,
    circle,
    cut,
    line,
    slopes,
)

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
