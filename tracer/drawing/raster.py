"""Raster: a page of a picture or a PDF becomes a Scan: grey levels, or colours, and what the file states.

Signals in: a picture that Pillow reads (PNG, JPEG, TIFF, WebP, AVIF, HEIC, …), or a PDF. Signals out: levels
0..255 (float32 beyond 8 bits), or colours, of one page, upright, rows from the top; the stated resolution in
dots per inch, and whether it is to be believed; the camera.

Questions: which of several pages is meant is not known; without --page it is the first, and the Scan says so.
Formats that a camera adds previews to (MPO) have one page.
"""

from __future__ import annotations

import struct
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from morfax.motion.faults import DrawingFault, Fault, FileFault
from morfax.motion.files import HEAD_BYTES, check_regular
from morfax.tracer.drawing import by_rows, exif, large
from morfax.tracer.drawing import memory as room
from morfax.tracer.drawing.coloured_paper import levels_on_white
from morfax.tracer.drawing.components import strips
from morfax.tracer.drawing.exif import ORIENTATION
from morfax.tracer.drawing.scan import (
    Camera,
    Grey,
    Scan,
    Stated,
    darkest,
    page_asked_for,
    page_notes,
)
from morfax.tracer.effort import FEW_PX

if TYPE_CHECKING:
    from PIL.Image import Image


PDF, HEIF_BRANDS = (
    b"%PDF-",
    (b"heic", b"heix", b"hevc", b"hevx", b"heim", b"heis", b"mif1", b"msf1"),
)
DRAWN_LINES = (".dxf", ".svg", ".plt", ".hpgl")  # drawings from CAD
PREVIEWS = ("MPO",)  # formats whose further pictures are no pages: a camera's previews
COLOURED = ("RGB", "YCbCr", "CMYK")  # modes in which the paper may have a colour
TURNED = (5, 6, 7, 8)  # orientations of Exif that put columns in the place of rows

# what Pillow meets in damaged files: a TIFF without its size ends in a TypeError
DAMAGE = (
    OSError,
    SyntaxError,
    ValueError,
    LookupError,
    TypeError,
    ArithmeticError,
    struct.error,
)


def read(
    file: Path, *, coloured: bool, page: int | None = None, dpi: float | None = None
) -> Scan:
    """A page of a picture or a PDF, the first without a number; raises DrawingFault, FileFault.

    Drawn lines of a PDF are rendered at `dpi`; a picture has its own pixels.
    """
    from PIL import UnidentifiedImageError

    check_regular(file)
    try:
        with warnings.catch_warnings(), file.open("rb") as stream:
            warnings.simplefilter("ignore")
            head = stream.read(HEAD_BYTES)
            stream.seek(0)
            if PDF in head:
                from morfax.tracer.drawing import pdf

                return pdf.read(file, stream, coloured=coloured, page=page, dpi=dpi)
            if head[4:8] == b"ftyp" and head[8:12] in HEIF_BRANDS:
                from pillow_heif import register_heif_opener

                register_heif_opener()
            return _picture(file, stream, coloured, page)
    except DrawingFault:
        raise
    except UnidentifiedImageError:
        raise _no_picture(file) from None
    except (MemoryError, *DAMAGE) as error:
        raise _unreadable(file, error) from None


def _no_picture(file: Path) -> DrawingFault:
    """The fault of a file that is no picture."""
    if file.suffix.lower() in DRAWN_LINES:
        return DrawingFault(
            f"{file} already holds lines, so there is nothing to trace; give it to morfax record"
        )
    return DrawingFault(
        f"{file} is not an image that can be read; give a PNG, JPEG or TIFF file"
    )


def _unreadable(file: Path, error: Exception) -> Fault:
    """The fault of a picture that could not be read."""
    if isinstance(error, FileNotFoundError):
        return FileFault(f"{file} does not exist; check the name")
    if isinstance(error, MemoryError):
        return DrawingFault(
            f"{file} is too large for the memory of this computer; scan it at a lower resolution"
        )
    if isinstance(error, OSError) and error.errno is not None:
        return FileFault(
            f"cannot read {file}: {error.strerror}; check the file and who may read it"
        )
    return DrawingFault(f"{file} is a damaged image ({error}); scan or save it again")


