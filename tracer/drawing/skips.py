"""Skips: short gaps that a pen has left in a line, as a ballpoint does; how wide a gap the head is to cross.

Signals: the patches of a sheet in; the widths of the skips, mm, and the gap to cross out.

    ━━━━━━━━━   ━━━━━━━━━━━━  ━━━━━━━━      two ends that face each other, nearer than a millimetre

One gap, or two, may be meant: a ring that is open, a line that ends before another. Where more pieces of line
face each other in this way the pen has skipped.

Source: our own. Questions: dashes nearer than a millimetre are skips too; they are followed as one line.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import unit
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.effort import FINE_PX, MANY
from morfax.tracer.limits import AHEAD_RAD, LONGER_WIDTHS, PIECE_MM

# All limits below were chosen by trial on `python -m benchmarks rough`.
WIDEST_MM = 1.0  # over a wider gap a leg's own bend does not lead any more
FEWEST = 3  # fewer may be meant
FACING_COS = math.cos(AHEAD_RAD)
MOST_ENDS = 3  # of a piece, one of them a burr; a piece with more is a net
SPARE_MM = 0.2  # the head's own uncertainty about both ends


class End(NamedTuple):
    """An end of a piece of line: where its ink ends (x, y) mm, and the unit vector outward."""

    tip_mm: Array
    outward: Array


def gap_to_cross_mm(sheet: Sheet) -> float | None:
    """The widest skip of the sheet's pen, and a little more; None if the pen has not skipped."""
    found = skips_mm(sheet)
    return min(max(found) + SPARE_MM, WIDEST_MM) if len(found) >= FEWEST else None


def skips_mm(sheet: Sheet) -> list[float]:
    """The gaps between ends that face each other, mm."""
    pieces = np.flatnonzero((sheet.lengths_mm > PIECE_MM) & ~sheet.are_solid)
    if not FEWEST <= len(pieces) <= MANY:
        return []
    ends = [end for patch in pieces for end in _ends(sheet.stroke(int(patch)), sheet.drawing)]
    found, taken = list[float](), set[int]()
    pairs = [(_gap_mm(ends[a], ends[b]), a, b) for a in range(len(ends)) for b in range(a)]
    for gap_mm, a, b in sorted(pairs):
        if gap_mm <= WIDEST_MM and not taken & {a, b}:
            taken |= {a, b}
            found.append(gap_mm)
    return found


def _ends(stroke: Stroke, drawing: Drawing) -> list[End]:
    """The two ends of a piece of line; none if it has not two."""
    places = stroke.ends_mm
    if not 2 <= len(places) <= MOST_ENDS:
        return []
    ends = []
    for place in places[:2]:  # the likeliest are first
        away = stroke.middles_mm - place
        near = np.hypot(*away.T) < LONGER_WIDTHS * stroke.width_mm
        outward = -unit(away[near].mean(axis=0))
        ends.append(End(_tip_mm(place, outward, stroke.width_mm, drawing), outward))
    return ends


def _tip_mm(place_mm: Array, outward: Array, width_mm: float, drawing: Drawing) -> Array:
    """Where the ink ends from a place within a width of its end on, (x, y) mm."""
    on_mm = np.arange(0.0, width_mm, FINE_PX * drawing.pitch_mm)
    places = place_mm + on_mm[:, None] * outward
    rows, columns = drawing.darkness.shape
    row = np.clip(rows - 1 - np.floor(places[:, 1] / drawing.pitch_mm), 0, rows - 1)
    column = np.clip(np.floor(places[:, 0] / drawing.pitch_mm), 0, columns - 1)
    is_paper = drawing.darkness[row.astype(int), column.astype(int)] < INK
    last = int(np.argmax(is_paper)) if is_paper.any() else len(places) - 1
    return np.asarray(places[last])


def _gap_mm(one: End, other: End) -> float:
    """The paper between two ends, mm; infinite if they do not face each other."""
    way = other.tip_mm - one.tip_mm
    gap_mm = float(np.hypot(*way))
    if not 0 < gap_mm <= WIDEST_MM:
        return math.inf
    faces = min(float(one.outward @ way), -float(other.outward @ way)) / gap_mm
    return gap_mm if faces > FACING_COS else math.inf
