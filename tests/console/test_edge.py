"""`--edge` by its behaviour."""

from __future__ import annotations

import math
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.motion.contour import distance
from morfax.motion.pathfile import read_path
from morfax.motion.units import MM_PER_INCH
from tests.console.conftest import SAMPLES, Morfax
from tests.tracer.drawing.filled import CIRCLE, filled
from tests.tracer.drawing.test_shapes import STEPPED
from tests.tracer.inked import UM, arc, inked, polyline


def test_the_edge_is_traced_and_compared(morfax: Morfax, here: Path) -> None:
    sheet = filled(here / "plate.png", STEPPED)
    assert morfax("trace", sheet, "--edge", "-o", "plate.csv", "--quiet").exit_code == 0
    assert distance(read_path(here / "plate.csv"), STEPPED).hausdorff_mm < 30 * UM
    compared = morfax("compare", sheet, "plate.csv", "--edge", "--json")
    assert compared.figures["path_to_ink"]["rms_mm"] < 0.005


def test_all_lines_takes_the_holes_before_the_outside(morfax: Morfax, here: Path) -> None:
    holes = arc((12, 16), 2), arc((20, 16), 2)
    sheet = filled(here / "plate.png", CIRCLE, holes=holes)
    answer = morfax(
        "trace", sheet, "--edge", "--lines", "contours", "-o", "plate.csv", "--json"
    )
    assert answer.exit_code == 0
    path = read_path(here / "plate.csv")
    assert distance(path, [CIRCLE, *holes]).hausdorff_mm < 30 * UM
    cut = path.xy_mm[path.tool > 0]
    radii = np.hypot(*(cut - [16, 16]).T)
    assert np.flatnonzero(radii < 7).max() < np.flatnonzero(radii > 9).min()


def test_fine_details_are_followed_enlarged_and_told_of(morfax: Morfax, here: Path) -> None:
    hole = arc((15, 16), 0.5)
    sheet = filled(here / "plate.png", CIRCLE, holes=(hole,))
    answer = morfax(
        "trace", sheet, "--edge", "--lines", "contours", "-o", "plate.csv", "--json"
    )
    assert answer.exit_code == 0 and "traced at 3 times the scale" in answer.err
    path = read_path(here / "plate.csv")
    assert distance(path, [CIRCLE, hole]).hausdorff_mm < 45 * UM  # as in test_silhouette
    again = morfax("trace", filled(here / "disc.png", CIRCLE), "--edge", "-o", "disc.csv")
    assert again.exit_code == 0 and "enlarged" not in again.err


def test_what_has_no_edge_is_refused_with_one_line(morfax: Morfax, here: Path) -> None:
    cut = filled(here / "cut.png", polyline((20, 8), (40, 8), (40, 20), (20, 20), (20, 8)))
    kept = set(here.iterdir())
    for sheet, told in (
        (cut, "a filled shape is cut by the border of the sheet at"),
        (SAMPLES / "cam.png", "leave --edge out to follow lines"),
    ):
        answer = morfax("trace", sheet, "--edge", "-o", "none.csv")
        assert answer.exit_code == 3 and told in answer.fault
    assert set(here.iterdir()) == kept


def test_a_filled_shape_without_edge_is_told(morfax: Morfax, here: Path) -> None:
    radii = np.where(np.arange(10) % 2, 6.0, 14.0)
    angles = np.arange(10) * np.pi / 5
    star = filled(
        here / "star.png",
        16.5 + radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)]),
    )
    for lines in ((), ("--lines", "contours")):
        refused = morfax("trace", star, "-o", "rim.csv", *lines)
        assert refused.exit_code == 4 and "--edge follows" in refused.fault
    followed = morfax("trace", star, "-o", "rim.csv", "--start", "30,16.5")
    assert followed.exit_code == 0 and "--edge follows its outline" in followed.err
    assert "--edge" not in morfax("trace", star, "--edge", "-o", "edge.csv").err
    assert "--edge" not in morfax("trace", SAMPLES / "bracket.png", "-o", "bracket.csv").err
    refused = morfax("trace", filled(here / "disc.png", CIRCLE), "-o", "disc.csv")
    assert refused.exit_code == 4 and "--edge" in refused.err


def test_solid_areas_among_lines_are_outlined_in_the_same_run(
    morfax: Morfax, here: Path
) -> None:
    sheet = here / "plan.png"
    frame = polyline((6, 6), (36, 6), (36, 36), (6, 36), (6, 6))
    wall = polyline((6, 46), (40, 46), (40, 49), (6, 49), (6, 46))
    ink = inked(frame, polyline((20, 36), (20, 47)), specks=(wall,), seed=1).darkness
    grey = np.clip(np.round(235 - 195 * ink), 0, 255).astype(np.uint8)
    Image.fromarray(grey).save(sheet, dpi=(300, 300))
    answer = morfax("trace", sheet, "--lines", "all", "--edge", "-o", "plan.csv", "--json")
    assert answer.exit_code == 0 and "left out" not in answer.err
    (area,) = answer.figures["outlined_areas"]
    assert area["outlined_mm2"] == pytest.approx(34 * 3, rel=0.06)
    outlines = [row for row in answer.figures["lines"] if row.get("outline")]
    assert len(outlines) == 1 and "line_width_mm" not in outlines[0]
    assert all("line_width_mm" in row for row in answer.figures["lines"] if row not in outlines)


