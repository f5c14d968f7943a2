"""Places between values, medians in kernels."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import _ends, between, bounds, median


def test_bounds_are_those_of_numpy() -> None:
    rows = np.random.default_rng(1).normal(size=(9, 3))
    low, high = bounds(rows)
    assert (low == rows.min(axis=0)).all() and (high == rows.max(axis=0)).all()


@pytest.mark.parametrize(
    ("at", "value"), [(-1, 2), (0, 2), (0.5, 3), (1.75, 7), (2, 8), (9, 8)]
)
def test_a_place_between_two_values(at: float, value: float) -> None:
    assert between(np.array([2.0, 4.0, 8.0]), at) == value


def test_one_value_holds_everywhere() -> None:
    assert between(np.array([3.0]), 0.5) == 3


@pytest.mark.parametrize("count", [1, 2, 3, 8, 121])
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_medians_are_those_of_numpy(count: int, kind: type) -> None:
    values = np.random.default_rng(count).normal(size=count).astype(kind)
    assert median(values) == pytest.approx(
        float(np.median(values)), rel=1e-7
    )  # rounding of float32


def test_a_median_with_no_number_is_none() -> None:
    assert np.isnan(median(np.array([1.0, np.nan, 2.0])))
    assert np.isnan(median(np.zeros(0)))


def test_bounds_of_any_layout_are_numbers_of_their_own_columns_and_nan_where_one_is() -> None:
    rows = np.random.default_rng(2).normal(size=(40, 6))
    rows[7, 2] = np.nan
    for some in (rows, rows[::3, ::2], rows.T[1:4], rows.astype(np.float32)):
        for found, wanted in zip(
            bounds(some), (some.min(axis=0), some.max(axis=0)), strict=True
        ):
            assert np.array_equal(found, wanted, equal_nan=True)
    plain = np.empty((2, 6))
    _ends.py_func(rows, plain)
    assert np.array_equal(plain, np.array(bounds(rows)), equal_nan=True)
    with pytest.raises(ValueError, match="one at least"):
        bounds(np.empty((0, 2)))
