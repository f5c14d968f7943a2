"""Filled shapes: the head rides on their edge as on a line, round corners both ways, and holes are lines of their own."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image
from skimage.draw import polygon

from motion.contour import distance
from motion.faults import DrawingFault
from motion.motion import thin
from tests.tracer.inked import DPI, SOFTNESS_MM, UM, Points, arc, polyline
from tracer.drawing import MM_PER_INCH, Drawing
from tracer.sequence import trace
from tracer.tour import trace_lines

CIRCLE = arc((16, 16), 10)
STEPPED = polyline((8, 8), (28, 8), (28, 18), (18, 18), (18, 26), (8, 26), (8, 8))  # five corners outward, one inward


def filled(file: Path, *outlines: Points, holes: tuple[Points, ...] = (), seed: int = 1) -> Path:
    """Filled shapes on a sheet of 36 x 34 mm at 300 dpi, eight times too fine by the middles of the pixels, as a scanner sees them."""
    rows, columns = (round(side * DPI / MM_PER_INCH) for side in (34, 36))
    fine = np.zeros((8 * rows, 8 * columns), np.float32)
    scale = 8 * DPI / MM_PER_INCH
    for outline, level in (*((outline, 1.0) for outline in outlines), *((hole, 0.0) for hole in holes)):
        i, j = polygon(8 * rows - outline[:, 1] * scale - 0.5, outline[:, 0] * scale - 0.5, fine.shape)
        fine[i, j] = level
    dark = cv2.GaussianBlur(
        cv2.resize(fine, (columns, rows), interpolation=cv2.INTER_AREA), (0, 0), SOFTNESS_MM * DPI / MM_PER_INCH
    )
    grey = 235 - 195 * dark + np.random.default_rng(seed).normal(0, 8, dark.shape)
    Image.fromarray(np.clip(np.round(grey), 0, 255).astype(np.uint8)).save(file, dpi=(DPI, DPI))
    return file


def test_round_a_disc(tmp_path: Path) -> None:
    run = trace(Drawing.open(filled(tmp_path / "disc.png", CIRCLE), edge=True))
    found = distance(thin(run), CIRCLE)
    assert run.ending == "closed" and found.path_to_reference.rms_mm < 4 * UM, found  # asked: 5


def test_corners_are_sharp_both_outward_and_inward(tmp_path: Path) -> None:
    run = trace(Drawing.open(filled(tmp_path / "stepped.png", STEPPED), edge=True))
    found = distance(thin(run), STEPPED)
    assert run.ending == "closed" and found.path_to_reference.rms_mm < 8 * UM, found
    assert found.hausdorff_mm < 30 * UM, found  # asked: 60


def test_a_hole_is_a_line_of_its_own(tmp_path: Path) -> None:
    hole = arc((15, 16), 4)
    run = trace_lines(Drawing.open(filled(tmp_path / "ring.png", CIRCLE, holes=(hole,)), edge=True))
    assert [line.ending for line in run.lines] == ["closed", "closed"]
    assert distance(thin(run), [CIRCLE, hole]).hausdorff_mm < 25 * UM


def test_a_blank_sheet_has_no_edge(tmp_path: Path) -> None:
    file = tmp_path / "blank.png"
    Image.fromarray(np.full((300, 300), 240, np.uint8)).save(file, dpi=(300, 300))
    with pytest.raises(DrawingFault, match="no filled shape on the drawing"):
        Drawing.open(file, edge=True)
