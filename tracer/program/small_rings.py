"""Small rings: closed lines of a sheet that are too short or too narrow to be contours.

A letter o and a small hole look alike: outside of all lines what is shorter than a contour is left out (see
`selection`), and so is a small patch on which the head can nowhere be put down, or within which no paper is
seen. But a hole that is left out is missed at the machine, so these are told.

Signals: a Sheet, and contours on which the head could not be put down, in; places and sizes out, mm.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.median import median
from morfax.tracer.drawing.enclosure import NONE
from morfax.tracer.drawing.holes import holes
from morfax.tracer.drawing.inked import is_filled
from morfax.tracer.drawing.inner_rings import LEAST_PX, LEAST_WIDTHS
from morfax.tracer.drawing.lettering import lettering
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.program.selection import Contour, lines_of

BROAD = 1.4  # of a line's width: two lines whose ink runs together
FILLED = 0.65  # of the square about it: a dot fills 0.79
# the same of what may be a slot, if its ink shows the seam between its sides
MAYBE_BROAD, MAYBE_FILLED = 1.15, 0.75
MOST_RINGS = 500  # patches that are looked at, the largest first: sheets of text have thousands


class SmallPatch(NamedTuple):
    """Ink that is left out: its middle, how far it reaches across, mm, and whether it is a filled shape."""

    place_mm: tuple[float, float]
    across_mm: float
    is_filled: bool = False

    @classmethod
    def of(cls, sheet: Sheet, patch: int) -> SmallPatch:
        """A patch of ink of a sheet."""
        top, bottom, left, right = sheet.patches.boxes[patch].tolist()
        rows, pitch_mm = sheet.drawing.darkness.shape[0], sheet.drawing.pitch_mm
        middle_mm = 0.5 * (left + right) * pitch_mm, (rows - 0.5 * (top + bottom)) * pitch_mm
        across_mm = max(bottom - top, right - left) * pitch_mm
        return cls(middle_mm, across_mm, is_filled(sheet.drawing, sheet.patches, patch))


def small_rings(sheet: Sheet) -> tuple[SmallPatch, ...]:
    """The closed lines of a sheet that are too short to be contours, and no lettering; the largest first."""
    lines, across_mm = lines_of(sheet), sheet.patches.longer_sides * sheet.drawing.pitch_mm
    small = across_mm > LEAST_WIDTHS * median(sheet.widths_mm[lines])
    small[[*lines, *lettering(sheet)]] = False
    chosen = np.flatnonzero(small)
    chosen = chosen[np.argsort(-across_mm[chosen], kind="stable")][:MOST_RINGS]
    rings = [p for p in chosen.tolist() if paper_within_px(sheet, p) >= LEAST_PX]
    return tuple(SmallPatch.of(sheet, patch) for patch in rings)


def pen_mm(sheet: Sheet) -> float:
    """The width of the lines along half of a sheet's ink."""
    lines = lines_of(sheet)
    order = np.argsort(sheet.widths_mm[lines], kind="stable")
    come_mm = np.cumsum(sheet.lengths_mm[lines][order])
    return float(sheet.widths_mm[lines][order][np.searchsorted(come_mm, 0.5 * come_mm[-1])])


def filled_up(sheet: Sheet, broad: float = BROAD, filled: float = FILLED) -> list[int]:
    """The patches of ink inside a line that are too short for one, broader than a line and longer than a dot:
    most likely slots whose sides run together. The largest first.
    """
    numbers, patches = lines_of(sheet), sheet.patches
    if not len(numbers):
        return []
    across_px, wide_mm = patches.longer_sides, pen_mm(sheet)
    small = (sheet.widths_mm > broad * wide_mm) & (patches.areas < filled * across_px**2)
    small &= (across_px * sheet.drawing.pitch_mm > LEAST_WIDTHS * wide_mm) & ~sheet.are_solid
    small[[*numbers, *lettering(sheet)]] = False
    if not small.any():
        return []
    are_lines = np.zeros(patches.count, bool)
    are_lines[numbers] = True
    inside = patches.enclosure.inside
    small &= (inside != NONE) & are_lines[inside]
    chosen = np.flatnonzero(small)
    largest_first = chosen[np.argsort(-across_px[chosen], kind="stable")]
    return [int(patch) for patch in largest_first]


def unclear_patches(sheet: Sheet, contours: Sequence[Contour]) -> tuple[SmallPatch, ...]:
    """The patches of contours on which the head could not be put down; the largest first."""
    patches = (SmallPatch.of(sheet, contour.stroke.patch) for contour in contours)
    return tuple(sorted(patches, key=lambda patch: -patch.across_mm))


def paper_within_px(sheet: Sheet, patch: int) -> int:
    """The largest area of paper that a patch of ink goes round, pixels."""
    top, bottom, left, right = sheet.patches.boxes[patch].tolist()
    own: NDArray[np.bool_] = np.zeros(sheet.patches.count, bool)
    own[patch] = True
    ink = sheet.patches.painted(own, top, bottom, left, right)
    return max((hole.paper_px for hole in holes(ink)), default=0)
