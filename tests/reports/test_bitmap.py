"""Pictures as pixels: marks lie where their places are, and a .png needs no matplotlib."""

from __future__ import annotations

import itertools
import subprocess
import sys
from pathlib import Path as FilePath

import numpy as np
import pytest

from morfax.motion.motion import Path
from morfax.reports import bitmap, vector
from morfax.reports.axis_numbers import numbers
from morfax.reports.canvas import DPI, save
from morfax.reports.overlay import Picture, draw
from morfax.reports.page import Box, PageLayout
from morfax.reports.plate import (
    BLACK,
    Caption,
    Ground,
    Plate,
    Polyline,
    Spot,
    TintedArea,
    free_corner,
    with_gaps,
)

PAGE = PageLayout(4.0, 4.0, Box(0.5, 0.5, 3.0, 3.0), [], None)  # 300 x 300 mm at 100 mm an inch
VIEW = (0.0, 300.0, 0.0, 300.0)
RED, BLUE = "#ff0000", "#0000ff"
MM = DPI / 100  # pixels of that page


def page_of(plate: Plate) -> np.ndarray:
    """The pixels of a page with one plate, (rows, columns, BGR)."""
    return bitmap.drawn(PAGE, [(PAGE.main, plate)], None).astype(int)


def is_red(pixels: np.ndarray) -> np.ndarray:
    return (pixels[:, :, 2] > 200) & (pixels[:, :, 1] < 120) & (pixels[:, :, 0] < 120)


def places_mm(of: np.ndarray) -> np.ndarray:
    """The middles of pixels, x and y on the sheet."""
    rows, columns = np.nonzero(of)
    left, bottom = 0.5 * DPI, 3.5 * DPI
    return np.column_stack([columns + 0.5 - left, bottom - rows - 0.5]) / MM


def test_a_line_lies_where_its_places_are_and_has_its_gap() -> None:
    runs = [np.array([[50.0, 100.0], [100.0, 100.0]]), np.array([[200.0, 100.0], [250, 100.0]])]
    found = places_mm(is_red(page_of(Plate(VIEW, marks=[Polyline(with_gaps(runs), RED, 3.0)]))))
    assert found[:, 1].mean() == pytest.approx(100.0, abs=0.5 / MM)  # half a pixel
    assert found[:, 1].max() - found[:, 1].min() == pytest.approx(
        3.0 * DPI / 72 / MM, abs=2 / MM
    )
    assert found[:, 0].min() == pytest.approx(50.0, abs=5 / MM)  # round ends
    assert found[:, 0].max() == pytest.approx(250.0, abs=5 / MM)
    assert not ((found[:, 0] > 105) & (found[:, 0] < 195)).any()


def test_a_higher_order_lies_on_top_and_nothing_leaves_the_axes() -> None:
    across = np.array([[-900.0, 150.0], [900.0, 150.0]])
    marks = [Polyline(across, RED, 6.0, order=3), Polyline(across[:, ::-1], BLUE, 6.0, order=2)]
    pixels = page_of(Plate(VIEW, marks=marks))
    assert is_red(pixels)[round(2 * DPI), round(2 * DPI)]  # where both cross
    found = places_mm(is_red(pixels))
    assert found[:, 0].min() > -2 / MM and found[:, 0].max() < 300 + 2 / MM


@pytest.mark.parametrize("shape", ["o", "s", "D", "X", "P", "*", "+"])
def test_a_spot_is_about_its_place(shape: str) -> None:
    found = places_mm(is_red(page_of(Plate(VIEW, marks=[Spot((80.0, 210.0), shape, 20, RED)]))))
    middle = (found.min(axis=0) + found.max(axis=0)) / 2
    assert middle[0] == pytest.approx(80.0, abs=1 / MM)
    assert middle[1] == pytest.approx(210.0, abs=3 / MM)  # a star is higher than deep
    size = {"D": 20 * 2**0.5}.get(shape, 20) * DPI / 72  # pixels
    assert np.ptp(found[:, 0]) * MM == pytest.approx(size, abs=4)


def test_an_area_shines_through_to_the_drawing_below() -> None:
    grey = np.full((30, 30), 200, np.uint8)
    grey[:15] = 100  # the upper half
    corners = np.array([[0.0, 0.0], [150.0, 0.0], [150.0, 300.0], [0.0, 300.0]])
    plate = Plate(VIEW, ground=Ground(grey, VIEW), marks=[TintedArea(corners, "#000000", 0.5)])
    pixels = page_of(plate)
    row, column = np.array([1.25, 2.75]) * DPI, np.array([1.25, 2.75]) * DPI
    seen = pixels[np.ix_(row.astype(int), column.astype(int))][:, :, 0]
    assert seen == pytest.approx(np.array([[50, 100], [100, 200]]), abs=1)


