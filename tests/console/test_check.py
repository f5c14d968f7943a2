"""`morfax check`: the verdict, every finding with its line, the picture; and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.console.conftest import SAMPLES, Morfax

PART = (
    "G21 G90 G94",
    "M3 S9000",
    "G0 Z5",
    "G0 X1 Y1",
    "G1 Z-2 F120",
    "G3 X1 Y1 I10 J0 F600",
    "G0 Z5",
)
BAD = ("G64 P0.01", "G0 X30 Z-1", "M5", "G1 X31", "G2 X31 Y9 I1 J3")


@pytest.fixture
def part(here: Path) -> Path:
    """A round hole, 2 mm deep."""
    file = here / "part.nc"
    file.write_text("\n".join([*PART, "M5", "M2", ""]))
    return file


def test_a_sound_program_may_be_started(morfax: Morfax, part: Path) -> None:
    answer = morfax("check", part, "--machine", "grbl-router", "--json")
    figures = answer.figures
    assert answer.exit_code == 0 and figures["may_be_started"] and figures["findings"] == []
    assert figures["depth_mm"] == 2 and figures["lines"] == 9 and figures["cuts"] == 1
    assert figures["width_mm"] == figures["height_mm"] == 20  # mm, twice the radius
    assert figures["x_axis"] == {"from_mm": 1, "to_mm": 21, "travel_mm": 20}
    assert figures["fastest_feed_mm_s"] == 10 and 9.8 < figures["duration_s"] < 11


def test_play_and_inspect_say_the_time_that_check_says(morfax: Morfax, part: Path) -> None:
    """They gave only what the simulated machine takes, whose rapids and corners are slower."""
    machine = ("--machine", "grbl-router")
    seconds = morfax("check", part, *machine, "--json").figures["duration_s"]
    for verb in ("play", "inspect"):
        figures = morfax(verb, part, *machine, "--json").figures
        assert (figures["machine"], figures["machine_duration_s"]) == ("grbl-router", seconds)
        assert figures["duration_s"] > seconds


def test_every_finding_is_listed_with_its_line(morfax: Morfax, part: Path) -> None:
    part.write_text("\n".join([*PART, *BAD, "M2", ""]))
    answer = morfax("check", part, "--machine", "grbl-router")
    assert answer.exit_code == 1 and answer.err == ""
    assert "may be started  no" in answer.out
    told = [line for line in answer.out.splitlines() if line.startswith("line ")]
    assert [line.split(":")[0].split(" (")[0] for line in told] == [
        "line 8",
        "line 8",
        "line 9",
        "line 11",
        "line 12",
    ]
    assert told[0].startswith("line 8: grbl-router does not take G64; allowed: G0 to G4 G10 ")
    assert "they may differ by 0.0050 mm" in told[-1]
    by_json = morfax("check", part, "--machine", "grbl-router", "--json")
    assert by_json.exit_code == 1
    assert {each["kind"] for each in json.loads(by_json.out)["findings"] if each["stops"]} == {
        "word",
        "rapid",
        "tool",
        "arc",
    }


def test_the_machine_is_the_one_that_the_program_names(morfax: Morfax, here: Path) -> None:
    words = ("record", SAMPLES / "bracket.csv", "-o", "a.nc", "--machine", "grbl-pen")
    assert morfax(*words).exit_code == 0
    assert morfax("check", "a.nc", "--json").figures["machine"] == "grbl-pen"
    assert morfax("check", "a.nc", "--machine", "marlin").exit_code == 1


def test_the_stock_holds_the_work_or_not(morfax: Morfax, part: Path) -> None:
    def check(*words: str) -> int:
        return morfax("check", part, "--machine", "grbl-router", *words).exit_code

    assert check("--stock", "25x22x2mm", "--stock-at", "0,-10") == 0
    assert check("--stock", "25x22x2mm") == 1  # half the hole lies below Y0
    assert check("--stock", "25x22x1.8mm", "--stock-at", "0,-10") == 1
    assert check("--stock", "25x22x1.8mm", "--stock-at", "0,-10", "--through", "0.2mm") == 0
    assert check("--stock", "1x0.9in", "--stock-at", "0,-10") == 0


def test_the_picture_shows_the_program(morfax: Morfax, part: Path, here: Path) -> None:
    part.write_text("\n".join([*PART, *BAD, "M2", ""]))
    answer = morfax(
        "check", part, "--machine", "grbl-router", "--picture", "a.svg", "--stock", "30x20x5mm"
    )
    assert answer.exit_code == 1 and "picture         a.svg" in answer.out
    drawn = (here / "a.svg").read_text()
    for text in ("must not be started", "line 9: rapid", "plunge", "stock", "Z, mm"):
        assert f"<!-- {text}" in drawn or text in drawn, text


def test_a_program_without_z_has_no_side_view(morfax: Morfax, here: Path) -> None:
    lines = ["G21 G90", "M4 S0", "G0 X0 Y0", "G1 X9 S500 F600", "S0", "M5", "M2", ""]
    (here / "a.nc").write_text("\n".join(lines))
    answer = morfax("check", "a.nc", "--machine", "grbl-laser", "--picture", "a.svg", "--json")
    assert answer.exit_code == 0 and "Z, mm" not in (here / "a.svg").read_text()
    assert "z_axis" not in answer.figures and "depth_mm" not in answer.figures


@pytest.mark.parametrize(
    ("words", "exit_code", "says"),
    [
        (("none.nc",), 8, "cannot read none.nc: No such file or directory; check the name"),
        (("part.nc", "--machine", "mach3"), 2, "there is no machine 'mach3'; there are"),
        (("part.nc", "--machine", "hpgl"), 2, "--machine hpgl takes no G-code"),
        (("part.nc", "--machine", "none.toml"), 8, "cannot read the machine none.toml"),
        (("part.nc", "--stock", "5x"), 2, "'5x' is no stock; give 200x100x18mm"),
        (("part.nc", "--stock", "5x-1x1mm"), 2, "'5x-1x1mm' is no stock; give 200x100x18mm"),
        (("part.nc", "--through", "1mm"), 2, "are of a stock; give --stock as well"),
        (("part.nc", "--picture", "a.txt"), 2, "must end in .png, .svg, .pdf"),
        (("part.nc", "--picture", "no/a.png"), 8, "there is no folder no; make it first"),
        (("a.steps",), 2, "a.steps is no G-code; check reads .ngc, .nc"),
        (("a.csv",), 2, "a.csv is no G-code; check reads .ngc, .nc"),
        (("binary.nc",), 5, "binary.nc is no text; a program is lines such as G1 X10 Y5 F600"),
    ],
)
def test_what_cannot_be_checked_is_refused(
    words: tuple[str, ...], exit_code: int, says: str, morfax: Morfax, part: Path, here: Path
) -> None:
    (here / "a.steps").write_text("steps\n")
    (here / "a.csv").write_text("x_mm,y_mm\n0,0\n5,5\n")
    (here / "binary.nc").write_bytes(b"G0 X1\0\n")
    answer = morfax("check", *words)
    assert answer.exit_code == exit_code and says in answer.fault
