"""Neighbours: the same as trying every point, whatever order the points come in."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion import neighbours
from morfax.motion.neighbours import (
    LEAF,
    MOST_MET,
    Neighbours,
    _count_pairs,
    _met,
    crowds,
    pairs_within,
)

ROUNDING = 1e-12  # of places up to 100


def tried(points: np.ndarray, places: np.ndarray) -> np.ndarray:
    """The distance of each place from each point."""
    return np.hypot(*(places[:, None] - points[None]).transpose(2, 0, 1))


@settings(max_examples=40)
@given(
    st.integers(0, 10_000),
    st.integers(1, 5 * LEAF + 1),
    st.sampled_from(["in order", "at random", "on a grid", "all alike"]),
)
def test_the_nearest_is_that_of_trying_all(seed: int, count: int, kind: str) -> None:
    random = np.random.default_rng(seed)
    points = random.uniform(-50, 50, (count, 2))
    if kind == "in order":
        points = np.cumsum(random.normal(0, 1, (count, 2)), axis=0)
    elif kind == "on a grid":
        points = np.round(points / 20)
    elif kind == "all alike":
        points[:] = points[0]
    places = np.vstack([random.uniform(-80, 80, (30, 2)), points[:5]])
    away, number = Neighbours(points).nearest(places)
    every = tried(points, places)
    assert away == pytest.approx(every.min(axis=1), abs=ROUNDING)
    assert every[np.arange(len(places)), number] == pytest.approx(away, abs=ROUNDING)
    if kind in ("on a grid", "all alike"):  # distances that are alike are so to the bit
        squares = ((places[:, None] - points[None]) ** 2).sum(axis=2)
        assert number.tolist() == squares.argmin(axis=1).tolist()
    few = min(4, count)
    several = Neighbours(points).several(places, few)
    found = np.take_along_axis(every, several, axis=1)
    assert found == pytest.approx(np.sort(every, axis=1)[:, :few], abs=ROUNDING)
    assert all(len(set(row)) == few for row in several.tolist())


def test_of_points_as_near_the_first_is_found() -> None:
    points = np.column_stack([np.arange(40) % 2, np.zeros(40)])
    away, number = Neighbours(points).nearest([[0.5, 0.0], [0.6, 0.0]])
    assert away == pytest.approx([0.5, 0.4])
    assert number.tolist() == [0, 1]


def test_beyond_a_limit_nothing_is_found() -> None:
    points = np.column_stack([np.linspace(0, 10, 101), np.zeros(101)])
    away, number = Neighbours(points).nearest([[5.0, 0.3], [5.0, 0.2]], within=0.25)
    assert away.tolist() == [np.inf, pytest.approx(0.2)]
    assert number.tolist() == [101, 50]


def test_points_in_any_order_are_put_in_order_first() -> None:
    """Else every box would be as large as all, and each place would try every point."""
    random = np.random.default_rng(1)
    points = random.uniform(0, 100, (4096, 2))
    found = Neighbours(points)
    leaves = found._boxes[len(found._boxes) // 2 :]
    sides = (leaves[:, 2:] - leaves[:, :2])[: 4096 // LEAF]
    # a square for 8 of 4096 points has sides of 4.4
    assert np.median(sides) < 6.0
    assert np.array_equal(found.nearest(points)[1], np.arange(4096))


def test_short_lines_in_any_order_are_put_in_order_and_a_long_line_stays() -> None:
    """900 circles: in any order a place lies in a hundred boxes. Of points as near the first is found."""
    random = np.random.default_rng(1)
    angles = np.linspace(0, 2 * np.pi, 32, endpoint=False)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    middles = 5.0 * np.argwhere(np.ones((30, 30)))
    circles = np.vstack([circle + middle for middle in random.permutation(middles)])
    for points, is_ordered in ((circles, True), (np.cumsum(np.abs(circles), axis=0), False)):
        found = Neighbours(points)
        assert bool((np.diff(found._numbers) != 1).any()) is is_ordered
        assert _met(found._boxes, len(points)) < MOST_MET
    twice = np.vstack([circles, circles])
    assert np.array_equal(Neighbours(twice).nearest(circles)[1], np.arange(len(circles)))


@settings(max_examples=30)
@given(st.integers(0, 10_000), st.integers(0, 40), st.booleans())
def test_the_pairs_within_a_reach_are_those_of_trying_all(
    seed: int, count: int, on_a_grid: bool
) -> None:
    points = np.random.default_rng(seed).uniform(0, 10, (count, 2))
    points = np.round(points) if on_a_grid else points
    found = pairs_within(points, 2.0)
    every = {(a, b) for a, b in np.argwhere(tried(points, points) <= 2.0).tolist() if a < b}
    assert sorted(tuple(sorted(pair)) for pair in found.tolist()) == sorted(every)


def test_of_no_points_none_is_near() -> None:
    away, number = Neighbours(np.empty((0, 2))).nearest([(1.0, 2.0), (3.0, 4.0)])
    assert np.all(np.isinf(away)) and number.tolist() == [0, 0]


@pytest.mark.parametrize("apart", [1, 2, 7])
@pytest.mark.parametrize("kernel", [_count_pairs, _count_pairs.py_func])
def test_crowds_are_those_of_all_pairs(
    apart: int, kernel: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(neighbours, "_count_pairs", kernel)
    points = np.random.default_rng(apart).integers(0, 12, (90, 2)).astype(float)
    near, numbers = tried(points, points) <= 2.0, np.arange(90)
    before = numbers[:, None] - numbers
    lower, higher = crowds(points, 2.0, apart)
    assert lower.tolist() == (near & (before >= apart)).sum(axis=1).tolist()
    assert higher.tolist() == (near & (-before >= apart)).sum(axis=1).tolist()
    assert [len(some) for some in crowds(points[:0], 2.0)] == [0, 0]
