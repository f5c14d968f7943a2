"""Small photographs of sheets whose truth is known: a simulated phone of 1.4 Mpx, 4 to 5 px a mm on A4."""

from __future__ import annotations

import math
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.phone import Phone
from morfax.reports.marked_sheet import picture
from morfax.tracer.flatten.flat import Flattening
from morfax.tracer.flatten.flat import found as found_in
from morfax.tracer.flatten.layout import Layout
from morfax.tracer.flatten.projection import Focal
from morfax.tracer.flatten.wanted import Wanted

Picture = NDArray[np.uint8]
Array = NDArray[np.float64]
Size = tuple[float, float]

A4: Size = (210.0, 297.0)
LETTER: Size = (215.9, 279.4)
PX_PER_MM = 10.0  # of the sheet before it is photographed
DPI = PX_PER_MM * 25.4
PAPER = 245
FOCAL = Focal.stated(26.0)


def phone(tilt_deg: float = 0.0, k1: float = 0.0, **how: float) -> Phone:
    """A small phone; its picture is as sharp as one of 12 Mpx is in mm."""
    return Phone(
        columns=1020,
        rows=1360,
        tilt_rad=math.radians(tilt_deg),
        about_rad=0.7,
        turn_rad=0.05,
        k1=k1,
        **{"blur_px": 0.6, **how},  # type: ignore[arg-type]
    )


@cache
def _marked(name: str) -> Picture:
    return picture(Layout.of(name), DPI)


def marked(name: str = "a4") -> Picture:
    """A sheet with marks, to draw on."""
    return _marked(name).copy()


def blank(size_mm: Size) -> Picture:
    """A sheet of plain paper."""
    columns, rows = (round(side * PX_PER_MM) for side in size_mm)
    return np.full((rows, columns, 3), PAPER, np.uint8)


@cache
def plain(camera: Phone, size_mm: Size) -> Picture:
    """A photograph of plain paper; not to be changed."""
    taken = camera.photograph(blank(size_mm), size_mm)
    taken.setflags(write=False)
    return taken


def draw(sheet: Picture, line_mm: Array, width_mm: float = 0.8) -> None:
    """Draw a line on a sheet, from the lower left, Y up."""
    x, y = line_mm.T * PX_PER_MM
    places = np.round(16 * np.column_stack([x - 0.5, len(sheet) - y - 0.5])).astype(np.int32)
    cv2.polylines(
        sheet, [places], False, (40, 40, 40), round(width_mm * PX_PER_MM), cv2.LINE_AA, shift=4
    )


def fill(sheet: Picture, box_mm: tuple[float, float, float, float], colour: int) -> None:
    """Paint a box (left, bottom, right, top) on a sheet."""
    left, bottom, right, top = (round(edge * PX_PER_MM) for edge in box_mm)
    sheet[len(sheet) - top : len(sheet) - bottom, left:right] = colour


def off_mm(made: Flattening, camera: Phone, size_mm: Size, inset_mm: float = 20.0) -> Array:
    """How far places all over a sheet are from where the flat sheet has them (n, 2), mm."""
    x, y = np.meshgrid(*(np.linspace(inset_mm, side - inset_mm, 9) for side in size_mm))
    places = np.column_stack([x.ravel(), y.ravel()])
    return made.projection.to_sheet(camera.to_photo(places, size_mm)) - places


def rms(off: Array) -> float:
    """Root mean square of distances (n, 2)."""
    return float(np.sqrt((off**2).sum(axis=1).mean()))


def made(picture: Picture, wanted: Wanted, bar_mm: float = 100.0) -> Flattening:
    """How a photograph was made flat."""
    return found_in(picture, wanted, bar_mm, FOCAL)
