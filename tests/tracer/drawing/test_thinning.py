"""Thinned ink: one pixel wide, in as many pieces as the ink, with its rings and its ends."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from scipy.ndimage import label

from morfax.tracer.drawing import thinning
from morfax.tracer.drawing.thinning import neighbours, thinned

SIZE = 80
EVERYWHERE = np.ones((3, 3), int)


def painted(*lines: tuple[tuple[int, int], tuple[int, int]], width_px: int = 7) -> np.ndarray:
    ink = np.zeros((SIZE, SIZE), np.uint8)
    for one, other in lines:
        cv2.line(ink, one, other, 1, width_px)
    return ink


def again(ink: np.ndarray) -> np.ndarray:
    """The thinned ink as a picture."""
    left = np.zeros_like(ink)
    left[thinned(ink)] = 1
    return left


CROSS = painted(((10, 40), (70, 40)), ((40, 10), (40, 70)))
SLOPE = painted(((8, 12), (70, 61)), width_px=9)


def test_a_cross_has_four_ends_and_its_forks_in_the_middle() -> None:
    rows, columns = thinned(CROSS)
    links = np.sum(neighbours(rows, columns) >= 0, axis=1)
    assert np.sum(links == 1) == 4
    forks = np.column_stack([rows, columns])[links > 2]
    assert len(forks) and np.abs(forks - 40).max() <= 3


def test_a_sloping_line_is_thin_and_goes_from_end_to_end() -> None:
    rows, columns = thinned(SLOPE)
    links = np.sum(neighbours(rows, columns) >= 0, axis=1)
    assert sorted(set(links.tolist())) == [1, 2] and np.sum(links == 1) == 2
    assert np.ptp(columns) > 62 - 9 and SLOPE[rows, columns].all()


def test_pieces_and_holes_stay() -> None:
    ink = painted(((8, 70), (70, 74)))
    cv2.circle(ink, (40, 30), 20, 1, 6)
    left = again(ink)
    assert label(left, EVERYWHERE)[1] == label(ink, EVERYWHERE)[1] == 2
    # a ring leaves the paper inside it apart
    assert label(left == 0)[1] == label(ink == 0)[1] == 2


@pytest.mark.parametrize("ink", [CROSS, SLOPE])
def test_the_plain_kernel_says_the_same(
    ink: np.ndarray, monkeypatch: pytest.MonkeyPatch
) -> None:
    compiled = again(ink)
    kernels = {name for name, item in vars(thinning).items() if hasattr(item, "py_func")}
    assert "_thin" in kernels
    for name in kernels:
        monkeypatch.setattr(thinning, name, getattr(thinning, name).py_func)
    assert np.array_equal(again(ink), compiled)


def test_ink_at_the_rim_of_the_sheet_and_none_at_all() -> None:
    assert len(thinned(np.zeros((5, 5), np.uint8))[0]) == 0
    rows, columns = thinned(painted(((0, 40), (79, 40))))
    assert set(rows.tolist()) <= {39, 40, 41} and columns.min() < 6 and columns.max() > 73