@pytest.mark.parametrize("aside_mm", [(-400, 0), (400, 0), (0, -400), (0, 400), (400, 400)])
def test_a_drawing_beside_the_page_is_not_seen_and_one_across_its_edge_is_in_part(
    aside_mm: tuple[float, float],
) -> None:
    grey = np.full((30, 30), 100, np.uint8)
    beside, across = (
        tuple(VIEW[end] + share * aside_mm[end // 2] for end in range(4)) for share in (1, 0.5)
    )
    seen = page_of(Plate(VIEW, ground=Ground(grey, beside)))  # type: ignore[arg-type]
    assert np.array_equal(seen, page_of(Plate(VIEW)))
    seen = page_of(Plate(VIEW, ground=Ground(grey, across)))  # type: ignore[arg-type]
    parts = [1 - 0.5 * abs(aside) / 300 for aside in aside_mm]
    assert (seen == 100).all(axis=2).mean() == pytest.approx(9 / 16 * np.prod(parts), abs=0.01)


def test_words_stand_beside_their_place_and_a_legend_in_its_corner() -> None:
    plate = Plate(VIEW, marks=[Caption((150.0, 150.0), "M", 30, RED, (20.0, 10.0))])
    found = places_mm(is_red(page_of(plate)))
    pt = DPI / 72 / MM  # in mm
    assert found[:, 0].min() == pytest.approx(150 + 20 * pt, abs=3 * pt)
    assert found[:, 1].min() == pytest.approx(150 + 10 * pt, abs=2 * pt)
    plate = Plate(VIEW, marks=[Polyline(np.zeros((0, 2)), RED, 3.0, label="a line")])
    found = places_mm(is_red(page_of(plate)))
    assert len(found) and (found > 200).all()


@pytest.mark.parametrize("taken", list(itertools.product((True, False), repeat=2)))
def test_a_legend_stands_in_the_corner_in_which_the_fewest_places_lie(
    taken: tuple[bool, bool],
) -> None:
    """All corners but one are full of a line; then the words of the legend stand in that one."""
    corners = {
        (is_upper, is_right): np.array([240.0 if is_right else 10, 240.0 if is_upper else 10])
        for is_upper in (True, False)
        for is_right in (True, False)
    }
    full = np.vstack([np.linspace(at, at + 50, 99) for c, at in corners.items() if c != taken])
    assert free_corner(Plate(VIEW, marks=[Polyline(full, BLACK, 1.0)]), (0.3, 0.3)) == taken
    plate = Plate(
        VIEW, marks=[Polyline(full, BLACK, 0.1), Polyline(full[:0], RED, 3.0, label="a line")]
    )
    found = places_mm(is_red(page_of(plate)))
    assert len(found)
    assert (found[:, 0] > 150).all() == taken[1] and (found[:, 1] > 150).all() == taken[0]


@pytest.mark.parametrize(
    ("first", "last", "steps", "written"),
    [
        (0.0, 6.4, 9, ["0", "1", "2", "3", "4", "5", "6"]),
        (81.48, 82.48, 4, ["81.50", "81.75", "82.00", "82.25"]),
        (-20.0, 21.0, 5, ["\N{MINUS SIGN}20", "\N{MINUS SIGN}10", "0", "10", "20"]),
        (0.0, 0.0031, 4, ["0.000", "0.001", "0.002", "0.003"]),
        (0.0, 9000.0, 9, [str(n * 1000) for n in range(10)]),
    ],
)
def test_numbers_along_an_axis_are_round(
    first: float, last: float, steps: int, written: list[str]
) -> None:
    assert [text for _, text in numbers(first, last, steps)] == written


def test_pixels_and_vectors_show_the_same(tmp_path: FilePath) -> None:
    from PIL import Image

    t = np.linspace(0, 2 * np.pi, 200)
    around = 150 + 100 * np.column_stack([np.cos(t), np.sin(2 * t)])
    marks = [Polyline(around, RED, 2.0, label="way"), Spot((60.0, 60.0), "D", 9, BLUE, "stop")]
    marks.append(Caption((60, 60), "D1", 9))
    plates = [(PAGE.main, Plate(VIEW, "a title", names=None, marks=marks))]
    save(vector.figure_of(PAGE, plates, None), tmp_path / "a.png", trim=False)
    with Image.open(tmp_path / "a.png") as image:
        theirs = np.asarray(image.convert("L"), float)
    ours = bitmap.drawn(PAGE, plates, None)[:, :, ::-1] @ [0.299, 0.587, 0.114]
    assert ours.shape == theirs.shape
    # edges are soft in other ways: a line may be half a pixel wider, or lie half a pixel beside the other one
    assert (
        np.abs(ours - theirs).mean() < 3.0
    )  # of 255: a hundredth of the page is other than it was
    blurred = [
        np.add.reduceat(np.add.reduceat(page, range(0, 520, 8), 0), range(0, 520, 8), 1) / 64
        for page in (ours, theirs)
    ]
    # a mark that is missing, or lies elsewhere, is 60 and more of a square that it goes through
    assert np.abs(blurred[0] - blurred[1]).max() < 40


def test_a_png_needs_no_matplotlib(tmp_path: FilePath) -> None:
    code = (
        "import sys, numpy as np\n"
        "from pathlib import Path as FilePath\n"
        "from morfax.motion.motion import Path\n"
        "from morfax.reports.overlay import Picture, draw\n"
        "places = np.column_stack([np.linspace(0, 90, 50), np.linspace(0, 60, 50), -np.ones(50)])\n"
        "draw(Picture('a', Path(np.arange(50.0), places)), FilePath(sys.argv[1]))\n"
        "print([name for name in ('matplotlib', 'scipy', 'numba') if name in sys.modules])\n"
    )
    words = [sys.executable, "-c", code, str(tmp_path / "a.png")]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    assert (tmp_path / "a.png").stat().st_size > 1000


def test_both_kinds_of_picture_can_be_asked_for(tmp_path: FilePath) -> None:
    places = np.column_stack([np.linspace(0, 90, 50), np.linspace(0, 60, 50), -np.ones(50)])
    path = Path(np.arange(50.0), places)
    draw(Picture("a way", path, stops_mm={"D1": (3.0, 4.0)}), tmp_path / "a.svg")
    assert "</svg>" in (tmp_path / "a.svg").read_text(encoding="utf-8")
