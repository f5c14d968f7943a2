"""Patent ES 414458 (Alfred Herbert, 1973): its worked cases, and one test for each claim.

`docs/background/claims-alfred-herbert.md` has the table from claim to test.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.ramp import CONSTANT, DOWN, UP, Ramp, count_ramp, positions_mm
from morfax.player.monitor.monitor import FollowingLimit, Monitor
from morfax.player.monitor.position_servo import PositionServo, PositionServos

Vectors = Callable[[str], Any]
INCREMENT_MM = Ramp().increment_mm


def test_the_limits_of_the_monitor(vectors: Vectors) -> None:
    limit = FollowingLimit.linear(lag_s=1 / 16.667, tolerance_mm=0.1)
    for case in vectors("he_monitor")["cases"]:
        assert limit.limit_mm(case["demand_speed_mm_s"]) == pytest.approx(
            case["limit_mm"], abs=1e-5
        )  # as printed


def speeds_of(plan: list[list[Any]]) -> tuple[list[int], list[int]]:
    """A plan of ramps and constant pieces as speeds, and the increments after which each later one is asked
    for.
    """
    speeds, changes_at, speed, travelled = [], [], 0, 0
    for mode, length in plan:
        if mode in ("up", "down"):
            if speeds:
                changes_at.append(travelled)
            speed += length if mode == "up" else -length
            speeds.append(speed)
        travelled += length or 0
    return speeds, changes_at


def test_where_the_ramp_down_starts(vectors: Vectors) -> None:
    for case in vectors("he_ramp")["cases"]:
        speeds, changes_at = speeds_of(case["plan"])
        profile = count_ramp(case["total_increments"], speeds, changes_at)
        assert profile.down_from == case["rampdown_starts_at"]
        assert profile.count_then == case["counter_at_switch"]
        assert case["total_increments"] - profile.down_from == case["distance_left"]
        # the odd increment is run half up and half down, so what the ramp down needs is what is left
        assert case["rampdown_needs"] - case["counter_at_switch"] == case["distance_left"]
        assert profile.at_rest() == (2 * case["total_increments"], 0)


def test_claim_1_a_servo_in_a_closed_loop_stepped_by_a_program() -> None:
    # demand, transducer, comparator, error and servo: the error goes to nothing, and a load that is pushed
    # comes back
    demand = np.vstack([positions_mm([0.0], [8.0], 20.0), np.full((6_000, 1), 8.0)])
    actual = PositionServos(demand[0]).follow(demand)
    assert abs(demand[-1, 0] - actual[-1, 0]) <= PositionServo().increment_mm
    pushed = PositionServos(np.array([5.0])).follow(np.full((12_000, 1), 8.0))
    assert abs(pushed[-1, 0] - 8.0) <= PositionServo().increment_mm
    assert (np.diff(np.abs(8.0 - pushed[:, 0])) <= 1e-12).all()
    # and it is watched, by figures 1 and 2
    assert Monitor("x", MOTION_RATE_HZ, FollowingLimit.linear(settle_s=0.06)).watch(
        demand, actual
    ) == len(demand)


def test_claim_2_each_increment_counts_two_while_the_speed_grows_and_one_while_it_holds() -> (
    None
):
    profile = count_ramp(1_000, [150])
    (up, rising), (constant, holding), (down, falling) = profile.pieces.tolist()
    assert (up, constant, down) == (UP, CONSTANT, DOWN)
    # lengths are in half increments
    assert -1_000 + 2 * (rising // 2) + holding // 2 == profile.count_then == 0
    assert rising == falling  # at the same rate
    way = positions_mm([0.0], [30.0], 10.0)[:, 0]
    push = np.diff(way, 2) * MOTION_RATE_HZ**2
    assert (
        push.max()
        == pytest.approx(-push.min(), rel=1e-3)
        == pytest.approx(Ramp().acceleration_mm_s2, rel=1e-3)
    )


def test_claim_3_one_counter_holds_the_sum_of_the_movements_in_all_dimensions() -> None:
    start, end = np.zeros(3), np.array([0.6, -0.2, 0.1])
    way = positions_mm(start, end, 5.0)
    assert (way[-1] == end).all()
    increments = np.rint(np.abs(end - start) / INCREMENT_MM).astype(int)
    assert increments.sum() == 900
    assert count_ramp(int(increments.sum()), [37]).at_rest() == (1_800, 0)
    # each axis ends exactly because all keep the ratio of their distances
    assert np.abs(way * [1, -3, 6] - way[:, :1]).max() < 1e-12


def test_claim_4_a_digital_counter_preset_by_the_initial_error() -> None:
    for error_mm in (0.001, 0.3, 0.301, 12.3456):
        increments = round(error_mm / INCREMENT_MM)
        profile = count_ramp(increments, [200])
        modes, halves = profile.pieces.T
        counted = (
            sum(
                {UP: 2, CONSTANT: 1, DOWN: 0}[int(mode)] * half
                for mode, half in zip(modes, halves, strict=True)
            )
            / 2
        )
        assert -increments + counted in (
            0,
            0.0,
        )  # with the odd increment half and half: 2 · ½ + 0 · ½
        assert profile.count_then in (0, 1)  # as the counter saw it: whole increments
        assert positions_mm([0.0], [error_mm], 10.0)[-1, 0] == error_mm
