"""Polarity: the paper is what is even without its strokes, whatever share of the sheet they take."""

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.tracer.drawing.inks import parsed
from morfax.tracer.drawing.paper import Paper
from morfax.tracer.drawing.polarity import HARDLY_DARK, LIGHT_LINES

PITCH_MM = 0.15
PX = 700


def bold(wide_mm: float, seed: int) -> np.ndarray:
    """Five outlines, 1 where they are, that cross."""
    ink, rng = np.zeros((PX, PX), np.uint8), np.random.default_rng(seed)
    for _ in range(5):
        centre = tuple(rng.integers(200, 500, 2).tolist())
        cv2.circle(ink, centre, int(rng.integers(80, 200)), 255, round(wide_mm / PITCH_MM))
    return cv2.GaussianBlur(ink, (0, 0), 1) / 255.0


def on_paper(ink: np.ndarray, paper: float, stroke: float) -> np.ndarray:
    return paper + (stroke - paper) * ink + np.random.default_rng(1).normal(0, 2, ink.shape)


def on_desk(sheet: np.ndarray, desk: float) -> np.ndarray:
    """A sheet that takes two fifths of its photograph."""
    small = cv2.resize(sheet, None, fx=0.65, fy=0.65, interpolation=cv2.INTER_AREA)
    seen = desk + np.random.default_rng(2).normal(0, 4, (PX, PX))
    seen[100 : 100 + len(small), 120 : 120 + len(small)] = small
    return seen


def seen(levels: np.ndarray) -> np.ndarray:
    return np.clip(levels, 0, 255).astype(np.uint8)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("wide_mm", [0.6, 3.0, 5.0])
def test_bold_lines_on_dark_paper_are_the_light_ones(wide_mm: float, seed: int) -> None:
    ink = bold(wide_mm, seed)
    assert not Paper.of(seen(on_paper(ink, 60, 220)), PITCH_MM).is_light
    assert Paper.of(seen(on_paper(ink, 220, 60)), PITCH_MM).is_light


@pytest.mark.parametrize("desk", [50, 200])
@pytest.mark.parametrize("wide_mm", [0.6, 3.0])
def test_a_desk_of_any_tone_about_a_sheet_decides_nothing(wide_mm: float, desk: float) -> None:
    ink = bold(wide_mm, 3)
    assert Paper.of(seen(on_desk(on_paper(ink, 225, 50), desk)), PITCH_MM).is_light
    assert not Paper.of(seen(on_desk(on_paper(ink, 50, 225), desk)), PITCH_MM).is_light


def test_hatching_is_no_paper() -> None:
    """Strokes take more than half of what is about them; only the sheet's margin tells."""
    ink = np.zeros((PX, PX))
    ink[150:550, 150:550] = (np.arange(400) % 14 < 8)[:, None]
    assert Paper.of(seen(on_paper(ink, 225, 50)), PITCH_MM).is_light
    assert not Paper.of(seen(on_paper(ink, 50, 225)), PITCH_MM).is_light


def test_a_picture_that_leaves_it_in_doubt_is_told_and_the_tone_may_be_named(tmp_path) -> None:
    """Stripes as broad as the paper between them are both; 60 mm of each."""
    stripes = np.zeros((PX, PX))
    stripes[:, :] = np.arange(PX) // 20 % 2
    file = tmp_path / "stripes.png"
    Image.fromarray(seen(on_paper(stripes, 200, 60))).save(file)
    asked = {
        ink: DrawingFile(file, width_mm=PX * PITCH_MM, ink=ink).open()
        for ink in (None, "dark", "light")
    }
    told = {HARDLY_DARK, LIGHT_LINES}
    assert told & set(asked[None].notes)
    assert not told & {*asked["dark"].notes, *asked["light"].notes}
    dark, light = (np.asarray(asked[ink].darkness) for ink in ("dark", "light"))
    middle = 350, 30  # of a dark stripe
    assert dark[middle] > 0.8 and light[middle] < 0.2


def test_shapes_of_a_light_tone_have_the_same_edges(tmp_path) -> None:
    shape = np.zeros((PX, PX))
    cv2.circle(shape, (350, 350), 200, 1.0, -1)
    for name, (paper, ink) in {"dark": (220, 50), "light": (35, 205)}.items():
        Image.fromarray(seen(on_paper(shape, paper, ink))).save(tmp_path / f"{name}.png")
    edges = [
        DrawingFile(tmp_path / f"{ink}.png", width_mm=PX * PITCH_MM, ink=ink, edge=True).open()
        for ink in ("dark", "light")
    ]
    dark, light = (drawing.edges_mm[0] for drawing in edges)
    assert np.abs(dark.mean(axis=0) - light.mean(axis=0)).max() < 0.1 * PITCH_MM


def test_a_tone_is_an_ink_and_a_bad_name_says_so() -> None:
    assert parsed(" Light ") == "light" and parsed("blue") == (0, 0, 255)
    with pytest.raises(ValueError, match="or dark or light"):
        parsed("glittering")
