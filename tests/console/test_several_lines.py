"""Several lines of a sheet in one program, and the one that is asked for."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.motion.pathfile import read_path
from tests.console.conftest import SAMPLES, Morfax

UM = 1e-3
PLAYED_WITHIN_MM = 3 * UM
DPI = (300.0, 300.0)


def test_another_line_is_traced_from_its_start(morfax: Morfax, here: Path) -> None:
    """The bracket's slot, 8 x 30 mm, instead of its outline."""
    answer = morfax(
        "trace", SAMPLES / "bracket.png", "--start", "48,26", "-o", "slot.csv", "--json"
    )
    assert answer.exit_code == 0 and answer.figures["ending"] == "closed"
    assert answer.figures["length_mm"] == pytest.approx(2 * 22 + 8 * np.pi, rel=0.005)


def test_several_starts_are_one_program_the_slot_before_its_outline(
    morfax: Morfax, here: Path
) -> None:
    bracket = SAMPLES / "bracket.png"
    call = ("trace", bracket, "--start", "40,7", "--start", "48,26", "-o", "both.csv", "--json")
    answer = morfax(*call)
    assert answer.exit_code == 0 and answer.err == ""
    slot, outline = answer.figures["lines"]
    assert (slot["line"], outline["line"]) == (2, 1)
    assert slot["length_mm"] == pytest.approx(2 * 22 + 8 * np.pi, rel=0.005)
    assert len(read_path("both.csv").runs()) == 2
    call = ("trace", bracket, "--start", "50.5,26", "--start", "48,26", "-o", "one.csv")
    answer = morfax(*call)
    assert (
        answer.exit_code == 4 and "are on the same line; leave one of them out" in answer.fault
    )
    call = ("trace", bracket, "--start", "48,26", "--start", "20,50", "-o", "one.csv")
    answer = morfax(*call)
    assert answer.exit_code == 4 and "no line within 3 mm of 20,50 mm" in answer.fault
    assert not Path("one.csv").exists()


def test_a_plain_trace_says_what_else_is_on_the_sheet(morfax: Morfax, here: Path) -> None:
    told = morfax("trace", SAMPLES / "bracket.png", "-o", "outline.csv").err
    assert "the sheet has 1 other line of about 69 mm, inside it: --lines contours cuts" in told
    both = morfax(
        "trace", SAMPLES / "bracket.png", "--lines", "contours", "-o", "b.csv", "--json"
    )
    assert [line["line"] for line in both.figures["lines"]] == [
        2,
        1,
    ]  # as it says: the hole first
    for words in (("--start", "48,26"), ("--lines", "1")):
        told = morfax("trace", SAMPLES / "bracket.png", *words, "-o", "outline.csv").err
        assert told == ""
    assert morfax("trace", SAMPLES / "program.png", "-o", "program.csv").err == ""


def test_open_lines_among_contours_are_told_with_how_each_ended(
    morfax: Morfax, here: Path
) -> None:
    """A sign's large letters were cut with its outline without a word, and the whole had "ended"."""
    grey = np.full((500, 900), 240, np.uint8)
    cv2.circle(grey, (220, 250), 150, 30, 6, cv2.LINE_AA)
    cv2.polylines(
        grey, [np.array([(500, 400), (500, 100), (760, 400), (760, 100)])], False, 30, 6
    )
    Image.fromarray(grey).save("sign.png", dpi=DPI)
    told = morfax("trace", "sign.png", "--lines", "contours", "-o", "a.csv", "--json")
    assert told.figures["ending"] == "1 closed, 1 ended"
    assert "line 1 is open" not in told.err
    assert "line 2 is open, and runs from end to end with the closed ones" in told.err
    alone = morfax("trace", "sign.png", "--lines", "1", "-o", "b.csv", "--json")
    assert alone.figures["ending"] == "closed" and "is open" not in alone.err
    asked = morfax("trace", "sign.png", "--lines", "contours", "--climb", "-o", "c.csv")
    assert asked.err.count("is open") == 1 and "cut as traced" in asked.err


