"""Patent US 3062995 (SEA, Raymond and Jeudon, 1957): its tables and figures, and one test for each claim.

`docs/background/claims-sea.md` has the table from claim to test.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.contour import distance
from morfax.motion.faults import LockFault
from morfax.motion.motion import join, thin
from morfax.player.cubics.cubic import Servo, play_cubic
from morfax.player.cubics.interpolator import (
    CubicInterpolator,
    TimeBase,
    ends,
    table,
    truncated_end,
)
from morfax.player.cubics.scales import Scales, gated_pulses, joined, read_scales
from morfax.player.cubics.stores import Store, Stores
from morfax.recorder.cubics.cubics import differences, record_cubics
from morfax.recorder.cubics.file import CubicFormat, read_program
from tests.recorder.steps.test_steps import circle

Vectors = Callable[[str], Any]

UM = 1e-3
ORBIT = circle(5, 10)


@pytest.fixture(scope="module")
def orbit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A circle of 5 mm at 10 mm/s, as a cubic program."""
    file = tmp_path_factory.mktemp("sea") / "orbit.cubic"
    record_cubics(ORBIT, file)
    return file


# worked examples


def test_table_i(vectors: Vectors) -> None:
    told = vectors("sea_table1")
    words = (told["D1"], told["D2"], told["D3"])
    rows = table(told["x"], words, 8)
    assert [list(row) for row in rows] == told["rows"]
    stores = Stores((told["x"], *words), width=16)
    for row in told["rows"][1:]:
        stores.round()
        assert list(stores.words) == row


def test_the_order_of_the_text_is_not_table_i(vectors: Vectors) -> None:
    """IV into III, and the new III into II: the rows that the text's order would give."""
    told = vectors("sea_table1")["order_error"]["rows_literal_order"]
    one, two, three, four = told[0]
    for row in told[1:]:
        one, three = one + two, three + four
        two += three
        assert [one, two, three, four] == row
    assert told != vectors("sea_table1")["rows"]


def test_relation_vi_is_the_table(vectors: Vectors) -> None:
    told = vectors("sea_table1")
    words = np.array([[[told["D1"], told["D2"], told["D3"]]]])
    for points in (2, 4, 8):
        assert told["x"] + ends(words, points)[0, 0] == told["rows"][points][0]


@pytest.mark.parametrize("case", range(8))
def test_the_differences_of_a_cubic_are_exact_in_3_log2_p_digits(
    vectors: Vectors, case: int
) -> None:
    told = vectors("sea_hermite")["cases"][case]
    sample = np.array([[[told["x1"], told["tangent1"]]], [[told["x2"], told["tangent2"]]]])
    words = differences(sample, told["steps"])
    assert words[0, 0].tolist() == [told["D1"], told["D2"], told["D3"]]
    assert CubicInterpolator.digits_for(told["steps"]) == told["frac_bits"]
    run = CubicInterpolator(np.array([told["x1"]]), told["steps"]).run(words)[:, 0]
    exact = [Fraction(int(one), 2 ** told["frac_bits"]) for one in run]
    assert [float(x) for x in exact] == told["x_at_p"][1:]
    assert exact[-1] == told["end"]


def test_registers_with_fewer_digits_end_beside_it(vectors: Vectors) -> None:
    """The patent's narrower registers, on random cubics with the vectors' bounds: never worse than told, and
    nearly so.
    """
    told = vectors("sea_hermite")["truncated_register_worst_end_error_counts"]
    rng = np.random.default_rng(1957)
    for name, worst in told.items():
        steps, *digits = (
            int("".join(filter(str.isdigit, part)))
            for part in name.split("_")
            if part != "frac"
        )
        cubics = np.stack(
            [rng.integers(-2000, 2001, (400, 2)), rng.integers(-4000, 4001, (400, 2))], axis=-1
        )
        off = []
        for sample in cubics:
            words = differences(sample[:, None], steps)[0, 0].tolist()
            ended = truncated_end(int(sample[0, 0]), tuple(words), steps, tuple(digits))
            off.append(abs(ended - sample[1, 0]))
        assert max(off) <= worst * 1.05 and (max(off) > 0.7 * worst or worst == 0), name


def test_the_time_base_of_figure_3(vectors: Vectors) -> None:
    told, base = vectors("sea_timebase"), TimeBase()
    assert base.carrier_hz == told["resolver_carrier_hz"]
    assert base.counts_per_period == told["counts_per_resolver_period"]
    assert base.word_hz == told["word_rate_hz"] and base.reading_hz == told["reading_sync_hz"]
    assert base.step_hz == told["interpolation_rate_hz"]
    assert base.steps_per_block == told["interpolations_per_tape_block"]
    assert base.block_s == pytest.approx(told["tape_block_period_s"])


def test_coarse_and_fine_are_joined_as_told(vectors: Vectors) -> None:
    for case in vectors("sea_coarse_fine")["cases"]:
        fine, coarse = read_scales(np.array([float(case["X"])]), Scales(64))
        assert (fine[0], coarse[0]) == (case["fine"], case["coarse_read"])
        assert fine[0] >> 5 == case["fine_msb"]
        assert joined(fine, coarse, 64)[0] == case["combined"] == case["X"]


def test_the_coarse_scale_may_be_late_by_one_digit_at_most(vectors: Vectors) -> None:
    position = np.arange(0, 39 * 64, dtype=float)
    for lag, right in vectors("sea_coarse_fine")["lag_in_coarse_LSB_vs_correct"].items():
        codes = joined(*read_scales(position, Scales(64, lag_digits=float(lag))), 64)
        assert (codes == position).all() == right, lag


