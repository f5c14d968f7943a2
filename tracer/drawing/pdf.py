"""PDF: a page becomes a Scan, in the size that the page states.

Signals in: a PDF. Signals out: a Scan of one page, on white paper, upright; its resolution is that of the
page, so that no scale need be given.

A page that shows pictures, maybe words, and no drawn lines is a scan: it is rendered on the pixels of its
finest picture, so that every pixel stays as it was scanned. Drawn lines are rendered at 600 dpi, or as asked,
and `hairlines` three pixels wide:

    X, Y of the page, 1/72 inch  ->  columns, rows:  (X, Y) · dpi / 72, moved so that the picture's corner is
                                                     a pixel's corner

Source: ISO 32000-1 (PDF 1.7), 8.3 coordinates, 8.9.5 images, 7.5.7 object streams. Questions: a scan at 72 or
96 dpi was given these by a program that knew no scale, and is doubted as in other files. A unit of the user's
own (table 30, UserUnit) is not told by pdfium; a file with one is doubted. Of a scan in several strips only
the pixels of the finest strip stay; the others are spread over up to a pixel more.
"""

from __future__ import annotations

import io
import math
import re
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO
from morfax.motion.faults import DrawingFault
from morfax.motion.units import MM_PER_INCH, POINTS_PER_INCH
from morfax.tracer.drawing import exif, hairlines
from morfax.tracer.drawing import memory as room
from morfax.tracer.drawing.coarse import DPI_STEP
from morfax.tracer.drawing.components import strips
from morfax.tracer.drawing.scale import LARGEST_PITCH_MM, LEAST_PITCH_MM
from morfax.tracer.drawing.scan import (
    Camera,
    Scan,
    Stated,
    darkest,
    page_asked_for,
    page_notes,
)

if TYPE_CHECKING:
    from pypdfium2 import PdfDocument, PdfImage, PdfPage

LINES_DPI = 600.0  # drawn lines: a pen of 0.13 mm, the finest of ISO 128, is three pixels wide
# of a scanned page, chosen: a coarser picture is a colour spread over the page, a finer one an ornament
COARSEST_DPI, FINEST_DPI = 50.0, 4800.0
ASKEW = 1e-4  # slope of a picture on its page; at less it is off its pixels by less than a pixel of 10 000
ROUNDING_PX = 1e-2  # pdfium's figures have 24 bits: 5e-4 pixel of 10 000, and twenty times that
LONGEST_PACKED = 1 << 24  # bytes of an object stream that are looked through
USER_UNIT = re.compile(rb"/UserUnit\s+(\d+\.?\d*|\.\d+)")
PACKED = re.compile(rb"/ObjStm.{0,400}?stream\r?\n(.*?)endstream", re.DOTALL)
OWN_UNIT = "but the file has a unit of its own (UserUnit), which is not read"


class _Axis(NamedTuple):
    """The pixels of a page along X or Y: how many per point, and the picture whose pixels they are."""

    per_pt: float
    begin_pt: float = 0.0  # of the picture, from the page's edge
    length_px: int = 0  # of the picture; 0: there is none

    @property
    def shift_px(self) -> float:
        """How far the page is moved, so that the picture begins where a pixel does."""
        begin_px = self.begin_pt * self.per_pt
        return max(0.0, math.ceil(begin_px - ROUNDING_PX) - begin_px)

    def pixels(self, length_pt: float) -> int:
        """How many pixels a page of this length has."""
        return max(1, math.ceil(length_pt * self.per_pt + self.shift_px - ROUNDING_PX))

    def rounded_dpi(self) -> float | None:
        """The scanner's resolution if the picture's length looks like it in whole points; None if not."""
        dpi = DPI_STEP * round(self.per_pt * POINTS_PER_INCH / DPI_STEP)
        length_pt = self.length_px / self.per_pt
        is_whole = abs(length_pt - round(length_pt)) < ROUNDING_PX
        if not dpi or not is_whole:
            return None
        meant_pt = self.length_px / dpi * POINTS_PER_INCH
        return float(dpi) if abs(meant_pt - length_pt) <= 0.5 + ROUNDING_PX else None

    def moved(self) -> tuple[float, float]:
        """What pdfium is told: pixels per point, and pixels that the page is moved by.

        pdfium spreads a picture over every pixel that it touches, so that it is drawn in by a hundredth.
        """
        if not self.length_px:
            return self.per_pt, self.shift_px
        drawn_in = self.per_pt * (1 - 2 * ROUNDING_PX / self.length_px)
        begin_px = self.begin_pt * self.per_pt + self.shift_px + ROUNDING_PX
        return drawn_in, begin_px - self.begin_pt * drawn_in


