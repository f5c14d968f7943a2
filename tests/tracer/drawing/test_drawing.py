"""The drawing: every kind of image, its scale, its paper; the line lies in sheet mm where it was drawn."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from morfax.motion.faults import DrawingFault, FileFault
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.polarity import LIGHT_LINES
from tests.tracer.drawing.images import DPI, PEN_MM, Grey, off_the_line_mm, opened
from tests.tracer.inked import UM

KINDS: dict[str, Callable[[Grey], Image.Image]] = {
    "grey.png": Image.fromarray,
    "grey.tif": Image.fromarray,
    "grey.jpg": Image.fromarray,
    "grey.bmp": Image.fromarray,
    "sixteen.png": lambda g: Image.fromarray(g.astype(np.uint16) * 257),
    "sixteen.tif": lambda g: Image.fromarray(g.astype(np.uint16) * 257),
    "thirtytwo.tif": lambda g: Image.fromarray(g.astype(np.int32) * 257),
    "float.tif": lambda g: Image.fromarray(g.astype(np.float32)),
    "colour.png": lambda g: Image.fromarray(g).convert("RGB"),
    "colour.jpg": lambda g: Image.fromarray(g).convert("RGB"),
    "palette.png": lambda g: Image.fromarray(g).convert("P"),
    "cmyk.tif": lambda g: Image.fromarray(g).convert("CMYK"),
    "cmyk.jpg": lambda g: Image.fromarray(g).convert("CMYK"),
    "alpha.png": lambda g: Image.fromarray(g).convert("LA"),
    "coloured-alpha.tif": lambda g: Image.fromarray(g).convert("RGBA"),
    "ink-in-the-alpha.png": lambda g: Image.merge(
        "LA", (Image.new("L", g.shape[::-1], 0), Image.fromarray(255 - g))
    ),  # black all over, and the paper transparent
    "red-line.png": lambda g: Image.merge(
        "RGB", (Image.new("L", g.shape[::-1], 255), Image.fromarray(g), Image.fromarray(g))
    ),
}


@pytest.mark.parametrize("name", KINDS)
def test_every_kind_of_image_has_its_line_where_it_was_drawn(
    tmp_path: Path, grey: Grey, name: str
) -> None:
    drawing = opened(KINDS[name](grey), tmp_path / name, dpi=DPI)
    off_mm = off_the_line_mm(drawing)
    assert abs(off_mm.mean()) < PEN_MM
    assert off_mm.std() < (
        5 * UM if name.endswith("jpg") else 1 * UM
    )  # the ripple of JPEG, 6 % of a pixel of 85 um
    assert drawing.darkness.dtype == np.float32
    assert drawing.pitch_mm == pytest.approx(MM_PER_INCH / 300, rel=1e-9)


def test_a_1_bit_image_has_its_line_where_it_was_drawn(tmp_path: Path, grey: Grey) -> None:
    image = Image.fromarray(grey).convert("1", dither=Image.Dither.NONE)
    off_mm = off_the_line_mm(opened(image, tmp_path / "bits.tif", dpi=DPI))
    assert (
        abs(off_mm.mean()) < 2 * UM
    )  # both edges are rounded to whole pixels of 85 um: 24 um RMS each, over 330 columns
    assert off_mm.std() < 0.3 * 85 * UM  # the mean of two edges, 1/sqrt(12) of a pixel each


def test_ink_is_one_and_paper_nothing(tmp_path: Path, grey: Grey) -> None:
    drawing = opened(Image.fromarray(grey), tmp_path / "a.png", dpi=DPI)
    assert np.percentile(drawing.darkness, 50) == pytest.approx(0, abs=0.01)
    assert drawing.darkness.max() == pytest.approx(
        1, abs=0.1
    )  # a narrow line's ink is soft; its darker part counts


def test_the_sheet_is_as_large_as_its_pixels(tmp_path: Path, grey: Grey) -> None:
    drawing = opened(Image.fromarray(grey), tmp_path / "a.png", dpi=DPI)
    assert drawing.width_mm == pytest.approx(grey.shape[1] * MM_PER_INCH / 300)
    assert drawing.height_mm == pytest.approx(grey.shape[0] * MM_PER_INCH / 300)


# paper and ink


def test_light_on_dark_is_found_out(tmp_path: Path, grey: Grey) -> None:
    """A blueprint."""
    drawing = opened(Image.fromarray(255 - grey), tmp_path / "blue.png", dpi=DPI)
    as_usual = opened(Image.fromarray(grey), tmp_path / "a.png", dpi=DPI)
    assert np.abs(drawing.darkness - as_usual.darkness).max() < 1 / 215  # a grey level
    assert (LIGHT_LINES in drawing.notes, LIGHT_LINES in as_usual.notes) == (True, False)


def test_uneven_paper_is_levelled(tmp_path: Path, grey: Grey) -> None:
    """The lamp's light falls off to a half towards one side; the ink stays as dark, relative to the paper
    there.
    """
    light = np.linspace(1.0, 0.5, grey.shape[1])[None, :]
    drawing = opened(
        Image.fromarray(np.round(grey * light).astype(np.uint8)), tmp_path / "a.png", dpi=DPI
    )
    assert np.abs(off_the_line_mm(drawing)).max() < 3 * UM
    assert (
        np.abs(np.median(drawing.darkness, axis=0)).max() < 0.1
    )  # paper that falls by 0.08 in 6 mm
    ridge = drawing.darkness.max(axis=0)[60:-60]  # the ends left out
    assert (
        ridge.min() > 0.7 and ridge.max() < 1.4
    )  # the contrast is that of the light, 1 to 0.5, about 1 in the middle


@pytest.mark.parametrize("level", [255, 0, 128])
def test_a_blank_sheet_holds_no_line(tmp_path: Path, level: int) -> None:
    with pytest.raises(DrawingFault, match=r"no line on the drawing: .*; check the file"):
        opened(
            Image.fromarray(np.full((400, 600), level, np.uint8)), tmp_path / "a.png", dpi=DPI
        )


def test_dirt_is_no_line(tmp_path: Path) -> None:
    """Paper with a scanner's noise and specks shorter than a line."""
    random = np.random.default_rng(7)
    sheet = 235 + random.normal(0, 8, (500, 700))
    for row, column in random.integers(10, 480, (60, 2)):
        sheet[row : row + 6, column : column + 6] = 60
    with pytest.raises(DrawingFault, match="no line on the drawing"):
        opened(
            Image.fromarray(np.clip(sheet, 0, 255).astype(np.uint8)),
            tmp_path / "a.png",
            dpi=DPI,
        )


