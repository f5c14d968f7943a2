"""Polylines against geometry that is known, and against all pairs of their pieces."""

from __future__ import annotations

import math
import tracemalloc
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion import neighbours, polyline
from morfax.motion.crossings import crossings
from morfax.motion.polyline import (
    APART_MM,
    STEPS_AT_A_TIME,
    WITHIN_MM,
    Nearest,
    area_mm2,
    at_lengths,
    come_to,
    lengths_mm,
    nearest_mm,
    plain,
    steps_mm,
    with_places,
)

ROUNDING_MM = 1e-12


def wave(seed: int, mm: float = 4.0, apart_mm: float = 0.03) -> np.ndarray:
    """A line that wanders at random."""
    turns = np.cumsum(np.random.default_rng(seed).normal(0, 0.7, 12))
    nodes = np.vstack(
        [
            np.zeros(2),
            np.cumsum(mm / 12 * np.column_stack([np.cos(turns), np.sin(turns)]), axis=0),
        ]
    )
    return with_places(nodes, apart_mm)


def test_a_crossing_in_a_place_of_a_line_counts_once() -> None:
    across, along = np.array([[1.0, -1.0], [1.0, 1.0]]), np.array([[0.0, 0], [1, 0], [2, 0]])
    assert crossings(along, across).tolist() == [[1.0, 0.5]]
    assert crossings(across, along).tolist() == [[0.5, 1.0]]


def test_steps_of_a_long_line_are_those_of_its_places_and_take_their_own_memory_alone() -> None:
    line_mm = np.random.default_rng(2).normal(size=(6 * STEPS_AT_A_TIME + 7, 2))
    tracemalloc.start()
    steps = steps_mm(line_mm)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert np.array_equal(steps, np.hypot(*np.diff(line_mm, axis=0).T))
    assert most < 2.0 * steps.nbytes  # all differences at once take as much as the line
    assert len(steps_mm(line_mm[:1])) == len(steps_mm(line_mm[:0])) == 0


def test_lengths_add_up_along_the_line() -> None:
    line = np.array([[0, 0], [3, 4], [3, 4], [3, 5.0]])
    assert lengths_mm(line).tolist() == [0, 5, 5, 6]


@given(seed=st.integers(0, 10_000), apart_mm=st.floats(0.003, 3))
@settings(max_examples=30, deadline=None)
def test_more_places_leave_the_line_where_it_is(seed: int, apart_mm: float) -> None:
    line = plain(wave(seed), ROUNDING_MM)
    more = with_places(line, apart_mm)
    assert np.hypot(*np.diff(more, axis=0).T).max() <= apart_mm + ROUNDING_MM
    assert lengths_mm(more)[-1] == pytest.approx(lengths_mm(line)[-1], abs=ROUNDING_MM)
    assert all(np.hypot(*(more - place).T).min() < ROUNDING_MM for place in line)


def test_fewer_places_are_within_what_is_allowed() -> None:
    angle = np.linspace(0, math.tau, 5001)
    circle = np.column_stack([10 * np.cos(angle), 10 * np.sin(angle)])
    kept = plain(circle, 0.01)
    assert (
        70 <= len(kept) < 2 * 70
    )  # chords with a rise of 0.01 mm are 0.9 mm long; they are halved as a whole
    assert np.abs(np.hypot(*with_places(kept, 0.05).T) - 10).max() <= 0.01 + ROUNDING_MM


@given(
    one=st.integers(0, 10_000),
    other=st.integers(0, 10_000),
    turn=st.floats(0.5, 2.5),
    apart_mm=st.floats(0.02, 0.4),
)
@settings(max_examples=100, deadline=None)
def test_crossings_are_those_of_all_pairs_of_pieces(
    one: int, other: int, turn: float, apart_mm: float
) -> None:
    a = wave(one, apart_mm=apart_mm)
    c, s = math.cos(turn), math.sin(turn)
    b = wave(other, apart_mm=apart_mm) @ np.array([[c, s], [-s, c]]) + [0.3, -0.2]
    found = crossings(a, b)
    p, q = np.diff(a, axis=0)[:, None], np.diff(b, axis=0)[None]
    w = b[None, :-1] - a[:-1, None]
    cross = p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]
    u, v = ((w[..., 0] * d[..., 1] - w[..., 1] * d[..., 0]) / cross for d in (q, p))
    i, j = np.nonzero((u >= 0) & (u < 1) & (v >= 0) & (v < 1))
    wanted = np.column_stack([i + u[i, j], j + v[i, j]])
    assert found == pytest.approx(
        wanted[np.argsort(wanted[:, 0])], abs=1e-6
    )  # of a piece: where it is met at a slant


