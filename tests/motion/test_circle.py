"""The circle through places: a circle is found again, and the middle and spread are those of statistics."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.circle import circle_through, kasa, spread

PLAIN = pytest.mark.parametrize("plain", [False, True], ids=["compiled", "plain"])


@PLAIN
def test_the_spread_is_that_of_statistics(plain: bool) -> None:
    places = np.random.default_rng(1).normal([3, -7], [1, 2], (40, 2))
    x, y, xx, xy, yy = (spread.py_func if plain else spread)(places)
    assert (x, y) == pytest.approx(tuple(places.mean(axis=0)), abs=1e-12)
    told = 40 * np.cov(places.T, bias=True)
    assert np.array([[xx, xy], [xy, yy]]) == pytest.approx(told, abs=1e-9)


@PLAIN
@pytest.mark.parametrize("arc_rad", [0.3, 2.0, 6.0])
def test_a_circle_is_found_by_an_arc_of_it(arc_rad: float, plain: bool) -> None:
    """Wherever it lies, by places that are not evenly apart."""
    angle = 1.0 + arc_rad * np.sort(np.random.default_rng(2).uniform(0, 1, 25))
    places = np.array([40.0, -9.0]) + 2.5 * np.column_stack([np.cos(angle), np.sin(angle)])
    assert (kasa.py_func if plain else kasa)(places) == pytest.approx(
        (40.0, -9.0, 2.5), abs=1e-6
    )
    centre, radius, misfit = circle_through(places)
    assert centre == pytest.approx([40.0, -9.0], abs=1e-6) and radius == pytest.approx(
        2.5, abs=1e-6
    )
    assert misfit < 1e-6


def test_the_misfit_is_the_root_mean_square_off_the_circle() -> None:
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    radii = 3.0 + 0.1 * (-1.0) ** np.arange(40)
    _, radius, misfit = circle_through(
        radii[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    )
    assert radius == pytest.approx(3.0, abs=0.002)  # the fit is of squares: 0.1² / 2R
    assert misfit == pytest.approx(0.1, abs=1e-3)


@PLAIN
def test_places_on_a_straight_line_have_no_circle(plain: bool) -> None:
    x = np.linspace(0, 10, 20)
    found = (kasa.py_func if plain else kasa)(np.column_stack([x, 3 * x + 1]))
    assert math.isinf(found[2])
    bent = np.column_stack([x, 3 * x + 1 + 1e-4 * x * x])
    assert math.isfinite((kasa.py_func if plain else kasa)(bent)[2])
