"""The drawing on its table: an image file becomes darkness 0..1 on a sheet in mm.

Signals: an image file in (PNG, JPEG, TIFF, …; any depth, grey or colour, with or without alpha), darkness out: float32 (rows from the top, columns),
0 = paper, 1 = the ink of the drawing's lines, on square pixels of `pitch_mm`.

Uneven paper is levelled: the paper is what is left of the picture when dark strokes narrower than a few mm are closed (a grey closing), smoothed. Ink is
how dark the longer strokes are at their darkest. Whether the line is dark on light or light on dark is read off the skew of the grey levels about their
local mean: strokes are the smaller part, so they stand out further.

Sheet coordinates: mm from the lower-left corner, X right, Y up; pixel i covers [i, i+1) pitches, so the centre of pixel 0 is at half a pitch.

Questions: the patent takes the drawing for granted. A resolution that the file does not state is asked for, never guessed.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from motion.faults import DrawingFault, FileFault

if TYPE_CHECKING:
    from PIL.Image import Image

MM_PER_INCH = 25.4
WIDEST_STROKE_MM = 6.0  # broader dark areas count as paper that is dark
LEAST_CONTRAST = 10.0  # grey levels of 255 between paper and ink
LEAST_STROKE_MM = 2.0  # shorter strokes are specks
FLATTEN_BY = 4  # the paper is estimated on a picture reduced by this

Grey = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Drawing:
    """A drawing as the cells see it: `darkness` (rows from the top, columns) on pixels of `pitch_mm`."""

    darkness: Grey
    pitch_mm: float
    file: Path | None = None

    @property
    def width_mm(self) -> float:
        """Width of the sheet, mm."""
        return self.darkness.shape[1] * self.pitch_mm

    @property
    def height_mm(self) -> float:
        """Height of the sheet, mm."""
        return self.darkness.shape[0] * self.pitch_mm

    @classmethod
    def open(cls, file: str | Path, dpi: float | None = None, width_mm: float | None = None) -> Drawing:
        """Read an image file; its scale from `dpi`, or from the sheet's `width_mm`, or from the file.

        Raises DrawingFault if it is no image, states no resolution, or holds no line; FileFault if it cannot be read.
        """
        file = Path(file)
        if dpi is not None and width_mm is not None:
            raise DrawingFault("both a resolution and a width were given; give one of --dpi and --width")
        image = _read(file)
        grey, stated = _grey(image), _stated_dpi(image)
        pitch = _pitches_mm(file, grey.shape[1], stated, dpi, width_mm)
        if abs(pitch[0] / pitch[1] - 1) > 1e-3:  # a fax has oblong pixels
            rows = round(grey.shape[0] * pitch[1] / pitch[0])
            grey = np.asarray(cv2.resize(grey, (grey.shape[1], rows), interpolation=cv2.INTER_LINEAR), np.float32)
        return cls(darkness_of(grey, pitch[0]), pitch[0], file)


def darkness_of(grey: Grey, pitch_mm: float) -> Grey:
    """Darkness 0..1 of a grey picture (0..255): paper levelled, contrast of the strokes 1.

    Raises DrawingFault if nothing on it is long and dark enough to be a line.
    """
    paper, dark = _paper(grey, pitch_mm)
    contrast = (paper - grey) if dark else (grey - paper)
    return np.asarray(contrast / _ink_contrast(contrast, pitch_mm), np.float32)


def _read(file: Path) -> Image:
    """The first page of an image file, loaded and upright."""
    from PIL import Image, ImageOps, UnidentifiedImageError

    Image.MAX_IMAGE_PIXELS = None  # a large sheet is no attack; a lack of memory is said below
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            image = Image.open(file)
            image.load()
            turned = ImageOps.exif_transpose(image)
    except UnidentifiedImageError:
        raise DrawingFault(f"{file} is not an image that can be read; give a PNG, JPEG or TIFF file") from None
    except FileNotFoundError:
        raise FileFault(f"{file} does not exist; check the name") from None
    except MemoryError:
        raise DrawingFault(
            f"{file} is too large for the memory of this computer; scan it at a lower resolution"
        ) from None
    except (OSError, SyntaxError, ValueError) as error:
        if isinstance(error, OSError) and error.errno is not None:
            raise FileFault(f"{file} cannot be read: {error.strerror}") from None
        raise DrawingFault(f"{file} is a damaged image ({error}); scan or save it again") from None
    turned.info.update({k: v for k, v in image.info.items() if k not in turned.info})
    turned.info["stated"] = _states_resolution(image)
    return turned


def _states_resolution(image: Image) -> bool:
    """Whether the file itself states a resolution: Pillow answers 72 dpi for a JPEG with Exif that does not."""
    if "dpi" not in image.info:
        return False
    by_jfif = image.info.get("jfif_unit", 0) in (1, 2)
    return image.format != "JPEG" or by_jfif or 282 in image.getexif()  # 282: XResolution


def _grey(image: Image) -> Grey:
    """Grey levels 0..255 of an image of any mode; the darkest colour channel, so that a coloured line is as dark as it can be."""
    if image.mode in ("I;16", "I;16B", "I;16L", "I", "F"):
        values = np.asarray(image, np.float32)
        top = 255.0 if values.max() <= 255 and image.mode != "I;16" else 65535.0
        return np.ascontiguousarray(values * (255.0 / top))
    if image.mode in ("1", "L"):
        return np.asarray(image.convert("L"), np.float32)
    if image.mode in ("LA", "PA", "RGBA", "La", "RGBa") or "transparency" in image.info:
        from PIL import Image as Images

        rgba = image.convert("RGBA")
        image = Images.alpha_composite(Images.new("RGBA", rgba.size, "white"), rgba)
    return np.asarray(image.convert("RGB")).min(axis=2).astype(np.float32)


def _stated_dpi(image: Image) -> tuple[float, float] | None:
    """Resolution that the file states, dots per inch in X and Y; whole numbers where the file rounds to dots per metre."""
    if not image.info.get("stated"):
        return None
    x, y = (float(v) for v in image.info["dpi"])
    if not (np.isfinite(x) and np.isfinite(y) and x > 1 and y > 1):
        return None
    return tuple(round(v) if abs(v - round(v)) < 0.02 else v for v in (x, y))  # type: ignore[return-value]


def _pitches_mm(
    file: Path, columns: int, stated: tuple[float, float] | None, dpi: float | None, width_mm: float | None
) -> tuple[float, float]:
    """Pixel pitch in X and Y, mm."""
    for name, value in (("--dpi", dpi), ("--width", width_mm)):
        if value is not None and not (np.isfinite(value) and value > 0):
            raise DrawingFault(f"{name} is {value:g}; it must be more than 0")
    if width_mm is not None:
        return (width_mm / columns,) * 2
    if dpi is not None:
        return (MM_PER_INCH / dpi,) * 2
    if stated is None:
        raise DrawingFault(f"{file} states no resolution; give --dpi 300, or the sheet's width with --width 120mm")
    return MM_PER_INCH / stated[0], MM_PER_INCH / stated[1]


def _paper(grey: Grey, pitch_mm: float) -> tuple[Grey, bool]:
    """Grey level of the paper everywhere, and whether the strokes are darker than it."""
    size = (max(1, grey.shape[1] // FLATTEN_BY), max(1, grey.shape[0] // FLATTEN_BY))
    small = cv2.resize(grey, size, interpolation=cv2.INTER_AREA)
    across = 2 * (max(24, round(WIDEST_STROKE_MM / pitch_mm)) // (2 * FLATTEN_BY)) + 1
    stroke = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (across, across))
    relief = small - cv2.blur(small, (across, across))
    dark = float((relief**3).sum()) <= 0  # strokes take less room than paper: the few stand out further
    level = cv2.morphologyEx(small, cv2.MORPH_CLOSE if dark else cv2.MORPH_OPEN, stroke)
    level = cv2.GaussianBlur(level, (0, 0), across / 2)
    return np.asarray(cv2.resize(level, grey.shape[::-1], interpolation=cv2.INTER_LINEAR), np.float32), dark


def _ink_contrast(contrast: Grey, pitch_mm: float) -> float:
    """Contrast of the strokes against the paper, grey levels: what the darker part of the longer strokes has."""
    soft = cv2.GaussianBlur(contrast, (0, 0), 1.0)
    centre = float(np.median(soft[::4, ::4]))
    noise = 1.4826 * float(np.median(np.abs(soft[::4, ::4] - centre)))
    least = max(LEAST_CONTRAST, centre + 6 * noise)
    _, numbers, stats, _ = cv2.connectedComponentsWithStats((soft > least).astype(np.uint8))
    longest = stats[:, [cv2.CC_STAT_WIDTH, cv2.CC_STAT_HEIGHT]].max(axis=1)
    strokes = longest >= max(12, LEAST_STROKE_MM / pitch_mm)
    strokes[0] = False
    inked = contrast[strokes[numbers]]
    if not inked.size:
        raise DrawingFault(
            f"no line on the drawing: nothing longer than {LEAST_STROKE_MM:g} mm is {least:.0f} or more of 255 grey levels"
            " darker than the paper; check the file, or scan it with more contrast"
        )
    return float(np.percentile(inked, 80))
