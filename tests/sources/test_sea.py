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

from morfax.motion.faults import Fault, LockFault
from morfax.motion.motion import join
from morfax.player.cubics.cubic import HISTORIC, play_cubic
from morfax.player.cubics.interpolator import CubicInterpolator, ends
from morfax.player.cubics.scales import Scales, gated_pulses, joined
from morfax.player.cubics.servo import Servo
from morfax.player.cubics.stores import LENGTHS, circulate, content, write
from morfax.player.cubics.time_base import TimeBase
from morfax.recorder.cubics.cubics import differences, record_cubics
from morfax.recorder.cubics.file import CubicFormat, read_program
from tests.console.conftest import Morfax
from tests.player.cubics.registers import codes, table, truncated_end
from tests.recorder.steps.paths import circle

Vectors = Callable[[str], Any]

UM = 1e-3
ORBIT = circle(5, 10)


@pytest.fixture(scope="module")
def orbit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A circle of 5 mm at 10 mm/s, as a cubic program."""
    file = tmp_path_factory.mktemp("sea") / "orbit.cubic"
    record_cubics(ORBIT, file)
    return file


def loaded(words: tuple[int, ...]) -> np.ndarray:
    """The four stores of the historic control with these words."""
    stores = np.zeros((4, LENGTHS[0]), np.int64)
    for i, word in enumerate(words):
        write(stores[i], LENGTHS[i], word)
    return stores


def circulated(
    stores: np.ndarray, gates: tuple[bool, bool, bool] = (True, True, True)
) -> list[int]:
    """What the stores hold when their digits have come round once."""
    circulate(stores, np.array(LENGTHS), gates)
    return [int(content(stores[i], LENGTHS[i])) for i in range(4)]


# worked examples


def test_table_i(vectors: Vectors) -> None:
    told = vectors("sea_table1")
    words = (told["D1"], told["D2"], told["D3"])
    rows = table(told["x"], words, 8)
    assert [list(row) for row in rows] == told["rows"]
    stores = loaded((told["x"], *words))
    for row in told["rows"][1:]:
        assert circulated(stores) == row


@pytest.mark.parametrize(
    ("rows", "before"), [("rows_literal_order", 0), ("rows_literal_with_D2_minus_D3", 1)]
)
def test_the_order_of_the_text_is_not_table_i(vectors: Vectors, rows: str, before: int) -> None:
    """IV into III, and the new III into II: other rows than the stores', and the same places only if the
    tape held A² less A³.
    """
    told = vectors("sea_table1")
    literal = told["order_error"][rows]
    one, two, three, four = literal[0]
    for row in literal[1:]:
        one, three = one + two, three + four
        two += three
        assert [one, two, three, four] == row
    stores = loaded((told["x"], told["D1"], told["D2"], told["D3"]))
    built = [[told["x"], told["D1"], told["D2"], told["D3"]]]
    built += [circulated(stores) for _ in literal[1:]]
    assert built == told["rows"] != literal
    assert ([row[0] for row in built] == [row[0] for row in literal]) is bool(before)
    assert told["order_error"]["equal_x"]


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


# claims


def test_claim_1_program_interpolator_measurement_comparison_and_drive(
    orbit: Path, here: Path, morfax: Morfax
) -> None:
    """The whole loop of the patent runs the curve; the program holds p, which is the points run."""
    assert morfax("play", orbit, "--historic", "--raw", "-o", "orbit.csv").exit_code == 0
    t_s, x_mm, y_mm = np.loadtxt("orbit.csv", delimiter=",", skiprows=1, usecols=(0, 1, 2)).T
    program = read_program(orbit)
    step_s = 16 * 2 * 16 / 3500  # figure 3
    assert np.diff(t_s) == pytest.approx(step_s, rel=1e-6)
    rests = 60  # the lag runs off: 15 time constants of 4 points
    assert len(t_s) == 1 + len(program.words) * program.format.points + rests
    off = np.abs(np.hypot(x_mm, y_mm - 5) - 5)
    assert off.max() < 3 * UM  # two of the fit, two counts of half a um


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


def played_with(scales: Scales, orbit: Path) -> np.ndarray:
    """Places of the historic machine along the orbit with these scales."""
    return join(play_cubic(orbit, servo=Servo(scales=scales), historic=True)).positions_mm


def test_claim_3_a_coarse_and_a_fine_encoder_make_one_code(orbit: Path) -> None:
    position = np.arange(-5000.0, 5000.0)
    fine, coarse, code = codes(position, HISTORIC.scales).T
    assert fine.max() == 63 and np.ptp(coarse) == pytest.approx(10000 / 32, abs=1)
    assert (code == position).all()
    # and the machine runs on them: 313 pitches of 32 um in 10 mm
    places = played_with(HISTORIC.scales, orbit)
    assert np.ptp(places[:, 0]) == pytest.approx(10, abs=3 * UM)


def test_claim_4_one_is_added_to_the_coarse_code_where_the_digits_differ(orbit: Path) -> None:
    assert joined(32, 20, 64) == joined(32, 21, 64) == 672
    assert joined(31, 19, 64) == joined(31, 20, 64) == 671
    # so a coarse scale may be late by up to a digit, and beyond it the machine is lost
    right = played_with(HISTORIC.scales, orbit)
    assert (played_with(Scales(64, lag_digits=0.1), orbit) == right).all()
    assert (played_with(Scales(64, lag_digits=0.9), orbit) == right).all()
    with pytest.raises(Fault):
        played_with(Scales(64, lag_digits=1.4), orbit)


def test_claim_5_a_gate_passes_fast_pulses_as_long_as_the_phase_is(orbit: Path) -> None:
    base = play_cubic(orbit, historic=True).base
    counted = [gated_pulses(place / 64, base.carrier_hz, base.fast_hz) for place in range(64)]
    assert counted == list(range(64))
    assert gated_pulses(1.25, base.carrier_hz, base.fast_hz) == 16
    # the machine's readings are those of its time base: half the pulses a second, half the counts
    slow = TimeBase(fast_hz=1750.0)
    assert [gated_pulses(x / 64, base.carrier_hz, slow.fast_hz) for x in (8, 40)] == [4, 20]


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
    assert list(LENGTHS) == sorted(set(LENGTHS), reverse=True)
    program, fmt = read_program(orbit), play_cubic(orbit).format
    whole, stores = (
        CubicInterpolator(np.array(program.checks[0]), fmt.points, historic=historic)
        for historic in (False, True)
    )
    # the shorter stores run the program as whole words of 64 bits do, to the last digit
    assert (stores.run(program.words) == whole.run(program.words)).all()
    assert (program.words < 0).any()  # a shorter store hands on its sign


@given(st.tuples(*[st.integers(-(2**20), 2**20)] * 4), st.integers(1, 20))
def test_claim_10_the_stores_recirculate(words: tuple[int, int, int, int], steps: int) -> None:
    stores = loaded(words)
    for _ in range(3):  # nothing but time has passed
        assert circulated(stores, (False, False, False)) == list(words)
    found = [circulated(stores) for _ in range(steps)][-1]
    assert tuple(found) == table(words[0], words[1:], steps)[-1]


def test_claim_10_each_gate_lets_one_store_into_the_next() -> None:
    stores = loaded((1000, 37, -5, 2))
    assert circulated(stores, (True, False, False)) == [1037, 37, -5, 2]
    assert circulated(stores, (False, True, False)) == [1037, 32, -5, 2]
    assert circulated(stores, (False, False, True)) == [1037, 32, -3, 2]


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