# files


@pytest.mark.filterwarnings(
    "ignore::pytest.PytestUnraisableExceptionWarning"
)  # Pillow leaves a damaged file open
@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_what_is_no_image_is_told(tmp_path: Path, grey: Grey) -> None:
    (tmp_path / "words.png").write_text("these are words")
    with pytest.raises(
        DrawingFault, match=r"words\.png is not an image .* give a PNG, JPEG or TIFF"
    ):
        Drawing.open(tmp_path / "words.png")
    Image.fromarray(grey).save(tmp_path / "whole.png", dpi=DPI)
    (tmp_path / "cut.png").write_bytes((tmp_path / "whole.png").read_bytes()[:700])
    with pytest.raises(
        DrawingFault, match=r"cut\.png is a damaged image .* scan or save it again"
    ):
        Drawing.open(tmp_path / "cut.png")


def test_a_file_that_is_not_there_or_cannot_be_read_is_told(tmp_path: Path) -> None:
    with pytest.raises(FileFault, match="does not exist"):
        Drawing.open(tmp_path / "missing.png")
    with pytest.raises(FileFault, match="cannot read"):
        Drawing.open(tmp_path)


@pytest.mark.parametrize(("period_px", "ink_px"), [(16, 8), (5, 2)])
def test_a_pattern_that_is_all_over_the_sheet_is_told(
    tmp_path: Path, period_px: int, ink_px: int
) -> None:
    """It was told as "580 or more of 255 grey levels", and "scan it with more contrast": black on white."""
    y, x = np.mgrid[:400, :400]
    hatched = np.where((x + y) % period_px < ink_px, 0, 255).astype(np.uint8)
    Image.fromarray(hatched).save(tmp_path / "hatched.png", dpi=DPI)
    with pytest.raises(
        DrawingFault, match="vary everywhere, as in noise, hatching or a pattern"
    ):
        Drawing.open(tmp_path / "hatched.png")


def test_bold_lines_that_take_half_of_the_picture_are_no_pattern(tmp_path: Path) -> None:
    """Squares within squares, 5 mm broad and 6 mm apart: their levels differ, those of neighbours do not."""
    y, x = np.abs(np.mgrid[-256:256, -256:256])
    away_px = np.maximum(x, y)
    bold = np.where((away_px % 44 < 20) & (away_px < 245), 0, 255).astype(np.uint8)
    Image.fromarray(bold).save(tmp_path / "bold.png", dpi=(100, 100))
    widths_mm = Drawing.open(tmp_path / "bold.png").sheet.widths_mm
    assert np.abs(widths_mm[:5] - 20 * MM_PER_INCH / 100).max() < 0.05  # a fifth of a pixel


def test_a_tiff_whose_next_page_has_no_size_is_damaged(tmp_path: Path) -> None:
    """Pillow ends with a TypeError."""
    file = tmp_path / "a.tif"
    Image.fromarray(np.full((40, 60), 255, np.uint8)).save(file, dpi=DPI)
    whole = file.read_bytes()
    next_at = 10 + 12 * int.from_bytes(whole[8:10], "little")  # behind all entries of the page
    pointer = len(whole).to_bytes(4, "little")  # to a page of no entry
    file.write_bytes(whole[:next_at] + pointer + whole[next_at + 4 :] + bytes(6))
    with pytest.raises(DrawingFault, match=r"is a damaged image \(.*\); scan or save it again"):
        Drawing.open(file)
