"""Closed lines that are too small to be contours are left out of a program of contours, and told."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from morfax.jobs.remarks.on_ink import of_ink
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import Points, arc, inked, polyline

PLATE = polyline((4, 4), (44, 4), (44, 30), (4, 30), (4, 4))
PITCH_MM = 25.4 / 300


def told(*lines: Points, width_mm: float) -> str:
    """What is told of a program of contours."""
    return " ".join(of_ink(trace_lines(inked(*lines, width_mm=width_mm, seed=1)), several=True))


def test_a_ring_outside_the_part_that_is_shorter_than_a_contour_is_told_with_its_place() -> (
    None
):
    """Inside the part it is a hole (see `test_small_loops`)."""
    lines = PLATE, arc((50, 20), 0.6)
    trace = trace_lines(inked(*lines, width_mm=0.35, seed=1))
    (ring,) = trace.small_rings
    assert np.hypot(*(np.array(ring.place_mm) - (50, 20))) < PITCH_MM
    assert ring.across_mm == pytest.approx(1.2 + 0.35, abs=2.5 * PITCH_MM)
    said = " ".join(of_ink(trace, several=True))
    assert "1 small closed line is left out" in said and "50.0,20.0 mm" in said
    # the advice works
    assert "--lines all" in said
    all_ink = trace_ink(inked(*lines, width_mm=0.35, seed=1))
    assert [line.ending for line in all_ink.lines] == ["closed", "closed"]


def test_dots_and_larger_holes_are_no_small_rings() -> None:
    dot = polyline((14, 20), (14.01, 20))
    assert "small closed" not in told(PLATE, dot, arc((30, 20), 1.5), width_mm=0.5)


def test_a_zigzag_too_narrow_to_be_followed_is_told() -> None:
    """Its strokes lie nearer than the line is wide, and leave no paper within."""
    zigzag = polyline(*((12 + 0.7 * k, 20 + 1.2 * (k % 2)) for k in range(7)))
    said = told(PLATE, zigzag, width_mm=1.0)
    assert "the head can nowhere be put down" in said


def plate_with_slot(wide_mm: float) -> Trace:
    """The contours of a plate with a slot 2.4 mm long and a dot, both drawn with a line of 1 mm."""
    slot = polyline((12, 20), (14.4, 20), (14.4, 20 + wide_mm), (12, 20 + wide_mm), (12, 20))
    dot = polyline((30, 20), (30.01, 20))
    return trace_lines(inked(PLATE, slot, dot, width_mm=1.0, dpi=150, seed=1))


def test_a_slot_whose_sides_run_together_is_told_with_its_place() -> None:
    """Its sides are as far apart as its line is wide: no paper is seen within, and no seam. A dot is none."""
    trace = plate_with_slot(1.0)
    assert [line.ending for line in trace.lines if not line.is_dot] == ["closed"]
    (patch,) = trace.unclear
    assert patch.place_mm == pytest.approx((13.2, 20.5), abs=2 * PITCH_MM)
    said = " ".join(of_ink(trace, several=True))
    assert "1 line is left out" in said and "with a finer pen" in said


def test_a_slot_whose_ink_shows_the_seam_between_its_sides_is_cut() -> None:
    """Within half a pixel, 85 um: its sides are 0.1 mm further apart than its line is wide."""
    trace = plate_with_slot(1.1)
    assert trace.unclear == ()
    (slot,) = (line for line in trace.lines if line.length_mm < 10 and not line.is_dot)
    low, high = slot.xy_mm.min(axis=0), slot.xy_mm.max(axis=0)
    assert [*low, *high] == pytest.approx([12, 20, 14.4, 21.1], abs=0.5 * PITCH_MM)


def test_a_thick_dash_is_no_slot_and_is_told() -> None:
    """As thick as the slot of 1.1 mm and its line, but of one stroke of a thick pen: it has no seam."""
    rows = [polyline((12, y), (14.4, y)) for y in np.arange(20, 21.11, 0.22)]
    trace = trace_lines(inked(PLATE, *rows, width_mm=1.0, dpi=150, seed=1))
    assert len([line for line in trace.lines if not line.is_dot]) == 1
    assert len(trace.unclear) == 1


def test_of_all_the_ink_a_slot_is_laid_once_though_several_strokes_lie_on_its_patch() -> None:
    """Its sides are 1.3 lines apart: within 0.1 mm it is 8.5 mm round, and was run three times."""
    along, across = 1.8 * _unit(70), 0.325 * _unit(160)
    corners = (-along - across, along - across, along + across, across - along, -along - across)
    slot = polyline(*((22 + x, 17 + y) for x, y in corners))
    trace = trace_ink(inked(PLATE, slot, width_mm=0.5, dpi=300, seed=1))
    inner = [line.length_mm for line in trace.lines if line.length_mm < 60]
    assert inner == [pytest.approx(8.5, abs=0.1)]


def _unit(degrees: float) -> NDArray[np.float64]:
    """A direction of length 1."""
    return np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
