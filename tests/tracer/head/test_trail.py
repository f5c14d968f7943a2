"""A copy of a trail shares the places so far, and goes on by itself."""

from __future__ import annotations

import copy
import math

import numpy as np
import pytest

from morfax.tracer.head.trail import BOXED, ROOM, Trail, come_near, place_back
from morfax.tracer.limits import NEAR, PIECE_MM

STEP_MM = 0.03


def along(first: int, last: int, up_mm: float = 0.0) -> np.ndarray:
    """Positions to the right, a step from each to the next."""
    x_mm = STEP_MM * np.arange(first, last)
    return np.column_stack([x_mm, np.full(len(x_mm), up_mm)])


def test_a_copy_shares_the_places_and_goes_on_by_itself() -> None:
    """Its own room is made where it goes on: the head is copied before each junction of metres of line."""
    first = Trail(np.zeros(2), STEP_MM)
    first.add(along(0, 3 * ROOM))
    before = first.places()
    other = copy.deepcopy(first)
    assert np.shares_memory(first.recent(), other.recent())
    first.add(along(3 * ROOM, 4 * ROOM))
    other.add(along(3 * ROOM, 9 * ROOM, up_mm=1.0))
    assert np.array_equal(other.places()[: len(before)], before)
    assert np.array_equal(first.places()[: len(before)], before)
    assert first.places()[-1][1] == 0.0 and other.places()[-1][1] == 1.0
    assert other._boxed == len(other.places()) // BOXED


def test_a_copy_of_a_copy_takes_no_more_than_its_places() -> None:
    """The head that goes on at a junction is a copy of a copy: when its boxes doubled each time they took
    8 GB after 25 junctions.
    """
    trail = Trail(np.zeros(2), STEP_MM)
    for k in range(40):
        trail = copy.deepcopy(trail)
        trail.add(along(100 * k, 100 * (k + 1)))
        assert len(trail.places()) // BOXED == trail._boxed <= len(trail._boxes)
        assert len(trail._boxes) <= 2 * trail._boxed
    sets = trail.places()[: trail._boxed * BOXED].reshape(-1, BOXED, 2)
    assert np.array_equal(trail._boxes[: trail._boxed, :2], sets.min(axis=1))
    assert np.array_equal(trail._boxes[: trail._boxed, 2:], sets.max(axis=1))


def test_the_kernel_notes_the_places_near_to_which_the_trail_came() -> None:
    """As numpy does, place by place, on a trail of many boxes that crosses itself; not its newest piece."""
    rng = np.random.default_rng(2)
    trail = Trail(np.zeros(2), STEP_MM)
    trail.add(np.cumsum(rng.normal(0, 0.02, (60_000, 2)), axis=0))
    ways, marks = trail.places(), trail.marks(0)
    before = ways[: len(ways) - round(PIECE_MM / STEP_MM)]
    for width_mm in (0.2, 0.6):
        for place in ways[rng.integers(0, len(ways), 30)]:
            leg = place + rng.uniform(-1, 1, (9, 2))
            near = np.zeros(len(leg), np.bool_)
            come_near(marks, leg, width_mm, near)
            away = np.hypot(*(before[:, None] - leg).transpose(2, 0, 1)).min(axis=0)
            assert np.array_equal(near, away < NEAR * width_mm)


@pytest.mark.parametrize(("ago", "middle_ago"), [(40, 38), (10, 8), (2, 2), (0, 2)])
def test_the_heading_of_a_place_on_the_trail_is_that_of_a_chord_of_four_places(
    ago: int, middle_ago: int
) -> None:
    """Round a circle of 1 mm a chord has the heading of the arc's middle, two places on; of the newest place
    it is that of the last four.
    """
    radius_mm = 1.0
    around = STEP_MM / radius_mm * 1.0001 * np.arange(120)
    trail = Trail(np.array([radius_mm, 0.0]), STEP_MM)
    trail.add(radius_mm * np.column_stack([np.cos(around), np.sin(around)])[1:])
    places = trail.places()
    x_mm, y_mm, heading = place_back(trail.marks(0), ago * STEP_MM)
    at = places[-1 - ago]
    assert (x_mm, y_mm) == pytest.approx(tuple(at))
    middle = places[-1 - middle_ago]
    tangent = math.atan2(middle[1], middle[0]) + math.pi / 2
    assert math.remainder(heading - tangent, math.tau) == pytest.approx(0.0, abs=1e-6)
