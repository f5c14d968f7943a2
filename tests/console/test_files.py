"""Files in and out: missing, in the way, not to be written."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.console.conftest import SAMPLES, Morfax


@pytest.mark.parametrize(
    "words",
    [
        ["trace", "missing.png"],
        ["play", "missing.wav"],
        ["inspect", "missing.wav"],
        ["record", "missing.csv"],
        ["compare", "missing.csv", "missing.wav"],
        ["run", "missing.png", "-o", "results"],
    ],
)
def test_a_missing_file_is_told_by_its_name(
    morfax: Morfax, here: Path, words: list[str]
) -> None:
    answer = morfax(*words)
    assert answer.exit_code == 8 and "missing." in answer.fault
    assert list(here.iterdir()) == []


def test_a_second_name_for_one_result_is_refused(morfax: Morfax, here: Path) -> None:
    answer = morfax("trace", SAMPLES / "cam.png", "-o", "a.ngc", "-o", "b.csv")
    assert answer.exit_code == 2 and "-o is given twice" in answer.fault
    assert list(here.iterdir()) == []


@pytest.mark.parametrize("output", ["nowhere/a.csv", "folder.csv"])
def test_an_output_that_cannot_be_written_is_told_before_the_work(
    morfax: Morfax, here: Path, tape_file: Path, output: str
) -> None:
    (here / "folder.csv").mkdir()
    answer = morfax("play", tape_file, "-o", output)
    assert answer.exit_code == 8 and output in answer.fault


def test_a_result_never_goes_over_what_it_is_made_from(
    morfax: Morfax, here: Path, path_file: Path
) -> None:
    shutil.copy(path_file, here / "a.wav")  # a path file under the name of a tape
    before = (here / "a.wav").read_bytes()
    answer = morfax("record", "a.wav", "-o", "a.wav")
    assert answer.exit_code == 8 and "made from" in answer.fault
    assert (here / "a.wav").read_bytes() == before


def test_a_made_up_name_that_is_taken_is_left_alone_unless_forced(
    morfax: Morfax, here: Path, path_file: Path
) -> None:
    (here / "circle.wav").write_text("dear to somebody")
    answer = morfax("record", path_file)
    assert answer.exit_code == 8 and "--force" in answer.fault
    assert (here / "circle.wav").read_text() == "dear to somebody"
    assert morfax("record", path_file, "--force").exit_code == 0
    assert (
        morfax("record", path_file, "-o", "circle.wav").exit_code == 0
    )  # a name that was given is written over


def test_verbs_that_write_over_a_given_name_take_force_too(
    morfax: Morfax, here: Path, path_file: Path, tape_file: Path
) -> None:
    for words, name in (
        (("play", tape_file, "-o"), "played.csv"),
        (("compare", path_file, path_file, "--picture"), "error.svg"),
    ):
        (here / name).write_text("of yesterday")
        assert morfax(*words, name, "--force").exit_code == 0
        with_it = (here / name).read_bytes()
        assert morfax(*words, name).exit_code == 0  # as without it
        assert len((here / name).read_bytes()) == len(with_it) > 100


def test_force_writes_no_result_over_what_it_is_made_from(
    morfax: Morfax, here: Path, tape_file: Path
) -> None:
    shutil.copy(tape_file, here / "tape.csv")  # a tape under the name of a path file
    answer = morfax("play", "tape.csv", "-o", "tape.csv", "--force")
    assert answer.exit_code == 8 and "made from" in answer.fault


def test_an_ending_that_says_no_kind_of_file_is_wrong_use(
    morfax: Morfax, here: Path, tape_file: Path
) -> None:
    answer = morfax("play", tape_file, "-o", "path.doc")
    assert answer.exit_code == 2 and ".svg" in answer.fault


def test_a_path_file_with_a_bad_line_is_told_by_its_line(morfax: Morfax, here: Path) -> None:
    (here / "bad.csv").write_text("x_mm,y_mm\n0,0\n1,wide\n")
    answer = morfax("record", "bad.csv")
    assert answer.exit_code == 7 and "line 3" in answer.fault


@pytest.mark.parametrize("verb", ["record", "play"])
def test_a_drawing_is_no_path_and_no_tape(morfax: Morfax, here: Path, verb: str) -> None:
    answer = morfax(verb, SAMPLES / "cam.png", "-o", "cam.ngc")
    assert answer.exit_code == 2 and "`morfax trace cam.png` makes one of it" in answer.fault
    assert not (here / "cam.ngc").exists()


def test_each_result_has_a_file_of_its_own(morfax: Morfax, path_file: Path, here: Path) -> None:
    """Of two results under one name the second would replace the first without a word."""
    (here / "sub").mkdir()
    (here / "link.csv").symlink_to(here / "a.csv")
    cam, tape = SAMPLES / "cam.png", here / "a.wav"
    assert morfax("record", path_file, "-o", tape).exit_code == 0
    for one, other in (("a.csv", "./a.csv"), ("a.csv", "sub/../a.csv"), ("link.csv", "a.csv")):
        answer = morfax("play", tape, "-o", one, "--following", other)
        assert answer.exit_code == 2
        assert f"{one} and {Path(other)} are one file, for two results" in answer.fault
    answer = morfax("trace", cam, "-o", "a.svg", "--picture", here / "a.svg")
    assert answer.exit_code == 2 and "are one file, for two results" in answer.fault
    answer = morfax("trace", cam, "-o", "a.csv", "--path", "b.csv")
    assert answer.exit_code == 2 and "would both hold the head's path" in answer.fault
    assert not any((here / name).exists() for name in ("a.csv", "b.csv", "a.svg"))


@pytest.fixture
def small_disk(tmp_path: Path) -> Path:
    """A disk of 64 kB, where this machine allows to make one."""
    disk = tmp_path / "disk"
    disk.mkdir()
    try:
        subprocess.run(
            ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", disk],
            check=True,
            capture_output=True,
        )
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("no disk can be mounted here")
    return disk


def test_a_full_disk_is_told_and_leaves_nothing(
    morfax: Morfax, small_disk: Path, path_file: Path
) -> None:
    try:
        answer = morfax("record", path_file, "-o", small_disk / "a.wav")
        assert answer.exit_code == 8 and "full" in answer.fault
        assert list(small_disk.iterdir()) == []
    finally:
        subprocess.run(["umount", small_disk], check=True)
