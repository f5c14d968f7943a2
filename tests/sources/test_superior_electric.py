"""Patent ES 443122 (Superior Electric, 1975): one test for each claim.

`docs/background/claims-superior-electric.md` has the table from claim to test.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from morfax.motion.motion import join
from morfax.player.steps.stepping import (
    decode,
    play_steps,
    pulses_of,
    tick_table,
)
from morfax.recorder.steps.file import (
    StepFormat,
    read_program,
    write_program,
)
from morfax.recorder.steps.rings import RINGS
from morfax.recorder.steps.steps import encode
from tests.console.conftest import SAMPLES, Morfax
from tests.sources.step_orders import (
    INTO_RING_OF_SIX,
    LINEAR,
    NEXT,
    PREVIOUS,
    REPEAT,
    SAME,
    X_DOWN,
    X_UP,
    counts,
    program,
    pulses_in,
)

Vectors = Callable[[str], Any]


def test_claim_1_pulses_at_the_rate_that_the_order_names_until_the_next_order() -> None:
    assert pulses_in([X_UP, X_UP, X_DOWN]) == [[1, 0], [2, 0], [1, 0]]
    assert (
        len({pulses_of(np.array([[count]], np.int8), LINEAR)[0, 0] for count in range(1, 16)})
        == 15
    )


def test_claim_2_the_next_rate_begins_with_its_order(tmp_path: Path) -> None:
    write_program(
        program([X_UP, X_UP, X_DOWN, X_DOWN], end_mm=(0.04, 0, 0)), tmp_path / "a.steps"
    )
    playback = play_steps(tmp_path / "a.steps")
    x = join(playback).positions_mm[:, 0]
    assert x[[0, 8, 16, 24, 32]] == pytest.approx(
        [0, 0.01, 0.03, 0.04, 0.04]
    )  # at the ends of the intervals


def test_claim_3_an_order_is_the_difference_between_two_representations() -> None:
    for before in range(6):
        rows = [X_UP] * before
        assert counts([*rows, X_UP])[-1][0] - (8 + before) == 1


def test_claim_4_in_one_direction_a_higher_rate_has_a_higher_number() -> None:
    forward = pulses_of(np.arange(9, 16, dtype=np.int8)[:, None], LINEAR)[:, 0]
    assert (forward > 0).all() and (np.diff(np.abs(forward)) > 0).all()


def test_claim_5_in_the_other_a_lower_rate_has_a_higher_number() -> None:
    backward = pulses_of(np.arange(1, 8, dtype=np.int8)[:, None], LINEAR)[:, 0]
    assert (backward < 0).all() and (np.diff(np.abs(backward)) < 0).all()


def test_claims_6_and_7_each_rate_has_one_count_of_a_counter() -> None:
    """Seven to one: figure 2, minus lines; eight: none; nine to fifteen: plus lines, growing."""
    by_count = pulses_of(np.arange(1, 16, dtype=np.int8)[:, None], LINEAR)[:, 0]
    assert by_count.tolist() == list(range(-7, 8))


def test_claim_8_the_count_itself_can_be_the_order(here: Path, morfax: Morfax) -> None:
    """A path recorded with counts for orders: what is punched is each count, and it plays as told."""
    assert morfax("record", SAMPLES / "cam.csv", "-o", "d.steps").exit_code == 0
    made = morfax(
        "record", SAMPLES / "cam.csv", "-o", "c.steps", "--orders", "counts", "--json"
    )
    with_counts, with_differences = read_program("c.steps"), read_program("d.steps")
    told, _ = decode(with_differences)
    assert (decode(with_counts)[0] == told).all()
    nibbles = with_counts.rows[:, None] >> np.array([0, 4, 8]) & 15
    assert (nibbles == told).all() and len(np.unique(told)) > 10
    played = [morfax("play", name, "--json").figures for name in ("c.steps", "d.steps")]
    assert played[0]["end_place_mm"] == played[1]["end_place_mm"]
    assert played[0]["duration_s"] == played[1]["duration_s"]
    assert made.figures["end_place_mm"] == pytest.approx(played[0]["end_place_mm"], abs=0.01)


def test_claim_8_a_count_beyond_its_neighbour_is_refused(here: Path, morfax: Morfax) -> None:
    rows = [0x889, 0x88A, 0x88C, 0x88A, 0x889, 0x888]
    write_program(program(rows, vectors=0, channels=13), "jump.steps")
    assert "counts [12, 8, 8]; they must be 1 to 15" in morfax("play", "jump.steps").fault


def test_claim_9_the_next_order_is_the_difference_of_the_counts() -> None:
    lengths = np.array([[1, 0, 0], [1, -1, 0], [0, -1, 0]])
    rows = encode(lengths, np.zeros(3, bool), StepFormat(vectors=1, channels=5))
    assert [f"{row:05b}" for row in rows] == ["10001", "11000", "10010"]


def test_claim_10_the_choice_is_one_up_one_down_or_the_same() -> None:
    for code in range(4):
        (after,) = counts([0b10000 | code])
        assert after[0] - 8 in (-1, 0, 1)
    with pytest.raises(ValueError, match="more than one step"):
        encode(np.array([[2, 0, 0]]), np.zeros(1, bool), StepFormat())


def test_claim_11_two_axes_run_in_the_same_interval() -> None:
    assert pulses_in([0b11001]) == [[1, -1]]


def test_claim_12_orders_of_both_axes_are_stored_together_and_taken_at_the_end_of_the_pulses(
    tmp_path: Path,
) -> None:
    rows = [0b10101, 0b10101, 0b11010, 0b11010]
    write_program(program(rows, end_mm=(0.04, 0.04, 0)), tmp_path / "a.steps")
    motion = join(play_steps(tmp_path / "a.steps")).positions_mm
    assert (motion[:, 0] == motion[:, 1]).all()
    assert motion[8::8, 0] == pytest.approx(
        [0.01, 0.03, 0.04, 0.04]
    )  # all pulses of an order before the next


ALL_RATES = [X_UP] * 7 + [SAME] * 90 + [X_DOWN] * 7


def steps_by_time(
    rows: list[int], interval_s: float, morfax: Morfax, oscillator_hz: float = 10240
) -> list[int]:
    """Steps of X that the machine has made in each stretch of that many seconds, by the times of its path."""
    end_mm = (0.01 * sum(pulses[0] for pulses in pulses_in(rows)), 0, 0)
    write_program(program(rows, end_mm=end_mm, oscillator_hz=oscillator_hz), "a.steps")
    assert morfax("play", "a.steps", "--raw", "-o", "a.csv").exit_code == 0
    t_s, x_mm = np.loadtxt("a.csv", delimiter=",", skiprows=1, usecols=(0, 1)).T
    made = np.rint(np.diff(x_mm) / 0.01).astype(int)
    # a step in a sample came before it; half a tick for the rounding of the times
    stretch = np.ceil((t_s[1:] - interval_s / 128) / interval_s).astype(int) - 1
    found = np.bincount(stretch, made, minlength=len(rows))
    return np.rint(found).astype(int).tolist()


@pytest.mark.parametrize("clock", [0, 1])
def test_claim_13_the_interval_is_the_same_for_every_order(
    vectors: Vectors, clock: int, here: Path, morfax: Morfax
) -> None:
    """By the path's own times: each order's pulses come within its stretch of 1/160 s (1/120 s)."""
    told = vectors("se_clock")["cases"][clock]
    found = steps_by_time(ALL_RATES, told["interval_s"], morfax, told["oscillator_hz"])
    assert found == [*range(1, 8), *[7] * 90, *range(6, -1, -1)]


def test_claim_14_each_rate_gives_a_whole_number_of_pulses() -> None:
    table = tick_table()
    assert [table[rate, 64] for rate in LINEAR] == list(LINEAR)
    assert table.dtype == np.int64


def test_claim_15_the_rates_differ_by_one_pulse(here: Path, morfax: Morfax) -> None:
    found = steps_by_time(ALL_RATES, 1 / 160, morfax)
    assert np.diff([0, *found[:7]]).tolist() == [1] * 7  # each rate gives one pulse more
    assert np.diff(found[-8:]).tolist() == [-1] * 7


def test_claim_16_an_order_of_a_vector_gives_its_extents_on_both_axes() -> None:
    assert pulses_in([*INTO_RING_OF_SIX, NEXT, NEXT, NEXT])[-3:] == [[6, -1], [6, -2], [5, -3]]


def test_claim_17_an_order_is_a_difference_of_places_in_the_endless_series() -> None:
    ring = RINGS[6]
    run = pulses_in([*INTO_RING_OF_SIX, *[NEXT] * 40])[6:]
    assert run == [
        list(ring[(k + 1) % len(ring)]) for k in range(40)
    ]  # past the end it begins again


def test_claim_18_the_same_vector_the_one_before_or_the_one_after() -> None:
    present = [*INTO_RING_OF_SIX, NEXT]
    after = [pulses_in([*present, order])[-1] for order in (PREVIOUS, REPEAT, NEXT, 0b00011)]
    assert after == [[6, 0], [6, -1], [6, -2], [6, -1]]


def test_claim_19_there_are_rings_of_several_speeds() -> None:
    assert sorted(RINGS) == [2, 3, 4, 5, 6, 7]
    for speed, ring in RINGS.items():
        lengths = np.hypot(*np.array(ring).T)
        assert np.abs(lengths - speed).max() <= 0.5  # steps


def test_claim_20_no_vector_is_like_any_other() -> None:
    every = [vector for ring in RINGS.values() for vector in ring]
    assert len(set(every)) == len(every) == 148


def test_claim_21_bit_5_tells_a_vector_from_extents() -> None:
    assert pulses_in([*INTO_RING_OF_SIX, NEXT])[-1] == [6, -1]
    assert pulses_in([*INTO_RING_OF_SIX, NEXT | 0b10000])[-1] == [5, 0]


def test_claim_22_a_vector_is_only_taken_where_the_extents_are_one() -> None:
    assert pulses_in([X_UP, NEXT, PREVIOUS, REPEAT])[1:] == [[1, 0]] * 3  # (1, 0) is in no ring
    assert pulses_in([X_UP, X_UP, NEXT])[-1] == [2, -1]


@pytest.mark.parametrize("speed", [2, 3, 4, 5, 6, 7])
def test_claim_23_the_present_vector_tells_the_ring(speed: int) -> None:
    assert pulses_in([*[X_UP] * speed, NEXT])[-1] == list(RINGS[speed][1])
    assert pulses_in([*[X_UP] * speed, PREVIOUS])[-1] == list(RINGS[speed][-1])


def test_claim_24_a_second_vector_waits_while_the_first_is_run() -> None:
    """Figure 11: bits 2, 1 are the first vector's, bits 4, 3 the second's; a row lasts two intervals."""
    both = pulses_in([*INTO_RING_OF_SIX, NEXT | NEXT << 2, PREVIOUS << 2], vectors=2)
    assert both[6:] == [[6, -1], [6, -2], [6, -2], [6, -1]]


def test_claim_25_two_bits_for_the_same_a_lower_and_a_higher_speed() -> None:
    assert pulses_in([X_UP, X_UP, SAME, X_DOWN]) == [[1, 0], [2, 0], [2, 0], [1, 0]]


def test_claim_28_the_difference_is_a_whole_number_of_increments() -> None:
    steps = np.array(pulses_in([X_UP, X_UP, X_UP, 0b11001, X_DOWN, 0b10110]))
    assert steps.dtype.kind == "i" and set(np.diff(steps, axis=0).ravel().tolist()) <= {
        -1,
        0,
        1,
    }


def test_claims_29_and_32_the_difference_is_one_of_places_in_the_order_of_the_rates() -> None:
    rates = (1, 3, 5, 7, 8, 9, 10)
    assert [x for x, _ in pulses_in([X_UP] * 7 + [X_DOWN], rates=rates)] == [*rates, 9]


def test_claim_30_the_rates_may_differ_by_a_constant_number() -> None:
    assert [x for x, _ in pulses_in([X_UP] * 7, rates=(2, 4, 6, 8, 10, 12, 14))] == [
        2,
        4,
        6,
        8,
        10,
        12,
        14,
    ]


def test_claim_33_the_rates_are_in_the_order_of_their_speed() -> None:
    faster = [x for x, _ in pulses_in([X_UP] * 7)]
    assert faster == sorted(faster)


def test_claims_38_and_39_neighbours_in_a_ring_differ_by_one_on_an_axis_at_most() -> None:
    for ring in RINGS.values():
        closed = np.array([*ring, ring[0]])
        assert np.abs(np.diff(closed, axis=0)).max() == 1


def test_every_claim_stands_in_the_table() -> None:
    table = (
        Path(__file__).parents[2] / "docs" / "background" / "claims-superior-electric.md"
    ).read_text(encoding="utf-8")
    rows = [
        line.split("|")
        for line in table.splitlines()
        if line.startswith("| ") and line[2].isdigit()
    ]
    assert [int(row[1]) for row in rows] == list(range(1, 40))
    for row in rows:
        assert row[3].strip().strip("`") in globals()
