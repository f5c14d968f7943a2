"""The cubic control: registers, scales and servo."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.contour import distance
from morfax.motion.drive import Condition
from morfax.motion.faults import FollowingFault, LockFault, ProgramFault
from morfax.motion.motion import join, thin
from morfax.player.cubics import cubic, interpolator, servo
from morfax.player.cubics.cubic import play_cubic
from morfax.player.cubics.interpolator import CubicInterpolator
from morfax.player.cubics.scales import Scales, joined, measured, read_scales
from morfax.player.cubics.servo import Servo
from morfax.player.cubics.time_base import TimeBase
from morfax.recorder.cubics.cubics import record_cubics
from morfax.recorder.cubics.file import CubicFormat, CubicProgram, write_program
from tests.player.cubics.registers import table, truncated_end
from tests.recorder.steps.paths import SQUARE, circle

UM = 1e-3


@pytest.fixture(scope="module")
def round_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A circle of 5 mm at 10 mm/s."""
    file = tmp_path_factory.mktemp("cubic") / "round.cubic"
    record_cubics(circle(5, 10), file)
    return file


def test_the_interpolator_is_table_i_for_any_words() -> None:
    words = np.array([[[37, -5, 2]]])
    run = CubicInterpolator(np.array([0]), 8).run(words)[:, 0]
    assert run.tolist() == [row[0] for row in table(0, (37, -5, 2), 8)][1:]


def test_registers_carry_on_from_block_to_block() -> None:
    words = np.random.default_rng(2).integers(-(10**6), 10**6, (10, 3, 3))
    whole = CubicInterpolator(np.array([1, 2, 3]), 16).run(words)
    parts = CubicInterpolator(np.array([1, 2, 3]), 16)
    assert (np.vstack([parts.run(words[:4]), parts.run(words[4:])]) == whole).all()


@pytest.mark.parametrize("points", [1, 12, 0])
def test_steps_that_are_no_power_of_two_are_refused(points: int) -> None:
    with pytest.raises(ValueError, match="power of two"):
        CubicInterpolator(np.zeros(3), points)


def test_words_of_another_shape_are_refused() -> None:
    with pytest.raises(ValueError, match=r"\(k, 3, 3\)"):
        CubicInterpolator(np.zeros(3), 16).run(np.zeros((4, 2, 3), np.int64))


def test_full_digits_end_exactly_and_fewer_do_not() -> None:
    words = (721000, -90000, 6000)  # counts / 16³: from 0 to 1000
    assert truncated_end(0, words, 16, (12, 12, 12, 12)) == 1000
    assert 0 < abs(truncated_end(0, words, 16, (0, 4, 8, 12)) - 1000) <= 20  # counts


def test_the_time_base_divides() -> None:
    base = TimeBase()
    assert base.cubic_hz == base.step_hz / 4 == base.fast_hz / (16 * 2 * 16 * 4)


@given(st.floats(-(10**6), 10**6), st.floats(0.02, 0.98), st.sampled_from([4, 64, 4096]))
def test_the_joined_code_is_the_position_wherever_the_coarse_scale_is_late_by_less_than_a_digit(
    position: float, late: float, pitch: int
) -> None:
    scale = Scales(pitch, lag_digits=late)
    settings = scale.table(TimeBase.of(CubicFormat(), pitch))
    place = np.floor(position) + 0.5  # in the middle of a count, as the servo has it
    fine, coarse = read_scales(place, 0.0, 0.0, settings)
    assert joined(fine, coarse, pitch) == np.floor(position)
    assert measured.py_func(place, 0.0, 0.0, settings) == np.floor(position)


def test_noise_is_harmless_in_the_middle_of_the_margin_and_not_at_its_edge() -> None:
    position = np.linspace(-5000, 5000, 20001)
    wrong = {}
    for misaligned in (-0.5, 0.0, 0.45):
        scale = Scales(
            64, misaligned_digits=misaligned, fine_noise_counts=2, coarse_noise_digits=0.3
        )
        settings = scale.table(TimeBase())
        noise = np.random.default_rng(0).uniform(-1, 1, (len(position), 2))
        codes = [measured(x, *n, settings) for x, n in zip(position, noise, strict=True)]
        wrong[misaligned] = np.abs(codes - np.floor(position)).max()
    assert wrong[0.0] <= 3 and wrong[-0.5] >= 32 and wrong[0.45] >= 32  # counts: a pitch is 64


def test_a_pitch_without_a_highest_digit_is_refused() -> None:
    with pytest.raises(ValueError, match="power of two"):
        Scales(100)


def test_noisy_scales_shake_the_machine_no_more_than_their_noise(round_file: Path) -> None:
    shaken = Servo(scales=Scales(fine_noise_counts=4, coarse_noise_digits=0.3))  # 2 um
    off = [
        distance(thin(play_cubic(round_file, servo=servo)), circle(5, 10))
        for servo in (Servo(), shaken)
    ]
    assert off[0].path_to_reference.max_mm < off[1].path_to_reference.max_mm < 4 * UM


def test_a_misaligned_scale_is_met_by_the_register(round_file: Path) -> None:
    with pytest.raises(LockFault, match="lags") as met:
        join(
            play_cubic(
                round_file,
                servo=Servo(scales=Scales(misaligned_digits=0.8), register_digits=10),
            )
        )
    assert met.value.axis in ("x", "y") and met.value.time_s >= 0


