"""Claims 15 to 17 of patent ES 361967, the machine that plays; the others are in `test_morfax_claims`."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.drive import Condition
from morfax.motion.faults import FollowingFault, LockFault
from morfax.motion.motion import Motion, join
from morfax.motion.ramp import positions_mm
from morfax.player.tape.playback import play
from morfax.player.tape.sector_wheel import SectorWheel
from morfax.recorder.tape.tape import record
from tests.sources.drawn_tape import (
    RADIUS_MM,
    RATE_HZ,
    SPEED_MM_S,
    UM,
    edges_of_the_cells,
)


def tones(file: Path, *hz: float, seconds: float = 2.0) -> Path:
    """A tape of tones alone, one to a track, made without the recorder and without a format."""
    t_s = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    # from one frequency to its own within a tenth of a second, as no motor starts at once
    gently = np.where(t_s < 0.1, 5 * t_s**2, t_s - 0.05)
    tracks = [0.5 * np.sin(2 * np.pi * (hz[0] * t_s + (one - hz[0]) * gently)) for one in hz]
    soundfile.write(file, np.column_stack(tracks), RATE_HZ, subtype="PCM_16")
    return file


def test_claim_15_each_axis_moves_as_its_frequency_is_above_or_below(tmp_path: Path) -> None:
    for given, mm_s in (
        ((6000, 6200, 5900, 6040), (10, -5, 2)),
        ((6000, 6200, 5900), (10, -5, 0)),
    ):  # Z if there is one
        played = join(
            play(tones(tmp_path / "a.wav", *given), reference_hz=6000, cycles_per_mm=20)
        ).positions_mm
        assert (played[11_000] - played[5_000]).tolist() == pytest.approx(
            list(mm_s), abs=1 * UM
        )  # in one second


def test_claim_16_the_reference_from_the_tape_turns_the_wheel_of_every_axis(
    tmp_path: Path,
) -> None:
    """A tape on which everything is 2 % high means the same motion; one whose reference alone is 20 Hz off
    moves all axes.
    """
    high = tones(tmp_path / "a.wav", 6120, 6120 + 204, 6120 - 102, 6120)
    played = join(play(high, reference_hz=6000, cycles_per_mm=20)).positions_mm
    assert (played[11_000] - played[5_000]).tolist() == pytest.approx(
        [10.2, -5.1, 0], abs=1 * UM
    )
    # the feedback is a signal about the reference: 2 s of 6 kHz on Z, which stands; above it on X, below on Y
    machine = play(high, reference_hz=6000, cycles_per_mm=20)
    *_, (edges, expected) = edges_of_the_cells(machine)
    assert np.abs(edges - expected).max() <= 1.1
    assert edges[2] == pytest.approx(12_000, abs=1) and edges[0] > 12_300 and edges[1] < 11_850
    off = tones(tmp_path / "b.wav", 5980, 6000, 6000, 6000)
    alike = play(off, reference_hz=6000, cycles_per_mm=20, alike=("x", "y", "z"))
    played = join(alike).positions_mm
    assert (played[11_000] - played[5_000]).tolist() == pytest.approx([1, 1, 1], abs=1 * UM)


def test_claim_17_the_motor_turns_a_member_whose_signal_is_fed_back(tmp_path: Path) -> None:
    """A loop makes up for a motor that has lost gain and is held by friction; one that does not turn is found
    out.
    """
    way = positions_mm([0.0], [2 * math.pi * RADIUS_MM], SPEED_MM_S)[:, 0] / RADIUS_MM
    circle = RADIUS_MM * np.column_stack([np.sin(way), 1 - np.cos(way), 0 * way])
    record(Motion(circle), tmp_path / "a.wav")
    weak = play(tmp_path / "a.wav")
    weak.conditions[0] = Condition(gain_share=0.7, friction_mm_s=0.5)
    played = join(weak).positions_mm[6000 : 6000 + len(circle)]
    # an open loop would be 0.5 mm/s and 30 % of 10 mm/s behind: after six seconds some mm
    assert np.abs(played - circle).max() < 3 * UM
    # it is the cell's signal that is fed back: an arm 0.1 mm off the axis of a wheel of 30 mm radius leads
    # the screw astray, once in each of its turns of 5 mm, and without light nothing leads it
    bent = join(play(tmp_path / "a.wav", wheel=SectorWheel(eccentricity_mm=0.1))).positions_mm
    # 2.7 um; the loop leaves 0.5 um at 0.5 m/s²
    wobble = 5.0 / (2 * np.pi) * 0.1 / 30 * np.sin(2 * np.pi * circle / 5.0)
    assert np.abs(bent[6000 : 6000 + len(circle)] - (circle - wobble)).max() < 0.6 * UM
    with pytest.raises(LockFault, match="its pick-up gives no signal"):
        join(play(tmp_path / "a.wav", wheel=SectorWheel(light=0.05)))
    stuck = play(tmp_path / "a.wav")
    stuck.conditions[1] = Condition(stuck=True)
    with pytest.raises((LockFault, FollowingFault)) as caught:
        join(stuck)
    assert caught.value.axis == "y"
