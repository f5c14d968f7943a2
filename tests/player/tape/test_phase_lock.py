"""The axis drives against the closed form of their loop."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import dlsim, dlti

from morfax.motion.contour import distance
from morfax.motion.drive import Drive
from morfax.player.monitor.monitor import Monitor
from morfax.player.tape import drives as organ
from morfax.player.tape.drives import Drives, following_limit
from morfax.player.tape.phase_lock import PhaseLock, place
from tests.player.carriers import (
    CYCLES_PER_MM,
    MOTION_RATE_HZ,
    UM,
    Course,
    along,
    circle,
    square,
)

DT_S = 1 / MOTION_RATE_HZ
Q_MM = 1 / CYCLES_PER_MM


def follow(positions_mm: np.ndarray, lock: PhaseLock | None = None) -> np.ndarray:
    """Where the screws went for a course given in mm."""
    return Drives(positions_mm.shape[1], Q_MM, MOTION_RATE_HZ, lock).follow(
        positions_mm * CYCLES_PER_MM
    )


def open_loop(lock: PhaseLock, z: np.ndarray) -> np.ndarray:
    """The transfer once round the loop, from its own parts."""
    n, g = place(lock, DT_S), lock.drive.gain(DT_S)
    networks = n.gain * (z - n.zero) * (z - n.lead_zero) / ((z - 1) * (z - n.lead_pole))
    return networks * g * DT_S / 2 * (z + 1) / ((z - 1) * (z - 1 + g))


@pytest.mark.parametrize(
    "lock", [PhaseLock(), PhaseLock(150, 0.707, 2), PhaseLock(drive=Drive(lag_s=0.0))]
)
def test_a_step_is_answered_by_the_three_poles_asked_for(lock: PhaseLock) -> None:
    # 0.2 um at once: small enough for the motor's acceleration, so the loop is linear.
    step_mm = np.r_[0.0, np.full(400, 0.2 * UM)][:, None]
    poles = lock.poles(DT_S)
    n = place(lock, DT_S)
    forward = 2 * 0.5 * n.gain * lock.drive.gain(DT_S) * DT_S / 2 * np.poly([-1, n.zero]).real
    _, expected = dlsim(dlti(forward, np.poly(poles).real, dt=DT_S), step_mm)
    assert np.abs(follow(step_mm, lock) - expected).max() < 1e-9 * UM  # rounding only


@given(
    natural_hz=st.floats(20, 400),
    damping=st.floats(0.4, 1.2),
    third=st.floats(0.7, 3),
    lag_s=st.floats(0.0002, 0.005),
)
@settings(max_examples=60, deadline=None)
def test_placing_is_exact(
    natural_hz: float, damping: float, third: float, lag_s: float
) -> None:
    lock = PhaseLock(natural_hz, damping, third, drive=Drive(lag_s))
    back = 1 + open_loop(lock, lock.poles(DT_S))
    # Relative to the slope there; double poles make the solution as exact as the root of rounding.
    assert np.abs(back).max() < 1e-6


def test_the_loop_has_margin() -> None:
    z = np.exp(2j * np.pi * np.geomspace(1, 2990, 20_000) * DT_S)
    loop = open_loop(PhaseLock(), z)
    # vector margin: no gain from 0.4 to 2.8 of the right one breaks the loop
    assert np.abs(1 + loop).min() > 0.65
    crossing = np.flatnonzero(np.diff(np.sign(np.abs(loop) - 1)))
    assert len(crossing) == 1
    assert np.degrees(np.angle(-loop[crossing[0]])) > 45  # phase margin


def test_rest_and_constant_speed_leave_no_error() -> None:
    way_mm = along(np.arange(4200) * DT_S, 100.0, 100.0, 500.0)
    drives = Drives(1, Q_MM, MOTION_RATE_HZ)
    drives.follow(way_mm[:, None] * CYCLES_PER_MM)
    assert abs(drives.error_mm[0]) < 1e-6 * UM  # 100 mm/s, half a second after the start


def test_constant_acceleration_leaves_the_error_of_the_loop_equation() -> None:
    t_s = np.arange(1200) * DT_S
    drives = Drives(1, Q_MM, MOTION_RATE_HZ)
    drives.follow((0.5 * 500.0 * t_s**2)[:, None] * CYCLES_PER_MM)
    z = np.array([1 + 1e-6])
    expected_mm = 500.0 * DT_S**2 / ((z - 1) ** 2 * open_loop(PhaseLock(), z)).real
    assert drives.error_mm == pytest.approx(expected_mm, rel=1e-4)
    assert drives.error_mm[0] < 0.5 * UM  # 0.01 cycle at 0.5 m/s², so 0.04 at 2 m/s²


@pytest.mark.parametrize(
    ("course", "seconds"),
    [
        (circle(3, 10), 2.5),
        (circle(50, 100), 4.0),
        (square(10, 10), 5.0),
        (square(50, 100), 4.0),
    ],
)
def test_the_screws_follow_the_path(course: Course, seconds: float) -> None:
    told = course(np.arange(round(seconds * MOTION_RATE_HZ)) * DT_S)
    apart = distance(told[:, :2], follow(told)[:, :2])
    for way in (apart.path_to_reference, apart.reference_to_path):
        assert way.rms_mm < 0.2 * UM
        assert way.max_mm < 0.6 * UM  # 0.49 um, the error of 0.5 m/s²


def test_a_stop_at_once_is_followed() -> None:
    t_s = np.arange(3000) * DT_S
    told = np.minimum(t_s, 0.25)[:, None] * 40.0
    moved = follow(told)
    assert len(moved) == len(told)
    assert abs(moved[-1, 0] - told[-1, 0]) < 1e-6 * UM
    assert np.abs(moved - told).max() < 1.05 * 40.0**2 / (
        2 * 5000.0
    )  # 3.2 cycles: what 5 m/s² needs, hardly more


LOCKS = (
    PhaseLock(),
    PhaseLock(150, 0.707),
    PhaseLock(drive=Drive(lag_s=0.004, acceleration_mm_s2=800.0)),
)


@pytest.mark.parametrize("lock", LOCKS)
@given(
    share=st.floats(0.01, 0.99),
    onto=st.sampled_from([-1.0, -0.5, 0.0, 0.5]),
    noise_um=st.sampled_from([0.0, 0.04]),
)
@settings(max_examples=30, deadline=None)
def test_a_sound_drive_passes_the_monitor_at_any_start_stop_and_turn_at_once(
    lock: PhaseLock, share: float, onto: float, noise_um: float
) -> None:
    # From rest to the fastest speed that it can be turned round from within its range, and at once to another
    # one.
    speed = share * np.sqrt(lock.range_cycles * Q_MM * lock.drive.acceleration_mm_s2 / 2)
    t_s = np.arange(4800) * DT_S
    told = speed * (np.clip(t_s - 0.1, 0, 0.3) + onto * np.clip(t_s - 0.4, 0, None))[:, None]
    told = told + np.random.default_rng(7).normal(0, noise_um * UM, told.shape)
    watch = Monitor("x", MOTION_RATE_HZ, following_limit(lock, Q_MM, MOTION_RATE_HZ))
    # near the range the slower loop leaves it: that is the fault circuit's to say
    moved = follow(told, lock)
    assert watch.watch(told[: len(moved)], moved) == len(moved) and (
        len(moved) == len(told) or share > 0.9
    )


def test_the_limit_of_a_tape_drive_is_its_own_error_at_low_speed_and_its_range_at_high() -> (
    None
):
    limit = following_limit(PhaseLock(), Q_MM, MOTION_RATE_HZ)
    # a twelfth of the range: a quarter of a cycle, and 4 um of turning round
    assert limit.limit_mm(1.0) < 17 * UM
    # from 10 mm/s to as fast the other way, at the limit of the current
    braked_mm = 2 * 10.0**2 / 5000.0
    assert braked_mm < limit.limit_mm(10.0) - limit.tolerance_mm < 1.6 * braked_mm
    assert limit.limit_mm(100.0) == pytest.approx(4.25 * Q_MM)


def test_noise_of_40_db_stays_below_a_tenth_of_a_micrometre() -> None:
    cycles = np.random.default_rng(3).normal(0, 7.6e-4, (60_000, 3))
    moved = Drives(3, Q_MM, MOTION_RATE_HZ).follow(cycles)
    # 0.038 um in, the loop's band of some 800 of 3000 Hz out
    assert np.sqrt(np.mean(moved**2)) < 0.05 * UM


def test_noise_that_meets_the_limit_of_the_current_on_one_side_does_not_push_the_screw_off() -> (
    None
):
    told = circle(10, 90)(np.arange(9000) * DT_S)  # 0.8 m/s² of 5, to and fro; 25 dB of noise
    noise = np.random.default_rng(1).normal(0, 4.4e-3, told.shape) * Q_MM
    off_cycles = np.abs(follow(told + noise) - follow(told)).max() * CYCLES_PER_MM
    # 0.01 to 0.017 by the seed; 0.036 to 0.045 where the integrator fell back at once
    assert off_cycles < 0.022


def test_beyond_the_range_the_rows_end() -> None:
    cycles = np.zeros((600, 2))
    cycles[300:, 1] = 4.5
    drives = Drives(2, Q_MM, MOTION_RATE_HZ)
    assert len(drives.follow(cycles)) == 300
    assert drives.error_mm[1] == pytest.approx(4.5 * Q_MM)


def test_what_is_no_number_ends_the_rows() -> None:
    cycles = np.zeros((60, 1))
    cycles[30] = np.nan
    assert len(Drives(1, Q_MM, MOTION_RATE_HZ).follow(cycles)) == 30


@settings(max_examples=10, deadline=None)
@given(cut=st.integers(1, 1999))
def test_state_is_carried_from_block_to_block(cut: int) -> None:
    cycles = circle(3, 10)(np.arange(2000) * DT_S) * CYCLES_PER_MM
    drives = Drives(3, Q_MM, MOTION_RATE_HZ)
    pieces = np.vstack([drives.follow(cycles[:cut]), drives.follow(cycles[cut:])])
    assert np.array_equal(pieces, Drives(3, Q_MM, MOTION_RATE_HZ).follow(cycles))


def test_kernel_agrees_with_itself_as_plain_python(monkeypatch: pytest.MonkeyPatch) -> None:
    told = circle(3, 10)(0.3 + np.arange(500) * DT_S)
    fast = follow(told)
    monkeypatch.setattr(organ, "_follow", organ._follow.py_func)
    assert np.abs(fast - follow(told)).max() < 1e-9 * UM


def test_a_rate_too_low_for_the_loop_is_refused_and_a_suited_loop_is_not() -> None:
    with pytest.raises(ValueError, match="at most 50 Hz"):
        place(PhaseLock(), 1 / 500)
    assert place(PhaseLock().suited_to(500), 1 / 500).gain > 0
    assert PhaseLock().suited_to(MOTION_RATE_HZ) == PhaseLock()
