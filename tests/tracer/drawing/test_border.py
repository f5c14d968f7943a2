"""The border of a picture is made paper; what is drawn on the sheet stays as it is."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from morfax.tracer.drawing.border import without_border
from morfax.tracer.drawing.deepening import LEAST
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.drawing.shapes_among_lines import drawing_of_all_ink

Picture = NDArray[np.float32]


def sheet(*, circle: bool = True) -> Picture:
    made = np.zeros((600, 800), np.float32)
    if circle:
        cv2.circle(made, (400, 300), 180, 1.0, 6)
    return made


def framed(inset: int, width: int, *, circle: bool = True) -> Picture:
    made = sheet(circle=circle)
    cv2.rectangle(made, (inset, inset), (799 - inset, 599 - inset), 1.0, width)
    return made


@pytest.mark.parametrize(("inset", "width"), [(0, 1), (0, 6), (2, 3), (0, 20)])
def test_a_frame_at_the_edges_is_made_paper_and_nothing_else(inset: int, width: int) -> None:
    picture = framed(inset, width)
    assert without_border(picture) == ("upper", "lower", "left", "right")
    assert np.array_equal(picture, sheet())


def test_a_dark_strip_along_two_edges_is_made_paper_with_its_soft_edge() -> None:
    picture = sheet()
    picture[:8], picture[:, :5] = 1.0, 1.0
    picture[8, 5:], picture[9, 5:] = 0.4, 0.1
    assert without_border(picture) == ("upper", "left")
    assert np.array_equal(picture, sheet())


@pytest.mark.parametrize(
    "kept",
    [
        framed(10, 4),  # a frame with paper about it is drawn
        framed(0, 6, circle=False),  # the only ink
        sheet() + np.roll(sheet(), 320, axis=0),  # a line that runs off the sheet
        np.maximum(framed(0, 60), 0),  # wider than any border
    ],
)
def test_what_is_drawn_stays(kept: Picture) -> None:
    picture = kept.copy()
    assert without_border(picture) == ()
    assert np.array_equal(picture, kept)


def test_the_operator_is_told() -> None:
    grey = (240 - 200 * framed(0, 6)).astype(np.uint8)
    drawing = Drawing.of(Scan(Path("framed.png"), grey), Scale(300.0))
    assert (
        "the ink along the upper, lower, left, right edges of the picture" in drawing.notes[-1]
    )
    assert drawing.darkness[2].max() == 0.0


def test_a_row_that_resizing_has_left_half_grey_is_a_border_where_pale_lines_are_followed() -> (
    None
):
    """It was a line of a pixel along all the sheet, beside which a pen's lines were walls."""
    picture = sheet()
    picture[:, -1] = 0.45
    assert without_border(picture.copy()) == ()
    assert without_border(picture, LEAST) == ("right",) and np.array_equal(picture, sheet())
    pixels = np.asarray(240 - 200 * sheet(), np.uint8)
    pixels[:, -1] = 150
    scan = Scan(Path("made.png"), pixels, Stated((150.0, 150.0)))
    notes = drawing_of_all_ink(scan, Scale(), None, "auto").notes
    assert any("right edge" in note for note in notes)
    assert not any("less than half as dark" in note for note in notes)