class _Grid(NamedTuple):
    """The pixels of a page."""

    x: _Axis
    y: _Axis

    @property
    def dpi(self) -> tuple[float, float]:
        """Pixels per inch in X and Y."""
        return self.x.per_pt * POINTS_PER_INCH, self.y.per_pt * POINTS_PER_INCH

    def scanned_dpi(self) -> tuple[float, float]:
        """Pixels per inch in X and Y as they were scanned: pages are often rounded to whole points."""
        x_dpi, y_dpi = self.x.rounded_dpi(), self.y.rounded_dpi()
        return (x_dpi, y_dpi) if x_dpi and y_dpi else self.dpi


def read(
    file: Path,
    stream: BinaryIO,
    *,
    coloured: bool,
    page: int | None = None,
    dpi: float | None = None,
) -> Scan:
    """A page of a PDF; raises DrawingFault for one that is locked or damaged."""
    import pypdfium2 as pdfium

    content = stream.read()
    document: PdfDocument | None = None
    try:
        document = pdfium.PdfDocument(content)
        pages = len(document)
        taken = page_asked_for(file, page, pages)
        sheet = document[taken - 1]
        pictures = _pictures(sheet)
        grid = _grid_of_scan(sheet, pictures)
        is_scan = grid is not None
        if grid is None:
            grid = _grid_of_lines(dpi)
            hairlines.widen(sheet, grid.x.per_pt)
        camera = _camera(pictures) if is_scan else None
        pixels = _rendered(file, sheet, grid, coloured)
    except pdfium.PdfiumError as error:
        raise DrawingFault(f"{file} {_why(error)}") from None
    finally:
        if document is not None:
            document.close()
    stated = Stated.of(*grid.scanned_dpi(), camera) if is_scan else Stated(grid.dpi)
    if _has_own_unit(content):
        stated = Stated(stated.dpi, OWN_UNIT)
    notes = page_notes(file, taken, pages) if page is None else ()
    return Scan(file, pixels, stated, camera, taken, pages, notes, not is_scan)


def _why(error: Any) -> str:
    """Why a PDF cannot be read."""
    import pypdfium2.raw as pdfium

    if error.err_code == pdfium.FPDF_ERR_PASSWORD:
        return "is locked with a password; save it without one"
    if error.err_code == pdfium.FPDF_ERR_SECURITY:
        return "is locked in a way that cannot be read; save it without protection"
    return "is a damaged PDF; save it again"


def _pictures(page: PdfPage) -> list[PdfImage]:
    """The pictures of a page that shows nothing else but words; none if lines are drawn on it."""
    import pypdfium2.raw as pdfium

    pictures = []
    for thing in page.get_objects():
        if thing.type == pdfium.FPDF_PAGEOBJ_IMAGE:
            pictures.append(thing)
        elif thing.type in (pdfium.FPDF_PAGEOBJ_PATH, pdfium.FPDF_PAGEOBJ_SHADING):
            return []
    return pictures


def _grid_of_lines(dpi: float | None) -> _Grid:
    """The pixels of a page of drawn lines; a resolution that no scan has is left for the scale to refuse."""
    if (
        dpi is None
        or not LEAST_PITCH_MM <= MM_PER_INCH / max(dpi, NOT_ZERO) <= LARGEST_PITCH_MM
    ):
        dpi = LINES_DPI
    return _Grid(*(_Axis(dpi / POINTS_PER_INCH),) * 2)


def _grid_of_scan(page: PdfPage, pictures: list[PdfImage]) -> _Grid | None:
    """The pixels of the finest picture of a page, None if there is none, or none that a scanner makes."""
    grids = [_grid_of(page, picture) for picture in pictures]
    finest = max(grids, key=lambda grid: math.prod(grid.dpi), default=None)
    if finest is None or not COARSEST_DPI <= math.sqrt(math.prod(finest.dpi)) <= FINEST_DPI:
        return None
    return finest


