"""The presets of `age`: which of them plays, and why the others are refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.contour import distances_mm
from morfax.motion.faults import Fault, TapeFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import Tape, TapeFormat, record
from morfax.recorder.wear.settings import SETS, Wear
from morfax.recorder.wear.transport import age
from tests.player.worn import program

UM = 1e-3
MOTION = Motion(program(5.0))


@pytest.fixture(scope="module")
def tape(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A circle with a check signal."""
    file = tmp_path_factory.mktemp("presets") / "a.wav"
    record(MOTION, file, TapeFormat(checked=True))
    return file


def off_um(file: Path) -> float:
    """The largest distance of the played path from the motion's line, um."""
    path_mm = join(play(file)).positions_mm
    return float(distances_mm(path_mm[::31, :2], MOTION.positions_mm[:, :2]).max()) / UM


@pytest.mark.parametrize(
    ("wear", "within_um"),
    [
        # 52 dB of noise is 3e-4 cycle, crosstalk of 45 dB 1e-3; weave of 1.5 us at Z 5e-3: um
        (SETS["reel"], 2.0),
        (Wear(codec="mp3-128"), 1.0),
    ],
)
def test_what_plays(tape: Path, tmp_path: Path, wear: Wear, within_um: float) -> None:
    age(tape, tmp_path / "b.wav", wear, seed=3)
    assert off_um(tmp_path / "b.wav") < within_um


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("cassette", "phase of Z swings by .* tape that weaves"),
        ("answering-machine", "check signal of .* and not the carrier of 6000 Hz: the band"),
    ],
)
def test_what_is_refused_with_its_reason(
    tape: Path, tmp_path: Path, name: str, said: str
) -> None:
    age(tape, tmp_path / "b.wav", SETS[name], seed=3)
    with pytest.raises(TapeFault, match=said):
        join(play(tmp_path / "b.wav"))


def test_an_mp3_of_64_kbit_s_is_right_or_a_fault(tape: Path, tmp_path: Path) -> None:
    age(tape, tmp_path / "b.wav", SETS["mp3"])
    try:
        assert off_um(tmp_path / "b.wav") < 2.0
    except Fault as fault:
        assert "lost" in str(fault)


def test_a_codec_gives_back_as_many_frames_at_their_time(tape: Path, tmp_path: Path) -> None:
    age(tape, tmp_path / "b.wav", Wear(codec="mp3-128"))
    with Tape.open(tape) as one, Tape.open(tmp_path / "b.wav") as other:
        before, after = (np.vstack(list(each.blocks())) for each in (one, other))
    assert before.shape == after.shape
    # beside the first and the last granules of 1152 frames; LAME turns all down to 0.95 (0.45 dB)
    before, after = before[4800:-4800], after[4800:-4800] / 0.95
    # 30 dB: one frame of delay would be a sixth of a turn of 6 kHz, -2 dB
    assert np.sqrt(((after - before) ** 2).mean() / (before**2).mean()) < 0.03


def test_a_codec_that_is_none_is_refused(tape: Path, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="codec is 'mp2'; it must be one of mp3-64"):
        age(tape, tmp_path / "b.wav", Wear(codec="mp2"))


@pytest.mark.parametrize(
    ("better", "worse"), [("studio-15ips", "reel"), ("cassette", "answering-machine")]
)
def test_a_studio_s_machine_is_no_worse_than_a_reel_nor_a_cassette_than_half_its_speed(
    better: str, worse: str
) -> None:
    """In each part that both have; of what is told in dB below the carrier more is better."""
    first, second = SETS[better], SETS[worse]
    parts = "speed", "wow", "flutter", "scrape", "skew_s", "weave_s", "third", "uneven_db"
    lost = "dropouts_per_min", "dropout_s", "dropout_db"
    for name in (*parts, *lost):
        assert 0 < getattr(first, name) <= getattr(second, name), name
    assert first.noise_db is not None and second.noise_db is not None
    assert first.noise_db > second.noise_db