def test_distances_are_true_a_radius_away() -> None:
    near = Nearest([np.array([[0, 0], [10, 0.0]]), np.array([[0, 8], [10, 8.0]])], 3.0)
    places = np.array([[5, 3], [5.0123, -3], [2, 7.5], [-3, 0.0]])
    assert near.distances_mm(places)[[0, 1, 3]] == pytest.approx([3, 3, 3], abs=WITHIN_MM)
    assert near.distances_mm(places)[2] == pytest.approx(0.5, abs=APART_MM**2)


def test_places_that_are_too_near_are_set_back_straight_and_no_others() -> None:
    near = Nearest([np.array([[0.0, 0.0], [10.0, 0.0]])], 2.0)
    back = near.set_back(np.array([[5.0, 1.99], [6.0, 2.5], [7.0, -1.999]]), 2.0)
    assert back == pytest.approx(
        np.array([[5.0, 2.0], [6.0, 2.5], [7.0, -2.0]]), abs=0.1 * 1e-3
    )


@given(st.integers(0, 40), st.integers(0, 60), st.integers(0, 2**32 - 1))
def test_the_nearest_place_is_that_of_all_pairs(count: int, others: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    places, line = random.normal(0, 5, (count, 2)), random.normal(0, 3, (others, 2))
    line[: others // 2, 0] = 1.0  # upright for half of its length
    apart = np.hypot(*np.moveaxis(places[:, None] - line[None], -1, 0))
    assert nearest_mm(places, line) == pytest.approx(
        apart.min(axis=1, initial=np.inf), abs=ROUNDING_MM
    )


def test_places_beside_an_upright_line_take_no_more_looks_than_beside_a_sloping_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """All of an upright line is as far in X: 4000 places beside 120 000 took seven seconds."""
    look, times = neighbours._look_through, list[int]()

    def looked(*args: Any) -> None:
        times[-1] += 1
        look(*args)

    monkeypatch.setattr(neighbours, "_look_through", looked)
    monkeypatch.setattr(neighbours, "_searched", neighbours._searched.py_func)
    along = np.linspace(0, 200, 3000)
    for across in (0.5 * along, 0 * along):
        line = np.column_stack([across, along])
        times.append(0)
        nearest_mm(line[::30] + np.array([60.0, -30.0]), line)
    assert 0 < times[1] <= times[0] < 3000  # a hundredth of all


@pytest.mark.parametrize(
    ("at", "found"),
    [
        (0.0, [0, 1, 2, 3, 0]),
        (1, [1, 2, 3, 0, 1]),
        (3.0, [3, 0, 1, 2, 3]),
        (1.5, [1.5, 2, 3, 0, 1, 1.5]),
        (3.5, [3.5, 0, 1, 2, 3, 3.5]),
        (0.25, [0.25, 1, 2, 3, 0, 0.25]),
    ],
)
def test_a_closed_line_may_begin_at_any_of_its_places(at: float, found: list[float]) -> None:
    """A square, once round; no place is there twice but the first and the last."""
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]])
    expected = polyline.at_places(square, np.array(found))
    assert polyline.begun_at(square, at) == pytest.approx(expected)


@pytest.mark.parametrize("seed", range(20))
def test_places_at_lengths_are_those_of_interpolation_to_the_last_bit(seed: int) -> None:
    """Also where the line stands, before its start and beyond its end, and in any order."""
    rng = np.random.default_rng(seed)
    line = np.cumsum(rng.normal(0, 0.1, (rng.integers(1, 60), 2)), axis=0)
    line[3:5] = line[min(3, len(line) - 1)]
    come = lengths_mm(line)
    at = np.r_[rng.uniform(-0.2, 1.2 * come[-1] + 0.1, 80), come]
    for some in (at, np.sort(at)):
        wanted = np.column_stack([np.interp(some, come, column) for column in line.T])
        assert np.array_equal(at_lengths(line, some), wanted)


def test_a_polyline_without_places_has_none_at_a_length() -> None:
    with pytest.raises(ValueError, match="one at least"):
        at_lengths(np.empty((0, 2)), np.zeros(1))


def test_the_area_is_positive_counter_clockwise_wherever_the_line_lies() -> None:
    oblong = np.array([[0.0, 0], [3, 0], [3, 2], [0, 2]])
    assert area_mm2(oblong) == 6.0 and area_mm2(oblong[::-1]) == -6.0
    assert area_mm2(oblong + 1e6) == pytest.approx(6.0, abs=1e-6)


def test_the_place_to_which_a_line_comes_after_a_length_is_the_first_that_is_so_far() -> None:
    line = np.cumsum(np.random.default_rng(3).normal(size=(50, 2)), axis=0)
    come_mm = lengths_mm(line)[1:]
    for length_mm in (0.0, 1.0, float(come_mm[20]), float(come_mm[-1]), 1e3):
        wanted = int(np.searchsorted(come_mm, length_mm))
        assert come_to(line[0], line[1:], length_mm) == wanted
        assert come_to.py_func(line[0], line[1:], length_mm) == wanted
