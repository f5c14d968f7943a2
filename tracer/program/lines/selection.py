"""The selection: which lines of a drawing are asked for, and where the head can be put down on each.

Signals: a Sheet and what is asked for ("contours", "outer" or numbers) in; contours out, each a stroke of ink
with its number (mm on the sheet).

    ┌───────────────┐        numbers: 1 is the longest line, then as they get shorter
    │  ( 2 )   ( 3 )│        the order in which they are cut: see `order`
    └─────── 1 ─────┘

Source: patent ES 361967 has one contour to a tape; several are our own. Questions: what is a line and what a
speck, a letter or a burr? A patch of ink shorter than 4 mm, or than six of its widths, is no line unless it
reaches over 12 mm, or is a ring in a line (see `drawing.inner_rings`): the hole of 2 mm that is drawn with
0.8 mm has 6.3 mm and eight widths, and a long line that runs into a blot has a large mean width. A larger
letter is a line, and is left out by asking for the others by number.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import groupby
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import ROUNDED, Array, bounds
from morfax.motion.faults import LineFault
from morfax.motion.median import median
from morfax.motion.nesting import lies_inside, size_mm
from morfax.motion.polyline import nearest_mm
from morfax.tracer.drawing import lettering
from morfax.tracer.drawing.inner_rings import inner_rings
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.effort import SOME_PLACES
from morfax.tracer.following.line import Line
from morfax.tracer.marks.reference import LARGEST_MM

Which = str | tuple[int, ...]  # "contours", "outer", or the numbers of lines

LEAST_MM, LEAST_WIDTHS = 4.0, 6.0  # a shorter patch is a speck, a letter or a burr, ...
LETTER_MM = lettering.LARGEST_MM  # ... unless it reaches as far as this
# The limits below were chosen by trial on the test drawings.
# the ink about a place of a plain stretch differs by less than this share from the line's usual
PLAIN = 0.06
STARTS = 8  # places at which the head may be put down on a line, ...
STARTS_WIDTHS = 4.0  # ... this far apart
LOOKED_AT = 400  # places of a line that are looked at for them
# of the ink that is joined to it: a shorter run is along another line, which crosses this one
SHORT = 0.5
NEW = 0.6  # a line is new if so much of its way is no other line's
COVERED = 0.8  # a stroke is a part of a followed line if this share of it lies on that line
ABOUT_REFERENCE_MM = 1.0  # ink as far beyond the largest reference point is still a part of it
BESIDE_MM = 1.0  # a stroke further outside a followed line's bounds does not lie on it


@dataclass(frozen=True)
class Contour:
    """A line that is asked for: its number, its stroke of ink, and how far it reaches in X or Y."""

    number: int
    stroke: Stroke
    reach_mm: float

    @cached_property
    def starts_mm(self) -> list[tuple[float, float]]:
        """A few places to put the head down, apart: furthest from corners, crossings and ends first."""
        stroke = self.stroke
        some = slice(None, None, max(1, len(stroke.middles_mm) // LOOKED_AT))
        places, filled = stroke.middles_mm[some], stroke.filled[some]
        odd = places[np.abs(filled / median(filled) - 1) > PLAIN]
        clear_mm = nearest_mm(places, odd) if len(odd) else np.zeros(len(places))
        apart_mm, kept = STARTS_WIDTHS * stroke.width_mm, list[tuple[float, float]]()
        places = places[np.argsort(-clear_mm, kind="stable")]
        while len(places) and len(kept) < STARTS:
            kept.append((float(places[0, 0]), float(places[0, 1])))
            places = places[np.hypot(*(places - places[0]).T) > apart_mm]
        return kept

    def lies_on(self, line_mm: Array) -> bool:
        """Whether a followed line (n, 2) mm runs along most of this stroke, as along a line with gaps."""
        places = self.stroke.middles_mm[:: max(1, len(self.stroke.middles_mm) // SOME_PLACES)]
        low, high = bounds(line_mm)
        within = (places > low - BESIDE_MM) & (places < high + BESIDE_MM)
        if within.all(axis=1).mean() < COVERED:
            return False
        # of a long line only what is near decides
        width_mm, (x, y) = self.stroke.width_mm, line_mm.T
        reach_mm = (1 + ROUNDED) * width_mm
        (left, lowest), (right, highest) = bounds(places)
        near = (x >= left - reach_mm) & (x <= right + reach_mm)
        near &= (y >= lowest - reach_mm) & (y <= highest + reach_mm)
        return bool(np.mean(nearest_mm(places, line_mm[near]) < width_mm) > COVERED)

    def lies_in(self, line_mm: Array) -> bool:
        """Whether this stroke lies inside a followed line (n, 2) mm."""
        return lies_inside(self.stroke.middles_mm, line_mm)


def plan(sheet: Sheet, which: Which) -> tuple[list[Contour], int]:
    """Contours that are asked for, and how many patches are too short.

    The widest spread comes first, so that none comes before one that it lies in. For "outer" it gives all:
    which lies inside which is known when they have been followed. Raises LineFault for a number that no line
    has.
    """
    reach_mm, patches = _reach_mm(sheet), lines_of(sheet)
    contours, spread_mm2 = list[Contour](), list[float]()
    for number in _numbers(which, len(patches)):
        patch = int(patches[number - 1])
        stroke = sheet.stroke(patch)
        contours.append(Contour(number, stroke, float(reach_mm[patch])))
        sides_mm = size_mm(stroke.middles_mm) + stroke.width_mm
        spread_mm2.append(float(np.prod(sides_mm)))
    widest_first = np.argsort(spread_mm2)[::-1]
    return [contours[i] for i in widest_first], sheet.patches.count - len(patches)


def is_shape(sheet: Sheet, contour: Contour, asked: Sequence[Contour]) -> bool:
    """Whether a patch is the rim of a filled shape, and no line; one that goes round lines is lost, not left
    out: an outline that hangs together with a shape is the part's.
    """
    patch = contour.stroke.patch
    if not sheet.are_solid[patch]:
        return False
    lines = [c.stroke.patch for c in asked if not sheet.are_solid[c.stroke.patch]]
    return not np.any(sheet.patches.enclosure.inside[lines] == patch)


class Others(NamedTuple):
    """Further lines of a sheet beside the one that was followed, how many of them lie inside that, and how
    long the longest is, mm.
    """

    lines: int = 0
    inside: int = 0
    longest_mm: float = 0.0


NO_OTHERS = Others()


def lines_of(sheet: Sheet) -> NDArray[np.int64]:
    """The patches that are lines, the longest first; every patch along the edge of a filled shape is one."""
    return sheet.once(_lines)


def _lines(sheet: Sheet) -> NDArray[np.int64]:
    """The same, of a sheet of which it was not asked before."""
    shortest_mm = 0.0 if sheet.drawing.edges_mm else least_mm(sheet.widths_mm)
    are_lines = (sheet.lengths_mm >= shortest_mm) | (_reach_mm(sheet) >= LETTER_MM)
    are_lines[inner_rings(sheet, are_lines)] = True
    return np.asarray(sheet.longest_first(np.flatnonzero(are_lines)), np.int64)


def others_than(sheet: Sheet, line: Line) -> Others:
    """The patches that are lines, are no part of a followed line, and are not the reference point from which
    it begins. The ink in which most of the line runs is told of as the line's own; a patch beyond a gap is a
    part of the line where that runs along most of it.
    """
    numbered = np.zeros(sheet.patches.count, bool)
    numbered[lines_of(sheet)] = True
    runs = np.flatnonzero(numbered[sheet.patches.patch])
    patch, middles_mm = sheet.patches.patch[runs], sheet.run_middles_mm(runs)
    near = nearest_mm(middles_mm, line.places_mm) < sheet.widths_mm[patch]
    ink_px = sheet.patches.end[runs] - sheet.patches.begin[runs]
    along_px = np.bincount(patch[near], ink_px[near], len(numbered))
    others = numbered & (along_px <= COVERED * np.bincount(patch, ink_px, len(numbered)))
    others[along_px.argmax()] &= along_px.max() == 0
    if line.reference_mm is not None:
        for number in np.flatnonzero(others):
            others[number] = not are_about(middles_mm[patch == number], [line.reference_mm])
    patches = np.flatnonzero(others)
    longest_mm = float(sheet.told.lengths_mm[patches].max()) if len(patches) else 0.0
    return Others(len(patches), _inside(sheet, patches, line), longest_mm)


def _inside(sheet: Sheet, patches: NDArray[np.int64], line: Line) -> int:
    """How many patches lie inside a line, by the middles of their boxes; none inside one that is open."""
    if line.is_open:
        return 0
    around = line.loop_mm[:: max(1, len(line.loop_mm) // LOOKED_AT)].astype(np.float32)
    middles_mm = sheet.middles_mm(patches).tolist()
    return sum(cv2.pointPolygonTest(around, (x, y), False) > 0 for x, y in middles_mm)


def are_about(places: Array, references_mm: Iterable[tuple[float, float]]) -> bool:
    """Whether places (n, 2) mm are those of one of some reference points."""
    reach_mm = 0.5 * LARGEST_MM + ABOUT_REFERENCE_MM
    return any(np.hypot(*(places - place_mm).T).max() < reach_mm for place_mm in references_mm)


def least_mm(width_mm: float | Array) -> Array:
    """Ink shorter than this is no line, for a width, mm."""
    return np.maximum(LEAST_MM, LEAST_WIDTHS * np.asarray(width_mm))


def _reach_mm(sheet: Sheet) -> Array:
    """How far each patch reaches in X or Y, mm."""
    return np.asarray(sheet.patches.longer_sides * sheet.drawing.pitch_mm)


def _numbers(which: Which, lines: int) -> list[int]:
    """Numbers of the lines to follow; raises LineFault for a number that no line has."""
    if isinstance(which, str):
        if which not in ("contours", "outer"):
            raise ValueError(
                f"{which!r} names no lines; give 'contours', 'outer', or their numbers"
            )
        return list(range(1, lines + 1))
    numbers = sorted(set(which))
    for number in numbers:
        if not 1 <= number <= lines:
            raise no_line(number, range(1, lines + 1))
    return numbers


def no_line(number: int, have: Sequence[int]) -> LineFault:
    """The fault of a number that no line has, with the numbers that lines have."""
    lines = f"{'line' if len(have) == 1 else 'lines'} {_listed(have)}" if have else "none"
    return LineFault(
        f"no line {number}: the drawing has {lines}, numbered from the longest on (no specks, letters, pieces"
        " of a line with gaps); give --lines contours and a --picture to see them"
    )


def _listed(numbers: Sequence[int]) -> str:
    """Numbers as people read them, "1 to 3, 5"."""
    runs = list[str]()
    for _, group in groupby(enumerate(sorted(numbers)), key=lambda at: at[1] - at[0]):
        run = [number for _, number in group]
        runs.append(f"{run[0]} to {run[-1]}" if len(run) > 2 else ", ".join(map(str, run)))
    return ", ".join(runs)


def a_letter(contour: Contour) -> LineFault:
    """The fault of a patch that was asked for by number, and on which the head can nowhere be put down."""
    x, y = contour.stroke.middles_mm.mean(axis=0)
    return LineFault(
        f"line {contour.number}, about {x:.1f},{y:.1f} mm, is taken for a letter: the head can be put down"
        " nowhere on it; give the other numbers, or --start X,Y at a plain stretch of it",
        x_mm=float(x),
        y_mm=float(y),
    )


def with_least_numbers(lines: list[Line], asked: list[Contour]) -> list[Line]:
    """The lines, each of several patches by the least of their numbers: which of equal pieces of a line with
    gaps was followed first is chance.
    """
    taken = {line.number for line in lines}
    numbered = list[Line]()
    for line in lines:
        pieces = [
            contour.number
            for contour in asked
            if contour.number < line.number
            and contour.number not in taken
            and contour.lies_on(line.places_mm)
        ]
        numbered.append(replace(line, number=min(pieces)) if pieces else line)
        taken.add(numbered[-1].number)
    return numbered
