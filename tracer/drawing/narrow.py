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

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.tracer.drawing import components
from morfax.tracer.drawing.components import INK, Numbers, Patches
from morfax.tracer.effort import FEW_PX
from morfax.tracer.limits import NEAR

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing

Mask = NDArray[np.uint8]
Pixels = NDArray[np.int64]

BRIDGE_PX = 1  # so far from each other pixels of one strip may lie
HALO_PX = 2  # beyond its reach OpenCV's measure of distances looks at pixels
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
        wide = NARROW_PX * drawing.finer + 1
        pixels, runs = list[tuple[Pixels, Pixels]](), list[tuple[Numbers, Numbers, Numbers]]()
        shape, halo = drawing.darkness.shape, wide + BRIDGE_PX
        for top, bottom, strip in components.strips(shape, halo=halo, pixels=FEW_PX):
            # 1. paper that is gone where ink is spread by a pixel, and shrunk again
            ink = np.asarray(drawing.darkness[strip] > INK, np.uint8)
            closed = cv2.morphologyEx(ink, cv2.MORPH_CLOSE, np.ones((wide, wide), np.uint8))
            thin: Mask = np.asarray(closed > ink, np.uint8)
            # 2. what lies together, but for a bridge of a pixel
            together = cv2.dilate(thin, np.ones((2 * BRIDGE_PX + 1,) * 2, np.uint8))
            own = slice(top - strip.start, bottom - strip.start)
            row, column = np.nonzero(thin[own])
            pixels.append((row + top, column))
            runs.append(components.runs_of(np.asarray(together[own], np.uint8), top))
        patches = Patches.of(runs)
        rows, columns = (np.concatenate(of) for of in zip(*pixels, strict=True))
        high, wide_px = patches.boxes[:, 1::2].T - patches.boxes[:, ::2].T
        lengths_mm = drawing.pitch_mm * np.hypot(wide_px, high)
        run = components.runs_at(patches.row, patches.begin, rows, columns)
        return cls(rows, columns, lengths_mm[patches.patch[run]])

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
    over_mm = [NEAR * min(width_mm, usual_mm) for _, width_mm in lines]
    pixels = [_pixels(drawing, places) for places, _ in lines]
    lengths_mm = [np.zeros(len(places)) for places, _ in lines]
    halo = math.ceil(max(over_mm) / drawing.pitch_mm) + HALO_PX
    for top, bottom, rows in components.strips(
        drawing.darkness.shape, halo=halo, pixels=FEW_PX
    ):
        near = _Near.of(strips, rows, drawing.darkness.shape[1])
        of_lines = zip(pixels, over_mm, lengths_mm, strict=True)
        for (row, column), within_mm, length_mm in of_lines:
            own = np.flatnonzero((row >= top) & (row < bottom))
            at = row[own] - rows.start, column[own]
            there = near.away_px[at] * drawing.pitch_mm < within_mm
            length_mm[own[there]] = near.lengths_mm[near.numbers[at][there]]
    ways = [places for places, _ in lines]
    return [_longest(*of) for of in zip(ways, lengths_mm, strict=True)]


def _longest(places: Array, lengths_mm: Array) -> NarrowGap | None:
    """The longest strip of those at some places (n, 2) mm; None if there is none."""
    if not lengths_mm.any():
        return None
    longest = int(np.argmax(lengths_mm))
    x, y = places[longest].tolist()
    return NarrowGap((x, y), float(lengths_mm[longest]))


class _Near(NamedTuple):
    """Of each pixel of some rows of a sheet, how far the nearest strip is, pixels, and its number; of each
    number, how long that strip is, mm.
    """

    away_px: NDArray[np.float32]
    numbers: NDArray[np.int32]
    lengths_mm: Array

    @classmethod
    def of(cls, strips: Strips, rows: slice, columns: int) -> _Near:
        """Those of some rows."""
        own = (strips.rows >= rows.start) & (strips.rows < rows.stop)
        at = strips.rows[own] - rows.start, strips.columns[own]
        paper = np.ones((rows.stop - rows.start, columns), np.uint8)
        paper[at] = 0
        away_px, numbers = cv2.distanceTransformWithLabels(
            paper, cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
        )
        lengths_mm = np.zeros(int(numbers.max()) + 1)
        lengths_mm[numbers[at]] = strips.lengths_mm[own]
        return cls(np.asarray(away_px, np.float32), np.asarray(numbers, np.int32), lengths_mm)


def _pixels(drawing: Drawing, places: Array) -> tuple[Pixels, Pixels]:
    """Rows and columns of the pixels in which places (n, 2) mm lie."""
    rows, columns = drawing.darkness.shape
    column = np.floor(places[:, 0] / drawing.pitch_mm).astype(np.int64)
    row = np.floor(rows - places[:, 1] / drawing.pitch_mm).astype(np.int64)
    return np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)
