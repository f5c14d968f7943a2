"""`--flatten`, `--bar` and `sheet` as a user meets them: figures, pictures, warnings, refusals."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from morfax.jobs.listener import Silent
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.motion.contour import distances_mm
from morfax.motion.pathfile import read_path
from tests.console.conftest import Morfax
from tests.tracer.flatten.photographs import A4, Array, blank, draw, marked, phone

MM = 1.0
ROUND = np.linspace(0, 2 * math.pi, 400)
RING: Array = np.column_stack([105 + 45 * np.cos(ROUND), 150 + 60 * np.sin(ROUND)])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with photographs of a sheet with marks, of plain paper, and of a table."""
    place = tmp_path_factory.mktemp("photographs")
    for name, sheet in (("marks", marked()), ("plain", blank(A4))):
        draw(sheet, RING)
        phone(12, 0.02).write(sheet, A4, place / f"{name}.jpg")
    with Image.open(place / "plain.jpg") as picture:
        table = Image.new("RGB", picture.size, (90, 80, 70))
        table.save(place / "table.jpg", exif=picture.getexif())
    return place


def test_a_photograph_of_a_sheet_with_marks_is_flattened_by_itself(
    morfax: Morfax, folder: Path, tmp_path: Path
) -> None:
    path, picture = tmp_path / "ring.csv", tmp_path / "ring.png"
    words = (folder / "marks.jpg", "-o", path, "--picture", picture, "--json")
    figures = morfax("trace", *words).figures
    assert figures["flattened_by"] == "14 of 14 marks on a4, 210 x 297 mm"
    assert figures["tilt_deg"] == pytest.approx(12, abs=0.3)
    assert figures["bar_mm"] == pytest.approx(100, abs=0.1)
    assert figures["finest_pixel_mm"] < figures["coarsest_pixel_mm"]
    assert figures["residual_rms_mm"] <= figures["residual_largest_mm"] < 0.1 * MM
    assert Path(figures["flat_picture"]) == tmp_path / "ring.flat.png"
    with Image.open(tmp_path / "ring.flat.png") as image:
        assert min(image.size) > 500  # px: of both, photograph and flat sheet
    off = distances_mm(read_path(path).runs()[0], RING)
    assert float(np.sqrt(np.mean(off**2))) < 0.06 * MM  # asked of 12 Mpx; this one has 1.4


def test_a_bar_of_another_length_and_the_figures_as_text(
    morfax: Morfax, folder: Path, tmp_path: Path
) -> None:
    told = morfax("trace", folder / "marks.jpg", "--bar", "99mm", "-o", tmp_path / "a.csv")
    assert told.exit_code == 0, told.err
    assert "207.9 x 294.03 mm" in told.out and "tilt  " in told.out and "degrees" in told.out


def test_edges_of_the_sheet_where_a_format_is_given(
    morfax: Morfax, folder: Path, tmp_path: Path
) -> None:
    path = tmp_path / "ring.csv"
    told = morfax("trace", folder / "plain.jpg", "--flatten", "paper=a4", "-o", path)
    assert told.exit_code == 0, told.err
    off = distances_mm(read_path(path).runs()[0], RING)
    assert float(np.sqrt(np.mean(off**2))) < 0.2 * MM


class Heard(Silent):
    """A listener that keeps the warnings."""

    def __init__(self) -> None:
        self.warnings: list[str] = []

    def warning(self, text: str) -> None:
        """Keep a warning."""
        self.warnings.append(text)


def test_a_tilted_photograph_with_a_width_is_warned_of(folder: Path) -> None:
    heard = Heard()
    DrawingFile(folder / "plain.jpg", width_mm=300.0).open(heard)
    assert len(heard.warnings) == 1
    assert re.search(
        r"at a tilt of some 1[123] degrees: sizes come out (1\.9|2\.\d) % wrong, and differ by up to"
        r" \d\d % .*--flatten paper=a4",
        heard.warnings[0],
    )


@pytest.mark.parametrize(
    ("name", "words", "code", "told"),
    [
        (
            "table.jpg",
            (),
            3,
            "shows neither marks nor the four edges of a sheet; give --flatten",
        ),
        ("table.jpg", ("--flatten", "marks"), 3, "shows no marks; print a sheet with"),
        ("table.jpg", ("--flatten", "paper=a4"), 3, "the four edges of the sheet do not show"),
        ("plain.jpg", (), 3, "its sheet can be a4, a3, a5, a2 or a6; give --flatten paper=a4"),
        ("plain.jpg", ("--flatten", "paper=letter"), 3, "does not have the sides of letter"),
        ("plain.jpg", ("--bar", "99mm"), 3, "shows no marks"),
        ("plain.jpg", ("--bar", "9mm"), 2, "may be 90mm to 110mm"),
        ("plain.jpg", ("--flatten", "paper=b7"), 2, "'b7' is no format of paper; give a4"),
        ("plain.jpg", ("--flatten", "0,0 0,9 9,9 9,0=9x9cm"), 2, "run anticlockwise"),
        ("plain.jpg", ("--flatten", "marks", "--width", "9cm"), 2, "gives the scale itself"),
        ("plain.jpg", ("--flatten", "paper=a4", "--bar", "99mm"), 2, "leave it out"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(
    morfax: Morfax,
    folder: Path,
    tmp_path: Path,
    name: str,
    words: tuple[str, ...],
    code: int,
    told: str,
) -> None:
    answer = morfax("trace", folder / name, *words, "-o", tmp_path / "a.csv")
    assert answer.exit_code == code and told in answer.fault
    assert list(tmp_path.iterdir()) == []


def test_a_sheet_to_print(morfax: Morfax, tmp_path: Path) -> None:
    file = tmp_path / "sheet.pdf"
    figures = morfax("sheet", "-o", file, "--json").figures
    assert figures["marks"] == 14 and file.read_bytes().startswith(b"%PDF")
    assert (figures["frame_width_mm"], figures["frame_height_mm"]) == (170, 250)


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        (("-o", "sheet.gif"), 2, "must end in .pdf, .svg, .png"),
        (("-o", "no/sheet.pdf"), 8, "there is no folder no"),
        (("-o", "sheet.pdf", "--paper", "a5"), 2, "'a5' has no marks; give a4, letter, a3"),
        ((), 2, "Missing option '-o'"),
    ],
)
def test_a_sheet_that_cannot_be(
    morfax: Morfax, words: tuple[str, ...], code: int, told: str
) -> None:
    answer = morfax("sheet", *words)
    assert answer.exit_code == code and told in answer.fault
