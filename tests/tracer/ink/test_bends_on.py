"""Two legs bend on as one way where an arc leads from the one to the other, and no straight one does."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.tracer.ink.partners import _bends_on
from morfax.tracer.ink.struck_off import _directions
from morfax.tracer.sensing.leg import Leg
from tests.tracer.inked import WIDTH_MM

RADIUS_MM = 5.0


def on_circle(at_deg: float, bend_per_mm: float, *, ahead: bool) -> Leg:
    """The leg that ends at an angle of a circle, coming on round it or against that."""
    at = math.radians(at_deg)
    place = RADIUS_MM * np.array([math.cos(at), math.sin(at)])
    heading, turns = (at + math.pi / 2, 1) if ahead else (at - math.pi / 2, -1)
    return Leg(place, heading, turns * bend_per_mm, WIDTH_MM, np.empty((0, 3)))


@pytest.mark.parametrize("round_deg", [30.0, 60.0, 90.0])
def test_legs_of_a_circle_bend_on_round_it(round_deg: float) -> None:
    """As felt, and not if their bends were twice as strong, or none."""
    for times, does in ((1.0, True), (0.0, False), (2.6, False)):
        bend = times / RADIUS_MM
        one = on_circle(0.0, bend, ahead=True)
        out = on_circle(round_deg, bend, ahead=False).turned_round()
        assert _bends_on(one, out) is does


def test_each_direction_along_a_way_is_of_length_one_and_that_of_a_single_place_too() -> None:
    for count in (1, 2, 5):
        way = np.column_stack([np.arange(count) * 0.7, np.arange(count) * 0.2])
        assert np.hypot(*_directions(way).T) == pytest.approx(np.ones(count))
