"""The predictor against its closed form, and what of a motion it takes for a surprise."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.player.tape import predictor as organ
from morfax.player.tape.predictor import predictor_gains, recount
from tests.player.carriers import MOTION_RATE_HZ


def surprises(cycles: np.ndarray) -> np.ndarray:
    """What surprises the predictor, cycles, of an axis that stood at the first of these."""
    told = np.zeros(len(cycles), np.float32)
    recount(
        cycles.copy(), predictor_gains(MOTION_RATE_HZ), np.array([cycles[0], 0.0, 0.0]), told
    )
    return told


def test_predictor_has_three_equal_poles() -> None:
    g, h, k = predictor_gains(MOTION_RATE_HZ)
    step = np.array([[1, 1, 1], [0, 1, 2], [0, 0, 1.0]])
    after = (np.eye(3) - np.outer([g, h, k], [1, 0, 0])) @ step
    theta = np.exp(-2 * np.pi * organ.PREDICTOR_HZ / MOTION_RATE_HZ)
    assert np.poly(after) == pytest.approx(np.poly([theta] * 3), abs=1e-12)  # float64 rounding


def test_a_motion_of_constant_acceleration_holds_no_surprise_for_long() -> None:
    told = surprises(5e-5 * np.arange(600.0) ** 2)  # 180 m/s² of a usual tape
    # 120 Hz: settled within 50 ms
    assert np.abs(told[300:]).max() < 1e-6 < np.abs(told[:300]).max()


def test_a_jump_of_speed_surprises_by_its_size_and_is_counted_all_the_same() -> None:
    """Up to 0.22 cycle a row (67 mm/s of a usual tape), beyond which another turn is nearer."""
    ramp = np.maximum(np.arange(200.0) - 50, 0)
    small, large = (np.abs(surprises(share * ramp)).max() for share in (0.05, 0.1))
    assert large == pytest.approx(2 * small, rel=1e-5)  # float32
    cycles = 0.1 * ramp
    turned = cycles - np.round(cycles)
    recount(turned, predictor_gains(MOTION_RATE_HZ), np.zeros(3), np.zeros(200, np.float32))
    assert turned == pytest.approx(cycles, abs=1e-9)
