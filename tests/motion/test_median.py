"""The median of numbers: numpy's, to the bit."""

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.median import MANY, median, medians, percentile


@given(st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=40))
def test_it_is_that_of_numpy_to_the_bit(values: list[float]) -> None:
    assert median(values) == float(np.median(values))
    assert median(np.array(values)) == float(np.median(values))


def test_a_number_that_is_none_leaves_none() -> None:
    assert math.isnan(median([1.0, math.nan, 2.0]))
    assert math.isnan(median([]))


@given(st.integers(MANY - 1, MANY + 3), st.integers(0, 1000))
def test_the_median_of_many_is_found_without_ordering_them(count: int, seed: int) -> None:
    values = np.random.default_rng(seed).normal(size=count)
    assert median(values) == float(np.median(values))
    values[seed % count] = math.nan
    assert math.isnan(median(values))


@given(
    st.integers(1, 50),
    st.floats(0, 100),
    st.sampled_from([np.float32, np.float64]),
    st.integers(0, 1000),
)
def test_a_percentile_is_that_of_numpy_to_the_bit(
    count: int, percent: float, kind: type[np.floating], seed: int
) -> None:
    values = np.random.default_rng(seed).normal(size=count).astype(kind)
    assert percentile(values, percent) == float(np.percentile(values, percent))
    # numpy calculates several at once in double precision
    both = np.percentile(values, [percent, 50.0])
    assert percentile(values, percent, np.float64) == both[0]


@given(st.integers(1, 9), st.integers(0, 1000))
def test_many_medians_are_those_of_numpy_to_the_bit(count: int, seed: int) -> None:
    values = np.random.default_rng(seed).normal(size=(3, 2, count)).astype(np.float32)
    assert np.array_equal(medians(values), np.median(values, axis=-1))