def _picture(file: Path, stream: BinaryIO, coloured: bool, page: int | None) -> Scan:
    """A page of a picture that Pillow reads."""
    from PIL import Image, ImageOps

    Image.MAX_IMAGE_PIXELS = None  # a large sheet is no attack; a lack of memory is said
    # by a stream, which is never mapped: Pillow turns maps wrongly
    with Image.open(stream) as image:
        pages = 1 if image.format in PREVIEWS else getattr(image, "n_frames", 1)
        taken = image.tell() + 1 if page is None else page_asked_for(file, page, pages)
        if taken - 1 != image.tell():
            image.info.pop("dpi", None)  # of the page before
            image.seek(taken - 1)
        is_large = image.width * image.height >= large.LARGE_PX
        parts = by_rows.rows_of(image, stream) if is_large and not coloured else None
        pixels: Any = parts
        if parts is None:
            room.make_sure(file, *image.size)
            pixels = None if coloured else by_rows.bytes_of(image, stream)
        if pixels is None:
            image.load()
        camera = exif.camera(image.getexif())
        stated = _stated(image, camera)
        if pixels is None:
            ImageOps.exif_transpose(image, in_place=True)
            pixels = np.array(image.convert("RGB")) if coloured else _grey(image)
    notes = page_notes(file, taken, pages) if page is None else ()
    if is_large and parts is None:
        notes = (*notes, _held_note(file, pixels.shape))
    return Scan(file, pixels, stated, camera, taken, pages, notes)


def _held_note(file: Path, shape: tuple[int, ...]) -> str:
    """What the operator should know of a large picture that is held in memory."""
    return (
        f"{file.name} has {shape[0] * shape[1] / 1e6:.0f} million pixels and cannot be read by rows; a grey"
        " PNG (not interlaced) or a TIFF of strips or tiles takes a tenth of the memory"
    )


def _stated(image: Image, camera: Camera | None) -> Stated | None:
    """The resolution that the file states, of the picture upright."""
    tags = image.getexif()
    dpi = image.info.get("dpi") if _is_own(image) else exif.resolution_dpi(tags)
    if dpi is None:
        return None
    x, y = (float(v) for v in dpi)
    if not (np.isfinite(x) and np.isfinite(y) and x > 1 and y > 1):
        return None
    if tags.get(ORIENTATION) in TURNED:
        x, y = y, x
    return Stated.of(x, y, camera)


def _is_own(image: Image) -> bool:
    """Whether Pillow has the file's resolution: for a JPEG with Exif that states none Pillow has 72 dpi."""
    by_jfif = image.info.get("jfif_unit", 0) in (1, 2)
    return "dpi" in image.info and (image.format != "JPEG" or by_jfif)


def _grey(image: Image) -> Grey:
    """Grey levels 0..255 of an image of any mode: its darkest channel, so that coloured lines are dark."""
    if image.mode == "L":
        return np.array(image)
    columns, rows = image.size
    deep = image.mode in ("I;16", "I;16B", "I;16L", "I", "F")
    grey = np.empty((rows, columns), np.float32 if deep else np.uint8)
    levels = levels_on_white(image) if image.mode in COLOURED else None
    for top, bottom, _ in strips(grey.shape, pixels=FEW_PX):
        # a strip's memory is that of the strip before
        strip = image.crop((0, top, columns, bottom))
        grey[top:bottom] = np.asarray(strip) if deep else _darkest_channel(strip, levels)
    if deep:
        np.multiply(grey, 255 / _white(image.mode, float(grey.max())), out=grey)
    return grey


def _white(mode: str, lightest: float) -> float:
    """The level that stands for white in a picture of 16 bits, or of whole or broken numbers."""
    if mode == "I;16" or lightest > 255:
        return float(np.iinfo(np.uint16).max)
    return 1.0 if mode == "F" and lightest <= 1 else 255.0


def _darkest_channel(image: Image, levels: list[int] | None) -> NDArray[np.uint8]:
    """The darkest colour channel of an image of eight bits or fewer, on white where it is transparent; of
    coloured paper with other levels (see `coloured_paper`).
    """
    if image.mode == "1":
        return np.asarray(image.convert("L"))
    if image.mode in ("LA", "PA", "RGBA", "La", "RGBa") or "transparency" in image.info:
        from PIL import Image as Images

        rgba = image.convert("RGBA")
        image = Images.alpha_composite(Images.new("RGBA", rgba.size, "white"), rgba)
    colours = image.convert("RGB")
    return darkest(np.asarray(colours if levels is None else colours.point(levels)))
