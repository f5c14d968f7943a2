"""Offsets against closed forms and shapely's buffer; the path run at a feed within its acceleration."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.contour import distance
from morfax.motion.offset import DriveCurve, offset
from tests.motion.polygons import SQUARE, UM, circle, polygon


@pytest.mark.parametrize(("left", "radius_mm"), [(True, 7.0), (False, 13.0)])
def test_a_circle_becomes_the_circle_that_is_smaller_or_larger_by_the_radius(
    left: bool, radius_mm: float
) -> None:
    (way,) = offset([DriveCurve(circle(10), True, left)], 3)
    assert way.closed and np.abs(np.hypot(*way.points_mm.T) - radius_mm).max() < 0.1 * UM
    start = way.points_mm[0]
    assert start == pytest.approx([radius_mm, 0], abs=0.1 * UM)  # beside where the head began


def test_a_cutter_as_wide_as_a_hole_goes_nowhere() -> None:
    assert offset([DriveCurve(circle(10), True, True)], 10.01) == []


def test_round_a_square_the_corners_are_rolled_round_and_inside_they_stay_sharp() -> None:
    (outside,) = offset([DriveCurve(SQUARE, True, False)], 3)
    length_mm = np.hypot(*np.diff(outside.points_mm, axis=0).T).sum()
    assert length_mm == pytest.approx(80 + math.tau * 3, abs=2 * UM)
    (inside,) = offset([DriveCurve(SQUARE, True, True)], 3)
    assert (
        distance(inside.points_mm, polygon((3, 3), (17, 3), (17, 17), (3, 17))).hausdorff_mm
        < 0.1 * UM
    )


def test_two_rooms_joined_by_a_passage_too_narrow_are_two_ways() -> None:
    rooms = polygon(
        (0, 0),
        (10, 0),
        (10, 4),
        (20, 4),
        (20, 0),
        (30, 0),
        (30, 10),
        (20, 10),
        (20, 6),
        (10, 6),
        (10, 10),
        (0, 10),
    )
    assert [way.closed for way in offset([DriveCurve(rooms, True, True)], 0.9)] == [True]
    assert [way.closed for way in offset([DriveCurve(rooms, True, True)], 1.1)] == [True, True]
