"""Scan: one page of a file as it was opened, before anything is made of it: pixels, and what the file states.

Signals in: none; `raster` fills the record. Signals out: pixels, upright, rows from the top; the resolution
that the file states; the camera that made the picture, if one did; page and pages; notes for the operator.

Source: our own. Questions: none.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.faults import DrawingFault

# what programs write into a file when they know no resolution: screens' dots, and Pillow's and Exif's default
PLACEHOLDERS_DPI = (72.0, 96.0)
ROUNDED_DPI = 0.02  # a file that states dots per metre is off a whole number of dpi by no more
Grey = NDArray[np.uint8] | NDArray[np.float32]  # levels 0..255


class Stated(NamedTuple):
    """The resolution that a file states, dots per inch in X and Y, and why it is no scale, if it is none."""

    dpi: tuple[float, float]
    doubt: str | None = None

    @classmethod
    def of(cls, x_dpi: float, y_dpi: float, camera: Camera | None) -> Stated:
        """The resolution as it was meant: in whole numbers, and doubted where it is no scale."""
        x, y = (round(v) if abs(v - round(v)) < ROUNDED_DPI else v for v in (x_dpi, y_dpi))
        if camera is not None:
            doubt = "but a camera took it, and a camera does not know how far the paper was"
            return cls((x, y), doubt)
        if x == y and x in PLACEHOLDERS_DPI:
            return cls((x, y), "which is what programs write when they know no scale")
        return cls((x, y))


class Camera(NamedTuple):
    """What a camera wrote of itself (Exif); None where it did not say."""

    make: str | None = None
    model: str | None = None
    focal_35mm: float | None = None  # focal length of the lens for a frame of 36 x 24 mm


@dataclass(frozen=True, slots=True)
class Scan:
    """A page as it was opened: grey levels 0..255 (rows, columns), or colours (rows, columns, 3)."""

    file: Path
    pixels: Grey
    stated: Stated | None = None  # None: the file states no resolution
    camera: Camera | None = None  # None: no camera made the picture
    page: int = 1
    pages: int = 1
    notes: tuple[str, ...] = ()  # what the operator should know
    is_rendered: bool = False  # of drawn lines, at any resolution

    @property
    def columns(self) -> int:
        """Width, pixels."""
        return int(self.pixels.shape[1])

    @property
    def rows(self) -> int:
        """Height, pixels."""
        return int(self.pixels.shape[0])


def darkest(colours: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The darkest channel of colours (rows, columns, 3), so that coloured lines are dark."""
    red, green, blue = (colours[..., k] for k in range(3))
    return np.minimum(np.minimum(red, green), blue)


def page_asked_for(file: Path, page: int | None, pages: int) -> int:
    """The page that is taken, from 1: the first if none is asked for.

    Raises DrawingFault for a page that the file does not have.
    """
    if page is not None and not 1 <= page <= pages:
        has = "it has one page; leave --page out"
        if pages > 1:
            has = f"it has pages 1 to {pages}; give --page one of them"
        raise DrawingFault(f"{file} has no page {page}; {has}")
    return page or 1


def page_notes(file: Path, page: int, pages: int) -> tuple[str, ...]:
    """What the operator should know of a file of several pages of which nobody has asked for one."""
    if pages == 1:
        return ()
    return (f"{file} has {pages} pages; page {page} is taken; for another one give --page",)
