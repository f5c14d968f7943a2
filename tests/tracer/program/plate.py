"""A plate with holes, as lines."""

from __future__ import annotations

from tests.tracer.inked import arc, polyline

FRAME = polyline((4, 4), (34, 4), (34, 24), (4, 24), (4, 4))
ISLAND, HOLE, EYE = arc((12, 14), 6), arc((26, 14), 3), arc((12, 14), 1.5)
LINES = (FRAME, ISLAND, HOLE, EYE)  # as their numbers go: 100, 38, 19 and 9 mm
