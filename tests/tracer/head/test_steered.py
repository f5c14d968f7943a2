"""The parts of the head that move it, against their closed forms: home, steering, relay, courses.

Each test calls one kernel on a state made by hand; what they do together is in `test_kernel`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.drive import Drive
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.head import kernel, screws, swinging
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import Home, Tuning, at_rest
from morfax.tracer.sensing.leg import leg_of
from morfax.tracer.sensing.view import View
from tests.tracer.head.heads import LEAD_MM, PLACE, SPEED_MM_S, moving

# home


@pytest.mark.parametrize(
    ("home", "there"),
    [
        ((0.5, 0.0, 0.0, 0.0), True),
        ((-0.05, 0.0, 0.0, 0.0), False),  # behind
        ((0.9, 0.0, 0.0, 0.0), True),
        ((1.2, 0.0, 0.0, 0.0), False),  # further than a lead
        ((0.5, 0.22, 0.0, 0.0), True),
        ((0.5, 0.35, 0.0, 0.0), False),  # aside
        ((0.5, 0.0, 0.6, 0.0), True),
        ((0.5, 0.0, 0.7, 0.0), False),  # on another heading
        ((0.5, 0.0, math.pi, 0.0), False),
        ((0.5, 0.0, 0.0, 5.1), False),  # too soon
    ],
)
@pytest.mark.parametrize("goes_rad", [0.0, 2.0])
def test_home_is_just_ahead_on_the_line(
    tuning: Tuning, home: tuple[float, float, float, float], there: bool, goes_rad: float
) -> None:
    """Within a lead, three tenths of it aside, and 37 degrees of its heading; a lead of 1 mm here."""
    state, (along, aside, heading, travel) = moving(), home
    state.travel_mm, state.heading_rad = 5.0, goes_rad
    c, s = math.cos(goes_rad), math.sin(goes_rad)
    x_mm, y_mm = PLACE + np.array([along * c - aside * s, along * s + aside * c])
    at = Home(x_mm, y_mm, goes_rad + heading, travel)
    assert bool(kernel._at_home(state, tuning._replace(lead_mm=1.0), at)) is there


# steering


def test_the_axis_steers_on_the_circle_that_touches_its_heading(tuning: Tuning) -> None:
    """Turn rate = v · 2e / (l² + e²), from where the screws will be when the drives have come after."""
    quick = tuning._replace(steering_gain=1.0)
    state = moving()
    owed = Drive().lag_s * SPEED_MM_S
    ahead = screws.owed_s(tuning.drive_gain, tuning.period_s) * SPEED_MM_S
    assert ahead == pytest.approx(owed, rel=0.1)  # a lag of 1 ms, stepped in periods of 0.17 ms
    state.point_x_mm, state.point_y_mm = PLACE + np.array([0.1 + ahead, 0.02])
    kernel._steer(state, quick, swinging.way_of(state))
    assert state.turn_rad_s == pytest.approx(SPEED_MM_S * 0.04 / (0.1**2 + 0.02**2), rel=1e-9)
    assert state.heading_rad == pytest.approx(state.turn_rad_s * tuning.period_s)


def test_a_point_that_is_passed_is_steered_for_as_if_a_fifth_were_left(tuning: Tuning) -> None:
    quick, state = tuning._replace(steering_gain=1.0), moving()
    state.point_x_mm, state.point_y_mm = PLACE + np.array([-1.0, 0.01])
    kernel._steer(state, quick, swinging.way_of(state))
    left = 0.2 * tuning.point_mm
    assert state.turn_rad_s == pytest.approx(SPEED_MM_S * 0.02 / (left**2 + 0.01**2), rel=1e-9)


def test_the_relay_holds_for_its_time_and_the_speed_changes_by_the_acceleration(
    tuning: Tuning,
) -> None:
    state = moving()
    state.slow_periods, state.point_x_mm, state.point_y_mm = 10.0, 1e3, PLACE[1]
    step = tuning.acceleration_mm_s2 * tuning.period_s
    for n in range(1, 10):
        kernel._steer(state, tuning, swinging.way_of(state))
        assert state.speed_mm_s == pytest.approx(SPEED_MM_S - n * step)
    kernel._steer(state, tuning, swinging.way_of(state))  # it lets go
    assert state.speed_mm_s == pytest.approx(SPEED_MM_S - 8 * step)


def test_the_relay_holds_for_a_tenth_of_a_second(tuning: Tuning) -> None:
    """From where cell 102 has lost the line to the first period in which the speed grows again."""
    state, periods = moving(), 0
    state.slow_periods, state.point_x_mm, state.point_y_mm = tuning.slow_periods, 1e3, PLACE[1]
    before = math.inf
    while state.speed_mm_s <= before:
        before, periods = state.speed_mm_s, periods + 1
        kernel._steer(state, tuning, swinging.way_of(state))
    assert periods / MOTION_RATE_HZ == pytest.approx(0.1, abs=2 / MOTION_RATE_HZ)


# the screws


def test_a_course_is_begun_and_braked_by_the_acceleration(tuning: Tuning) -> None:
    """Speed² = 2·a·distance to the end, and no less than a fiftieth of the tracing speed."""
    state = at_rest(PLACE, LEAD_MM)
    way = PLACE + np.array([[0.0, 0.0], [1.0, 0.0]])
    speeds, places, out = [], [], np.empty((1, 2))
    while screws.run(state, tuning, np.vstack([_demand(state, tuning), way[1]]),
                     np.array([SPEED_MM_S, 0.0]), out):  # fmt: skip
        speeds.append(float(state.speed_mm_s))
        places.append(float(_demand(state, tuning)[0]))
        if places[-1] >= way[1, 0] - 1e-9:
            break
    a, period_s = tuning.acceleration_mm_s2, tuning.period_s
    assert speeds[0] == pytest.approx(0.02 * SPEED_MM_S, rel=1e-9) or speeds[
        0
    ] == pytest.approx(a * period_s)
    assert np.diff(speeds).max() <= a * period_s * (1 + 1e-9)
    left = way[1, 0] - np.r_[PLACE[0], places[:-1]]
    braking = np.maximum(np.sqrt(2 * a * np.maximum(left, 0)), 0.02 * SPEED_MM_S)
    assert np.all(np.array(speeds) <= braking * (1 + 1e-6))
    assert np.mean(np.array(speeds[-40:-5]) > 0.97 * braking[-40:-5]) > 0.9  # and no slower


def _demand(state: Any, tuning: Tuning) -> Array:
    """Where the drives' demand stands."""
    owed = screws.owed_s(tuning.drive_gain, tuning.period_s)
    return np.array([state.x_mm + owed * state.vx_mm_s, state.y_mm + owed * state.vy_mm_s])


