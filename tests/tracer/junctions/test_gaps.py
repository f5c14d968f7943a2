"""Where a line ends and ink goes on: dashes, whose gap is told so that the head can be let across it."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.head.settings import Settings
from morfax.tracer.program.trace import trace
from tests.tracer.inked import UM, Points, arc, inked, polyline

STEP_MM = 0.1  # in which gaps are tried


def dashed(gap_mm: float, dash_mm: float = 4.0, width_mm: float = 0.5) -> list[Points]:
    """A circle of 15 mm in dashes with round ends, gaps and dashes counted by their ink."""
    count = round(2 * np.pi * 15 / (dash_mm + gap_mm))
    turn_deg, on_deg = 360 / count, np.degrees((dash_mm - width_mm) / 15)
    return [arc((20, 20), 15, k * turn_deg, k * turn_deg + on_deg) for k in range(count)]


@pytest.mark.parametrize("gap_mm", [0.8, 2.0])
def test_the_gap_of_a_dashed_line_is_told_and_takes_the_head_round(gap_mm: float) -> None:
    drawing = inked(*dashed(gap_mm), seed=3)
    (line,) = trace(drawing).lines
    assert line.ending == "ended" and line.length_mm < 4 and len(line.breaks) == 2
    told_mm = max(broken.gap_mm for broken in line.breaks)
    assert told_mm == pytest.approx(gap_mm, abs=2 * STEP_MM)
    assert min(np.hypot(*(line.xy_mm[0] - broken.place_mm)) for broken in line.breaks) < 1 * UM
    assert trace(drawing, settings=Settings(gap_mm=told_mm + STEP_MM)).ending == "closed"


@pytest.mark.parametrize(("radius_mm", "gap_mm"), [(10.0, 4.0), (20.0, 4.0), (20.0, 6.0)])
def test_a_wide_gap_in_an_arc_is_crossed_along_its_circle(
    radius_mm: float, gap_mm: float
) -> None:
    """A leg of 1.2 mm does not show the bend: 4 mm straight on from an arc of 20 mm are 0.4 mm beside it.

    In the gap the way is the head's own guess, off the circle by no more than an eighth of the line's width.
    """
    middle = radius_mm + 4
    half_deg = np.degrees((gap_mm + 0.5) / 2 / radius_mm)  # the ends of the ink are round
    drawing = inked(arc((middle, middle), radius_mm, half_deg, 360 - half_deg), seed=2)
    (line,) = trace(drawing, settings=Settings(gap_mm=gap_mm + 1)).lines
    assert line.ending == "closed"
    off_mm = np.hypot(*(line.xy_mm - middle).T) - radius_mm
    assert np.abs(off_mm).max() < 0.5 / 8


def test_a_wide_gap_is_not_crossed_to_ink_beside_the_circle() -> None:
    """An arc goes on 1.5 mm further out behind the gap: that is another line."""
    arcs = arc((24, 24), 20, 6, 90), arc((24, 24), 21.5, -90, -6)
    (line,) = trace(inked(*arcs, seed=2), (24, 44), settings=Settings(gap_mm=5.0)).lines
    assert line.ending == "ended" and line.length_mm < 31


def test_ink_that_does_not_go_on_straight_ahead_is_no_break() -> None:
    """A line that ends before another one across its way, or beside one, or far from one."""
    line = polyline((4, 10), (20, 10))
    for other in (
        polyline((21.5, 4), (21.5, 16)),
        polyline((21.5, 11.5), (30, 11.5)),
        polyline((25, 10), (35, 10)),
    ):
        (traced,) = trace(inked(line, other, seed=1), (8, 10)).lines
        assert traced.ending == "ended" and traced.breaks == ()


def test_a_closed_line_has_no_break() -> None:
    assert trace(inked(arc((12, 12), 8))).lines[0].breaks == ()
