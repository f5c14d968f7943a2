"""The way between two places and headings: an arc where these are an arc's."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.curves import bow, hermite
from morfax.motion.plane import direction

RADIUS_MM = 10.0
UM = 1e-3
OFF_MM = 3 * UM  # of a radius of 10 mm over a quarter turn, a fifth of what a scan tells


@pytest.mark.parametrize("turn_deg", [-90, -22, 5, 60, 90])
def test_a_bow_between_two_places_of_a_circle_is_its_arc(turn_deg: float) -> None:
    """The cubic whose slopes are as long as the chord was 0.43 mm within it over a quarter turn."""
    half, side = math.radians(turn_deg) / 2, math.copysign(1.0, turn_deg)
    middle = np.array([30.0, 40.0])
    ends = [middle - side * RADIUS_MM * direction(half * at + math.pi / 2) for at in (-1, 1)]
    way = bow(ends[0], -half, ends[1], half)
    assert np.abs(np.hypot(*(way - middle).T) - RADIUS_MM).max() < OFF_MM
    assert np.abs(way[[0, -1]] - ends).max() < 1e-9


def test_a_bow_straight_on_is_the_cubic_with_slopes_as_long_as_the_chord() -> None:
    pose = np.array([1.0, 2.0]), 0.0, np.array([9.0, 2.0]), 0.0
    assert np.abs(bow(*pose) - hermite(*pose)).max() < 1e-9
