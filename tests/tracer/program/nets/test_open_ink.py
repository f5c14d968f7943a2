"""Open ink: where no line comes round, the head is put down for no trial, and runs each stroke once."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.attempts import Attempts
from morfax.tracer.program import one_of_each
from morfax.tracer.program.lines import selection
from morfax.tracer.program.nets.open_ink import is_of_several
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import arc, inked, polyline

TRUNK = polyline((8, 10), (48, 10))
BRANCHES = polyline((20, 10), (20, 30)), polyline((34, 10), (42, 26))


def test_the_strokes_of_a_tree_are_run_without_trials(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its bars end on the trunk, and are no lines: 20 + 17.9 mm of ink are told."""
    runs = list[object]()
    monkeypatch.setattr(Attempts, "run", lambda *asked: runs.append(asked))
    trace = trace_lines(inked(TRUNK, *BRANCHES, seed=2))
    (line,) = trace.lines
    assert not runs and line.ending == "ended"
    assert line.length_mm == pytest.approx(40, abs=0.2)  # the pen's round ends
    assert trace.left_out_mm == pytest.approx(20 + 17.9, rel=0.1)


def test_a_line_that_comes_round_or_is_one_stroke_is_followed_as_ever() -> None:
    for drawing in (inked(arc((16, 16), 10), BRANCHES[0]), inked(TRUNK)):
        setup = Setup(Sheet.of(drawing))
        (contour,), _ = selection.plan(setup.sheet, "contours")
        assert not is_of_several(setup, contour.stroke)


def test_a_ring_with_a_gap_is_closed_though_it_stands_among_letters() -> None:
    """A gap of 0.3 mm, which the head crosses: its patch goes round nothing."""
    width_mm, radius_mm = 0.5, 3.0
    half = 0.5 * (0.3 + width_mm) / radius_mm
    angles = np.linspace(half, math.tau - half, 200)
    ring = radius_mm * np.column_stack([np.cos(angles), np.sin(angles)]) + 10.0
    setup = Setup(Sheet.of(inked(ring, width_mm=width_mm, seed=3)))
    (contour,), _ = selection.plan(setup.sheet, "contours")
    found = one_of_each._follow(setup, contour, is_letter=True)
    assert found.line is not None and found.line.ending == "closed"
