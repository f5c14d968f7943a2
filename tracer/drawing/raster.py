"""Raster: an image file becomes grey levels, or colours, and the scale that the file states.

Signals in: an image file that Pillow reads. Signals out: levels 0..255 (float32 beyond 8 bits) of the first
page, upright, rows from the top; the stated resolution in dots per inch, and whether it is to be believed.

Source: the patent takes the drawing and its scale for granted. Questions: a wrong scale makes a wrong part,
and nothing later can tell. So 72 and 96 dpi, which programs write when they know no scale, and whatever a
camera states are refused like a missing resolution.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.faults import DrawingFault, FileFault
from morfax.tracer.drawing import memory as room
from morfax.tracer.drawing.components import strips

if TYPE_CHECKING:
    from PIL.Image import Image

MM_PER_INCH = 25.4
# what programs write into a file when they know no resolution: screens' dots, and Pillow's and Exif's default
PLACEHOLDERS_DPI = (72.0, 96.0)
# Exif tags that only a camera writes (a scanner has a maker and a model, too): exposure time, aperture, focal
# length, in the directory of Exif; and the tag of the resolution in X
EXIF_IFD, CAMERA_TAGS, X_RESOLUTION = 0x8769, (0x829A, 0x829D, 0x920A), 0x11A
# chosen far beyond any scan: a scale outside is a slip
LEAST_PITCH_MM, LARGEST_PITCH_MM = 0.001, 10.0
ROUNDED_DPI = 0.02  # a file that states dots per metre is off a whole number of dpi by no more
Grey = NDArray[np.uint8] | NDArray[np.float32]  # levels 0..255


class Stated(NamedTuple):
    """The resolution that a file states, dots per inch in X and Y, and why it is no scale, if it is none."""

    dpi: tuple[float, float]
    doubt: str | None = None


def read(file: Path, *, coloured: bool) -> tuple[Grey, Stated | None]:
    """Grey levels, or colours, of the first page of an image file, upright, and its stated resolution."""
    from PIL import Image, ImageOps, UnidentifiedImageError

    Image.MAX_IMAGE_PIXELS = None  # a large sheet is no attack; a lack of memory is said below
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            # by a stream, which is never mapped: Pillow turns maps wrongly
            with file.open("rb") as stream, Image.open(stream) as image:
                room.make_sure(file, *image.size)
                image.load()
                stated = _stated(image)
                ImageOps.exif_transpose(image, in_place=True)
                return np.array(image.convert("RGB")) if coloured else _grey(image), stated
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


def _stated(image: Image) -> Stated | None:
    """The resolution that the file states; whole numbers where the file rounds to dots per metre."""
    if not _states_resolution(image):
        return None
    x, y = (float(v) for v in image.info["dpi"])
    if not (np.isfinite(x) and np.isfinite(y) and x > 1 and y > 1):
        return None
    x, y = (round(v) if abs(v - round(v)) < ROUNDED_DPI else v for v in (x, y))
    return Stated((x, y), _doubt(image, x, y))


def _doubt(image: Image, x_dpi: float, y_dpi: float) -> str | None:
    """Why a stated resolution is not the paper's; None where it may be."""
    if any(tag in image.getexif().get_ifd(EXIF_IFD) for tag in CAMERA_TAGS):
        return "but a camera took it, and a camera does not know how far the paper was"
    if x_dpi == y_dpi and x_dpi in PLACEHOLDERS_DPI:
        return "which is what programs write when they know no scale"
    return None


def pitches_mm(
    file: Path,
    columns: int,
    stated: Stated | None,
    dpi: float | None,
    width_mm: float | None,
) -> tuple[float, float]:
    """Pixel pitch in X and Y, mm."""
    for name, value, pitch_mm in (
        ("--dpi", dpi, dpi and MM_PER_INCH / dpi),
        ("--width", width_mm, width_mm and width_mm / columns),
    ):
        if value is not None and not LEAST_PITCH_MM <= (pitch_mm or 0.0) <= LARGEST_PITCH_MM:
            allowed = f"{MM_PER_INCH / LARGEST_PITCH_MM:.3g} to {MM_PER_INCH / LEAST_PITCH_MM:.3g} dpi"
            raise DrawingFault(
                f"{name} is {value:g}; it must give pixels of {LEAST_PITCH_MM:g} to"
                f" {LARGEST_PITCH_MM:g} mm, {allowed}"
            )
    if width_mm is not None:
        return (width_mm / columns,) * 2
    if dpi is not None:
        return (MM_PER_INCH / dpi,) * 2
    if stated is None:
        raise DrawingFault(
            f"{file} states no resolution; give --dpi 300, or the sheet's width with --width 120mm"
        )
    if stated.doubt is not None:
        raise DrawingFault(
            f"{file} states {stated.dpi[0]:g} dpi, {stated.doubt}; "
            f"give the sheet's width with --width 120mm, or --dpi {stated.dpi[0]:g} if that is true"
        )
    return MM_PER_INCH / stated.dpi[0], MM_PER_INCH / stated.dpi[1]
