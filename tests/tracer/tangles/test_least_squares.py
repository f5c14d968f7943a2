"""Least squares: the same as scipy's `least_squares`, to the last bit, without the rest of its optimisers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

from morfax.motion.arrays import Array
from morfax.tracer.tangles import least_squares as ours

AT = np.linspace(0.0, 3.0, 80)
STARTS = np.random.default_rng(1).normal(size=(20, 4))


def wrong(figures: Array) -> Array:
    """What is wrong of a sum of two curves."""
    fades = figures[0] * np.exp(-np.clip(figures[1] * AT, -50, 50))
    return np.asarray(fades + figures[2] * np.sin(figures[3] * AT) - np.cos(AT))


def slopes(figures: Array) -> Array:
    """By how much each figure changes that, by steps of its own."""
    steps = 1e-6 * np.eye(4)
    return np.stack([(wrong(figures + step) - wrong(figures)) / 1e-6 for step in steps]).T


@pytest.mark.parametrize("zero", [None, 0, 3])
@pytest.mark.parametrize("most", [5, 160])
def test_it_comes_to_what_scipy_comes_to(zero: int | None, most: int) -> None:
    for start in STARTS.copy():
        if zero is not None:
            start[zero] = 0.0
        asked = {"method": "lm", "max_nfev": most, "ftol": ours.ENOUGH}
        theirs = least_squares(wrong, start, diff_step=ours.NUDGE, **asked)
        assert np.array_equal(ours.fitted(wrong, start, most), theirs.x)
        theirs = least_squares(wrong, start, slopes, **asked)
        assert np.array_equal(ours.fitted(wrong, start, most, slopes), theirs.x)


def test_a_scipy_that_keeps_minpack_elsewhere_is_loaded_whole(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def missing(package: str, name: str) -> object:
        raise ImportError(name)

    monkeypatch.setattr(ours, "extension", missing)
    ours._lmder.cache_clear()
    found = ours.fitted(wrong, STARTS[0], 160)
    ours._lmder.cache_clear()
    assert np.sum(wrong(found) ** 2) < np.sum(wrong(STARTS[0]) ** 2)
