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

MM_PER_INCH = 25.4
Grey = NDArray[np.uint8] | NDArray[np.float32]  # levels 0..255


class Stated(NamedTuple):
    """The resolution that a file states, dots per inch in X and Y, and why it is no scale, if it is none."""

    dpi: tuple[float, float]
    doubt: str | None = None


class Camera(NamedTuple):
    """What a camera wrote of itself (Exif); None where it did not say."""

    make: str | None = None
    model: str | None = None
    focal_mm: float | None = None  # focal length of the lens
    focal_35mm: float | None = None  # the same for a frame of 36 x 24 mm


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

    @property
    def columns(self) -> int:
        """Width, pixels."""
        return int(self.pixels.shape[1])

    @property
    def rows(self) -> int:
        """Height, pixels."""
        return int(self.pixels.shape[0])
