"""Directions in the plane, against right angles and turns."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.plane import cross, direction, heading_of, left_of, meeting, unit

HEADINGS = st.floats(-3.14, 3.14)
LENGTHS = st.floats(0.01, 100.0)


def test_left_of_x_is_y_and_left_of_y_is_back() -> None:
    assert left_of(np.array([2.0, 0.0])).tolist() == [0.0, 2.0]
    assert left_of(np.array([0.0, 3.0])).tolist() == [-3.0, 0.0]
    assert left_of(np.array([[2.0, 0.0], [0.0, 3.0]])).tolist() == [[0.0, 2.0], [-3.0, 0.0]]
    assert direction(math.pi / 2) == pytest.approx([0.0, 1.0])


@given(HEADINGS, LENGTHS)
def test_a_direction_has_the_heading_that_it_was_made_of(heading: float, length: float) -> None:
    way = length * direction(heading)
    assert math.hypot(*way) == pytest.approx(length)
    assert heading_of(way) == pytest.approx(heading)
    assert math.remainder(heading_of(left_of(way)) - heading, math.tau) == pytest.approx(
        math.pi / 2
    )


@given(HEADINGS, st.floats(-1.5, 1.5), LENGTHS, LENGTHS)
def test_the_area_between_two_directions_is_that_of_their_lengths_and_turn(
    heading: float, turn: float, one: float, other: float
) -> None:
    area = cross(one * direction(heading), other * direction(heading + turn))
    assert area == pytest.approx(one * other * math.sin(turn), abs=1e-9)


@given(HEADINGS, st.floats(0.1, 3.0), st.floats(-50, 50), st.floats(-50, 50))
def test_lines_meet_where_both_come_by(
    heading: float, turn: float, along: float, its: float
) -> None:
    met, way, its_way = np.array([3.0, -4.0]), direction(heading), 2 * direction(heading + turn)
    found = meeting(met - along * way, way, met + its * its_way, its_way)
    assert found == pytest.approx(met, abs=1e-9)


def test_directions_of_length_1_and_one_of_none_stays() -> None:
    assert unit(np.array([3.0, -4.0])) == pytest.approx([0.6, -0.8])
    assert unit(np.array([[0.0, 0.0], [0.0, 2e-6]])).tolist() == [[0.0, 0.0], [0.0, 1.0]]
