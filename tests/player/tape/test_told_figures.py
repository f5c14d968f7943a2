"""A text chunk that states other figures than the tracks were recorded with is a fault."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import soundfile

from morfax.motion.faults import TapeFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.playback import play
from morfax.recorder.tape.check_frame import CheckFrame, from_bits, to_bits
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.tape.tape import record
from morfax.recorder.tape.told_figures import StatedFigures, demand_agreement, frame_of
from tests.player.worn import corners

STATED = StatedFigures(20.0, ("x", "y", "z"), (50.0, 20.0, 2.0))


@pytest.fixture(scope="module")
def tape(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A checked tape of a square, from (50, 20, 2) mm."""
    file = tmp_path_factory.mktemp("tape") / "cam.wav"
    record(Motion(corners(3.0) + np.array([50.0, 20.0, 2.0])), file)
    return file


def changed(tape: Path, folder: Path, **entries: Any) -> Path:
    """The tape with other entries in its text."""
    with soundfile.SoundFile(tape) as sound:
        text, frames, rate_hz = json.loads(sound.comment), sound.read(dtype="int16"), 48000
    out = folder / "changed.wav"
    with soundfile.SoundFile(out, "w", rate_hz, frames.shape[1], "PCM_16") as sound:
        sound.comment = json.dumps({**text, **entries})
        sound.write(frames)
    return out


@pytest.mark.parametrize(
    ("entries", "says"),
    [
        ({"cycles_per_mm": 30.0}, "states 30 cycles per mm, and its tracks say 20:.*--cycles-per-mm 20,"),
        ({"cycles_per_mm": 20.001}, "states 20.001 cycles per mm"),
        ({"start_mm": [50.0, 21.0, 2.0]}, "start 50,21,2 mm, and its tracks were recorded with others"),
        ({"axes": ["y", "x", "z"]}, "states the axes y, x, z"),
    ],
)  # fmt: skip
def test_a_changed_figure_is_a_fault(
    tape: Path, tmp_path: Path, entries: dict[str, Any], says: str
) -> None:
    with pytest.raises(TapeFault, match=says):
        join(play(changed(tape, tmp_path, **entries)))


def test_what_the_fault_says_to_do_plays_the_tape(tape: Path, tmp_path: Path) -> None:
    clean = join(play(tape)).positions_mm
    other = changed(tape, tmp_path, cycles_per_mm=30.0)
    assert np.array_equal(join(play(other, cycles_per_mm=20.0)).positions_mm, clean)
    doubled = play(tape, cycles_per_mm=10.0)  # another travel, on purpose
    assert len(join(doubled).positions_mm) and "2 times as long" in doubled.notes[0]
    assert not play(tape).notes


@pytest.mark.parametrize(
    ("by_hand", "says"),
    [
        ({"start_mm": (50.0, 20.0, 2.0)}, []),
        ({}, ["not recorded from 0,0,0 mm.*--from"]),
        ({"start_mm": (50.0, 20.0, 2.1)}, ["not recorded from 50,20,2.1 mm"]),
        (
            {"start_mm": (50.0, 20.0, 2.0), "cycles_per_mm": 10.0},
            ["with 20 cycles per mm and is played with 10: all lengths are 2 times"],
        ),
    ],
)  # fmt: skip
def test_a_tape_that_has_lost_its_text_tells_figures_by_hand_that_are_not_its_own(
    tape: Path, tmp_path: Path, by_hand: dict[str, Any], says: list[str]
) -> None:
    with soundfile.SoundFile(tape) as sound:
        frames = sound.read(dtype="int16")
    soundfile.write(tmp_path / "bare.wav", frames, 48000, "PCM_16")
    playback = play(
        tmp_path / "bare.wav", **{"reference_hz": 6000.0, "cycles_per_mm": 20.0, **by_hand}
    )
    join(playback)
    assert len(playback.notes) == len(says)
    assert all(re.search(text, note) for text, note in zip(says, playback.notes, strict=True))


@pytest.mark.parametrize("cycles_per_mm", [20.0, 787.4015748, 1e-4, 12345.678])
def test_a_frame_tells_its_figures_and_no_others(cycles_per_mm: float) -> None:
    stated = STATED._replace(cycles_per_mm=cycles_per_mm)
    said = from_bits(to_bits(frame_of(stated, 7, False))[None])[0]
    assert said is not None
    demand_agreement(said, stated, stated)
    for off in (1 + 3e-6, 1.1, 10.0):
        other = stated._replace(cycles_per_mm=cycles_per_mm * off)
        with pytest.raises(TapeFault):
            demand_agreement(said, other, other)


def test_a_tape_of_an_earlier_version_tells_nothing() -> None:
    demand_agreement(CheckFrame(0, 7, 0.0), STATED, STATED)
    # beyond what can be told
    far = STATED._replace(cycles_per_mm=1e9)
    said = from_bits(to_bits(frame_of(far, 0, False))[None])[0]
    assert said is not None
    demand_agreement(said, far, far)


def test_the_text_does_not_hold_what_it_states_twice() -> None:
    fmt = TapeFormat.from_json(TapeFormat(start_mm=(1.0, 2.0, 3.0)).to_json())
    assert fmt.stated == (20.0, ("x", "y", "z"), (1.0, 2.0, 3.0))
    assert "stated" not in fmt.to_json()
