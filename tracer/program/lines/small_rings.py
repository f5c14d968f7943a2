"""Small rings: closed lines of a sheet that are too short or too narrow to be contours.

A letter o and a small hole look alike: outside of all lines what is shorter than a contour is left out (see
`selection`), and so is a small patch on which the head can nowhere be put down, or within which no paper is
seen. But a hole that is left out is missed at the machine, so these are told.

Signals: a Sheet, and contours on which the head could not be put down, in; places and sizes out, mm.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.faults import LineFault
from morfax.motion.median import median
from morfax.tracer.drawing.enclosure import NONE
from morfax.tracer.drawing.holes import holes_in
from morfax.tracer.drawing.inked import is_filled
from morfax.tracer.drawing.inner_rings import LEAST_PX, LEAST_WIDTHS
from morfax.tracer.drawing.lettering import lettering
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.limits import WIDER
from morfax.tracer.marks.sizes import DOT_FULL
from morfax.tracer.program.lines.selection import Contour, lines_of

BROAD = 1.4  # of a line's width: two lines whose ink runs together
# of the square about it: a dot fills more than `DOT_FULL`; what may be a slot, and is one if its ink shows
# the seam between its sides, fills less than this
MAYBE_FILLED = 0.75
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


def small_rings(sheet: Sheet, laid: Collection[int] = ()) -> tuple[SmallPatch, ...]:
    """The closed lines of a sheet that are too short to be contours, no lettering, and no patches that were
    laid; the largest first.
    """
    lines, across_mm = lines_of(sheet), sheet.patches.longer_sides * sheet.drawing.pitch_mm
    small = across_mm > LEAST_WIDTHS * median(sheet.widths_mm[lines])
    small[[*lines, *lettering(sheet), *laid]] = False
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


def filled_up(sheet: Sheet) -> list[int]:
    """The patches of ink inside a line that are too short for one, broader than a line and longer than a dot:
    most likely slots whose sides run together. The largest first.
    """
    small = _small_inside(sheet)
    chosen: list[int] = small[_are_filled_up(sheet, small, BROAD, DOT_FULL)].tolist()
    return chosen


def maybe_slots(sheet: Sheet) -> list[int]:
    """The same of all that may be slots, if their ink shows the seam between two sides."""
    small = _small_inside(sheet)[:MOST_RINGS]
    maybe = _are_filled_up(sheet, small, WIDER, MAYBE_FILLED)
    shows_paper = np.array([paper_within_px(sheet, p) > 0 for p in small.tolist()], bool)
    chosen: list[int] = small[maybe | shows_paper].tolist()
    return chosen


def _are_filled_up(
    sheet: Sheet, small: NDArray[np.int64], broad: float, filled: float
) -> NDArray[np.bool_]:
    """Which patches are so much broader than a line, and fill less of the square about them."""
    if not len(small):
        return np.empty(0, bool)
    squares_px = sheet.patches.longer_sides[small].astype(float) ** 2
    are_broad = sheet.widths_mm[small] > broad * pen_mm(sheet)
    return np.asarray(are_broad & (sheet.patches.areas[small] < filled * squares_px))


def _small_inside(sheet: Sheet) -> NDArray[np.int64]:
    """The patches of ink inside a line that are too short for one, and no letters; the largest first."""
    numbers, patches, none = lines_of(sheet), sheet.patches, np.empty(0, np.int64)
    if not len(numbers):
        return none
    across_px = patches.longer_sides
    least_mm = LEAST_WIDTHS * pen_mm(sheet)
    small = (across_px * sheet.drawing.pitch_mm > least_mm) & ~sheet.are_solid
    small[[*numbers, *lettering(sheet)]] = False
    if not small.any():
        return none
    are_lines = np.zeros(patches.count, bool)
    are_lines[numbers] = True
    inside = patches.enclosure.inside
    small &= (inside != NONE) & are_lines[inside]
    chosen = np.flatnonzero(small)
    return np.asarray(chosen[np.argsort(-across_px[chosen], kind="stable")])


def unclear_patches(sheet: Sheet, contours: Sequence[Contour]) -> tuple[SmallPatch, ...]:
    """The patches of contours on which the head could not be put down; the largest first."""
    patches = (SmallPatch.of(sheet, contour.stroke.patch) for contour in contours)
    return tuple(sorted(patches, key=lambda patch: -patch.across_mm))


def none_begun(unclear: Sequence[SmallPatch]) -> LineFault:
    """The fault of a sheet on which no line can be begun, with the patches that were left out."""
    filled = next((patch for patch in unclear if patch.is_filled), None)
    if filled is None:
        return LineFault(
            "no line can be begun: the ink on the sheet is too short, or is letters; give --start X,Y at a "
            "plain stretch, or, if dots are to be drilled, the --line-width of their pen"
        )
    x, y = filled.place_mm
    return LineFault(
        f"no line can be begun: what is on the sheet is filled shapes (the largest, {filled.across_mm:.1f} "
        f"mm across, at {x:.1f},{y:.1f} mm); --edge follows their outlines"
    )


def paper_within_px(sheet: Sheet, patch: int) -> int:
    """The largest area of paper that a patch of ink goes round, pixels."""
    return max((hole.paper_px for hole in holes_in(sheet.patches, patch)), default=0)
