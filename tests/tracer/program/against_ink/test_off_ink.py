"""What a pen along a way leaves about each of its places: nothing but noise where the way is right."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.polyline import evenly
from morfax.tracer.program.against_ink.off_ink import (
    OFF,
    Clean,
    UsualPen,
    felt_at,
    goes_on,
    ink_about,
    without_lone_pixels,
    wrong_about,
)
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles.seen_ink import SeenInk
from tests.tracer.inked import Points, inked, polyline, together

WIDTH_MM, DPI = 0.5, 300.0
LINE = polyline((5.3, 6.1), (24.0, 9.0))
ACROSS = polyline((14.0, 4.0), (15.0, 12.0))


def felt_along(*lines: Points, seed: int | None = 1) -> tuple[UsualPen, Points, SeenInk]:
    """The pen along the first of some lines, places along that, and the ink about them as the pen sees it."""
    drawing = inked(*lines, width_mm=WIDTH_MM, dpi=DPI, seed=seed)
    way = evenly(lines[0], STEP_WIDTHS * WIDTH_MM)[10:-10]
    felt = felt_at(drawing, [Clean(way, np.arange(20, len(way) - 20))], WIDTH_MM)
    assert felt is not None
    return felt, way, felt.pen.sees(ink_about(drawing, way, WIDTH_MM, 1.6))


def straight(way: Points) -> np.ndarray:
    """No corners."""
    return np.zeros(len(way), bool)


def test_the_pen_is_felt_true() -> None:
    """Within 6 percent of the line's width, which is drawn up to two eighths of a pixel wider; its softness
    is that of a scan's blur and pixels, 0.055 mm, or less.
    """
    felt, _, _ = felt_along(LINE)
    assert 2 * felt.pen.half_mm == pytest.approx(WIDTH_MM, rel=0.06)
    assert 0.02 < felt.pen.softness_mm < 0.07
    assert abs(felt.usual) < 0.3 * OFF


def test_no_pen_is_felt_in_a_broad_area() -> None:
    """Beyond the line there is no paper to tell its ink from."""
    way = evenly(LINE, STEP_WIDTHS * WIDTH_MM)[10:-10]
    drawing = inked(LINE, width_mm=5.0, dpi=DPI)
    assert felt_at(drawing, [Clean(way, np.arange(20, len(way) - 20))], WIDTH_MM) is None


def test_a_broader_line_that_is_crossed_leaves_no_ink() -> None:
    """It is known, and as broad as it was felt: 1.1 mm across one of 0.5 mm."""
    drawing = together((LINE, WIDTH_MM), (ACROSS, 1.1), seed=1)
    way = evenly(LINE, STEP_WIDTHS * WIDTH_MM)[10:-10]
    ink = ink_about(drawing, way, WIDTH_MM, 1.6, [(ACROSS, 0.5 * (1.1 - WIDTH_MM))])
    wrong = wrong_about(ink, way, straight(way), STEP_WIDTHS)
    # the line goes on beyond the ends; pens are drawn up to two eighths of a pixel wider
    assert wrong[40:-40].max() < 3 * OFF


@pytest.mark.parametrize("aside_mm", [0.03, 0.06])
def test_a_bulge_of_some_hundredths_of_a_mm_is_off_its_ink_and_the_rest_is_not(
    aside_mm: float,
) -> None:
    """Over a width of way; a third of a pixel and more."""
    _, way, ink = felt_along(LINE)
    along = np.arange(len(way)) - len(way) // 2
    bulge = np.exp(-0.5 * (along * STEP_WIDTHS / 0.5) ** 2)
    aside = np.array([-0.15, 0.98]) * aside_mm
    assert wrong_about(ink, way, straight(way), STEP_WIDTHS)[20:-20].max() < OFF
    wrong = wrong_about(ink, way + bulge[:, None] * aside, straight(way), STEP_WIDTHS)
    assert wrong[len(way) // 2] > OFF
    assert wrong[20 : len(way) // 2 - 40].max() < OFF


def test_a_speck_is_left_out_and_two_pixels_that_hang_together_are_not() -> None:
    _, way, ink = felt_along(LINE, seed=None)
    pitch_mm = 25.4 / DPI
    beside = np.argsort(np.abs(np.hypot(*(ink.places_mm - way[80]).T) - 0.6))[0]
    near = np.flatnonzero(np.hypot(*(ink.places_mm - ink.places_mm[beside]).T) < 1.1 * pitch_mm)
    for specks, kept in (([beside], 1), (near.tolist(), 0)):
        dark = ink.darkness.copy()
        dark[specks] = 1.0
        left = without_lone_pixels(ink._replace(darkness=dark), way, pitch_mm)
        assert len(ink.darkness) - len(left.darkness) == kept


def test_ink_of_another_line_goes_on_and_the_lines_own_does_not() -> None:
    _, way, ink = felt_along(LINE)
    assert not goes_on(ink, way, 1.6)
    _, way, ink = felt_along(LINE, ACROSS)
    assert goes_on(ink, way, 1.6)


def test_too_little_ink_shows_no_pen() -> None:
    drawing = inked(LINE, width_mm=WIDTH_MM, dpi=DPI, seed=1)
    assert felt_at(drawing, [Clean(LINE, np.array([], int))], WIDTH_MM) is None


def test_pixels_that_lie_only_on_ink_show_no_pen() -> None:
    """Along coarse pixels, no row of which lies between one and one and a quarter widths from the line."""
    drawing = inked(polyline((5, 6.477), (60, 6.477)), width_mm=0.6, dpi=100, seed=1)
    way = evenly(polyline((8, 6.477), (57, 6.477)), STEP_WIDTHS * 0.6)
    assert felt_at(drawing, [Clean(way, np.arange(20, len(way) - 20))], 0.6) is None