def test_the_lag_is_the_speed_over_the_modulus(round_file: Path) -> None:
    for modulus in (100.0, 200.0):
        playback = play_cubic(round_file, servo=Servo(modulus_per_s=modulus))
        join(playback)
        assert max(playback.following_error_mm) == pytest.approx(
            10 / modulus, rel=0.05
        )  # 10 mm/s
        assert playback.end_error_mm == pytest.approx([0, 0, 0], abs=1 * UM)


@pytest.mark.parametrize(("speed_mm_s", "limit_mm"), [(0, 0.0055), (10, 0.068), (40, 0.2555)])
def test_the_limit_is_the_lag_and_5_um(speed_mm_s: float, limit_mm: float) -> None:
    """5 ms of modulus, 1 ms of motor and a point of 0.25 ms at speed; 5 um and one count of half a um."""
    allowed = Servo().limit(200.0, 2000.0, 4000.0)
    assert allowed.limit_mm(speed_mm_s) == pytest.approx(limit_mm, abs=0.1 * UM)


def test_a_sound_drive_takes_most_of_its_limit_and_a_weak_one_more(round_file: Path) -> None:
    playback = play_cubic(round_file)
    list(playback)
    assert 0.65 < playback.monitor.largest_share[0] < 0.85  # measured 0.75
    playback.conditions[0] = Condition(gain_share=0.6)  # 1.67 times the lag
    with pytest.raises(FollowingFault, match="X does not follow"):
        list(playback)


def test_a_small_modulus_cuts_the_circle_as_it_should(round_file: Path) -> None:
    motion = join(play_cubic(round_file, servo=Servo(modulus_per_s=20)))
    radius = np.hypot(motion.positions_mm[:, 0], motion.positions_mm[:, 1] - 5)
    middle = radius[len(radius) // 3 : len(radius) // 2].mean()
    assert 5 - middle == pytest.approx(5 - 5 / np.sqrt(1 + (2 / 20) ** 2), rel=0.1)  # 2 rad/s


def test_dropping_digits_makes_a_rough_pass(round_file: Path) -> None:
    off = []
    for dropped in (0, 6):
        played = thin(play_cubic(round_file, servo=Servo(dropped_digits=dropped)))
        off.append(distance(played, circle(5, 10)).path_to_reference.max_mm)
    assert off[0] < 2 * UM and 10 * UM < off[1] < 64 * UM  # 64 counts of half a um


def test_a_register_that_is_full_stops_the_machine(round_file: Path) -> None:
    playback = play_cubic(round_file, servo=Servo(modulus_per_s=4))
    blocks = []
    with pytest.raises(LockFault, match="larger speed modulus") as met:
        blocks.extend(playback)
    assert np.abs(playback.following_error_mm).max() < 4096 / 2000
    assert met.value.time_s == pytest.approx(
        sum(len(b.positions_mm) for b in blocks) / 4000, abs=2
    )


def test_a_modulus_too_large_for_the_points_is_refused(round_file: Path) -> None:
    with pytest.raises(ProgramFault, match="give at most"):
        play_cubic(round_file, servo=Servo(modulus_per_s=3000))


def test_the_times_of_the_blocks_join(round_file: Path) -> None:
    playback = play_cubic(round_file)
    blocks = list(playback)
    ends_s = [block.start_s + block.duration_s for block in blocks[:-1]]
    assert ends_s == pytest.approx([block.start_s for block in blocks[1:]])
    assert ends_s[-1] + blocks[-1].duration_s == pytest.approx(
        playback.duration_s, abs=1 / 1000
    )


def test_the_kernels_do_as_plain_python_what_they_do_compiled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    short = record_cubics(
        SQUARE, tmp_path / "a.cubic", fmt=CubicFormat(points=64, linear=2)
    ).file
    shaken = Servo(scales=Scales(fine_noise_counts=1), dropped_digits=1)
    compiled = join(play_cubic(short, servo=shaken)).positions_mm
    monkeypatch.setattr(interpolator, "_interpolate", interpolator._interpolate.py_func)
    monkeypatch.setattr(cubic, "run_servos", servo.run_servos.py_func)
    assert join(play_cubic(short, servo=shaken)).positions_mm == pytest.approx(
        compiled, abs=1e-9
    )


def test_the_historic_control_interpolates_as_the_usual_one_and_takes_longer(
    round_file: Path,
) -> None:
    usual, historic = play_cubic(round_file), play_cubic(round_file, historic=True)
    off = distance(thin(historic), circle(5, 10))
    assert off.path_to_reference.max_mm < 3 * UM  # two of the fit, two counts of half a um
    assert historic.base.block_s == usual.format.points * 16 * 2 * 16 / 3500
    assert historic.duration_s > 100 * usual.duration_s


def test_a_program_whose_words_are_longer_than_a_store_is_refused(tmp_path: Path) -> None:
    words = np.array(
        [[[1 << 47, 0, 0], [0, 0, 0], [0, 0, 0]]]
    )  # store II has 48 digits, one its sign
    file = tmp_path / "long.cubic"
    write_program(CubicProgram(CubicFormat(), words, {0: (0, 0, 0), 1: (0, 0, 0)}), file)
    with pytest.raises(ProgramFault, match="more digits than store II;"):
        play_cubic(file, historic=True)
    with pytest.raises(ProgramFault, match="X goes to"):
        play_cubic(file)


@pytest.mark.parametrize(("share", "counts"), [(0.49, 5), (0.51, 6), (-0.49, 5), (-0.51, 4)])
def test_a_register_is_read_to_the_nearest_count(share: float, counts: int) -> None:
    register = CubicInterpolator(np.array([5]), 16)
    whole = 1 << CubicInterpolator.digits_for(16)
    assert register.counts(np.array([round((5 + share) * whole)])).tolist() == [counts]
