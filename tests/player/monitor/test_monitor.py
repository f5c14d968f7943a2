"""The following-error monitor and the servo it watches: sound drives pass, broken ones are found in time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.drive import Condition
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.ramp import Ramp, positions_mm
from morfax.player.monitor import monitor, position_servo
from morfax.player.monitor.chart import Chart
from morfax.player.monitor.following_limit import (
    FollowingLimit,
    allowed_mm,
    learn_table,
)
from morfax.player.monitor.monitor import Monitor
from morfax.player.monitor.position_servo import PositionServo, PositionServos

INCREMENT_MM = PositionServo().increment_mm
WIDE_MM = 6.1  # the single limit that a rapid of 100 mm/s wants


def move(speed_mm_s: float, seconds: float = 3.0) -> np.ndarray:
    """Demand (n, 1) of a move with gentle ramps."""
    return positions_mm(
        [0.0], [speed_mm_s * seconds], speed_mm_s, Ramp(acceleration_mm_s2=10 * speed_mm_s)
    )


def run(demand: np.ndarray, breaks_at: int, condition: Condition) -> np.ndarray:
    """Actual positions of a servo that is sound until a row, and in a condition from there on."""
    servos = PositionServos(demand[0])
    before = servos.follow(demand[:breaks_at])
    servos.conditions = [condition] * demand.shape[1]
    return np.vstack([before, servos.follow(demand[breaks_at:])])


def test_the_limits_of_the_vectors(vectors: Callable[[str], Any]) -> None:
    limit = FollowingLimit.linear(lag_s=1 / 16.667, tolerance_mm=0.1)
    for case in vectors("he_monitor")["cases"]:
        assert limit.limit_mm(case["demand_speed_mm_s"]) == pytest.approx(
            case["limit_mm"], abs=1e-5
        )  # as printed


def test_a_table_is_straight_between_its_points_and_holds_beyond() -> None:
    limit = FollowingLimit.table([(0, 0.01), (10, 0.5), (100, 2.0)], tolerance_mm=0.1)
    speeds = np.array([-150.0, -10, 0, 5, 10, 55, 100, 1000])
    expected = np.interp(np.abs(speeds), [0, 10, 100], [0.01, 0.5, 2.0]) + 0.1
    assert [limit.limit_mm(v) for v in speeds] == pytest.approx(expected.tolist())


@given(st.floats(0.5, 100))
def test_a_sound_servo_passes_at_every_speed(speed_mm_s: float) -> None:
    demand = move(speed_mm_s, 1.0)
    watch = Monitor("x", MOTION_RATE_HZ, FollowingLimit.linear(settle_s=PositionServo().lag_s))
    assert watch.watch(demand, PositionServos(demand[0]).follow(demand)) == len(demand)
    assert watch.largest_error_mm[0] == pytest.approx(speed_mm_s * 0.06, rel=0.2)
    assert watch.warnings == []


@pytest.mark.parametrize(
    ("what", "condition", "within_s"),
    [
        ("friction", Condition(friction_mm_s=5.0), 0.2),
        ("lost gain", Condition(gain_share=0.2), 0.3),
        ("stuck axis", Condition(stuck=True), 0.2),
        ("runaway", Condition(runaway_mm_s=20.0), 0.05),
    ],
)
def test_a_broken_drive_at_low_speed_is_found_in_time_and_a_wide_limit_misses_it(
    what: str, condition: Condition, within_s: float
) -> None:
    demand, breaks_at = move(1.0), 6000
    actual = run(demand, breaks_at, condition)
    watch = Monitor("x", MOTION_RATE_HZ)
    sound_rows = watch.watch(demand, actual)
    assert breaks_at < sound_rows < breaks_at + within_s * MOTION_RATE_HZ
    single = Monitor("x", MOTION_RATE_HZ, FollowingLimit.table([(0, 0)], tolerance_mm=WIDE_MM))
    assert single.watch(demand, actual) == len(demand)


def test_a_fault_carries_its_state() -> None:
    demand = np.column_stack([move(1.0), 0 * move(1.0)])
    watch = Monitor("xy", MOTION_RATE_HZ)
    rows = watch.watch(demand, run(demand, 6000, Condition(stuck=True)))
    fault = watch.warnings[0]
    assert (fault.axis, fault.time_s, fault.exit_code) == ("x", rows / MOTION_RATE_HZ, 6)
    assert fault.demand_mm == demand[rows, 0]
    assert fault.limit_mm == pytest.approx(0.06 * 1.0 + 0.1, abs=1e-6)
    assert fault.demand_mm - fault.actual_mm == pytest.approx(
        fault.limit_mm, abs=2 * INCREMENT_MM
    )
    assert "the drive of X does not follow at 1." in str(
        fault
    ) and "allowed ±0.160 mm at 1 mm/s" in str(fault)


def test_a_warning_does_not_stop_and_comes_again_after_it_was_over() -> None:
    demand = np.zeros((9, 1))
    actual = np.array([0, 0.2, 0.3, 0, 0, 0.2, 0, 0, 0.0])[:, None]
    watch = Monitor("x", 1.0, stop=False)
    assert watch.watch(demand, actual) == 9
    assert [fault.time_s for fault in watch.warnings] == [1.0, 5.0]


def test_the_largest_share_of_a_limit_is_the_largest_error_over_the_limit() -> None:
    """0.1 mm is allowed at rest: 0.02, 0.07 and 0.05 mm off are at most 70 % of it."""
    watch = Monitor("x", 1.0, FollowingLimit.linear(tolerance_mm=0.1))
    watch.watch(np.zeros((3, 1)), np.array([[0.02], [-0.07], [0.05]]))
    assert watch.largest_share == pytest.approx([0.7])


def test_the_largest_share_is_exact_whichever_row_has_it() -> None:
    rng = np.random.default_rng(2)
    demand = np.cumsum(rng.normal(0, 2e-3, (4000, 2)), axis=0)
    actual = demand + rng.normal(0, 4e-3, demand.shape)
    limit = FollowingLimit.table([(0, 0.0), (5, 0.02), (9, 0.1)], 0.02)
    watch = Monitor("xy", 1000, limit, stop=False)
    watch.watch(demand, actual)
    speeds = np.abs(np.diff(demand, axis=0, prepend=demand[:1])) * 1000
    limits = np.vectorize(limit.limit_mm)(speeds)
    assert (watch.largest_share == (np.abs(demand - actual) / limits).max(axis=0)).all()


def test_two_axes_that_fail_at_once_are_both_told() -> None:
    watch = Monitor("xy", 1.0, stop=False)
    watch.watch(np.zeros((4, 2)), np.full((4, 2), 9.0))
    assert sorted(fault.axis for fault in watch.warnings) == ["x", "y"]


def test_blocks_are_as_the_whole() -> None:
    demand = move(20.0, 0.5)
    actual = run(demand, 1500, Condition(stuck=True))
    whole, parts = Monitor("x", MOTION_RATE_HZ), Monitor("x", MOTION_RATE_HZ)
    whole.watch(demand, actual)
    for first in range(0, len(demand), 700):
        if parts.watch(demand[first : first + 700], actual[first : first + 700]) < len(
            demand[first : first + 700]
        ):
            break
    assert parts.warnings[0].time_s == whole.warnings[0].time_s
    assert parts.rows_seen == whole.rows_seen


def test_a_chart_of_every_row_holds_demand_actual_and_limit() -> None:
    demand, chart = move(10.0, 0.5), Chart(every_s=0)
    actual = PositionServos(demand[0]).follow(demand)
    Monitor("x", MOTION_RATE_HZ, FollowingLimit.linear(settle_s=0.06), chart=chart).watch(
        demand, actual
    )
    assert (chart.demand_mm == demand).all() and (chart.actual_mm == actual).all()
    assert chart.limit_mm[0, 0] == pytest.approx(0.1) and chart.limit_mm.max() == pytest.approx(
        0.7, abs=1e-3
    )
    assert chart.t_s == pytest.approx(np.arange(len(demand)) / MOTION_RATE_HZ)


@given(st.integers(1, 400), st.integers(1, 90))
def test_a_chart_keeps_of_each_stretch_and_axis_the_row_nearest_to_its_limit(
    block: int, stretch: int
) -> None:
    rng, chart = np.random.default_rng(block), Chart(every_s=stretch / 1000)
    actual = rng.normal(size=(500, 2))
    watch = Monitor(
        "xy", 1000.0, FollowingLimit.linear(tolerance_mm=9.0), stop=False, chart=chart
    )
    for first in range(0, 500, block):
        watch.watch(np.zeros_like(actual[first : first + block]), actual[first : first + block])
    assert np.abs(chart.error_mm).max(axis=0) == pytest.approx(watch.largest_error_mm)
    starts = np.rint(chart.t_s * 1000).astype(int)
    kept = np.maximum.reduceat(np.abs(actual), starts, axis=0)
    assert (np.abs(chart.error_mm) == kept).all() and (np.diff(starts) <= stretch).all()


def test_a_chart_begins_anew_with_each_run_and_ends_with_the_row_of_the_fault() -> None:
    demand, chart = move(1.0), Chart()
    assert len(chart.t_s) == len(chart.limit_mm) == 0
    for _ in range(2):
        watch = Monitor("x", MOTION_RATE_HZ, chart=chart)
        rows = watch.watch(demand, run(demand, 6000, Condition(stuck=True)))
    assert chart.t_s[-1] <= rows / MOTION_RATE_HZ < chart.t_s[-1] + 0.01
    assert chart.error_mm[-1, 0] == watch.warnings[0].demand_mm - watch.warnings[0].actual_mm


def test_a_position_that_is_no_number_is_a_fault() -> None:
    assert Monitor("x", 1.0).watch(np.zeros((2, 1)), np.array([[0.0], [np.nan]])) == 1


def test_a_table_learnt_from_a_sound_run_passes_that_run() -> None:
    demand = move(50.0, 1.0)
    actual = PositionServos(demand[0]).follow(demand)
    speeds = np.linspace(0, 50, 26)
    limit = FollowingLimit.table(
        learn_table(demand, actual, MOTION_RATE_HZ, speeds.tolist()), tolerance_mm=0.01
    )
    assert Monitor("x", MOTION_RATE_HZ, limit).watch(demand, actual) == len(demand)


@pytest.mark.parametrize(
    "points", [[], [(1, 0)], [(0, 0), (0, 1)], [(0, -1)], [(0, 0), (float("inf"), 1)]]
)
def test_what_is_no_table_is_refused(points: list[tuple[float, float]]) -> None:
    with pytest.raises(ValueError, match=r"give finite ones|must be 0 or more"):
        FollowingLimit.table(points, 0.1)


def test_shapes_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ValueError, match=r"both must be \(n, 1\)"):
        Monitor("x", 1.0).watch(np.zeros((2, 2)), np.zeros((2, 2)))
    with pytest.raises(ValueError, match=r"give \(n, 1\)"):
        PositionServos(np.zeros(1)).follow(np.zeros((2, 2)))


def test_the_servo_is_behind_by_its_lag_and_arrives() -> None:
    demand = np.vstack([move(10.0, 2.0), np.full((6000, 1), 20.0)])
    actual = PositionServos(demand[0]).follow(demand)
    assert demand[9000, 0] - actual[9000, 0] == pytest.approx(
        10 * PositionServo().lag_s, abs=2 * INCREMENT_MM
    )
    assert abs(actual[-1, 0] - 20.0) <= INCREMENT_MM


def test_the_compiled_kernels_are_the_plain_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    demand = np.column_stack([move(5.0, 0.1), -move(5.0, 0.1)])
    broken = Condition(gain_share=0.4, friction_mm_s=0.1, runaway_mm_s=0.2)
    limit = FollowingLimit.table(
        [(0, 0), (3, 0.02), (4, 0.1)], 0.01, settle_s=0.01, hold_s=0.002
    )
    results = []
    for plain in (False, True):
        if plain:
            monkeypatch.setattr(position_servo, "_follow", position_servo._follow.py_func)
            for name in ("_watch", "_calm", "_watch_row"):
                monkeypatch.setattr(monitor, name, getattr(monitor, name).py_func)
        actual = run(demand, 300, broken)
        watch = Monitor("xy", MOTION_RATE_HZ, limit, stop=False)
        watch.watch(demand, actual)
        results.append((actual, [(fault.axis, fault.time_s) for fault in watch.warnings]))
    assert np.abs(results[0][0] - results[1][0]).max() < 1e-9
    assert results[0][1] == results[1][1] != []
    assert allowed_mm(3.5, 1, limit.rows, 0.01) == allowed_mm.py_func(3.5, 1, limit.rows, 0.01)
