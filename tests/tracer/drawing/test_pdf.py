"""PDF: the size is the page's; a scanned page keeps its pixels, lines are rendered as finely as asked."""

from __future__ import annotations

import io
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pypdfium2 as pdfium
import pytest
from numpy.typing import NDArray
from PIL import Image

from morfax.motion.faults import DrawingFault
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing import raster
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan
from tests.tracer.inked import UM

A4_MM = (210.0, 297.0)
PT_MM = MM_PER_INCH / 72


def written(
    file: Path, content: str, size_mm: tuple[float, float] = A4_MM, more: str = ""
) -> Path:
    """A PDF of one page with some lines, in a user space of mm."""
    width, height = (mm / PT_MM for mm in size_mm)
    body = f"{1 / PT_MM:.9f} 0 0 {1 / PT_MM:.9f} 0 0 cm {content}"
    things = [
        "<</Type/Catalog/Pages 2 0 R>>",
        "<</Type/Pages/Kids[3 0 R]/Count 1>>",
        f"<</Type/Page/Parent 2 0 R/MediaBox[0 0 {width:.6f} {height:.6f}]/Contents 4 0 R {more}>>",
        f"<</Length {len(body)}>>stream\n{body}\nendstream",
    ]
    text, places = "%PDF-1.7\n", []
    for number, thing in enumerate(things, 1):
        places.append(len(text))
        text += f"{number} 0 obj\n{thing}\nendobj\n"
    table = "".join(f"{place:010d} 00000 n \n" for place in places)
    text += f"xref\n0 5\n0000000000 65535 f \n{table}trailer\n<</Size 5/Root 1 0 R>>\n"
    file.write_text(f"{text}startxref\n{text.index('xref')}\n%%EOF\n")
    return file


def opened(file: Path, **how: object) -> Scan:
    """A page of a file."""
    return raster.read(file, coloured=False, **how)  # type: ignore[arg-type]


def centre_mm(scan: Scan, axis: int) -> float:
    """Where the middle of the ink is across an axis, mm from the lower left."""
    assert scan.stated is not None
    ink = (255.0 - scan.pixels).sum(axis=1 - axis)
    places = (np.arange(len(ink)) + 0.5) * MM_PER_INCH / scan.stated.dpi[1 - axis]
    middle = float((ink * places).sum() / ink.sum())
    return middle if axis else scan.rows * MM_PER_INCH / scan.stated.dpi[1] - middle


def noise(columns: int = 500, rows: int = 700) -> Image.Image:
    """A picture in which every pixel counts."""
    levels = np.random.default_rng(3).integers(0, 256, (rows, columns))
    return Image.fromarray(levels.astype(np.uint8))


def laid(
    file: Path,
    picture: Image.Image,
    page_pt: tuple[float, float],
    matrix: tuple[float, ...],
    **how: Any,
) -> NDArray[np.uint8]:
    """A PDF of one page with a picture laid on it; the picture's levels as its JPEG has them."""
    jpeg = io.BytesIO()
    picture.save(jpeg, "JPEG", **how)
    document = pdfium.PdfDocument.new()
    page = document.new_page(*page_pt)
    thing = pdfium.PdfImage.new(document)
    thing.load_jpeg(io.BytesIO(jpeg.getvalue()), inline=True)
    thing.set_matrix(pdfium.PdfMatrix(*matrix))
    page.insert_obj(thing)
    page.gen_content()
    document.save(file)
    return np.asarray(Image.open(jpeg))


# drawn lines


@pytest.mark.parametrize("dpi", [None, 300.0, 1200.0])
def test_drawn_lines_are_where_the_page_has_them(tmp_path: Path, dpi: float | None) -> None:
    size_mm = (60.3, 50.7)  # no whole pixels
    upright = written(tmp_path / "x.pdf", "0.5 w 45 10 m 45 40 l S", size_mm)
    scan = opened(upright, dpi=dpi)
    assert scan.stated == ((dpi or 600.0,) * 2, None)
    pixel_mm = MM_PER_INCH / (dpi or 600.0)
    assert scan.columns * pixel_mm == pytest.approx(60.3, abs=pixel_mm)
    # a hundredth of a pixel at 300 dpi
    assert centre_mm(scan, 1) == pytest.approx(45, abs=1 * UM)
    # the page's upper edge is the first row's; below the last whole pixel a part of one is added
    level = opened(written(tmp_path / "y.pdf", "0.5 w 10 30 m 50 30 l S", size_mm), dpi=dpi)
    assert level.rows * pixel_mm - centre_mm(level, 0) == pytest.approx(20.7, abs=1 * UM)


