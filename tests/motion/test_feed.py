"""A way run at a feed: from rest to rest, stopping at corners, within the acceleration everywhere."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.feed import ACROSS, SMOOTHED_S, STANDS_S, run_along
from morfax.motion.polyline import nearest_mm, with_places
from morfax.motion.segments import SHARE

RATE_HZ = 6000.0
FEED_MM_S, MOST_MM_S2 = 20.0, 500.0


def speeds_of(positions: Array) -> Array:
    """mm/s."""
    return np.hypot(*np.diff(positions, axis=0).T) * RATE_HZ


def circle(radius_mm: float, rad: float = 2 * math.pi) -> Array:
    angle = np.linspace(0, rad, 2000)
    return radius_mm * np.column_stack([np.cos(angle), np.sin(angle)])


def test_a_straight_way_takes_as_long_as_its_feed_and_its_ramps() -> None:
    way = with_places(np.array([[0.0, 0.0], [20.0, 0.0]]), 0.02)
    positions = run_along(way, FEED_MM_S, MOST_MM_S2, RATE_HZ)
    assert positions[0].tolist() == [0, 0] and positions[-1].tolist() == [20, 0]
    assert speeds_of(positions).max() == pytest.approx(FEED_MM_S, rel=1e-6)
    ramp_s = FEED_MM_S / (SHARE * MOST_MM_S2)
    told_s = 20 / FEED_MM_S + ramp_s + 2 * STANDS_S
    assert len(positions) / RATE_HZ == pytest.approx(told_s, abs=2e-3)


@pytest.mark.parametrize("radius_mm", [0.3, 1.0, 5.0])
def test_in_a_bend_a_third_of_the_acceleration_is_across(radius_mm: float) -> None:
    """v² / R = a/3, or the feed."""
    positions = run_along(circle(radius_mm), 40.0, MOST_MM_S2, RATE_HZ)
    most = min(40.0, math.sqrt(ACROSS * MOST_MM_S2 * radius_mm))
    middle = speeds_of(positions)[len(positions) // 3 : len(positions) // 2]
    # the bend is that of whole pieces within 0.1 mm, one of 0.016 mm too many at the most
    assert 0.92 * most < middle.min() and middle.max() < 1.001 * most
    assert np.hypot(*positions.T) == pytest.approx(radius_mm, abs=2e-4)


@pytest.mark.parametrize(
    ("turn_deg", "stops"), [(9.0, False), (11.0, True), (90.0, True), (180.0, True)]
)
def test_at_a_turn_of_ten_degrees_the_tool_stops(turn_deg: float, stops: bool) -> None:
    a = math.radians(turn_deg)
    way = with_places(
        np.array([[0, 0], [5, 0], [5 + 5 * math.cos(a), 5 * math.sin(a)]], float), 0.02
    )
    positions = run_along(way, FEED_MM_S, MOST_MM_S2, RATE_HZ)
    near = np.hypot(*(positions - [5, 0]).T).argmin()
    slowest = speeds_of(positions)[near - 20 : near + 20].min()
    assert (slowest < 1.0) == stops
    assert nearest_mm(np.array([[5.0, 0.0]]), positions)[0] < 2e-3


@pytest.mark.parametrize("seed", range(4))
def test_nothing_is_asked_for_more_than_the_acceleration(seed: int) -> None:
    """Over a way of straight pieces, arcs and a corner, by the mean over what is smoothed."""
    chance = np.random.default_rng(seed)
    turns = np.cumsum(np.repeat(chance.uniform(-0.02, 0.02, 20), 50)) + np.repeat(
        [0.0, 1.5], 500
    )
    way = np.cumsum(0.02 * np.column_stack([np.cos(turns), np.sin(turns)]), axis=0)
    positions = run_along(way, FEED_MM_S, MOST_MM_S2, RATE_HZ)
    window = round(SMOOTHED_S * RATE_HZ)
    velocity = (positions[window:] - positions[:-window]) * RATE_HZ / window
    asked = np.hypot(*(velocity[window:] - velocity[:-window]).T) * RATE_HZ / window
    assert asked.max() < MOST_MM_S2
    assert nearest_mm(way, positions).max() < 0.02
    assert nearest_mm(positions, with_places(way, 1e-3)).max() < 2e-3


def test_places_that_repeat_make_no_stop() -> None:
    way = with_places(np.array([[0.0, 0.0], [10.0, 0.0]]), 0.02)
    twice = np.repeat(way, 2, axis=0)
    plain = run_along(way, FEED_MM_S, MOST_MM_S2, RATE_HZ)
    assert run_along(twice, FEED_MM_S, MOST_MM_S2, RATE_HZ) == pytest.approx(plain, abs=1e-9)
