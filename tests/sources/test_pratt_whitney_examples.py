"""Patent from US application 631 214 (Pratt & Whitney, 1967): its worked examples.

Pulses are of 0.0005 in, position counts of 0.001 in.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from morfax.motion.drive import Condition
from morfax.player.gcode.feed_control import (
    EIGHTH,
    GREATEST,
    MIDDLE,
    SMALLEST,
    resultant_weights,
)
from morfax.player.gcode.pulse_servo import (
    PULSES_PER_COUNT,
    PulseServos,
    lag,
    subtracted,
    unit_circuit,
)
from morfax.player.gcode.pulses import HISTORIC_CONTROL
from morfax.player.gcode.residues import (
    CLOCKWISE,
    COUNTER_CLOCKWISE,
    Feed,
    ResidueInterpolator,
)
from tests.sources.pulse_registers import (
    ALWAYS,
    read,
    step,
    ways,
)

Vectors = Callable[[str], Any]


def test_table_1_row_by_row(vectors: Vectors) -> None:
    for row in vectors("pw_table1")["printed_rows"]:
        end, pulse = step(
            row["RR_start"], row["error"], row["addend_magnitude"], row["gate_open"]
        )
        assert (end, pulse or None) == (row["RR_end"], row["pulse"]), row["cycle"]


def test_table_1_as_a_run_with_one_rule(vectors: Vectors) -> None:
    run = vectors("pw_table1")["run_same_cycle_rule"]
    loop = ResidueInterpolator(servo_constant=4, guard=False)
    found = read(loop, (-6, 0, 0), Feed(gate_period=3), 5)
    for row in run["rows"]:
        at = row["cycle"] - 1
        began, ended = found.residue[at : at + 2, 0].tolist()
        assert (began, ended) == (row["start"], row["end"])
        assert began + found.entered[at, 0] == row["after_error"]
        assert (found.error[at, 0], found.total[at]) == (row["E"], row["L_plus_Em"])
        assert found.against[at, 0] == row["added"] and row["gate"] == found.was_open[at]
        assert (found.pulses[at, 0] or None) == row["pulse"]
    pulsed = [cycle for cycle, pulse in enumerate(found.pulses[:, 0], 1) if pulse]
    assert pulsed == run["pulse_cycles"] == [4, 9, 16, 21, 30, 45]


@pytest.mark.parametrize("rule", ["zero_positive", "zero_negative"])
def test_a_sum_that_is_late_pulses_elsewhere_and_once_the_wrong_way(
    vectors: Vectors, rule: str
) -> None:
    """The rule that is not built, as the vectors have it; the compiled loop does otherwise."""
    told = vectors("pw_table1")["run_one_cycle_late_rule"][rule]
    residue, left, late, pulses = 5, -6, 10, []
    low = 0 if rule == "zero_positive" else 1
    for cycle in range(1, told[-1][0] + 1):
        total, late = late, 4 + abs(left)
        now = residue + (left if cycle % 3 == 0 else 0) + (total if residue < low else -total)
        if (now < low) == (residue < low):
            pulse = -1 if now < low else 1
            left -= pulse
            pulses.append([cycle, pulse])
        residue = now
    assert pulses == told
    built = read(
        ResidueInterpolator(servo_constant=4, guard=False), (-6, 0, 0), Feed(gate_period=3), 5
    )
    ours = [[k, int(pulse)] for k, pulse in enumerate(built.pulses[:, 0], 1) if pulse]
    assert ours != told and {pulse for _, pulse in ours} == {-1}


def test_one_axis_never_pulses_the_wrong_way_and_always_arrives() -> None:
    for error in range(1, 25, 2):
        for constant in (1, 2, 4, 8):
            for at in range(1 - constant - error, constant + error, 4):
                for period in (1, 2, 3, 4, 5, 7):
                    loop = ResidueInterpolator(servo_constant=constant, guard=False)
                    pulses = loop.line((error,) * 3, Feed(gate_period=period), at)[:, 0]
                    assert len(pulses) < 4_000 and pulses.min() >= 0
                    assert pulses.sum() == error


def test_linear_runs(vectors: Vectors) -> None:
    for case in vectors("pw_linear")["cases"]:
        pulses = ResidueInterpolator(servo_constant=case["L"], guard=False).line(
            tuple(case["target"]), ALWAYS, case["R0"]
        )
        assert len(pulses) == case["cycles"]
        first = [[int(i) + 1, pulses[i].tolist()] for i in np.flatnonzero(pulses.any(axis=1))]
        assert first[: len(case["first_pulses"])] == case["first_pulses"]
        assert (len(first), first[-1][0]) == (case["steps"], case["last_cycle"])
        along = np.array(case["target"]) / np.linalg.norm(case["target"])
        way = ways(pulses)
        off = np.linalg.norm(way - np.outer(way @ along, along), axis=1)
        assert off.max() == pytest.approx(case["max_dev_pulses"], abs=1e-4)  # as printed
        assert wrong_ways(pulses, case["target"]) == case["wrong_direction_pulses"]


def wrong_ways(pulses: np.ndarray, target: list[int]) -> int:
    """Pulses against the sense of their axis, or of an axis that is to stand."""
    return int(
        (pulses * np.sign(target) < 0).sum() + (pulses[:, np.array(target) == 0] != 0).sum()
    )


def test_linear_runs_from_a_residue_of_nothing(vectors: Vectors) -> None:
    for case in vectors("pw_linear")["cases"]:
        told = case["with_R0_zero"]
        loop = ResidueInterpolator(servo_constant=case["L"], guard=False)
        pulses = loop.line(tuple(case["target"]), ALWAYS, 0)
        along = np.array(case["target"]) / np.linalg.norm(case["target"])
        way = ways(pulses)
        off = np.linalg.norm(way - np.outer(way @ along, along), axis=1)
        assert len(pulses) == told["cycles"]
        assert off.max() == pytest.approx(told["max_dev"], abs=1e-4)  # as printed
        assert wrong_ways(pulses, case["target"]) == told["wrong_direction_pulses"]


def test_circular_runs(vectors: Vectors) -> None:
    for case in vectors("pw_circular")["cases"]:
        start, sense = (*case["start"], 0), COUNTER_CLOCKWISE if case["ccw"] else CLOCKWISE
        pulses = ResidueInterpolator(start, case["L"]).arc(
            (*case["end"], 0), tuple(case["centre"]), sense, ALWAYS
        )
        way = ways(pulses[pulses.any(axis=1)], start)[:, :2]
        assert len(pulses) == case["cycles"] and way[-1].tolist() == case["end"]
        expected = case["path_every_50"]
        assert way[::50][: len(expected)].tolist() == expected
        off = np.hypot(*(way - case["centre"]).T) - math.dist(case["start"], case["centre"])
        assert [off.min(), off.max()] == pytest.approx(case["radial_error_pulses"], abs=1e-3)
        # the text's variant, with the larger error in 2h, is further off
        assert np.abs(off).max() < np.abs(case["text_variant_radial_error"]).max()


def test_the_weights_and_what_they_make_of_the_speed(vectors: Vectors) -> None:
    norms = vectors("pw_feed_norm")
    assert norms["counter_weights_eighths"] | {"note": ""} == {
        "G": GREATEST,
        "M": MIDDLE,
        "S": SMALLEST,
        "note": "",
    }
    for sample in norms["samples"]:
        direction = np.array(sample["vector"])
        approximate = (
            direction @ resultant_weights(direction, true_norm=False) / (GREATEST * EIGHTH)
        )
        true = direction @ resultant_weights(direction, true_norm=True) / (GREATEST * EIGHTH)
        assert approximate == pytest.approx(sample["approx"]) and true == pytest.approx(
            sample["true"], rel=1e-4
        )
        assert true / approximate == pytest.approx(
            sample["true_feed_over_programmed"], rel=1e-4
        )  # weights of 15 bits


def test_the_largest_and_the_smallest_feeds_of_the_weights(vectors: Vectors) -> None:
    """Where two and three axes move, by directions a degree apart and those that the vectors name."""
    told = vectors("pw_feed_norm")
    for axes in (2, 3):
        extremes = told["two_axis" if axes == 2 else "three_axis"]
        tilts = np.radians(np.arange(91.0)) if axes == 3 else np.zeros(1)
        ways = [
            [math.cos(turn) * math.cos(tilt), math.sin(turn) * math.cos(tilt), math.sin(tilt)]
            for turn in np.radians(np.arange(0.0, 91.0))
            for tilt in tilts
        ]
        if axes == 3:
            ways += [extremes["max_at"], extremes["min_at"]]
            assert ratio(np.array([1.0, 1.0, 0.0])) == pytest.approx(extremes["at_1_1_0"])
        else:
            for name in ("max_at_deg", "min_at_deg"):
                turn = math.radians(extremes[name])
                ways.append([math.cos(turn), math.sin(turn), 0.0])
        ratios = [ratio(np.array(way, float)) for way in ways]
        assert max(ratios) == pytest.approx(extremes["max_ratio"]) == pytest.approx(ratios[-2])
        assert min(ratios) == pytest.approx(extremes["min_ratio"]) == pytest.approx(ratios[-1])
        slowest, fastest = (100 / one - 100 for one in (max(ratios), min(ratios)))
        assert [slowest, fastest] == pytest.approx(extremes["feed_error_percent"], abs=1e-3)


def ratio(direction: np.ndarray) -> float:
    """The patent's resultant speed over the true one."""
    weighed = direction @ resultant_weights(direction, true_norm=False) / (GREATEST * EIGHTH)
    return float(weighed / np.linalg.norm(direction))


def test_the_unit_circuit(vectors: Vectors) -> None:
    for case in vectors("pw_unit_circuit")["cases"]:
        asked = case["position"], case["icr5"], 5
        assert subtracted(*asked) == (case["diff5"], case["borrow"])
        assert unit_circuit(*asked) == case["interpolated"]
        assert lag(*asked) == case["lag"]


def test_the_unit_circuit_in_a_servo_whose_motor_is_stuck(vectors: Vectors) -> None:
    """The axis stands at the vectors' position, and is told to go on by their lag: no fault."""
    for case in vectors("pw_unit_circuit")["cases"]:
        servos = PulseServos(
            np.array([PULSES_PER_COUNT * case["position"]]), 6_000, HISTORIC_CONTROL.servo, 1
        )
        servos.conditions = [Condition(stuck=True)]
        sense = np.int8(math.copysign(1, case["lag"]))
        pulses = np.full((PULSES_PER_COUNT * abs(case["lag"]), 1), sense)
        assert servos.follow(pulses)[2] == len(pulses)
        assert servos.command[0] == PULSES_PER_COUNT * case["interpolated"]
        assert servos.largest_lag[0] == abs(case["lag"])
