"""Ticks and dots: marks of a drawn program, ink on any other sheet."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.tracer.following.line import Line
from morfax.tracer.marks.marks import Mark
from morfax.tracer.operator.card import Card, Stop
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.lines.marks_read import with_marks_read
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import arc, inked, polyline

TICK = Mark("tick", (22.0, 14.0), 100.0)
STRAIGHT = Line(
    np.column_stack([np.linspace(0, 30, 300), np.zeros(300)]), "ended", 0.5, 30.0, marks=(TICK,)
)
DOT = Line.of_dot(np.array([40.0, 5.0]), 0.5, 2)


def test_on_a_sheet_without_a_reference_point_ticks_and_dots_are_ink_and_the_trace_counts_them() -> (
    None
):
    drawing = inked(
        arc((14, 14), 8), polyline((20.5, 14), (23.5, 14)), specks=[arc((34, 8), 1.2)]
    )
    plain = trace(drawing)
    assert plain.lines[0].marks == () and plain.unread == 1
    assert all(action.halt.kind == "begin" for action in plain.actions[0])
    several = trace_lines(drawing)
    assert [line.is_dot for line in several.lines] == [False] and several.unread == 2
    marked = trace_lines(drawing, operator=Operator(marks="on"))
    kinds = sorted(a.halt.kind for actions in marked.actions for a in actions if a.halt.number)
    assert kinds == ["hole", "tick"] and marked.unread == 0


@pytest.mark.parametrize(
    ("line", "operator"),
    [
        (replace(STRAIGHT, reference_mm=(0.0, 0.0)), Operator()),
        (STRAIGHT, Operator(reference_mm=(50.0, 50.0))),
        (STRAIGHT, Operator(card=Card(stops=(Stop(1),)))),
        (STRAIGHT, Operator(card=Card(turns=("left",)))),
        (STRAIGHT, Operator(card=Card(restart="manual"))),
        (STRAIGHT, Operator(marks="on")),
    ],
)
def test_a_reference_point_a_card_about_stops_or_the_operator_make_them_marks(
    line: Line, operator: Operator
) -> None:
    lines, unread = with_marks_read([line, DOT], operator)
    assert lines == [line, DOT] and unread == 0


@pytest.mark.parametrize(
    "operator", [Operator(), Operator(card=Card(depths_mm=(5.0,))), Operator(marks="off")]
)
def test_elsewhere_they_are_not(operator: Operator) -> None:
    lines, unread = with_marks_read([STRAIGHT, DOT], operator)
    assert [line.marks for line in lines] == [()] and unread == 2


def test_a_sheet_of_nothing_but_dots_is_drilled() -> None:
    assert with_marks_read([DOT], Operator()) == ([DOT], 0)