def test_a_course_is_run_slowly_while_the_relay_holds(tuning: Tuning) -> None:
    state = at_rest(PLACE, LEAD_MM)
    state.slow_periods = 1e6
    out = np.empty((300, 2))
    way, speeds = PLACE + np.array([[0.0, 0.0], [9.0, 0.0]]), np.full(2, SPEED_MM_S)
    screws.run(state, tuning, way, speeds, out)
    assert state.speed_mm_s == pytest.approx(Settings().slowed * SPEED_MM_S)


def test_the_screws_of_a_moving_head_come_onto_a_course_without_a_leap(tuning: Tuning) -> None:
    """The demand goes on from where the screws will be when the drives have made good what they owe."""
    state, out = moving(), np.empty((30, 2))
    begin = _demand(state, tuning)
    way = np.vstack([begin, begin + np.array([2.0, 0.0])])
    screws.run(state, tuning, way, np.full(2, SPEED_MM_S), out)
    steps = np.diff(np.vstack([PLACE, out])[:, 0])
    assert steps == pytest.approx(SPEED_MM_S * tuning.period_s, rel=1e-9)


def test_following_that_comes_nowhere_leaves_the_next_as_it_was(seen: View) -> None:
    """The cell may stop before the first position: on the drum is still what was felt."""
    carriage = Carriage(Stance(PLACE, 0.0, seen), Settings(), MOTION_RATE_HZ)
    carriage.aim(seen, leg_of(seen.feel(PLACE, 0.0, seen.leg_mm), False, seen.leg_mm))
    nowhere = Home(0.0, 0.0, 0.0, from_travel_mm=1e9)
    carriage.follow(seen, nowhere, samples=0)
    carriage.follow(seen, nowhere, samples=100)
    assert carriage.count == 101
