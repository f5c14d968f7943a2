"""Open ink: where no line comes round, the head is put down for no trial, and runs each stroke once."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.attempts import Attempts
from morfax.tracer.program import one_of_each
from morfax.tracer.program.lines import selection
from morfax.tracer.program.nets.open_ink import strokes_told
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
        assert strokes_told(setup, contour, is_letter=False) is None


HOOK = polyline((10, 10), (14, 18), (18, 10))  # small: it reaches over 8 mm


def test_a_small_stroke_on_its_own_is_run_without_trials(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Attempts, "run", None)
    (line,) = trace_lines(inked(HOOK, seed=2)).lines
    assert line.ending == "ended"
    assert line.length_mm == pytest.approx(2 * math.hypot(4, 8), abs=0.3)  # ends and the corner


@pytest.mark.parametrize("gap_mm, leads_on", [(0.3, True), (1.5, False)])
def test_a_small_stroke_whose_end_is_at_a_gap_is_not(gap_mm: float, leads_on: bool) -> None:
    """The head crosses half a millimetre; the pen's round ends make a gap narrower by its width."""
    width_mm = 0.5
    begin = 18 + gap_mm + width_mm
    dashes = polyline((8, 10), (18, 10)), polyline((begin, 10), (begin + 20, 10))
    setup = Setup(Sheet.of(inked(*dashes, width_mm=width_mm, seed=2)))
    contours, _ = selection.plan(setup.sheet, "contours")
    dash = min(contours, key=lambda contour: contour.reach_mm)
    assert (strokes_told(setup, dash, is_letter=False) is None) == leads_on


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
