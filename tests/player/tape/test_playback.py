"""The whole player: a file in, the machine's own motion out."""

from __future__ import annotations

import gc
import tracemalloc
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import soundfile
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from morfax.motion.contour import distance
from morfax.motion.faults import LockFault, TapeFault
from morfax.motion.motion import Motion, join
from morfax.motion.ramp import positions_mm
from morfax.player.tape.ahead import BLOCKS_AHEAD
from morfax.player.tape.playback import TapePlayback, play
from morfax.player.tape.reader import BLOCK_FRAMES
from morfax.recorder.tape.tape import TapeFormat, record
from tests.player.carriers import (
    CYCLES_PER_MM,
    MOTION_RATE_HZ,
    RATE_HZ,
    REFERENCE_HZ,
    UM,
    Course,
    Transport,
    circle,
    square,
    swing,
    tracks,
)

SECONDS = 1.5
BYTES_A_ROW = 3 * 8 + 3 * 4 + 4 * 4  # cycles and surprise of three axes, levels of four tracks


def tape(file: Path, frames: np.ndarray, rate_hz: int = RATE_HZ) -> Path:
    """A tape without a text chunk, 16 bit."""
    soundfile.write(file, frames, rate_hz, subtype="PCM_16")
    return file


def by_hand(file: Path, start_mm: tuple[float, ...] | None = None) -> TapePlayback:
    """Play such a tape."""
    return play(file, reference_hz=REFERENCE_HZ, cycles_per_mm=CYCLES_PER_MM, start_mm=start_mm)


def played(
    file: Path,
    transport: Transport | None = None,
    course: Course = swing,
    seconds: float = SECONDS,
) -> np.ndarray:
    """The machine's motion for a course, shifted to the course's own start."""
    start = tuple(course(np.zeros(1))[0].tolist())
    return join(by_hand(tape(file, tracks(course, seconds, transport)), start)).positions_mm


def test_the_machine_goes_where_the_tape_says(tmp_path: Path) -> None:
    positions = played(tmp_path / "t.wav")
    told = swing(np.arange(len(positions)) / MOTION_RATE_HZ)
    assert len(positions) == SECONDS * MOTION_RATE_HZ
    # following error of 0.5 m/s²; the last rows are held
    assert np.abs(positions - told)[:-8].max() < 0.6 * UM


@pytest.mark.parametrize(
    ("course", "seconds"), [(circle(3, 10), 2.6), (square(10, 10), 5.0), (circle(50, 100), 4.0)]
)
@pytest.mark.parametrize(
    ("transport", "rms_mm", "max_mm"),
    [
        (Transport(), 0.2 * UM, 0.6 * UM),
        (Transport(noise_db=40, flutter=0.005), 0.2 * UM, 0.7 * UM),
    ],
)
def test_path_played_against_path_recorded(
    tmp_path: Path,
    course: Course,
    seconds: float,
    transport: Transport,
    rms_mm: float,
    max_mm: float,
) -> None:
    told = course(np.arange(round(seconds * MOTION_RATE_HZ)) / MOTION_RATE_HZ)
    went = played(tmp_path / "t.wav", transport, course, seconds)
    apart = distance(told[:, :2], went[:, :2])
    for way in (apart.path_to_reference, apart.reference_to_path):
        assert way.rms_mm < rms_mm
        assert way.max_mm < max_mm
    assert np.abs(went[-1] - told[-1]).max() < 0.1 * UM  # at rest: noise of the loop's band


@settings(
    max_examples=8, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    level=st.floats(0.02, 0.99),
    start_cycles=st.floats(0, 1),
    offsets=st.tuples(*[st.floats(-0.5, 0.5)] * 3),
    speed=st.floats(0.95, 1.05),
)
def test_gain_start_phase_and_speed_do_not_change_where_it_goes(
    tmp_path: Path, level: float, start_cycles: float, offsets: tuple[float, ...], speed: float
) -> None:
    how = Transport(
        level=level, start_cycles=start_cycles, track_cycles=(0.0, *offsets), speed=speed
    )
    positions = played(tmp_path / "t.wav", how)
    told = swing(how.programme_s(np.arange(len(positions)) / MOTION_RATE_HZ))
    # 0.6 um as above, 16 bit of a carrier 34 dB down, and 10 % more acceleration at the higher speed.
    assert np.abs(positions - told)[:-8].max() < 0.8 * UM


