"""Dropouts: the bound of what is certain, from both sides."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.faults import LockFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.bridges import Bridge, bridge, filled, side
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import TapeFormat, record
from tests.player.worn import program

RATE_HZ = 48000
FILTER_MS = 1.7  # what the filter adds to a dropout


def parabola(rows: np.ndarray) -> np.ndarray:
    """A motion of an even acceleration, cycles."""
    return 5 + 0.03 * rows + 1e-4 * rows**2


def test_a_side_is_the_motion_at_its_edge() -> None:
    found = side(parabola(np.arange(-35, 1)), 35)
    assert (found.place, found.speed, found.bend) == pytest.approx((5, 0.03, 1e-4), abs=1e-9)
    assert found.misfit < 1e-9


def test_an_even_motion_is_bridged_exactly() -> None:
    before, after = (
        side(parabola(np.arange(-35, 1)), 35),
        side(parabola(np.arange(30, 66)) - 3, 0),
    )
    found = bridge(before, after, 30, 0.0)
    assert found.travel == pytest.approx(
        parabola(np.array(30.0)) - 5, abs=1e-9
    )  # three cycles were miscounted
    assert found.off == pytest.approx(0, abs=1e-9)
    between = filled(before, after, found.travel, 30)
    assert between == pytest.approx(parabola(np.arange(1, 30)), abs=1e-9)


def test_the_bound_is_where_another_count_could_be_meant() -> None:
    # There and back with the acceleration A in the gap T: A T² / 4 of travel, against one cycle less the
    # margin.
    limit_s = 6.0e-3  # A T² / 4 = 0.9 cycle at 5 m/s² and 20 cycles/mm
    rate_hz, acceleration = 6000, 5000 * 20 / 6000**2
    still = side(np.zeros(36), 35)
    assert bridge(still, still, int(limit_s * rate_hz) - 1, acceleration).certain
    assert not bridge(still, still, int(limit_s * rate_hz) + 1, acceleration).certain


@pytest.mark.parametrize("bad", ["off", "between", "misfit"])
def test_sides_that_do_not_agree_are_not_certain(bad: str) -> None:
    parts = {"travel": 1.0, "off": 0.01, "reach": 0.2, "between": 0.01, "misfit": 0.01}
    assert Bridge(**parts).certain
    assert not Bridge(
        **{**parts, bad: {"off": 0.8, "between": 0.06, "misfit": 0.05}[bad]}
    ).certain


@pytest.fixture
def tape(tmp_path: Path) -> Path:
    """A bare tape: a circle of 10 mm at 10 mm/s."""
    record(Motion(program()), tmp_path / "a.wav", TapeFormat())
    return tmp_path / "a.wav"


def holed(
    tape: Path, length_ms: float, tracks: slice = slice(1, 2), left: float = 0.01
) -> Path:
    """The tape with a dropout at 3 s, in which a share of the level is left."""
    with soundfile.SoundFile(tape) as sound:
        frames, text = sound.read(dtype="float32"), sound.comment
    frames[3 * RATE_HZ : 3 * RATE_HZ + round(length_ms * 48), tracks] *= left
    file = tape.with_name("holed.wav")
    with soundfile.SoundFile(file, "w", RATE_HZ, 4, "PCM_16") as out:
        out.comment = text
        out.write(frames)
    return file


@pytest.mark.parametrize(
    "tracks", [slice(1, 2), slice(0, 1), slice(0, 4)], ids=["X", "reference", "all"]
)
@pytest.mark.parametrize(("acceleration_mm_s2", "limit_ms"), [(None, 6.0), (500.0, 18.9)])
def test_dropouts_from_both_sides_of_the_bound(
    tape: Path, tracks: slice, acceleration_mm_s2: float | None, limit_ms: float
) -> None:
    whole = join(play(tape)).positions_mm
    playback = play(
        holed(tape, limit_ms - FILTER_MS - 1.0, tracks), acceleration_mm_s2=acceleration_mm_s2
    )
    went = join(playback).positions_mm
    assert np.abs(went - whole).max() * 20 < 0.01  # cycles: a smooth motion
    assert {name for _, name in playback.bridged} == (
        {"x"} if tracks == slice(1, 2) else {"x", "y", "z"}
    )
    with pytest.raises(
        LockFault, match="how many cycles passed there is not certain"
    ) as caught:
        join(
            play(
                holed(tape, limit_ms - FILTER_MS + 1.0, tracks),
                acceleration_mm_s2=acceleration_mm_s2,
            )
        )
    fault = caught.value
    assert fault.time_s == pytest.approx(3, abs=0.002)
    row = round(fault.time_s * 6000)
    assert fault.position_mm == pytest.approx(whole[row, "xyz".index(fault.axis)], abs=0.002)


@pytest.mark.parametrize(("left", "bridged"), [(0.35, True), (0.7, True), (0.85, False)])
def test_a_level_a_fifth_off_is_a_dropout(tape: Path, left: float, bridged: bool) -> None:
    """Another signal of a fifth of the level turns the phase by 0.03 cycle; less is let pass."""
    playback = play(holed(tape, 2.0, left=left))
    join(playback)
    assert {name for _, name in playback.bridged} == ({"x"} if bridged else set())


def test_from_a_fault_one_goes_on_by_hand(tape: Path) -> None:
    whole, file = join(play(tape)).positions_mm, holed(tape, 30)
    with pytest.raises(LockFault):
        join(play(file))
    resumed = join(play(file, resume_at_s=3.05, start_mm=tuple(whole[18300])))
    assert resumed.start_s == pytest.approx(3.05)
    assert np.abs(resumed.positions_mm[600:] - whole[18900:]).max() < 0.002
    with pytest.raises(ValueError, match="must be said"):
        play(file, resume_at_s=3.05)
    with pytest.raises(ValueError, match="cannot be resumed at 99"):
        play(file, resume_at_s=99, start_mm=(0, 0))


@pytest.mark.parametrize("missing_s", [0.05, 0.2, 1.0])
def test_a_cut_is_told_as_one(tape: Path, tmp_path: Path, missing_s: float) -> None:
    """It looks like a dropout as long as the filter, whatever is missing."""
    frames, rate_hz = soundfile.read(tape, dtype="int16")
    with soundfile.SoundFile(tape) as sound:
        text = sound.comment
    at = len(frames) // 3
    cut = tmp_path / "cut.wav"
    with soundfile.SoundFile(cut, "w", rate_hz, frames.shape[1], "PCM_16") as sound:
        sound.comment = text
        sound.write(np.concatenate([frames[:at], frames[at + round(missing_s * rate_hz) :]]))
    with pytest.raises(LockFault, match=r"ms at .* s \(or the tape is cut there"):
        join(play(cut))


def test_a_dropout_longer_than_the_filter_is_no_cut(tape: Path) -> None:
    with pytest.raises(LockFault, match=r"was lost for 2\d\.\d ms at \d\.\d* s, last"):
        join(play(holed(tape, 25.0, slice(1, 2))))
