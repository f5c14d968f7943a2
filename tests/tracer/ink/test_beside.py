"""Two lines in one ink of which one begins or ends beside the other: two strokes, each from end to end."""

from __future__ import annotations

from dataclasses import replace
from unittest import mock

import numpy as np
import pytest

from morfax.motion.polyline import length_mm, nearest_mm
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.beside import Shared, _own, lines_beside
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.run import Run
from morfax.tracer.ink.stretches import FeltSheet
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.program.trace_lines import trace_lines
from morfax.tracer.sensing.view import STEP_WIDTHS
from tests.tracer.drawing.test_grain import opened
from tests.tracer.inked import WIDTH_MM, Points, arc, inked, polyline, together

CLEAR = polyline((5, 40), (55, 40))  # a line by itself


def aside_mm(one: Points, other: Points) -> float:
    """How far two lines are from each other, their ends too, mm."""
    away = *nearest_mm(one, dense(other)), *nearest_mm(other, dense(one))
    return float(np.max(away))


def dense(line: Points) -> Points:
    """A line with places 0.02 mm apart."""
    come = np.r_[0, np.cumsum(np.hypot(*np.diff(line, axis=0).T))]
    at = np.arange(0, come[-1] + 0.02, 0.02)
    return np.column_stack([np.interp(at, come, axis) for axis in line.T])


@pytest.mark.parametrize("apart", [0.4, 0.7, 0.97])
@pytest.mark.parametrize("other", [(9, 40), (9, 58), (-2, 40)])
def test_a_line_that_begins_or_ends_beside_another_is_a_stroke_of_its_own(
    apart: float, other: tuple[int, int]
) -> None:
    """The other lies within the one's length, goes on beyond its end, or begins before it."""
    one = polyline((5, 20), (50, 20))
    y = 20 + apart * WIDTH_MM
    beside = polyline((5 + other[0], y), (other[1], y))
    found = trace_ink(inked(one, beside, CLEAR, seed=2))
    assert len(found.lines) == 3
    for line in (one, beside):
        # a tenth of the pen's width, at the ends a pixel: their rounds lie beside the other's ink
        assert min(aside_mm(line, stroke.xy_mm) for stroke in found.lines) < 0.085


def test_bent_lines_of_two_pixels_are_two_strokes() -> None:
    """Half of a millimetre at 100 dpi; on such a sheet no widths tell ink of two lines."""
    one, other = arc((30, -10), 40, 60, 120), arc((30, -10), 40 + 0.8 * WIDTH_MM, 75, 105)
    found = trace_ink(inked(one, other, CLEAR, seed=3, dpi=100))
    assert len(found.lines) == 3
    for line in (one, other):
        # half of a pixel
        assert min(aside_mm(line, stroke.xy_mm) for stroke in found.lines) < 0.127


@pytest.mark.parametrize(("width_mm", "dpi"), [(0.45, 300.0), (0.45, 150.0)])
def test_a_line_of_ink_and_paper_alone_is_one_stroke_where_it_is_nearly_level(
    width_mm: float, dpi: float
) -> None:
    """Of two levels, as a fax has it: from step to step it is a pixel broader or narrower."""
    turn = np.linspace(0, 2 * np.pi, 1500)
    across = 30 * np.cos(turn) - 9 * np.cos(2 * turn)
    up = 14 * np.sin(turn) + 5 * np.sin(2 * turn) * np.cos(turn)
    fish = np.column_stack([53 + 1.2 * across, 26.03 + 1.2 * up])
    levels = np.where(inked(fish, width_mm=width_mm, dpi=dpi).darkness > 0.5, 0.0, 255.0)
    (stroke,) = trace_ink(opened(levels, dpi)).lines
    assert stroke.ending == "closed"
    assert aside_mm(fish, stroke.xy_mm) < MM_PER_INCH / dpi  # a pixel, at its corners


def beside(drawing: Drawing) -> dict[int, list[int]]:
    """How many runs each line has of each stretch on which lines run beside each other."""
    left = ink_left(drawing.sheet)
    felt = FeltSheet.of(left.drawing, Settings(), left.ink, are_strokes=True)
    return {n: [len(line.runs) for line in lines] for n, lines in felt.beside.items()}


def test_a_line_part_of_which_a_broader_pen_drew_is_one() -> None:
    """Both its rims step aside."""
    one = polyline((5, 20), (50, 20))
    broad = polyline((15, 20), (40, 20))
    assert (
        beside(together((one, WIDTH_MM), (broad, 1.6 * WIDTH_MM), (CLEAR, WIDTH_MM), seed=1))
        == {}
    )


def test_a_line_one_rim_of_which_swells_slowly_is_one() -> None:
    """As a wedge does that is drawn beside a line; no pen begins like that."""
    one = polyline((5, 20), (50, 20))
    wedge = np.array([(12.0, 20.0), (27.0, 20.6), (42.0, 20.0)])
    assert beside(inked(one, CLEAR, specks=[wedge], seed=1)) == {}


def test_a_contour_goes_on_from_a_side_into_one_that_runs_beside_its_end() -> None:
    """As strokes it is an open line from end to end."""
    y = 10 + 0.6 * WIDTH_MM
    plate = polyline((40, 10), (10, 10), (10, 40), (60, 40), (60, y), (30, y))
    drawing = inked(plate, polyline((25, 40), (25, 55)), polyline((10, 25), (60, 25)), seed=1)
    assert [line.ending for line in trace_lines(drawing).lines] == ["closed"]
    longest = max(trace_ink(drawing).lines, key=lambda line: line.length_mm)
    assert longest.length_mm == pytest.approx(length_mm(plate), abs=0.5)  # its corners are cut


def test_a_burr_near_the_end_of_a_line_is_no_step() -> None:
    """Half of a step has come there, and too little of a line before it shows where that leads."""
    left = ink_left(inked(polyline((5, 20), (50, 20)), seed=1).sheet)
    (run,) = FeltSheet.of(left.drawing, Settings(), left.ink).felt
    widths = np.full(len(run), WIDTH_MM)
    widths[16:-60] = 1.6 * WIDTH_MM
    widths[7:9] = 1.6 * WIDTH_MM
    assert lines_beside(replace(run, widths_mm=widths), WIDTH_MM, (True, True)) == []


def test_the_lines_of_a_shared_part_are_by_themselves_off_its_steps_outward() -> None:
    part = Shared(10.4, 20.6, mock.Mock(spec=Run), 1, -1)
    assert part.cuts(0) == (10, 21) and part.cuts(3) == (7, 24)


def test_a_line_shows_where_it_leads_within_three_widths_before_a_step() -> None:
    """Nearer the step is seen already; further off it may have come from elsewhere."""
    step_mm = STEP_WIDTHS * WIDTH_MM
    nearest, farthest = _own(1000, WIDTH_MM, step_mm)
    assert 0.5 < nearest * STEP_WIDTHS < 1 and 2 < farthest * STEP_WIDTHS < 3
    assert _own(12, WIDTH_MM, step_mm) == (nearest, 12)  # all of a short one
