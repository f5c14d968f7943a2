"""The lines of a ring of ink: the head runs along none of which it is known that they are not taken."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.lines import selection
from morfax.tracer.program.nets import net_lines
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import inked, polyline


@pytest.mark.parametrize(("reads_marks", "runs"), [(True, 0), (False, 1)])
def test_a_line_with_ticks_is_not_run_by_its_junctions_where_marks_are_read(
    reads_marks: bool, runs: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a coast of 650 mm, whose spikes are as short as ticks, 1.2 of 9.5 s were spent on that run."""
    turns, ran = np.linspace(0, 2 * np.pi, 200), list[Line]()
    ring = np.column_stack([20 + 10 * np.cos(turns), 20 + 10 * np.sin(turns)])
    drawing = inked(ring, polyline((28.8, 20), (31.2, 20)))
    setup = Setup(drawing.sheet, Settings(), Operator(), None)
    (contour,), _ = selection.plan(setup.sheet, "contours")

    def counted(*args: object) -> Line:
        ran.append(line_along(*args))
        return ran[-1]

    line_along = net_lines.line_along
    monkeypatch.setattr(net_lines, "line_along", counted)
    found = net_lines.lines_of_ring(setup, contour, reads_marks)
    assert [line.ending for line in found] == ["closed"] * runs
    assert len(ran) == runs
