"""What is told before a sheet is traced: nearly all ink is too short to be lines."""

from pathlib import Path

import cv2
import numpy as np
from PIL import Image

from morfax.jobs.remarks.many_pieces import of_many_pieces
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.tracer.drawing.drawing import Drawing

WIDTH_MM, PX = 100.0, 1000
BLACK, BLUE = (20, 20, 20), (90, 110, 230)


def dashed(colour: tuple[int, int, int]) -> np.ndarray:
    """A black line over dashes 3 mm long of a colour."""
    sheet = np.full((PX, PX, 3), 250, np.uint8)
    for x in range(40, 960, 50):
        for y in range(40, 960, 50):
            cv2.line(sheet, (x, y), (x + 28, y), colour, 5)
    cv2.line(sheet, (100, 120), (900, 870), BLACK, 6)
    return sheet


def opened(sheet: np.ndarray, file: Path, ink: str | None = None) -> Drawing:
    Image.fromarray(sheet).save(file)
    return DrawingFile(file, width_mm=WIDTH_MM, ink=ink).open()


def test_short_print_of_another_colour_is_told_and_the_advice_works(tmp_path: Path) -> None:
    """Blue dashes 3 mm long under a black line, as on printed sketching paper."""
    sheet = dashed(BLUE)
    all_ink = opened(sheet, tmp_path / "a.png")
    assert [text for text in of_many_pieces(all_ink) if "--ink black" in text]
    own = opened(sheet, tmp_path / "a.png", "black")
    assert not list(of_many_pieces(own))
    assert own.sheet.patches.count < 20


def test_no_colour_is_advised_where_one_was_given(tmp_path: Path) -> None:
    """Black dashes under the black line: to name black once more would not help; a tone is no colour."""
    sheet = dashed(BLACK)
    for ink in ("black", "dark"):
        [text] = of_many_pieces(opened(sheet, tmp_path / "a.png", ink))
        assert ("--ink" in text) == (ink == "dark")
