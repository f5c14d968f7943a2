"""Scale: how many mm a pixel of a scan is, by what the operator gives, or by what the file states.

Signals in: a Scan; a resolution, a width, or two places that are a known distance apart. Signals out: the
pixel's pitch in X and Y, mm.

Places are in pixels, as picture viewers show them: columns from the left, rows from the top, of the upright
page. The pitch is length / distance; a pixel at either end is 1 / distance of it.

Source: the patent takes the drawing's scale for granted. Questions: a wrong scale makes a wrong part, and
nothing later can tell. So a file without a resolution, or with one that is to be doubted (see `scan`), is
refused, and the operator is asked.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import cv2
import numpy as np

from morfax.motion.faults import DrawingFault
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing.scan import Grey, Scan

# chosen far beyond any scan: a scale outside is a slip
LEAST_PITCH_MM, LARGEST_PITCH_MM = 0.001, 10.0
OBLONG = 1e-3  # sides of a pixel that differ by more than this share are made alike: a fax has such pixels
MOST_OBLONG = 4.0  # sides of a pixel; a fax has 204 x 98 dpi, at its coarsest 204 x 51
# a pixel is then 1 % of the scale; a part is no use with a greater error
LEAST_APART_PX = 100.0
OF_A_PHOTOGRAPH = "--flatten marks, or --flatten paper=a4"

Place = tuple[float, float]


class Known(NamedTuple):
    """Two places on the sheet, (column, row) in pixels, and the length between them, mm."""

    first_px: Place
    second_px: Place
    length_mm: float


@dataclass(frozen=True, slots=True)
class Scale:
    """What the operator gives as the scale; nothing: the file's own counts."""

    dpi: float | None = None
    width_mm: float | None = None  # of the whole sheet
    known: Known | None = None

    def given(self) -> tuple[str, ...]:
        """The options that are given."""
        every = {"--dpi": self.dpi, "--width": self.width_mm, "--known": self.known}
        return tuple(name for name, value in every.items() if value is not None)

    def pitches_mm(self, scan: Scan) -> tuple[float, float]:
        """Pixel pitch in X and Y, mm; raises DrawingFault if there is no scale, or no sensible one."""
        if len(self.given()) > 1:
            names = " and ".join(self.given())
            raise DrawingFault(f"both {names} were given; give one of {names}")
        if self.known is not None:
            return _known_mm(self.known, scan)
        if self.width_mm is not None:
            pitch_mm = self.width_mm / scan.columns
            return (_checked("--width", self.width_mm, pitch_mm),) * 2
        if self.dpi is not None:
            pitch_mm = MM_PER_INCH / self.dpi if self.dpi else 0.0
            return (_checked("--dpi", self.dpi, pitch_mm),) * 2
        return _stated_mm(scan)

    def notes(self, scan: Scan) -> tuple[str, ...]:
        """What the operator should know about the scale: what two places give, and how exactly."""
        if self.known is None:
            return ()
        x_mm, y_mm = self.pitches_mm(scan)
        share = 100 / math.dist(self.known.first_px, self.known.second_px)
        return (
            f"--known gives {MM_PER_INCH / x_mm:.4g} dpi, a sheet of"
            f" {scan.columns * x_mm:.2f} x {scan.rows * y_mm:.2f} mm;"
            f" a pixel more or less makes {share:.2g} % of it",
        )


def _known_mm(known: Known, scan: Scan) -> tuple[float, float]:
    """Pixel pitch in X and Y by two places; oblong pixels stay as oblong as the file states."""
    for x, y in (known.first_px, known.second_px):
        if not (0 <= x <= scan.columns and 0 <= y <= scan.rows):
            raise DrawingFault(
                f"--known has the place {x:g},{y:g}, which is not on the page of {scan.columns} x"
                f" {scan.rows} pixels; give columns from the left, rows from the top"
            )
    apart_px = math.dist(known.first_px, known.second_px)
    if not apart_px >= LEAST_APART_PX:
        raise DrawingFault(
            f"--known has places {apart_px:.4g} pixels apart; give two that are {LEAST_APART_PX:g} or more"
            " apart, better the sheet's whole length: a pixel counts for less then"
        )
    oblong = 1.0 if scan.stated is None else scan.stated.dpi[0] / scan.stated.dpi[1]
    if not 1 / MOST_OBLONG <= oblong <= MOST_OBLONG:
        oblong = 1.0  # what the file states cannot be
    right, down = (b - a for a, b in zip(known.first_px, known.second_px, strict=True))
    pitch_mm = known.length_mm / math.hypot(right, down * oblong)
    return _checked("--known", known.length_mm, pitch_mm), pitch_mm * oblong


def _checked(option: str, value: float, pitch_mm: float) -> float:
    """A pixel pitch, mm; raises DrawingFault for one that no scan has."""
    if LEAST_PITCH_MM <= pitch_mm <= LARGEST_PITCH_MM:
        return pitch_mm
    allowed = f"{MM_PER_INCH / LARGEST_PITCH_MM:.3g} to {MM_PER_INCH / LEAST_PITCH_MM:.3g} dpi"
    raise DrawingFault(
        f"{option} is {value:g}; it must give pixels of {LEAST_PITCH_MM:g} to"
        f" {LARGEST_PITCH_MM:g} mm, {allowed}"
    )


def _stated_mm(scan: Scan) -> tuple[float, float]:
    """Pixel pitch in X and Y by what the file states, mm."""
    stated = scan.stated
    if stated is None:
        raise DrawingFault(
            f"{scan.file} states no resolution; "
            "give --dpi 300, or the sheet's width with --width 120mm, or --known X,Y X,Y 100mm; of a"
            f" photograph {OF_A_PHOTOGRAPH}"
        )
    if stated.doubt is not None:
        raise DrawingFault(
            f"{scan.file} states {stated.dpi[0]:g} dpi, {stated.doubt}; give the sheet's width with"
            f" --width 120mm, or --known X,Y X,Y 100mm, or --dpi {stated.dpi[0]:g} if that is true; of a"
            f" photograph {OF_A_PHOTOGRAPH}"
        )
    x_mm, y_mm = (MM_PER_INCH / dpi for dpi in stated.dpi)
    every = all(LEAST_PITCH_MM <= pitch_mm <= LARGEST_PITCH_MM for pitch_mm in (x_mm, y_mm))
    if not every or not 1 / MOST_OBLONG <= x_mm / y_mm <= MOST_OBLONG:
        raise DrawingFault(
            f"{scan.file} states {stated.dpi[0]:g} x {stated.dpi[1]:g} dpi, which no scanner has; "
            "give --dpi 300, or the sheet's width with --width 120mm"
        )
    return x_mm, y_mm


def on_square_pixels(grey: Grey, pitch_mm: tuple[float, float]) -> Grey:
    """A picture whose pixels have a pitch across and down, on pixels of the pitch across."""
    across_mm, down_mm = pitch_mm
    if abs(across_mm / down_mm - 1) <= OBLONG:
        return grey
    size = grey.shape[1], round(grey.shape[0] * down_mm / across_mm)
    square = cv2.resize(np.asarray(grey, np.float32), size, interpolation=cv2.INTER_LINEAR)
    return np.asarray(square, np.float32)
