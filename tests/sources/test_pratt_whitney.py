"""Patent from US application 631 214 (Pratt & Whitney, 1967): its worked examples, and one test for each
claim.

`docs/background/claims-pratt-whitney.md` has the table from claim to test. Pulses are of 0.0005 in, position
counts of 0.001 in.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from morfax.motion.motion import MOTION_RATE_HZ, join
from morfax.player.gcode.feed_control import (
    BLOCKED,
    EIGHTH,
    EVERY,
    FEED_EIGHTHS,
    FOURTH,
    GREATEST,
    MIDDLE,
    SMALLEST,
    count_feed,
    feed_number,
    gate_opens,
    override_number,
    resultant_weights,
)
from morfax.player.gcode.pulse_servo import PulseServo, PulseServos, lag, unit_circuit
from morfax.player.gcode.pulses import PulseControl, PulsePlayback
from morfax.player.gcode.residues import (
    CLOCKWISE,
    COUNTER_CLOCKWISE,
    LINE,
    Feed,
    ResidueInterpolator,
)
from morfax.player.gcode.rs274 import parse_rs274

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
    """One recirculation of a residue loop, in words: the new residue, and the pulse (0 for none)."""
    now = residue + (error if gate_open else 0) + (total if residue < 0 else -total)
    return now, 0 if (now < 0) != (residue < 0) else (-1 if now < 0 else 1)


def residues(
    end: tuple[int, int, int], constant: int, feed: Feed, residue: int, cycles: int
) -> list[tuple[int, int]]:
    """Residue of X and its pulse after each of the first recirculations, of the compiled loop."""
    found = []
    whole = ResidueInterpolator(servo_constant=constant, guard=False).line(end, feed, residue)
    at, total = residue, constant + max(map(abs, end))
    place = np.zeros(3, np.int64)
    for cycle in range(1, cycles + 1):
        error = np.array(end) - place
        total = constant + int(np.abs(error).max())
        at, pulse = step(at, int(error[0]), total, cycle % feed.gate_period == 0)
        assert pulse == whole[cycle - 1, 0]
        place = place + whole[cycle - 1]
        found.append((at, pulse))
    return found


# --- worked examples


def test_table_1_row_by_row(vectors: Vectors) -> None:
    for row in vectors("pw_table1")["printed_rows"]:
        end, pulse = step(
            row["RR_start"], row["error"], row["addend_magnitude"], row["gate_open"]
        )
        assert (end, pulse or None) == (row["RR_end"], row["pulse"]), row["cycle"]


def test_table_1_as_a_run_with_one_rule(vectors: Vectors) -> None:
    run = vectors("pw_table1")["run_same_cycle_rule"]
    found = residues((-6, 0, 0), 4, Feed(gate_period=3), 5, 45)
    assert [end for end, _ in found] == [row["end"] for row in run["rows"]]
    assert (
        [cycle for cycle, (_, pulse) in enumerate(found, 1) if pulse]
        == run["pulse_cycles"]
        == [4, 9, 16, 21, 30, 45]
    )


def test_one_axis_never_pulses_the_wrong_way_and_always_arrives() -> None:
    for error in range(1, 25, 2):
        for constant in (1, 2, 4, 8):
            for at in range(1 - constant - error, constant + error, 4):
                for period in (1, 2, 3, 4, 5, 7):
                    residue, left, cycle = at, error, 0
                    while left and cycle < 4_000:
                        cycle += 1
                        residue, pulse = step(
                            residue, left, constant + left, cycle % period == 0
                        )
                        assert pulse >= 0
                        left -= pulse
                    assert left == 0


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


def test_the_unit_circuit(vectors: Vectors) -> None:
    for case in vectors("pw_unit_circuit")["cases"]:
        assert unit_circuit(case["position"], case["icr5"]) == case["interpolated"]
        assert lag(case["position"], case["icr5"]) == case["lag"]


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
    assert step(5, 0, 10, False) == (-5, 0) and step(-5, 0, 10, False) == (
        5,
        0,
    )  # left alone it alternates
    assert step(5, -6, 10, True) == (-11, 0) and step(-11, 0, 10, False) == (-1, -1)
    residues((50, 0, 0), 16, Feed(gate_period=3), 33, 200)  # the compiled loop does the same


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
    assert [gate_opens(count * EIGHTH, 1) for count in (0, 31, 32, 63, 64, 255)] == [
        False
    ] * 4 + [True] * 2
    assert gate_opens(FOURTH, 4) and not gate_opens(FOURTH - 1, 4) and gate_opens(EVERY, 3)


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
    # one axis from a residue that alternates evenly: a pulse needs RR + E - (L + E_m) >= 0 after so many
    # openings
    for constant in (1, 7, 60):
        pulses = ResidueInterpolator(servo_constant=constant, guard=False).line(
            (100, 0, 0), ALWAYS, residue=0
        )
        residue, cycle = 0, 0
        while True:
            cycle += 1
            residue, pulse = step(residue, 100, constant + 100, True)
            if pulse:
                break
        assert int(np.flatnonzero(pulses[:, 0])[0]) + 1 == cycle


def test_claim_11_errors_enter_in_selected_recirculations_and_a_sign_that_stays_is_found() -> (
    None
):
    for period in (1, 2, 3, 4):
        found = residues((40, 0, 0), 16, Feed(gate_period=period), 28, 100)
        signs = [28, *(residue for residue, _ in found)]
        assert [pulse != 0 for _, pulse in found] == [
            (a < 0) == (b < 0) for a, b in pairwise(signs)
        ]


def test_claim_12_a_train_of_pulses_for_each_axis() -> None:
    pulses = ResidueInterpolator().line((3_000, -2_000, 1_000), ALWAYS)
    assert set(np.unique(pulses)) == {-1, 0, 1}
    assert pulses.sum(axis=0).tolist() == [3_000, -2_000, 1_000]


def test_claim_13_each_train_drives_the_motor_of_its_axis() -> None:
    motion = join(
        PulsePlayback(parse_rs274(["G1 X0 Y0 Z0 F600", "G1 X3 Y-2 Z1", "M2"]), PulseControl())
    )
    assert motion.positions_mm[-1] == pytest.approx([3, -2, 1], abs=0.001)  # a pulse


def test_claim_14_the_sum_added_twice_with_one_sign_is_found() -> None:
    residue, total = 5, 10
    added = []
    for cycle in range(1, 5):
        added.append(-total if residue >= 0 else total)
        residue, pulse = step(residue, -6, total, cycle % 3 == 0)
    assert pulse == -1 and residue < 0  # so that the next sum has the sign of the one before
    assert added == [-10, 10, -10, 10]


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
    opened = {
        count: sum(gate_opens(count * EIGHTH, r) for r in range(64))
        for count in (31, 32, 64, 255)
    }
    assert opened == {31: 0, 32: 16, 64: 64, 255: 64}


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
            assert unit_circuit(position, (position + behind) & 31) == position + behind


def test_claim_20_the_difference_is_a_representation_of_the_lag() -> None:
    assert [lag(position, 7) for position in (0, 7, 20)] == [7, 0, -13]
    run = PulsePlayback(parse_rs274(["G1 X0 F900", "G1 X5", "M2"]), PulseControl())
    join(run)
    assert run.following_error_mm[0] > 5 * 0.001  # the table was behind its command by pulses


def test_claim_23_the_tangent_is_the_chord_and_twice_the_perpendicular() -> None:
    # in equations: V = E + A with A = E · E/2h turned by a right angle is the tangent at T, for any chord
    random = np.random.default_rng(23)
    for _ in range(200):
        radius, first, turn = (
            random.uniform(50, 4_000),
            random.uniform(0, 6.28),
            random.uniform(0.1, 3.0),
        )
        here, end = (
            radius * np.array([math.cos(a), math.sin(a)]) for a in (first, first + turn)
        )
        chord = end - here
        h = math.sqrt(radius**2 - chord @ chord / 4)
        ratio = math.hypot(*chord) / (2 * h)
        tangent = chord + ratio * np.array([chord[1], -chord[0]])
        assert tangent @ here == pytest.approx(0, abs=1e-6 * radius**2)
    # and as it is run
    pulses = ResidueInterpolator((2_000, 0, 0)).arc(
        (0, 2_000, 0), (0, 0), COUNTER_CLOCKWISE, ALWAYS
    )
    way = ways(pulses, (2_000, 0, 0))
    for first in range(0, len(way) - 300, 100):
        (x, y, _), step_by = way[first + 50], way[first + 100] - way[first]
        assert abs(step_by[0] * x + step_by[1] * y) <= 0.08 * np.hypot(x, y) * np.hypot(
            *step_by[:2]
        )


@pytest.mark.parametrize("sense", [COUNTER_CLOCKWISE, CLOCKWISE])
def test_claim_24_errors_are_added_or_taken_by_the_sense_of_rotation(sense: int) -> None:
    start, end = (1_500, 0, 0), (0, 1_500 * sense, 0)
    pulses = ResidueInterpolator(start).arc(end, (0, 0), sense, ALWAYS)
    way = ways(pulses, start)
    turning = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
    assert turning[-1] == pytest.approx(sense * math.pi / 2)
    assert (np.diff(turning[::100]) * sense > 0).all()


def parts_of_an_arc() -> tuple[list[bool], list[int], list[int]]:
    """Loop Q along an arc, worked out beside the compiled one: whether straight, E_m taken, 2h added."""
    start, end, centre = (1_000, 0, 0), (0, 1_000, 0), (0, 0)
    way = ways(ResidueInterpolator(start).arc(end, centre, COUNTER_CLOCKWISE, ALWAYS), start)
    ratio, straight, taken, added = 0, [], [], []
    for x, y, _ in way[:-1].tolist():
        error, largest = (end[0] - x, end[1] - y), max(abs(end[0] - x), abs(end[1] - y))
        straight.append(ratio >= 0)
        if ratio >= 0:
            ratio -= largest
            taken.append(largest)
        else:
            other = 1 if abs(error[0]) > abs(error[1]) else 0
            perpendicular = abs(2 * (centre[other] - (x, y)[other]) - error[other])
            ratio += perpendicular
            added.append(perpendicular)
    return straight, taken, added


def test_claim_25_larger_error_and_smaller_perpendicular_choose_how_the_errors_go_in() -> None:
    straight, _, _ = parts_of_an_arc()
    first, last = straight[:300], straight[-300:]
    assert sum(first) < sum(
        last
    )  # as the chord gets shorter its perpendicular grows, and fewer errors are crossed
    # at the start of a quarter E_m / 2h_n is 1: as many crossed as straight
    assert sum(first) == pytest.approx(len(first) / 2, rel=0.15)


def test_claim_26_one_more_loop_takes_the_larger_and_adds_the_smaller() -> None:
    _, taken, added = parts_of_an_arc()
    assert sum(taken) == pytest.approx(
        sum(added), abs=max(taken) + max(added)
    )  # the loop stays about zero


def test_claims_27_and_28_straight_where_it_is_positive_crossed_and_one_negative_where_not() -> (
    None
):
    # E = (-1000, 1000) at the start of a quarter turn: Q = 0 is positive, so both go to their own axes
    straight, _, _ = parts_of_an_arc()
    assert straight[:2] == [True, False]
    # straight (-1000, 1000), then crossed (1000, 1000): X has none left, Y twice as much, the tangent at
    # (1000, 0)
    pulses = ResidueInterpolator((1_000, 0, 0)).arc(
        (0, 1_000, 0), (0, 0), COUNTER_CLOCKWISE, ALWAYS
    )[:40]
    assert abs(int(pulses[:, 0].sum())) <= 2 and int(pulses[:, 1].sum()) >= 35
    # the other way round the other one is negative
    other = ResidueInterpolator((1_000, 0, 0)).arc((0, -1_000, 0), (0, 0), CLOCKWISE, ALWAYS)[
        :40
    ]
    assert abs(int(other[:, 0].sum())) <= 2 and int(other[:, 1].sum()) <= -35
