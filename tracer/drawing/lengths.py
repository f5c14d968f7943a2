"""Lengths: how long the lines of a sheet are, by the ink of each patch.

    length = area of the patch over the width of its line; less the two round ends of an open line, which
             are ink beyond its length

All lines that one pen may have drawn have one width: a scan measures a width of three pixels a little
differently at each angle. The depth of pixels, by which patches have their widths, makes a slanting line up
to half a pixel too narrow, and so up to a tenth too long; a line along the pixels is whole pixels wide, and
so up to a tenth too short or too long. That is near enough to put lines in order. Whoever reads of a length
is told it by areas whose edges lie between pixels, where the darkness crosses that of an edge,

            area = pixels + sum over neighbours, ink and paper, of (part of the step up to the edge - 1/2)
                            times the share that the step's direction has in the slope there (cosine squared)

and by the width that profiles across the lines show: of the patch itself if enough of them cross it, else of
all that one pen may have drawn. An edge of a filled shape is told by its own places.

Signals: a sheet's patches of ink in; their lengths, mm, out.

Source: our own. Questions: the ink of a net's junctions counts once, so that a net is told a little short.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.median import median
from morfax.motion.plane import left_of
from morfax.motion.polyline import length_mm
from morfax.tracer.drawing.components import INK, runs_at, strips
from morfax.tracer.drawing.profiles import (
    FEWEST_PROFILES,
    STEP_PX,
    Profiles,
    profiles_of,
    seen_across,
)
from morfax.tracer.drawing.tiles import Kept
from morfax.tracer.limits import ROUND

if TYPE_CHECKING:
    from morfax.tracer.drawing.strokes import Sheet

# lines whose widths are within this share of the usual width are one pen's; by trial
ONE_PEN = 0.3
PIXELS_OFF = 0.1  # share by which lengths by whole pixels are off: a line along them is three wide at least
# two profiles are turned by so much to both sides; by less, and noise is their difference
ASIDE = math.radians(25)
PARTS = 8  # of a step between two samples of a profile: a sixteenth of a pixel


class Told(NamedTuple):
    """Lengths and widths of a sheet's patches as lines, mm."""

    lengths_mm: Array
    widths_mm: Array


def one_pen_mm(sheet: Sheet) -> Array:
    """Lengths of the patches, mm, by one width for all that one pen may have drawn."""
    return sheet.lengths_mm * sheet.widths_mm / _pens_mm(sheet)


def told(sheet: Sheet) -> Told:
    """Lengths of the patches as a reader is told them, true to 1.5 % (of three pixels to 2 %); widths."""
    if sheet.drawing.edges_mm:
        return Told(_of_edges_mm(sheet), sheet.widths_mm)
    (pens_mm, widths_mm), pitch_mm = _seen_mm(sheet), sheet.drawing.pitch_mm
    # areas less wide than the line are flaws of its ink
    is_open = sheet.patches.enclosure.loops((sheet.widths_mm / pitch_mm) ** 2) == 0
    lengths_mm = pitch_mm**2 * _areas_px(sheet) / pens_mm - is_open * ROUND * pens_mm
    return Told(np.maximum(lengths_mm, pens_mm), widths_mm)  # a dot is as long as it is wide


def _of_edges_mm(sheet: Sheet) -> Array:
    """Lengths of the patches along edges of filled shapes, mm: the picture shows the edges themselves."""
    edges = sheet.drawing.edges_mm
    patches = [sheet.patch_at(edge[0]) for edge in edges]
    lengths_mm = [length_mm(edge) for edge in edges]
    return np.asarray(np.bincount(patches, lengths_mm, sheet.patches.count), float)


def _usual_mm(sheet: Sheet) -> float:
    """The width that half of all ink has or less, mm."""
    areas_mm2 = sheet.lengths_mm * sheet.widths_mm
    order = np.argsort(sheet.widths_mm)
    sums = np.cumsum(areas_mm2[order])
    return float(sheet.widths_mm[order[np.searchsorted(sums, 0.5 * sums[-1])]])


def _is_one_pen(widths_mm: Array, usual_mm: float) -> NDArray[np.bool_]:
    """Which widths may be those of the pen that has drawn most."""
    return np.abs(widths_mm / usual_mm - 1) < ONE_PEN


def _pens_mm(sheet: Sheet) -> Array:
    """The width of each patch's pen, mm."""
    usual_mm = _usual_mm(sheet)
    return np.where(_is_one_pen(sheet.widths_mm, usual_mm), usual_mm, sheet.widths_mm)


