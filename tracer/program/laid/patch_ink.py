"""The ink of a patch, and what a pen along ways leaves of it, box by box.

Signals: a sheet, a patch of its ink and a pen's width in; how far its places are from a way, mm, and by how
much ways are off the ink, in squares of the width, out.

Source: our own (see `tangles.seen_ink`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.neighbours import Neighbours
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.ink.crossing_ink import Boxes
from morfax.tracer.program.laid.loop_ink import ink_of
from morfax.tracer.tangles import distances, pen
from morfax.tracer.tangles.seen_ink import SeenInk

MOST_PLACES = 100_000  # of a patch: with more its largest would take seconds


@dataclass(frozen=True, eq=False)
class PatchInk:
    """The ink of a patch of a sheet, and the paper about it, as far as that is no other patch's."""

    seen: SeenInk
    pitch_mm: float

    @classmethod
    def of(cls, sheet: Sheet, patch: int, width_mm: float) -> PatchInk:
        """That of a patch that a pen of a width has drawn."""
        return cls(ink_of(sheet, patch, width_mm, MOST_PLACES), sheet.drawing.pitch_mm)

    @property
    def places_mm(self) -> Array:
        """The middles of its pixels, (n, 2) mm."""
        return self.seen.places_mm

    @cached_property
    def _boxes(self) -> Boxes:
        """Its pixels in a window."""
        at = (self.places_mm / self.pitch_mm).astype(np.int64)
        column, row = (at - at.min(axis=0)).T
        return Boxes((row, column), (int(row.max()) + 1, int(column.max()) + 1), self.pitch_mm)

    def away_mm(self, way: Array) -> Array:
        """How far its places are from a way (m, 2) mm, (n,)."""
        return distances.away_from(self.places_mm, way)

    def wrong(self, away_mm: Array) -> Array:
        """What a pen along ways that are so far away (n,) draws too dark at each place."""
        drawn = np.empty(len(away_mm))
        pen.ink(away_mm, self.seen.half_mm, self.seen.softness_mm, drawn)
        return np.asarray(drawn - self.seen.darkness)

    def left_by(self, way: Array, at: NDArray[np.int64]) -> Array:
        """How much a pen along places (m, 2) mm a step apart leaves unexplained at some of the ink's places
        (n,), with what noise leaves, in squares of the width.
        """
        away_mm, _ = Neighbours(way).nearest(self.places_mm[at])
        drawn = np.empty(len(at))
        pen.ink(away_mm, self.seen.half_mm, self.seen.softness_mm, drawn)
        return self.seen.left_at(drawn - self.seen.darkness[at])

    def left(self, away_mm: Array, where: NDArray[np.bool_] | None = None) -> float:
        """How much it leaves unexplained in all, or at some of its places (n,), in squares of the width."""
        wrong = self.wrong(away_mm)
        if where is None:
            return self.seen.left(wrong)
        at = np.flatnonzero(where)
        return self.seen.only(at).left(wrong[at])

    def worst(self, away_mm: Array, where: NDArray[np.bool_] | None = None) -> float:
        """The same in the worst box as wide as a line."""
        wrong, seen = self.wrong(away_mm), self.seen
        worst = self._boxes.worst(wrong if where is None else wrong * where, seen.width_mm)
        # a place may stand for some more pixels
        return worst * seen.area_mm2 / self.pitch_mm**2 - seen.noise / len(wrong)
