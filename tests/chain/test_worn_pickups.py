"""Tapes of every pick-up, worn as real recorders wear them: within a twentieth of a cycle, or a fault."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.contour import distance
from morfax.motion.motion import Motion, join, thin
from morfax.motion.ramp import Ramp, positions_mm
from morfax.player.tape.playback import play
from morfax.recorder.tape.pickups import PICK_UPS
from morfax.recorder.tape.tape import TapeFormat, record
from morfax.recorder.wear.settings import Wear
from morfax.recorder.wear.transport import age

UM = 1e-3
RADIUS_MM = 15.0

WORN = {
    "40 dB, 0.5 % flutter": Wear(noise_db=40, flutter=0.005),
    "a cassette's level": Wear(uneven_db=0.3, level_db=-6, noise_db=40),
    "short dropouts": Wear(dropouts_per_min=60, dropout_s=0.002, dropout_db=30),
}


def circle(speed_mm_s: float) -> Motion:
    """Once round at a speed: a coil's tracks grow and fall by a quarter at 75 mm/s."""
    way = (
        positions_mm([0.0], [4 * np.pi * RADIUS_MM], speed_mm_s, Ramp(acceleration_mm_s2=500))[
            :, 0
        ]
        / RADIUS_MM
    )
    return Motion(RADIUS_MM * np.column_stack([np.sin(way), 1 - np.cos(way), 0 * way]))


@pytest.mark.parametrize("wear", WORN)
@pytest.mark.parametrize("pickup", PICK_UPS)
def test_a_worn_tape_of_any_pick_up_plays(pickup: str, wear: str, tmp_path: Path) -> None:
    motion = circle(75.0)
    fmt = TapeFormat(pickup=pickup, cycles_per_mm=PICK_UPS[pickup].cycles_per_mm)
    record(motion, tmp_path / "a.wav", fmt)
    age(tmp_path / "a.wav", tmp_path / "b.wav", WORN[wear], seed=7)
    played = join(play(tmp_path / "b.wav"))
    flat = [
        Motion(np.c_[one.positions_mm[:, :2], np.full(len(one.positions_mm), -1.0)])
        for one in (motion, played)
    ]
    found = distance(thin([flat[1]]), thin([flat[0]]))
    # 0.4 um of following at 0.375 m/s² and 0.2 um of thinning beside the tape's own
    assert found.hausdorff_mm < 0.05 * fmt.mm_per_cycle + 0.6 * UM
