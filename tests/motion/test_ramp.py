"""The ramp counter: exact at rest whatever the move, and never beyond its acceleration and feed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.ramp import (
    CONSTANT,
    DOWN,
    UP,
    Profile,
    Ramp,
    _count,
    count_ramp,
    positions_mm,
)

MOVES = 100_000  # the figure asked for
ROUNDING = 1e-6  # of second differences of mm at 6 kHz, in mm/s²: 1e-14 mm · (6 kHz)² · 3


def pieces(profile: Profile) -> list[tuple[int, float]]:
    """(mode, increments) of each piece."""
    return [(int(mode), halves / 2) for mode, halves in profile.pieces]


def test_every_one_of_100_000_random_moves_is_exactly_at_rest() -> None:
    random = np.random.default_rng(1972)
    for _ in range(MOVES):
        increments, changes = int(random.integers(1, 2000)), int(random.integers(0, 4))
        speeds = random.integers(1, 400, changes + 1).tolist()
        profile = count_ramp(
            increments, speeds, np.sort(random.integers(0, increments + 1, changes)).tolist()
        )
        assert profile.at_rest() == (2 * increments, 0), (increments, speeds)


def test_a_long_move_goes_up_holds_and_comes_down() -> None:
    assert pieces(count_ramp(1000, [150])) == [(UP, 150), (CONSTANT, 700), (DOWN, 150)]


def test_after_a_change_to_a_lower_feed_the_move_holds_that_feed_exactly() -> None:
    profile = count_ramp(1000, [200, 50], [400])
    assert pieces(profile) == [
        (UP, 200),
        (CONSTANT, 200),
        (DOWN, 150),
        (CONSTANT, 400),
        (DOWN, 50),
    ]


def test_a_short_move_turns_from_up_to_down() -> None:
    assert pieces(count_ramp(300, [200])) == [(UP, 150), (DOWN, 150)]


def test_the_odd_increment_of_a_short_move_is_half_up_and_half_down() -> None:
    profile = count_ramp(301, [200])
    assert pieces(profile) == [(UP, 150.5), (DOWN, 150.5)]
    assert (profile.down_from, profile.count_then) == (
        151,
        1,
    )  # from -1 to +1: it is never zero


def test_one_increment_is_a_move() -> None:
    assert pieces(count_ramp(1, [200])) == [(UP, 0.5), (DOWN, 0.5)]


def test_a_change_of_speed_while_the_ramp_down_is_near_loses_nothing() -> None:
    for at in range(900, 1001):
        assert count_ramp(1000, [150, 400], [at]).at_rest() == (2000, 0)
        assert count_ramp(1000, [150, 3], [at]).at_rest() == (2000, 0)


@given(st.integers(0, 500), st.integers(0, 3000), st.integers(1, 700))
def test_a_new_demand_on_the_way_ends_exactly_too(
    moving: int, further: int, speed: int
) -> None:
    increments = moving + further  # at least what the braking takes
    assert count_ramp(increments, [speed], moving=moving).at_rest() == (2 * increments, 0)


def test_a_new_demand_too_near_to_stop_is_refused() -> None:
    with pytest.raises(
        ValueError,
        match="9 increments are too few to stop in from a speed that needs 10; give 10",
    ):
        count_ramp(9, [20], moving=10)


@pytest.mark.parametrize("speeds", [[0], [5, 5], []])
def test_speeds_that_do_not_fit_are_refused(speeds: list[int]) -> None:
    with pytest.raises(ValueError):
        count_ramp(10, speeds)


@given(
    st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), min_size=1, max_size=3),
    st.floats(0.1, 60),
    st.floats(0, 100),
    st.floats(0.1, 60),
)
def test_positions_end_exactly_within_feed_and_acceleration(
    axes: list[tuple[float, float]], feed_mm_s: float, at_mm: float, later_mm_s: float
) -> None:
    start, end = np.array(axes).T
    way = positions_mm(start, end, feed_mm_s, changes=[(at_mm, later_mm_s)])
    assert (way[0] == start).all() and (way[-1] == end).all()
    speed = np.linalg.norm(np.diff(way, axis=0), axis=1) * MOTION_RATE_HZ
    assert speed.max(initial=0) <= max(feed_mm_s, later_mm_s, 1.1) * (
        1 + 1e-6
    )  # 1 mm/s: a ramp of one increment
    around = np.vstack([start, way, end])  # standing before and after
    push = np.linalg.norm(np.diff(around, 2, axis=0), axis=1) * MOTION_RATE_HZ**2
    assert push.max() <= Ramp().acceleration_mm_s2 + 50 * ROUNDING


def test_axes_keep_the_ratio_of_their_distances_all_along() -> None:
    way = positions_mm([0, 0, 0], [6, 2, -1], 20.0)
    assert np.abs(way[:, 0] - 3 * way[:, 1]).max() < 1e-12
    assert np.abs(way[:, 0] + 6 * way[:, 2]).max() < 1e-12


def test_feed_and_time_are_those_of_the_trapezium() -> None:
    way = positions_mm([0], [30], 10.0, Ramp(acceleration_mm_s2=500))
    assert np.diff(way[:, 0]).max() * MOTION_RATE_HZ == pytest.approx(10, abs=1e-6)
    assert (len(way) - 1) / MOTION_RATE_HZ == pytest.approx(
        30 / 10 + 10 / 500, abs=1 / MOTION_RATE_HZ
    )


def test_the_feed_is_reached_exactly_though_its_ramp_is_no_whole_number_of_increments() -> None:
    way = positions_mm([0, 0], [20, 7], 7.77, Ramp(acceleration_mm_s2=333))
    assert np.linalg.norm(np.diff(way, axis=0), axis=1).max() * MOTION_RATE_HZ == pytest.approx(
        7.77, rel=1e-6
    )


def test_a_move_of_nothing_is_one_row_and_one_below_an_increment_still_arrives() -> None:
    assert positions_mm([1, 2], [1, 2], 10.0).tolist() == [[1, 2]]
    assert positions_mm([0.0], [0.0002], 10.0)[-1] == 0.0002


@pytest.mark.parametrize("feed_mm_s", [0.0, -1.0, float("inf"), float("nan")])
def test_a_feed_that_never_arrives_is_refused(feed_mm_s: float) -> None:
    with pytest.raises(ValueError, match=r"feed of .* never arrives; give one above zero"):
        positions_mm([0], [1], feed_mm_s)


def test_places_that_are_none_are_refused() -> None:
    with pytest.raises(ValueError, match="finite mm"):
        positions_mm([0], [float("nan")], 1.0)
    with pytest.raises(ValueError, match="acceleration of 0 moves nothing"):
        Ramp(acceleration_mm_s2=0)


def test_the_compiled_counter_is_the_plain_one() -> None:
    for increments, speeds, at in [
        (1001, [90, 200, 3], [300, 600]),
        (7, [2], []),
        (11, [90], []),
    ]:
        plain = np.empty((40, 2), np.int64)
        arrays = np.array(at, np.int64), np.array(speeds, np.int64)
        rows, down_from, count = _count.py_func(increments, 0, *arrays, plain)
        profile = count_ramp(increments, speeds, at)
        assert profile.pieces.tolist() == plain[:rows].tolist()
        assert (profile.down_from, profile.count_then) == (down_from, count)
