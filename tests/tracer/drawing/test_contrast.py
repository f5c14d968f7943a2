"""Contrast: made where it is asked for, it is the picture held against OpenCV's interpolated paper."""

import cv2
import numpy as np
import pytest

from morfax.tracer.drawing.contrast import BARE_FROM_MM, FAINT, Contrast
from morfax.tracer.drawing.paper import Paper

PITCH_MM = 25.4 / 600  # the paper is reduced by 8


def page(is_light: bool) -> np.ndarray:
    """A page lit from one side, with a line and some noise."""
    rows, columns = 405, 610
    grey = np.linspace(200, 240, columns) * np.ones((rows, 1))
    cv2.line(grey, (50, 50), (500, 350), 40.0, 12)
    grey += np.random.default_rng(2).normal(0, 1, grey.shape)
    return (grey if is_light else 255 - grey).astype(np.uint8)


@pytest.mark.parametrize("is_light", [True, False])
def test_contrast_is_that_against_the_interpolated_paper(is_light: bool) -> None:
    grey = page(is_light)
    contrast = Contrast.of(grey, PITCH_MM)
    assert contrast.paper.is_light == is_light
    paper = contrast.paper.rows(0, len(grey))
    expected = paper - grey if is_light else grey - paper
    # where OpenCV was built without fused products it rounds once more: a bit of 255
    assert np.abs(contrast.everywhere() - expected).max() <= 2**-15
    assert np.array_equal(contrast.pixels(3), contrast.everywhere()[::3, ::3])


@pytest.mark.parametrize("wide_mm", [0.5, 2.0, 4.0, 5.0, 8.0])
def test_a_bold_outline_is_dark_on_light(wide_mm: float) -> None:
    """Of a fetched icon the paper between its outlines was followed, as light lines on a dark sheet."""
    grey, pitch_mm = np.full((1000, 1000), 255, np.uint8), 0.1
    cv2.rectangle(grey, (150, 150), (850, 850), 0, round(wide_mm / pitch_mm))
    assert Paper.of(grey, pitch_mm).is_light
    if wide_mm < 5.0:
        assert not Paper.of(255 - grey, pitch_mm).is_light


def test_paper_far_from_anything_dark_is_bare_and_all_else_is_the_contrast() -> None:
    """Ink of a contrast is 1; a smudge of an eighth of that is no bare paper."""
    grey = np.pad(page(True), ((0, 600), (0, 700)), mode="reflect")[:1000, :1300]
    grey[300:, 650:] = 230
    grey[800:804, 900:904] = 210
    contrast = Contrast.of(grey, PITCH_MM)
    darkness, whole = contrast.darkness(160.0), contrast.everywhere() / np.float32(160)
    kept = darkness != 0
    assert np.array_equal(darkness[kept], whole[kept])
    assert 0.1 < np.mean(~kept) < 0.9
    about_px = int(BARE_FROM_MM / PITCH_MM)
    near = cv2.dilate(
        (whole > FAINT).view(np.uint8), np.ones((2 * about_px + 1,) * 2, np.uint8)
    )
    assert near[802, 902] and not near[999, 1299]
    assert np.array_equal(darkness[near > 0], whole[near > 0])


def test_the_contrast_of_a_whole_sheet_becomes_its_darkness_in_its_place() -> None:
    grey = np.pad(page(True), ((0, 600), (0, 700)), mode="reflect")[:1000, :1300]
    grey[300:, 650:] = 230
    contrast = Contrast.of(grey, PITCH_MM)
    whole, expected = contrast.everywhere(), contrast.darkness(160.0)
    assert 0.1 < np.mean(expected == 0) < 0.9
    assert contrast.in_parts_of(160.0, whole) is whole
    assert np.array_equal(whole, expected)


def test_blocks_that_are_left_out_are_nowhere_above_the_level() -> None:
    contrast = Contrast.of(page(True), PITCH_MM)
    dark = contrast.above(10.0)
    assert 0 < dark.mean() < 0.7
    soft = cv2.GaussianBlur(contrast.everywhere(), (0, 0), 1.0)
    pixels = np.kron(dark, np.ones((8, 8), np.uint8))[: soft.shape[0], : soft.shape[1]]
    assert soft[pixels == 0].max() <= 10.0
    within = contrast.within(dark)
    assert np.array_equal(within[pixels == 1], contrast.everywhere()[pixels == 1])


def test_a_sample_is_as_noisy_as_the_whole_page() -> None:
    contrast = Contrast.of(page(True), PITCH_MM)
    soft = cv2.GaussianBlur(contrast.everywhere(), (0, 0), 1.0)
    # quartiles: 12 rows of 153 pixels, and the noise of a spot is 0.28 levels
    whole, some = (np.percentile(seen, [25, 75]) for seen in (soft, contrast.sample(1.0)))
    assert np.abs(whole - some).max() < 0.1
