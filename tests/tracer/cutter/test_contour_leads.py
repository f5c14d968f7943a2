"""Leads, where a cut begins, what lies inside what, and lines that stay as they were followed."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from morfax.jobs.remarks.on_contours import of_contouring
from morfax.motion.faults import LineFault, MotionFault
from morfax.motion.motion import join
from morfax.motion.polyline import area_mm2
from morfax.tracer.cutter.contouring import Contouring, Lead
from morfax.tracer.cutter.cutter import Cutter
from morfax.tracer.following.line import Line
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.marks.marks import Mark
from morfax.tracer.program.program import Trace
from tests.tracer.cutter.contours import (
    LEVELS,
    ON_LINE_MM,
    circle,
    closed,
    cut,
    loop,
    positions,
    square,
)


def test_an_arc_touches_the_cut_and_a_straight_lead_meets_it_at_45_degrees() -> None:
    for kind, wanted_deg in (("arc", 0.0), ("line", 45.0)):
        line = cut(
            Trace((closed(square(20)),)), Contouring("climb", Lead(3.0, kind)), None
        ).lines[0]  # type: ignore[arg-type]
        lead, path = line.xy_mm[line.first - 60 : line.first], loop(line)[60:120]
        arrives, leaves = lead[-1] - lead[0], path[-1] - path[0]
        turned = math.degrees(
            math.acos(np.dot(arrives, leaves) / np.hypot(*arrives) / np.hypot(*leaves))
        )
        # the chord of the last 0.1 mm of an arc of 3 mm is 1 degree off its end
        assert turned == pytest.approx(wanted_deg, abs=1.2)


def test_the_size_is_the_arc_s_radius_and_the_straight_lead_s_length() -> None:
    for kind, across_mm in (("arc", 3 * math.sqrt(2)), ("line", 3.0)):
        line = cut(Trace((closed(square(20)),)), Contouring(None, Lead(3.0, kind)), None).lines[
            0
        ]  # type: ignore[arg-type]
        assert math.dist(line.xy_mm[0], line.place(line.first)) == pytest.approx(
            across_mm, abs=ON_LINE_MM
        )


def test_a_cut_begins_on_the_longest_straight_at_the_sharpest_corner_or_nearest_to_the_tool() -> (
    None
):
    """The tip of a house is its sharpest corner (53 degrees inside), its floor the longest straight."""
    house = [(-10.0, 0.0), (10.0, 0.0), (10.0, 12.0), (0.0, 32.0), (-10.0, 12.0)]
    begins = {}
    for start_at in ("straight", "corner", "nearest"):
        lines = Trace((closed(square(2, -30, 6), 2), closed(house)))
        begins[start_at] = cut(lines, Contouring(start_at=start_at), None).lines[1].start_mm  # type: ignore[arg-type]
    slope = math.dist((10.0, 12.0), (0.0, 32.0))
    assert slope > 20.0
    assert begins["straight"] in (
        pytest.approx((5, 22), abs=0.05),
        pytest.approx((-5, 22), abs=0.05),
    )
    assert begins["corner"] == pytest.approx((0, 32), abs=0.01)
    assert begins["nearest"][0] == pytest.approx(-10, abs=0.01)


def test_where_there_is_no_room_a_lead_is_shorter_or_missing_and_that_is_told() -> None:
    """In a hole of 3 mm an arc of 3 mm has no room; in a slot of 0.1 mm there is none at all."""
    slot = [(12.0, -5.0), (12.1, -5.0), (12.1, 5.0), (12.0, 5.0)]
    lines = Trace((closed(circle(1.5), 3), closed(slot, 2), closed(square(20), 1)))
    asked = Contouring("climb", Lead(3.0))
    made = cut(lines, asked, None)
    got = {line.number: line.leads.in_mm if line.leads else 0.0 for line in made.lines}
    assert got[1] == 3.0 and 0.4 < got[3] < 1.0 and got[2] == 0.0
    (told,) = of_contouring(made, asked)
    assert "no room for a lead-in of 3 mm" in told
    assert "none at line 2" in told and f"{round(got[3], 2):g} mm at line 3" in told


def test_a_lead_that_no_line_has_room_for_is_refused() -> None:
    pocket, cutter = Trace((closed(circle(0.15)),)), Cutter(0.1, "inside")
    with pytest.raises(
        MotionFault, match=r"no room for a lead-in of 3 mm, nor for a shorter one.*--lead-in"
    ):
        cut(pocket, Contouring(lead_in=Lead(3.0)), cutter)


def test_open_lines_keep_their_direction_and_alone_are_refused() -> None:
    line = Line(positions([(0, 0), (30, 5)]), "ended", 0.5, 30.4, number=2)
    made = cut(Trace((line, LEVELS.lines[2])), Contouring("climb", Lead(2.0)), None)
    assert np.array_equal(made.lines[0].xy_mm, line.xy_mm)
    (told,) = of_contouring(made, Contouring("climb", Lead(2.0)))
    assert told.startswith("line 2 is open and cut as traced")
    with pytest.raises(MotionFault, match="--climb is for closed lines, and the line is open"):
        cut(Trace((line,)), Contouring("climb"), None)
    as_it_was = cut(Trace((line,)), Contouring("climb", by_machine=True), None)
    assert np.array_equal(as_it_was.lines[0].xy_mm, line.xy_mm)


def test_a_line_that_crosses_itself_stays_as_it_was() -> None:
    eight = closed([(0, 0), (20, 10), (20, 0), (0, 10)])
    made = cut(
        Trace((eight, closed(square(5, 50, 0), 2))), Contouring("climb", Lead(1.0)), None
    )
    assert np.array_equal(made.lines[0].xy_mm, eight.xy_mm)
    assert made.lines[1].leads is not None


def test_what_lies_inside_a_line_with_a_stem_or_a_gap_is_a_hole() -> None:
    """A stem before a loop, and a gap in a line, leave it uncut by leads; but its hole is a hole."""
    stem = positions([(0, -30), *square(20), (0, -20)])
    loop_from = int(np.argmin(np.hypot(*(stem - (0, -20)).T)))
    gap = positions([*square(20)[1:], (-2, -20)])  # from (20, -20) back to 22 mm before it
    nearly = positions([(2, -20), *square(20)[1:], (0, -20)])  # but for 2 mm
    hole = closed(circle(8), 2)
    for outer, is_outline in (
        (Line(stem, "joined", 0.5, 170.0, loop_from=loop_from), True),
        (Line(nearly, "ended", 0.5, 158.0), True),
        (Line(gap, "ended", 0.5, 138.0), False),
    ):
        made = cut(Trace((hole, outer)), Contouring("climb", Lead(2.0)), None)
        assert np.array_equal(made.lines[1].xy_mm, outer.xy_mm)
        inner = made.lines[0]
        assert (math.hypot(*inner.xy_mm[0]) < 8) == is_outline
        assert (area_mm2(loop(inner)) > 0) == is_outline


def test_where_a_line_was_lost_all_stay_as_they_were() -> None:
    lost = replace(LEVELS.lines[2], ending="lost", fault=LineFault("line lost"))
    trace = Trace((LEVELS.lines[1], lost))
    asked = Contouring("conventional", Lead(2.0))
    assert cut(trace, asked, None) is trace
    (told,) = of_contouring(trace, asked)
    assert told.startswith("a line was lost")


def drawn_lead(**more: Any) -> Line:
    """A lead line with a tick from a reference point to a square, followed counter-clockwise, with a tick and
    a guide line on it."""
    way = [
        (0, -20),
        (0, -10),
        (10, -10),
        (10, 10),
        (16, 10),
        (10, 10),
        (-10, 10),
        (-10, -10),
        (0, -10),
    ]
    xy_mm = positions(way)

    def at(x: float, y: float, after: int = 0) -> int:
        return after + int(np.argmin(np.hypot(*(xy_mm[after:] - (x, y)).T)))

    loop_from, leave = at(0, -10), at(10, 10)
    tip = at(16, 10)
    marks = (
        Mark("tick", (0.0, -15.0), float(at(0, -15))),
        Mark("tick", (-10.0, 0.0), float(at(-10, 0))),
    )
    guides = (GuideLine(leave, tip, at(10, 10, tip)),)
    return Line(
        xy_mm, "joined", 0.5, 100.0, loop_from=loop_from, marks=marks, guides=guides,
        reference_mm=(0.0, -23.0), **more,
    )  # fmt: skip


def test_a_drawn_lead_line_goes_before_and_stops_and_guide_lines_come_along() -> None:
    """The line is turned round: the tool still comes by the lead line; each stop stays where it is drawn."""
    drawn = Trace((drawn_lead(),))
    asked = Contouring("climb", Lead(2.0), Lead(2.0))
    made = cut(drawn, asked, None)
    (line,) = made.lines
    assert line.is_lead and line.leads is not None
    assert line.leads.in_mm == 0.0 and line.leads.out_mm == 2.0
    assert line.start_mm == drawn.lines[0].start_mm
    assert area_mm2(loop(line)) < 0 < area_mm2(drawn.lines[0].xy_mm[drawn.lines[0].loop_from :])
    for trace in (drawn, made):
        stops = {
            action.halt.number: action.halt.place_mm
            for action in trace.actions[0]
            if action.halt.number is not None
        }
        assert stops[1] == pytest.approx((0, -15), abs=ON_LINE_MM)
        assert stops[2] == pytest.approx(
            (16, 10), abs=ON_LINE_MM
        )  # the hole at the guide line's tip
        assert stops[3] == pytest.approx((-10, 0), abs=0.01)
    # the hole is drilled with the tool up on the way there, as before
    motion = join(made).positions_mm
    on_guide = motion[motion[:, 0] > 10.5]
    moves = np.any(np.diff(on_guide[:, :2], axis=0) != 0, axis=1)
    assert np.all(on_guide[1:][moves][:, 2] > 0)
    # and the program ends where it began
    assert motion[-1, :2] == pytest.approx(motion[0, :2], abs=1e-9)


@pytest.mark.parametrize(
    ("asked", "plain_changes", "told_changes", "drawn_changes"),
    [
        (Contouring("conventional"), False, False, False),
        (Contouring("climb"), True, False, True),
        (Contouring("climb", mirrored=True), False, False, False),
        (Contouring("conventional", mirrored=True), True, False, True),
        (Contouring(start_at="corner"), True, False, False),
        (Contouring(lead_in=Lead(2.0)), True, True, False),
        (Contouring(lead_out=Lead(2.0)), True, True, True),
    ],
)
def test_a_line_is_run_anew_only_where_it_is_cut_otherwise_than_it_was_followed(
    asked: Contouring, plain_changes: bool, told_changes: bool, drawn_changes: bool
) -> None:
    """An outline followed counter-clockwise; one whose beginning and way the operator's arrow says; one with
    a drawn lead line, which says where it begins.
    """
    told = closed(square(10), as_told=True)
    for line, changes in (
        (closed(square(10)), plain_changes),
        (told, told_changes),
        (drawn_lead(), drawn_changes),
    ):
        (made,) = cut(Trace((line,)), asked, None).lines
        assert np.array_equal(made.xy_mm, line.xy_mm) != changes
        if line.as_told:  # its way is the operator's
            assert area_mm2(loop(made)) > 0


@pytest.mark.parametrize("cutter", [None, Cutter(2.0)])
def test_what_is_asked_of_a_drawing_without_closed_lines_is_refused_by_its_name(
    cutter: Cutter | None,
) -> None:
    lines = [
        Line(positions([(0, y), (30, y + 5)]), "ended", 0.5, 30.4, number=2) for y in (0, 9)
    ]
    if cutter is not None:
        cutter = replace(cutter, side="left")
    for asked, name in (
        (Contouring("conventional"), "--conventional"),
        (Contouring(lead_out=Lead(1.0)), "a lead"),
        (Contouring(start_at="corner"), "--start-at"),
        (Contouring("climb", Lead(1.0), by_machine=True), "a lead"),
    ):
        with pytest.raises(
            MotionFault, match=f"{name} is for closed lines, and all 2 lines are"
        ):
            cut(Trace(tuple(lines)), asked, cutter)
    lost = (replace(lines[0], ending="lost", fault=LineFault("lost")), lines[1])
    cut(
        Trace(lost), Contouring("climb"), cutter
    )  # whether the lost line is closed is not known
