"""Plates: what a picture shows, before it is known how it is drawn.

Signals: a plate shows a part of the sheet. Its marks have places in mm on the sheet, and sizes in points
(1/72 in). `bitmap` draws plates as pixels, `vector` as SVG and PDF with matplotlib, which takes longer to
import than a page takes to trace.

Source: our own. Questions: none.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.reports.looks import SPOTS, TITLE_PT

View = tuple[float, float, float, float]  # left, right, bottom, top, mm on the sheet
Place = tuple[float, float]
BLACK = "#000000"


@dataclass(frozen=True, slots=True)
class Ground:
    """A grey picture (rows from the top, columns), 0 for black, and the part of the sheet that it covers."""

    grey: NDArray[np.uint8]
    extent: View


@dataclass(frozen=True, slots=True)
class Polyline:
    """A polyline (n, 2); where it is not a number it has a gap. Lines of a higher order lie on top."""

    places_mm: Array
    colour: str
    width_pt: float
    dash: tuple[float, float] | None = None  # and the gap behind it, in widths of the line
    label: str = ""
    order: int = 2


@dataclass(frozen=True, slots=True)
class Spot:
    """A place, marked by an outline of a size: "o", "s", "D", "X", "P", "*", or the cross "+"."""

    place_mm: Place
    shape: str
    size_pt: float
    colour: str
    label: str = ""
    order: int = SPOTS


@dataclass(frozen=True, slots=True)
class TintedArea:
    """A polygon (n, 2) that what lies under it shines through."""

    corners_mm: Array
    colour: str
    alpha: float
    edged: bool = False
    label: str = ""
    order: int = 2


@dataclass(frozen=True, slots=True)
class Caption:
    """Words that begin beside a place, or have it in their middle; in a white ring if that is asked for."""

    place_mm: Place
    text: str
    size_pt: float
    colour: str = BLACK
    offset_pt: Place = (0.0, 0.0)
    ring: str = ""  # its colour
    centred: bool = False


@dataclass(frozen=True, slots=True)
class Colours:
    """A scale of colours from 0 to the largest value, and what the values are."""

    colours: Sequence[str]
    largest: float
    label: str


Shape = Polyline | Spot | TintedArea
Mark = Shape | Caption


@dataclass(slots=True)
class Plate:
    """A part of the sheet with axes round it, and all that is drawn on it."""

    view: View
    title: str = ""
    title_pt: float = TITLE_PT
    numbers_pt: float = TITLE_PT  # along the axes
    most_numbers: int | None = None  # along an axis; None: as many as there is room for
    names: tuple[str, str] | None = ("X, mm", "Y, mm")  # of the axes
    ground: Ground | None = None
    marks: list[Mark] = field(default_factory=list)

    def add(self, *marks: Mark) -> None:
        """Draw these too."""
        self.marks.extend(marks)

    @property
    def lowest_first(self) -> list[Shape]:
        """All marks but words, those that lie below others first."""
        marks: list[Shape] = [mark for mark in self.marks if not isinstance(mark, Caption)]
        return sorted(marks, key=lambda mark: mark.order)

    @property
    def words(self) -> list[Caption]:
        """All words: they lie on top."""
        return [mark for mark in self.marks if isinstance(mark, Caption)]

    @property
    def legend(self) -> list[Shape]:
        """The marks that have a label."""
        return [mark for mark in self.marks if not isinstance(mark, Caption) and mark.label]


def fitted(view: View, height_to_width: float) -> View:
    """A view as wide as it must be for axes of a shape: both axes have one scale."""
    left, right, low, high = view
    wide = max(right - left, (high - low) / height_to_width)
    tall = wide * height_to_width
    x = (left + right) / 2
    y = (low + high) / 2
    return x - wide / 2, x + wide / 2, y - tall / 2, y + tall / 2


def shades(colours: Sequence[str], count: int) -> list[int]:
    """So many colours 0xrrggbb, evenly from the first of some #rrggbb to the last."""
    known = np.array([int(colour[1:], 16) for colour in colours])
    at = np.linspace(0, len(known) - 1, count)
    index = np.arange(len(known))
    mixed = [
        np.interp(at, index, known >> shift & 255).round().astype(int) for shift in (16, 8, 0)
    ]
    return [int(red << 16 | green << 8 | blue) for red, green, blue in zip(*mixed, strict=True)]


def with_gaps(runs: Sequence[Array]) -> Array:
    """Several polylines as one, with gaps between them."""
    gap = np.full((1, 2), np.nan)
    return np.vstack([part for run in runs for part in (gap, run)][1:])


def filled_in(places: Array, apart: float) -> Array:
    """The places (n, 2) of a line, and more on it where two are further apart; gaps are left out."""
    steps = np.hypot(*np.diff(places, axis=0).T)
    parts = [places[np.isfinite(places).all(axis=1)]]
    for k in np.flatnonzero(steps > apart):
        parts.append(np.linspace(places[k], places[k + 1], int(steps[k] / apart) + 2))
    return np.vstack(parts)


def free_corner(plate: Plate, share: tuple[float, float]) -> tuple[bool, bool]:
    """The corner of a plate, of so much of its width and height, in which the fewest places lie: whether it
    is an upper one, and a right one. Of equal ones the upper right is the first.
    """
    places = _in_corners(plate, share)
    return min(places, key=lambda corner: places[corner])


def has_free_corner(plate: Plate, share: tuple[float, float]) -> bool:
    """Whether a legend of so much of a plate's width and height hides nothing in one of its corners."""
    return min(_in_corners(plate, share).values()) == 0


def _in_corners(plate: Plate, share: tuple[float, float]) -> dict[tuple[bool, bool], int]:
    """How many places lie in each corner of a plate: an upper one or not, a right one or not."""
    left, right, low, high = plate.view
    apart_mm = 0.25 * min(share) * min(right - left, high - low)
    lines = [mark for mark in plate.marks if isinstance(mark, Polyline)]
    marked = [filled_in(line.places_mm, apart_mm) for line in lines]
    marked += [np.array([spot.place_mm]) for spot in plate.marks if isinstance(spot, Spot)]
    places = np.vstack([np.empty((0, 2)), *marked])
    x = (places[:, 0] - left) / (right - left)
    y = (places[:, 1] - low) / (high - low)
    aside = {True: x > 1 - share[0], False: x < share[0]}
    level = {True: y > 1 - share[1], False: y < share[1]}
    corners = [(is_upper, is_right) for is_upper in (True, False) for is_right in (True, False)]
    return {corner: int(np.sum(level[corner[0]] & aside[corner[1]])) for corner in corners}
