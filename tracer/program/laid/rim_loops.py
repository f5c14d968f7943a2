"""Rim loops: a closed line of any shape whose sides run together, laid within the rim of its ink.

    ╭──╮        an arc, a hook, a wave: what a compass does not draw (see `tangles.compass`), and the head
    ╰─╮╰────╮   does not follow, since between the sides its cells see little paper or none
      ╰─────╯

Signals: a patch of ink of a sheet in; the way within its rim as a core for the compass out, or none.

Source: our own (see `ink.rim`).
"""

from __future__ import annotations

from itertools import islice

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.tracer.drawing.inner_rings import LEAST_PX
from morfax.tracer.drawing.narrow import LONG_WIDTHS
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.plain_places import places_of, plainest_first
from morfax.tracer.ink.rim import felt_rim
from morfax.tracer.limits import AS_WIDE
from morfax.tracer.program.against_ink.window import view_about
from morfax.tracer.program.lines.selection import lines_of
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.compass import Core

# of the ink and what lies within it, in widths of the pen: one line is 1 broad, two that touch are 2; sides
# that are further apart the head follows as any line
BROAD = 1.6, 4.2
LONGEST = 800.0  # widths round; chosen
DISTINCT = 0.2  # of a step: places nearer to each other are one corner
FELT_PLACES = 9  # the pen's width is the middle one of so many of the plainest places


def narrow_outline(sheet: Sheet, patch: int, pen_mm: float) -> Array | None:
    """The outline (n, 2) mm of a patch of ink, counter-clockwise, if with what lies within it is about as
    broad as two lines beside each other; None for another.
    """
    if sheet.lengths_mm[patch] > LONGEST * pen_mm:
        return None
    outline = max(_contours(sheet, patch, cv2.RETR_EXTERNAL), key=len)
    area_px2, long_px = cv2.contourArea(outline, True), cv2.arcLength(outline, False)
    # the outline runs through the middles of pixels
    pen_px, broad_px = pen_mm / sheet.drawing.pitch_mm, 2 * abs(area_px2) / max(long_px, 1) + 1
    is_narrow = BROAD[0] < broad_px / pen_px < BROAD[1] and long_px < LONGEST * pen_px
    if not is_narrow:
        return None
    return _places_mm(sheet, patch, outline)[:: -1 if area_px2 > 0 else 1]  # rows go down


def outlines_of(sheet: Sheet, patch: int) -> list[Array]:
    """The outlines (n, 2) mm of a patch of ink, each with the ink to its left: about all of it, and about the
    areas of paper within it.
    """
    outlines = _contours(sheet, patch, cv2.RETR_CCOMP)
    broad = (o for o in outlines if cv2.contourArea(o) >= LEAST_PX)
    return [_places_mm(sheet, patch, outline) for outline in broad]


def _contours(sheet: Sheet, patch: int, mode: int) -> list[NDArray[np.int32]]:
    """The contours (n, 1, 2) of a patch of ink, columns and rows in its box and a pixel more."""
    top, bottom, left, right = sheet.patches.boxes[patch].tolist()
    ink = sheet.patches.painted(patch, top - 1, bottom + 1, left - 1, right + 1)
    found, _ = cv2.findContours(ink, mode, cv2.CHAIN_APPROX_NONE)
    return [np.asarray(contour, np.int32) for contour in found]


def _places_mm(sheet: Sheet, patch: int, outline: NDArray[np.int32]) -> Array:
    """The places (n, 2) mm of a contour of a patch."""
    top, _, left, _ = sheet.patches.boxes[patch].tolist()
    column, row = outline[:, 0].T.astype(float)
    up = len(sheet.drawing.darkness) - (row - 1 + top) - 0.5
    return np.column_stack([column - 1 + left + 0.5, up]) * sheet.drawing.pitch_mm


def core_within(view: View, outline: Array, width_mm: float) -> Core | None:
    """The way of a pen of a width within the rim that the cells feel about an outline (n, 2) mm."""
    rim = felt_rim(view, outline)
    if rim is None:
        return None
    way = rim.way(0.5 * width_mm)
    apart_mm = np.hypot(*np.diff(way, axis=0, prepend=way[-1:]).T)
    return Core(way[apart_mm > DISTINCT * view.step_mm], 0.0, 0.5 * width_mm)


def felt_pen_mm(sheet: Sheet, aperture_mm: float | None, pen_mm: float) -> float:
    """The pen's width as the cells feel it, where the longest of its lines is plain; they see no more of the
    sheet than a stretch of that.
    """
    lines = lines_of(sheet)
    of_pen = np.abs(sheet.widths_mm[lines] / pen_mm - 1) < AS_WIDE
    stroke = sheet.stroke(int(lines[of_pen][0]) if of_pen.any() else int(lines[0]))
    reach_mm = LONG_WIDTHS * pen_mm
    x, y = stroke.middles_mm[0].tolist()
    places = places_of(stroke, (x, y), reach_mm)
    view = view_about(sheet, aperture_mm, pen_mm, places, reach_mm)
    stances = islice(plainest_first(view, places), FELT_PLACES)
    felt_mm = np.array([stance.view.width_mm for stance in stances])
    return median(felt_mm) if len(felt_mm) else pen_mm
