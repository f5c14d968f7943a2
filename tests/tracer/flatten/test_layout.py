"""The sheet with marks: every mark tells paper and place, nothing overlaps, the bar is 100 mm."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import cv2
import numpy as np
import pytest

from morfax.reports.marked_sheet import write_sheet
from morfax.tracer.flatten.layout import FIRST, Box, Layout, dictionary
from tests.tracer.flatten.photographs import PX_PER_MM, marked

SHEETS = [Layout.of(name) for name in FIRST]


def apart(a: Box, b: Box) -> bool:
    """Whether two boxes have no place in common."""
    return a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]


def test_no_mark_stands_on_two_sheets_and_all_are_in_the_dictionary() -> None:
    numbers = [number for sheet in SHEETS for number in sheet.marks_mm]
    assert len(numbers) == len(set(numbers))
    assert max(numbers) < len(dictionary().bytesList)


@pytest.mark.parametrize("sheet", SHEETS, ids=list(FIRST))
def test_marks_stand_all_round_inside_the_paper_and_beside_the_bar(sheet: Layout) -> None:
    assert len(sheet.marks_mm) >= 12
    corners = np.vstack(list(sheet.marks_mm.values()))
    size = (sheet.paper.width_mm, sheet.paper.height_mm)
    assert (corners >= 6.4).all() and (
        corners <= np.array(size) - 6.4
    ).all()  # mm that printers leave
    boxes = [*sheet.printed_mm(), sheet.frame_mm]
    assert all(apart(a, b) for a, b in combinations(boxes, 2))
    assert np.ptp(sheet.bar_mm[:, 0]) == pytest.approx(100)


def test_opencv_finds_every_mark_where_the_layout_says() -> None:
    grey = cv2.cvtColor(marked(), cv2.COLOR_RGB2GRAY)
    corners, numbers, _ = cv2.aruco.ArucoDetector(dictionary()).detectMarkers(grey)
    layout = Layout.of("a4")
    assert sorted(numbers.ravel().tolist()) == sorted(layout.marks_mm)
    for number, four in zip(numbers.ravel(), corners, strict=True):
        x, y = layout.marks_mm[int(number)].T * PX_PER_MM
        assert four.reshape(4, 2) == pytest.approx(
            np.column_stack([x, 2970 - y]), abs=1.5
        )  # px


@pytest.mark.parametrize("suffix", [".pdf", ".svg"])
def test_the_file_has_the_size_of_the_paper(tmp_path: Path, suffix: str) -> None:
    file = tmp_path / f"sheet{suffix}"
    write_sheet(Layout.of("letter"), file)
    said = file.read_bytes()
    points = (
        b"/MediaBox [ 0 0 612 792 ]" if suffix == ".pdf" else b'width="612pt" height="792pt"'
    )
    assert points in said


def test_the_bar_is_on_the_pixels_that_it_should_be_on() -> None:
    layout = Layout.of("a4")
    (left, y), (right, _) = layout.bar_mm
    row = marked()[round(2970 - y * PX_PER_MM), :, 0] < 128
    inked = np.flatnonzero(row[round(30 * PX_PER_MM) : round(180 * PX_PER_MM)]) + 30 * PX_PER_MM
    assert inked.min() / PX_PER_MM == pytest.approx(left, abs=1 / PX_PER_MM)
    assert (inked.max() + 1) / PX_PER_MM == pytest.approx(right, abs=1 / PX_PER_MM)


@pytest.mark.parametrize("name", list(FIRST))
def test_all_that_is_black_lies_in_the_boxes_that_become_paper(name: str) -> None:
    sheet = marked(name)
    for left, bottom, right, top in Layout.of(name).printed_mm():
        a, b = (len(sheet) - round(edge * PX_PER_MM) for edge in (top, bottom))
        sheet[a:b, round(left * PX_PER_MM) : round(right * PX_PER_MM)] = 255
    assert sheet[..., 1:].min() > 200  # levels of green and blue: the grid alone is left
