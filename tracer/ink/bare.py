"""Bare ink: the thinned ink of a sheet, and the parts of its stretches along which no stroke runs.

Signals: the sheet as it was felt, and places along the strokes, (n, 2) sheet mm, in; parts of stretches out.

The thinned ink says where the middles of all lines are: those near to a stroke are that stroke's.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.long_array import one_in
from morfax.motion.neighbours import Neighbours
from morfax.motion.polyline import evenly, length_mm
from morfax.motion.usual import THINNED
from morfax.tracer.drawing.components import runs_at
from morfax.tracer.drawing.depth import depth_of
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.drawing.thinning import Indices
from morfax.tracer.effort import LOOKED_MM
from morfax.tracer.ink.graph import Graph
from morfax.tracer.ink.left_out import InkLeft
from morfax.tracer.limits import OWN_WIDTHS

LEAST_MM = 1.0  # a part of a stretch that is left is told if it is longer, and run; chosen

Flags = NDArray[np.bool_]


class Bare(NamedTuple):
    """A part of a stretch along which no stroke runs: the stretch's number, the first of its pixels and the
    one after the last, as the stretch counts them, and where these are, (n, 2) mm.
    """

    stretch: int
    first: int
    last: int
    places_mm: Array

    @property
    def length_mm(self) -> float:
        """Its length."""
        return length_mm(self.places_mm)


class Thinned(NamedTuple):
    """The thinned pixels of a sheet: where they are, (n, 2) mm, the patch of each, how wide a patch's lines
    are, mm, and how wide lines usually are.
    """

    places_mm: Array
    patch: Indices
    wide_mm: Array
    usual_mm: float

    @classmethod
    def of(cls, sheet: Sheet, graph: Graph, left: InkLeft) -> Thinned:
        """The thinned pixels of the ink that is left for strokes."""
        usual_mm = _usual_mm(sheet, left)
        wide_mm = np.where(left.solid_px > 0, usual_mm, np.maximum(sheet.widths_mm, usual_mm))
        patches = sheet.patches
        run = runs_at(patches.row, patches.begin, graph.rows, graph.columns)
        patch = np.asarray(patches.patch[np.maximum(run, 0)], np.int64)
        return cls(graph.places_mm(sheet.drawing), patch, wide_mm, usual_mm)

    def near(self, run: Array) -> Flags:
        """Which pixels are near to some places (n, 2) mm along the strokes."""
        away_mm = Neighbours(run).nearest(self.places_mm)[0]
        return np.asarray(away_mm < OWN_WIDTHS * self.wide_mm[self.patch])

    def bare(self, graph: Graph, are_near: Flags) -> Iterator[Bare]:
        """The parts of all stretches that are left, those long enough."""
        for number, stretch in enumerate(graph.stretches):
            flags = are_near[stretch.pixels]
            ends = np.r_[0, np.flatnonzero(np.diff(flags)) + 1, len(flags)].tolist()
            for first, last in pairwise(ends):
                part = Bare(number, first, last, self.places_mm[stretch.pixels[first:last]])
                if not flags[first] and part.length_mm > LEAST_MM:
                    yield part


def places_along(ways: Iterable[Array]) -> Array:
    """Places along some ways, `LOOKED_MM` apart, (n, 2) mm."""
    return np.vstack([evenly(one_in(way, THINNED), LOOKED_MM) for way in ways])


def _usual_mm(sheet: Sheet, left: InkLeft) -> float:
    """The usual width of a sheet's lines, mm; a patch with a solid area is broader than its lines."""
    if left.solid_px.any() and left.packed_ink.any():
        # as of a patch, see `drawing.strokes`
        wide_px = 4 * float(depth_of(left.ink).mean()) - 2
        return max(wide_px, 1.0) * sheet.drawing.pitch_mm
    weights = np.where(sheet.are_solid, NOT_ZERO, sheet.lengths_mm)
    return float(np.average(sheet.widths_mm, weights=weights))
