"""Parabolas in kernels: what numpy finds, and what plain Python does."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.sensing import parabola as organ

WIDTH_MM, STEP_MM, LEG_MM = 0.5, 0.05, 1.2
UM = 1e-3
# an arc of 5 mm radius is a parabola about one chord, and nearly one about another 7 degrees aslant
ASLANT_MM, ASLANT_RAD, ASLANT_BEND = 2 * UM, 0.01, 0.05


@pytest.fixture(params=[False, True], ids=["kernel", "plain"])
def leg_through(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., Any]:
    """The kernel, and the same in plain Python."""
    if request.param:
        for name, kernel in list(vars(organ).items()):
            if hasattr(kernel, "py_func"):
                monkeypatch.setattr(organ, name, kernel.py_func)
    return organ.leg_through


def stations(bend_per_mm: float, count: int = 40, noise_mm: float = 0.0) -> Array:
    """Stations along a parabola from the origin at 30 degrees."""
    x = STEP_MM * np.arange(count)
    y = bend_per_mm / 2 * x * x + np.random.default_rng(1).normal(0, 1, count) * noise_mm
    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    return np.column_stack([x * c - y * s, x * s + y * c, np.full(count, WIDTH_MM)])


@pytest.mark.parametrize("bend_per_mm", [0.0, 0.1, -0.2])
def test_a_parabola_is_found_again_at_its_clean_end(
    leg_through: Callable[..., Any], bend_per_mm: float
) -> None:
    seen = stations(bend_per_mm)
    (x, y, heading, bend, width), begin, stop = leg_through(seen, False, LEG_MM)
    # the first station is always left to the junction's ink
    assert (begin, stop) == (1, len(seen))
    assert math.hypot(x - seen[1, 0], y - seen[1, 1]) < ASLANT_MM
    assert heading == pytest.approx(
        math.radians(30) + math.atan(bend_per_mm * STEP_MM), abs=ASLANT_RAD
    )
    at_its_end = bend_per_mm / (1 + (bend_per_mm * STEP_MM) ** 2) ** 1.5
    assert bend == pytest.approx(at_its_end, abs=ASLANT_BEND * abs(bend_per_mm))
    assert width == WIDTH_MM


def test_stations_that_the_ink_of_a_junction_widens_are_left_out(
    leg_through: Callable[..., Any],
) -> None:
    seen = stations(0.0)
    seen[-4:, 2] += 0.2 * WIDTH_MM
    _, begin, stop = leg_through(seen, True, LEG_MM)
    assert (begin, stop) == (0, len(seen) - 5)
    # a third at most
    seen[:, 2] = np.linspace(WIDTH_MM, 3 * WIDTH_MM, len(seen))
    _, begin, stop = leg_through(seen, True, LEG_MM)
    assert begin == 0 and stop >= len(seen) - len(seen) // 3


def test_a_station_that_is_far_off_does_not_count(leg_through: Callable[..., Any]) -> None:
    seen = stations(0.0, noise_mm=1 * UM)
    clean = leg_through(seen, False, LEG_MM)[0]
    seen[12, :2] += [-50 * UM, 90 * UM]
    spoilt = leg_through(seen, False, LEG_MM)[0]
    assert math.dist(clean[:2], spoilt[:2]) < 0.5 * UM


@pytest.mark.parametrize("degree", [1, 2])
def test_the_weighted_parabola_is_numpy_s(degree: int) -> None:
    rng = np.random.default_rng(4)
    x, y, weights = rng.normal(size=30), rng.normal(size=30), rng.uniform(0.1, 1, 30)
    found = organ.parabola(x, y, weights, degree)[0]
    expected = np.polynomial.polynomial.polyfit(x, y, degree, w=np.sqrt(weights))
    assert found[: degree + 1] == pytest.approx(expected, abs=1e-9)
    assert not found[degree + 1 :].any()
    plain = organ.parabola.py_func(x, y, weights, degree)[0]
    assert plain == pytest.approx(found, abs=1e-12)
