"""Several contours of one drawing: which lines, which of them lie inside which, and in what order they are
cut. Plans only, never the path.

Signals: a Drawing and what is asked for ("all", "outer" or numbers) in; contours out, each a stroke of ink
with its number. Then the places where the followed lines begin and end, and which lie inside which, in; the
order out (all mm on the sheet).

    ┌───────────────┐        numbers: 1 is the longest line, then as they get shorter
    │  ( 2 )   ( 3 )│        order: 2, 3, 1: what lies inside is cut first, as what lies outside
    └─────── 1 ─────┘        comes loose when it is cut; the idle way is 2 → 3 → 1

Order: from each of several first lines always on to the nearest that may be cut, and back from each of
several last ones; then, as long as it makes the idle way shorter and keeps inner before outer, a stretch of
the order is turned round, or up to three lines are moved elsewhere. Where the first line is does not count:
the tool stands at clearance there when the program begins.

Source: patent ES 361967 has one contour to a tape; several are our own. Improving by turning stretches round
is Croes, Operations Research 6 (1958); by moving short stretches, Or (1976).

Questions: what is a line and what a speck, a letter or a burr? A patch of ink shorter than 4 mm, or than six
of its widths, is none unless it reaches over 12 mm: the hole of 2 mm that is drawn with 0.8 mm has 6.3 mm and
eight widths, and a long line that runs into a blot has a large mean width. A larger letter is a line, and is
left out by asking for the others by number.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.motion.nesting import lies_inside
from morfax.tracer.drawing.strokes import Sheet, Stroke

Which = str | tuple[int, ...]  # "all", "outer", or the numbers of lines

LEAST_MM, LEAST_WIDTHS = 4.0, 6.0  # a shorter patch is a speck, a letter or a burr,
LETTER_MM = 12.0  # unless it reaches as far as this
# ink about a place of a plain stretch differs by less than this share from what is usual on the line
PLAIN = 0.06
STARTS = 8  # places at which the head may be put down on a line
LOOKED_AT = 400  # places of a line that are looked at for them
COVERED = 0.8  # a stroke is a part of a followed line if as much of it lies on that line


@dataclass(frozen=True, slots=True)
class Contour:
    """A line that is asked for: its number, its stroke of ink, and how far it reaches in X or Y."""

    number: int
    stroke: Stroke
    reach_mm: float

    def starts_mm(self) -> list[tuple[float, float]]:
        """Places to put the head down, the plainest first: those furthest from corners, crossings and ends; a
        few, apart.
        """
        stroke = self.stroke
        some = slice(None, None, max(1, len(stroke.middles_mm) // LOOKED_AT))
        places, filled = stroke.middles_mm[some], stroke.filled[some]
        odd = places[np.abs(filled / np.median(filled) - 1) > PLAIN]
        clear_mm = _nearest_mm(places, odd) if len(odd) else np.zeros(len(places))
        kept: list[Array] = []
        for place in places[np.argsort(-clear_mm, kind="stable")]:
            if len(kept) < STARTS and all(
                np.hypot(*(place - k)) > 4 * stroke.width_mm for k in kept
            ):
                kept.append(place)
        return [(float(x), float(y)) for x, y in kept]

    def lies_on(self, line_mm: Array) -> bool:
        """Whether a followed line (n, 2) mm runs along most of this stroke, as it does along a line with
        gaps.
        """
        places = self.stroke.middles_mm[:: max(1, len(self.stroke.middles_mm) // 40)]
        near = (places > line_mm.min(axis=0) - 1) & (places < line_mm.max(axis=0) + 1)
        if near.all(axis=1).mean() < COVERED:
            return False
        return bool(np.mean(_nearest_mm(places, line_mm) < self.stroke.width_mm) > COVERED)

    def lies_in(self, line_mm: Array) -> bool:
        """Whether this stroke lies inside a followed line (n, 2) mm."""
        return lies_inside(self.stroke.middles_mm, line_mm)


def plan(sheet: Sheet, which: Which) -> tuple[list[Contour], int]:
    """Contours that are asked for, the widest spread first (so none comes before one that it lies in), and
    how many patches are too short.

    "outer" is still all of them: what lies inside which is known when they have been followed. Raises
    LineFault for a number that no line has.
    """
    reach_mm, patches = _reach_mm(sheet), lines_of(sheet)
    numbers = _numbers(which, len(patches))
    asked = [int(patches[number - 1]) for number in numbers]
    contours = [
        Contour(n, sheet.stroke(p), float(reach_mm[p]))
        for n, p in zip(numbers, asked, strict=True)
    ]
    spread = [
        float(np.prod(np.ptp(c.stroke.middles_mm, axis=0) + c.stroke.width_mm))
        for c in contours
    ]
    return [contours[i] for i in np.argsort(spread)[::-1]], sheet.patches.count - len(patches)


def lines_of(sheet: Sheet) -> NDArray[np.int64]:
    """The patches that are lines, the longest first: of those along edges all."""
    least_mm = (
        0.0 if sheet.drawing.edges_mm else np.maximum(LEAST_MM, LEAST_WIDTHS * sheet.widths_mm)
    )
    long_enough = sheet.lengths_mm >= least_mm
    patches = np.flatnonzero(long_enough | (_reach_mm(sheet) >= LETTER_MM))
    return patches[np.argsort(-sheet.lengths_mm[patches], kind="stable")]


def _reach_mm(sheet: Sheet) -> Array:
    """How far each patch reaches in X or Y, mm."""
    return np.asarray(sheet.patches.longer_sides * sheet.drawing.pitch_mm)


def _numbers(which: Which, lines: int) -> list[int]:
    """Numbers of the lines to follow; raises LineFault for one that there is not."""
    if isinstance(which, str):
        if which not in ("all", "outer"):
            raise ValueError(f"{which!r} names no lines; give 'all', 'outer', or their numbers")
        return list(range(1, lines + 1))
    numbers = sorted(set(which))
    for number in numbers:
        if not 1 <= number <= lines:
            raise no_line(number, range(1, lines + 1))
    return numbers


def no_line(number: int, have: Sequence[int]) -> LineFault:
    """The fault of a number that no line has, with those that there are."""
    lines = f"{'line' if len(have) == 1 else 'lines'} {_told(have)}" if have else "none"
    return LineFault(
        f"no line {number}: the drawing has {lines}, numbered from the longest on (no specks, letters, pieces of a line with gaps);"
        " give --lines all and a --picture to see them"
    )


def _told(numbers: Sequence[int]) -> str:
    """Numbers as people read them, "1 to 3, 5"."""
    runs = [
        [n for _, n in run]
        for _, run in groupby(enumerate(sorted(numbers)), key=lambda at: at[1] - at[0])
    ]
    return ", ".join(
        f"{run[0]} to {run[-1]}" if len(run) > 2 else ", ".join(map(str, run)) for run in runs
    )


def _nearest_mm(places_mm: Array, others_mm: Array) -> Array:
    """Distance of each place from the nearest of others, mm."""
    return np.array([np.hypot(*(others_mm - place).T).min() for place in places_mm])
