"""The noise of a drawing against drawings made with known noise, softness, grain and width."""

from __future__ import annotations

import math
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image
from scipy.special import erf

from morfax.tracer.drawing import profiles
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.noise import measured, within
from morfax.tracer.drawing.profiles import profiles_of, seen_across, seen_at
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from tests.tracer.inked import DPI, NOISE, SOFTNESS_MM, UM, WIDTH_MM, arc, inked, polyline

SAMPLE = Path(__file__).parents[3] / "samples" / "cam.png"
PITCH_MM = 0.1
SIDE_PX = 500
APART_PX = 40.0  # of paper between the lines
WAVE_PX = 60.0  # along the lines, of their grain

Darkness = NDArray[np.float32]


def ruled(width_px: float, softness_px: float, heading: float, grain: float = 0.0) -> Darkness:
    """A sheet of straight lines by the closed form of their edges; their darkness waves along them."""
    rows, columns = np.mgrid[:SIDE_PX, :SIDE_PX] - SIDE_PX / 2
    across = rows * math.cos(heading) + columns * math.sin(heading)
    along = columns * math.cos(heading) - rows * math.sin(heading)
    every = width_px + APART_PX
    u = (across + every / 2) % every - every / 2
    spot = math.sqrt(2) * softness_px
    ink = 0.5 * (erf((u + width_px / 2) / spot) - erf((u - width_px / 2) / spot))
    wave = grain * math.sqrt(2) * np.sin(along * math.tau / WAVE_PX)
    return np.asarray(ink * (1 + wave), np.float32)


def noisy(darkness: Darkness, paper: float, ink: float) -> Darkness:
    """The same with noise of these standard deviations on the pixels of paper and of ink."""
    noise = np.random.default_rng(1).normal(0, 1, darkness.shape)
    return np.asarray(darkness + noise * np.where(darkness > 0.5, ink, paper), np.float32)


@pytest.mark.parametrize("white", [235, 255])
@pytest.mark.parametrize("softness_px", [0.6, 0.8, 1.2])
def test_noise_of_paper_makes_lines_neither_softer_nor_wider(
    white: int, softness_px: float
) -> None:
    """Paper's level is that of its lighter pixels; noise of 6 levels lies 3 levels above it in the mean."""
    noise = np.random.default_rng(1).normal(0, 6, (SIDE_PX, SIDE_PX))
    levels = white - (white - 30) * ruled(4.7, softness_px, 0.3) + noise
    grey = np.clip(np.round(levels), 0, 255).astype(np.uint8)
    drawing = Drawing.of(Scan(Path("made.png"), grey, Stated((DPI, DPI))), Scale())
    assert drawing.noise.softness_px == pytest.approx(softness_px, rel=0.12)
    assert drawing.noise.width_mm / drawing.pitch_mm == pytest.approx(4.7, rel=0.02)


@settings(max_examples=25)
@given(
    softness_px=st.floats(0.7, 2.0),
    widths=st.floats(6.0, 12.0),
    heading=st.floats(-math.pi, math.pi),
    paper=st.floats(0.0, 0.06),
    ink=st.floats(0.0, 0.06),
)
def test_what_a_sheet_was_made_with_is_found_again(
    softness_px: float, widths: float, heading: float, paper: float, ink: float
) -> None:
    width_px = widths * softness_px
    found = measured(noisy(ruled(width_px, softness_px, heading), paper, ink), PITCH_MM)
    # a line along the pixels lies at one phase of them: what is between them is not averaged
    assert found.width_mm == pytest.approx(width_px * PITCH_MM, abs=0.2 * PITCH_MM)
    assert found.softness_px == pytest.approx(softness_px, abs=0.12)
    assert found.softness_mm == pytest.approx(found.softness_px * PITCH_MM)
    # the foot of a soft edge counts as paper, and the neighbour along the line lies a little aside
    assert found.paper == pytest.approx(paper, abs=0.02)
    assert found.ink == pytest.approx(ink, abs=0.02)
    assert (
        found.grain < 0.04
    )  # what interpolation leaves of noise of 0.06 in lines along the pixels


@pytest.mark.parametrize("grain", [0.05, 0.1, 0.2])
@pytest.mark.parametrize("heading", [0.0, 0.3, math.pi / 4])
def test_grain_is_told_from_noise(grain: float, heading: float) -> None:
    found = measured(noisy(ruled(8.0, 1.0, heading, grain), 0.03, 0.03), PITCH_MM)
    assert found.grain == pytest.approx(grain, rel=0.1)  # over some forty waves
    assert found.ink == pytest.approx(0.03, abs=0.012)  # the wave's slope adds to it


