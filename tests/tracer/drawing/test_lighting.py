"""A sheet in a shadow is read as if it lay in even light; filled shapes are no shadows."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from morfax.motion.polyline import evenly, nearest_mm
from morfax.tracer.drawing.deepening import LEAST
from morfax.tracer.drawing.levelling import levelled
from morfax.tracer.drawing.lighting import Lighting
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.drawing.shapes_among_lines import drawing_of_all_ink
from morfax.tracer.program.trace_ink import trace_ink

UM = 1e-3
PAPER, INK = 0.85, 0.1  # of the light, thrown back
RINGS = ((20.0, 20.0, 12.0), (50.0, 20.0, 12.0), (35.0, 20.0, 5.0))  # middles and radii, mm
SHEET_MM = (70.0, 40.0)
FLAT = np.full((120, 200), 235, np.float32)
# of the light: by so much paper itself differs from place to place (5 of 255 levels)
AS_PAPER = 0.02
# of the light: beside an edge; the edges of a line at half its darkness move by a tenth of a pixel then
AT_EDGE = 0.05


def camera(light: NDArray[np.float64]) -> NDArray[np.float64]:
    """The levels of a camera, 0..255."""
    return np.asarray(255 * np.maximum(light, 1e-4) ** (1 / 2.2))


def photographed(dpi: float, pen_mm: float, soft_mm: float, taken: float) -> Scan:
    """Three rings; at 35 mm a shadow begins, upright and so soft, that takes so much of the light."""
    pitch_mm = 25.4 / dpi
    columns, rows = (round(side / pitch_mm) for side in SHEET_MM)
    x = (np.arange(columns) + 0.5) * pitch_mm
    y = (rows - np.arange(rows) - 0.5) * pitch_mm
    off = [np.abs(np.hypot(x - a, y[:, None] - b) - r) for a, b, r in RINGS]
    ink = np.clip(0.5 + (pen_mm / 2 - np.min(off, axis=0)) / pitch_mm, 0, 1)
    light = 1 - taken * (0.5 + np.clip((x - 35) / soft_mm, -0.5, 0.5))
    seen = cv2.GaussianBlur((PAPER + (INK - PAPER) * ink) * light, (0, 0), 0.7)
    noisy = camera(seen) + np.random.default_rng(1).normal(0, 2, seen.shape)
    pixels = np.asarray(np.clip(np.round(noisy), 0, 255), np.uint8)
    return Scan(Path("made.png"), pixels, Stated((dpi, dpi)))


@pytest.mark.parametrize(
    ("dpi", "pen_mm", "soft_mm", "taken"),
    [(150, 0.7, 1.0, 0.7), (150, 0.4, 5.0, 0.7), (300, 1.0, 5.0, 0.7), (300, 0.4, 1.0, 0.4)],
)
def test_lines_across_a_shadows_edge_are_run_once_and_whole(
    dpi: float, pen_mm: float, soft_mm: float, taken: float
) -> None:
    """A quarter of them were paper in the shadow, or broad beside its edge, with no word. (Fails without.)"""
    drawing = drawing_of_all_ink(
        photographed(dpi, pen_mm, soft_mm, taken), Scale(), None, "auto"
    )
    trace = trace_ink(drawing)
    ways = np.vstack([evenly(line.xy_mm, 0.1) for line in trace.lines])
    turn = np.linspace(0, 2 * np.pi, 400)
    true = [np.column_stack([a + r * np.cos(turn), b + r * np.sin(turn)]) for a, b, r in RINGS]
    for ring in true:
        assert nearest_mm(ring, ways).max() < 0.1  # the ways' own steps are 0.1 mm apart
    length_mm = 2 * np.pi * sum(r for _, _, r in RINGS)
    run_mm = sum(line.length_mm for line in trace.lines)
    assert abs(run_mm - length_mm) < 0.01 * length_mm
    # a shadow's edge of a millimetre tilts a line's profile by a twentieth of a pixel, 8.5 um at 150 dpi; the
    # camera's noise adds as much
    off = np.min([np.abs(np.hypot(*(ways - (a, b)).T) - r) for a, b, r in RINGS], axis=0)
    assert np.sqrt(np.mean(off**2)) < 12 * UM


def even(level: NDArray[np.float32]) -> Lighting | None:
    """How a sheet without strokes is lit."""
    return Lighting.of(level, level)


def test_even_light_is_left_as_it_is() -> None:
    """A scanner's lamp that falls off by a tenth is none."""
    assert even(FLAT * np.linspace(0.9, 1, 200, dtype=np.float32)) is None


