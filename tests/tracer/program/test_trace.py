"""A run as the operator makes it: Z down and up while X and Y stand, the line between, from end to end, in
blocks.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion.contour import distance
from morfax.motion.faults import DrawingFault, LineFault
from morfax.motion.motion import IN_WORK_BELOW_MM, MOTION_RATE_HZ, join, thin
from morfax.tracer.following.line import Line
from morfax.tracer.operator.card import Card
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Work
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from tests.tracer.inked import UM, arc, inked, polyline

CIRCLE = arc((9, 9), 5)
OPEN = polyline((4, 6), (24, 9))


@pytest.fixture(scope="module")
def run() -> Trace:
    return trace(inked(CIRCLE))


def over_the_line(work: Work) -> Trace:
    """A trace that stays where it is for 50 ms: its Z moves are all there is to it."""
    return Trace((Line(np.tile([3.0, 4.0], (300, 1)), "ended", 0.5, 0.0),), Operator(work))


# Z


@settings(max_examples=40)
@given(
    depth_mm=st.floats(0.1, 30),
    clearance_mm=st.floats(0.5, 20),
    feed_mm_s=st.floats(0.5, 50),
    acceleration_mm_s2=st.floats(50, 2000),
)
def test_z_goes_down_to_depth_and_up_to_clearance_within_feed_and_acceleration(
    depth_mm: float, clearance_mm: float, feed_mm_s: float, acceleration_mm_s2: float
) -> None:
    work = Work(depth_mm, clearance_mm, feed_mm_s, acceleration_mm_s2)
    x, y, z = join(over_the_line(work)).positions_mm.T
    assert z[0] == pytest.approx(clearance_mm, abs=1e-9) and z[-1] == pytest.approx(
        clearance_mm, abs=1e-9
    )
    assert z.min() == pytest.approx(-depth_mm, abs=1e-9) and z.max() == pytest.approx(
        clearance_mm, abs=1e-9
    )
    assert np.all(x == 3) and np.all(y == 4)
    speed = np.diff(z) * MOTION_RATE_HZ
    assert np.abs(speed).max() <= feed_mm_s * (1 + 1e-6)
    # the last period of a move is cut short where it arrives: there the speed steps by a period's worth more
    assert np.abs(np.diff(speed)).max() * MOTION_RATE_HZ <= 2.01 * acceleration_mm_s2
    down = z[: np.argmin(z) + 1]
    assert np.all(np.diff(down) <= 1e-12)


def test_without_a_card_the_z_unit_goes_from_clearance_to_depth_and_back_exactly() -> None:
    z = join(over_the_line(Work(1 / 3, np.pi))).positions_mm[:, 2]  # no whole counts
    assert (z[0], z.min(), z[-1]) == (np.pi, -1 / 3, np.pi)


PASSES = Work(depth_mm=5.0, passes_mm=(2.0, 4.0))


def test_a_closed_line_of_several_passes_is_run_on_at_each_depth(run: Trace) -> None:
    passes = Trace(run.lines, Operator(PASSES))
    path = thin(passes)
    assert len(path.runs()) == 1  # the tool stays in the work
    x, y, z = join(passes).positions_mm.T
    for depth_mm in PASSES.depths_mm:
        assert distance(np.column_stack([x, y])[z == -depth_mm], CIRCLE).hausdorff_mm < 25 * UM
    assert np.all(
        np.diff(z[: np.argmin(z) + 1]) <= 0
    )  # from depth to depth, and never up in between
    assert (
        np.hypot(np.diff(x), np.diff(y)).max() * MOTION_RATE_HZ < 10.1
    )  # no leap from the end to the start
    assert passes.duration_s == pytest.approx(len(z) / MOTION_RATE_HZ)


def test_an_open_line_of_several_passes_is_begun_again_with_the_tool_up() -> None:
    xy_mm = np.column_stack([np.linspace(0, 10, 6001), np.zeros(6001)])
    passes = Trace((Line(xy_mm, "ended", 0.5, 10.0),), Operator(PASSES))
    path = thin(passes)
    assert [tuple(in_work[0]) for in_work in path.runs()] == [(0, 0)] * 3
    assert [tuple(in_work[-1]) for in_work in path.runs()] == [(10, 0)] * 3
    moved = np.diff(join(passes).positions_mm, axis=0)
    assert not np.any(
        moved[:, :2].any(axis=1) & (moved[:, 2] != 0)
    )  # X and Y stand while Z moves


def test_x_and_y_stand_while_z_moves(run: Trace) -> None:
    positions = join(run).positions_mm
    moving = np.flatnonzero(np.diff(positions[:, 2]) != 0)
    assert np.all(np.diff(positions[:, :2], axis=0)[moving] == 0)
    still = np.diff(positions[:, :2], axis=0).any(axis=1)
    assert np.all(positions[1:, 2][still] == -run.work.depth_mm)  # and the line is run at depth


def test_the_tool_is_in_the_work_along_the_line_only(run: Trace) -> None:
    path = thin(run)
    (in_work,) = path.runs()
    assert path.tool[0] == path.tool[-1] == False  # noqa: E712
    assert distance(in_work, CIRCLE).hausdorff_mm < 25 * UM
    assert path.positions_mm[:, 2].max() > IN_WORK_BELOW_MM
    assert path.xy_mm[0] == pytest.approx(run.start_mm)


# the stream


def test_the_stream_can_be_read_twice_and_joins_without_a_seam(run: Trace) -> None:
    blocks = list(run)
    assert len(blocks) >= 3
    for one, after in pairwise(blocks):
        assert after.start_s == pytest.approx(one.start_s + one.duration_s, abs=1e-9)
        assert after.rate_hz == one.rate_hz == MOTION_RATE_HZ
    steps = np.hypot(*np.diff(join(run).positions_mm[:, :2], axis=0).T)
    assert (
        steps.max() * MOTION_RATE_HZ < 10.1
    )  # never faster than the tracing speed, not at a seam either
    assert np.array_equal(join(run).positions_mm, join(blocks).positions_mm)


def test_duration_and_length_are_those_of_the_stream(run: Trace) -> None:
    motion = join(run)
    assert run.duration_s == pytest.approx(motion.duration_s, abs=1e-9)
    travelled = np.hypot(*np.diff(motion.positions_mm[:, :2], axis=0).T).sum()
    assert run.length_mm == pytest.approx(travelled, abs=1 * UM)
    assert run.line_width_mm == pytest.approx(0.5, abs=40 * UM)


# which line, from where to where


@pytest.mark.parametrize("start_mm", [None, (12.0, 7.2), (20.0, 8.4), (14.0, 8.5)])
def test_an_open_line_is_followed_from_end_to_end_wherever_the_head_is_put_down(
    start_mm: tuple[float, float] | None,
) -> None:
    run = trace(inked(OPEN), start_mm)
    assert run.ending == "ended"
    ends = run.xy_mm[[0, -1]]
    assert ends[np.argsort(ends[:, 0])] == pytest.approx(
        OPEN, abs=30 * UM
    )  # the pen's round, seen by an aperture
    assert distance(run.xy_mm, OPEN).path_to_reference.max_mm < 25 * UM
    assert run.length_mm == pytest.approx(np.hypot(20, 3), abs=60 * UM)  # once


def test_the_longest_line_is_taken_or_the_one_asked_for() -> None:
    small, large = arc((5, 5), 3), arc((20, 12), 8)
    drawing = inked(small, large)
    assert distance(trace(drawing).xy_mm[::4], large).hausdorff_mm < 25 * UM
    assert distance(trace(drawing, (8.5, 5.0)).xy_mm[::4], small).hausdorff_mm < 25 * UM


def test_a_contour_is_taken_before_the_pieces_of_a_centre_line_that_cross_it() -> None:
    pieces = [polyline((24, 16), (38, 16)), polyline((16, 24), (16, 38))]
    run = trace(inked(arc((16, 16), 10), *pieces, seed=3))
    assert run.ending == "closed"
    assert run.length_mm == pytest.approx(20 * np.pi, abs=0.2)


def test_a_start_far_from_any_line_says_how_far_the_nearest_is() -> None:
    with pytest.raises(
        LineFault, match=r"no line within 3 mm of 9,9 mm: the nearest is 4\.[78] mm away"
    ) as caught:
        trace(inked(CIRCLE), (9.0, 9.0))
    assert (caught.value.x_mm, caught.value.y_mm) == (9.0, 9.0)


def test_a_sheet_without_a_line_is_a_fault() -> None:
    drawing = inked(CIRCLE)
    drawing.darkness[:] = 0
    with pytest.raises(DrawingFault, match="no line on the drawing"):
        trace(drawing)


def test_progress_is_told_up_to_the_line_s_length() -> None:
    told: list[tuple[float, float]] = []
    trace(
        inked(arc((14, 14), 10)),
        progress=lambda come_mm, length_mm: told.append((come_mm, length_mm)),
    )
    come = [come_mm for come_mm, _ in told]
    assert come == sorted(come) and len(come) > 3
    assert all(0 <= come_mm <= length_mm for come_mm, length_mm in told)
    assert told[-1][1] == pytest.approx(
        20 * np.pi, rel=0.1
    )  # a plan: area of ink over its width


def test_a_ramped_entry_goes_down_along_the_line_and_leaves_none_of_it_above_depth(
    run: Trace,
) -> None:
    """Z goes from the surface to depth over 6 mm of the line; what was run above depth is run again, and the
    tool comes back to the line's end.
    """
    ramped = Trace(run.lines, Operator(card=Card.parse('entry = "6mm"')))
    positions = join(ramped).positions_mm
    moving = np.hypot(*np.diff(positions[:, :2], axis=0).T) > 1e-9
    both = moving & (np.abs(np.diff(positions[:, 2])) > 1e-9)
    assert np.hypot(*np.diff(positions[:-1, :2][both], axis=0).T).sum() == pytest.approx(
        6, abs=0.05
    )
    z = positions[:-1, 2][both]
    assert (
        np.all(np.diff(z) <= 0)
        and z[0] == pytest.approx(0, abs=1 * UM)
        and z[-1] == pytest.approx(-5, abs=1 * UM)
    )
    at_depth = positions[positions[:, 2] == -ramped.work.depth_mm][:, :2]
    assert distance(CIRCLE, at_depth[::4]).path_to_reference.max_mm < 25 * UM
    assert positions[-1] == pytest.approx([*run.lines[0].xy_mm[-1], 2.0], abs=1 * UM)
    assert (
        np.abs(np.diff(positions[:, 2], 2)).max() * MOTION_RATE_HZ**2
        <= 2.01 * ramped.work.acceleration_mm_s2
    )
