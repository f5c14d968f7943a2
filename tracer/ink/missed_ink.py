"""Missed ink: ink on one side of all strokes, further from them than their pen reaches.

    ══════════════╗      two lines so near to each other that paper hardly shows between them have one middle
    ═══════  ═════╝      in the thinned ink, and that is near to a stroke along either of them: what is
      ↑ no stroke        missing of the other shows in the ink alone

Ink that lies as far on a stroke's other side as well is a broad line's, along whose middle the stroke runs.

Signals: the ink that is left for strokes, and places of these, (n, 2) mm, in; pieces of missed ink out.

Source: our own. Questions: a corner that is drawn to a sharp point reaches as far; by its area it is none.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.neighbours import Neighbours
from morfax.tracer.drawing.components import joined
from morfax.tracer.drawing.deviation import COVERS
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.drawing.thinning import Indices
from morfax.tracer.ink.left_out import InkLeft

# In widths of the lines of a patch, by trial on 11 sheets with known truth: each piece was one of a true line
# that no stroke ran along.
# of missed line, by its ink; a corner of 30 degrees that comes to a point has a third
LEAST = 0.8
BROAD = 0.5  # of a piece: so much lies as far on the stroke's other side as well
LOOKED_PX = 1 << 16  # of ink that are looked at together, in 6 MB; chosen
# pixels: as near to a solid area ink is its rim's
RIM_PX = np.array([(i, j) for i in (-2, 0, 2) for j in (-2, 0, 2)])


class Missed(NamedTuple):
    """A piece of missed ink: its pixels (n, 2) mm, and how long a line would have as much."""

    places_mm: Array
    length_mm: float


def missed_ink(sheet: Sheet, left: InkLeft, run: Array, widths_mm: Array) -> Iterator[Missed]:
    """The missed ink of those patches of which a width of the lines is given, and not 0; none of a pencil's
    grain, and of pixels that were made finer.
    """
    if sheet.drawing.grainy or sheet.drawing.finer > 1:
        return
    far = _far(sheet, left, run, widths_mm)
    if not len(far.rows):
        return
    group, count = joined(far.rows, far.columns, far.columns + 1, True)
    for number in range(count):
        own = np.flatnonzero(group == number)
        width_mm, places = float(far.widths_mm[own[0]]), far.places[own]
        length_mm = len(own) * sheet.drawing.pitch_mm**2 / width_mm
        is_broad = np.mean(_is_ink(sheet, left, 2 * far.strokes[own] - places)) > BROAD
        if length_mm > LEAST * width_mm and not is_broad:
            yield Missed(places, length_mm)


class _Far(NamedTuple):
    """Pixels of ink far from all strokes: row by row, and where they are, (n, 2) mm; the place of a stroke
    that is nearest to each, and the width of the lines there, mm.
    """

    rows: Indices
    columns: Indices
    places: Array
    strokes: Array
    widths_mm: Array


def _far(sheet: Sheet, left: InkLeft, run: Array, widths_mm: Array) -> _Far:
    """The pixels of patches with a width that are far from all strokes, some runs of ink at a time."""
    patches, near = sheet.patches, Neighbours(run)
    runs, found = np.flatnonzero(widths_mm[patches.patch] > 0), list[_Far]()
    pixels = np.cumsum(patches.end[runs] - patches.begin[runs])
    last = pixels[-1] if len(runs) else 0
    parts = np.searchsorted(pixels, np.arange(LOOKED_PX, last, LOOKED_PX))
    for some in np.split(runs, parts):
        counts = patches.end[some] - patches.begin[some]
        within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        rows = np.repeat(patches.row[some].astype(np.int64), counts)
        columns = np.repeat(patches.begin[some].astype(np.int64), counts) + within
        places = sheet.places_mm(rows, columns)
        width_mm = np.repeat(widths_mm[patches.patch[some]], counts)
        away_mm, nearest = near.nearest(places)
        is_far = away_mm > 0.5 * COVERS * width_mm  # half of it lies on either side of a stroke
        at = np.flatnonzero(is_far & left.packed_ink.at(rows, columns))
        at = at[~_at_rim(left, rows[at], columns[at])]
        found.append(_Far(rows[at], columns[at], places[at], run[nearest[at]], width_mm[at]))
    return _Far(*(np.concatenate(column) for column in zip(*found, strict=True)))


def _at_rim(left: InkLeft, rows: Indices, columns: Indices) -> NDArray[np.bool_]:
    """Whether some pixels lie at the rim of a solid area."""
    solid, found = left.packed_solid, np.zeros(len(rows), bool)
    last = np.array(solid.shape) - 1
    for aside in RIM_PX:
        at = np.clip(np.column_stack([rows, columns]) + aside, 0, last)
        found |= solid.at(at[:, 0], at[:, 1])
    return found


def _is_ink(sheet: Sheet, left: InkLeft, places: Array) -> NDArray[np.bool_]:
    """Whether places (n, 2) mm are on ink."""
    last = np.array(left.packed_ink.shape) - 1
    x, y = np.floor(places / sheet.drawing.pitch_mm).astype(int).T
    at = np.clip(np.column_stack([last[0] - y, x]), 0, last)
    return left.packed_ink.at(at[:, 0], at[:, 1])
