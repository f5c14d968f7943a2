"""Several contours: which patches are lines, all cut in one stream, lost ones, leads and dots among them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from morfax.motion.contour import distance
from morfax.motion.faults import LineFault
from morfax.motion.motion import MOTION_RATE_HZ, join, thin
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program import one_of_each
from morfax.tracer.program.joined_lines import joined_to
from morfax.tracer.program.lines.selection import plan
from morfax.tracer.program.program import Trace
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import UM, Points, arc, inked, polyline
from tests.tracer.program.plate import FRAME, HOLE, ISLAND, LINES


@pytest.fixture(scope="module")
def all_lines() -> Trace:
    return trace_lines(inked(*LINES, seed=1))


def truth_of(line: Line) -> Points:
    """The line as it was drawn."""
    return LINES[line.number - 1]


# which lines


def test_specks_letters_and_burrs_are_counted_and_left_out() -> None:
    speck = np.array([(28, 8), (29, 8), (29, 9), (28, 9)])
    letter = polyline((8, 6), (10.5, 6))
    contours, left_out = plan(Sheet.of(inked(FRAME, HOLE, letter, specks=[speck])), "contours")
    assert [c.number for c in contours] == [1, 2] and left_out == 2
    assert contours[1].stroke.length_mm == pytest.approx(6 * np.pi, rel=0.1)


def test_the_lines_asked_for_are_followed_and_no_others(all_lines: Trace) -> None:
    assert sorted(line.number for line in all_lines.lines) == [1, 2, 3, 4]
    drawing = inked(*LINES)
    assert [line.number for line in trace_lines(drawing, "outer").lines] == [1]
    assert sorted(line.number for line in trace_lines(drawing, (4, 2, 4)).lines) == [2, 4]
    with pytest.raises(
        LineFault, match="no line 5: the drawing has lines 1 to 4, numbered from the longest"
    ):
        trace_lines(drawing, (2, 5))
    with pytest.raises(ValueError, match="'inner' names no lines"):
        trace_lines(drawing, "inner")


def test_a_letter_that_is_asked_for_by_its_number_is_refused_by_it() -> None:
    scribble = polyline(
        (21.35, 16.07),
        (19.06, 14.04),
        (19.49, 15.6),
        (18.0, 14.01),
        (22.2, 16.67),
        (18.83, 15.71),
        (22.09, 17.75),
    )
    drawing = inked(polyline((6, 6), (50, 6), (50, 30), (6, 30), (6, 6)), scribble, seed=1)
    assert [line.number for line in trace_lines(drawing).lines] == [1]
    for asked in ((1, 2), (2,)):
        with pytest.raises(
            LineFault, match=r"line 2, about \d+\.\d,\d+\.\d mm, is taken for a letter"
        ):
            trace_lines(drawing, asked)


def test_a_line_with_gaps_is_one_line() -> None:
    gapped = [
        arc((14, 14), 9, *span) for span in ((2, 118), (122, 238), (242, 358))
    ]  # the pen fills most of 0.6 mm
    run = trace_lines(inked(*gapped, arc((14, 14), 3), width_mm=0.3))
    assert [line.ending for line in run.lines] == ["closed", "closed"]
    assert run.length_mm == pytest.approx(24 * np.pi, rel=0.01)
    with pytest.raises(LineFault, match="no line 5: the drawing has lines 1, 4, numbered"):
        trace_lines(inked(*gapped, arc((14, 14), 2), width_mm=0.3), (5,))


def test_lines_that_cross_or_touch_are_all_followed_though_they_are_one_patch_of_ink() -> None:
    """Three rings, a line through them, and a chord from ring to ring: no line, but told of."""
    rings = [arc((14, 14), 8), arc((24, 14), 8), arc((40, 14), 11)]
    across, chord = polyline((4, 16), (54, 16)), polyline((40, 3), (40, 25))
    drawing = inked(*rings, across, chord, seed=2)
    run = trace_lines(drawing)
    assert sorted(line.number for line in run.lines) == [1, 2, 3, 4]
    assert sorted(line.ending for line in run.lines) == ["closed", "closed", "closed", "ended"]
    for drawn in (*rings, across):
        assert (
            min(distance(line.places_mm, drawn).hausdorff_mm for line in run.lines) < 120 * UM
        )
    assert 15 < run.left_out_mm < 22
    assert sorted(line.number for line in trace_lines(drawing, (1, 4)).lines) == [1, 4]
    with pytest.raises(LineFault, match="no line 5: the drawing has lines 1 to 4,"):
        trace_lines(drawing, (5,))


OUTLINE = polyline(
    (8, 37), (20, 39), (32, 37), (32, 26), (29, 14), (20, 6), (11, 14), (8, 26), (8, 37)
)
UPRIGHT, BAR = polyline((20, 6), (20, 39)), polyline((8, 28), (32, 28))


def test_a_head_put_down_on_a_chord_is_put_down_elsewhere_before_it_tries_other_turns() -> None:
    """A shield with an upright between two of its corners and a bar: with other turns half of the shield
    closes, along the upright.
    """
    drawing = inked(OUTLINE, UPRIGHT, BAR, width_mm=0.3, seed=2)
    for run in (trace(drawing), trace_lines(drawing)):
        (line,) = run.lines
        assert (
            line.ending == "closed" and distance(line.places_mm, OUTLINE).hausdorff_mm < 40 * UM
        )
    assert run.left_out_mm == pytest.approx(
        33 + 24, rel=0.1
    )  # the upright and the bar, up to the outline


def test_a_run_from_a_chord_does_not_hide_the_contour_that_it_went_along() -> None:
    """The bar has been followed; from the upright the head runs into the outline and most of the way round
    it.
    """
    sheet = Sheet.of(inked(OUTLINE, UPRIGHT, BAR, width_mm=0.3, seed=2))
    (contour,), _ = plan(sheet, "contours")
    bar = Line(np.linspace(*BAR, 6000), "ended", 0.3, 24.0)
    (outline,), left_mm = joined_to(bar, contour, Setup(sheet))
    assert distance(outline.places_mm, OUTLINE).hausdorff_mm < 40 * UM
    assert left_mm == pytest.approx(33, rel=0.1)


def test_marks_guide_lines_and_the_ring_of_the_reference_point_are_no_lines_joined_to_the_contour() -> (
    None
):
    ring, lead = arc((7, 14), 2), polyline((7, 14), (18, 14))
    ticks = [polyline((14, 12.5), (14, 15.5)), polyline((26, 4.5), (26, 7.5))]
    program = trace_lines(
        inked(ring, lead, *ticks, arc((26, 14), 8), polyline((26, 22), (26, 30))),
        operator=Operator(marks="on"),
    )
    assert [(line.number, line.is_lead) for line in program.lines] == [(1, True)]


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


def test_ink_beyond_a_gap_that_is_followed_in_part_is_another_line() -> None:
    """On a drawn shirt the head came over a gap and went round the collar; a sleeve was left in silence."""
    before, behind = polyline((5, 20), (35, 20)), polyline((35.9, 20), (50, 20))
    followed_in_part = trace(inked(before, behind, polyline((45, 20), (45, 45)), seed=1))
    assert followed_in_part.lines[0].length_mm == pytest.approx(45.0, abs=0.1)
    assert followed_in_part.others.lines == 1
    assert followed_in_part.others.longest_mm == pytest.approx(39.1, abs=3.0)
    assert trace(inked(before, behind, seed=1)).others.lines == 0
