"""The arc spline: lines and arcs end to end, tangent at every joint, laid nearest to a row of places.

Signals in: places in mm, pieces of them, and which pieces are curved. Signals out: a chain of segments.
Unknown are the joints and half the angle that each arc turns; least squares of the distances, where

    heading at the end of segment i  =  heading at the start of segment i + 1

is held by its weight: a break of the tangent of 1e-4 rad counts as much as a place at the edge of the
tolerance. Where the chain leaves the tolerance the worst places weigh more.

Source: D. Meek and D. Walton, Approximating quadratic NURBS curves by arc splines, 1993, fitted here instead
of laid through points. Questions: none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import lengths_mm
from morfax.recorder.gcode.normal_equations import offs
from morfax.recorder.gcode.pieces import SPACING_MM, Piece, curvature_per_mm
from morfax.recorder.gcode.settling import owners, settle, table_of

# of an arc, half of what it turns. On a small circle a joint can slide until one arc goes round it once or
# three times; the arc's ends, as they are written, then meet and tell no centre
MOST_HALF_RAD = 0.75 * math.pi


@dataclass(frozen=True, slots=True)
class LineOrArc:
    """A line or an arc: begin, heading there, length, and curvature (0 for a line, positive to the left)."""

    begin_mm: tuple[float, float]
    heading_rad: float
    length_mm: float
    curvature_per_mm: float

    @property
    def turned_rad(self) -> float:
        """Angle turned from begin to end."""
        return self.length_mm * self.curvature_per_mm

    @property
    def end_mm(self) -> tuple[float, float]:
        """The end point, mm."""
        half = self.turned_rad / 2
        chord = self.length_mm * float(np.sinc(half / math.pi))
        along = self.heading_rad + half
        return self.begin_mm[0] + chord * math.cos(along), self.begin_mm[1] + chord * math.sin(
            along
        )


@dataclass(frozen=True, slots=True)
class SegmentChain:
    """Segments from corner to corner, and their largest distance from the path."""

    segments: list[LineOrArc]
    deviation_mm: float


class ArcSpline:
    """A chain with as many segments as there are pieces, each tangent to the one before.

    Unknown are the joints (x, y) between fixed ends, and half the angle that each curved segment turns.
    """

    def __init__(self, places: Array, pieces: list[Piece], curved: NDArray[np.bool_]) -> None:
        n = len(pieces)
        self.places, s = places, lengths_mm(places)
        self.joints = np.asarray(places[[0, *(b for _, b, _ in pieces)]], float)
        bends = [curvature_per_mm(places[a : b + 1]) for a, b, _ in pieces]
        halves = [k * (s[b] - s[a]) / 2 for k, (a, b, _) in zip(bends, pieces, strict=True)]
        self.halves = np.where(curved, halves, 0.0)
        self.few = np.unique(
            np.linspace(0, len(places) - 1, min(len(places), 60 * n + 20)).astype(int)
        )
        self.shares = s / s[-1]
        self.closed = n > 1 and math.dist(places[0], places[-1]) < SPACING_MM
        # the unknowns in the order of the path, so that those that meet are near each other; -1 is fixed
        free = np.column_stack([np.arange(n) > 0, np.arange(n) > 0, curved])
        number = np.where(free, np.cumsum(free).reshape(n, 3) - 1, -1)
        ends = np.vstack([number[1:, :2], np.full((1, 2), -1)])
        # of each segment's five numbers
        self.columns = np.column_stack([number[:, :2], ends, number[:, 2]])

    def laid(self, tolerance_mm: float) -> SegmentChain | None:
        """The chain by least squares, the worst places weighted more where needed; None if none fits."""
        weights = np.ones(len(self.few))
        for _ in range(4):
            seen = (self.places[self.few], self.shares[self.few], weights / tolerance_mm)
            settle(self.joints, self.halves, seen, self.columns, self.closed)
            table = table_of(self.joints, self.halves)
            off = np.abs(offs(table, self.places, owners(table, self.shares)))
            if off.max() <= tolerance_mm and np.abs(self.halves).max() <= MOST_HALF_RAD:
                return SegmentChain(segments(rows_of(table)), float(off.max()))
            if off.max() > 2 * tolerance_mm:
                break
            weights = weights * (0.3 + off[self.few] / off.max())
        return None


def segments(rows: Array) -> list[LineOrArc]:
    """Rows as segments."""
    return [
        LineOrArc((x, y), heading, length, bend)
        for x, y, heading, length, bend in rows.tolist()
    ]


def rows_of(table: Array) -> Array:
    """Rows (x, y, heading, length, curvature) of segments given by their ends and half the angle turned."""
    x0, y0, x1, y1, half = table.T
    chord = np.hypot(x1 - x0, y1 - y0)
    length = chord / np.sinc(half / math.pi)
    return np.column_stack(
        [x0, y0, np.arctan2(y1 - y0, x1 - x0) - half, length, 2 * half / length]
    )
