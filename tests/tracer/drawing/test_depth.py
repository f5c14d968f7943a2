"""Depth of ink: the same to the bit as OpenCV's exact distance, on sheets of lines as well."""

from __future__ import annotations

import tracemalloc

import cv2
import numpy as np
import pytest

from morfax.tracer.drawing.components import runs_of
from morfax.tracer.drawing.depth import (
    MOST_LOOKS_EACH,
    _along_runs,
    depth_along,
    depth_at,
    depth_of,
    depth_px,
)


@pytest.mark.parametrize("width_px", [1, 3, 9])
def test_lines_on_much_paper_are_as_deep_as_the_whole_sheet_says(width_px: int) -> None:
    ink = np.zeros((301, 400), np.uint8)
    cv2.ellipse(ink, (200, 150), (150, 90), 20, 0, 300, 1, width_px)
    cv2.line(ink, (0, 10), (399, 0), 1, width_px)  # over three borders of the sheet
    ink[250:, 5] = 1
    exact = cv2.distanceTransform(ink, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    assert np.array_equal(depth_px(ink), exact)


def test_paper_takes_no_memory() -> None:
    """The runs of a page were found on three copies of it, where its memory was the most."""
    ink = np.zeros((2000, 1500), np.uint8)
    ink[::100] = 1
    depth_of(ink)  # its kernels
    tracemalloc.start()
    depth_of(ink)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 0.5 * ink.size


def test_a_filled_shape_is_deep_and_paper_is_not() -> None:
    ink = np.zeros((40, 40), np.uint8)
    assert not depth_px(ink).any()
    ink[10:31, 10:31] = 1
    depth = depth_px(ink)
    assert depth[20, 20] == 11  # pixels from the middle of 21 to the first of paper
    assert depth[9, 20] == 0


def test_one_broad_shape_on_much_paper_is_left_to_opencv_soon() -> None:
    """Looking along the rows of a square is work by its side's third power: 38 s on a sheet of 49 Mpx."""
    ink = np.zeros((2000, 2000), np.uint8)
    for left, is_whole in ((300, False), (890, True)):  # a square, and a line of ten pixels
        ink[:] = 0
        ink[300:900, left:900] = 1
        most = MOST_LOOKS_EACH * int(ink.sum())
        assert _along_runs(*runs_of(ink, 0), ink.shape, most)[1] == is_whole
        exact = cv2.distanceTransform(ink, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
        assert np.array_equal(depth_px(ink), exact)


def test_some_pixels_of_ink_are_as_deep_as_the_whole_sheet_says() -> None:
    ink = np.zeros((200, 300), np.uint8)
    cv2.ellipse(ink, (150, 100), (100, 60), 20, 0, 300, 1, 9)
    cv2.line(ink, (0, 0), (299, 150), 1, 5)
    exact = cv2.distanceTransform(ink, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    rows, columns = np.nonzero(ink)
    some = np.random.default_rng(1).permutation(len(rows))[:500]
    depth = depth_at(ink, rows[some], columns[some])
    assert np.array_equal(depth, exact[rows[some], columns[some]])


@pytest.mark.parametrize("broad", [False, True])
def test_along_runs_it_is_the_same_as_on_the_sheet(broad: bool) -> None:
    """Lines, some of them along the edges of the sheet; and a shape that is too broad for looking."""
    ink = np.zeros((400, 500), np.uint8)
    for line in ((0, 20, 499, 380), (30, 0, 30, 399), (0, 0, 200, 0), (499, 100, 499, 300)):
        cv2.line(ink, line[:2], line[2:], 1, 9)
    if broad:
        cv2.circle(ink, (300, 200), 180, 1, -1)
    exact = cv2.distanceTransform(ink, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    assert np.array_equal(depth_along(*runs_of(ink, 0), ink.shape), exact[ink > 0])
