"""A motion rehearsed against the same motion played off its tape: both hold, or both refuse."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.faults import Fault, MotionFault
from morfax.motion.motion import MOTION_RATE_HZ, Motion, join
from morfax.player.tape.playback import play
from morfax.player.tape.rehearsal import Rehearsal
from morfax.recorder.tape.tape import TapeFormat, record

T_S = np.arange(0, 0.6, 1 / MOTION_RATE_HZ)


def jump(speed_mm_s: float) -> np.ndarray:
    """X runs at a speed at once, stops at once, and Y goes on."""
    way_mm = speed_mm_s * T_S
    return np.column_stack(
        [np.minimum(way_mm, way_mm[-1] / 2), np.maximum(way_mm - way_mm[-1] / 2, 0)]
    )


def turn(speed_mm_s: float) -> np.ndarray:
    """X runs there and back, from a speed to as much the other way, after a start and before an end without a
    jump.
    """
    speed = (
        speed_mm_s
        * np.clip(np.minimum(T_S, T_S[::-1]) / 0.1, 0, 1)
        * np.where(T_S < 0.3, 1, -1)
    )
    return np.column_stack([np.cumsum(speed) / MOTION_RATE_HZ, 0 * T_S])


def circle(acceleration_mm_s2: float) -> np.ndarray:
    """A small circle at 100 rad/s, wound up and down."""
    radius = acceleration_mm_s2 / 100**2 * np.sin(np.pi * T_S / T_S[-1]) ** 2
    return np.column_stack([radius * np.cos(100 * T_S), radius * np.sin(100 * T_S)])


def start(acceleration_mm_s2: float) -> np.ndarray:
    """X comes to 90 mm/s and to rest again at an acceleration."""
    speed = np.minimum(90, acceleration_mm_s2 * np.minimum(T_S, T_S[::-1]))
    return np.column_stack([np.cumsum(speed) / MOTION_RATE_HZ, 0 * T_S])


@pytest.mark.parametrize(
    ("way", "holds", "breaks"),
    [(jump, 33.7, 34.0), (turn, 16.8, 17.1), (circle, 1200, 3000), (start, 6000, 7500)],
)
def test_what_is_rehearsed_is_what_is_played(
    way: Callable[[float], np.ndarray], holds: float, breaks: float, tmp_path: Path
) -> None:
    for asked, sound in ((holds, True), (breaks, False)):
        motion = Motion(np.column_stack([way(asked), 0 * T_S]), MOTION_RATE_HZ)
        rehearsal, refused = Rehearsal(TapeFormat()), None
        try:
            assert list(rehearsal.of([motion])) == [motion]
        except MotionFault as fault:
            refused = fault
        assert (refused is None and rehearsal.unfollowed is None) == sound
        record(motion, tmp_path / "way.wav")
        if sound:
            assert join(play(tmp_path / "way.wav")).duration_s > motion.duration_s
        else:
            with pytest.raises(Fault):
                list(play(tmp_path / "way.wav"))


def test_a_jump_is_told_with_its_axis_its_place_and_its_size_wherever_a_block_ends() -> None:
    positions = np.column_stack([jump(80.0), 0 * T_S])
    positions[:, 0] = turn(10.0)[:, 0]  # only Y jumps, half-way
    told = []
    for rows in (len(T_S), 100):
        blocks = (
            Motion(positions[k : k + rows], MOTION_RATE_HZ) for k in range(0, len(T_S), rows)
        )
        with pytest.raises(
            MotionFault,
            match=r"^Y, at [0-9.]+,0.0[0-9] mm and 0.30[0-9] s, changes its speed by 80 mm/s",
        ) as caught:
            list(Rehearsal(TapeFormat()).of(blocks))
        told.append((caught.value.axis, caught.value.time_s, caught.value.speed_mm_s))
    assert told[0] == told[1] and told[0][0] == "y"
    assert told[0][1] == pytest.approx(0.3, abs=1e-3) and told[0][2] == pytest.approx(
        80, rel=1e-6
    )


def test_the_limit_goes_with_the_cycles_per_mm() -> None:
    """A quarter of a cycle is five times as far with a fifth of the cycles."""
    motion = Motion(np.column_stack([jump(80.0), 0 * T_S]), MOTION_RATE_HZ)
    assert len(list(Rehearsal(TapeFormat(cycles_per_mm=4.0)).of([motion]))) == 1
    with pytest.raises(MotionFault, match=r"up to 6.77 mm/s"):
        list(Rehearsal(TapeFormat(cycles_per_mm=100.0)).of([motion]))