def test_the_drawings_of_the_tests_are_as_they_say() -> None:
    drawing = inked(
        polyline((4, 4), (40, 12)), arc((20, 25), 8), polyline((30, 20), (38, 36)), seed=1
    )
    noise = drawing.noise
    pixel_mm = drawing.pitch_mm / math.sqrt(12)
    assert noise.width_mm == pytest.approx(
        WIDTH_MM + 25 * UM, abs=10 * UM
    )  # the pen inks this wide
    assert noise.softness_mm == pytest.approx(math.hypot(SOFTNESS_MM, pixel_mm), rel=0.1)
    assert noise.paper == pytest.approx(NOISE, abs=0.003)
    assert noise.ink == pytest.approx(NOISE, abs=0.006)
    assert drawing.pitch_mm == pytest.approx(25.4 / DPI)


def test_paper_whose_white_is_clipped_has_its_noise_on_the_dark_side() -> None:
    darkness = noisy(ruled(8.0, 1.0, 0.3), 0.04, 0.04)
    assert measured(np.maximum(darkness, 0.0), PITCH_MM).paper == pytest.approx(0.04, abs=0.006)


def test_the_noise_of_paper_that_is_made_bare_is_known(tmp_path: Path) -> None:
    """Nine tenths of the sheet are bare."""
    grey = np.random.default_rng(4).normal(240, 2.0, (1500, 1500))
    grey[100:106, 100:300] -= 200
    Image.fromarray(grey.astype(np.uint8)).save(tmp_path / "sheet.png", dpi=(600, 600))
    drawing = Drawing.open(tmp_path / "sheet.png")
    assert np.mean(drawing.darkness == 0) > 0.9
    # a twentieth: the rounding to whole levels, and 65 000 pixels
    assert drawing.noise.paper == pytest.approx(2.0 / 200, rel=0.05)


def test_noise_is_measured_once() -> None:
    drawing = Drawing(ruled(8.0, 1.0, 0.3), PITCH_MM)
    assert drawing.noise is drawing.noise


@pytest.mark.parametrize("darkness", [0.0, 1.0])
def test_a_sheet_without_lines_has_paper_only(darkness: float) -> None:
    found = measured(np.full((200, 300), darkness, np.float32), PITCH_MM)
    assert (
        math.isnan(found.width_mm) and math.isnan(found.softness_px) and math.isnan(found.ink)
    )


@pytest.mark.parametrize("by", [1, 5])
def test_the_noise_of_an_opened_drawing_is_that_of_its_own_darkness(
    by: int, tmp_path: Path
) -> None:
    """As it was scanned; and so coarse, 60 dpi, that its pixels are made finer after they were measured."""
    with Image.open(SAMPLE) as image:
        image.reduce(by).save(tmp_path / "sheet.png", dpi=(300 / by, 300 / by))
    drawing = Drawing.open(tmp_path / "sheet.png")
    assert (drawing.finer > 1) == (by > 1)
    assert drawing.noise == measured(drawing.darkness, drawing.pitch_mm, drawing.paper_noise)


@pytest.mark.parametrize("lighter", [0.4, 0.6])
def test_ink_beside_what_is_lighter_than_paper_tells_no_width(lighter: float) -> None:
    """As beside filled shapes in colour; lines looked -25.7 pixels wide there, a note said."""
    rows = np.zeros((400, 600), np.float32)
    for k, row in enumerate(range(40, 380, 40)):
        rows[row - 14 : row + 15, 40:560] = -lighter * (k % 2)
        rows[row - 2 : row + 2, 40:560] = 1.0
    noise = np.random.default_rng(1).normal(0, 0.01, rows.shape)
    darkness = np.asarray(cv2.GaussianBlur(rows, (0, 0), 0.7) + noise, np.float32)
    assert within(darkness).seen_px == pytest.approx(4.0, abs=0.2)


def test_what_is_seen_across_lines_is_what_is_seen_at_each_place() -> None:
    """To the bit; only no array of all the places is made of others."""
    darkness = ruled(6.0, 0.8, 0.7)
    found = profiles_of(darkness)
    assert found is not None
    places = found.middles[:, :, None] + found.across[:, :, None] * found.at_px
    across = seen_across(darkness, found.middles, found.across, found.at_px)
    assert np.array_equal(across, seen_at(darkness, places))
    filled = np.empty((len(found.middles), len(found.at_px), 2))
    profiles._spread_out.py_func(found.middles, found.across, found.at_px, filled)
    assert np.array_equal(np.moveaxis(filled, 2, 1), places)
