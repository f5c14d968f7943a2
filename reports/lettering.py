"""Words on a page of pixels: titles, numbers along axes, legends, names beside places.

Signals in: plates and the boxes in which they stand. Signals out: the page with its words; how much room
words take. Lengths are pixels of the page, from its top left corner.

The letters are those of matplotlib, which brings DejaVu Sans along; Pillow draws them. Where that font is not
found, Pillow's own is taken.

Source: our own; matplotlib is given the same distances (see `vector`). Questions: none.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path as FilePath
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from morfax.motion.files import printable
from morfax.motion.units import POINTS_PER_INCH
from morfax.reports import looks
from morfax.reports.axis_numbers import numbers, steps_in
from morfax.reports.canvas import DPI
from morfax.reports.page import Box, PageLayout
from morfax.reports.plate import (
    BLACK,
    Caption,
    Colours,
    Place,
    Plate,
    View,
    fitted,
    free_corner,
)

PX_PER_PT = DPI / POINTS_PER_INCH
RING_PAD = 0.2  # round words in a ring, in times of their size
# of a legend, in times of its letters' size: to the axes, round all, between rows, on to words; a sample
PAD, SAMPLE = 0.5, 2.0
HALF_HIGH = 0.35  # of a legend's sample of an area
FONT = "mpl-data/fonts/ttf/DejaVuSans.ttf"


@dataclass(frozen=True, slots=True)
class Legend:
    """A legend's box (left, top, right, bottom) within its axes; begin, end and row of each sample."""

    sides_px: tuple[float, float, float, float]
    samples_px: list[tuple[float, float, float]]
    half_high_px: float


def ticks(plate: Plate, box: Box) -> list[tuple[float, bool]]:
    """Shares of a plate's axes at which numbers stand; whether along the upright one."""
    return [(share, is_upright) for share, is_upright, _ in _numbered(plate, box)]


def scale_numbers(scale: Colours, box: Box) -> list[tuple[float, str]]:
    """Shares of a scale of colours at which numbers stand, and these."""
    steps = steps_in(box.width_in * POINTS_PER_INCH, looks.TITLE_PT, upright=False)
    return [(value / scale.largest, text) for value, text in numbers(0.0, scale.largest, steps)]


def ring(words: Caption) -> tuple[Place, float]:
    """Middle, from the words' place, and radius of the ring round words."""
    left, top, right, bottom = _font(words.size_pt).getbbox(_plain(words.text), anchor="ls")
    x = words.offset_pt[0] * PX_PER_PT
    y = -words.offset_pt[1] * PX_PER_PT
    size_px = words.size_pt * PX_PER_PT
    radius = max(right - left, size_px) / 2 + RING_PAD * size_px
    return (x + (left + right) / 2, y + (top + bottom) / 2), radius


def legend(plate: Plate, wide_px: float, high_px: float) -> Legend | None:
    """The legend of a plate, in the freest corner of axes of a size; None without any."""
    if not plate.legend:
        return None
    em = looks.WORDS_PT * PX_PER_PT
    rows, (wide, high) = len(plate.legend), _legend_px(plate)
    shown = replace(plate, view=fitted(plate.view, high_px / wide_px))
    is_upper, is_right = free_corner(shown, legend_share(plate, wide_px, high_px))
    left = wide_px - PAD * em - wide if is_right else PAD * em
    top = PAD * em if is_upper else high_px - PAD * em - high
    begin = left + PAD * em
    end = left + (PAD + SAMPLE) * em
    middles = [top + (PAD + 0.5 + row * (1 + PAD)) * em for row in range(rows)]
    samples = [(begin, end, middle) for middle in middles]
    return Legend((left, top, left + wide, top + high), samples, HALF_HIGH * em)


def legend_share(plate: Plate, wide_px: float, high_px: float) -> tuple[float, float]:
    """How much of the width and height of axes of a size a plate's legend takes in its corner."""
    wide, high = _legend_px(plate)
    outside = PAD * looks.WORDS_PT * PX_PER_PT
    return (wide + outside) / wide_px, (high + outside) / high_px


def _legend_px(plate: Plate) -> tuple[float, float]:
    """Width and height of a plate's legend."""
    em, rows = looks.WORDS_PT * PX_PER_PT, len(plate.legend)
    longest = max(_font(looks.WORDS_PT).getlength(_plain(mark.label)) for mark in plate.legend)
    beside_words = 3 * PAD + SAMPLE
    between_rows = (rows - 1) * PAD
    return beside_words * em + longest, (2 * PAD + rows + between_rows) * em


def written(
    pixels: NDArray[np.uint8],
    page: PageLayout,
    plates: Sequence[tuple[Box, Plate]],
    scale: Colours | None,
) -> NDArray[np.uint8]:
    """Write all words onto a page (rows, columns, BGR); gives the page."""
    image = Image.fromarray(cv2.cvtColor(pixels, cv2.COLOR_BGR2RGB))
    pen = _Pen(image, page)
    for box, plate in plates:
        pen.axes(box, plate)
        pen.legend(box, plate)
        pen.words(box, plate)
    if scale is not None and page.bar is not None:
        pen.scale(page.bar, scale)
    return np.asarray(cv2.cvtColor(np.asarray(image), cv2.COLOR_RGB2BGR), np.uint8)