def _seen_mm(sheet: Sheet) -> tuple[Array, Array]:
    """The widths of the patches' pens, and of their lines: a patch's own width if enough profiles cross it,
    else that of one pen, and that by its depths.
    """
    pens_mm, widths_mm = _pens_mm(sheet), sheet.widths_mm.copy()
    profiles = profiles_of(sheet.drawing.darkness)
    if profiles is None:
        return pens_mm, widths_mm
    wide_mm = _wide_px(sheet.drawing.darkness, profiles) * sheet.drawing.pitch_mm
    usual_mm = _usual_mm(sheet)
    usual = wide_mm[_is_one_pen(wide_mm, usual_mm)]
    if len(usual) >= FEWEST_PROFILES:
        pens_mm *= median(usual) / usual_mm
    patch = _patches_at(sheet, profiles.middles)
    count = np.bincount(patch[patch >= 0])
    for own in np.flatnonzero(count >= FEWEST_PROFILES):
        pens_mm[own] = widths_mm[own] = median(wide_mm[patch == own])
    return pens_mm, widths_mm


def _patches_at(sheet: Sheet, places: Array) -> NDArray[np.int64]:
    """The patch of the ink at places (n, 2), rows and columns; -1 on paper."""
    patches = sheet.patches
    rows, columns = np.round(places).astype(int).T
    run = runs_at(patches.row, patches.begin, rows, columns)
    is_ink = (run >= 0) & (patches.row[run] == rows) & (columns < patches.end[run])
    return np.where(is_ink, patches.patch[run], -1)


def _areas_px(sheet: Sheet) -> Array:
    """Areas of the patches with their edges between pixels, in pixels."""
    darkness, patches = sheet.drawing.darkness, sheet.patches
    areas = patches.areas.copy()
    for top, bottom, rows in strips(darkness.shape, halo=1):
        own = patches.runs_between(top, bottom)
        runs = patches.row[own] - rows.start, patches.begin[own], patches.end[own]
        _move_edges(np.asarray(darkness[rows]), *runs, patches.patch[own], areas)
    return areas


@njit(cache=True)
def _move_edges(seen, row, begin, end, patch, areas):  # type: ignore[no-untyped-def]
    """Move the edges of runs of ink of a strip from between pixels to where they are, in the areas."""
    for k in range(len(row)):
        for column in range(begin[k], end[k]):
            for step in (-1, 1):
                areas[patch[k]] += _beyond(seen, row[k], column, 0, step)
                areas[patch[k]] += _beyond(seen, row[k], column, step, 0)


@njit(cache=True)
def _beyond(seen, row, column, down, right):  # type: ignore[no-untyped-def]
    """What the edge lies beyond the middle between a pixel of ink and its neighbour, pixels of area; 0 if
    that is ink, or where noise makes one the other.
    """
    ink, paper = seen[row, column], _at(seen, row + down, column + right)
    if paper <= INK < ink:
        along = ink - paper
        # the slope square to the step, at the middle of both
        aside = 0.0
        for side in (-1, 1):
            for far in (0, 1):
                beside = _at(
                    seen, row + far * down + side * right, column + far * right + side * down
                )
                aside += 0.25 * side * beside
        return ((ink - INK) / along - 0.5) * along * along / (along * along + aside * aside)
    return 0.0


@njit(cache=True)
def _at(seen, row, column):  # type: ignore[no-untyped-def]
    """Darkness of a pixel; beyond the border that of the nearest."""
    return seen[min(max(row, 0), seen.shape[0] - 1), min(max(column, 0), seen.shape[1] - 1)]


def _wide_px(darkness: Kept, profiles: Profiles) -> Array:
    """How wide the lines of profiles (n, k) are square to them, pixels.

    A profile that lies at an angle to the square sees 1/cos of it more. Of two that are turned to both sides
    of it the sum and the difference of 1/width give the two legs of 1/width.
    """
    narrow, along = [], left_of(profiles.across)
    for side in (-1, 1):
        way = math.cos(ASIDE) * profiles.across + side * math.sin(ASIDE) * along
        seen = seen_across(darkness, profiles.middles, way, profiles.at_px)
        narrow.append(1 / np.maximum(_own_px(seen), 1 / PARTS))
    less, more = narrow
    legs = (more + less) / math.cos(ASIDE), (more - less) / math.sin(ASIDE)
    return np.asarray(2 / np.hypot(*legs))


def _own_px(seen: Array) -> Array:
    """How much ink lies about the middles of profiles (n, k), with straight lines between samples, pixels."""
    shares = (np.arange(PARTS) + 0.5) / PARTS
    parts = [(1 - share) * seen[:, :-1] + share * seen[:, 1:] > INK for share in shares]
    ink = np.stack(parts, axis=2).reshape(len(seen), -1)
    middle = ink.shape[1] // 2
    sides = ink[:, middle:], ink[:, middle - 1 :: -1]
    both = [np.logical_and.accumulate(side, axis=1).sum(axis=1) for side in sides]
    return np.asarray(sum(both) * STEP_PX / PARTS)
