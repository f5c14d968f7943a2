"""The whole player: a file in, the machine's own motion out."""

from __future__ import annotations

import gc
import tracemalloc
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from morfax.motion.contour import distance
from morfax.motion.motion import Motion, join
from morfax.player.tape.ahead import BLOCKS_AHEAD
from morfax.player.tape.playback import play
from morfax.player.tape.reader import BLOCK_FRAMES
from morfax.recorder.tape.tape import TapeFormat, record
from tests.player.carriers import (
    MOTION_RATE_HZ,
    RATE_HZ,
    UM,
    Course,
    Transport,
    circle,
    square,
    swing,
    tracks,
)
from tests.player.tape.bare_tapes import SECONDS, by_hand, tape

BYTES_A_ROW = 3 * 8 + 3 * 4 + 4 * 4  # cycles and surprise of three axes, levels of four tracks


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


def test_two_axes_leave_z_at_zero(tmp_path: Path) -> None:
    file = tape(tmp_path / "t.wav", tracks(swing, 0.5)[:, :3])
    positions = join(by_hand(file)).positions_mm
    assert positions.shape == (3000, 3)
    assert not positions[:, 2].any()


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
