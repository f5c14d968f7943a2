"""Plates as pixels: lines, spots, areas, the drawing in grey; words and numbers by `lettering`.

Signals in: plates and the boxes in which they stand. Signals out: a page of pixels, (rows, columns, BGR).

All but words is drawn `FINER` times as large and then reduced: OpenCV's lines are whole pixels wide.
Source: the looks are those of matplotlib, which draws the same plates as SVG and PDF (`vector`).
Questions: none.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.units import POINTS_PER_INCH
from morfax.reports import lettering
from morfax.reports.canvas import DPI
from morfax.reports.looks import AWAY_PT, SEE_THROUGH
from morfax.reports.page import Box, PageLayout
from morfax.reports.pixels import Pixels, blend, dashes, polylines, seen, strokes_of
from morfax.reports.plate import (
    Colours,
    Ground,
    Plate,
    Polyline,
    Spot,
    TintedArea,
    fitted,
    shades,
)

FINER = 2
PX_PER_PT = FINER * DPI / POINTS_PER_INCH
SPOT_PX = 1.0 * PX_PER_PT  # edge of a spot, matplotlib's
EDGE_GREY = "#cccccc"  # of a legend
MANY = 2000  # places: fewer are drawn sooner than looked through
THIRD, FIFTH = 1 / 3, 0.2 * np.pi
OUTLINES: dict[str, list[tuple[float, float]]] = {  # of size 1 about 0, as matplotlib's markers
    "s": [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)],
    "D": [(0, -0.707), (0.707, 0), (0, 0.707), (-0.707, 0)],
    "X": [
        *[(-0.25, -0.5), (0, -0.25), (0.25, -0.5), (0.5, -0.25), (0.25, 0), (0.5, 0.25)],
        *[(0.25, 0.5), (0, 0.25), (-0.25, 0.5), (-0.5, 0.25), (-0.25, 0), (-0.5, -0.25)],
    ],
    "P": [
        *[(-THIRD / 2, -0.5), (THIRD / 2, -0.5), (THIRD / 2, -THIRD / 2), (0.5, -THIRD / 2)],
        *[(0.5, THIRD / 2), (THIRD / 2, THIRD / 2), (THIRD / 2, 0.5), (-THIRD / 2, 0.5)],
        *[(-THIRD / 2, THIRD / 2), (-0.5, THIRD / 2), (-0.5, -THIRD / 2)],
        (-THIRD / 2, -THIRD / 2),
    ],
    "*": [
        (
            (0.19, 0.5)[k % 2 == 0] * np.sin(k * FIFTH),
            -(0.19, 0.5)[k % 2 == 0] * np.cos(k * FIFTH),
        )
        for k in range(10)
    ],
    "o": [(0.5 * np.cos(a), 0.5 * np.sin(a)) for a in np.linspace(0, 2 * np.pi, 24)],
}


def drawn(
    page: PageLayout, plates: Sequence[tuple[Box, Plate]], scale: Colours | None
) -> Pixels:
    """Draw a page with all its plates and its scale of colours."""
    high, wide = (round(side * DPI) for side in (page.height_in, page.width_in))
    canvas = np.full((high * FINER, wide * FINER, 3), 255, np.uint8)
    for box, plate in plates:
        left, top, right, bottom = corners_px(page, box)
        canvas[top:bottom, left:right] = _Field(plate, right - left, bottom - top).drawn()
        _frame(canvas, corners_px(page, box))
        for at, is_upright in lettering.ticks(plate, box):
            _tick(canvas, corners_px(page, box), at, is_upright)
    if scale is not None and page.bar is not None:
        _fill_scale(canvas, corners_px(page, page.bar), scale)
        for share, _ in lettering.scale_numbers(scale, page.bar):
            _tick(canvas, corners_px(page, page.bar), share, is_upright=False)
    small = cv2.resize(canvas, (wide, high), interpolation=cv2.INTER_AREA)
    return lettering.written(np.asarray(small, np.uint8), page, plates, scale)


def corners_px(page: PageLayout, box: Box) -> tuple[int, int, int, int]:
    """Left, top, right and bottom of a box on the fine canvas, pixels."""
    high = round(page.height_in * DPI)
    left = box.left_in * DPI
    right = (box.left_in + box.width_in) * DPI
    top = high - (box.bottom_in + box.height_in) * DPI
    bottom = high - box.bottom_in * DPI
    at = [round(side) * FINER for side in (left, top, right, bottom)]
    return at[0], at[1], at[2], at[3]


class _Field:
    """What lies within the frame of a plate, on pixels of its own."""

    def __init__(self, plate: Plate, wide_px: int, high_px: int) -> None:
        self.plate = plate
        self.view = fitted(plate.view, high_px / wide_px)
        self.px_per_mm = wide_px / (self.view[1] - self.view[0])
        self.canvas = np.full((high_px, wide_px, 3), 255, np.uint8)

    def drawn(self) -> Pixels:
        """Draw all but words."""
        if self.plate.ground is not None:
            self._ground(self.plate.ground)
        for mark in self.plate.lowest_first:
            if isinstance(mark, Polyline):
                self._line(self._px(mark.places_mm), mark)
            elif isinstance(mark, Spot):
                self._spot(self._px(np.array([mark.place_mm]))[0], mark)
            elif isinstance(mark, TintedArea):
                self._area(self._px(mark.corners_mm), mark)
        for words in self.plate.words:
            if words.ring:
                middle, radius_px = lettering.ring(words)
                at = self._px(np.array([words.place_mm]))[0] + FINER * np.array(middle)
                self._ring(at, FINER * radius_px, words.ring)
        self._legend()
        return self.canvas

    def _px(self, places_mm: Array) -> Array:
        """Places on the canvas, columns and rows, pixels."""
        left, _, _, top = self.view
        x = places_mm[:, 0] - left
        y = top - places_mm[:, 1]
        return np.column_stack([x, y]) * self.px_per_mm - 0.5

    def _ground(self, ground: Ground) -> None:
        """The drawing in grey."""
        left, right, low, high = ground.extent
        corners = np.array([[left, high], [right, low]])
        ends = np.round(self._px(corners) + 0.5).astype(int)
        (first, top), (last, bottom) = ends
        rows, columns = self.canvas.shape[:2]
        is_beside = last <= 0 or bottom <= 0 or first >= columns or top >= rows
        if last <= first or bottom <= top or is_beside:
            return
        is_smaller = last - first < ground.grey.shape[1]
        how = cv2.INTER_AREA if is_smaller else cv2.INTER_NEAREST
        grey = cv2.resize(
            ground.grey, (int(last - first), int(bottom - top)), interpolation=how
        )
        to = self.canvas[max(top, 0) : bottom, max(first, 0) : last]
        high_px, wide_px = to.shape[:2]
        above, before = max(-top, 0), max(-first, 0)
        part = grey[above : above + high_px, before : before + wide_px]
        to[:] = cv2.cvtColor(part, cv2.COLOR_GRAY2BGR)

    def _line(self, at_px: Array, line: Polyline) -> None:
        """A line with its gaps."""
        if line.dash is not None or len(at_px) > MANY:
            at_px = seen(at_px, self.canvas.shape)
        strokes = strokes_of(at_px)
        if line.dash is not None:
            on, off = (line.width_pt * PX_PER_PT * times for times in line.dash)
            strokes = [dash for stroke in strokes for dash in dashes(stroke, on, off)]
        polylines(self.canvas, strokes, line.colour, line.width_pt * PX_PER_PT, closed=False)

    def _spot(self, at_px: Array, spot: Spot) -> None:
        """The outline of a spot, or a cross."""
        size_px = spot.size_pt * PX_PER_PT
        if spot.shape == "+":
            arms = [np.array([[-0.5, 0], [0.5, 0]]), np.array([[0, -0.5], [0, 0.5]])]
            strokes, closed = [at_px + size_px * arm for arm in arms], False
        else:
            strokes = [at_px + size_px * np.array(OUTLINES[spot.shape])]
            closed = True
        polylines(self.canvas, strokes, spot.colour, SPOT_PX, closed=closed)

    def _area(self, corners_px: Array, area: TintedArea) -> None:
        """An area that what lies under it shines through."""
        blend(self.canvas, corners_px, area.colour, area.alpha)
        if area.edged:
            polylines(self.canvas, [corners_px], area.colour, SPOT_PX, closed=True)

    def _ring(self, middle: Array, radius_px: float, colour: str) -> None:
        """A white disc with an edge."""
        edge = middle + 2 * radius_px * np.array(OUTLINES["o"])
        blend(self.canvas, edge, "#ffffff", SEE_THROUGH)
        polylines(self.canvas, [edge], colour, SPOT_PX, closed=True)

    def _legend(self) -> None:
        """The legend's box, with a sample of each mark in it."""
        rows, columns = self.canvas.shape[:2]
        box = lettering.legend(self.plate, columns / FINER, rows / FINER)
        if box is None:
            return
        left, top, right, bottom = (FINER * side for side in box.sides_px)
        corners = np.array([[left, top], [right, top], [right, bottom], [left, bottom]])
        blend(self.canvas, corners, "#ffffff", SEE_THROUGH)
        polylines(self.canvas, [corners], EDGE_GREY, SPOT_PX, closed=True)
        for mark, (begin, end, row) in zip(self.plate.legend, box.samples_px, strict=True):
            sample = FINER * np.array([[begin, row], [end, row]])
            if isinstance(mark, Polyline):
                self._line(sample, mark)
            elif isinstance(mark, Spot):
                self._spot(sample.mean(axis=0), mark)
            else:
                up = FINER * np.array([0, box.half_high_px])
                self._area(np.vstack([sample - up, sample[::-1] + up]), mark)


