"""age by its behaviour."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
import soundfile

from tests.console.conftest import Morfax


def test_a_worn_tape_is_written_and_the_same_seed_gives_the_same(
    morfax: Morfax, here: Path, tape_file: Path
) -> None:
    for name in ("one.wav", "two.wav"):
        answer = morfax(
            "age",
            tape_file,
            "-o",
            name,
            "--preset",
            "cassette",
            "--speed-error",
            "-1%",
            "--seed",
            7,
            "--json",
        )
        assert answer.exit_code == 0
        assert answer.figures["duration_s"] == pytest.approx(
            soundfile.info(tape_file).duration / 0.99, rel=1e-3
        )
    assert (here / "one.wav").read_bytes() == (here / "two.wav").read_bytes()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--speed-error", "fast"], "no share"),
        (["--noise", "loud"], "no level"),
        (["--order", "1,2"], "each of the tracks"),
        (["--order", "x"], "names no tracks"),
        (["--preset", "gramophone"], "gramophone"),
        (["--stamped", "1e12"], "a header holds 1 to"),
    ],
)
def test_wrong_use_is_one_line(
    morfax: Morfax, here: Path, tape_file: Path, words: list[str], said: str
) -> None:
    answer = morfax("age", tape_file, "-o", "w.wav", *words)
    assert answer.exit_code == 2 and said in answer.fault
    assert list(here.iterdir()) == []


def test_a_fault_is_gone_on_from_by_hand(morfax: Morfax, here: Path, tape_file: Path) -> None:
    words = (
        "--dropouts",
        60,
        "--dropout-length",
        "30ms",
        "--dropout-depth",
        "60dB",
        "--cut-start",
        "0",
        "--seed",
        5,
    )
    assert morfax("age", tape_file, "-o", "holes.wav", *words).exit_code == 0
    told = morfax("play", "holes.wav", "-o", "a.csv")
    assert (
        told.exit_code == 6
        and "last certain position" in told.fault
        and "--resume-at" in told.fault
    )
    assert morfax("play", tape_file, "--resume-at", "2s").exit_code == 2
    assert morfax("play", tape_file, "--resume-at", "99s", "--from", "1,2,3").exit_code == 2
    whole = morfax("play", tape_file, "--json").figures
    rest = morfax(
        "play", tape_file, "--resume-at", "0.5s", "--from", "40,30,2", "--json"
    ).figures
    assert rest["end_place_mm"] == pytest.approx(whole["end_place_mm"], abs=1e-3)
    assert rest["duration_s"] == pytest.approx(whole["duration_s"] - 0.5, abs=0.01)


def test_a_tape_through_a_pipe(here: Path, tape_file: Path) -> None:
    with tape_file.open("rb") as tape:
        words = ["play", "-", "-o", "piped.csv", "--json"]
        code = "import sys; from morfax.console.cli import main; sys.exit(main(sys.argv[1:]))"
        answer = subprocess.run(
            [sys.executable, "-c", code, *words],
            stdin=tape,
            capture_output=True,
            text=True,
            check=False,
        )
    assert answer.returncode == 0, answer.stderr
    assert '"end_place_mm"' in answer.stdout and (here / "piped.csv").exists()


def test_a_tape_is_mended_or_told_why_not(morfax: Morfax, here: Path, tape_file: Path) -> None:
    assert morfax("record", str(tape_file), "-o", "plain.wav", "--plain").exit_code == 0
    tapes = {"one.wav": tape_file, "two.wav": here / "plain.wav", "both.wav": tape_file}
    for name, places_s in (
        ("one.wav", (2.5,)),
        ("two.wav", (2.5, 3.5)),
        ("both.wav", (2.5, 3.5)),
    ):
        frames, rate_hz = soundfile.read(tapes[name], dtype="int16")
        for at_s in places_s:
            frames[round(at_s * rate_hz) :][: round(0.04 * rate_hz), 1] = 0
        with soundfile.SoundFile(here / name, "w", rate_hz, 4, "PCM_16") as worn:
            worn.comment = soundfile.SoundFile(tapes[name]).comment
            worn.write(frames)
    answer = morfax("mend", "one.wav", "-o", "mended.wav", "--json")
    assert answer.exit_code == 0 and answer.figures["dropouts"] == 1
    assert answer.figures["mends"][0]["axis"] == "x"
    assert answer.figures["mends"][0]["time_s"] == pytest.approx(2.5, abs=0.002)
    assert morfax("play", "mended.wav", "-o", "mended.csv").exit_code == 0
    told = morfax("mend", "two.wav", "-o", "other.wav")
    assert (
        told.exit_code == 5
        and "cannot be known" in told.fault
        and not (here / "other.wav").exists()
    )
    # its check signal says what each of them lost
    both = morfax("mend", "both.wav", "-o", "other.wav", "--json")
    assert [round(one["time_s"], 1) for one in both.figures["mends"]] == [2.5, 3.5]


def test_tracks_in_another_order_are_put_right_by_hand(
    morfax: Morfax, here: Path, tape_file: Path
) -> None:
    assert morfax("age", tape_file, "-o", "mixed.wav", "--order", "2,1,4,3").exit_code == 0
    answer = morfax("play", "mixed.wav", "--tracks", "2,1,4,3", "--json")
    assert answer.exit_code == 0
    assert answer.figures["end_place_mm"] == pytest.approx([40, 30, 2], abs=1e-3)
    assert morfax("play", "mixed.wav", "--tracks", "2,1").exit_code == 5
    assert morfax("play", "mixed.wav", "--tracks", "x").exit_code == 2