# claims


def test_claim_1_program_interpolator_measurement_comparison_and_drive(orbit: Path) -> None:
    """The whole loop runs the curve; four stores in cascade, p in the program; smooth from one set to the
    next.
    """
    playback = play_cubic(orbit)
    assert distance(thin(playback), ORBIT).hausdorff_mm < 4 * UM
    assert playback.format.points in (16, 32, 64, 128, 256, 512, 1024, 2048)
    stores = Stores((1000, 37, -5, 2), width=16)
    stores.round(gate_2=False, gate_3=False)
    assert stores.words == (1037, 37, -5, 2)
    stores.round(gate_1=False, gate_3=False)
    assert stores.words == (1037, 32, -5, 2)


def test_claim_2_a_switch_makes_all_steps_cubic_or_one_in_q(tmp_path: Path) -> None:
    files = {
        q: record_cubics(ORBIT, tmp_path / f"{q}.cubic", fmt=CubicFormat(linear=q)).file
        for q in (1, 4)
    }
    bends = {}
    for q, file in files.items():
        program = read_program(file)
        run = CubicInterpolator(np.array(program.checks[0]), 64, q).run(program.words)
        bends[q] = np.diff(run, 2, axis=0)[:60, 0] != 0
        assert (run[63::64][-1] >> 18 == program.checks[len(program.words)]).all()
    assert bends[1].all() and bends[4].sum() == 15  # one step in four changes the speed


def test_claim_3_a_coarse_and_a_fine_encoder_make_one_code() -> None:
    position = np.arange(-5000.0, 5000.0)
    fine, coarse = read_scales(position, Scales(64))
    assert fine.max() == 63 and np.ptp(coarse) == pytest.approx(10000 / 32, abs=1)
    assert (joined(fine, coarse, 64) == position).all()


def test_claim_4_one_is_added_to_the_coarse_code_where_the_digits_differ() -> None:
    assert (
        joined(np.array([32]), np.array([20]), 64)
        == joined(np.array([32]), np.array([21]), 64)
        == 672
    )
    assert (
        joined(np.array([31]), np.array([19]), 64)
        == joined(np.array([31]), np.array([20]), 64)
        == 671
    )


def test_claim_5_a_gate_passes_fast_pulses_as_long_as_the_phase_is() -> None:
    base = TimeBase()
    counted = [gated_pulses(place / 64, base) for place in range(64)]
    assert counted == list(range(64))
    assert gated_pulses(1.25, base) == 16


def test_claim_6_the_register_of_the_difference_has_few_digits(orbit: Path) -> None:
    join(play_cubic(orbit, servo=Servo(register_digits=8)))  # 50 um of lag is 100 counts
    with pytest.raises(LockFault, match=r"allowed ±0\.032 mm"):
        join(play_cubic(orbit, servo=Servo(register_digits=6)))


def test_claim_7_the_decoder_s_ratio_is_set_apart_from_the_difference(orbit: Path) -> None:
    lags = []
    for modulus in (50.0, 100.0, 200.0):
        playback = play_cubic(orbit, servo=Servo(modulus_per_s=modulus))
        join(playback)
        lags.append(max(playback.following_error_mm) * modulus)
    assert lags == pytest.approx([10, 10, 10], rel=0.05)  # mm/s


def test_claim_8_the_program_holds_the_ratio(tmp_path: Path) -> None:
    for modulus in (80.0, 160.0):
        record_cubics(
            ORBIT, tmp_path / "a.cubic", fmt=CubicFormat(points=256, modulus_per_s=modulus)
        )
        playback = play_cubic(tmp_path / "a.cubic")
        join(playback)
        assert max(playback.following_error_mm) == pytest.approx(10 / modulus, rel=0.05)


def test_claim_9_each_store_needs_fewer_digits_than_the_one_before(orbit: Path) -> None:
    program = read_program(orbit)
    largest = [
        np.abs(
            CubicInterpolator(np.array(program.checks[0]), program.format.points).run(
                program.words
            )
        ).max()
    ]
    largest += np.abs(program.words).max(axis=(0, 1)).tolist()
    digits = [int(word).bit_length() for word in largest]
    assert digits == sorted(digits, reverse=True) and len(set(digits)) == 4


@given(st.tuples(*[st.integers(-(2**20), 2**20)] * 4), st.integers(1, 20))
def test_claim_10_the_stores_recirculate(words: tuple[int, int, int, int], steps: int) -> None:
    stores = Stores(words, width=64)
    for _ in range(3):
        stores.round(False, False, False)
        assert stores.words == words  # nothing but time has passed
    for _ in range(steps):
        stores.round()
    assert stores.words == table(words[0], words[1:], steps)[-1]
    with pytest.raises(ValueError, match="does not fit in 8 digits"):
        Store.of(128, 8)


def test_every_claim_stands_in_the_table() -> None:
    lines = (
        (Path(__file__).parents[2] / "docs" / "background" / "claims-sea.md")
        .read_text(encoding="utf-8")
        .splitlines()
    )
    rows = [line.split("|") for line in lines if line.startswith("| ") and line[2].isdigit()]
    assert [int(row[1]) for row in rows] == list(range(1, 11))
    for row in rows:
        assert row[3].strip().strip("`") in globals()
