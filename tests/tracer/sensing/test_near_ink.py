"""Cells on a large sheet with little ink: near it they see what they see of the whole sheet blurred."""

import cv2
import numpy as np

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.sensing.behind_spot import ABOUT_MM
from morfax.tracer.sensing.photocell import behind_aperture

PITCH_MM = 25.4 / 600
APERTURE_MM = 0.3


def test_near_the_line_nothing_differs_and_far_from_it_is_plain_paper() -> None:
    noise = np.random.default_rng(3).normal(0, 0.01, (2000, 2200))
    darkness = noise.astype(np.float32)
    cv2.line(darkness, (100, 150), (700, 400), 1.0, 12)
    drawing = Drawing(darkness, PITCH_MM)
    seen = behind_aperture(drawing, APERTURE_MM).darkness
    soft = cv2.GaussianBlur(darkness, (0, 0), APERTURE_MM / 4 / PITCH_MM)
    about_px = int(ABOUT_MM / PITCH_MM)
    near = cv2.dilate(
        (darkness > 0.5).view(np.uint8), np.ones((2 * about_px + 1,) * 2, np.uint8)
    )
    assert np.array_equal(seen[near > 0], soft[near > 0])
    assert (seen == 0).mean() > 0.5
    # six standard deviations of the noise behind the spot
    assert np.abs(soft[seen == 0]).max() < 0.06


def test_paper_far_from_ink_takes_no_memory_on_a_page_full_of_lines_either() -> None:
    """Two such sheets were a quarter of the memory that a page of gears took."""
    darkness = np.random.default_rng(3).normal(0, 0.01, (1500, 1500)).astype(np.float32)
    darkness[::50, :900] = darkness[:1200, 20] = 1.0
    seen = behind_aperture(Drawing(darkness, PITCH_MM), APERTURE_MM).darkness
    soft = cv2.GaussianBlur(darkness, (0, 0), APERTURE_MM / 4 / PITCH_MM)
    assert np.array_equal(seen[:, :900], soft[:, :900])
    assert 0.1 < (seen == 0).mean() < 0.4


def test_the_darkest_blocks_count_the_ink() -> None:
    darkness = np.zeros((500, 333), np.float32)
    cv2.circle(darkness, (160, 250), 120, 0.9, 5)
    assert Drawing(darkness, PITCH_MM).ink_px == np.count_nonzero(darkness > 0.5)


def test_a_sheet_with_ink_near_everywhere_is_seen_at_once() -> None:
    """Of a star of 1.1 Mpx tile by tile took twice the time; a corner without ink gets its noise then."""
    darkness = np.random.default_rng(4).normal(0, 0.05, (290, 500)).astype(np.float32)
    darkness[140:150, 20:480] = 1.0
    seen = behind_aperture(Drawing(darkness, 0.05), APERTURE_MM).darkness
    soft = cv2.GaussianBlur(darkness, (0, 0), APERTURE_MM / 4 / 0.05)
    assert np.array_equal(seen, soft)
    larger = np.zeros((2000, 2000), np.float32)
    larger[:290, :500] = darkness
    near = behind_aperture(Drawing(larger, 0.05), APERTURE_MM).darkness
    assert np.array_equal(near[:280, :490], soft[:280, :490])
