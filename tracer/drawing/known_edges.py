"""The known edges of filled shapes: which of them may be near a place, by the boxes about them.

Signals: edges as closed polylines (n, 2), sheet mm, and places in; out the edges near them.

A circuit board has some thousand edges, and each is asked for as often as there are lines: only those
are looked through whose box is near.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from morfax.motion.arrays import Array, bounds


class KnownEdges:
    """Edges of filled shapes (n, 2), mm, each with its box."""

    def __init__(self, all_mm: Sequence[Array]) -> None:
        self.all_mm = tuple(all_mm)
        boxes = np.array([bounds(edge) for edge in self.all_mm]).reshape(-1, 2, 2)
        self._low, self._high = boxes[:, 0], boxes[:, 1]

    def near(self, places_mm: Array, within_mm: float) -> list[Array]:
        """Those whose box comes within a distance of the box about some places (m, 2), in order."""
        away_mm = self._boxes_away_mm(*bounds(places_mm))
        return [self.all_mm[k] for k in np.flatnonzero(away_mm <= within_mm)]

    def nearest(self, place_mm: Array) -> Array:
        """The edge one of whose places is nearest to a place."""
        boxes_mm = self._boxes_away_mm(place_mm, place_mm)
        nearest, least_mm = 0, np.inf
        for k in np.argsort(boxes_mm, kind="stable"):
            if boxes_mm[k] > least_mm:
                break
            away_mm = float(np.hypot(*(self.all_mm[k] - place_mm).T).min())
            if away_mm < least_mm:
                nearest, least_mm = int(k), away_mm
        return self.all_mm[nearest]

    def _boxes_away_mm(self, low_mm: Array, high_mm: Array) -> Array:
        """How far the edges' boxes are from a box, (n,) mm."""
        apart = np.maximum(self._low - high_mm, low_mm - self._high)
        return np.asarray(np.hypot(*np.maximum(apart, 0.0).T))
