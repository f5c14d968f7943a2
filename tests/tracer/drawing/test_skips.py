"""Skips of a pen: gaps between ends that face each other, and which gaps are meant."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.tracing.skips import gap_across_skips
from morfax.tracer.drawing.skips import SPARE_MM, WIDEST_MM, gap_to_cross_mm, skips_mm
from morfax.tracer.head.settings import Settings
from morfax.tracer.program.trace import trace
from tests.tracer.inked import DPI, WIDTH_MM, Points, arc, inked, polyline

PIXEL_MM = 25.4 / DPI
CENTRE, RADIUS_MM = (20.0, 20.0), 14.0


def ring(*gaps_mm: float) -> list[Points]:
    """A ring with gaps in its ink, evenly round."""
    # a round pen's ink ends half a width beyond its last place
    open_deg = [np.degrees((gap + WIDTH_MM) / RADIUS_MM) for gap in gaps_mm]
    begins = [k * 360 / len(gaps_mm) for k in range(len(gaps_mm) + 1)]
    return [
        arc(CENTRE, RADIUS_MM, begin + 0.5 * gap, end - 0.5 * after)
        for begin, end, gap, after in zip(
            begins, begins[1:], open_deg, [*open_deg[1:], open_deg[0]], strict=False
        )
    ]


def test_the_widths_of_skips_are_found() -> None:
    found = sorted(skips_mm(inked(*ring(0.4, 0.6, 0.8), seed=1).sheet))
    # both ends are places of whole pixels
    assert found == pytest.approx([0.4, 0.6, 0.8], abs=2 * PIXEL_MM)


def test_three_skips_are_a_pen_s_and_two_may_be_meant() -> None:
    three, two = ring(0.7, 0.7, 0.7), ring(0.7, 0.7)
    assert gap_to_cross_mm(inked(*three, seed=1).sheet) == pytest.approx(
        0.7 + SPARE_MM, abs=2 * PIXEL_MM
    )
    assert gap_to_cross_mm(inked(*two, seed=1).sheet) is None


def test_wide_gaps_and_lines_side_by_side_are_no_skips() -> None:
    wide = ring(*(3 * [WIDEST_MM + 0.3]))
    beside = [polyline((5, 5 + k), (30, 5 + k)) for k in range(5)]
    for lines in (wide, beside):
        assert skips_mm(inked(*lines, seed=1).sheet) == []


def test_a_skipping_ring_comes_round_and_a_gap_that_is_set_holds() -> None:
    drawing = inked(*ring(0.7, 0.7, 0.7, 0.7), seed=1)
    gap_mm = gap_across_skips(drawing, LineSettings(), Settings())
    assert gap_mm is not None
    line = trace(drawing, settings=Settings(gap_mm=gap_mm)).lines[0]
    assert line.ending == "closed"
    away_mm = np.abs(np.hypot(*(line.xy_mm - CENTRE).T) - RADIUS_MM)
    assert away_mm.max() < 0.1  # across a gap the heading of 2 mm of line leads
    assert gap_across_skips(drawing, LineSettings(gap_mm=0.5), Settings()) is None