def _grid_of(page: PdfPage, picture: PdfImage) -> _Grid:
    """The pixels of a picture as they lie on the page."""
    corner, right, up = (
        _shown(page, _on_page(picture, *at)) for at in ((0, 0), (1, 0), (0, 1))
    )
    columns, rows = picture.get_px_size()
    across, along = right - corner, up - corner
    if abs(across.real) < abs(across.imag):  # it lies on its side
        across, along, columns, rows = along, across, rows, columns
    wide_pt, high_pt = max(abs(across), NOT_ZERO), max(abs(along), NOT_ZERO)
    if abs(across.imag) > ASKEW * wide_pt or abs(along.real) > ASKEW * high_pt:
        return _Grid(*(_Axis(max(columns / wide_pt, rows / high_pt)),) * 2)
    left_pt = min(corner.real, (corner + across).real)
    top_pt = min(corner.imag, (corner + along).imag)
    return _Grid(
        _Axis(columns / wide_pt, left_pt, columns), _Axis(rows / high_pt, top_pt, rows)
    )


def _on_page(picture: PdfImage, across: float, up: float) -> tuple[float, float]:
    """Where a place of a picture, in shares of its width and height, is on the page, points."""
    matrix, form = picture.get_matrix(), picture.container
    while form is not None:
        matrix, form = matrix.multiply(form.get_matrix()), form.container
    x, y = matrix.on_point(across, up)
    return float(x), float(y)


def _shown(page: PdfPage, place: tuple[float, float]) -> complex:
    """Where a place of the page is as the page is shown: points from the upper left corner, Y down."""
    (left, bottom, right, top), (x, y) = page.get_bbox(), place
    turned = {
        0: (x - left, top - y),
        90: (y - bottom, x - left),
        180: (right - x, y - bottom),
        270: (top - y, right - x),
    }
    return complex(*turned[page.get_rotation()])


def _rendered(file: Path, page: PdfPage, grid: _Grid, coloured: bool) -> NDArray[np.uint8]:
    """The pixels of a page: its darkest colour channel, or its colours."""
    import pypdfium2 as pdfium
    import pypdfium2.raw as raw

    wide_pt, high_pt = page.get_size()
    columns, rows = grid.x.pixels(wide_pt), grid.y.pixels(high_pt)
    (x_per_pt, x_px), (y_per_pt, y_px) = grid.x.moved(), grid.y.moved()
    room.make_sure(file, columns, rows, "give a lower resolution with --dpi")
    shape = (rows, columns, 3) if coloured else (rows, columns)
    pixels = np.empty(shape, np.uint8)
    for top, bottom, _ in strips(shape):
        strip = pdfium.PdfBitmap.new_native(columns, bottom - top, raw.FPDFBitmap_BGR)
        strip.fill_rect((255, 255, 255, 255), 0, 0, columns, bottom - top)
        moved = raw.FS_MATRIX(x_per_pt, 0, 0, y_per_pt, x_px, y_px - top)
        whole = raw.FS_RECTF(0, 0, columns, bottom - top)
        flags = raw.FPDF_ANNOT | raw.FPDF_REVERSE_BYTE_ORDER
        raw.FPDF_RenderPageBitmapWithMatrix(strip, page, moved, whole, flags)
        colours = strip.to_numpy()
        pixels[top:bottom] = colours if coloured else darkest(colours)
    return pixels


def _camera(pictures: list[PdfImage]) -> Camera | None:
    """The camera that made one of the pictures, if one did."""
    from PIL import Image

    for picture in pictures:
        if "DCTDecode" in picture.get_filters():
            try:
                jpeg = io.BytesIO(bytes(picture.get_data(decode_simple=True)))
                with Image.open(jpeg) as image:
                    camera = exif.camera(image.getexif())
            except (OSError, SyntaxError, ValueError):
                continue  # what pdfium can draw need not be a whole JPEG file
            if camera is not None:
                return camera
    return None


def _has_own_unit(content: bytes) -> bool:
    """Whether a page of the file has another unit than 1/72 inch."""
    packed = []
    for found in PACKED.finditer(content):
        try:
            packed.append(zlib.decompressobj().decompress(found[1], LONGEST_PACKED))
        except zlib.error:
            continue  # packed in another way, or locked
    units = (unit[1] for text in (content, *packed) for unit in USER_UNIT.finditer(text))
    return any(float(unit) != 1 for unit in units)
