"""Paths as SVG in true size."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from pathlib import Path as FilePath

import numpy as np
import pytest

from morfax.motion.motion import Path
from morfax.reports.svg import write_svg

TENTH_UM = 1e-4  # mm; what the file is written to


def path_of(xy_mm: list[tuple[float, float]], z_mm: list[float]) -> Path:
    """A path of one point per second."""
    return Path(
        np.arange(len(z_mm), dtype=float), np.column_stack([np.array(xy_mm), np.array(z_mm)])
    )


def read(file: FilePath) -> tuple[np.ndarray, list[np.ndarray]]:
    """The page's width and height in mm, and the polylines with Y up from its lower edge."""
    root = ElementTree.parse(file).getroot()
    size = np.array(
        [float(root.attrib[side].removesuffix("mm")) for side in ("width", "height")]
    )
    assert root.attrib["viewBox"].split()[2:] == [
        root.attrib[side].removesuffix("mm") for side in ("width", "height")
    ]
    lines = root.iter("{http://www.w3.org/2000/svg}polyline")
    points = [
        np.array([p.split(",") for p in line.attrib["points"].split()], float) for line in lines
    ]
    return size, [np.column_stack([p[:, 0], size[1] - p[:, 1]]) for p in points]


def test_one_unit_is_a_millimetre_and_the_page_s_corner_is_the_sheet_s(
    tmp_path: FilePath,
) -> None:
    write_svg(path_of([(10, 20), (30, 20), (30, 45)], [0, 0, 0]), tmp_path / "a.svg")
    size, (line,) = read(tmp_path / "a.svg")
    assert line == pytest.approx(np.array([[10, 20], [30, 20], [30, 45]]), abs=TENTH_UM)
    assert size == pytest.approx([35, 50])  # a margin of 5 mm beyond the path


def test_moves_with_the_tool_up_are_not_drawn(tmp_path: FilePath) -> None:
    corners = [(1.0, 1.0), (5.0, 1.0), (5.0, 1.0), (9.0, 1.0), (9.0, 1.0), (9.0, 5.0)]
    write_svg(path_of(corners, [0, 0, 2, 2, 0, 0]), tmp_path / "a.svg")
    _, lines = read(tmp_path / "a.svg")
    assert [line.tolist() for line in lines] == [[[1, 1], [5, 1]], [[9, 1], [9, 5]]]


def test_a_path_left_of_or_below_the_corner_stays_on_the_page(tmp_path: FilePath) -> None:
    write_svg(path_of([(-10, 3), (20, -4)], [0, 0]), tmp_path / "a.svg")
    size, (line,) = read(tmp_path / "a.svg")
    assert (line > 0).all() and (line < size).all()
    assert np.diff(line, axis=0) == pytest.approx(np.array([[30, -7]]), abs=TENTH_UM)
