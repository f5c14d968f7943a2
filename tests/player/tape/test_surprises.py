"""Rows at which an axis moves as its program never does, while its level is right."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.motion import Motion, join
from morfax.player.tape.bridges import Bound
from morfax.player.tape.phases import Phases
from morfax.player.tape.playback import play
from morfax.player.tape.predictor import count_turns, predictor_gains
from morfax.player.tape.surprises import Surprises, acceleration_gain
from morfax.player.tape.told_bounds import ToldBounds
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.tape.tape import record
from tests.player.attacks.bench import Bench, Kind
from tests.player.attacks.drawn import tone_in_phase
from tests.player.worn import corners

RATE_HZ = 6000.0
GAINS = predictor_gains(RATE_HZ)
HARD = 10_000 / RATE_HZ**2  # cycles/row²: 0.5 m/s² at 20 cycles per mm
ROWS = 1200


def phases(way: np.ndarray, noise: float = 0.0) -> Phases:
    """The rows of one axis that goes this way, cycles, beside a reference; both at a level of 0.5."""
    random = np.random.default_rng(1)
    turns = (way + random.normal(0, noise, len(way)))[None]
    cycles, surprise = np.empty((len(way), 1)), np.empty((len(way), 1), np.float32)
    count_turns(turns, GAINS, np.full((1, 3), np.nan), cycles, surprise)
    return Phases(0, cycles, surprise, np.full((len(way), 2), 0.5, np.float32))


class SameThroughout(ToldBounds):
    """Bounds that are the same in all rows."""

    def __init__(self, bound: Bound) -> None:
        super().__init__(RATE_HZ, 0.48)
        self._told = [(0.0, float(ROWS), bound)]


def lost(rows: Phases, acceleration: float) -> np.ndarray:
    """The rows that are lost where the tape tells this acceleration."""
    told = SameThroughout(Bound(acceleration, 0.03))  # at 9 mm/s
    found = Surprises(GAINS, TapeFormat(axes=("x",))).rows(rows, [told])
    return np.zeros(len(rows), bool) if found is None else found[:, 0]


def swung(size: float) -> np.ndarray:
    """A way of an acceleration that turns over when it surprises most: against the signs of the response."""
    ramp = phases(np.maximum(np.arange(ROWS) - ROWS // 2, 0.0) * 1e-3)
    signs = np.sign(ramp.surprise[:, 0])[::-1]
    return np.cumsum(np.cumsum(size * signs))


@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_no_motion_within_what_is_told_is_lost(noise: float) -> None:
    rows = phases(swung(HARD), noise)
    hardest = float(np.abs(rows.surprise).max())
    assert hardest > 0.7 * HARD * acceleration_gain(GAINS)  # the way asks for nearly all of it
    assert not lost(rows, HARD).any()


@pytest.mark.parametrize(("off", "begins"), [(0.05, 610), (0.1, 596)])
def test_what_is_a_twentieth_off_for_a_moment_is_lost(off: float, begins: int) -> None:
    """Blurred over eight rows, as the band filter does; a twentieth shows where it ends at the latest."""
    step = np.zeros(ROWS)
    step[600:618] = off
    rows = phases(np.convolve(step, np.full(8, 1 / 8), "same"))
    found = np.flatnonzero(lost(rows, HARD))
    assert begins <= found[0] < begins + 10
    assert 614 < found[-1] < 660
    assert not lost(rows, np.nan).any()  # nothing is told: a bare tape


def test_a_dip_is_lost_only_where_the_program_jumps() -> None:
    rows = phases(np.zeros(ROWS))
    rows.levels[700:704, 1] *= np.float32(0.97)
    assert not lost(rows, HARD).any()
    assert set(np.flatnonzero(lost(rows, 10 * HARD))) >= {700, 701, 702, 703}


def test_a_program_that_jumps_from_speed_to_speed_plays(tmp_path: Path) -> None:
    """A side of 3 mm is too short for 40 mm/s: the square jumps to it, and each jump makes the level dip."""
    motion = Motion(corners(3.0))
    record(motion, tmp_path / "square.wav")
    playback = play(tmp_path / "square.wav")
    join(playback)
    assert not playback.bridged


def test_a_short_tone_in_phase_with_its_track_is_never_silently_wrong(tmp_path: Path) -> None:
    """Five of these were 0.1 to 0.23 cycle off when only levels were watched."""
    square = corners(6.0, 40.0)
    square[:, 2] = 2 - 2 * np.clip(
        np.arange(len(square)) / 1500, 0, 1
    )  # jumps from speed to speed
    bench = Bench(tmp_path, square)
    kind = Kind("tone", tone_in_phase, "right or fault")
    found = [bench.tried(kind, seed) for seed in range(16)]
    assert not any(one.silently_wrong for one in found)
    assert any(one.fault is None for one in found)
