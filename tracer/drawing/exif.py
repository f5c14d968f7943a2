"""Exif: what a camera, a scanner or a program wrote into a picture about how it was made.

Signals in: the tags of a picture, as Pillow reads them. Signals out: the camera, if one made it; a resolution
in dots per inch.

Source: Exif 2.32 (CIPA DC-008), tables 4, 7 and 8. Questions: a scanner writes its maker and model, too, so
that a camera is known by what only a camera has: exposure time, aperture or focal length.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from morfax.tracer.drawing.scan import Camera

if TYPE_CHECKING:
    from PIL.Image import Exif

# tags: the directory of Exif, and in it exposure time, aperture, focal lengths
EXIF_IFD, EXPOSURE_S, APERTURE, FOCAL_MM, FOCAL_35MM = 0x8769, 0x829A, 0x829D, 0x920A, 0xA405
ORIENTATION = 0x112
MAKE, MODEL, X_RESOLUTION, Y_RESOLUTION, UNIT = 0x10F, 0x110, 0x11A, 0x11B, 0x128
PER_INCH = {2: 1.0, 3: 2.54}  # dots per unit of the tag UNIT (inch, cm) to dots per inch


def camera(exif: Exif) -> Camera | None:
    """The camera that made a picture, None if it was none."""
    tags = exif.get_ifd(EXIF_IFD)
    if not any(tag in tags for tag in (EXPOSURE_S, APERTURE, FOCAL_MM)):
        return None
    make, model = _text(exif.get(MAKE)), _text(exif.get(MODEL))
    return Camera(make, model, _above_zero(tags.get(FOCAL_35MM)))


def resolution_dpi(exif: Exif) -> tuple[float, float] | None:
    """The resolution in X and Y, dots per inch; None if there is none."""
    per_inch = PER_INCH.get(exif.get(UNIT, 2))
    x, y = _above_zero(exif.get(X_RESOLUTION)), _above_zero(exif.get(Y_RESOLUTION))
    if per_inch is None or x is None:
        return None
    return x * per_inch, (y or x) * per_inch


def _text(value: object) -> str | None:
    """A word, None if there is none."""
    return str(value).strip("\0 ") or None if value is not None else None


def _above_zero(value: object) -> float | None:
    """A finite number above zero, None if there is none: some programs write 0, or 0/0."""
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, ZeroDivisionError):
        return None
    return number if math.isfinite(number) and number > 0 else None
