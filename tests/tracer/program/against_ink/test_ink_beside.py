"""Ink beside a line is told from ink that is as broad to both of its sides."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.polyline import at_lengths, length_mm
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.ink_beside import Piece, pieces_beside
from tests.tracer.inked import Points, arc, tick, together

WIDTH_MM = 0.5
STEP_MM = 0.0017  # of the motion: 10 mm/s at 6 kHz
CENTRE, RADIUS_MM = (20.0, 20.0), 12.0
# what ink is there is seen to a pixel or two: 85 um at 300 dpi
PIXEL_MM = 0.17


def beside(*more: tuple[Points, float]) -> list[Piece]:
    """What is beside a way round a circle, on which more is drawn by some pens."""
    circle = arc(CENTRE, RADIUS_MM)
    drawing = together((circle, WIDTH_MM), *more, seed=1)
    whole_mm = length_mm(circle)
    way = at_lengths(circle, np.arange(0.0, whole_mm, STEP_MM))
    line = Line(way, "closed", WIDTH_MM, whole_mm)
    return list(pieces_beside(Sheet.of(drawing), [line]))


@pytest.mark.parametrize("about_deg", [0.0, 50.0, 90.0])
def test_a_stretch_of_a_broader_pen_is_told_once_with_its_length(about_deg: float) -> None:
    pen_mm = 3.2 * WIDTH_MM
    (piece,) = beside((arc(CENTRE, RADIUS_MM, about_deg - 20, about_deg + 20), pen_mm))
    assert piece.is_broad
    # the round ends of the pen may count
    chord_mm = 2 * RADIUS_MM * math.sin(math.radians(20))
    assert -WIDTH_MM < piece.length_mm - chord_mm < pen_mm
    x, y = np.array(piece.place_mm) - CENTRE
    assert math.hypot(x, y) == pytest.approx(RADIUS_MM, abs=PIXEL_MM)
    assert abs(math.degrees(math.atan2(y, x)) - about_deg) < 22


@pytest.mark.parametrize("about_deg", [0.0, 50.0, 90.0])
def test_a_line_that_crosses_is_ink_beside_the_way_to_both_sides(about_deg: float) -> None:
    about = math.radians(about_deg)
    on = (20 + RADIUS_MM * math.cos(about), 20 + RADIUS_MM * math.sin(about))
    pieces = beside((tick(on, about_deg + 90), WIDTH_MM))
    assert pieces
    assert not any(piece.is_broad for piece in pieces)
    for piece in pieces:
        assert piece.length_mm == pytest.approx(1.5 + WIDTH_MM / 2, abs=2 * PIXEL_MM)


@pytest.mark.parametrize("about_deg", [0.0, 50.0, 90.0])
def test_ink_along_one_side_of_the_way_is_no_broader_pen(about_deg: float) -> None:
    outside = arc(CENTRE, RADIUS_MM + WIDTH_MM, about_deg - 20, about_deg + 20)
    pieces = beside((outside, 1.2 * WIDTH_MM))
    assert pieces
    assert not any(piece.is_broad for piece in pieces)


def test_a_pen_that_is_less_than_two_widths_broad_is_not_told() -> None:
    assert beside((arc(CENTRE, RADIUS_MM, 0, 40), 2 * WIDTH_MM)) == []