def test_all_lines_are_one_program_listed_and_numbered(morfax: Morfax, here: Path) -> None:
    """The bracket's slot, then its outline; the table has a row for each, the JSON an entry."""
    call = ("trace", SAMPLES / "bracket.png", "--lines", "contours", "-o", "bracket.csv")
    answer = morfax(*call, "--picture", "lines.svg", "--json")
    assert answer.exit_code == 0 and answer.figures["patches_left_out"] == 0
    slot, outline = answer.figures["lines"]
    assert (slot["line"], outline["line"]) == (2, 1) and slot["ending"] == outline[
        "ending"
    ] == "closed"
    assert answer.figures["length_mm"] == pytest.approx(
        slot["length_mm"] + outline["length_mm"], abs=1e-3
    )
    assert len(read_path("bracket.csv").runs()) == 2
    from_slot = np.subtract(slot["start_place_mm"], outline["start_place_mm"])
    assert answer.figures["idle_mm"] == pytest.approx(np.hypot(*from_slot), abs=0.1)
    assert Path("lines.svg").read_text().count("<!-- 2 -->") == 1  # the axes count in tens
    table = morfax(*call).out.splitlines()
    rows = table[
        table.index(next(row for row in table if "cell share" in row and "ending" in row)) :
    ]
    assert rows[0].split() == ["ending", "length", "line", "width", "start", "cell", "share"]
    assert [row.split()[:3] for row in rows[1:3]] == [
        ["line", "2", "closed"],
        ["line", "1", "closed"],
    ]


def test_run_plays_all_lines_off_one_tape(morfax: Morfax, here: Path) -> None:
    answer = morfax(
        "run", SAMPLES / "bracket.png", "--lines", "contours", "-o", "results", "--json"
    )
    assert answer.exit_code == 0 and answer.figures["missed_ink_share"] < 0.01
    assert answer.figures["played_to_traced"]["max_mm"] < PLAYED_WITHIN_MM


def test_lines_that_there_are_not_are_refused(morfax: Morfax, here: Path) -> None:
    bracket = SAMPLES / "bracket.png"
    answer = morfax("trace", bracket, "--lines", "1,3")
    assert answer.exit_code == 4 and "no line 3: the drawing has lines 1, 2" in answer.fault
    answer = morfax("trace", bracket, "--lines", "inner")
    assert (
        answer.exit_code == 2
        and "give all, contours, outer, or numbers such as 1,3" in answer.fault
    )
    answer = morfax("trace", bracket, "--lines", "contours", "--start", "1,1")
    assert answer.exit_code == 2 and "--start picks one line, --lines several" in answer.fault
    assert list(here.iterdir()) == []


def test_a_lost_line_among_several_leaves_the_others_cut(morfax: Morfax, here: Path) -> None:
    """A ring, and a line into a bar as broad as ten lines."""
    grey = np.full((600, 1200), 255, np.uint8)
    cv2.line(grey, (50, 350), (1100, 350), 0, 6)
    cv2.rectangle(grey, (600, 330), (1190, 370), 0, -1)
    cv2.circle(grey, (200, 150), 100, 0, 6, cv2.LINE_AA)
    Image.fromarray(grey).save("bar.png", dpi=DPI)
    answer = morfax(
        "trace",
        "bar.png",
        "--lines",
        "contours",
        "--line-width",
        "0.5mm",
        "-o",
        "bar.csv",
        "--json",
    )
    assert answer.exit_code == 4 and answer.figures["incomplete"] is True
    endings = {line["line"]: line["ending"] for line in answer.figures["lines"]}
    (lost,) = (number for number, ending in endings.items() if ending == "lost")
    assert sorted(endings.values()) == ["closed", "lost"]
    assert (
        f"line {lost} of 2 is incomplete, the others are cut" in answer.fault
        and "heading" in answer.fault
    )
    assert len(read_path("bar.incomplete.csv").runs()) == 2
