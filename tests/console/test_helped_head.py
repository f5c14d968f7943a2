"""Five drawings on which the head goes wrong by itself, and one correction each that leads it right."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.motion.pathfile import read_path
from morfax.motion.polyline import with_places
from morfax.tracer.drawing.drawing import Drawing
from tests.console.conftest import Morfax
from tests.tracer.inked import DPI, UM, Points, arc, inked, polyline

BOX = polyline((6, 6), (40, 6), (40, 26), (6, 26), (6, 6))
ROUND = arc((26, 26), 20)
GAP_DEG = math.degrees(3 / 20)  # to each side: 6 mm in all


@dataclass(frozen=True)
class Case:
    """A drawing, the line that is meant on it, where the head starts, and the words that put it right."""

    name: str
    drawing: Drawing
    meant: Points
    words: tuple[str, ...]
    start: str = "30,26"
    off_um: float = 25.0  # largest distance of the path from the line: corners in noise of 4 %


def grainy(drawing: Drawing) -> Drawing:
    """The drawing with 6 mm of its lower line in grain: a third of the ink has taken."""
    rng, pitch_mm = np.random.default_rng(1), drawing.pitch_mm
    dark, middle = drawing.darkness.copy(), len(drawing.darkness) - round(6 / pitch_mm)
    window = np.s_[middle - 8 : middle + 8, round(18 / pitch_mm) : round(24 / pitch_mm)]
    grain = cv2.GaussianBlur(rng.random(dark[window].shape), (0, 0), 1.0)
    dark[window] *= grain > np.quantile(grain, 0.67)
    return Drawing(dark, pitch_mm)


SLOT = polyline(
    (6, 6), (40, 6), (40, 26), (24, 26), (24, 12), (21, 12), (21, 26), (6, 26), (6, 6)
)
BROKEN_BOX = polyline((23.5, 6), (40, 6), (40, 26), (6, 26), (6, 6), (22, 6))
CASES = (
    Case(
        "a gap of 6 mm",
        inked(arc((26, 26), 20, GAP_DEG, 360 - GAP_DEG), seed=3),
        ROUND,
        ("--bridge", "45.9,29 45.8,23"),
        "6,26",
    ),
    Case(
        "lost in grain",
        grainy(inked(BOX, seed=6)),
        BOX,
        ("--bridge", "17.5,6 24.5,6.1"),
    ),
    Case(
        "a blot",  # in the mouth of a slot, which the head then passes by
        inked(SLOT, specks=[arc((22.5, 25.4), 1.72)], seed=4),
        SLOT,
        ("--rub", "22.5,20 22.5,30", "--rubber", "2.46mm"),
        off_um=60.0,  # what the rubber has left beside the lines: a tenth of a mm
    ),
    Case(
        "a wrong turn",
        inked(BOX, polyline((40, 6), (70, 6)), seed=5),
        BOX,
        ("--turn", "left", "40.3,6.2"),
        "20,6",
    ),
    Case(
        "a tick taken for a corner",
        inked(BROKEN_BOX, polyline((22, 6), (22, 11.5)), seed=7),
        BOX,
        ("--turn", "straight", "22,6"),
    ),
)


def off_mm(path: Points, line: Points) -> float:
    """The largest distance of a path's places from a line, and of the line's from the path, mm."""
    a, b = with_places(path, 0.2), with_places(line, 0.01)
    b_coarse, a_fine = b[::20], with_places(path, 0.01)
    there = max(float(np.hypot(*(b - place).T).min()) for place in a)
    back = max(float(np.hypot(*(a_fine - place).T).min()) for place in b_coarse)
    return max(there, back)


def saved(drawing: Drawing) -> None:
    """Write a drawing as a scan, scan.png."""
    levels = np.clip(255 - 235 * drawing.darkness, 0, 255).astype(np.uint8)
    Image.fromarray(levels).save("scan.png", dpi=(DPI, DPI))


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_one_correction_leads_the_head_right(morfax: Morfax, here: Path, case: Case) -> None:
    saved(case.drawing)
    trace = ("trace", "scan.png", "--start", case.start, "--json")
    # 1. by itself it goes wrong: it does not find the line, or runs another one
    wrong = morfax(*trace, "-o", "wrong.csv")
    if wrong.exit_code == 0:
        path = read_path(Path("wrong.csv"))
        runs = np.vstack(path.runs())
        assert off_mm(runs, case.meant) > 1.0
    # 2. one correction, kept beside the drawing
    assert morfax("correct", "scan.png", *case.words, "--why", case.name).exit_code == 0
    right = morfax(*trace, "-o", "right.csv")
    assert right.exit_code == 0
    assert right.err.splitlines()[0].startswith("1 correction of scan.morfax.toml: 1 ")
    assert "changed nothing" not in right.err
    assert (right.figures["ending"], right.figures["corrections"]) == ("closed", 1)
    assert off_mm(np.vstack(read_path(Path("right.csv")).runs()), case.meant) < case.off_um * UM


def test_with_corrections_and_without_them_the_same_again(morfax: Morfax, here: Path) -> None:
    saved(CASES[0].drawing)
    trace = ("trace", "scan.png", "--start", CASES[0].start, "--json")
    bare = morfax(*trace, "-o", "bare.csv")
    morfax("correct", "scan.png", *CASES[0].words)
    for name in ("first.csv", "second.csv"):
        assert morfax(*trace, "-o", name).exit_code == 0
    assert Path("first.csv").read_bytes() == Path("second.csv").read_bytes()
    without = morfax(*trace, "--no-corrections", "-o", "bare-again.csv")
    assert Path("bare-again.csv").read_bytes() == Path("bare.csv").read_bytes()
    assert without.exit_code == bare.exit_code and "correction" not in without.err
    assert "corrections" not in without.out
