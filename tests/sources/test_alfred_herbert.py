"""Patent ES 414458 (Alfred Herbert, 1973): its worked cases, and one test for each claim.

`docs/background/claims-alfred-herbert.md` has the table from claim to test.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import pytest

from morfax.motion import ramp
from morfax.motion.drive import SOUND, Condition
from morfax.motion.faults import FollowingFault
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.ramp import CONSTANT, UP, count_ramp
from morfax.player.gcode.positioning import PositionControl, PositionPlayback
from morfax.player.gcode.rs274 import parse_rs274
from morfax.player.monitor import position_servo
from morfax.player.monitor.following_limit import FollowingLimit
from morfax.player.monitor.position_servo import CONSTANT as AT_FEED
from morfax.player.monitor.position_servo import DOWN as ON_THE_WAY_DOWN
from morfax.player.monitor.position_servo import UP as ON_THE_WAY_UP
from morfax.player.monitor.position_servo import PositionServo, PositionServos
from tests.console.conftest import Morfax

Vectors = Callable[[str], Any]
INCREMENT_MM = PositionServo().increment_mm


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
        # the ramp down is the last piece; of an odd increment the half before it belongs to the ramp up
        before = [
            mode for mode, halves in profile.pieces.tolist()[:-1] if halves > 1 or mode == UP
        ]
        assert {UP: "up", CONSTANT: "const"}[before[-1]] == case["mode_at_switch"]
        assert case["total_increments"] - profile.down_from == case["distance_left"]
        # the odd increment is run half up and half down, so what the ramp down needs is what is left
        assert case["rampdown_needs"] - case["counter_at_switch"] == case["distance_left"]
        assert profile.at_rest() == (2 * case["total_increments"], 0)


@dataclass(frozen=True)
class Period:
    """One period of a move as the control has it: mode and counter, and the transducers, increments."""

    mode: int
    counter: int
    seen: np.ndarray


def counted(*lines: str, condition: Condition = SOUND) -> tuple[list[Period], PositionPlayback]:
    """Each period of the last move of a program that the control plays; in parts of one period."""
    playback = PositionPlayback(parse_rs274([*lines, "M2"]), PositionControl())
    if condition != SOUND:  # a weak drive would be stopped by the monitor
        playback.limit = FollowingLimit.linear(lag_s=10, tolerance_mm=10)
    playback.conditions = [condition] * 3
    periods: list[Period] = []
    with mock.patch.object(position_servo, "AT_ONCE", 1):
        for motion in playback:
            if len(motion.positions_mm) > 1:  # standing still
                continue
            seen = np.rint(motion.positions_mm[0] / INCREMENT_MM).astype(int)
            servos = playback.servos
            if periods and servos.mode == ON_THE_WAY_UP and periods[-1].mode == ON_THE_WAY_DOWN:
                periods.clear()  # the next move
            periods.append(Period(servos.mode, servos.counter, seen))
    return periods, playback


def speeds_mm_s(periods: list[Period], over: int = 60) -> np.ndarray:
    """Speed along the path, over 10 ms each."""
    places = np.array([period.seen for period in periods[::over]]) * INCREMENT_MM
    return np.linalg.norm(np.diff(places, axis=0), axis=1) * MOTION_RATE_HZ / over


def test_claim_1_a_servo_in_a_closed_loop_stepped_by_a_program(
    here: Path, morfax: Morfax
) -> None:
    """Demand, transducer, comparator, error and servo: each end is reached, and kept."""
    (here / "plate.ngc").write_text(
        "G0 X0 Y0 Z2\nG0 X12.5 Y7\nG1 Z-3 F300\nG3 X12.5 Y17 J5 F900\nG4 P0.2\nG0 Z2\nG0 X-4\nM2\n"
    )
    asked = "play", "plate.ngc", "--control", "herbert", "-o", "plate.csv", "--raw", "--json"
    found = morfax(*asked).figures
    assert found["end_place_mm"] == pytest.approx([-4, 17, 2], abs=INCREMENT_MM)
    x_mm, y_mm, z_mm = np.loadtxt("plate.csv", delimiter=",", skiprows=1, usecols=(1, 2, 3)).T
    deep = z_mm < -2.9
    arc = np.hypot(x_mm[deep] - 12.5, y_mm[deep] - 12) - 5
    # 0.3 um outside by the lag, an increment of each transducer, the last 50 straight
    assert np.abs(arc).max() < 3 * INCREMENT_MM and y_mm[deep].max() > 16.9
    # a load that is pushed comes back
    pushed = PositionServos(np.array([5.0])).follow(np.full((12_000, 1), 8.0))
    assert abs(pushed[-1, 0] - 8.0) <= PositionServo().increment_mm
    assert (np.diff(np.abs(8.0 - pushed[:, 0])) <= 1e-12).all()


def test_claim_1_a_load_that_does_not_move_stops_the_machine() -> None:
    with pytest.raises(FollowingFault, match="X does not follow"):
        program = parse_rs274(["G1 X0 F600", "G1 X9", "M2"])
        playback = PositionPlayback(program, PositionControl())
        playback.conditions[0] = Condition(stuck=True)
        list(playback)


def test_claim_2_each_increment_counts_two_while_the_speed_grows_and_one_while_it_holds() -> (
    None
):
    """What is counted is what the transducer gives, period by period, and the ramps have one rate."""
    periods, _ = counted("G1 X0 F900", "G1 X8")
    weights = {ON_THE_WAY_UP: 2, AT_FEED: 1, ON_THE_WAY_DOWN: 0}
    for before, after in pairwise(periods):
        moved = np.abs(after.seen - before.seen).sum()
        assert after.counter - before.counter == weights[before.mode] * moved
    modes = [period.mode for period in periods]
    assert modes == sorted(modes, key=[ON_THE_WAY_UP, AT_FEED, ON_THE_WAY_DOWN].index)
    # the speed grows to 15 mm/s in 30 ms, at 500 mm/s², holds, and falls at the same rate
    took_s = np.array([modes.count(mode) for mode in weights]) / MOTION_RATE_HZ
    # 3 ms: the drive's lag of 1 ms, and the ends of a ramp, where increments are few
    assert took_s[[0, 2]] == pytest.approx(0.030, abs=0.003)
    assert speeds_mm_s(periods)[10:20] == pytest.approx(15, abs=0.2)


@pytest.mark.parametrize("length_mm", [0.001, 0.3, 0.301, 12.345])
@pytest.mark.parametrize("gain_share", [1.0, 0.7])
def test_claim_2_the_load_is_at_rest_where_it_was_sent(
    length_mm: float, gain_share: float
) -> None:
    """Also with a drive that gives 0.7 of its speed: its own increments say where to slow down."""
    periods, playback = counted(
        "G1 X0 F600", f"G1 X{length_mm}", condition=Condition(gain_share=gain_share)
    )
    assert playback.end_error_mm == pytest.approx([0, 0, 0], abs=1e-9)
    left = [round(length_mm / INCREMENT_MM) - int(period.seen[0]) for period in periods]
    assert min(left) >= -1  # never past it by more than an increment


def test_claim_3_one_counter_holds_the_sum_of_the_movements_in_all_dimensions() -> None:
    periods, playback = counted("G1 X0 Y0 Z0 F600", "G1 X6 Y-2 Z1")
    assert periods[0].counter == -9_000
    places = np.array([period.seen for period in periods])
    turned = next(k for k, period in enumerate(periods) if period.mode == ON_THE_WAY_DOWN)
    # the increments left on all axes are those of the ramp up, less what is past zero
    ramp_up = next(k for k, period in enumerate(periods) if period.mode == AT_FEED)
    left = np.abs([6_000, -2_000, 1_000] - places[turned]).sum()
    assert left == np.abs(places[ramp_up]).sum() - periods[turned].counter
    # and all axes end, on the straight line: within two increments of it
    assert playback.end_error_mm == pytest.approx([0, 0, 0], abs=1e-9)
    assert np.abs(places * [1, -3, 6] - places[:, :1]).max() < 2 * 6


def test_claim_4_a_digital_counter_preset_by_the_initial_error() -> None:
    for error_mm in (0.3, 0.301, 4.345):
        periods, _ = counted("G1 X0 F600", f"G1 X{error_mm}")
        increments = round(error_mm / INCREMENT_MM)
        assert periods[0].counter == -increments
        assert periods[-1].mode == ON_THE_WAY_DOWN
        # several increments of a period may take it past zero: 10 mm/s are 1.7 of them, twice
        assert 0 <= periods[-1].counter <= 4
        first = next(k for k, period in enumerate(periods) if period.mode == ON_THE_WAY_DOWN)
        assert all(period.counter < 0 for period in periods[:first])


@pytest.mark.parametrize(("word", "to"), [("G2", "X5 Y-5"), ("G3", "X5 Y5")])
def test_an_arc_presets_the_counter_by_the_increments_of_its_quarters(
    word: str, to: str
) -> None:
    """Three quarters round a radius of 5 mm, either way: both axes travel 5 mm in each."""
    periods, _ = counted("G1 X0 Y0 F600", f"{word} {to} I5 J0 F1200")
    assert periods[0].counter == -30_000


def test_the_planned_move_of_the_z_unit_counts_as_the_servos_do() -> None:
    """`motion.ramp` plans with the same counter: its moves end by the count, and not by their last line."""
    for error_mm in (0.001, 0.3, 0.301, 12.3456):
        profile = count_ramp(round(error_mm / INCREMENT_MM), [200])
        assert profile.count_then in (0, 1)
        travelled = ramp._sample(profile, 1e6, MOTION_RATE_HZ)
        assert travelled[-1] == pytest.approx(profile.increments, rel=1e-12)