def _frame(canvas: Pixels, corners: tuple[int, int, int, int]) -> None:
    """The frame of axes, a pixel of the page wide."""
    left, top, right, bottom = corners
    for column in (left, right):
        canvas[top : bottom + FINER, column : column + FINER] = 0
    for row in (top, bottom):
        canvas[row : row + FINER, left : right + FINER] = 0


def _tick(
    canvas: Pixels, corners: tuple[int, int, int, int], share: float, is_upright: bool
) -> None:
    """A tick below or to the left of axes, at a share of their width or height."""
    left, top, right, bottom = corners
    long = round(AWAY_PT / 2 * PX_PER_PT)
    if is_upright:
        row = round((bottom + share * (top - bottom)) / FINER) * FINER
        canvas[row : row + FINER, left - long : left] = 0
    else:
        column = round((left + share * (right - left)) / FINER) * FINER
        canvas[bottom : bottom + long, column : column + FINER] = 0


def _fill_scale(canvas: Pixels, corners: tuple[int, int, int, int], scale: Colours) -> None:
    """A scale of colours from left to right, in a frame."""
    left, top, right, bottom = corners
    rgb = np.array(shades(scale.colours, right - left))
    bytes_of = [rgb & 255, rgb >> 8 & 255, rgb >> 16]
    canvas[top:bottom, left:right] = np.stack(bytes_of, axis=1)
    _frame(canvas, corners)


def encoded(pixels: Pixels, compression: int) -> bytes:
    """The pixels as a PNG."""
    made: Any
    _, made = cv2.imencode(".png", pixels, [cv2.IMWRITE_PNG_COMPRESSION, compression])
    return bytes(made.tobytes())
