"""Places between values, medians in kernels."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import between, bounds, median


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
