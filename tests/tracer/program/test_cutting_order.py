"""The order of cutting: which lines the head follows anew from their other end."""

from __future__ import annotations

import pytest

from morfax.motion.polyline import evenly, length_mm
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program import arrows
from morfax.tracer.program.cutting_order import in_cutting_order
from morfax.tracer.program.head_runs import followed
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import UM, WIDTH_MM, inked, polyline

END_MM = 36.0  # of the lower stroke, as of its ink


@pytest.mark.parametrize(("to_mm", "runs"), [(END_MM, 1), (20.0, 0)])
def test_only_from_an_open_end_of_ink_is_a_line_followed_anew(
    to_mm: float, runs: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The lower stroke's end is nearer to where the upper one ends; where that end is within ink, as in
    letters that touch, the head would run to the beginning, and come back along the line as it was.
    """
    places = (4.0, 10.0), (END_MM, 10.0)
    ways = [polyline((4, 16), (END_MM, 16)), polyline(places[0], (to_mm, 10.0))]
    sheet = Sheet.of(inked(ways[0], polyline(*places)))
    upper, lower = (
        Line(evenly(way, 5 * UM), "ended", WIDTH_MM, length_mm(way), number=k, as_told=k == 1)
        for k, way in enumerate(ways, 1)
    )
    asked = list[int]()

    def counted(setup: Setup, start_mm: tuple[float, float], number: int, turns: bool) -> Line:
        asked.append(number)
        return followed(setup, start_mm, number, turns)

    monkeypatch.setattr(arrows, "followed", counted)
    setup = Setup(sheet, Settings(), Operator(order=(1, 2)))
    first, second = in_cutting_order(setup, [upper, lower])
    assert first is upper
    assert len(asked) == runs
    assert (second is lower) == (runs == 0)
