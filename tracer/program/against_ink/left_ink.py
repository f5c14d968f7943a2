"""The ink of a patch that is left: what no way along it has come by.

    patch    ━━━━━━━━━━━━┯━━━━━━━━━━━      a run has tried the ink, up to its first junction; a run that was
    line     ────────────╯                 in vain has gone further, and has shown nothing there
    left                   ···········

Signals: a patch of ink, and ways (n, 2) mm, in; the part of the patch that is far from them, out.

Each way is held against the ink once, whatever is asked of it later: of each place of the ink the distance
from the nearest way is kept. Source: our own.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.neighbours import crowds
from morfax.motion.polyline import nearest_mm
from morfax.tracer.drawing.strokes import Stroke


@dataclass(slots=True)
class LeftInk:
    """The places of a patch's ink, and how far each is from the nearest of some ways, mm."""

    stroke: Stroke
    beside_mm: float  # ink nearer to a way is that way's
    away_mm: Array = field(init=False)
    _weights: Array | None = None

    def __post_init__(self) -> None:
        """No way yet."""
        self.away_mm = np.full(len(self.stroke.middles_mm), np.inf)

    def pass_by(self, way_mm: Array) -> None:
        """Take in a way (n, 2) mm."""
        near_mm = nearest_mm(self.stroke.middles_mm, way_mm)
        np.minimum(self.away_mm, near_mm, out=self.away_mm)

    def left(self, others_mm: Array | None = None) -> Stroke:
        """The part of the ink by which no way has come; nor any of others, from which it is so far, mm."""
        stroke, near = self.stroke, self.away_mm < self.beside_mm
        if others_mm is not None:
            near |= others_mm < self.beside_mm
        # all of it, as a rule: nothing to weigh
        share = 0.0 if near.all() else float(np.average(~near, weights=self._weighed()))
        return replace(
            stroke,
            middles_mm=stroke.middles_mm[~near],
            filled=stroke.filled[~near],
            length_mm=stroke.length_mm * share,
        )

    def _weighed(self) -> Array:
        """What each middle place counts for: a line along the rows has two abreast, a sloping one has one."""
        if self._weights is None:
            lower, higher = crowds(self.stroke.middles_mm, self.stroke.width_mm)
            self._weights = 1 / (1.0 + lower + higher)
        return self._weights
