"""`--lettering` by its behaviour: with all the ink, with contours, and refused elsewhere."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from PIL import Image

from tests.console.conftest import SAMPLES, Morfax
from tests.tracer.inked import DPI, inked, polyline


def sheet_with_a_word(file: Path) -> Path:
    """A frame and three letters 4 mm high, as a picture."""
    frame = polyline((6, 6), (36, 6), (36, 26), (6, 26), (6, 6))
    letters = [
        polyline((12, 16), (12, 12), (14, 12)),
        polyline((16, 16), (17, 12), (18, 16)),
        polyline((20, 12), (20, 16)),
    ]
    darkness = inked(frame, *letters, width_mm=0.35, seed=1).darkness
    grey = (235 - 195 * darkness.clip(0, 1)).astype("uint8")
    Image.fromarray(grey).save(file, dpi=(DPI, DPI))
    return file


def test_letters_are_left_out_and_it_is_told(morfax: Morfax, here: Path) -> None:
    sheet = sheet_with_a_word(here / "word.png")
    run = morfax(
        "trace", sheet, "--lines", "all", "--lettering", "none", "-o", "w.csv", "--json"
    )
    assert len(run.figures["lines"]) == 1
    assert run.figures["lettering_left_out_mm"] == pytest.approx(6 + 8.2 + 4, rel=0.1)
    assert "--lettering all follows it" in run.err


def test_lettering_without_all_the_ink_and_what_names_no_letters_are_wrong_use(
    morfax: Morfax, here: Path
) -> None:
    answer = morfax("trace", SAMPLES / "cam.png", "--lettering", "none")
    assert answer.exit_code == 2 and "give one of these" in answer.fault
    answer = morfax("trace", SAMPLES / "cam.png", "--lines", "all", "--lettering", "small")
    assert answer.exit_code == 2 and "give all, none, or the height" in answer.fault
    assert not list(here.iterdir())


def test_contours_that_are_likely_letters_are_told_with_what_leaves_them_out(
    morfax: Morfax, here: Path
) -> None:
    sheet = sheet_with_a_word(here / "word.png")
    told = morfax("trace", sheet, "--lines", "contours", "-o", "a.csv")
    advice = re.search(
        r"lines 2, 3, 4 are likely lettering, .*; (--lettering) (none) leaves them out",
        told.err,
    )
    assert advice is not None, told.err
    followed = morfax(
        "trace", sheet, "--lines", "contours", *advice.groups(), "-o", "b.csv", "--json"
    )
    assert followed.exit_code == 0 and len(followed.figures["lines"]) == 1
    assert followed.figures["lettering_left_out"] == [2, 3, 4]
    assert "lines 2, 3, 4 are likely lettering, and left out" in followed.err


def test_a_cutter_leaves_out_letters_between_whose_strokes_it_has_no_room(
    morfax: Morfax, here: Path
) -> None:
    """Letters of 4.35 mm with the pen; three of these are open, of which no cutter knows the outside."""
    sheet = sheet_with_a_word(here / "word.png")
    cut = morfax("trace", sheet, "--cutter", "1.5mm", "-o", "cut.csv", "--json")
    assert cut.exit_code == 0, cut.err
    assert [line["line"] for line in cut.figures["lines"]] == [1]
    assert "lines 2, 3, 4 are likely lettering lower than 4.5 mm, and left out" in cut.err
    all_of_it = morfax("trace", sheet, "--cutter", "1.5mm", "--lettering", "all", "-o", "a.csv")
    assert all_of_it.exit_code == 7 and "is open" in all_of_it.fault
    slender = morfax("trace", sheet, "--cutter", "1mm", "-o", "b.csv")
    assert slender.exit_code == 7 and "is open" in slender.fault