@pytest.mark.parametrize("across_mm", [8.0, 16.0, 20.0, 30.0])
def test_a_filled_disc_in_a_frame_is_named_and_the_advice_works(
    morfax: Morfax, here: Path, across_mm: float
) -> None:
    """Where only contours are asked for the disc is no line; outlined beside the frame both come closed.

    (From 16 mm on its rim was a line that was lost without `_falls_slowly`: exit code 4, no whole program.)
    """
    grey = np.full((800, 800), 245, np.uint8)
    cv2.rectangle(grey, (100, 100), (700, 700), 30, 6)
    cv2.circle(grey, (400, 400), round(across_mm / 2 * 300 / 25.4), 30, -1, cv2.LINE_AA)
    Image.fromarray(grey).save("disc.png", dpi=(300, 300))
    words = ("trace", "disc.png", "-o", "disc.csv", "--json", "--lines")
    told = morfax(*words, "contours")
    assert told.exit_code == 0 and "1 filled shape is left out" in told.err
    assert len(told.figures["lines"]) == 1
    assert "--lines all --edge" in told.err
    advised = morfax(*words, "all", "--edge")
    assert advised.exit_code == 0
    lengths_mm = sorted(row["length_mm"] for row in advised.figures["lines"])
    assert lengths_mm == pytest.approx([math.pi * across_mm, 4 * 600 / 300 * 25.4], rel=0.01)


def test_an_outline_that_hangs_together_with_a_filled_bar_is_lost_and_not_left_out(
    morfax: Morfax, here: Path
) -> None:
    """(Ends with 0, and a note only, where `is_shape` does not look for lines inside.)"""
    grey = np.full((945, 1181), 245, np.uint8)  # 100 x 80 mm
    cv2.rectangle(grey, (120, 120), (1060, 825), 30, 6)
    cv2.rectangle(grey, (120, 120), (1060, 260), 30, -1)
    cv2.circle(grey, (400, 560), 118, 30, 6, cv2.LINE_AA)
    Image.fromarray(grey).save("bar.png", dpi=(300, 300))
    lost = morfax("trace", "bar.png", "-o", "bar.csv", "--lines", "contours", "--json")
    assert lost.exit_code == 4 and "--lines all --edge" in lost.fault
    assert [row["ending"] for row in lost.figures["lines"]].count("closed") == 1


SOFTEN = "soften the picture by 2 pixels, and --edge"


@pytest.mark.parametrize(
    ("across_mm", "white", "advice"),
    [(36, 0.02, "--edge"), (36, 0.3, SOFTEN), (14, 0.15, SOFTEN)],
)
def test_a_filled_shape_full_of_white_pixels_is_told_how_its_edge_is_followed(
    morfax: Morfax, here: Path, across_mm: int, white: float, advice: str
) -> None:
    """Its specks are taken for no net, which took minutes, and it is no line of chalk."""
    random = np.random.default_rng(1)
    grey = np.full((620, 620), 235, np.uint8)
    cv2.circle(grey, (310, 310), round(across_mm / 2 * 300 / MM_PER_INCH), 40, -1, cv2.LINE_AA)
    grey[(grey < 140) & (random.random(grey.shape) < white)] = 235
    Image.fromarray(grey).save("noisy.png", dpi=(300, 300))
    told = morfax("trace", "noisy.png", "-o", "noisy.csv")
    assert told.exit_code == 4 and "dark area" in told.fault and advice in told.fault
    assert "chalk" not in told.err
    Image.fromarray(cv2.GaussianBlur(grey, (0, 0), 2.0)).save("soft.png", dpi=(300, 300))
    assert morfax("trace", "soft.png", "-o", "soft.csv", "--edge").exit_code == 0


def test_a_dark_area_up_to_the_border_is_not_sent_to_edge(morfax: Morfax, here: Path) -> None:
    """A ramp of grey: --edge would refuse it, since it is cut by the border."""
    grey = np.tile(np.linspace(0, 255, 400).astype(np.uint8), (400, 1))
    Image.fromarray(grey).save("ramp.png", dpi=(300, 300))
    fault = morfax("trace", "ramp.png", "-o", "ramp.csv").fault
    assert "reaches the border of the picture" in fault and "--edge" not in fault
