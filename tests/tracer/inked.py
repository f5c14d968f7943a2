"""Drawings whose geometry is known: lines inked with a round pen, apart from the tracer, clean or as a
scanner sees them.

Coordinates are sheet mm. The pen's ink is drawn eight times too fine and averaged over each pixel, then
softened as by a scanner's lens. With a seed it is seen on paper with a scanner's noise, 4 % of the contrast.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing.drawing import Drawing

UM = 1e-3  # mm
WIDTH_MM = 0.5
DPI = 300.0
MARGIN_MM = 4.0
SOFTNESS_MM = 0.05
NOISE = 0.04
OVERSAMPLE = 8
SAGITTA_MM = 0.02 * UM  # of the chords of a curve

Points = NDArray[np.float64]


def inked(
    *lines: Points,
    width_mm: float = WIDTH_MM,
    dpi: float = DPI,
    seed: int | None = None,
    specks: Sequence[Points] = (),
) -> Drawing:
    """The drawing of lines (n, 2) mm on a sheet with a margin above and right of all; specks are filled
    outlines.
    """
    return _scanned([(line, width_mm) for line in lines], specks, dpi, seed)


def together(*drawn: tuple[Points, float], seed: int | None = None) -> Drawing:
    """The drawing of lines (n, 2) mm, each with the width of its pen, mm."""
    return _scanned(drawn, (), DPI, seed)


def _scanned(
    drawn: Sequence[tuple[Points, float]],
    specks: Sequence[Points],
    dpi: float,
    seed: int | None,
) -> Drawing:
    """The drawing of lines, each with the width of its pen, and specks."""
    high = np.vstack([*(line for line, _ in drawn), *specks]).max(axis=0) + MARGIN_MM
    pixels = np.ceil(high * dpi / MM_PER_INCH).astype(int)
    fine = np.zeros((pixels[1] * OVERSAMPLE, pixels[0] * OVERSAMPLE), np.uint8)
    scale = dpi / MM_PER_INCH * OVERSAMPLE
    for line, width_mm in drawn:
        way, pen = _fixed(line, len(fine), scale), round(width_mm * scale)
        cv2.polylines(fine, [way], False, 255, pen, cv2.LINE_AA, 8)
    for speck in specks:
        cv2.fillPoly(fine, [_fixed(speck, len(fine), scale)], 255, cv2.LINE_AA, 8)
    return Drawing(_seen(fine, pixels, dpi, seed), MM_PER_INCH / dpi)


def loops(count: int, apart_mm: float = 12.0) -> Points:
    """The way of a pen that writes some loops in a row: one stroke with two free ends."""
    share = np.linspace(0.0, 1.0, 1000 * count + 1)
    turned = 2 * np.pi * count * share
    x = 10 + apart_mm * count * share + 5 * np.sin(turned)
    return np.column_stack([x, 16 - 9 * np.sin(turned + 1.2) - 2 * np.sin(9 * share)])


def _fixed(line: Points, rows: int, scale: float) -> NDArray[np.int32]:
    """Points in 1/256 of a fine pixel, Y down, 0 at the middle of the first fine pixel."""
    at = np.column_stack([line[:, 0] * scale, rows - line[:, 1] * scale]) - 0.5
    return np.round(at * 256).astype(np.int32).reshape(-1, 1, 2)


def _seen(
    fine: NDArray[np.uint8], pixels: NDArray[np.int_], dpi: float, seed: int | None
) -> NDArray[np.float32]:
    """Darkness 0..1 of the pixels."""
    size = (int(pixels[0]), int(pixels[1]))
    ink = cv2.resize(fine, size, interpolation=cv2.INTER_AREA).astype(np.float32) / 255
    soft = cv2.GaussianBlur(ink, (0, 0), SOFTNESS_MM * dpi / MM_PER_INCH)
    if seed is not None:
        soft = soft + np.random.default_rng(seed).normal(0, NOISE, soft.shape)
    return np.asarray(soft, np.float32)


def polyline(*points: tuple[float, float]) -> Points:
    """A line from point to point, mm."""
    return np.array(points, float)


def arc(
    centre: tuple[float, float], radius_mm: float, from_deg: float = 0.0, to_deg: float = 360.0
) -> Points:
    """An arc, or the whole circle, its ends included."""
    step = 2 * math.acos(1 - min(SAGITTA_MM / radius_mm, 1.0))
    angle = np.linspace(
        *np.radians([from_deg, to_deg]),
        2 + math.ceil(abs(math.radians(to_deg - from_deg)) / step),
    )
    return np.asarray(
        np.array(centre) + radius_mm * np.column_stack([np.cos(angle), np.sin(angle)])
    )


def corner(deflection_deg: float, radius_mm: float = 0.0, leg_mm: float = 10.0) -> Points:
    """Two straight legs, the first along X, the second turned left by the deflection; the vertex is rounded
    by the radius.
    """
    turn = math.radians(deflection_deg)
    way = np.array([math.cos(turn), math.sin(turn)])
    touch = radius_mm * math.tan(turn / 2)
    vertex = np.array([MARGIN_MM + leg_mm * max(1.0, 1.0 - math.cos(turn)), MARGIN_MM])
    legs = [
        vertex - [leg_mm, 0],
        vertex - [touch, 0],
        vertex + touch * way,
        vertex + leg_mm * way,
    ]
    if radius_mm == 0:
        return np.array([legs[0], vertex, legs[3]])
    bend = arc((legs[1][0], legs[1][1] + radius_mm), radius_mm, -90, -90 + deflection_deg)
    return np.vstack([legs[0], bend, legs[3]])


def tick(
    place: tuple[float, float],
    line_deg: float = 0.0,
    *,
    before_mm: float = 1.5,
    beyond_mm: float = 1.5,
    slant_deg: float = 0.0,
) -> Points:
    """A stop mark through a place on a line of a heading: from `before_mm` on its right to `beyond_mm` on its
    left (one negative: beside the line).
    """
    a = math.radians(line_deg + 90 + slant_deg)
    way = np.array([math.cos(a), math.sin(a)])
    return np.asarray(place) + np.array([-before_mm * way, beyond_mm * way])


def cross(
    place: tuple[float, float], size_mm: float = 3.0, turn_deg: float = 0.0
) -> list[Points]:
    """The two strokes of a reference point."""
    return [
        tick(place, turn_deg + k, before_mm=size_mm / 2, beyond_mm=size_mm / 2) for k in (0, 90)
    ]


def dot(place: tuple[float, float], across_mm: float) -> Points:
    """The outline of a filled round."""
    return arc(place, across_mm / 2)
