"""`--lettering` by its behaviour: with all the ink, and refused elsewhere."""

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
    assert answer.exit_code == 2 and "give --lines all too" in answer.fault
    answer = morfax("trace", SAMPLES / "cam.png", "--lines", "all", "--lettering", "small")
    assert answer.exit_code == 2 and "give all, none, or the height" in answer.fault
    assert not list(here.iterdir())


def test_contours_that_are_likely_letters_are_told_with_what_leaves_them_out(
    morfax: Morfax, here: Path
) -> None:
    sheet = sheet_with_a_word(here / "word.png")
    told = morfax("trace", sheet, "--lines", "contours", "-o", "a.csv")
    advice = re.search(
        r"lines 2, 3, 4 are likely lettering, .*; (--lines) (1) leaves them out", told.err
    )
    assert advice is not None, told.err
    followed = morfax("trace", sheet, *advice.groups(), "-o", "b.csv")
    assert followed.exit_code == 0 and "lettering" not in followed.err
