"""Rim bays: a stretch of a closed line laid within the rim of its ink, however long and of whatever shape.

    ──╮ ╭──     a stalk, a slit: two sides that run together over many widths, straight or bent; on one side
      │ │       of the line the rim of its ink is as clear as that of any other
      ╰─╯

Signals: the ink about a stretch, and the stretch, in; the ways within the rims of its ink from its first
place to its last out.

Source: our own (see `ink.rim`). Questions: that the bar is two lines and not a broad one its ink does not
tell, where the sides touch; on a drawing of one pen it is two.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.crossings import crossings_of
from morfax.motion.neighbours import Neighbours
from morfax.motion.polyline import (
    area_mm2,
    between_corners,
    evenly,
    length_mm,
    lengths_mm,
    nearest_mm,
    plain,
    turned_rad,
)
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.ink.rim import RimCorners, felt_rim
from morfax.tracer.limits import ABOUT_WIDTHS, AS_WIDE, CLEAR_WIDTHS
from morfax.tracer.program.against_ink.off_ink import ink_about
from morfax.tracer.program.against_ink.window import SheetWindow, view_about
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import LEGS
from morfax.tracer.program.lines.selection import lines_of
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles.beside_itself import partners

# In widths of the pen:
NEAR = 1.0  # from an end of the stretch to the rim's way
ASIDE = 0.2  # the same, where both run side by side
LONGER = 1.5  # than the stretch: a way that is not goes along no bay
BENT = 0.1  # from a polygon: a way that is so near to one turns as that does
LOOP = 2.0  # of the way: a longer loop at a crossing is none of a narrow end
OPEN = 0.2  # between its sides: a way with less runs out and back along one line, ...
BACK = 1.5  # ... if it does so for half as long: a tip of 15 degrees comes as near to itself


def rim_bays(setup: Setup, width_mm: float, own: Array, beyond: Array) -> Iterator[LaidWay]:
    """Those ways within the rims of the ink about a stretch (n, 2) mm and what belongs to it (m, 2) mm, from
    its first place to its last, that are longer than the stretch or turn less, and go nowhere out and back
    along one line.
    """
    for bay in ways_within_rims(setup, width_mm, own, beyond):
        if _is_bay(bay.way, own, width_mm):
            yield bay


def ways_within_rims(
    setup: Setup, width_mm: float, own: Array, beyond: Array
) -> Iterator[LaidWay]:
    """The ways of a pen of a width within the rims of the ink about a stretch (n, 2) mm and what belongs to
    it (m, 2) mm, from its first place to its last, that do not cross themselves.
    """
    half_mm, about = 0.5 * width_mm, np.vstack([own, beyond])
    # the rims are about the outlines, and these about the stretch
    aperture_mm, reach_mm = setup.settings.aperture_mm, 2 * ABOUT_WIDTHS * width_mm
    view = view_about(setup.sheet, aperture_mm, width_mm, about, reach_mm)
    for outline in _outlines(setup.sheet.drawing, about, width_mm):
        if nearest_mm(own[[0, -1]], outline).max() > NEAR * width_mm:
            continue
        rim = felt_rim(view, outline)
        if rim is None:
            continue
        within = _likest(setup.sheet.drawing, rim.corners(half_mm), width_mm)
        for way in _between(within, own, width_mm):
            if not len(crossings_of(way, np.arange(len(way) - 1))):
                yield LaidWay(tuple(between_corners(way)), half_mm)


def _likest(drawing: Drawing, corners: RimCorners, width_mm: float) -> Array:
    """The way of a pen of a width within a rim, with its corners as their ink has them."""
    if not len(corners.at):
        return corners.way
    ink = ink_about(drawing, corners.middles_mm, width_mm, CLEAR_WIDTHS)

    def left(way: Array) -> Array:
        return ink.left_at(ink.drawn_along(way, 0.5 * width_mm) - ink.darkness)

    return corners.likest(ink.places_mm, left, CLEAR_WIDTHS * width_mm)


def within_outer_rims(setup: Setup, width_mm: float, own: Array) -> Iterator[Array]:
    """The closed ways (n, 2) mm of a pen of a width within the rims of the ink along a way (n, 2) mm; where
    one of these turns towards the ink, its way is that within another.
    """
    aperture_mm, reach_mm = setup.settings.aperture_mm, 2 * ABOUT_WIDTHS * width_mm
    view, near = view_about(setup.sheet, aperture_mm, width_mm, own, reach_mm), Neighbours(own)
    within = [
        rim.corners(0.5 * width_mm)
        for outline in _outlines(setup.sheet.drawing, own, width_mm)
        if np.isfinite(near.nearest(outline, NEAR * width_mm)[0]).any()
        and (rim := felt_rim(view, outline)) is not None
    ]
    for k, corners in enumerate(within):
        others = [other.way for n, other in enumerate(within) if n != k]
        yield corners.over_to(others, ASIDE * width_mm)


def _outlines(drawing: Drawing, about: Array, width_mm: float) -> Iterator[Array]:
    """The outlines (n, 2) mm of the ink about some places, with the ink to their left."""
    window = SheetWindow.about(drawing, about, ABOUT_WIDTHS * width_mm)
    ink = np.asarray(window.of(drawing.darkness), float) > INK
    padded = np.pad(ink.astype(np.uint8), 1)
    found, tree = cv2.findContours(padded, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    for outline, (_, _, _, around) in zip(found, tree[0] if len(found) else (), strict=True):
        column, row = outline[:, 0].T - 1
        places = np.column_stack(window.place_mm(column, row))
        is_hole = around >= 0
        yield places if (area_mm2(places) > 0) != is_hole else places[::-1]


def _between(way: Array, own: Array, width_mm: float) -> Iterator[Array]:
    """The parts of a closed way on either side of a stretch (n, 2) mm, from its first place to its last; to
    these places.
    """
    ends, steps = own[[0, -1]], own[[1, -1]] - own[[0, -2]]
    ahead = np.roll(way, -1, axis=0) - np.roll(way, 1, axis=0)
    for side in (1, -1):  # on its left the way comes back: the ink is to the left of that
        at = list[int]()
        for end, step in zip(ends, steps, strict=True):
            away_mm = np.where(side * (ahead @ step) > 0, np.hypot(*(way - end).T), math.inf)
            at.append(int(np.argmin(away_mm)))
        if np.hypot(*(way[at] - ends).T).max() < ASIDE * width_mm:
            count = (side * (at[1] - at[0])) % len(way)
            if not count:
                continue  # both ends are nearest to one place: it goes nowhere
            part = way[(at[0] + side * np.arange(count + 1)) % len(way)]
            yield with_corners_for_loops(
                to_ends(part, ends, LEGS[0] * width_mm), LOOP * width_mm
            )


def to_ends(way: Array, ends: Array, leg_mm: float) -> Array:
    """A way (n, 2) mm that comes to two places over a leg at each of its ends."""
    come_mm = lengths_mm(way)
    leg_mm = min(leg_mm, 0.4 * float(come_mm[-1]))
    near_first = np.clip(1 - come_mm / leg_mm, 0, 1)[:, None]
    near_last = np.clip(1 - (come_mm[-1] - come_mm) / leg_mm, 0, 1)[:, None]
    return np.asarray(way + near_first * (ends[0] - way[0]) + near_last * (ends[1] - way[-1]))


def with_corners_for_loops(way: Array, most_mm: float) -> Array:
    """A way (n, 2) mm with a corner in place of loops no longer than that: within a round end as narrow as
    the pen the way comes to a point, and past it.
    """
    pieces = crossings_of(way, np.arange(len(way) - 1))
    come_mm, kept, at = lengths_mm(way), list[Array](), 0
    for first, last in sorted(np.sort(pieces, axis=1).tolist()):
        i, j = int(first), int(last)
        if i < at or come_mm[j] - come_mm[i] > most_mm:
            continue
        kept += [way[at : i + 1], (way[i] + (first - i) * (way[i + 1] - way[i]))[None]]
        at = j + 1
    return np.vstack([*kept, way[at:]])


def turned_less_rad(way: Array, own: Array, width_mm: float) -> float:
    """By how much less a way turns in all than a stretch; 0 if it does so by less than a corner."""
    turned = [turned_rad(plain(each, BENT * width_mm)) for each in (way, own)]
    less_rad = turned[1] - turned[0]
    return less_rad if less_rad > math.pi / 2 else 0.0


def _is_bay(way: Array, own: Array, width_mm: float) -> bool:
    """Whether a way is longer than a stretch, or turns less, and goes nowhere out and back along one line."""
    is_other = length_mm(way) > length_mm(own) + LONGER * width_mm
    is_other = is_other or turned_less_rad(way, own, width_mm) > 0
    return is_other and not runs_back(way, width_mm)


def runs_back(way: Array, width_mm: float) -> bool:
    """Whether a way (n, 2) mm goes out along a line, and back along the same one."""
    step_mm = STEP_WIDTHS * width_mm
    apart = round(BACK / STEP_WIDTHS)
    return bool((partners(evenly(way, step_mm), OPEN * width_mm, apart) >= 0).any())


def is_a_pen(sheet: Sheet, broad_mm: float) -> bool:
    """Whether a line of the sheet is about so broad."""
    shares = sheet.widths_mm[lines_of(sheet)] / broad_mm
    return bool(np.any(np.abs(shares - 1) < AS_WIDE))
