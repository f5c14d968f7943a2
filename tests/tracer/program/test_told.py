"""Turns and stops that the operator's corrections tell, at their places."""

from __future__ import annotations

import pytest

from morfax.tracer.corrections.corrections import Correction, Corrections, Kind, Place, Span
from morfax.tracer.drawing.corrected import corrected
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.trace import trace
from tests.tracer.inked import UM, dot, inked, polyline, tick

BOX = polyline((6, 6), (40, 6), (40, 26), (6, 26), (6, 6))
# the lower line goes on beyond the corner
TAIL = inked(BOX, polyline((40, 6), (70, 6)), seed=5)
START = (20.0, 6.0)


def mm(x: float, y: float) -> Place:
    """A place on the sheet."""
    return Place(x, y, "mm")


def followed(
    drawing: Drawing, *each: Correction, start_mm: tuple[float, float] = START
) -> Line:
    """The line that the head follows with some corrections."""
    return trace(corrected(drawing, Corrections(each)), start_mm).lines[0]


@pytest.mark.parametrize(
    ("kind", "come", "length_mm"),
    [
        ("left", None, 108.0),
        ("left", mm(36, 6), 108.0),  # as it comes: from the left
        ("left", mm(40, 10), None),  # of a head that comes down the other side
        ("straight", None, None),
    ],
)
def test_the_head_turns_as_told(
    kind: Kind, come: Place | None, length_mm: float | None
) -> None:
    line = followed(TAIL, Correction(kind, (mm(40.5, 6.5),), coming_from=come))
    assert (line.ending == "closed") == (length_mm is not None)
    if length_mm is not None:
        assert line.length_mm == pytest.approx(length_mm, abs=0.1)  # four corners of 25 um
        assert line.served == {1}


def test_straight_on_goes_across_six_widths_of_paper() -> None:
    """The pen was lifted for 2.5 mm, at a line of 0.53 mm; the head alone goes across 0.5 mm."""
    broken = polyline((24.5, 6), (40, 6), (40, 26), (6, 26), (6, 6), (22, 6))
    drawing = inked(broken, seed=8)
    assert followed(drawing, start_mm=(30, 26)).ending == "ended"
    line = followed(drawing, Correction("straight", (mm(22, 6),)), start_mm=(30, 26))
    assert (line.ending, line.served) == ("closed", {1})


def test_a_turn_to_a_side_without_a_line_is_not_served() -> None:
    """From the left there is nothing to the right; a head that came down the side would turn right there."""
    line = followed(TAIL, Correction("right", (mm(40, 6),), coming_from=mm(36, 6)))
    assert not line.served


def test_a_stop_is_told_where_the_line_comes_nearest() -> None:
    line = followed(inked(BOX, seed=5), Correction("stop", (mm(20, 25),)))
    (mark,) = line.marks
    assert (mark.kind, mark.correction, line.served) == ("tick", 1, {1})
    assert mark.place_mm == pytest.approx((20, 26), abs=10 * UM)
    assert line.place(mark.at) == pytest.approx(mark.place_mm, abs=1 * UM)


def test_a_stop_far_from_the_line_is_not_served() -> None:
    line = followed(inked(BOX, seed=5), Correction("stop", (mm(20, 15),)))
    assert not line.marks and not line.served


def test_a_tick_is_struck_out_and_a_told_stop_stands_at_the_tick_that_is_there() -> None:
    drawing = inked(BOX, tick((15, 26)), tick((30, 26)), seed=5)
    line = followed(
        drawing, Correction("not-stop", (mm(15, 27),)), Correction("drill", (mm(30.8, 26),))
    )
    (mark,) = line.marks
    assert (mark.kind, mark.correction, line.served) == ("dot", 2, {1, 2})
    assert mark.place_mm == pytest.approx((30, 26), abs=30 * UM)  # the tick's own middle


def test_told_stops_are_stops_where_ticks_are_ink() -> None:
    """Without a program drawn on the sheet ticks are ink; what the operator tells is a stop all the same."""
    drawing = inked(BOX, tick((30, 26)), seed=5)
    said = corrected(drawing, Corrections((Correction("stop", (mm(15, 26),)),)))
    stops = [mark.correction for mark in trace(said, START).lines[0].marks]
    assert stops == [1]


def test_a_place_of_the_pen_is_a_dot_as_one_that_was_drawn() -> None:
    operator = Operator(marks="on")
    drawn = trace(inked(BOX, specks=[dot((20, 26), 1.6)]), START, operator=operator).lines[0]
    pen = Correction("bridge", (mm(20, 26),), Span(1.6, "mm"))
    said = corrected(inked(BOX), Corrections((pen,)))
    told = trace(said, START, operator=operator).lines[0]
    assert [mark.kind for mark in told.marks] == [mark.kind for mark in drawn.marks] == ["dot"]
    assert told.marks[0].place_mm == pytest.approx(drawn.marks[0].place_mm, abs=20 * UM)
