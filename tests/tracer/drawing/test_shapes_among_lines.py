"""Filled shapes among lines, where all the ink is asked for: they are ink, and lines end at them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from morfax.motion.polyline import nearest_mm
from morfax.tracer.drawing import lines_read as lines_read_module
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.levelling import Levelled
from morfax.tracer.drawing.paper import Paper
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.drawing.shapes_among_lines import (
    MOSTLY_SHAPES,
    drawing_of_all_ink,
    has_lines,
)
from morfax.tracer.ink.pale import pale_lines
from morfax.tracer.program.trace_ink import trace_ink

DPI, FINE = 200.0, 4
WIDTH_MM, WIDE_MM, HIGH_MM = 0.6, 110.0, 90.0
BLACK, WHITE, NOISE = 30.0, 240.0, 4.0
# centre and radius of a ring whose upper part is covered by the shape, mm
FACE = (55.0, 30.0), 25.0


def read(shape_mm: NDArray[np.float64], *, lines: bool, light: float = 0.0) -> Drawing:
    """A scan of a filled shape, with lines if they are wanted, below a light that falls off to one side."""
    scale = DPI / 25.4 * FINE
    fine = np.zeros((round(HIGH_MM * scale), round(WIDE_MM * scale)), np.uint8)

    def pixels(points: NDArray[np.float64]) -> NDArray[np.int32]:
        return np.round(points * [scale, -scale] + [0, len(fine)]).astype(np.int32)

    cv2.fillPoly(fine, [pixels(shape_mm)], 255, cv2.LINE_AA)
    thick = round(WIDTH_MM * scale)
    if lines:
        cv2.polylines(fine, [pixels(circle(*FACE))], True, 255, thick, cv2.LINE_AA)
        for x in (45.0, 65.0, 15.0, 95.0):
            cv2.polylines(fine, [pixels(circle((x, 30.0), 8.0))], True, 255, thick, cv2.LINE_AA)
    ink = cv2.resize(fine, None, fx=1 / FINE, fy=1 / FINE, interpolation=cv2.INTER_AREA) / 255.0
    lit = 1 - light * np.linspace(0, 1, ink.shape[1])
    noise = np.random.default_rng(1).normal(0, NOISE, ink.shape)
    grey = np.clip(np.round((WHITE - (WHITE - BLACK) * ink) * lit + noise), 0, 255)
    scan = Scan(Path("made.png"), grey.astype(np.uint8), Stated((DPI, DPI)))
    return drawing_of_all_ink(scan, Scale(), None, "auto")


def circle(centre: tuple[float, float], radius_mm: float) -> NDArray[np.float64]:
    """Places round a circle, mm."""
    turned = np.linspace(0, 2 * np.pi, 400)
    return np.array(centre) + radius_mm * np.column_stack([np.cos(turned), np.sin(turned)])


def box(left: float, bottom: float, right: float, top: float) -> NDArray[np.float64]:
    """The corners of a rectangle, mm."""
    return np.array([[left, bottom], [right, bottom], [right, top], [left, top]])


@pytest.mark.parametrize("light", [0.0, 0.35], ids=["even light", "light from one side"])
@pytest.mark.parametrize(
    "shape_mm", [box(25, 45, 85, 58), box(15, 45, 95, 85)], ids=["a bar", "as broad as a hand"]
)
def test_a_line_that_ends_at_a_black_area_is_followed_up_to_it(
    shape_mm: NDArray[np.float64], light: float
) -> None:
    found = trace_ink(read(shape_mm, lines=True, light=light))
    assert found.ink is not None and found.ink.followed_share > 0.99
    # the line below the shape is not the shape's rim, and the shape's inside is not paper
    centre, radius_mm = FACE
    ring = circle(centre, radius_mm)
    below = ring[ring[:, 1] < shape_mm[0, 1] - WIDTH_MM]
    run = np.vstack([line.places_mm for line in found.lines])
    assert float(nearest_mm(below, run).max()) < 0.1
    (area,) = (area for area in found.ink.areas if area.what == "solid area")
    (left, bottom), (right, top) = shape_mm[0], shape_mm[2]
    assert area.area_mm2 == pytest.approx((right - left) * (top - bottom), rel=0.03)


@pytest.mark.parametrize("lines", [True, False], ids=["among lines", "alone"])
def test_filled_shapes_are_told_and_a_sheet_with_lines_is_read_once(
    monkeypatch: pytest.MonkeyPatch, lines: bool
) -> None:
    levelled, read_as_ink = lines_read_module.levelled, list[bool]()

    def counted(grey: Any, pitch_mm: float, shapes_are_ink: bool, *known: Any) -> Levelled:
        read_as_ink.append(shapes_are_ink)
        return levelled(grey, pitch_mm, shapes_are_ink, *known)

    monkeypatch.setattr(lines_read_module, "levelled", counted)
    assert read(box(25, 45, 85, 58), lines=lines).has_shapes
    assert read_as_ink == ([True] if lines else [True, False])


@pytest.mark.parametrize(
    ("grey", "is_ink"), [(20.0, True), (90.0, False)], ids=["black", "grey"]
)
def test_a_panel_paler_than_ink_stays_paper_for_lines_may_be_drawn_on_it(
    grey: float, is_ink: bool
) -> None:
    small = np.full((300, 300), 240.0, np.float32)
    small[60:240, 60:240] = grey
    paper = Paper.of_reduced(small, 4, 1200, 0.085)
    level = paper.beneath_shapes(small, contrast=220.0).reduced
    assert float(level[150, 150]) == pytest.approx(240.0 if is_ink else grey, abs=2.0)


def test_of_filled_shapes_alone_it_is_said_what_follows_their_outlines() -> None:
    drawing = read(box(25, 30, 85, 70), lines=False)
    assert MOSTLY_SHAPES in drawing.notes


def test_a_sheet_without_ink_has_no_lines() -> None:
    """Of an icon that is dark paper all over; numpy's warning of an empty mean came to the terminal."""
    assert not has_lines(Drawing(np.zeros((40, 60), np.float32), 0.1))


def test_the_shade_of_a_filled_shape_is_no_pale_line() -> None:
    drawing = read(box(25, 30, 85, 70), lines=False)
    assert drawing.shapes is not None and drawing.shapes.any()
    assert not pale_lines(drawing)
