"""`morfax lines`: the numbers that trace --lines takes, what each is, and what is told beside them."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from tests.console.conftest import SAMPLES, Morfax

DPI = (300, 300)
PX_PER_MM = 300 / 25.4
# share: a length by the ink of hard pixels is so much off the way along its middle, ...
AREA_OVER_WIDTH = 0.01
ENDS_MM = 0.5  # ... and an open one by its pen's width at its ends and corners


@pytest.fixture
def plate(here: Path) -> str:
    """A frame; in it two rings that cross, a ring with a ring inside, an open line and a dot; below the frame
    a word of three letters, and specks.
    """
    grey = np.full((400, 560), 245, np.uint8)
    cv2.rectangle(grey, (30, 30), (530, 290), 30, 6)
    for x in (100, 160):
        cv2.circle(grey, (x, 150), 55, 30, 6, cv2.LINE_AA)
    cv2.circle(grey, (350, 120), 65, 30, 6, cv2.LINE_AA)
    cv2.circle(grey, (350, 120), 40, 30, 6, cv2.LINE_AA)
    cv2.line(grey, (280, 260), (400, 240), 30, 6, cv2.LINE_AA)
    cv2.circle(grey, (480, 120), 10, 30, -1, cv2.LINE_AA)
    for k, letter in enumerate("TIE"):
        cv2.putText(grey, letter, (60 + 28 * k, 350), 0, 1.2, 30, 6, cv2.LINE_AA)
    cv2.line(grey, (400, 350), (430, 350), 30, 6)
    Image.fromarray(grey).save("plate.png", dpi=DPI)
    return "plate.png"


def test_the_table_says_what_each_number_is_and_inside_which(
    morfax: Morfax, plate: str
) -> None:
    answer = morfax("lines", plate, "--picture", "plate-lines.png", "--json")
    assert answer.exit_code == 0 and Path("plate-lines.png").exists()
    rows = {row["line"]: row for row in answer.figures["lines"]}
    by_kind = [(n, rows[n]["kind"], rows[n].get("inside")) for n in list(rows)[:5]]
    assert by_kind == [
        (1, "closed", None),
        (2, "several", 1),
        (3, "closed", 1),
        (4, "closed", 3),
        (5, "open", 1),
    ]
    frame_mm = 2 * (500 + 260) / PX_PER_MM
    assert rows[1]["length_mm"] == pytest.approx(frame_mm, rel=AREA_OVER_WIDTH)
    assert rows[max(rows)]["kind"] == "dot" and rows[max(rows)]["inside"] == 1
    assert answer.figures["likely_letters"] == 3 and answer.figures["patches_left_out"] >= 1
    assert f"the others from {max(rows) + 1} on" in answer.err
    assert "--lines contours leaves out" in answer.err


def test_every_number_of_the_table_is_taken_by_trace(morfax: Morfax, plate: str) -> None:
    """The line of each number begins or lies where the table says, and is as long."""
    followed = morfax("lines", plate, "--follow", "--json").figures["lines"]
    seen = {row["line"]: row for row in morfax("lines", plate, "--json").figures["lines"]}
    assert [row["line"] for row in followed] == list(range(1, len(seen) + 2))
    assert followed[-1]["joined_to"] == 2
    for row in followed:
        number = row["line"]
        if not row["in_contours"]:
            continue
        call = ("trace", plate, "--lines", number, "-o", "one.csv", "--json")
        answer = morfax(*call)
        assert answer.exit_code == 0, answer.err
        (line,) = answer.figures["lines"]
        assert line["line"] == number
        # followed alone or among all: the same ink, begun elsewhere at most
        assert line["length_mm"] == pytest.approx(row["length_mm"], rel=0.01)
        if seen.get(number, {}).get("kind") in ("closed", "open"):
            by_ink_mm = seen[number]["length_mm"]
            assert line["length_mm"] == pytest.approx(
                by_ink_mm, rel=AREA_OVER_WIDTH, abs=ENDS_MM * (row["kind"] == "open")
            )


def test_a_line_with_gaps_is_several_numbers_and_following_says_of_which(
    morfax: Morfax, here: Path
) -> None:
    grey = np.full((300, 900), 245, np.uint8)
    for x in (60, 320, 580):
        cv2.line(grey, (x, 150), (x + 250, 150), 30, 6)  # gaps of 0.3 mm
    Image.fromarray(grey).save("dashed.png", dpi=DPI)
    seen = morfax("lines", "dashed.png", "--json").figures["lines"]
    assert [row["kind"] for row in seen] == ["open"] * 3
    answer = morfax("lines", "dashed.png", "--follow", "--json")
    rows = answer.figures["lines"]
    (whole,) = (row for row in rows if row["in_contours"])
    pieces = [row for row in rows if not row["in_contours"]]
    assert [row["remark"] for row in pieces] == [f"piece of line {whole['line']}"] * 2
    assert whole["length_mm"] == pytest.approx(770 / PX_PER_MM, abs=1.0)
    numbers = ", ".join(str(row["line"]) for row in pieces)
    assert f"--lines contours leaves out lines {numbers} (pieces of another line)" in answer.err


def test_a_likely_wrong_scale_is_told_with_what_would_mend_it(
    morfax: Morfax, here: Path
) -> None:
    """An A4 sheet by 5 % too small; and one whose lines are 4 mm wide."""
    grey = np.full((877, 620), 245, np.uint8)
    cv2.circle(grey, (300, 300), 150, 30, 4, cv2.LINE_AA)
    Image.fromarray(grey).save("sheet.png")
    told = morfax("lines", "sheet.png", "--width", "199.5mm").err
    assert "the shape of A4 at 95.0 %: if it is A4, give --width 210mm" in told
    told = morfax("lines", "sheet.png", "--width", "620mm").err
    assert "wide by this scale; pens draw 0.1 to 2 mm" in told and "A4" not in told
    told = morfax("lines", "sheet.png", "--width", "210mm").err
    assert "give --width" not in told and "pens draw" not in told


def test_a_sheet_without_a_line_says_so_and_what_to_do(morfax: Morfax, here: Path) -> None:
    grey = np.full((300, 300), 245, np.uint8)
    cv2.line(grey, (100, 100), (136, 100), 30, 6)  # 3 mm
    Image.fromarray(grey).save("short.png", dpi=DPI)
    answer = morfax("lines", "short.png", "--json")
    assert answer.exit_code == 0 and answer.figures["lines"] == []
    assert "no piece of ink is long enough to be a line" in answer.err


def test_bad_input_is_one_line_and_leaves_nothing(morfax: Morfax, here: Path) -> None:
    answer = morfax("lines", SAMPLES / "cam.png", "--picture", "away/lines.png")
    assert answer.exit_code == 8 and "there is no folder away" in answer.fault
    answer = morfax("lines", "none.png")
    assert answer.exit_code == 8 and "none.png" in answer.fault
    assert list(here.iterdir()) == []
