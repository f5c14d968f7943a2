"""What is set at the machine: zero, override and motors, each by what it does to the played path, and where
it faults.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.contour import distance
from morfax.motion.faults import FollowingFault, LockFault
from morfax.motion.motion import MOTION_RATE_HZ, Motion, join, thin
from morfax.motion.ramp import Ramp
from morfax.motion.ramp import positions_mm as ramped_mm
from morfax.player.tape.drives import Drives
from morfax.player.tape.phase_lock import MOTORS, place
from morfax.player.tape.playback import play
from morfax.player.tape.setting import LARGEST_ZERO_MM, OVERRIDES, Setting
from morfax.recorder.tape.tape import record

REST_MM = 2e-6  # 16-bit noise on the phase, after the loop
UM = 1e-3


def circle(radius_mm: float = 10.0, speed_mm_s: float = 10.0) -> np.ndarray:
    """Once round, gently from rest and to rest."""
    ramp = Ramp(acceleration_mm_s2=5 * speed_mm_s)
    way = ramped_mm([0.0], [2 * np.pi * radius_mm], speed_mm_s, ramp)[:, 0] / radius_mm
    return np.column_stack([radius_mm * np.sin(way), radius_mm * (1 - np.cos(way)), 0 * way])


@pytest.fixture(scope="module")
def tape(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("setting") / "circle.wav"
    record(Motion(circle()), file)
    return file


def test_the_phase_changer_moves_the_whole_path(tape: Path) -> None:
    plain = join(play(tape)).positions_mm
    # a quarter of a cycle, 140 cycles, 8 cycles
    playback = play(tape, zero_mm=(0.013, -7.0, 0.4))
    moved = join(playback).positions_mm
    assert np.abs(moved - plain - [0.013, -7.0, 0.4]).max() < REST_MM
    assert playback.start_mm == pytest.approx([0.013, -7.0, 0.4], abs=1e-9)
    assert playback.end_error_mm is not None and np.abs(playback.end_error_mm).max() < REST_MM


def test_the_drives_turn_there_under_the_comparators_eye() -> None:
    drives = Drives(2, 0.05, MOTION_RATE_HZ)
    drives.adjust(np.array([30.0, -2.0]))
    assert np.abs(drives.error_mm).max() < 1e-6 * UM  # at rest again
    # what the tape says next is counted from the new zero: nothing moves
    still = drives.follow(np.tile([30.0 / 0.05, -2.0 / 0.05], (600, 1)))
    assert np.abs(still - [30.0, -2.0]).max() < 1e-6 * UM


def test_a_zero_that_is_not_given_is_none(tape: Path) -> None:
    assert np.array_equal(
        join(play(tape)).positions_mm, join(play(tape, zero_mm=(0, 0))).positions_mm
    )


@pytest.mark.parametrize("override", [0.1, 0.25, 0.8, 1.2, 2.0])
def test_an_override_changes_the_time_and_not_the_path(tape: Path, override: float) -> None:
    plain, run = play(tape), play(tape, override=override)
    as_recorded, played = thin(plain), thin(run)
    assert played.t_s[-1] == pytest.approx(as_recorded.t_s[-1] / override, rel=1e-9)
    assert run.duration_s == pytest.approx(plain.duration_s / override)
    # 10 mm/s round 10 mm is 10 mm/s², 10 nm of following, four times that at 200 %; the rest is the thinning,
    # 0.2 um
    assert distance(played, as_recorded).hausdorff_mm < 1 * UM
    assert run.end_error_mm is not None and np.abs(run.end_error_mm).max() < 10 * REST_MM


def test_the_following_error_grows_with_the_square_of_the_override(tmp_path: Path) -> None:
    # 405 mm/s², far above the noise of 16 bit
    record(Motion(circle(20.0, 90.0)), tmp_path / "a.wav")
    errors = []
    for override in (0.5, 1.0, 2.0):
        playback = play(tmp_path / "a.wav", override=override)
        join(playback)
        errors.append(playback.following_error_mm[:2].max())
    # e = acceleration / (K a): the loop is the same at all three, the acceleration is not
    assert errors[1] / errors[0] == pytest.approx(4, rel=0.15) and errors[2] / errors[
        1
    ] == pytest.approx(4, rel=0.15)


def test_a_tape_at_twice_its_speed_may_ask_for_a_quarter_of_the_motors_acceleration(
    tape: Path,
) -> None:
    """As it is on the tape: the longest dropout that is bridged follows from it."""
    for override in (0.5, 2.0):
        most_mm_s2 = MOTORS["electric"].drive.acceleration_mm_s2 / override**2
        assert play(tape, override=override).acceleration_mm_s2 == pytest.approx(most_mm_s2)


def fast_turn(tmp_path: Path) -> Path:
    """X to and fro at 60 mm/s with 3 m/s²: the motors give 5."""
    t_s = np.arange(6000) / MOTION_RATE_HZ
    speed = (
        60
        * (2 * np.abs(2 * ((t_s / 0.08) % 1) - 1) - 1)
        * np.clip(4 * t_s, 0, 1)
        * np.clip(4 * (1 - t_s), 0, 1)
    )
    x = np.cumsum(speed) / MOTION_RATE_HZ
    record(Motion(np.column_stack([x, 0 * x, 0 * x])), tmp_path / "fast.wav")
    return tmp_path / "fast.wav"


def test_an_override_beyond_the_motors_is_a_fault_and_not_silence(tmp_path: Path) -> None:
    file = fast_turn(tmp_path)
    assert len(join(play(file)).positions_mm)
    with pytest.raises((LockFault, FollowingFault)) as caught:  # 2 · 2 · 3 m/s² are 12
        join(play(file, override=2.0))
    assert caught.value.axis == "x"


def test_a_motor_that_is_too_slow_faults(tmp_path: Path) -> None:
    way = ramped_mm([0.0], [60.0], 95.0, Ramp(acceleration_mm_s2=300))
    record(Motion(np.hstack([way, 0 * way, 0 * way])), tmp_path / "a.wav")
    hydraulic = MOTORS["hydraulic"]
    join(play(tmp_path / "a.wav", settings=hydraulic))
    assert hydraulic.drive.top_speed_mm_s < 2 * 95
    with pytest.raises((LockFault, FollowingFault)):
        join(play(tmp_path / "a.wav", settings=hydraulic, override=2.0))
    join(play(tmp_path / "a.wav", override=2.0))  # the electric motor does 250 mm/s


@pytest.mark.parametrize("motor", MOTORS)
def test_both_motors_make_a_loop_of_type_2(motor: str) -> None:
    """Errors at rest and at constant speed are zero, and at constant acceleration acceleration / (K a)."""
    t_s = np.arange(24_000) / MOTION_RATE_HZ
    # at rest, 100 mm/s² for half a second, then 50 mm/s
    speed = np.clip(100 * (t_s - 0.5), 0, 50)
    x = np.cumsum(speed)[:, None] / MOTION_RATE_HZ
    drives = Drives(1, 0.05, MOTION_RATE_HZ, MOTORS[motor])
    error = (x - drives.follow(x / 0.05))[:, 0]
    lock = MOTORS[motor]
    dt_s = 1 / MOTION_RATE_HZ
    network = place(lock, dt_s)
    # the stepped loop equation at z = 1, see phase_lock: (z - 1)² (z - pole) against k (z + 1)(z - zero)
    twice_k = network.gain * lock.drive.gain(dt_s) * dt_s
    expected = 100 * dt_s**2 * (1 - network.lead_pole) / (twice_k * (1 - network.zero))
    assert error[5900] == pytest.approx(expected, rel=1e-4)
    assert np.abs(error[2900]) < 1e-9 and np.abs(error[-1]) < 1e-6


def test_hydraulic_is_looser_and_still_on_the_path(tape: Path) -> None:
    electric, hydraulic = play(tape), play(tape, settings=MOTORS["hydraulic"])
    assert distance(thin(electric), thin(hydraulic)).hausdorff_mm < 1 * UM
    assert hydraulic.following_error_mm[:2].max() > 10 * electric.following_error_mm[:2].max()


def test_motors_stop_at_their_top_speed() -> None:
    lock = replace(MOTORS["hydraulic"], range_cycles=np.inf)
    drives = Drives(1, 0.05, MOTION_RATE_HZ, lock)
    moved = drives.follow(np.arange(3000)[:, None] * 400 / MOTION_RATE_HZ / 0.05)
    assert np.diff(moved[:, 0]).max() * MOTION_RATE_HZ == pytest.approx(
        lock.drive.top_speed_mm_s, rel=1e-9
    )


@pytest.mark.parametrize(
    ("setting", "says"),
    [
        ({"override": 3.0}, "the override is 300%; give 10% to 200%"),
        ({"override": float("nan")}, "the override is nan%; give"),
        ({"zero_mm": (0.0, 2 * LARGEST_ZERO_MM)}, "a zero of 2000 mm is too far"),
        ({"zero_mm": (0.0, float("inf"))}, "too far"),
    ],
)
def test_what_cannot_be_set(setting: dict[str, object], says: str) -> None:
    with pytest.raises(ValueError, match=says):
        Setting(**setting)  # type: ignore[arg-type]
    assert OVERRIDES == (0.1, 2.0)


def test_more_zeros_than_axes(tape: Path) -> None:
    with pytest.raises(
        ValueError, match="a zero of 4 places does not fit; the tape has 3 axes"
    ):
        play(tape, zero_mm=(0, 0, 0, 1))
