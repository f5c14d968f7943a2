"""Narrow gaps: long strips of paper between two lines that are only one or two of the scan's pixels wide, and
paths that run over them.

    ██████████████████████        Noise bridges such a strip here and there, and the head may go over a bridge
    ▒▒▒▒░░░░▒▒▒▒▒▒░░░▒▒▒▒▒        from one line to the other. A path that keeps to its line stays half a pen's
    ██████████████████████        width off the strip.

Signals: a drawing and paths with the widths of their ink, sheet mm, in; the places where paths run over
narrow strips of paper, and how long these are, mm, out.

Source: our own. Questions: large sheets (see `large`) are not looked at; their lines have many pixels.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.tracer.drawing.components import INK
from morfax.tracer.limits import NEAR

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing

Mask = NDArray[np.uint8]
Pixels = NDArray[np.int64]

NARROW_PX = 2  # so wide a strip is bridged by noise; one of three pixels is not
# widths of the usual line: shorter ones are where letters crowd, and two lines meet; on 53 real sheets paths
# run over longer ones on eight, and most of these paths are astray there
LONG_WIDTHS = 20.0
PARTED = 2.0  # times the resolution: a strip of two pixels has four, and is bridged nowhere


class NarrowGap(NamedTuple):
    """Where a path runs over a narrow strip of paper, and how long the strip is, mm."""

    place_mm: tuple[float, float]
    length_mm: float


class Strips(NamedTuple):
    """The narrow strips of a drawing: rows (n,) and columns of their pixels, from the upper row down, and how
    long the strip of each is, mm.
    """

    rows: Pixels
    columns: Pixels
    lengths_mm: Array

    @classmethod
    def of(cls, drawing: Drawing) -> Strips:
        """All the strips of a drawing, however short."""
        if not isinstance(drawing.darkness, np.ndarray) or drawing.edges_mm:
            none = np.empty(0, np.int64)
            return cls(none, none, np.empty(0))
        # 1. paper that is gone where ink is spread by a pixel, and shrunk again
        ink = np.asarray(drawing.darkness > INK, np.uint8)
        wide = NARROW_PX * drawing.finer + 1
        closed = cv2.morphologyEx(ink, cv2.MORPH_CLOSE, np.ones((wide, wide), np.uint8))
        thin: Mask = np.asarray(closed > ink, np.uint8)
        # 2. what lies together, but for a bridge of a pixel
        together = cv2.dilate(thin, np.ones((3, 3), np.uint8))
        _, numbers, boxes, _ = cv2.connectedComponentsWithStats(together, connectivity=8)
        lengths_mm = drawing.pitch_mm * np.hypot(*boxes[:, 2:4].T)
        rows, columns = np.nonzero(thin)
        return cls(rows, columns, lengths_mm[numbers[rows, columns]])

    def long_for(self, width_mm: float) -> Strips:
        """Those that are long for lines of a width."""
        is_long = self.lengths_mm > LONG_WIDTHS * width_mm
        return Strips(self.rows[is_long], self.columns[is_long], self.lengths_mm[is_long])


def narrow_strip_of(drawing: Drawing, places: Array, width_mm: float) -> NarrowGap | None:
    """The longest narrow strip of paper within a width of some ink, by places (n, 2) mm near its middle."""
    strips = drawing.narrow_strips.long_for(width_mm)
    if not len(strips.rows):
        return None
    # 1. where it is near to the ink, on a window of the sheet about that
    row, column = _pixels(drawing, places)
    reach = int(width_mm / drawing.pitch_mm)
    top, left = row.min() - reach, column.min() - reach
    shape = row.max() + reach + 1 - top, column.max() + reach + 1 - left
    near = np.zeros(shape, np.uint8)
    near[row - top, column - left] = 1
    near = np.asarray(cv2.dilate(near, np.ones((2 * reach + 1,) * 2, np.uint8)))
    # 2. the longest strip there
    rows, columns = strips.rows - top, strips.columns - left
    is_within = (rows >= 0) & (rows < shape[0]) & (columns >= 0) & (columns < shape[1])
    there = np.flatnonzero(is_within)
    there = there[near[rows[there], columns[there]] > 0]
    if not len(there):
        return None
    longest = there[np.argmax(strips.lengths_mm[there])]
    x = float(strips.columns[longest] + 0.5)
    y = float(len(drawing.darkness) - strips.rows[longest] - 0.5)
    length_mm = float(strips.lengths_mm[longest])
    return NarrowGap((x * drawing.pitch_mm, y * drawing.pitch_mm), length_mm)


def narrow_gaps(
    drawing: Drawing, lines: Sequence[tuple[Array, float]]
) -> list[NarrowGap | None]:
    """Of each path (n, 2) mm with the width of its ink, the longest narrow strip that it runs over."""
    usual_mm = median([width_mm for _, width_mm in lines]) if lines else 0.0
    strips = drawing.narrow_strips.long_for(usual_mm)
    if not lines or not len(strips.rows):
        return [None] * len(lines)
    at = strips.rows, strips.columns
    paper = np.ones(drawing.darkness.shape, np.uint8)
    paper[at] = 0
    away_px, nearest = cv2.distanceTransformWithLabels(
        paper, cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    length_mm_of = np.zeros(int(nearest.max()) + 1)
    length_mm_of[nearest[at]] = strips.lengths_mm
    found = list[NarrowGap | None]()
    for places, width_mm in lines:
        row, column = _pixels(drawing, places)
        over_mm = NEAR * min(width_mm, usual_mm)
        there = np.flatnonzero(away_px[row, column] * drawing.pitch_mm < over_mm)
        if not len(there):
            found.append(None)
            continue
        lengths_mm = length_mm_of[nearest[row[there], column[there]]]
        longest = int(np.argmax(lengths_mm))
        x, y = places[there[longest]].tolist()
        found.append(NarrowGap((x, y), float(lengths_mm[longest])))
    return found


def _pixels(drawing: Drawing, places: Array) -> tuple[Pixels, Pixels]:
    """Rows and columns of the pixels in which places (n, 2) mm lie."""
    rows, columns = drawing.darkness.shape
    column = np.floor(places[:, 0] / drawing.pitch_mm).astype(np.int64)
    row = np.floor(rows - places[:, 1] / drawing.pitch_mm).astype(np.int64)
    return np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)
