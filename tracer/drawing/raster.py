"""Raster: a page of an image file becomes a Scan: grey levels, or colours, and what the file states.

Signals in: an image file that Pillow reads. Signals out: levels 0..255 (float32 beyond 8 bits), or colours,
of one page, upright, rows from the top; the stated resolution in dots per inch, and whether it is to be
believed; the camera.

Source: Exif 2.32 (tags of cameras). Questions: 72 and 96 dpi, which programs write when they know no scale,
and whatever a camera states are no scale (see `scale`).
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from morfax.motion.faults import DrawingFault, FileFault
from morfax.tracer.drawing import memory as room
from morfax.tracer.drawing.components import strips
from morfax.tracer.drawing.scan import MM_PER_INCH, Camera, Grey, Scan, Stated

if TYPE_CHECKING:
    from PIL.Image import Exif, Image

__all__ = ["MM_PER_INCH", "read"]

# what programs write into a file when they know no resolution: screens' dots, and Pillow's and Exif's default
PLACEHOLDERS_DPI = (72.0, 96.0)
# Exif tags that only a camera writes (a scanner has a maker and a model, too): exposure time, aperture, focal
# length, in the directory of Exif; further tags, and that of the resolution in X
EXIF_IFD, CAMERA_TAGS, X_RESOLUTION = 0x8769, (0x829A, 0x829D, 0x920A), 0x11A
MAKE, MODEL, FOCAL_MM, FOCAL_35MM = 0x10F, 0x110, 0x920A, 0xA405
ROUNDED_DPI = 0.02  # a file that states dots per metre is off a whole number of dpi by no more
PREVIEWS = ("MPO",)  # formats whose further pictures are no pages: a camera's previews


def read(file: Path, *, coloured: bool, page: int | None = None) -> Scan:
    """A page of an image file, the first without a number; raises DrawingFault, FileFault."""
    from PIL import Image, ImageOps, UnidentifiedImageError

    Image.MAX_IMAGE_PIXELS = None  # a large sheet is no attack; a lack of memory is said below
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            # by a stream, which is never mapped: Pillow turns maps wrongly
            with file.open("rb") as stream, Image.open(stream) as image:
                pages = _turned_to(file, image, page)
                room.make_sure(file, *image.size)
                image.load()
                camera = _camera(image.getexif())
                stated = _stated(image, camera)
                ImageOps.exif_transpose(image, in_place=True)
                pixels = np.array(image.convert("RGB")) if coloured else _grey(image)
                number = image.tell() + 1
    except UnidentifiedImageError:
        raise DrawingFault(
            f"{file} is not an image that can be read; give a PNG, JPEG or TIFF file"
        ) from None
    except FileNotFoundError:
        raise FileFault(f"{file} does not exist; check the name") from None
    except MemoryError:
        raise DrawingFault(
            f"{file} is too large for the memory of this computer; scan it at a lower resolution"
        ) from None
    except DrawingFault:
        raise
    except (OSError, SyntaxError, ValueError) as error:
        if isinstance(error, OSError) and error.errno is not None:
            raise FileFault(f"{file} cannot be read: {error.strerror}") from None
        raise DrawingFault(
            f"{file} is a damaged image ({error}); scan or save it again"
        ) from None
    notes = page_notes(file, number, pages) if page is None else ()
    return Scan(file, pixels, stated, camera, number, pages, notes)


def page_notes(file: Path, page: int, pages: int) -> tuple[str, ...]:
    """What the operator should know of a file of several pages."""
    if pages == 1:
        return ()
    return (f"{file} has {pages} pages; page {page} is taken; for another one give --page",)


def check_page(file: Path, page: int, pages: int) -> None:
    """Raise DrawingFault for a page that the file does not have."""
    if not 1 <= page <= pages:
        has = "one page" if pages == 1 else f"pages 1 to {pages}"
        raise DrawingFault(f"{file} has no page {page}; it has {has}; give --page one of them")


def _turned_to(file: Path, image: Image, page: int | None) -> int:
    """Turn to a page, if one is asked for; how many pages there are."""
    pages = 1 if image.format in PREVIEWS else getattr(image, "n_frames", 1)
    if page is not None:
        check_page(file, page, pages)
        if page - 1 != image.tell():
            image.info.pop("dpi", None)  # of the page before
            image.seek(page - 1)
    return pages


def _camera(exif: Exif) -> Camera | None:
    """The camera that made a picture, None if it was none."""
    tags = exif.get_ifd(EXIF_IFD)
    if not any(tag in tags for tag in CAMERA_TAGS):
        return None
    make, model = (_text(exif.get(tag)) for tag in (MAKE, MODEL))
    return Camera(make, model, _length(tags.get(FOCAL_MM)), _length(tags.get(FOCAL_35MM)))


def _text(value: object) -> str | None:
    """A word of Exif, None if there is none."""
    return str(value).strip("\0 ") or None if value is not None else None


def _length(value: object) -> float | None:
    """A length of Exif above zero, None if there is none: some programs write 0, or 0/0."""
    try:
        length = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, ZeroDivisionError):
        return None
    return length if np.isfinite(length) and length > 0 else None


def _states_resolution(image: Image) -> bool:
    """Whether the file states a resolution: for a JPEG with Exif that does not Pillow answers 72 dpi."""
    if "dpi" not in image.info:
        return False
    by_jfif = image.info.get("jfif_unit", 0) in (1, 2)
    return image.format != "JPEG" or by_jfif or X_RESOLUTION in image.getexif()


def _grey(image: Image) -> Grey:
    """Grey levels 0..255 of an image of any mode: its darkest channel, so that coloured lines are dark."""
    columns, rows = image.size
    deep = image.mode in ("I;16", "I;16B", "I;16L", "I", "F")
    grey = np.empty((rows, columns), np.float32 if deep else np.uint8)
    for top, bottom, _ in strips(grey.shape):
        # the whole image would be held twice more
        strip = image.crop((0, top, columns, bottom))
        grey[top:bottom] = np.asarray(strip) if deep else _darkest_channel(strip)
    if deep:
        np.multiply(grey, 255 / _white(image.mode, float(grey.max())), out=grey)
    return grey


def _white(mode: str, lightest: float) -> float:
    """The level that stands for white in a picture of 16 bits, or of whole or broken numbers."""
    if mode == "I;16" or lightest > 255:
        return 65535.0
    return 1.0 if mode == "F" and lightest <= 1 else 255.0


def _darkest_channel(image: Image) -> NDArray[np.uint8]:
    """The darkest colour channel of an image of eight bits or fewer, on white where it is transparent."""
    if image.mode in ("1", "L"):
        return np.asarray(image.convert("L"))
    if image.mode in ("LA", "PA", "RGBA", "La", "RGBa") or "transparency" in image.info:
        from PIL import Image as Images

        rgba = image.convert("RGBA")
        image = Images.alpha_composite(Images.new("RGBA", rgba.size, "white"), rgba)
    return np.asarray(np.asarray(image.convert("RGB")).min(axis=2))


def _stated(image: Image, camera: Camera | None) -> Stated | None:
    """The resolution that the file states; whole numbers where the file rounds to dots per metre."""
    if not _states_resolution(image):
        return None
    x, y = (float(v) for v in image.info["dpi"])
    if not (np.isfinite(x) and np.isfinite(y) and x > 1 and y > 1):
        return None
    x, y = (round(v) if abs(v - round(v)) < ROUNDED_DPI else v for v in (x, y))
    return Stated((x, y), _doubt(camera, x, y))


def _doubt(camera: Camera | None, x_dpi: float, y_dpi: float) -> str | None:
    """Why a stated resolution is not the paper's; None where it may be."""
    if camera is not None:
        return "but a camera took it, and a camera does not know how far the paper was"
    if x_dpi == y_dpi and x_dpi in PLACEHOLDERS_DPI:
        return "which is what programs write when they know no scale"
    return None
