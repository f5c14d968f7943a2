"""Ink broader than another line's that is one line all the same: a broader pen, a nib, grain, print."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from morfax.motion.polyline import length_mm, nearest_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.two_levels import with_rims
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.stretches import FeltSheet
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.ink.near_lines import CLEAR, near_lines
from tests.tracer.inked import WIDTH_MM, arc, inked, loops, polyline, together


def test_a_line_of_a_broader_pen_is_one_line() -> None:
    drawn = together((CLEAR, WIDTH_MM), (polyline((5, 20), (55, 20)), 1.6 * WIDTH_MM), seed=1)
    found = trace_ink(drawn)
    assert len(found.lines) == 2 and found.ink is not None and not found.ink.single


def test_a_line_of_a_broader_pen_is_one_line_however_often_others_cross_it() -> None:
    broad = polyline((5, 20), (55, 20)), 1.6 * WIDTH_MM
    others = [(polyline((x, 10), (x + 3, 30)), WIDTH_MM) for x in range(8, 50, 4)]
    found = trace_ink(together(broad, *others, seed=1))
    assert len(found.lines) == 1 + len(others)


@pytest.mark.parametrize("swell", ["by its heading", "as a sine"])
def test_a_nib_that_swells_and_shrinks_is_one_line(swell: str) -> None:
    way = loops(5)
    turned = np.linspace(0, 9 * np.pi, len(way))[::5] + 0.6
    share = np.abs(np.sin(turned)) if swell == "by its heading" else 0.5 - 0.5 * np.cos(turned)
    pieces = ((way[5 * k : 5 * k + 6], 0.25 + 0.35 * wide) for k, wide in enumerate(share))
    found = trace_ink(together(*pieces, seed=1))
    # taken for two lines of the thinnest pen, it was run twice, along both its rims
    assert sum(line.length_mm for line in found.lines) < 1.03 * length_mm(way)
    places = np.vstack([line.places_mm for line in found.lines])
    assert float(np.mean(nearest_mm(places, way) < 0.2 * WIDTH_MM)) > 0.97


def test_rough_lines_do_not_tell() -> None:
    """The width of a rough line says nothing of a second one."""
    rng, x = np.random.default_rng(1), np.linspace(5, 55, 400)
    rough = np.column_stack([np.r_[x, x[::-1]], np.r_[20 + rng.uniform(-0.1, 0.1, 800)]])
    drawing = inked(rough, CLEAR, seed=1)
    left = ink_left(drawing.sheet)
    assert not FeltSheet.of(left.drawing, Settings(), left.ink).doubled.stations


def test_a_small_ring_of_a_broader_pen_is_one_line() -> None:
    """It has no end at which anything could go on: on such a sheet all was given up."""
    ring = arc((30, 20), 2.0), 1.6 * WIDTH_MM
    thin = [(arc((30, 20), radius_mm), WIDTH_MM) for radius_mm in (9.0, 14.0)]
    found = trace_ink(together(ring, *thin))
    assert len(found.lines) == 3 and found.ink is not None
    assert found.ink.followed_share > 0.999 and not found.ink.single


def two_pens(thin_mm: float, thick_mm: float, seed: int | None) -> Drawing:
    """Rings by a thin pen round arcs by a thicker one, which two straight lines of that pen cross."""
    thin = [arc((30, 30), 20.0), arc((30, 30), 24.0), polyline((5, 56), (55, 58))]
    thick = [arc((30, 30), radius_mm, 0.0, 300.0) for radius_mm in (5.0, 8.0, 11.0, 14.0, 17.0)]
    thick += [polyline((12, 16), (20, 44)), polyline((40, 14), (33, 44))]
    drawn = [(line, thin_mm) for line in thin] + [(line, thick_mm) for line in thick]
    return together(*drawn, seed=seed)


def doubled_mm(drawing: Drawing, *, tell_letters: bool = True) -> float:
    """The length of the ink of a drawing that is taken for that of two lines."""
    left = ink_left(drawing.sheet)
    letters = drawing.sheet.patches.painted(
        left.lettering, 0, len(left.ink), 0, left.ink.shape[1]
    )
    told = letters if tell_letters else None
    sheet = FeltSheet.of(left.drawing, Settings(), left.ink, told)
    return sum(sheet.doubled.length_mm(sheet.felt, n) for n in sheet.doubled.stations)


def test_lines_of_few_pixels_do_not_tell() -> None:
    assert doubled_mm(two_pens(0.2, 0.28, None)) == 0.0


def test_lines_with_grain_do_not_tell() -> None:
    """A pencil line on a photograph was told as two along 343 of its 520 mm."""
    clean = two_pens(0.5, 0.65, None)
    assert doubled_mm(clean) > 0
    assert doubled_mm(replace(clean, grainy=True)) == 0


def test_hard_pixels_tell_a_width_to_one_of_them() -> None:
    """A line of five and six pixels was ink of two lines, of which one was told as left out, or both were."""
    seen = inked(*near_lines(True), CLEAR)
    assert doubled_mm(seen) > 10.0
    assert doubled_mm(replace(seen, is_hard=True)) == 0.0


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_broader_pens_line_along_the_steps_of_pixels_is_one_line(seed: int) -> None:
    """It is a pixel broader for as long as its rims come by no step: 29 mm were told as two lines."""
    rows = [polyline((4, y), (46, y + rise)) for y, rise in ((10, 0.4), (28, -0.5), (38, 0.9))]
    columns = [polyline((x, 4), (x + 2, 46)) for x in (12, 24, 37)]
    thin = [(line, 0.25) for line in (*columns, rows[1], polyline((4, 18), (46, 19.4)))]
    drawing = together(*thin, (rows[0], 0.45), (rows[2], 0.45), seed=None)
    noise = np.random.default_rng(seed).normal(0.0, 0.1, drawing.darkness.shape)
    hard = (drawing.darkness + cv2.GaussianBlur(noise, (0, 0), 0.8) > 0.5).astype(np.float32)
    laid = replace(drawing, darkness=with_rims(hard), has_rims=True)
    assert doubled_mm(laid) == 0.0
    assert doubled_mm(replace(laid, has_rims=False)) > 5.0


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_a_broader_pen_that_comes_by_two_lines_in_one_ink_draws_one_line(
    seed: int | None,
) -> None:
    """Where an arc comes up to a straight line both are one ink; the other arcs of that pen are not."""
    drawing = two_pens(0.25, 0.35, seed)
    assert doubled_mm(drawing) < 5.0  # of 230 mm that the broader pen has drawn
    found = trace_ink(drawing)
    assert found.ink is not None and found.ink.followed_share > 0.99


def test_printed_letters_do_not_tell() -> None:
    """Of a broader pen, nowhere as narrow as the lines: they need not even be told as letters."""
    lines = polyline((5, 30), (95, 33)), arc((50, 20), 8.0), arc((30, 18), 9.0)
    drawing = together(*((line, 0.4) for line in lines), seed=1)
    words = np.zeros(drawing.darkness.shape, np.uint8)
    at = 60, len(words) - 60
    cv2.putText(
        words, "SECTION OF RODS", at, cv2.FONT_HERSHEY_TRIPLEX, 1.6, 255, 1, cv2.LINE_AA
    )
    printed = cv2.GaussianBlur(words.astype(np.float32) / 255, (0, 0), 0.6)
    with_words = Drawing(np.maximum(drawing.darkness, printed), drawing.pitch_mm)
    assert doubled_mm(with_words, tell_letters=False) == 0.0
    assert doubled_mm(with_words) == 0.0