@pytest.mark.parametrize("dpi", [300.0, 600.0, 1800.0])
@pytest.mark.parametrize("width", ["0 w", "0.01 w", "0.02 0 0 0.02 44.1 0 cm 0.5 w"])
def test_a_hairline_is_three_pixels_wide_at_any_resolution(
    tmp_path: Path, width: str, dpi: float
) -> None:
    """0 is what CAD writes; the last is thin by its own scale. It stays where the page has it."""
    way = "45 500 m 45 2000 l" if "cm" in width else "45 10 m 45 40 l"
    scan = opened(written(tmp_path / "x.pdf", f"{width} {way} S", (60.3, 50.7)), dpi=dpi)
    ink = 1 - scan.pixels[scan.rows // 2] / 255.0
    assert ink.sum() == pytest.approx(3, abs=0.05)  # pixels are rounded to grey levels
    assert centre_mm(scan, 1) == pytest.approx(45, abs=1 * UM)


def test_a_line_of_three_pixels_keeps_its_width(tmp_path: Path) -> None:
    scan = opened(written(tmp_path / "x.pdf", "0.4 w 45 10 m 45 40 l S", (60.3, 50.7)))
    ink = 1 - scan.pixels[scan.rows // 2] / 255.0
    assert ink.sum() * MM_PER_INCH / 600 == pytest.approx(0.4, abs=2 * UM)


def test_a_page_of_lines_needs_no_scale(tmp_path: Path) -> None:
    drawing = Drawing.open(written(tmp_path / "x.pdf", "0.5 w 15 10 m 15 40 l S", (50, 50)))
    assert drawing.pitch_mm == pytest.approx(MM_PER_INCH / 600)
    assert drawing.width_mm == pytest.approx(50, abs=drawing.pitch_mm)
    assert drawing.is_rendered


def test_red_lines_are_dark_and_colours_are_kept(tmp_path: Path) -> None:
    file = written(tmp_path / "x.pdf", "1 0 0 RG 2 w 5 5 m 5 15 l S", (20, 20))
    assert opened(file).pixels.min() == 0
    reds = raster.read(file, coloured=True).pixels.reshape(-1, 3)
    assert (reds == (255, 0, 0)).all(axis=1).any()


@pytest.mark.parametrize("dpi", [0.5, 1e9])
def test_a_resolution_that_no_scan_has_is_refused(tmp_path: Path, dpi: float) -> None:
    file = written(tmp_path / "x.pdf", "1 w 5 5 m 5 15 l S", (20, 20))
    with pytest.raises(
        DrawingFault, match=r"--dpi is .*; it must give pixels of 0.001 to 10 mm"
    ):
        Drawing.open(file, dpi=dpi)


@pytest.mark.parametrize("packed", [False, True])
def test_a_unit_of_the_page_s_own_is_no_scale(tmp_path: Path, packed: bool) -> None:
    """pdfium passes over it: the page would come out too small."""
    file = written(tmp_path / "x.pdf", "1 w 5 5 m 5 15 l S", (20, 20), "/UserUnit 10")
    if packed:
        plain = file.read_bytes().replace(b"/UserUnit 10", b"")
        inside = zlib.compress(b"3 0 <</Type/Page/UserUnit 10.0>>")
        stream = b"9 0 obj<</Type/ObjStm/N 1/First 4/Length %d>>stream\n" % len(inside)
        file.write_bytes(
            plain.replace(b"trailer", stream + inside + b"\nendstream endobj\ntrailer")
        )
    with pytest.raises(
        DrawingFault, match=r"has a unit of its own \(UserUnit\).*--width 120mm"
    ):
        Drawing.open(file)
    one = written(tmp_path / "one.pdf", "1 w 5 5 m 5 15 l S", (20, 20), "/UserUnit 1.0")
    Drawing.open(one)


# scanned pages


@pytest.mark.parametrize("turned", [0, 90, 180, 270])
@pytest.mark.parametrize("mode", ["L", "1"])
def test_a_scanned_page_keeps_its_pixels(tmp_path: Path, mode: str, turned: int) -> None:
    """Drawn on by no other pixels: each is as it was scanned, on a page that is turned as well."""
    scanned = noise().convert(mode)
    scanned.save(tmp_path / "a.pdf", resolution=300)
    document = pdfium.PdfDocument(tmp_path / "a.pdf")
    picture = next(document[0].get_objects())
    told = picture.get_bitmap(render=False).to_numpy()  # what the JPEG in it holds
    document[0].set_rotation(turned)
    document.save(tmp_path / "b.pdf")
    scan = opened(tmp_path / "b.pdf")
    assert scan.stated == ((300, 300), None) and not scan.is_rendered
    assert (scan.pixels == np.rot90(told.reshape(700, 500), -turned // 90)).all()


def test_a_scanned_page_keeps_its_pixels_where_it_leaves_a_margin(tmp_path: Path) -> None:
    """Its corner is 3.3 pixels from the page's: the page is moved, and no pixel is spread over two."""
    margin = (120, 0, 0, 168, 3.3 * 0.24, 4.0)
    told = laid(tmp_path / "a.pdf", noise(), (140.0, 190.0), margin)
    scan = opened(tmp_path / "a.pdf")
    found = scan.pixels[75:775, 4:504].astype(int)
    assert np.abs(found - told).max() <= 3  # two decoders of JPEG, which may round apart
    assert scan.stated == ((300, 300), None)


@pytest.mark.parametrize("matrix", [(0, 168, -120, 0, 120, 0), (0, -168, 120, 0, 0, 168)])
def test_a_scanned_page_keeps_its_pixels_where_it_lies_on_its_side(
    tmp_path: Path, matrix: tuple[float, ...]
) -> None:
    told = laid(tmp_path / "a.pdf", noise(700, 500), (120.0, 168.0), matrix)
    scan = opened(tmp_path / "a.pdf")
    upright = np.rot90(told, 1 if matrix[1] > 0 else -1)
    assert np.abs(scan.pixels.astype(int) - upright).max() <= 3
    assert scan.stated == ((300, 300), None)


def test_a_page_in_whole_points_has_the_scanner_s_resolution(tmp_path: Path) -> None:
    """A4 at 300 dpi on a page of 595 x 842 points: 300.1 and 299.97 dpi by the page."""
    picture = Image.new("L", (2480, 3508), 200)
    laid(tmp_path / "a.pdf", picture, (595.0, 842.0), (595, 0, 0, 842))
    assert opened(tmp_path / "a.pdf").stated == ((300, 300), None)
    laid(tmp_path / "b.pdf", picture, (595.3, 842.2), (595.3, 0, 0, 842.2))
    assert opened(tmp_path / "b.pdf").stated[0] == pytest.approx((299.95, 299.90), abs=0.005)


def test_a_fax_keeps_its_pixels(tmp_path: Path) -> None:
    told = laid(tmp_path / "a.pdf", noise(340, 160), (120.0, 120.0), (120, 0, 0, 120))
    scan = opened(tmp_path / "a.pdf")
    assert scan.stated == ((204, 96), None)
    assert np.abs(scan.pixels.astype(int) - told).max() <= 3


@pytest.mark.parametrize("dpi", [72, 96])
def test_a_scan_at_a_program_s_own_resolution_has_no_scale(tmp_path: Path, dpi: int) -> None:
    """Pillow's own and img2pdf's own."""
    noise().save(tmp_path / "a.pdf", resolution=dpi)
    with pytest.raises(DrawingFault, match=rf"states {dpi} dpi, which is what programs write"):
        Drawing.open(tmp_path / "a.pdf")
    scan = opened(tmp_path / "a.pdf", dpi=dpi)
    assert scan.pixels.shape == (700, 500)
    assert Scale(dpi=dpi).pitches_mm(scan) == (MM_PER_INCH / dpi,) * 2  # the advice works


def test_a_camera_s_picture_on_a_page_has_no_scale(tmp_path: Path) -> None:
    tags = Image.Exif()
    tags.get_ifd(0x8769)[0x920A] = 4.25
    laid(tmp_path / "a.pdf", noise(), (120.0, 168.0), (120, 0, 0, 168), exif=tags)
    assert opened(tmp_path / "a.pdf").camera == (None, None, None)
    with pytest.raises(DrawingFault, match=r"states 300 dpi, but a camera took it"):
        Drawing.open(tmp_path / "a.pdf")


# pages, and what cannot be read


def test_pages(tmp_path: Path) -> None:
    first, second = noise(), noise(300, 200)
    first.save(tmp_path / "a.pdf", resolution=300, save_all=True, append_images=[second])
    scan = opened(tmp_path / "a.pdf")
    assert scan.notes == (
        f"{tmp_path / 'a.pdf'} has 2 pages; page 1 is taken; for another one give --page",
    )
    assert opened(tmp_path / "a.pdf", page=2).pixels.shape == (200, 300)
    with pytest.raises(DrawingFault, match="has no page 3; it has pages 1 to 2"):
        opened(tmp_path / "a.pdf", page=3)


# a password that nobody knows
LOCKED = "<</Filter/Standard/V 1/R 2/P -4/O<" + "28" * 32 + ">/U<" + "41" * 32 + ">>>"


def test_a_locked_page_is_refused(tmp_path: Path) -> None:
    file = written(tmp_path / "a.pdf", "1 w 5 5 m 5 15 l S", (20, 20))
    text = file.read_text().replace(
        "/Root 1 0 R", f"/Root 1 0 R/Encrypt {LOCKED}/ID[<{'00' * 16}><{'00' * 16}>]"
    )
    file.write_text(text)
    with pytest.raises(DrawingFault, match="is locked with a password; save it without one"):
        opened(file)


@pytest.mark.parametrize("kept", [5, 40, 120])
def test_a_damaged_file_is_refused(tmp_path: Path, kept: int) -> None:
    whole = written(tmp_path / "a.pdf", "1 w 5 5 m 5 15 l S", (20, 20)).read_bytes()
    (tmp_path / "b.pdf").write_bytes(whole[:kept])
    with pytest.raises(DrawingFault, match=r"b\.pdf is a damaged PDF; save it again"):
        opened(tmp_path / "b.pdf")


def test_a_page_too_large_for_the_memory_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("morfax.tracer.drawing.memory.free_bytes", lambda: 10**8)
    file = written(tmp_path / "a.pdf", "1 w 5 5 m 5 15 l S")
    with pytest.raises(DrawingFault, match="give a lower resolution with --dpi"):
        opened(file)
