"""The verb `correct`, as a user meets it."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.console.conftest import SAMPLES, Morfax


@pytest.fixture
def scan(here: Path) -> Path:
    """A drawing in a folder of its own."""
    return Path(shutil.copy(SAMPLES / "bracket.png", here)).relative_to(here)


def test_corrections_are_made_listed_and_undone(morfax: Morfax, scan: Path) -> None:
    made = morfax(
        "correct", scan, "--rub", "40,62 41,62", "--rubber", "3mm", "--why", "coffee", "--json"
    )
    assert made.exit_code == 0
    assert made.figures["each"][0]["at"] == "472.44px,23.72px 484.25px,23.72px"
    assert made.figures["each"][0]["why"] == "coffee"
    more = morfax(
        "correct",
        scan,
        "--turn",
        "left",
        "100px,200px",
        "--from",
        "50px,200px",
        "--not-stop",
        "9px,9px",
    )
    assert more.exit_code == 0
    assert "correction 3" in more.out
    before = Path("bracket.morfax.toml").read_bytes()
    listed = morfax("correct", scan, "--list", "--json")
    assert [row["do"] for row in listed.figures["each"]] == ["rub", "left", "not-stop"]
    assert Path("bracket.morfax.toml").read_bytes() == before
    undone = morfax("correct", scan, "--undo", "--undo", "--json")
    assert (undone.figures["corrections"], undone.figures["removed"]) == (1, [2, 3])


def test_another_file_and_none(morfax: Morfax, scan: Path) -> None:
    morfax("correct", scan, "--corrections", "mine.toml", "--rub", "40,62")
    assert not Path("bracket.morfax.toml").exists()
    assert "correction" not in morfax("lines", scan).err
    assert (
        "1 correction of mine.toml: 1 rub"
        in morfax("lines", scan, "--corrections", "mine.toml").err
    )
    Path("mine.toml").rename("bracket.morfax.toml")
    assert "1 correction of bracket.morfax.toml" in morfax("lines", scan).err
    assert "correction" not in morfax("lines", scan, "--no-corrections").err


@pytest.mark.parametrize(
    ("words", "exit_code", "told"),
    [
        (["--rub", "40,3px"], 2, "mixes pixels and mm"),
        (["--rub", ""], 2, "no place is given"),
        (["--rub-area", "1px,2px 3px,4px"], 2, "rub-area has 2 places; it takes 3 to 2000"),
        (["--rubber", "3mm"], 2, "--rubber goes with --rub"),
        (["--rub", "40,62", "--pen", "3mm"], 2, "--pen goes with --bridge"),
        (["--why", "coffee"], 2, "--why goes with a correction"),
        (["--list", "--undo"], 2, "--list changes nothing"),
        (
            ["--remove", "1"],
            2,
            "there is no correction 1: there are none; `morfax correct` without options",
        ),
        (["--rub", "4000px,3px"], 9, "beside the sheet of 84.1 x 64.0 mm"),
        (["--no-corrections", "--rub", "40,62"], 2, "leave --no-corrections out"),
        (["--corrections", "no/x.toml", "--rub", "40,62"], 8, "the folder"),
    ],
)
def test_what_cannot_be_served_is_refused(
    morfax: Morfax, scan: Path, words: list[str], exit_code: int, told: str
) -> None:
    answer = morfax("correct", scan, *words)
    assert answer.exit_code == exit_code
    assert told in answer.fault
    assert not Path("bracket.morfax.toml").exists()
