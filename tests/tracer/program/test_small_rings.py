"""Closed lines that are too small to be contours are left out of a program of contours, and told."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.jobs.remarks_on_ink import of_ink
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import Points, arc, inked, polyline

PLATE = polyline((4, 4), (44, 4), (44, 30), (4, 30), (4, 4))
PITCH_MM = 25.4 / 300


def told(*lines: Points, width_mm: float) -> str:
    """What is told of a program of contours."""
    return " ".join(of_ink(trace_lines(inked(*lines, width_mm=width_mm, seed=1)), several=True))


@pytest.mark.parametrize("diameter_mm", [1.0, 1.2])
def test_a_hole_shorter_than_a_contour_is_told_with_its_place(diameter_mm: float) -> None:
    hole = arc((14, 20), diameter_mm / 2)
    trace = trace_lines(inked(PLATE, hole, width_mm=0.35, seed=1))
    (ring,) = trace.small_rings
    assert np.hypot(*(np.array(ring.place_mm) - (14, 20))) < PITCH_MM
    assert ring.across_mm == pytest.approx(diameter_mm + 0.35, abs=2.5 * PITCH_MM)
    said = " ".join(of_ink(trace, several=True))
    assert "1 small closed line is left out" in said and "14.0,20.0 mm" in said
    # the advice works
    assert "--lines all" in said
    all_ink = trace_ink(inked(PLATE, hole, width_mm=0.35, seed=1))
    assert [line.ending for line in all_ink.lines] == ["closed", "closed"]


def test_dots_and_larger_holes_are_no_small_rings() -> None:
    dot = polyline((14, 20), (14.01, 20))
    assert "small closed" not in told(PLATE, dot, arc((30, 20), 1.5), width_mm=0.5)


def test_a_slot_too_narrow_to_be_followed_is_told() -> None:
    """The paper within a slot of 4.2 by 1.2 mm is a fifth of its line's width."""
    slot = polyline((12, 20), (15, 20), (15, 21.2), (12, 21.2), (12, 20))
    said = told(PLATE, slot, width_mm=1.0)
    assert "the head can nowhere be put down" in said and "13.5,20.6 mm" in said
