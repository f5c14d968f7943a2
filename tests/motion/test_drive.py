"""The velocity servo against the closed form of a first-order lag with a limited acceleration."""

import math

import numpy as np
import pytest

from morfax.motion.drive import Drive, drive_step

DT_S = 1 / 6000
ROUNDING = 1e-12  # of float64 over a few thousand steps


def speeds_mm_s(drive: Drive, demand_mm_s: float, steps: int) -> np.ndarray:
    gain, largest = drive.gain(DT_S), drive.acceleration_mm_s2 * DT_S
    speed, out = 0.0, []
    for _ in range(steps):
        speed = drive_step.py_func(speed, demand_mm_s, gain, largest)
        out.append(speed)
    return np.array(out)


def test_a_step_of_demand_is_answered_by_the_lag() -> None:
    # 1 mm/s within the lag asks for 1 / 0.001 = 1000 mm/s², under the limit: the drive is linear, and the
    # step exact
    drive, t_s = Drive(), DT_S * np.arange(1, 61)
    closed_form = 1.0 - np.exp(-t_s / drive.lag_s)
    assert np.abs(speeds_mm_s(drive, 1.0, 60) - closed_form).max() < ROUNDING


def test_a_large_step_is_answered_by_the_limit_and_then_the_lag() -> None:
    # with v' = (V - v) / lag limited to a, the limit ends at V - a lag, in closed form a straight line until
    # then
    drive, demand = Drive(lag_s=0.01, acceleration_mm_s2=1000.0), 50.0
    speed, t_s = speeds_mm_s(drive, demand, 600), DT_S * np.arange(1, 601)
    straight = (
        t_s <= (demand - drive.acceleration_mm_s2 * drive.lag_s) / drive.acceleration_mm_s2
    )
    assert np.abs(speed - 1000.0 * t_s)[straight].max() < 1e-9 * demand
    left = demand - speed[~straight]
    assert left[1:] / left[:-1] == pytest.approx(math.exp(-DT_S / drive.lag_s), rel=1e-9)


@pytest.mark.parametrize("demand_mm_s", [-20.0, 0.0, 35.0])
def test_the_drive_comes_to_the_demand(demand_mm_s: float) -> None:
    assert speeds_mm_s(Drive(), demand_mm_s, 600)[-1] == pytest.approx(demand_mm_s, abs=1e-6)


def test_no_lag_follows_at_once() -> None:
    assert Drive(lag_s=0.0).gain(DT_S) == 1.0


def test_the_compiled_step_is_the_plain_one() -> None:
    assert drive_step(1.0, 5.0, 0.2, 0.3) == drive_step.py_func(1.0, 5.0, 0.2, 0.3) == 1.3
