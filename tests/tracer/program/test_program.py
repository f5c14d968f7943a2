"""Lines cut one after the other: where the tool is up and down, the way back along a lead line, and what the
whole says of itself.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.motion.motion import MOTION_RATE_HZ, join
from morfax.motion.usual import ACCELERATION_MM_S2
from morfax.tracer.following.line import Leads, Line
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.marks.marks import Mark
from morfax.tracer.operator.card import Card
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Work
from morfax.tracer.program.program import Trace

WORK = Work(depth_mm=4.0, clearance_mm=2.0)
STEP_MM = 10.0 / MOTION_RATE_HZ  # of a head at 10 mm/s
EXACT_MM = 1e-9  # double precision
# of a way that is run from memory by places 0.1 mm apart, which cut a corner by half of that
WITHIN_MM = 0.05


def run_through(*corners: tuple[float, float]) -> Array:
    """Positions of a head that runs from corner to corner at 10 mm/s, (n, 2) mm."""
    nodes = np.array(corners)
    lengths = np.r_[0.0, np.cumsum(np.hypot(*np.diff(nodes, axis=0).T))]
    at = np.arange(0.0, lengths[-1] + STEP_MM / 2, STEP_MM)
    return np.column_stack([np.interp(at, lengths, nodes[:, k]) for k in (0, 1)])


def at(way: Array, place: tuple[float, float]) -> int:
    """The position of a way that is nearest to a place."""
    return int(np.argmin(np.hypot(*(way - place).T)))


LEAD = run_through((0, 0), (10, 0), (10, 8), (18, 8), (18, 0), (10.01, 0))
TICK = Mark("tick", (6.0, 0.0), float(at(LEAD, (6, 0))))
LINE = Line(
    LEAD,
    "joined",
    0.5,
    42.0,
    loop_from=at(LEAD, (10, 0)),
    marks=(TICK,),
    reference_mm=(-3.0, 0.0),
)  # a reference point 3 mm before the lead line, a tick on that, and a square
OPEN = Line(run_through((30, 0), (40, 0)), "ended", 0.5, 10.0, number=2)


def moved(*lines: Line, operator: Operator | None = None) -> Array:
    return join(Trace(lines, operator or Operator(WORK))).positions_mm


def in_work(positions: Array) -> Array:
    """The places at which the tool is in the work, (n, 2) mm."""
    return positions[positions[:, 2] < 0, :2]


def test_a_lead_line_s_program_begins_and_ends_at_the_reference_point_with_the_tool_raised() -> (
    None
):
    positions = moved(LINE)
    for end in (positions[0], positions[-1]):
        assert end == pytest.approx([-3.0, 0.0, WORK.clearance_mm], abs=EXACT_MM)


def test_the_tool_is_in_the_work_from_the_tick_on_and_round_the_loop_only() -> None:
    cut = in_work(moved(LINE))
    assert cut[:, 0].min() == pytest.approx(6.0, abs=EXACT_MM)
    assert cut[:, 0].max() == pytest.approx(18.0, abs=STEP_MM) and cut[
        :, 1
    ].max() == pytest.approx(8.0, abs=STEP_MM)
    assert cut[-1] == pytest.approx([10.0, 0.0], abs=0.02)


def test_the_tool_goes_back_along_the_lead_line() -> None:
    bent = run_through((0, 0), (5, 5), (10, 0), (10, 8), (18, 8), (18, 0), (10.01, 0))
    line = Line(bent, "joined", 0.5, 46.0, loop_from=at(bent, (10, 0)), reference_mm=(0.0, 0.0))
    positions = moved(line)
    back = positions[np.flatnonzero(positions[:, 2] < 0)[-1] :, :2]
    assert back[:, 1].max() == pytest.approx(
        5.0, abs=WITHIN_MM
    )  # round the bend, not straight to the end


def test_x_and_y_never_move_with_z_nor_leap() -> None:
    positions = moved(LINE, OPEN)
    steps = np.diff(positions, axis=0)
    assert not np.any((steps[:, 2] != 0) & np.any(steps[:, :2] != 0, axis=1))
    assert np.abs(steps).max() * MOTION_RATE_HZ < WORK.rapid_mm_s * 1.01


def test_x_and_y_come_to_rest_where_the_tool_goes_down() -> None:
    positions = moved(LINE)
    down = int(np.flatnonzero(np.diff(positions[:, 2]) < 0)[0])
    speeds = np.hypot(*np.diff(positions[:down, :2], axis=0).T) * MOTION_RATE_HZ
    assert speeds[speeds > 0][-1] < np.sqrt(
        2 * ACCELERATION_MM_S2 * STEP_MM
    )  # the last step is one of braking


def test_from_line_to_line_the_tool_goes_straight_at_clearance() -> None:
    positions = moved(LINE, OPEN)
    over = positions[(positions[:, 0] > 18.1) & (positions[:, 0] < 29.9)]
    assert (
        len(over)
        and np.all(over[:, 2] == WORK.clearance_mm)
        and np.abs(over[:, 1]).max() < EXACT_MM
    )
    assert Trace((LINE, OPEN)).idle_mm == pytest.approx(33.0)


def test_each_pass_of_a_loop_is_run_on_at_the_next_depth_and_the_tick_stops_the_first_only() -> (
    None
):
    positions = moved(LINE, operator=Operator(replace(WORK, passes_mm=(1.0, 2.0))))
    levels = positions[
        np.r_[True, np.diff(positions[:, 2]) != 0] & np.r_[np.diff(positions[:, 2]) == 0, True],
        2,
    ]
    assert levels.tolist() == [2.0, -1.0, -2.0, -4.0, 2.0]
    assert in_work(positions)[:, 0].min() == pytest.approx(6.0, abs=EXACT_MM)
    deepest = positions[positions[:, 2] == -4.0, :2]
    assert deepest[:, 0].min() == pytest.approx(10.0, abs=0.02)  # the loop alone


def test_a_guide_line_is_left_for_on_the_first_pass_only_and_never_in_the_work() -> None:
    way = run_through(
        (0, 0), (10, 0), (10, 8), (14, 8), (14, 4), (14, 8), (18, 8), (18, 0), (10.01, 0)
    )
    tip = at(way, (14, 4))
    guide = GuideLine(at(way[:tip], (14, 8)), tip, tip + at(way[tip:], (14, 8)))
    line = Line(
        way,
        "joined",
        0.5,
        50.0,
        loop_from=at(way, (10, 0)),
        guides=(guide,),
        reference_mm=(-3.0, 0.0),
    )
    positions = moved(line, operator=Operator(replace(WORK, passes_mm=(2.0,))))
    on_guide = positions[
        (positions[:, 1] > 4.1)
        & (positions[:, 1] < 7.9)
        & (np.abs(positions[:, 0] - 14) < EXACT_MM)
    ]
    assert len(on_guide) and np.all(on_guide[:, 2] == WORK.clearance_mm)
    assert np.count_nonzero(np.diff(np.sign(on_guide[:, 1] - 6)) != 0) == 2  # out and back once


def test_where_the_head_came_back_aside_from_a_guide_line_no_pass_leaps() -> None:
    way = run_through(
        (0, 0), (10, 0), (10, 8), (18, 8), (18, 12), (18.004, 8.003), (18, 0), (10.01, 0)
    )
    leave, tip = at(way, (18, 8)), at(way, (18, 12))
    guide = GuideLine(leave, tip, tip + at(way[tip:], (18.004, 8.003)))
    line = replace(LINE, xy_mm=way, loop_from=at(way, (10, 0)), guides=(guide,))
    cut = join(Trace((line,), Operator(replace(WORK, passes_mm=(2.0,))))).positions_mm
    speeds = np.hypot(*np.diff(cut[:, :2], axis=0).T)[cut[1:, 2] < 0] * MOTION_RATE_HZ
    assert speeds.max() < 10.0 * (
        1 + 1e-6
    )  # a step of 5 um at the motion rate would be 30 mm/s


def test_passes_asked_for_at_the_stop_where_the_tool_goes_down_are_that_line_s() -> None:
    operator = Operator(WORK, Card.parse('[[stop]]\nnumber = 1\npasses = ["1mm", "3mm"]\n'))
    lows = np.unique(moved(LINE, operator=operator)[:, 2].round(6))
    assert lows.min() == -3.0 and -1.0 in lows and -4.0 not in lows


def test_a_line_that_was_lost_is_cut_as_far_as_it_goes_and_named() -> None:
    fault = LineFault("line lost at 40.00,0.00 mm", x_mm=40.0, y_mm=0.0, heading_rad=0.0)
    lost = Line(OPEN.xy_mm, "lost", 0.5, 10.0, fault, number=2)
    both = Trace((LINE, lost), Operator(WORK))
    assert both.ending == "lost" and str(both.fault).startswith("line 2 of 2 is incomplete")
    assert Trace((lost,)).fault is fault
    assert in_work(join(both).positions_mm)[:, 0].max() == pytest.approx(40.0, abs=STEP_MM)


def test_duration_length_and_reference_are_those_of_the_lines() -> None:
    program = Trace((LINE, OPEN), Operator(WORK))
    assert program.duration_s == pytest.approx(len(join(program).positions_mm) / MOTION_RATE_HZ)
    assert (
        program.length_mm == 52.0
        and program.reference_mm == (-3.0, 0.0)
        and program.start_mm == (0.0, 0.0)
    )


# a square with a lead-in of 3 mm and a lead-out of 2 mm
WAY = run_through((7, 0), (10, 0), (10, 8), (18, 8), (18, 0), (10, 0), (10, -2))
CORNER = at(WAY[: len(WAY) // 2], (10, 0))
BACK = len(WAY) - 1 - at(WAY[::-1][: len(WAY) // 2], (10, 0))
LED = Line(WAY, "closed", 0.5, 37.0, leads=Leads(CORNER, BACK, 3.0, 2.0))


def test_the_tool_goes_down_where_a_lead_in_begins_and_up_where_the_lead_out_ends() -> None:
    positions = moved(LED)
    z_moves = np.flatnonzero(np.diff(positions[:, 2]) != 0)
    np.testing.assert_allclose(positions[z_moves[0], :2], (7, 0), atol=EXACT_MM)
    np.testing.assert_allclose(positions[z_moves[-1], :2], (10, -2), atol=EXACT_MM)
    np.testing.assert_allclose(positions[-1], (10, -2, WORK.clearance_mm), atol=EXACT_MM)


@pytest.mark.parametrize(
    ("work", "card"),
    [
        (replace(WORK, passes_mm=(1.0, 2.0)), Card()),
        (WORK, Card(entry_mm=5.0)),
        (WORK, Card(entry_mm=1.0)),
    ],
    ids=["three passes", "an entry into the loop", "an entry on the lead-in"],
)
def test_of_several_passes_the_first_has_the_lead_in_and_the_last_the_lead_out(
    work: Work, card: Card
) -> None:
    """Between the passes the tool stays in the work and runs on; nowhere does it leap."""
    positions = moved(LED, operator=Operator(work, card))
    in_lead = positions[(positions[:, 0] < 9.9) & (positions[:, 2] < 0)]
    out_lead = positions[positions[:, 1] < -0.1]
    assert np.all(np.diff(in_lead[:, 0]) >= 0)  # once, towards the square
    assert np.all(np.diff(out_lead[:, 1]) <= 0)  # once, away from it
    np.testing.assert_allclose(out_lead[0, 2], -WORK.depth_mm, atol=EXACT_MM)
    raised = np.flatnonzero(positions[:, 2] > EXACT_MM)
    assert np.diff(raised).max() == len(positions) - len(raised) + 1  # up before and after only
    assert np.abs(np.diff(positions[:, :2], axis=0)).max() < 2 * STEP_MM


def test_the_width_of_several_lines_is_that_along_most_of_their_way() -> None:
    """Not that of the first one: a broad letter, cut first, stood for a whole page of a fine pen."""
    letter = replace(OPEN, width_mm=1.4, number=1)
    assert (
        Trace((letter, replace(LINE, width_mm=0.6), OPEN), Operator(WORK)).line_width_mm == 0.6
    )
    assert Trace((letter,), Operator(WORK)).line_width_mm == 1.4
