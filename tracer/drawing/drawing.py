"""The drawing on its table: an image file becomes darkness 0..1 on a sheet in mm.

Signals: an image file in (PNG, JPEG, TIFF, …; any depth, grey or colour, with or without alpha), darkness out: float32 (rows from the top, columns),
0 = paper, 1 = the ink of the drawing's lines, on square pixels of `pitch_mm`.

Uneven paper is levelled (see `paper`), dark on light or light on dark. Ink is how dark the longer strokes are at their darkest.

Sheet coordinates: mm from the lower-left corner, X right, Y up; pixel i covers [i, i+1) pitches, so the centre of pixel 0 is at half a pitch.

A sheet may have a thousand million pixels: all that is done to every pixel is done strip by strip, and only the darkness is kept as a whole.

Questions: the patent takes the drawing for granted. A resolution that the file does not state is asked for, never guessed.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.faults import DrawingFault, FileFault
from morfax.tracer.drawing import inks, paper
from morfax.tracer.drawing import memory as room
from morfax.tracer.drawing.components import Patches, runs_of, strips
from morfax.tracer.drawing.shapes import outlined

if TYPE_CHECKING:
    from PIL.Image import Image

MM_PER_INCH = 25.4
LEAST_PITCH_MM, LARGEST_PITCH_MM = 0.001, 10.0
LEAST_CONTRAST = 10.0  # grey levels of 255 between paper and ink
LEAST_STROKE_MM = 2.0  # shorter strokes are specks
FEWEST_SAMPLES = 1 << 22  # that tell the noise of the paper, and the darkness of the ink

Darkness = NDArray[np.float32]
Shapes = NDArray[np.bool_]
Grey = NDArray[np.uint8] | NDArray[np.float32]  # levels 0..255


@dataclass(frozen=True, slots=True)
class Drawing:
    """A drawing as the cells see it: `darkness` (rows from the top, columns) on pixels of `pitch_mm`.

    Of filled shapes the `edges_mm`, closed polylines (n, 2), that a run has to keep to, and how many times `enlarged` the head sees the line along them; if
    they are not asked for, where there are `shapes`, on the picture reduced by a whole number.
    """

    darkness: Darkness
    pitch_mm: float
    file: Path | None = None
    enlarged: int = 1
    edges_mm: tuple[NDArray[np.float64], ...] = ()
    shapes: Shapes | None = None

    @property
    def width_mm(self) -> float:
        """Width of the sheet, mm."""
        return self.darkness.shape[1] * self.pitch_mm

    @property
    def height_mm(self) -> float:
        """Height of the sheet, mm."""
        return self.darkness.shape[0] * self.pitch_mm

    @classmethod
    def open(
        cls,
        file: str | Path,
        dpi: float | None = None,
        width_mm: float | None = None,
        ink: str | None = None,
        edge: bool = False,
    ) -> Drawing:
        """Read an image file; its scale from `dpi`, or from the sheet's `width_mm`, or from the file. Of a coloured drawing only one `ink`, if given;
        of filled shapes their edges, if `edge`.

        Raises DrawingFault if it is no image, states no resolution, or holds no line; FileFault if it cannot be read.
        """
        file, wanted = Path(file), None if ink is None else inks.parsed(ink)
        if dpi is not None and width_mm is not None:
            raise DrawingFault("both a resolution and a width were given; give one of --dpi and --width")
        picture, stated = _read(file, coloured=ink is not None)
        pitch = _pitches_mm(file, picture.shape[1], stated, dpi, width_mm)
        grey = (
            picture
            if wanted is None
            else inks.covered(np.asarray(picture, np.uint8), wanted, None if edge else pitch[0])
        )
        if abs(pitch[0] / pitch[1] - 1) > 1e-3:  # a fax has oblong pixels
            size = grey.shape[1], round(grey.shape[0] * pitch[1] / pitch[0])
            grey = np.asarray(
                cv2.resize(grey.astype(np.float32), size, interpolation=cv2.INTER_LINEAR), np.float32
            )
        if edge:
            line = outlined(grey, pitch[0])
            return cls(line.darkness, pitch[0] / line.finer, file, line.finer, line.edges_mm)
        darkness, shapes = levelled(grey, pitch[0])
        return cls(darkness, pitch[0], file, shapes=shapes)


def levelled(grey: Grey, pitch_mm: float) -> tuple[Darkness, Shapes]:
    """Darkness 0..1 of a grey picture (0..255): paper levelled, contrast of the strokes 1; and where filled shapes are, on a picture reduced by a whole number.

    Raises DrawingFault if nothing on it is long and dark enough to be a line.
    """
    level = paper.Paper.of(grey, pitch_mm)
    contrast = np.empty(grey.shape, np.float32)
    for top, bottom, _ in strips(grey.shape):
        behind = level.rows(top, bottom)
        first, second = (behind, grey[top:bottom]) if level.is_light else (grey[top:bottom], behind)
        np.subtract(first, second, out=contrast[top:bottom], dtype=np.float32)
    ink = _ink_contrast(contrast, pitch_mm)
    contrast /= np.float32(ink)
    return contrast, level.shapes(ink)


def _read(file: Path, *, coloured: bool) -> tuple[Grey, tuple[float, float] | None]:
    """Grey levels, or colours, of the first page of an image file, upright, and the resolution that the file states."""
    from PIL import Image, ImageOps, UnidentifiedImageError

    Image.MAX_IMAGE_PIXELS = None  # a large sheet is no attack; a lack of memory is said below
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with (
                file.open("rb") as stream,
                Image.open(stream) as image,
            ):  # a stream is never mapped: Pillow turns maps wrongly
                room.make_sure(file, *image.size)
                image.load()
                stated = _stated_dpi(image)
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
        raise DrawingFault(f"{file} is a damaged image ({error}); scan or save it again") from None


def _states_resolution(image: Image) -> bool:
    """Whether the file itself states a resolution: Pillow answers 72 dpi for a JPEG with Exif that does not."""
    if "dpi" not in image.info:
        return False
    by_jfif = image.info.get("jfif_unit", 0) in (1, 2)
    return image.format != "JPEG" or by_jfif or 282 in image.getexif()  # 282: XResolution


def _grey(image: Image) -> Grey:
    """Grey levels 0..255 of an image of any mode; the darkest colour channel, so that a coloured line is as dark as it can be."""
    columns, rows = image.size
    deep = image.mode in ("I;16", "I;16B", "I;16L", "I", "F")
    grey = np.empty((rows, columns), np.float32 if deep else np.uint8)
    for top, bottom, _ in strips(grey.shape):
        strip = image.crop((0, top, columns, bottom))  # as a whole it would be held twice more
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
    """The darkest of the colour channels of an image of eight bits or fewer, on white where it is transparent."""
    if image.mode in ("1", "L"):
        return np.asarray(image.convert("L"))
    if image.mode in ("LA", "PA", "RGBA", "La", "RGBa") or "transparency" in image.info:
        from PIL import Image as Images

        rgba = image.convert("RGBA")
        image = Images.alpha_composite(Images.new("RGBA", rgba.size, "white"), rgba)
    return np.asarray(np.asarray(image.convert("RGB")).min(axis=2))


def _stated_dpi(image: Image) -> tuple[float, float] | None:
    """Resolution that the file states, dots per inch in X and Y; whole numbers where the file rounds to dots per metre."""
    if not _states_resolution(image):
        return None
    x, y = (float(v) for v in image.info["dpi"])
    if not (np.isfinite(x) and np.isfinite(y) and x > 1 and y > 1):
        return None
    return tuple(round(v) if abs(v - round(v)) < 0.02 else v for v in (x, y))  # type: ignore[return-value]


def _pitches_mm(
    file: Path, columns: int, stated: tuple[float, float] | None, dpi: float | None, width_mm: float | None
) -> tuple[float, float]:
    """Pixel pitch in X and Y, mm."""
    for name, value, pitch_mm in (
        ("--dpi", dpi, dpi and MM_PER_INCH / dpi),
        ("--width", width_mm, width_mm and width_mm / columns),
    ):
        if value is not None and not LEAST_PITCH_MM <= (pitch_mm or 0.0) <= LARGEST_PITCH_MM:
            allowed = f"{MM_PER_INCH / LARGEST_PITCH_MM:.3g} to {MM_PER_INCH / LEAST_PITCH_MM:.3g} dpi"
            raise DrawingFault(
                f"{name} is {value:g}; it must give pixels of {LEAST_PITCH_MM:g} to {LARGEST_PITCH_MM:g} mm, {allowed}"
            )
    if width_mm is not None:
        return (width_mm / columns,) * 2
    if dpi is not None:
        return (MM_PER_INCH / dpi,) * 2
    if stated is None:
        raise DrawingFault(
            f"{file} states no resolution; give --dpi 300, or the sheet's width with --width 120mm"
        )
    return MM_PER_INCH / stated[0], MM_PER_INCH / stated[1]


def _ink_contrast(contrast: Darkness, pitch_mm: float) -> float:
    """Contrast of the strokes against the paper, grey levels: what the darker part of the longer strokes has."""
    every = max(4, math.isqrt(contrast.size // FEWEST_SAMPLES))
    sample = np.concatenate(
        [soft[-top % every :: every, ::every].ravel() for top, soft in _softened(contrast)]
    )
    centre = float(np.median(sample))
    noise = 1.4826 * float(np.median(np.abs(sample - centre)))
    least = max(LEAST_CONTRAST, centre + 6 * noise)
    patches = Patches.of(runs_of(soft > least, top) for top, soft in _softened(contrast))
    strokes = patches.longer_sides >= max(12, LEAST_STROKE_MM / pitch_mm)
    if not strokes.any():
        raise DrawingFault(
            f"no line on the drawing: nothing longer than {LEAST_STROKE_MM:g} mm is {least:.0f} or more of 255 grey levels"
            " darker than the paper; check the file, or scan it with more contrast"
        )
    every = max(1, int(patches.areas[strokes].sum()) // (4 * FEWEST_SAMPLES))
    inked = [
        contrast[top:bottom][patches.painted(strokes, top, bottom, 0, contrast.shape[1]).view(bool)][::every]
        for top, bottom, _ in strips(contrast.shape)
    ]
    return float(np.percentile(np.concatenate(inked), 80))


def _softened(contrast: Darkness) -> Iterator[tuple[int, Darkness]]:
    """The picture behind a spot of one pixel (standard deviation), strip by strip: first row, and the strip."""
    for top, bottom, rows in strips(contrast.shape, halo=8):
        soft = cv2.GaussianBlur(contrast[rows], (0, 0), 1.0)
        yield top, np.asarray(soft[top - rows.start : bottom - rows.start], np.float32)
