"""Bold lines, of 3 to 6 mm: where they meet their ink is broader than a stroke, and is ink all the same."""

import math
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image
from scipy.spatial import cKDTree

from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.trace_ink import trace_ink

PX_PER_MM, WIDTH_MM, HEIGHT_MM = 8, 120, 80
STEEP_RAD = math.radians(40)
NEAR_MM = 0.2  # of 4 mm: two pixels, and what a round joint moves a path
# a cross at 40 degrees, and a corner of 40 degrees, mm from the upper left corner
CROSS = (
    ((10, 40), (54, 40)),
    tuple(
        (32 + s * 22 * math.cos(STEEP_RAD), 40 + s * 22 * math.sin(STEEP_RAD)) for s in (-1, 1)
    ),
)
CORNER = (
    ((108, 60), (72, 60)),
    ((72, 60), (72 + 36 * math.cos(STEEP_RAD), 60 - 36 * math.sin(STEEP_RAD))),
)


def opened(file: Path, wide_mm: float, paper: int, ink: int) -> Drawing:
    sheet = np.full((HEIGHT_MM * PX_PER_MM, WIDTH_MM * PX_PER_MM), paper, np.uint8)
    for line in (*CROSS, *CORNER):
        begin, end = (tuple(round(16 * PX_PER_MM * c) for c in place) for place in line)
        cv2.line(sheet, begin, end, ink, round(wide_mm * PX_PER_MM), cv2.LINE_AA, 4)
    Image.fromarray(sheet).save(file)
    return DrawingFile(file, dpi=25.4 * PX_PER_MM, all_ink=True).open()


@pytest.mark.parametrize(("paper", "ink"), [(240, 20), (30, 230)])
@pytest.mark.parametrize("wide_mm", [2.0, 4.0, 5.6])
def test_lines_are_as_dark_where_they_meet(
    tmp_path: Path, wide_mm: float, paper: int, ink: int
) -> None:
    darkness = np.asarray(opened(tmp_path / "a.png", wide_mm, paper, ink).darkness[:, :])
    for x_mm, y_mm in ((32, 40), (28, 40), (73.5, 60), (78, 60), (15, 40)):
        assert darkness[round(y_mm * PX_PER_MM), round(x_mm * PX_PER_MM)] > 0.9


def test_strokes_go_on_to_where_they_meet(tmp_path: Path) -> None:
    drawing = opened(tmp_path / "a.png", 4.0, 240, 20)
    assert not [note for note in drawing.notes if "wide" in note]
    along = np.concatenate([line.xy_mm for line in trace_ink(drawing).lines])
    far_mm, _ = cKDTree(along).query(
        [
            (x, HEIGHT_MM - y)
            for begin, end in (*CROSS, *CORNER)
            for x, y in np.linspace(begin, end, 200)[5:-5]
        ]
    )
    assert far_mm.max() < NEAR_MM


def test_areas_broader_than_a_stroke_beside_finer_lines_stay_none(tmp_path: Path) -> None:
    sheet = np.full((640, 960), 240, np.uint8)
    cv2.rectangle(sheet, (80, 80), (880, 560), 20, 16, cv2.LINE_AA)
    cv2.circle(sheet, (480, 320), 40, 20, -1, cv2.LINE_AA)
    Image.fromarray(sheet).save(tmp_path / "a.png")
    drawing = DrawingFile(tmp_path / "a.png", dpi=25.4 * PX_PER_MM).open()
    assert drawing.darkness[320, 480] < 0.5
