"""Programs of lines and arcs on the command line: recorded, inspected, played, compared, refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.console.conftest import SAMPLES, Morfax


@pytest.fixture
def bracket(here: Path, morfax: Morfax) -> Path:
    """The program of a sample's truth."""
    assert morfax("record", SAMPLES / "bracket.csv", "-o", "bracket.ngc").exit_code == 0
    return here / "bracket.ngc"


def test_a_program_is_inspected_played_and_compared(bracket: Path, morfax: Morfax) -> None:
    found = morfax("inspect", bracket, "--json").figures
    assert (
        (found["lines"], found["arcs"], found["rapids"])
        == (
            11,
            4,
            4,
        )
    )  # 9 drawn, one down to where the path begins, one down into the slot; the last rapid is up at the end
    assert morfax("play", bracket, "-o", "played.csv").exit_code == 0
    figures = morfax("compare", "played.csv", SAMPLES / "bracket.csv", "--json").figures
    assert figures["largest_mm"] < 0.006  # 2 um of the fit, 4 pulses of 1 um


def test_the_norm_and_the_override_change_the_time(bracket: Path, morfax: Morfax) -> None:
    took = {
        words: morfax("play", bracket, *words, "--json").figures["duration_s"]
        for words in [(), ("--norm", "true"), ("--feed-override", "0.5")]
    }
    assert (
        took["--norm", "true"] < took[()] < took["--feed-override", "0.5"]
    )  # the weights make it up to 7 % slow


def test_a_program_is_played_in_the_units_of_1967(bracket: Path, morfax: Morfax) -> None:
    assert morfax("play", bracket, "--historic", "-o", "played.csv").exit_code == 0
    figures = morfax("compare", "played.csv", SAMPLES / "bracket.csv", "--json").figures
    # 3 pulses of 12.7 um, as much as arcs are off; measured 0.022, and below 0.006 with pulses of 1 um
    assert 0.006 < figures["largest_mm"] < 3 * 0.0127


def test_a_program_is_played_on_herbert_s_control(bracket: Path, morfax: Morfax) -> None:
    asked = "play", bracket, "--control", "herbert", "-o", "played.csv"
    assert morfax(*asked).exit_code == 0
    figures = morfax("compare", "played.csv", SAMPLES / "bracket.csv", "--json").figures
    assert figures["largest_mm"] < 0.006  # 2 um of the fit, 3 increments of 1 um
    assert "leave --control out" in morfax(*asked, "--norm", "true").fault


def test_what_is_for_another_control_is_refused(bracket: Path, morfax: Morfax) -> None:
    assert "is for tapes" in morfax("play", bracket, "--acceleration", "3000").fault
    assert (
        morfax("record", bracket, "-o", "bracket.wav").exit_code == 0
    )  # played on its own control first
    assert (
        "is for programs of lines and arcs"
        in morfax("play", "bracket.wav", "--norm", "true").fault
    )
    assert (
        "is for programs of lines and arcs" in morfax("play", "bracket.wav", "--historic").fault
    )
    assert (
        "is for programs of lines"
        in morfax("play", "bracket.wav", "--control", "herbert").fault
    )
    assert "the override is 3; give" in morfax("play", bracket, "--feed-override", "3").fault


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("G1 X5 F600\nG1 X6\n", "breaks off after line 3"),
        ("G1 X5 F600\nG41 X6\nM2\n", "line 2: G41 is not played"),
        ("G1 X5 F0\nM2\n", "line 1: F0 moves nothing"),
        ("G0 X0 Y0\nG2 X5 Y0 I2 F60\nM2\n", "line 2: I2 J0 is no centre of both ends"),
        (
            "G0 X0\nG1 X99999 F60\nM2\n",
            "line 2: X goes to 99999.000 mm; the machine has ±2000.000 mm",
        ),
    ],
)
def test_bad_programs_move_nothing_and_leave_nothing(
    text: str, says: str, here: Path, morfax: Morfax
) -> None:
    (here / "bad.ngc").write_text(text)
    answer = morfax("play", "bad.ngc", "-o", "played.csv")
    assert answer.exit_code == 5 and says in answer.fault
    assert [file.name for file in here.iterdir()] == ["bad.ngc"]
