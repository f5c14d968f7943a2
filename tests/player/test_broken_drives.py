"""Every control under the monitor: a sound drive passes, a broken one is found in time, and one wide limit
misses it.
"""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from morfax.motion.drive import Condition
from morfax.motion.faults import FollowingFault, LockFault
from morfax.motion.motion import MOTION_RATE_HZ, Motion
from morfax.motion.ramp import Ramp, positions_mm
from morfax.player.controls import play
from morfax.player.monitor.following_limit import FollowingLimit
from morfax.player.steps.motor import MotorCondition
from morfax.recorder.media import record

SPEED_MM_S, LENGTH_MM, REST_S = 1.0, 0.15, 0.3


@dataclass(frozen=True)
class Rig:
    """A control: suffix of its programs, one limit that would do for all its speeds, what to break, how soon
    it is found.
    """

    suffix: str
    wide_mm: float
    breaks: dict[str, tuple[Any, float]]  # the condition, and s from the start of the move


RIGS = {
    "tape": Rig(
        ".wav",
        0.2,  # the range of the comparator
        {
            # The integrator makes up for a fifth of the gain and for friction below 5.4 mm/s: nothing is
            # behind then.
            "friction": (Condition(friction_mm_s=6.0), 0.03),
            "lost gain": (Condition(gain_share=0.1), 0.06),
            "stuck axis": (Condition(stuck=True), 0.03),
            "runaway": (Condition(runaway_mm_s=6.0), 0.03),
        },
    ),
    "steps": Rig(
        ".steps",
        # A motor loses steps at any speed alike, so half a step is the limit for all; this is what a servo
        # would want.
        0.2,
        {
            "friction": (MotorCondition(friction_share=1.0), 0.02),
            "lost gain": (MotorCondition(torque_share=0.3), 0.02),
            "stuck axis": (MotorCondition(stuck=True), 0.02),
            "runaway": (
                MotorCondition(stray_hz=25.0),
                0.0,
            ),  # a quarter of a mm/s, from the first standstill on
        },
    ),
    "cubic": Rig(
        ".cubic",
        0.63,  # the lag at 100 mm/s
        {
            "friction": (Condition(friction_mm_s=5.0), 0.06),
            "lost gain": (Condition(gain_share=0.1), 0.06),
            "stuck axis": (Condition(stuck=True), 0.06),
            "runaway": (Condition(runaway_mm_s=5.0), 0.0),
        },
    ),
    "pulses": Rig(
        ".ngc",
        0.25,  # the range of the instantaneous command register
        {
            "friction": (Condition(friction_mm_s=100.0), 0.1),
            "lost gain": (Condition(gain_share=0.005), 0.1),
            "stuck axis": (Condition(stuck=True), 0.1),
            "runaway": (Condition(runaway_mm_s=100.0), 0.0),
        },
    ),
}
CASES = [(name, what) for name, rig in RIGS.items() for what in rig.breaks]


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A short slow move of X in each medium, from 10, 20, -1."""
    folder = tmp_path_factory.mktemp("slow")
    way = positions_mm([10.0], [10.0 + LENGTH_MM], SPEED_MM_S, Ramp(acceleration_mm_s2=50.0))[
        :, 0
    ]
    rest = round(REST_S * MOTION_RATE_HZ)
    x = np.r_[np.full(rest, 10.0), way, np.full(rest, 10.0 + LENGTH_MM)]
    motion = Motion(np.column_stack([x, np.full(len(x), 20.0), np.full(len(x), -1.0)]))
    for rig in RIGS.values():
        record(motion, folder / f"slow{rig.suffix}")
    return {name: folder / f"slow{rig.suffix}" for name, rig in RIGS.items()}


def began_s(program: Path) -> float:
    """When a sound machine has moved X by a tenth of a step."""
    for block in play(program):
        moved = np.flatnonzero(np.abs(block.positions_mm[:, 0] - 10.0) > 0.001)
        if len(moved):
            return float(block.times_s[moved[0]])
    raise AssertionError("the machine never moved")


@pytest.mark.parametrize("name", RIGS)
def test_a_sound_machine_passes(programs: dict[str, Path], name: str) -> None:
    playback = play(programs[name])
    assert list(playback) and playback.monitor.warnings == []
    assert playback.end_mm[0] == pytest.approx(10 + LENGTH_MM, abs=0.011)  # one step


@pytest.mark.parametrize(("name", "what"), CASES)
def test_a_broken_drive_is_found_in_time_with_its_state(
    programs: dict[str, Path], name: str, what: str
) -> None:
    condition, within_s = RIGS[name].breaks[what]
    playback = play(programs[name])
    playback.conditions[0] = condition
    blocks = []
    with pytest.raises(FollowingFault) as met:
        blocks.extend(playback)
    fault = met.value
    assert fault.axis == "x" and fault.exit_code == 6
    assert fault.time_s < began_s(programs[name]) + within_s
    assert abs(fault.demand_mm - fault.actual_mm) > fault.limit_mm
    assert fault.limit_mm < RIGS[name].wide_mm
    assert "X does not follow" in str(fault)
    # what was sound was given out, and no more
    told_s = sum(block.duration_s for block in blocks)
    assert told_s == pytest.approx(fault.time_s, abs=0.002)


@pytest.mark.parametrize(("name", "what"), CASES)
def test_one_limit_wide_enough_for_all_speeds_misses_it(
    programs: dict[str, Path], name: str, what: str
) -> None:
    playback = play(programs[name])
    playback.conditions[0], _ = RIGS[name].breaks[what]
    playback.limit = FollowingLimit.table([(0, 0)], RIGS[name].wide_mm)
    with contextlib.suppress(
        LockFault
    ):  # that the machine did not arrive shows at the end, where the program says it
        assert list(playback)
    assert playback.following_error_mm[0] < RIGS[name].wide_mm
