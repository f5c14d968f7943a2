"""Several contours are cut in one stream: their order and figures, lost ones, leads and dots among them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from morfax.motion.contour import distance
from morfax.motion.faults import LineFault
from morfax.motion.motion import MOTION_RATE_HZ, join, thin
from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program import one_of_each
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import UM, Points, arc, inked, polyline
from tests.tracer.program.plate import ISLAND, LINES


def truth_of(line: Line) -> Points:
    """The line as it was drawn."""
    return LINES[line.number - 1]


# one stream


def test_every_line_is_cut_where_it_was_drawn_the_inner_ones_first(all_lines: Trace) -> None:
    numbers = [line.number for line in all_lines.lines]
    assert numbers[-1] == 1 and numbers.index(4) < numbers.index(2)
    runs = thin(all_lines).runs()
    assert len(runs) == 4
    for run, line in zip(runs, all_lines.lines, strict=True):
        found = distance(run, truth_of(line))
        assert (
            found.hausdorff_mm < 50 * UM and found.path_to_reference.rms_mm < 9 * UM
        )  # 19 and 5.5, of the hole of 3 mm
        assert line.ending == "closed" and line.width_mm == pytest.approx(0.5, abs=40 * UM)


def test_from_line_to_line_the_tool_goes_straight_at_clearance(all_lines: Trace) -> None:
    motion = join(all_lines)
    assert motion.duration_s == pytest.approx(all_lines.duration_s, abs=1e-9)
    up = motion.positions_mm[:, 2] == all_lines.work.clearance_mm
    steps = np.hypot(*np.diff(motion.positions_mm[:, :2], axis=0).T)
    assert steps[up[1:] & up[:-1]].sum() == pytest.approx(all_lines.idle_mm, abs=1 * UM)
    assert np.all(
        np.diff(motion.positions_mm[:, 2])[steps * MOTION_RATE_HZ > 10.1] == 0
    )  # faster than it cuts only there
    assert steps.max() * MOTION_RATE_HZ <= all_lines.work.rapid_mm_s * (1 + 1e-6)
    for one, after in pairwise(all_lines):
        assert after.start_s == pytest.approx(one.start_s + one.duration_s, abs=1e-9)


def test_figures_of_several_lines(all_lines: Trace) -> None:
    assert all_lines.ending == "closed" and all_lines.fault is None and all_lines.left_out == 0
    assert all_lines.length_mm == pytest.approx(sum(line.length_mm for line in all_lines.lines))
    assert all_lines.start_mm == all_lines.lines[0].start_mm
    assert len(all_lines.xy_mm) == sum(len(line.xy_mm) for line in all_lines.lines)


def test_progress_is_told_over_all_lines() -> None:
    told: list[tuple[float, float]] = []
    trace_lines(
        inked(*LINES), progress=lambda come_mm, length_mm: told.append((come_mm, length_mm))
    )
    come = [come_mm for come_mm, _ in told]
    assert all(0 <= come_mm <= length_mm for come_mm, length_mm in told)
    assert len({length_mm for _, length_mm in told}) == 1 and max(come) > 0.9 * told[0][1]
    # bays, the lines joined to others and their order count, too, and nothing comes back
    assert come == sorted(come) and max(np.diff(come)) < 0.5 * told[0][1]


# a line lost


def test_a_lost_line_is_cut_as_far_as_it_was_followed_and_the_others_all_the_same() -> None:
    """5 mm of solid ink ahead: neither an end nor a leg can be seen from where the line enters it."""
    patch = np.array([[24.0, 5], [30, 5], [30, 15], [24, 15]])
    drawing = inked(
        polyline((4, 10), (44, 10)), arc((12, 20), 5), arc((36, 20), 4), specks=[patch]
    )
    run = trace_lines(drawing, settings=Settings(line_width_mm=0.5))
    (lost,) = (line for line in run.lines if line.ending == "lost")
    assert [line.ending for line in run.lines].count("closed") == 2 and run.ending == "lost"
    assert (
        f"line {lost.number} of 3 is incomplete, the others are cut; line {lost.number}: line lost at"
        in str(run.fault)
    )
    assert (
        run.fault is not None and lost.fault is not None and run.fault.x_mm == lost.fault.x_mm
    )
    assert len(thin(run).runs()) == 3


def test_a_large_line_that_cannot_be_begun_is_told_and_the_tool_stays_up(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    followed = one_of_each.followed

    def not_the_hole(
        drawing: object, start_mm: tuple[float, float], *others: object, **more: object
    ) -> object:
        if start_mm[0] > 20:
            raise LineFault("no clean stretch of line to start on")
        return followed(drawing, start_mm, *others, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(one_of_each, "followed", not_the_hole)
    run = trace_lines(inked(ISLAND, arc((28, 14), 6.5)))
    assert [line.ending for line in sorted(run.lines, key=lambda line: line.number)] == [
        "lost",
        "closed",
    ]
    assert "line 1 of 2 is incomplete" in str(run.fault) and len(thin(run).runs()) == 1
    assert join(run).duration_s == pytest.approx(run.duration_s, abs=1e-9)


# lead lines, reference points and dots among several lines


def test_a_lead_line_is_begun_at_its_reference_point_and_the_cross_is_no_line() -> None:
    cross = [polyline((5, 14), (9, 14)), polyline((7, 12), (7, 16))]
    circle, hole = arc((26, 14), 8), arc((26, 14), 3)
    program = trace_lines(inked(polyline((10, 14), (18, 14)), circle, hole, *cross))
    inner, outer = program.lines
    assert (inner.ending, outer.ending, outer.is_lead) == ("closed", "joined", True)
    assert outer.reference_mm == pytest.approx((7, 14), abs=25 * UM)
    end_mm = join(program).positions_mm[-1, :2]
    assert end_mm == pytest.approx(outer.reference_mm, abs=1 * UM)


def test_a_dot_alone_is_drilled_on_the_way() -> None:
    """The hole goes down at the dot's middle, to a tenth of a pixel, and is no patch left out."""
    dots = [arc((34, 8), 0.8), arc((34, 20), 1.5)]
    program = trace_lines(inked(arc((14, 14), 8), specks=dots), operator=Operator(marks="on"))
    places = sorted(
        (action.halt.kind, action.halt.place_mm)
        for actions in program.actions
        for action in actions
        if action.halt.number
    )
    assert [kind for kind, _ in places] == ["hole", "hole"]
    for (_, place), middle in zip(places, [(34, 8), (34, 20)], strict=True):
        assert place == pytest.approx(middle, abs=10 * UM)
    assert program.left_out == 0
    down = join(program).positions_mm
    assert down[down[:, 2] == -program.work.depth_mm][:, 0].max() == pytest.approx(
        34, abs=10 * UM
    )


def test_a_sheet_of_dots_is_drilled_if_the_pen_s_width_is_given_and_else_says_so() -> None:
    middles = [(8.0, 8.0), (20.0, 14.0), (32.0, 8.0)]
    drawing = inked(specks=[arc(middle, 0.9) for middle in middles])
    program = trace_lines(drawing, settings=Settings(line_width_mm=0.5))
    drilled = sorted(actions[0].halt.place_mm for actions in program.actions)
    assert np.array(drilled) == pytest.approx(
        np.array(middles), abs=10 * UM
    )  # a tenth of a pixel
    with pytest.raises(LineFault, match=r"no line can be begun.*--line-width"):
        trace_lines(drawing)
    with pytest.raises(LineFault, match="no line 1: the drawing has none"):
        trace_lines(drawing, (1,))
