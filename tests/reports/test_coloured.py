"""Pictures: the error along a contour as lines of one colour each, and the page they stand on."""

from __future__ import annotations

from pathlib import Path as FilePath

import numpy as np
import pytest
from PIL import Image

from morfax.motion.arrays import Array
from morfax.motion.motion import Path
from morfax.reports import overlay
from morfax.reports.canvas import DPI
from morfax.reports.coloured import SHADES, error_lines
from morfax.reports.overlay import Picture, draw
from morfax.reports.page import lay_out, shortened
from morfax.reports.plate import shades

VIEW = (0.0, 100.0, 0.0, 100.0)
UM = 1e-3  # mm


def drawn(points: Array, error_mm: Array) -> tuple[list[Array], Array]:
    """The lines (places, with gaps) that are drawn, and the error that the colour of each stands for, um."""
    lines, scale = error_lines(points, error_mm, VIEW, 1.8)
    colours = [f"#{shade:06x}" for shade in shades(scale.colours, SHADES)]
    told = np.array([colours.index(line.colour) + 0.5 for line in lines])
    return [line.places_mm for line in lines], told * scale.largest / SHADES


def strokes(places: Array) -> list[Array]:
    """The pieces of a line between its gaps."""
    gaps = np.flatnonzero(np.isnan(places[:, 0]))
    return [part[np.isfinite(part[:, 0])] for part in np.split(places, gaps)]


def test_each_colour_is_one_line_and_the_largest_error_is_drawn_last() -> None:
    points = np.column_stack([np.linspace(0, 100, 2001), np.full(2001, 50.0)])
    error_mm = np.where(points[:, 0] < 50, 1 * UM, 4 * UM)
    lines, told_um = drawn(points, error_mm)
    assert len(lines) == 2
    assert told_um == pytest.approx(
        [1.0, 4.0], abs=4.0 / SHADES
    )  # um, half a shade to either side
    assert lines[1][:, 0].min() >= 49.9  # mm, one step of 0.05 before the change
    assert [len(strokes(line)) for line in lines] == [1, 1]  # each in one stroke


def test_the_largest_error_shows_however_many_points_there_are() -> None:
    points = np.column_stack([np.linspace(0, 100, 100_000), np.full(100_000, 50.0)])
    error_mm = np.full(len(points), 1 * UM)
    error_mm[70_003] = 8 * UM
    lines, told_um = drawn(points, error_mm)
    assert told_um[-1] == pytest.approx(8.0, abs=8.0 / SHADES)  # um
    assert np.abs(lines[-1][:, 0] - 70.0).max() < 0.2  # mm: two dots of the picture
    assert sum(len(places) for places in lines) < 5000  # of 100 000: a dot of the picture each


def test_a_way_with_the_tool_up_and_one_without_a_number_are_not_drawn() -> None:
    x = np.r_[np.linspace(0, 40, 401), np.linspace(60, 100, 401)]
    error_mm = np.full(len(x), 2 * UM)
    error_mm[100:201] = np.nan  # 10 to 20 mm
    lines, _ = drawn(np.column_stack([x, np.full(len(x), 50.0)]), error_mm)
    pieces = strokes(lines[0])
    begins, ends = [piece[0, 0] for piece in pieces], [piece[-1, 0] for piece in pieces]
    assert len(lines) == 1
    assert begins == pytest.approx([0, 20, 60], abs=0.2)  # mm: two dots
    assert ends == pytest.approx([10, 40, 100], abs=0.2)


@pytest.mark.parametrize("shape", [0.05, 0.5, 1.0, 1.4, 5.0])
@pytest.mark.parametrize("insets", [0, 3])
def test_axes_stand_apart_on_the_page_and_keep_their_shape(shape: float, insets: int) -> None:
    page = lay_out(shape, insets, has_bar=True)
    assert page.bar is not None and len(page.insets) == insets
    boxes = [page.main, page.bar, *page.insets]
    for number, (left, low, wide, high) in enumerate(boxes):
        assert 0 < left < left + wide < page.width_in
        assert 0 < low < low + high < page.height_in
        for other_left, other_low, other_wide, other_high in boxes[:number]:
            apart = left + wide < other_left or other_left + other_wide < left
            assert apart or low + high < other_low or other_low + other_high < low
    assert page.main.height_in / page.main.width_in == pytest.approx(max(shape, 0.2))


def test_a_long_title_stays_on_the_picture(tmp_path: FilePath) -> None:
    places = np.column_stack(
        [np.linspace(0, 90, 50), np.linspace(0, 60, 50), np.full(50, -1.0)]
    )
    path = Path(np.arange(50.0), places)
    for title in ("short", "a_name$of_a^file" * 30):
        draw(Picture(title, path), tmp_path / "a.png")
        with Image.open(tmp_path / "a.png") as image:
            grey = np.asarray(image.convert("L"))
        assert (grey[:, : DPI // 20] == 255).all() and (grey[:, -DPI // 20 :] == 255).all()


def test_a_long_name_does_not_hide_what_the_colours_mean() -> None:
    said = ": the path, coloured by its distance from the ink"
    short = shortened("a_name_of_a_file" * 30 + said, 80)
    assert len(short) == 80
    assert short.startswith("a_name_of_a_file") and short.endswith(said)
    assert shortened("a" + said, 80) == "a" + said


def test_the_path_of_a_tool_that_runs_beside_the_line_is_named() -> None:
    """What its edge touches is coloured; the thin line beside that was in no legend."""
    places = np.column_stack([np.linspace(0, 90, 50), np.full(50, 30.0), np.full(50, -1.0)])
    edge = places[:, :2] + [0, 0.1]
    path = Path(np.arange(50.0), places)
    beside = Picture("cut", path, None, None, edge, np.full(50, UM), path_called="middle")
    main = overlay._laid_out(beside, overlay.view_of(beside), 0)[1]
    assert "middle" in [mark.label for mark in main.legend]
    assert not overlay._enlarged(beside, edge[0], 1).legend