class _Pen:
    """Writes on a page."""

    def __init__(self, image: Image.Image, page: PageLayout) -> None:
        self.image, self.draw = image, ImageDraw.Draw(image)
        self.page_px = round(page.height_in * DPI)

    def axes(self, box: Box, plate: Plate) -> None:
        """The title of a plate, the numbers along its axes, and their names."""
        left, top, right, bottom = self._sides(box)
        middle, size_pt = (left + right) / 2, plate.numbers_pt
        away = looks.AWAY_PT * PX_PER_PT
        self._write(
            (middle, top - looks.AWAY_PT * PX_PER_PT), plate.title, plate.title_pt, "ms"
        )
        farthest = 0.0
        for share, is_upright, text in _numbered(plate, box):
            if is_upright:
                at = (left - away, bottom + share * (top - bottom))
                self._write(at, text, size_pt, "rm")
                farthest = max(farthest, _font(size_pt).getlength(text))
            else:
                self._write((left + share * (right - left), bottom + away), text, size_pt, "mt")
        if plate.names is not None:
            below = bottom + away + (size_pt + looks.AWAY_PT) * PX_PER_PT
            self._write((middle, below), plate.names[0], size_pt, "mt")
            beside = left - away - farthest - looks.AWAY_PT * PX_PER_PT
            self._upright((beside, (top + bottom) / 2), plate.names[1], size_pt)

    def legend(self, box: Box, plate: Plate) -> None:
        """The labels of a plate's legend."""
        left, top, right, bottom = self._sides(box)
        found = legend(plate, right - left, bottom - top)
        if found is None:
            return
        for mark, (_, end, row) in zip(plate.legend, found.samples_px, strict=True):
            beside = left + end + PAD * looks.WORDS_PT * PX_PER_PT
            self._write((beside, top + row), mark.label, looks.WORDS_PT, "lm")

    def words(self, box: Box, plate: Plate) -> None:
        """The words beside places of a plate, as far as those places are on it."""
        left, top, right, bottom = self._sides(box)
        view = fitted(plate.view, box.height_in / box.width_in)
        for words in plate.words:
            x, y = _shares(view, words.place_mm)
            if not (0 <= x <= 1 and 0 <= y <= 1):
                continue
            at_x = left + x * (right - left) + words.offset_pt[0] * PX_PER_PT
            at_y = bottom + y * (top - bottom) - words.offset_pt[1] * PX_PER_PT
            anchor = "mm" if words.centred else "ls"
            self._write((at_x, at_y), words.text, words.size_pt, anchor, words.colour)

    def scale(self, box: Box, scale: Colours) -> None:
        """The numbers below a scale of colours, and what they are."""
        left, _, right, bottom = self._sides(box)
        away = looks.AWAY_PT * PX_PER_PT
        for share, text in scale_numbers(scale, box):
            self._write(
                (left + share * (right - left), bottom + away), text, looks.TITLE_PT, "mt"
            )
        below = bottom + away + (looks.TITLE_PT + looks.AWAY_PT) * PX_PER_PT
        self._write(((left + right) / 2, below), scale.label, looks.TITLE_PT, "mt")

    def _sides(self, box: Box) -> tuple[float, float, float, float]:
        """Left, top, right and bottom of a box."""
        bottom = self.page_px - box.bottom_in * DPI
        left = box.left_in * DPI
        top = bottom - box.height_in * DPI
        return left, top, left + box.width_in * DPI, bottom

    def _write(
        self, at: Place, text: str, size_pt: float, anchor: str, colour: str = BLACK
    ) -> None:
        """Write words at a place of the page."""
        self.draw.text(at, _plain(text), colour, _font(size_pt), anchor=anchor)

    def _upright(self, at: Place, text: str, size_pt: float) -> None:
        """Write words that run upwards, and end to the left of a place."""
        font = _font(size_pt)
        left, top, right, bottom = (round(side) for side in font.getbbox(text, anchor="ls"))
        strip = Image.new("L", (right - left, bottom - top), 0)
        ImageDraw.Draw(strip).text((-left, -top), text, 255, font, anchor="ls")
        turned = strip.transpose(Image.Transpose.ROTATE_90)
        corner = (round(at[0]) - turned.width, round(at[1] - turned.height / 2))
        self.image.paste(Image.new("RGB", turned.size, BLACK), corner, turned)


def _numbered(plate: Plate, box: Box) -> list[tuple[float, bool, str]]:
    """Shares of the axes at which numbers stand, whether along the upright one, and the numbers."""
    view = fitted(plate.view, box.height_in / box.width_in)
    found = list[tuple[float, bool, str]]()
    sides = ((view[:2], box.width_in, False), (view[2:], box.height_in, True))
    for (first, last), long_in, is_upright in sides:
        room = steps_in(long_in * POINTS_PER_INCH, plate.numbers_pt, upright=is_upright)
        steps = min(room, plate.most_numbers or room)
        for value, text in numbers(first, last, steps):
            found.append(((value - first) / (last - first), is_upright, text))
    return found


def _shares(view: View, place_mm: Place) -> Place:
    """Where a place is within a view, as shares of its sides."""
    left, right, low, high = view
    return (place_mm[0] - left) / (right - left), (place_mm[1] - low) / (high - low)


def _plain(text: str) -> str:
    """Words as they can be written: a file's name may hold any bytes."""
    return printable(text)


@cache
def _font(size_pt: float) -> Any:
    """The letters of a size."""
    size_px = size_pt * PX_PER_PT
    package = importlib.util.find_spec("matplotlib")
    folders = (package.submodule_search_locations if package else None) or []
    for folder in folders:
        if (file := FilePath(folder) / FONT).exists():
            return ImageFont.truetype(str(file), size_px, layout_engine=ImageFont.Layout.BASIC)
    return ImageFont.load_default(size_px)