@pytest.mark.parametrize("soft_px", [1, 20, 100])
def test_the_light_follows_a_shadows_edge_hard_or_soft(soft_px: int) -> None:
    """Close enough where the edge is, too."""
    light = 1 - 0.4 * np.clip((np.arange(200) - 100) / soft_px + 0.5, 0, 1)
    level = FLAT * light.astype(np.float32)
    lighting = even(level)
    assert lighting is not None
    found = lighting.light(9.0)
    assert np.abs(found / light - 1).max() < AT_EDGE


def test_beneath_a_filled_shape_the_light_is_that_beside_it() -> None:
    """A black one, and one as dark as a pencil's lines; a shadow half as dark stays one."""
    level = FLAT.copy()
    level[30:60, 20:60] = 30
    level[30:60, 90:120] *= 0.55
    level[:, 150:] *= 0.8
    lighting = even(level)
    assert lighting is not None
    found = lighting.beneath_shapes(0.8 * 0.5, 4, 9.0).light(1.0)
    assert np.abs(found[:, :148] - 1).max() < AS_PAPER
    assert np.abs(found[:, 153:] - 0.8).max() < AS_PAPER


def test_a_grey_picture_on_white_paper_is_no_shape_if_lines_are_drawn_on_it() -> None:
    """As dark as the ink of the lines, and with a sharp edge."""
    level = FLAT.copy()
    level[30:90, 60:140] *= 0.55
    seen = level.copy()
    seen[58:60, 70:130] *= 0.6
    for shown, light in ((seen, 0.55), (level, 1.0)):
        lighting = Lighting.of(level, shown)
        assert lighting is not None
        found = lighting.beneath_shapes(0.8 * 0.5, 4, 9.0).light(1.0)
        assert np.abs(found[40:80, 70:130] - light).max() < AS_PAPER


def test_a_disc_of_pencil_under_a_lamp_stays_dark() -> None:
    """It is as dark as the ring of pencil beside it, though no darker than a shadow might be."""
    grey = np.full((472, 945), 235.0)
    cv2.circle(grey, (236, 236), 140, 110.0, -1, cv2.LINE_AA)
    cv2.circle(grey, (708, 236), 140, 110.0, 6, cv2.LINE_AA)
    grey *= np.linspace(1, 0.7, 945)
    shapes = levelled(np.asarray(np.round(grey), np.uint8), 25.4 / 300).shapes
    by = round(945 / shapes.shape[1])
    assert shapes[236 // by, 236 // by] and not shapes[236 // by, 708 // by]


def test_along_the_edge_of_grey_paper_no_line_is_left() -> None:
    """A pale line, half as wide as those that are drawn, made pens of these. (Fails without a pixel's own
    light beside a step.)
    """
    grey = np.full((472, 945), 240.0)
    cv2.rectangle(grey, (203, 101), (741, 370), 150.0, -1)
    cv2.line(grey, (240, 140), (700, 330), 20.0, 7, cv2.LINE_AA)
    darkness = levelled(np.asarray(np.round(grey), np.uint8), 25.4 / 300).darkness
    drawn = np.zeros(grey.shape, np.uint8)
    cv2.line(drawn, (240, 140), (700, 330), 1, 15)
    for corner in ((203, 101), (741, 101), (203, 370), (741, 370)):
        cv2.circle(drawn, corner, 36, 1, -1)  # 3 mm: a closing rounds them, and leaves specks
    assert np.abs(np.asarray(darkness)[drawn == 0]).max() < LEAST
    assert np.asarray(darkness)[235, 470] > 0.9
