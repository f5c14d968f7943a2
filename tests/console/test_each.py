"""Several drawings on one command line: a result each by its own name; one that fails stops no other."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from tests.console.conftest import Morfax

DPI = (300, 300)


@pytest.fixture
def rings(here: Path) -> tuple[str, ...]:
    """Two rings, of 8 and 12 mm across, and a sheet with nothing on it."""
    for name, radius in (("small", 47), ("large", 71), ("empty", 0)):
        grey = np.full((200, 200), 245, np.uint8)
        if radius:
            cv2.circle(grey, (100, 100), radius, 30, 6, cv2.LINE_AA)
        Image.fromarray(grey).save(f"{name}.png", dpi=DPI)
    return "small.png", "empty.png", "large.png"


def test_each_drawing_has_its_own_results_and_one_that_fails_stops_no_other(
    morfax: Morfax, rings: tuple[str, ...]
) -> None:
    answer = morfax("trace", *rings, "-o", "{}.ngc", "--picture", "{}-seen.png", "--json")
    assert answer.exit_code == 3 and (answer.figures["traced"], answer.figures["failed"]) == (
        2,
        1,
    )
    lengths_mm = [row.get("length_mm") for row in answer.figures["drawings"]]
    assert lengths_mm[1] is None and "fault" in answer.figures["drawings"][1]
    for length_mm, radius_px in ((lengths_mm[0], 47), (lengths_mm[2], 71)):
        assert length_mm == pytest.approx(2 * np.pi * radius_px * 25.4 / 300, rel=0.005)
    for name in ("small", "large"):
        assert Path(f"{name}.ngc").exists() and Path(f"{name}-seen.png").exists()
    assert not Path("empty.ngc").exists()
    assert "morfax: empty.png: no line on the drawing" in answer.err
    assert "3 of 3: large.png" in answer.err


def test_the_folder_of_a_pattern_is_made(morfax: Morfax, rings: tuple[str, ...]) -> None:
    answer = morfax("trace", "small.png", "large.png", "-o", "parts/{}.ngc")
    assert answer.exit_code == 0
    assert {file.name for file in Path("parts").iterdir()} == {"small.ngc", "large.ngc"}
    deep = morfax("trace", "small.png", "large.png", "-o", "not/there/{}.ngc")
    assert deep.exit_code == 8 and "there is no folder not/there" in deep.fault


def test_a_folder_takes_the_tapes_and_none_is_written_over(
    morfax: Morfax, rings: tuple[str, ...]
) -> None:
    Path("tapes").mkdir()
    call = ("trace", "small.png", "large.png", "-o", "tapes")
    answer = morfax(*call)
    assert answer.exit_code == 0
    rows = [line.split() for line in answer.out.splitlines() if line.startswith("drawing")]
    assert [row[-1] for row in rows] == ["tapes/small.wav", "tapes/large.wav"]
    answer = morfax(*call)
    assert answer.exit_code == 8 and "small.wav is there already" in answer.fault


def test_names_that_do_not_differ_are_refused_before_anything_is_traced(
    morfax: Morfax, rings: tuple[str, ...]
) -> None:
    answer = morfax("trace", *rings, "-o", "ring.ngc")
    assert answer.exit_code == 2 and "such as {}.ngc" in answer.fault
    Path("other").mkdir()
    Path("small.png").rename("other/small.png")
    Path("large.png").rename("small.png")
    answer = morfax("trace", "other/small.png", "small.png", "-o", "{}.ngc")
    assert answer.exit_code == 2 and "would both be written to small.ngc" in answer.fault
    answer = morfax("trace", "small.png", "empty.png", "-o", "{}.csv", "--picture", "{}.png")
    assert answer.exit_code == 8 and "would replace it" in answer.fault
    assert not list(Path().glob("*.ngc")) and not list(Path().glob("*.csv"))
