"""The parabola from weighted sums of places: exact ones come back, and places on one spot tell none."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.moments import (
    NO_PLACES,
    Moments,
    parabola_of,
    straight_of,
    with_place,
)
from morfax.tracer.sensing.parabola import parabola

ROUNDING = 1e-12  # of coefficients near 1
X = np.linspace(-0.4, 0.7, 9)  # mm


def _sums(y: np.ndarray, weights: np.ndarray) -> Moments:
    sums = NO_PLACES
    for w, along, across in zip(weights, X, y, strict=True):
        sums = with_place.py_func(sums, float(w), float(along), float(across))
    return sums


@pytest.mark.parametrize("weights", [np.ones(9), np.linspace(0.1, 1.0, 9)])
def test_places_on_a_parabola_give_it_whatever_they_weigh(weights: np.ndarray) -> None:
    found = parabola_of.py_func(_sums(0.3 - 0.2 * X + 0.9 * X**2, weights))
    assert found == (True, *(pytest.approx(each, abs=ROUNDING) for each in (0.3, -0.2, 0.9)))


def test_places_with_noise_give_what_the_parabola_of_stations_gives() -> None:
    rng = np.random.default_rng(1)
    y, weights = rng.normal(0.0, 1.0, 9), rng.uniform(0.1, 1.0, 9)
    expected, _ = parabola(X, y, weights, 2)
    assert parabola_of.py_func(_sums(y, weights))[1:] == pytest.approx(expected, abs=1e-9)
    expected, _ = parabola(X, y, weights, 1)
    assert straight_of.py_func(_sums(y, weights)) == pytest.approx(expected, abs=1e-9)


def test_no_places_and_places_on_one_spot_give_no_parabola() -> None:
    spot = NO_PLACES
    for _ in range(5):
        spot = with_place.py_func(spot, 1.0, 0.2, 0.1)
    for sums in (NO_PLACES, with_place.py_func(NO_PLACES, 1.0, 0.2, 0.1), spot):
        assert not parabola_of.py_func(sums)[0]
    level, slope, _ = straight_of.py_func(spot)
    assert level + 0.2 * slope == pytest.approx(0.1, abs=ROUNDING)  # any line through the spot
