"""Numbering: the same order of lines however large, fine or turned a sheet is scanned."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from morfax.tracer.drawing.numbering import InkSpread, longest_first

Points = NDArray[np.float64]


def turned(places: Points, angle_rad: float, size: float) -> Points:
    """Places turned about the sheet's corner and made larger."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    return size * places @ np.array([[c, s], [-s, c]])


def test_the_order_is_the_same_at_any_angle_and_size() -> None:
    """Lengths in steps of 5 %, so that many are equal, measured half a percent off; 98 of 100 is asked."""
    same = 0
    for seed in range(200):
        rng = np.random.default_rng(seed)
        lengths, middles = 20 * 1.05 ** rng.integers(0, 4, 8), rng.uniform(0, 100, (8, 2))
        first = longest_first(lengths, middles, InkSpread.of(middles, lengths))
        angle_rad, size = rng.uniform(0, 2 * math.pi), rng.uniform(0.3, 3.0)
        measured = size * lengths * rng.uniform(0.995, 1.005, 8)
        there = turned(middles, angle_rad, size)
        same += list(first) == list(
            longest_first(measured, there, InkSpread.of(there, lengths))
        )
    assert same >= 196


def test_equal_lines_go_by_their_place_and_not_by_the_rows_of_the_picture() -> None:
    middles = np.array([[10.0, 10.0], [30.0, 12.0], [55.0, 40.0], [20.0, 44.0]])
    lengths = np.full(4, 19.0)
    order = longest_first(lengths, middles, InkSpread.of(middles, lengths))
    upside_down = 100 - middles
    again = longest_first(lengths, upside_down, InkSpread.of(upside_down, lengths))
    assert list(order) == list(again)


def test_a_longer_line_comes_first_however_far_away() -> None:
    middles = np.array([[50.0, 50.0], [90.0, 90.0], [48.0, 50.0]])
    order = longest_first(
        np.array([30.0, 31.0, 29.0]), middles, InkSpread.of(middles, np.ones(3))
    )
    assert list(order) == [1, 0, 2]


def test_the_middle_and_reach_of_ink_are_those_of_its_places() -> None:
    ink = InkSpread.of(np.array([[0.0, 0.0], [10.0, 0.0]]), np.array([1.0, 1.0]))
    assert ink.middle_mm == pytest.approx((5.0, 0.0))
    assert ink.reach_mm == pytest.approx(5.0)