def test_blocks_follow_one_another_and_time_begins_with_the_tape(tmp_path: Path) -> None:
    blocks = list(by_hand(tape(tmp_path / "t.wav", tracks(swing, 4.0))))
    assert len(blocks) > 2
    assert blocks[0].start_s == 0
    for one, after in pairwise(blocks):
        assert after.start_s == pytest.approx(one.start_s + one.duration_s)
        assert (
            np.abs(after.positions_mm[0] - one.positions_mm[-1]).max() < 60.0 / MOTION_RATE_HZ
        )  # 60 mm/s


def test_it_can_be_played_again(tmp_path: Path) -> None:
    playback = by_hand(tape(tmp_path / "t.wav", tracks(swing, 0.5)))
    assert np.array_equal(join(playback).positions_mm, join(playback).positions_mm)


@pytest.fixture
def recorded(tmp_path: Path) -> Path:
    """A square as the recorder writes it, from 40, 12, 2."""
    positions = np.array([40.0, 12.0, 2.0]) + square(5, 10)(
        np.arange(3 * 6000) / MOTION_RATE_HZ
    )
    file = tmp_path / "square.wav"
    record([Motion(positions)], file, TapeFormat())
    return file


def test_a_recorded_tape_brings_the_machine_from_its_start_to_its_end(recorded: Path) -> None:
    playback = play(recorded)
    assert playback.end_error_mm is None
    motion = join(playback)
    assert motion.positions_mm[0] == pytest.approx([40, 12, 2], abs=0.1 * UM)
    assert playback.end_mm == pytest.approx([40, 12, 2], abs=0.1 * UM)
    assert playback.end_error_mm == pytest.approx([0, 0, 0], abs=0.1 * UM)
    assert playback.duration_s == pytest.approx(motion.duration_s, abs=1 / MOTION_RATE_HZ)
    assert 0.1 * UM < playback.following_error_mm[0] < 0.6 * UM
    assert playback.following_error_mm[2] < 0.02 * UM  # Z stands: 16 bit


def test_a_start_by_hand_moves_the_whole_motion(recorded: Path) -> None:
    own, moved = (
        join(play(recorded)).positions_mm,
        join(play(recorded, start_mm=(0.0, 0.0))).positions_mm,
    )
    assert np.abs(own - moved - np.array([40, 12, 0])).max() < 1e-9 * UM


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


def test_two_axes_leave_z_at_zero(tmp_path: Path) -> None:
    file = tape(tmp_path / "t.wav", tracks(swing, 0.5)[:, :3])
    positions = join(by_hand(file)).positions_mm
    assert positions.shape == (3000, 3)
    assert not positions[:, 2].any()


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


def test_memory_does_not_grow_with_the_tape(tmp_path: Path) -> None:
    peaks = []
    for seconds in (6, 48):
        file = tape(tmp_path / f"{seconds}.wav", tracks(swing, seconds))
        # a first one may compile kernels, and the tests' runner has a thread beside: the least counts
        peaks.append(min(peak_of_playing(file) for _ in range(4)))
    # how far the reader is ahead of the drives is chance; the positions of 42 s more would be 6 MB
    ahead = BLOCKS_AHEAD * BLOCK_FRAMES * MOTION_RATE_HZ / RATE_HZ * BYTES_A_ROW
    assert peaks[1] < 1.1 * peaks[0] + ahead
    assert peaks[0] < 20e6  # bytes: a few blocks of 1 MB


def peak_of_playing(file: Path) -> int:
    """What playing a tape takes at most, bytes."""
    gc.collect()
    tracemalloc.start()
    try:
        for _ in by_hand(file):
            pass
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


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
