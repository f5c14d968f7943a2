"""`devices`, `--device`, `--label`, `--stereo` and tapes through pipes, on a cable in a device's place."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.motion import join
from morfax.player.tape.playback import play_pipe
from tests.console.conftest import Morfax
from tests.recorder.sound.stand_in import Cable, plugged_in

LINE = "x,y\n10,10\n20,10\n20,15\n"


@pytest.fixture
def cable(monkeypatch: pytest.MonkeyPatch) -> Cable:
    """A cable; it is faster than the recorder, so all is made before it starts."""
    return plugged_in(monkeypatch)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A short path file."""
    file = tmp_path / "line.csv"
    file.write_text(LINE)
    return file


def test_devices_are_listed(morfax: Morfax, cable: Cable) -> None:
    first = morfax("devices", "--json").figures["devices"][0]
    assert (first["number"], first["name"], first["inputs"]) == (0, "Cable one", 4)


def test_a_tone_shows_on_the_meters(morfax: Morfax, cable: Cable) -> None:
    told = morfax(
        "devices", "--test-tone", "0", "--meters", "0", "--for", "1s", "--json"
    ).figures
    # 0.5 of full scale and the check signal, a fifth of it: -6.0 + 0.17 dB
    assert told["track_4"]["level_db"] == pytest.approx(-5.85, abs=0.05)
    assert told["track_1"]["frequency_hz"] == pytest.approx(6000, abs=0.5)


def test_a_tape_goes_out_and_comes_in(morfax: Morfax, cable: Cable, path: Path) -> None:
    label, out = path.with_suffix(".json"), path.with_name("played.csv")
    assert morfax("record", path, "--device", "0", "--label", label).exit_code == 0
    told = morfax("play", "--device", "0", "--label", label, "-o", out, "--json").figures
    assert told["end_place_mm"][:2] == pytest.approx([20, 15], abs=1e-3)
    assert out.is_file()


def test_what_a_device_loses_leaves_no_file(morfax: Morfax, cable: Cable, path: Path) -> None:
    label, out = path.with_suffix(".json"), path.with_name("played.csv")
    cable.underflow_at = 20
    refused = morfax("record", path, "--device", "0", "--label", label)
    assert refused.exit_code == 10 and "underrun" in refused.fault and not label.exists()
    silent = morfax("play", "--device", "1", "--wait", "1s", *BY_HAND, "-o", out)
    assert silent.exit_code in (5, 10) and not out.exists()


BY_HAND = ("--reference-frequency", "6kHz", "--cycles-per-mm", "20")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("play",), "give a TAPE, or a --device"),
        (("play", "a.wav", "--device", "0"), "give a TAPE, or a --device"),
        (("record", "line.csv", "-o", "a.wav", "--device", "0"), "leave out --device, or -o"),
        (("record", "line.csv", "--stereo"), "give -o a name such as cam.wav"),
        (("record", "line.csv", "--stereo", "-o", "a.ngc"), "--stereo is for tapes"),
        (("age", "a.wav", "-o", "b.wav", "--as", "cassette"), "--as is called --preset now"),
    ],
)
def test_what_does_not_go_together(
    morfax: Morfax,
    path: Path,
    monkeypatch: pytest.MonkeyPatch,
    words: tuple[str, ...],
    said: str,
) -> None:
    monkeypatch.chdir(path.parent)
    answer = morfax(*words)
    assert answer.exit_code == 2 and said in answer.fault


def test_a_tape_through_a_pipe(path: Path, capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    from morfax.console.cli import main

    assert main(["record", str(path), "-o", "-", "--quiet"]) == 0
    played = join(play_pipe(io.BytesIO(capfdbinary.readouterr().out)))
    assert played.positions_mm[-1][:2] == pytest.approx([20, 15], abs=1e-3)


def test_a_label_says_what_a_sound_program_dropped(morfax: Morfax, path: Path) -> None:
    tape, label, bare = (path.with_name(name) for name in ("a.wav", "a.json", "b.wav"))
    assert morfax("record", path, "-o", tape, "--label", label).exit_code == 0
    frames, rate_hz = soundfile.read(tape)
    soundfile.write(bare, frames, rate_hz)
    assert morfax("play", bare).exit_code == 5
    for said in (label, tape):
        told = morfax("play", bare, "--label", said, "--json").figures
        assert told["start_place_mm"][:2] == pytest.approx([10, 10], abs=1e-3)
    label.write_text("{}")
    assert morfax("play", bare, "--label", label).exit_code == 5


def test_two_stereo_files(morfax: Morfax, path: Path) -> None:
    assert morfax("record", path, "-o", path.with_name("a.wav"), "--stereo").exit_code == 0
    one, other = path.with_name("a.1-2.wav"), path.with_name("a.3-4.wav")
    told = morfax("play", one, "--second", other, "--json").figures
    assert np.allclose(told["end_place_mm"][:2], [20, 15], atol=1e-3)
    assert "--second" in morfax("play", one).fault
