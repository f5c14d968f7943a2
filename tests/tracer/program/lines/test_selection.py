"""Several contours: which patches of ink are lines."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.contour import distance
from morfax.motion.faults import LineFault
from morfax.motion.polyline import evenly
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.joined_lines import joined_to
from morfax.tracer.program.lines.selection import Contour, plan
from morfax.tracer.program.program import Trace
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import UM, arc, inked, polyline
from tests.tracer.program.plate import FRAME, HOLE, LINES

# which lines


@pytest.mark.parametrize("off_mm", [0.0, 0.4, 0.49, 0.51, 3.0])
def test_a_stroke_lies_on_a_line_that_runs_along_most_of_it_within_its_width(
    off_mm: float,
) -> None:
    """The line goes on far beyond the stroke, which is 0.5 mm wide, and comes by it again."""
    middles = evenly(polyline((10, 10), (14, 10)), 0.1)
    stroke = Stroke(4.0, 0.5, middles, np.ones(len(middles)), 0)
    corners = (0, 10 + off_mm), (40, 10 + off_mm), (40, 30), (12, 30), (12, 25)
    line = evenly(polyline(*corners), 0.05)
    away_mm = np.hypot(*(middles[:, None] - line).transpose(2, 0, 1)).min(axis=1)
    assert Contour(1, stroke, 4.0).lies_on(line) == bool((away_mm < 0.5).mean() > 0.8)
    assert Contour(1, stroke, 4.0).lies_on(line) == (off_mm < 0.5)
    assert not Contour(1, stroke, 4.0).lies_on(line[line[:, 0] < 12])  # along half of it


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


def test_ink_beyond_a_gap_that_is_followed_in_part_is_another_line() -> None:
    """On a drawn shirt the head came over a gap and went round the collar; a sleeve was left in silence."""
    before, behind = polyline((5, 20), (35, 20)), polyline((35.9, 20), (50, 20))
    followed_in_part = trace(inked(before, behind, polyline((45, 20), (45, 45)), seed=1))
    assert followed_in_part.lines[0].length_mm == pytest.approx(45.0, abs=0.1)
    assert followed_in_part.others.lines == 1
    assert followed_in_part.others.longest_mm == pytest.approx(39.1, abs=3.0)
    assert trace(inked(before, behind, seed=1)).others.lines == 0
