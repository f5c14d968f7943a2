"""What stops the machine that plays: never a wrong position."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from morfax.motion.faults import LockFault, TapeFault
from morfax.motion.motion import Motion, join
from morfax.motion.ramp import positions_mm
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import TapeFormat, record
from tests.player.carriers import (
    CYCLES_PER_MM,
    MOTION_RATE_HZ,
    RATE_HZ,
    Transport,
    swing,
    tracks,
)
from tests.player.tape.bare_tapes import SECONDS, by_hand, tape


def test_a_wrong_end_is_a_fault(tmp_path: Path) -> None:
    frames = tracks(swing, 0.5)
    fmt = TapeFormat(start_mm=(0.0, 0.0, 0.0), end_mm=(0.0, 0.05, 0.0))
    file = tmp_path / "t.wav"  # it stands; its end is stated a whole cycle further on
    with soundfile.SoundFile(file, "w", RATE_HZ, 4, "PCM_16") as sound:
        sound.comment = fmt.to_json()
        sound.write(frames[: RATE_HZ // 10])
    with pytest.raises(
        LockFault, match=r"Y ends at .* -0.050 mm from the end that the tape states"
    ):
        join(play(file))


def test_a_drive_that_cannot_follow_is_a_fault_with_its_state(tmp_path: Path) -> None:
    def dash(t_s: np.ndarray) -> np.ndarray:
        """Y to 80 mm/s with 10 m/s², twice the motor's limit: 0.32 mm are missing in the end, 6.4 cycles."""
        t = np.clip(t_s - 0.3, 0, None)
        return np.column_stack([0 * t, np.where(t < 0.008, 5000 * t**2, 80 * t - 0.32), 0 * t])

    with pytest.raises(LockFault, match=r"the drive of Y lost its lock at 0\.3") as caught:
        join(by_hand(tape(tmp_path / "t.wav", tracks(dash, 0.5))))
    fault = caught.value
    assert (fault.axis, fault.error_cycles) == (
        "y",
        pytest.approx(4.0, abs=0.2),
    )  # found within a row, 80 mm/s
    assert 0.30 < fault.time_s < 0.32
    assert 0.0 < fault.position_mm < 0.64


def test_a_jump_stops_the_machine_before_it(tmp_path: Path) -> None:
    frames = tracks(swing, SECONDS)
    frames[RATE_HZ:, 1] *= -1  # half a cycle, at 1 s
    seen: list[Motion] = []
    with pytest.raises(
        LockFault, match=r"the phase of X jumps|X was lost for 1\.. ms"
    ) as caught:
        for motion in by_hand(tape(tmp_path / "t.wav", frames)):
            seen.append(motion)
    assert caught.value.time_s == pytest.approx(1.0, abs=0.0015)
    assert len(join(seen).positions_mm) == pytest.approx(MOTION_RATE_HZ, abs=6)


def test_a_lost_carrier_stops_the_machine(tmp_path: Path) -> None:
    frames = tracks(swing, SECONDS)
    frames[RATE_HZ : RATE_HZ + 480, 2] = 0  # 10 ms
    with pytest.raises(LockFault, match="Y was lost for 11") as caught:
        join(by_hand(tape(tmp_path / "t.wav", frames)))
    assert caught.value.time_s == pytest.approx(1.0, abs=0.0015)


@settings(
    max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(seed=st.integers(0, 10_000), silence_ms=st.floats(0.5, 40))
def test_a_dropout_is_ridden_out_or_a_fault_but_never_a_wrong_position(
    tmp_path: Path, seed: int, silence_ms: float
) -> None:
    random = np.random.default_rng(seed)
    frames = tracks(swing, SECONDS, Transport(noise_db=40))
    first = int(random.integers(RATE_HZ // 2, RATE_HZ))
    frames[first : first + int(silence_ms * RATE_HZ / 1000), random.integers(0, 4)] *= 0.01
    start = tuple(swing(np.zeros(1))[0].tolist())
    try:
        positions = join(by_hand(tape(tmp_path / "t.wav", frames), start)).positions_mm
    except (TapeFault, LockFault):
        return
    told = swing(np.arange(len(positions)) / MOTION_RATE_HZ)
    assert np.abs(positions - told)[:-8].max() < 0.25 / CYCLES_PER_MM


def test_a_silent_track_is_a_fault_at_once(tmp_path: Path) -> None:
    frames = tracks(swing, 0.5)
    frames[:, 3] = 0
    with pytest.raises(TapeFault, match=r"track 4 \(Z\) is silent"):
        next(iter(by_hand(tape(tmp_path / "t.wav", frames))))


def test_a_tape_whose_start_is_erased_on_all_tracks_is_a_fault(tmp_path: Path) -> None:
    """It looks like one that a sound program has recorded, but for what moves where it begins."""
    frames = tracks(swing, SECONDS)
    frames[: RATE_HZ // 2] = 0
    with pytest.raises(TapeFault, match=r"starts while \w moves"):
        next(iter(by_hand(tape(tmp_path / "t.wav", frames))))


def test_a_tape_of_a_moment_is_a_fault(tmp_path: Path) -> None:
    with pytest.raises(TapeFault, match="ends after 40 frames; it must be longer"):
        join(by_hand(tape(tmp_path / "t.wav", tracks(swing, 0.5)[:40])))


@pytest.mark.parametrize(("off_mm", "is_fault"), [(0.011, False), (0.020, True)])
def test_a_closed_program_may_end_a_quarter_of_a_cycle_off_its_start(
    off_mm: float, is_fault: bool, tmp_path: Path
) -> None:
    """12.5 um; a cycle that was lost on the way is 50."""
    x = np.vstack([positions_mm([0.0], [5.0], 10.0), positions_mm([5.0], [off_mm], 10.0)])
    record(Motion(np.hstack([x, 0 * x, 0 * x])), tmp_path / "told.wav")
    frames, rate_hz = soundfile.read(tmp_path / "told.wav")
    soundfile.write(tmp_path / "bare.wav", frames, rate_hz, subtype="PCM_16")
    by_hand = {"reference_hz": 6000.0, "cycles_per_mm": 20.0, "still": ("y", "z")}
    playback = play(tmp_path / "bare.wav", closed=True, **by_hand)
    if is_fault:
        with pytest.raises(LockFault, match="from the end that the tape states"):
            join(playback)
    else:
        assert len(join(playback).positions_mm) > len(x)
