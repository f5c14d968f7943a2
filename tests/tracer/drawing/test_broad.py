"""Broad lines: two lines whose ink runs together, against the pen that other lines of the sheet show.

Broken on purpose, with `TWO` from 1.5 on, `SHORT_WIDTHS` a tenth or `WIDER` twice as large, tests here fail.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from morfax.jobs.remarks.two_lines import TwoLines
from morfax.tracer.drawing import broad as broad_lines
from morfax.tracer.drawing.deviation import darkness_across
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import WIDTH_MM, Points, arc, inked, polyline, together

MIDDLE_MM, RADIUS_MM = (20.0, 20.0), 14.0
ALONE = (polyline((4, 3), (30, 4)), arc(MIDDLE_MM, 5.0))  # lines of the same pen


def rings(widths: float, dpi: float, *others: np.ndarray) -> Drawing:  # type: ignore[type-arg]
    """Two circles round one middle, so many widths apart, and other lines."""
    radii = [RADIUS_MM + side * widths * WIDTH_MM / 2 for side in (-1, 1)]
    return inked(*(arc(MIDDLE_MM, radius) for radius in radii), *others, dpi=dpi, seed=2)


@pytest.mark.parametrize("dpi", [100.0, 120.0, 150.0])
@pytest.mark.parametrize("how", ["one", "contours", "all"])
def test_two_lines_that_the_scan_shows_as_one_are_told_by_the_pen_of_others(
    how: str, dpi: float
) -> None:
    drawing = rings(1.02, dpi, *ALONE)
    follow = {"one": trace, "contours": trace_lines, "all": trace_ink}[how]
    traced = follow(drawing)
    two = TwoLines.along(drawing, traced)
    assert not two.hollow.of_lines and not two.narrow.of_lines  # nothing else shows it
    ((number, found),) = two.broad.of_lines
    line = next(line for line in traced.lines if line.number == number)
    assert abs(np.hypot(*np.subtract(line.xy_mm[0], MIDDLE_MM)) - RADIUS_MM) < 0.1
    assert found.length_mm > 0.9 * line.length_mm
    assert found.width_mm == pytest.approx(2 * two.broad.pen_mm, rel=0.06)  # drawn, 2 pens
    (said,) = two.remarks()
    assert f"line {number} is" in said and "if two lines run side by side" in said


def test_a_sheet_of_one_pen_has_no_broad_line() -> None:
    drawing = inked(arc(MIDDLE_MM, RADIUS_MM), *ALONE, dpi=120.0, seed=2)
    assert not tuple(TwoLines.along(drawing, trace_ink(drawing)).remarks())


@pytest.mark.parametrize(("times", "told"), [(1.6, 0), (2.0, 1), (2.5, 0)])
def test_only_a_line_twice_as_wide_as_the_pen_may_be_two(times: float, told: int) -> None:
    ring, others = (arc(MIDDLE_MM, RADIUS_MM), times * WIDTH_MM), [(a, WIDTH_MM) for a in ALONE]
    drawing = together(ring, *others, seed=2)
    assert len(TwoLines.along(drawing, trace_ink(drawing)).broad.of_lines) == told


def test_gaps_in_a_line_make_its_pen_no_finer() -> None:
    """Dashes of 6 mm with gaps of 0.9 mm, 0.35 mm wide, beside a line of 0.5 mm: it is no two of them."""
    drawing = together((polyline((5, 25), (60, 27)), 0.5), *dashes(0.35), seed=2)
    at_mm = polyline((5, 5), (60, 9))
    seen = partial(darkness_across, drawing)
    widths_mm = broad_lines.widths_along(seen, at_mm, 0.35, drawing.pitch_mm)
    known = widths_mm[np.isfinite(widths_mm)]
    # a sixteenth of the pen, to which its ink is told, and an eighth of a pixel, to which it is drawn
    assert len(known) > 10 and known == pytest.approx(0.35, abs=0.035)
    assert not tuple(TwoLines.along(drawing, trace_ink(drawing)).remarks())


def dashes(width_mm: float) -> list[tuple[Points, float]]:
    """The dashes of a line from 5, 5 to 60, 9 mm, with the round ends of their pen."""
    way = np.array([55.0, 4.0]) / np.hypot(55, 4)
    begins = np.arange(0.0, 50.0, 6.9 + width_mm)
    return [
        (np.array([5.0, 5.0]) + np.array([[at], [at + 6.0]]) * way, width_mm) for at in begins
    ]


def test_a_short_broad_stretch_is_not_told() -> None:
    """Ten widths of two lines in a row of one: a blot, or where lines meet."""
    places = np.column_stack([np.linspace(0, 60, 601), np.zeros(601)])
    widths = np.full(20, 0.5)
    widths[5:8] = 1.0
    assert broad_lines.broad(places, widths, 3.0, 0.5) is None
    widths[5:10] = 1.0
    found = broad_lines.broad(places, widths, 3.0, 0.5)
    assert found is not None and found.length_mm == 15.0 and found.place_mm == (22.5, 0.0)


def test_a_brush_shows_no_pen() -> None:
    widths = np.linspace(0.2, 3.0, 300)
    assert np.isnan(broad_lines.pen_of(widths, np.ones(300)))
    widths[:60] = 0.5
    assert broad_lines.pen_of(widths, np.ones(300)) == pytest.approx(0.5, abs=0.03)
