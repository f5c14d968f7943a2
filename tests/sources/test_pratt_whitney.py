"""Patent from US application 631 214 (Pratt & Whitney, 1967): its worked examples, and one test for each
claim.

`docs/background/claims-pratt-whitney.md` has the table from claim to test. Pulses are of 0.0005 in, position
counts of 0.001 in.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from morfax.motion.drive import Condition
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.player.gcode.feed_control import (
    BLOCKED,
    EIGHTH,
    FEED_EIGHTHS,
    FOURTH,
    GREATEST,
    MIDDLE,
    SMALLEST,
    count_feed,
    feed_number,
    override_number,
    resultant_weights,
)
from morfax.player.gcode.pulse_servo import (
    PULSES_PER_COUNT,
    PulseServo,
    PulseServos,
    lag,
    subtracted,
    unit_circuit,
)
from morfax.player.gcode.pulses import HISTORIC_CONTROL
from morfax.player.gcode.residues import (
    CLOCKWISE,
    COUNTER_CLOCKWISE,
    LINE,
    Feed,
    ResidueInterpolator,
)
from tests.console.conftest import Morfax
from tests.sources.pulse_registers import Block, played, read

Vectors = Callable[[str], Any]
RECIRCULATIONS_HZ = 8 * MOTION_RATE_HZ
ALWAYS = Feed(gate_period=1)


def ways(pulses: np.ndarray, start: tuple[int, ...] = (0, 0, 0)) -> np.ndarray:
    """Places after each recirculation, the start first."""
    return (
        np.vstack([np.zeros((1, 3), np.int64), np.cumsum(pulses, axis=0, dtype=np.int64)])
        + start
    )


def step(residue: int, error: int, total: int, gate_open: bool) -> tuple[int, int]:
    """One recirculation of the compiled loop: the new residue, and the pulse (0 for none)."""
    size = max(1, abs(error))
    loop = ResidueInterpolator(servo_constant=total - size, guard=False)
    end = (int(math.copysign(size, error)), 0, 0)
    block = read(loop, end, Feed(gate_period=1 if gate_open else 2), residue, most=1)
    return int(block.residue[1, 0]), int(block.pulses[0, 0])


def oblique() -> list[Block]:
    """Lines in three axes as the historic control plays them, at a feed below its fastest."""
    lines = "G1 X0 Y0 Z0 F1800", "G1 X9 Y-4 Z2", "G1 X1 Y4 Z2", "G1 X-9 Y1 Z0"
    return played(HISTORIC_CONTROL, *lines)[-3:]


def quarters() -> list[Block]:
    """Quarter circles of 12 mm, either way round, as the historic control plays them."""
    there, back = "G3 X0 Y12 I-12 J0", "G2 X12 Y0 I0 J-12"
    return played(HISTORIC_CONTROL, "G1 X12 Y0 F1200", there, back)[-2:]


# --- worked examples


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


# --- claims


def rates(end: tuple[int, int, int], constant: int = 16) -> np.ndarray:
    """Pulses per recirculation at the start of a line, while the errors have hardly changed."""
    pulses = ResidueInterpolator(servo_constant=constant).line(end, ALWAYS)
    few = max(map(abs, end)) // 20
    return np.abs(pulses[:few]).mean(axis=0)


def test_claim_1_pulse_frequencies_from_each_error_and_the_largest() -> None:
    largest = 40_000
    found = rates((largest, -25_000, 10_000), constant=10_000)
    assert found == pytest.approx(
        np.array([40, 25, 10]) / (40 + 10), rel=0.02
    )  # 2 %: the errors fall by 4 %


def test_claim_2_the_frequencies_are_in_the_ratio_of_the_errors() -> None:
    end = (30_000, 20_000, -10_000)
    pulses = ResidueInterpolator().line(end, ALWAYS)
    way = np.abs(ways(pulses))
    for place in way[:: len(way) // 50]:
        assert place == pytest.approx(np.abs(end) * place[0] / 30_000, abs=2)


def test_claim_3_the_sum_is_added_against_the_sign_and_a_sign_that_stays_is_a_pulse() -> None:
    # left alone it alternates
    assert step(5, 0, 10, False) == (-5, 0) and step(-5, 0, 10, False) == (5, 0)
    assert step(5, -6, 10, True) == (-11, 0) and step(-11, 0, 10, False) == (-1, -1)
    for block in oblique():
        largest = int(np.abs(block.error[0]).argmax())  # the guard has nothing to do there
        came, error = block.entered[:, largest], block.error[:, largest]
        assert ((came == 0) | (came == error)).all()
        stayed = (block.residue[1:, largest] < 0) == (block.residue[:-1, largest] < 0)
        assert (stayed == (block.pulses[:, largest] != 0)).all() and stayed.any()


def test_claim_4_feed_pulses_count_up_command_pulses_down_and_the_count_opens_the_gates() -> (
    None
):
    feed = Feed(feed_number(9_000, RECIRCULATIONS_HZ))
    interpolator = ResidueInterpolator()
    weights = resultant_weights(np.array([8_000, 3_000, 0]), true_norm=False)
    pulses = next(interpolator.recirculate((8_000, 3_000, 0), (0, 0), LINE, feed))[:4_000]
    taken = int(np.abs(pulses).sum(axis=0) @ weights) // EIGHTH
    fed = count_feed(len(pulses), feed.number, feed.override) * FEED_EIGHTHS
    assert 0 <= fed - taken < BLOCKED // EIGHTH  # what is left is the counter, of 8 stages
    loop = ResidueInterpolator()
    read_out = read(loop, (8_000, 3_000, 0), feed, most=4_000)
    taken_so_far = np.cumsum(np.abs(read_out.pulses) @ weights) / EIGHTH
    for row in range(0, 4_000, 100):
        fed = count_feed(row + 1, feed.number, feed.override) * FEED_EIGHTHS
        assert read_out.counter[row + 1] == fed - taken_so_far[row]
    # 9000 of 48000: at times every fourth recirculation, at times none
    assert read_out.counter[2_000:].min() < 32 < read_out.counter[2_000:].max() < 64


def held(end: tuple[int, int, int], **how: Any) -> float:
    """The speed along a line over what was programmed, off the approach."""
    override = override_number(how.pop("override", 1.0))
    pulses = ResidueInterpolator().line(
        end, Feed(feed_number(9_000, RECIRCULATIONS_HZ), override, **how)
    )
    half = len(pulses) // 2
    return float(np.linalg.norm(ways(pulses)[half]) / half * RECIRCULATIONS_HZ / 9_000)


@pytest.mark.parametrize("direction", [(1, 1, 1), (10, 4, 3), (5, 3, 1), (3, 2, 1)])
def test_claim_5_three_axes_weigh_two_and_a_half_to_one_to_three_quarters(
    direction: tuple[int, int, int],
) -> None:
    size = np.array(direction, float)
    approximate = (2.5 * size[0] + size[1] + 0.75 * size[2]) / 2.5
    end = tuple((size / np.linalg.norm(size) * 20_000).astype(int))
    assert held(end) == pytest.approx(np.linalg.norm(size) / approximate, rel=0.005)


@pytest.mark.parametrize("direction", [(1, 0), (1, 1), (10, 4), (4, 3)])
def test_claim_6_two_axes_weigh_two_and_a_half_to_one(direction: tuple[int, int]) -> None:
    size = np.array([*direction, 0], float)
    end = tuple((size / np.linalg.norm(size) * 20_000).astype(int))
    assert held(end) == pytest.approx(
        np.linalg.norm(size) / (size[0] + size[1] / 2.5), rel=0.005
    )


def test_claims_7_and_8_the_speed_of_each_part_is_its_error_over_the_largest_and_a_constant() -> (
    None
):
    for constant in (16, 400, 4_000):
        pulses = ResidueInterpolator(servo_constant=constant).line((9_000, 4_500, 0), ALWAYS)
        left = np.array([9_000, 4_500, 0]) - ways(pulses)
        for first in range(0, len(pulses) - 400, 300):
            error = left[first : first + 200].mean(axis=0)
            speed = pulses[first : first + 200].mean(axis=0)
            assert speed == pytest.approx(
                error / (constant + error.max()), abs=0.02
            )  # 4 pulses in 200


def test_claim_9_the_largest_error_is_found_whichever_axis_has_it() -> None:
    runs = [
        ResidueInterpolator().line(tuple(np.roll([900, 300, 100], k)), ALWAYS) for k in range(3)
    ]
    for k, run in enumerate(runs):
        assert (np.roll(run, -k, axis=1) == runs[0]).all()


def test_claim_10_the_constant_is_added_to_the_largest_error() -> None:
    for constant in (1, 7, 60):
        block = read(
            ResidueInterpolator(servo_constant=constant), (100, -40, 0), Feed(gate_period=4)
        )
        closed = ~block.was_open & (block.error[:, 0] != 0)
        changed = np.abs(np.diff(block.residue[:, 0]))[closed]
        assert (changed == constant + np.abs(block.error).max(axis=1)[closed]).all()
        assert closed.sum() > 2 * len(closed) // 3


def test_claim_11_errors_enter_in_selected_recirculations_and_a_sign_that_stays_is_found() -> (
    None
):
    for period in (1, 2, 3, 4):
        block = read(ResidueInterpolator(), (40, 0, 0), Feed(gate_period=period), 28)
        assert np.flatnonzero(block.was_open)[:20].tolist() == [
            period * (k + 1) - 1 for k in range(20)
        ]
        low = block.residue[:, 0] < 0
        assert ((low[1:] == low[:-1]) == (block.pulses[:, 0] != 0)).all()


def test_claim_12_a_train_of_pulses_for_each_axis() -> None:
    pulses = ResidueInterpolator().line((3_000, -2_000, 1_000), ALWAYS)
    assert set(np.unique(pulses)) == {-1, 0, 1}
    assert pulses.sum(axis=0).tolist() == [3_000, -2_000, 1_000]


def test_claim_13_each_train_drives_the_motor_of_its_axis(here: Path, morfax: Morfax) -> None:
    (here / "part.ngc").write_text("G1 X0 Y0 Z0 F600\nG1 X3 Y-2 Z1\nM2\n")
    for how, pulse_mm in (((), 0.001), (("--historic",), 0.0127)):
        found = morfax("play", "part.ngc", *how, "--json").figures
        assert found["end_place_mm"] == pytest.approx([3, -2, 1], abs=pulse_mm)


def test_claim_14_the_sum_added_twice_with_one_sign_is_found() -> None:
    """Read from the residues: a pulse comes where the next sum has the sign of the one before."""
    for block in [*oblique(), *quarters()]:
        largest = int(np.abs(block.error[0]).argmax())
        moved, error = np.diff(block.residue[:, largest]), block.error[:, largest]
        # the sum that was added: with the error or without it, whichever is L + E_m
        with_error = np.abs(np.abs(moved - error) - block.total) == 0
        added = np.where(with_error, moved - error, moved)
        if block.sense:  # on an arc crossed errors come in as well
            added = block.against[:, largest]
        twice = (added[1:] > 0) == (added[:-1] > 0)
        assert (twice == (block.pulses[:-1, largest] != 0)).all() and 0.1 < twice.mean() < 0.9


def test_claim_15_a_count_of_feed_pulses_lets_the_interpolators_run() -> None:
    pulses = ResidueInterpolator().line(
        (4_000, 0, 0), Feed(feed_number(6_000, RECIRCULATIONS_HZ))
    )
    first = int(np.flatnonzero(pulses[:, 0])[0])
    fed = count_feed(first + 1, feed_number(6_000, RECIRCULATIONS_HZ), override_number(1.0))
    # nothing moves before the count has reached stage 6
    assert fed * FEED_EIGHTHS >= FOURTH // EIGHTH
    assert held((20_000, 0, 0)) == pytest.approx(1.0, rel=0.005)
    assert held((20_000, 0, 0), override=0.5) == pytest.approx(0.5, rel=0.005)


def test_claim_16_the_count_sets_how_often_the_gates_open() -> None:
    """Stage 6 is 4 units, stage 7 is 8; the count as it stood when the gate was decided."""
    seen = {"none": 0, "fourth": 0, "every": 0}
    for feed_mm_min in (600, 1200, 2400):
        blocks = played(HISTORIC_CONTROL, f"G1 X0 Y0 F{feed_mm_min}", "G1 X20 Y0", "G1 X0 Y1")
        recirculation = 1
        for block in (block for block in blocks if len(block.pulses)):
            taken = 20 * np.abs(block.pulses[:, 0]) + 8 * np.abs(block.pulses[:, 1])
            if np.abs(block.error[0]).argmax() == 1:
                taken = 8 * np.abs(block.pulses[:, 0]) + 20 * np.abs(block.pulses[:, 1])
            units = (block.counter[1:] + taken) / 8
            number = recirculation + np.arange(len(units))
            recirculation += len(units)
            fourth = (units >= 4) & (units < 8)
            expected = (units >= 8) | (fourth & (number % 4 == 0))
            assert (block.was_open == expected).all()
            seen["none"] += int((units < 4).sum())
            seen["fourth"] += int(fourth.sum())
            seen["every"] += int((units >= 8).sum())
    assert min(seen.values()) > 500


def test_claim_17_pulses_at_the_frequency_of_the_difference_between_command_and_position() -> (
    None
):
    # the axis is told to stand 12 counts further, and its motor is as good as stuck: only lag pulses come
    servo = PulseServo(gain_per_s=1e-9, lag_stages=10)
    servos = PulseServos(np.zeros(1, np.int64), RECIRCULATIONS_HZ, servo)
    servos.follow(np.ones((24, 1), np.int8))
    before = servos.count[0]
    servos.follow(np.zeros((10_240, 1), np.int8))
    assert (servos.count[0] - before) // 2 == pytest.approx(24 * 10_240 / 2**10, abs=1)


def test_claims_18_21_and_22_the_lag_is_added_to_itself_and_its_overflow_is_a_pulse() -> None:
    servos = PulseServos(
        np.zeros(1, np.int64), RECIRCULATIONS_HZ, PulseServo(gain_per_s=1e-9, lag_stages=5)
    )
    servos.follow(np.ones((10, 1), np.int8))
    count = servos.count[0]
    seen = []
    for _ in range(32):  # 10 half counts in 5 stages: an overflow in 3.2 recirculations
        servos.follow(np.zeros((1, 1), np.int8))
        seen.append(int(servos.count[0] - count))
    assert seen[-1] // 2 == 10 and max(np.diff(seen)) == 2


def test_claim_19_the_low_bits_of_the_command_join_the_high_bits_of_the_position() -> None:
    for position in range(-200, 200):
        for behind in range(-15, 17):
            assert unit_circuit(position, (position + behind) & 31, 5) == position + behind
    # on the run a number that is not the command is a fault: a motor that stands is found in time
    servos = PulseServos(np.zeros(1, np.int64), 6_000, HISTORIC_CONTROL.servo, 1)
    servos.conditions = [Condition(stuck=True)]
    assert (
        servos.follow(np.ones((100, 1), np.int8))[2] == 2 * 17 - 1
    )  # 16 counts are still right


def test_claim_20_the_difference_is_a_representation_of_the_lag() -> None:
    """The lag register gets command less position, in pulses, in each recirculation of a run."""
    servos = PulseServos(np.zeros(1, np.int64), 6_000, HISTORIC_CONTROL.servo, 1)
    lags = []
    for row in range(1_200):
        before, position = servos.lag_register[0], servos.position[0]
        servos.follow(np.full((1, 1), row < 300 and row % 3 == 0, np.int8))
        added = (servos.lag_register[0] - before + 16) % 32 - 16  # 5 stages: overflows at 32
        lags.append(servos.command[0] - position)
        assert added == lags[-1]
    assert max(lags) >= 4 and min(lags) < 0 and lags[-1] == 0


def crossings(block: Block) -> Iterator[tuple[slice, float, float, np.ndarray]]:
    """Parts of an arc: rows, crossed recirculations too many, E/2h by geometry, and the place there."""
    radius = math.dist(block.place[0, :2], block.centre)
    for first in range(0, len(block.pulses) - 400, 400):
        rows = slice(first, first + 400)
        opened = block.was_open[rows]
        crossed = int((opened & (block.ratio[:-1][rows] < 0)).sum())
        straight = int(opened.sum()) - crossed
        here = block.place[:-1][rows][opened][:, :2].mean(axis=0)
        chord = math.dist(here, block.end[:2])
        if chord > radius / 4 and opened.sum() > 60:
            twice_h = math.sqrt(4 * radius**2 - chord**2)
            yield rows, crossed - straight * chord / twice_h, chord / twice_h, here


def test_claim_23_the_tangent_is_the_chord_and_twice_the_perpendicular() -> None:
    """What enters the residues is, in the mean, E + A with A = E · E/2h at a right angle to E."""
    seen = 0
    for block in quarters():
        for rows, _, ratio, here in crossings(block):
            opened = block.was_open[rows]
            came = block.entered[rows][opened, :2].mean(axis=0) * (1 + ratio)
            chord = block.end[:2] - here
            across = block.sense * ratio * np.array([chord[1], -chord[0]])
            # 5 %: an error more or less crossed in 60
            assert math.dist(came, chord + across) < 0.05 * math.hypot(*came)
            radial = came @ (here - block.centre)
            assert abs(radial) < 0.05 * math.hypot(*came) * math.dist(here, block.centre)
            seen += 1
    assert seen > 10


@pytest.mark.parametrize("sense", [COUNTER_CLOCKWISE, CLOCKWISE])
def test_claim_24_errors_are_added_or_taken_by_the_sense_of_rotation(sense: int) -> None:
    start, end = (1_500, 0, 0), (0, 1_500 * sense, 0)
    pulses = ResidueInterpolator(start).arc(end, (0, 0), sense, ALWAYS)
    way = ways(pulses, start)
    turning = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
    assert turning[-1] == pytest.approx(sense * math.pi / 2)
    assert (np.diff(turning[::100]) * sense > 0).all()


def perpendicular(block: Block) -> np.ndarray:
    """2h of the axis with the smaller error, by equations X and XI, along an arc."""
    place, error = block.place[:-1, :2], block.error[:, :2]
    both = 2 * (block.centre - place) - error
    larger_x = np.abs(error[:, 0]) > np.abs(error[:, 1])
    return np.abs(np.where(larger_x, both[:, 1], both[:, 0]))


def test_claim_25_larger_error_and_smaller_perpendicular_choose_how_the_errors_go_in() -> None:
    """They are crossed E/2h times as often as not, with E and h from the circle's geometry."""
    for block in quarters():
        parts = [(too_many, ratio) for _, too_many, ratio, _ in crossings(block)]
        assert max(abs(too_many) for too_many, _ in parts) <= 2  # one at either end of a part
        # as the chord gets shorter fewer are crossed; at the start of a quarter as many as not
        assert parts[0][1] == pytest.approx(1, rel=0.1) and parts[-1][1] < 0.3


def test_claim_26_one_more_loop_takes_the_larger_and_adds_the_smaller() -> None:
    """Loop Q as it was compiled: - E_m where it is not negative, + 2h where it is, else as it was."""
    for block in quarters():
        largest = np.abs(block.error[:, :2]).max(axis=1)
        change = np.where(block.ratio[:-1] >= 0, -largest, perpendicular(block))
        assert (np.diff(block.ratio) == np.where(block.was_open, change, 0)).all()
        assert block.ratio.min() < 0 < block.ratio.max()


def test_claim_27_where_the_loop_is_positive_errors_go_to_their_own_circuits() -> None:
    for block in quarters():
        straight = block.was_open & (block.ratio[:-1] >= 0)
        assert (block.entered[straight, :2] == block.error[straight, :2]).all()
        assert straight.sum() > 500


def test_claim_28_where_it_is_negative_they_are_crossed_and_one_is_subtracted() -> None:
    for block in quarters():
        crossed = block.was_open & (block.ratio[:-1] < 0)
        to_x, to_y = block.entered[crossed, :2].T
        error_x, error_y = block.error[crossed, :2].T
        assert (to_x == block.sense * error_y).all() and (to_y == -block.sense * error_x).all()
        assert crossed.sum() > 200
