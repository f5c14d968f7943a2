"""Patent from US application 631 214 (Pratt & Whitney, 1967): one test for each claim on lines, feeds and
servos; claims on arcs and worked examples have files of their own.

`docs/background/claims-pratt-whitney.md` has the table from claim to test. Pulses are of 0.0005 in, position
counts of 0.001 in.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from morfax.motion.drive import Condition
from morfax.player.gcode.feed_control import (
    BLOCKED,
    EIGHTH,
    FEED_EIGHTHS,
    FOURTH,
    count_feed,
    feed_number,
    override_number,
    resultant_weights,
)
from morfax.player.gcode.pulse_servo import (
    PulseServo,
    PulseServos,
    unit_circuit,
)
from morfax.player.gcode.pulses import HISTORIC_CONTROL
from morfax.player.gcode.residues import (
    LINE,
    Feed,
    ResidueInterpolator,
)
from tests.console.conftest import Morfax
from tests.sources.pulse_registers import (
    ALWAYS,
    RECIRCULATIONS_HZ,
    oblique,
    played,
    quarters,
    read,
    step,
    ways,
)


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
