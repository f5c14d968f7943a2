"""Where a line begins and which way the head goes (--arrow), and in what order lines are cut (--order)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from morfax.motion.pathfile import read_path
from morfax.motion.polyline import area_mm2
from tests.console.conftest import Morfax
from tests.tracer.inked import DPI, Points, arc, inked, polyline

LINE_MM = 0.5  # the head begins on the line's middle, within a line's width of the arrow
PLATE = inked(
    polyline((6, 6), (46, 6), (46, 30), (6, 30), (6, 6)),
    arc((16, 18), 5),
    arc((36, 18), 4),
    polyline((52, 8), (52, 28)),
    seed=2,
)  # by length: 1 the outline, 2 and 3 the holes, 4 an open line


@pytest.fixture
def plate(here: Path) -> Path:
    """The plate as a scan."""
    levels = np.clip(255 - 235 * PLATE.darkness, 0, 255).astype(np.uint8)
    Image.fromarray(levels).save("plate.png", dpi=(DPI, DPI))
    return here


def runs(file: str) -> list[Points]:
    """Where the tool is in the work, run by run."""
    return [run[:, :2] for run in read_path(Path(file)).runs()]


def traced(morfax: Morfax, *words: str) -> list[Points]:
    """The runs of the plate traced with some words."""
    done = morfax("trace", "plate.png", *words, "-o", "out.csv", "--force")
    assert done.exit_code == 0, done.err
    return runs("out.csv")


@pytest.mark.parametrize(("towards", "is_ccw"), [("32,30", False), ("20,30", True)])
def test_a_closed_line_begins_at_its_arrow_and_goes_its_way(
    morfax: Morfax, plate: Path, towards: str, is_ccw: bool
) -> None:
    (run,) = traced(morfax, "--arrow", "26,30", towards)
    assert np.hypot(*(run[0] - (26, 30))) < LINE_MM
    assert (area_mm2(run) > 0) == is_ccw


def test_several_lines_each_have_an_arrow_of_their_own(morfax: Morfax, plate: Path) -> None:
    arrows = ("--arrow", "16,23", "18,23", "--arrow", "36,14", "38,14")
    for words in (("--lines", "2,3"), ()):  # which name the lines, or are named by the arrows
        one, other = sorted(traced(morfax, *words, *arrows), key=lambda run: run[0, 0])
        assert np.hypot(*(one[0] - (16, 23))) < LINE_MM and area_mm2(one) < 0
        assert np.hypot(*(other[0] - (36, 14))) < LINE_MM and area_mm2(other) > 0


@pytest.mark.parametrize(("towards", "begins"), [("52,20", 8), ("52,10", 28)])
def test_an_open_line_begins_at_the_end_behind_its_arrow(
    morfax: Morfax, plate: Path, towards: str, begins: float
) -> None:
    (run,) = traced(morfax, "--lines", "4", "--arrow", "52,15", towards)
    assert abs(run[0, 1] - begins) < LINE_MM


def test_an_arrow_goes_before_climb_and_keeps_its_place_with_leads(
    morfax: Morfax, plate: Path
) -> None:
    words = ("--lines", "1,2,3", "--climb", "--cutter", "1mm", "--lead-in", "1mm")
    arrow = (
        "--arrow",
        "26,30",
        "20,30",
    )  # the outline counter-clockwise, which is conventional
    by_climb = max(traced(morfax, *words), key=len)
    by_arrow = max(traced(morfax, *words, *arrow), key=len)
    assert area_mm2(by_climb) < 0 < area_mm2(by_arrow)
    # a lead of 1 mm away from the cut, which is half a cutter away from the line
    assert np.hypot(*(by_arrow[0] - (26, 30))) < 2.5


@pytest.mark.parametrize("order", [(3, 2, 1, 4), (4, 1), (2,)])
def test_lines_are_cut_in_the_order_that_is_asked_for(
    morfax: Morfax, plate: Path, order: tuple[int, ...]
) -> None:
    middles = {1: (26, 18), 2: (16, 18), 3: (36, 18), 4: (52, 18)}
    made = traced(morfax, "--lines", "contours", "--order", ",".join(map(str, order)))
    cut = [
        min(middles, key=lambda k: float(np.hypot(*(0.5 * (r.min(0) + r.max(0)) - middles[k]))))
        for r in made
    ]
    assert tuple(cut[: len(order)]) == order and sorted(cut) == [1, 2, 3, 4]
    rest = cut[len(order) :]  # the others as ever: inner before outer
    assert 1 not in rest or rest.index(1) > max(
        (rest.index(k) for k in (2, 3) if k in rest), default=-1
    )


def test_a_part_that_is_cut_out_before_its_holes_is_told_of(
    morfax: Morfax, plate: Path
) -> None:
    done = morfax("trace", "plate.png", "--lines", "1,2,3", "--order", "1,2,3", "-o", "a.csv")
    assert done.exit_code == 0
    assert "--order cuts line 1 before line 2, 3 inside it" in " ".join(done.err.split())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--arrow", "26,18", "28,18"), "the nearest is"),
        (("--lines", "2", "--arrow", "26,30", "20,30"), "the nearest line that is followed"),
        (("--arrow", "26,30", "20,30", "--start", "16,23"), "--arrow and --start both"),
        (("--arrow", "26,30", "20,30", "--direction", "cw"), "--arrow and --direction both"),
        (("--arrow", "26,30", "26,30"), "has two equal places"),
        (("--lines", "all", "--arrow", "26,30", "20,30"), "does not take --arrow"),
        (("--lines", "all", "--order", "1"), "does not take --order"),
        (("--order", "1"), "for several lines"),
        (("--lines", "1,2", "--order", "1,1"), "twice"),
        (("--lines", "1,2", "--order", "7"), "no line 7"),
        (("--lines", "1,2", "--order", "x"), "no order of lines"),
    ],
)
def test_what_cannot_be_served_is_refused_in_words(
    morfax: Morfax, plate: Path, words: tuple[str, ...], said: str
) -> None:
    done = morfax("trace", "plate.png", *words, "-o", "a.csv")
    assert done.exit_code != 0 and said in " ".join(done.err.split())
    assert not Path("a.csv").exists()
