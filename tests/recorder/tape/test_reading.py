"""Tapes as they are read: what is given by hand, no text or another one, no tape, tapes cut short."""

import os
from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.faults import FileFault, TapeFault
from morfax.recorder.tape.tape import Tape, TapeFormat, record
from tests.recorder.tape.circles import circle


def test_what_is_given_by_hand_goes_before_the_text(tmp_path: Path) -> None:
    record(circle(), tmp_path / "a.wav")
    with Tape.open(tmp_path / "a.wav", reference_hz=3000, start_mm=(0, 0)) as tape:
        assert tape.format.reference_hz == 3000
        assert tape.format.cycles_per_mm == 20
        assert tape.format.start_mm == (0.0, 0.0, -2.0)
        end = circle()[0].positions_mm[-1] - [50, 20, 0]  # moved with the start
        assert tape.format.end_mm == pytest.approx(end, abs=1e-6)
    with Tape.open(tmp_path / "a.wav", cycles_per_mm=10) as tape:
        assert tape.format.end_mm is None  # twice the travel ends elsewhere
    with pytest.raises(ValueError, match="4 places; the tape has 3 axes"):
        Tape.open(tmp_path / "a.wav", start_mm=(0, 0, 0, 0))
    with pytest.raises(TapeFault, match="cannot be played so: reference_hz is 20000"):
        Tape.open(tmp_path / "a.wav", reference_hz=20_000)


def test_a_tape_without_text_needs_two_figures(tmp_path: Path) -> None:
    soundfile.write(tmp_path / "a.wav", np.zeros((100, 5)), 44_100)
    with pytest.raises(
        TapeFault, match="--label, or --reference-frequency 6kHz --cycles-per-mm 20"
    ):
        Tape.open(tmp_path / "a.wav")
    with pytest.raises(TapeFault, match="or --cycles-per-mm 20"):
        Tape.open(tmp_path / "a.wav", reference_hz=6000)
    with Tape.open(
        tmp_path / "a.wav", reference_hz=6000, cycles_per_mm=20, start_mm=(1, 2)
    ) as tape:
        assert tape.format.axes == ("x", "y", "z", "a")
        assert tape.format.start_mm == (1.0, 2.0, 0.0, 0.0)
        assert tape.format.sample_rate_hz == 44_100
        assert tape.format.motion_rate_hz == 6300
        assert tape.text == ""


def test_a_remark_of_a_sound_program_is_no_format(tmp_path: Path) -> None:
    with soundfile.SoundFile(tmp_path / "a.wav", "w", 48_000, 4) as out:
        out.comment = "mastered"
        out.write(np.zeros((100, 4)))
    with pytest.raises(TapeFault, match="does not say its format"):
        Tape.open(tmp_path / "a.wav")


def test_a_resampled_tape_goes_by_its_own_rate(tmp_path: Path) -> None:
    with soundfile.SoundFile(tmp_path / "a.wav", "w", 44_100, 4) as out:
        out.comment = TapeFormat().to_json()
        out.write(np.zeros((100, 4)))
    with Tape.open(tmp_path / "a.wav") as tape:
        assert tape.format.sample_rate_hz == 44_100


@pytest.mark.parametrize(
    ("tracks", "text", "fault"),
    [
        (1, "", "has one track; a tape has at least 3"),
        (2, "", "has 2 tracks; a tape has at least 3"),
        (5, TapeFormat().to_json(), "has 5 tracks, but its text chunk speaks of 4"),
        (4, '{"version": 9}', "version 9; this program reads 3"),
        (4, "{broken", "no JSON object"),
    ],
)
def test_sounds_that_are_no_tape(tmp_path: Path, tracks: int, text: str, fault: str) -> None:
    with soundfile.SoundFile(tmp_path / "a.wav", "w", 48_000, tracks) as out:
        if text:
            out.comment = text
        out.write(np.zeros((100, tracks)))
    with pytest.raises(TapeFault, match=fault):
        Tape.open(tmp_path / "a.wav")


def test_files_that_are_no_sound(tmp_path: Path) -> None:
    for name, content, fault in (
        ("a.wav", b"", "is empty"),
        ("a.wav", b"RIFF", "is no tape"),
        ("a.wav", b"t_s,x_mm,y_mm\n0,0,0\n", "is no tape"),
        ("a.raw", b"0123456789", "is no tape"),
    ):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(TapeFault, match=fault):
            Tape.open(tmp_path / name)
    soundfile.write(tmp_path / "a.wav", np.zeros((0, 4)), 48_000)
    with pytest.raises(TapeFault, match="holds no frames"):
        Tape.open(tmp_path / "a.wav")
    with pytest.raises(FileFault, match="No such file"):
        Tape.open(tmp_path / "none.wav")
    with pytest.raises(FileFault, match="directory"):
        Tape.open(tmp_path)


@pytest.mark.parametrize("name", ["a.wav", "a.rf64", "a.flac"])
@pytest.mark.parametrize("share", [0.02, 0.5, 0.999])
def test_a_tape_cut_short_is_told(tmp_path: Path, name: str, share: float) -> None:
    record(circle(), tmp_path / name)
    whole = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(TapeFault, match="is cut short"):
        Tape.open(tmp_path / name)


def test_a_tape_that_is_cut_while_it_is_read(tmp_path: Path) -> None:
    record(circle(), tmp_path / "a.wav")
    with Tape.open(tmp_path / "a.wav") as tape:
        os.truncate(tmp_path / "a.wav", 100_000)
        with pytest.raises(TapeFault, match=r"is cut short: 0\.2"):
            list(tape.blocks(4096))


def test_blocks_are_of_the_size_asked_for(tmp_path: Path) -> None:
    recording = record(circle(), tmp_path / "a.wav")
    with Tape.open(tmp_path / "a.wav") as tape:
        sizes = [len(block) for block in tape.blocks(1000)]
        assert sizes[:-1] == [1000] * (len(sizes) - 1)
        # and again from the start
        assert sum(sizes) == recording.frames == sum(len(block) for block in tape.blocks())
        assert all(block.dtype == np.float32 for block in tape.blocks())
        with pytest.raises(ValueError, match="at least 1"):
            next(tape.blocks(0))
