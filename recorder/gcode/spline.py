"""The arc spline: lines and arcs end to end, tangent at every joint, laid nearest to a row of places.

Signals in: places in mm, pieces of them, and which pieces are curved. Signals out: a chain of segments.
Unknown are the joints and half the angle that each arc turns; least squares of the distances, where

    heading at the end of segment i  =  heading at the start of segment i + 1

is held by its weight: a break of the tangent of 1e-4 rad counts as much as a place at the edge of the
tolerance. Where the chain leaves the tolerance the worst places weigh more.

Source: D. Meek and D. Walton, Approximating quadratic NURBS curves by arc splines, 1993, fitted here instead
of laid through points; steps by K. Levenberg, 1944, and D. Marquardt, 1963.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import lengths_mm
from morfax.recorder.gcode.normal_equations import BREAK_RAD, normal, offs, solved
from morfax.recorder.gcode.pieces import SPACING_MM, Piece, curvature_per_mm

ROUNDS = 20  # of Levenberg and Marquardt; what has not settled by then is taken as it is


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
class Chain:
    """Segments from corner to corner, and their largest distance from the path."""

    segments: list[LineOrArc]
    deviation_mm: float


class Spline:
    """A chain with as many segments as there are pieces, each tangent to the one before.

    Unknown are the joints (x, y) between fixed ends, and half the angle that each curved segment turns.
    """

    def __init__(self, places: Array, pieces: list[Piece], curved: NDArray[np.bool_]) -> None:
        n = len(pieces)
        self.places, self.s = places, lengths_mm(places)
        self.joints = places[[0, *(b for _, b, _ in pieces)]]
        halves = [
            curvature_per_mm(places[a : b + 1]) * (self.s[b] - self.s[a]) / 2
            for a, b, _ in pieces
        ]
        self.halves = np.where(curved, halves, 0.0)
        self.few = np.unique(
            np.linspace(0, len(places) - 1, min(len(places), 60 * n + 20)).astype(int)
        )
        self.closed = n > 1 and math.dist(places[0], places[-1]) < SPACING_MM
        # the unknowns in the order of the path, so that those that meet are near each other; -1 is fixed
        free = np.column_stack([np.arange(n) > 0, np.arange(n) > 0, curved])
        number = np.where(free, np.cumsum(free).reshape(n, 3) - 1, -1)
        ends = np.vstack([number[1:, :2], np.full((1, 2), -1)])
        # of each segment's five numbers
        self.columns = np.column_stack([number[:, :2], ends, number[:, 2]])

    def laid(self, tolerance_mm: float) -> Chain | None:
        """The chain by least squares, the worst places weighted more where needed; None if none fits."""
        weights = np.ones(len(self.few))
        for _ in range(4):
            self._settle(weights, tolerance_mm)
            off = np.abs(
                _off_rows(self._rows()[self._owner(np.arange(len(self.s)))], self.places)
            )
            if off.max() <= tolerance_mm:
                return Chain(segments(self._rows()), float(off.max()))
            if off.max() > 2 * tolerance_mm:
                break
            weights = weights * (0.3 + off[self.few] / off.max())
        return None

    def _settle(self, weights: Array, tolerance_mm: float) -> None:
        """Take steps by Levenberg and Marquardt until they no longer help."""
        damping, cost = 1e-3, np.inf
        for _ in range(ROUNDS):
            cost, band, pull, seam = self._linearised(weights, tolerance_mm)
            if not len(pull):
                return
            before = (self.joints, self.halves)
            scale = float(band[:, 0].mean() + (seam**2).mean())
            for _ in range(5):
                damped = band.copy()
                damped[:, 0] += damping * 1e-4 * scale
                self._step(-solved(damped, seam, pull), *before)
                new = self._residuals(weights, tolerance_mm)
                if (now := float(new @ new)) < cost:
                    break
                damping *= 10
            else:
                self.joints, self.halves = before
                return
            damping = max(damping / 5, 1e-9)
            if cost - now < 1e-3 * cost:
                return

    def _step(self, change: Array, joints: Array, halves: Array) -> None:
        """Joints and half angles after a change of the unknowns."""
        change = np.r_[change, 0.0]  # column -1 is fixed
        self.joints = joints + np.vstack([change[self.columns[:, :2]], np.zeros((1, 2))])
        self.halves = halves + change[self.columns[:, 4]]

    def _residuals(self, weights: Array, tolerance_mm: float) -> Array:
        """Distances in tolerances, and breaks of the tangent."""
        off = offs(self._table(), self.places[self.few], self._owner(self.few))
        return np.r_[weights * off / tolerance_mm, self._breaks() / BREAK_RAD]

    def _breaks(self) -> Array:
        """The jump of the direction at each joint, and at the seam of a closed line, rad."""
        chords = np.diff(self.joints, axis=0)
        direction = np.arctan2(chords[:, 1], chords[:, 0])
        jumps = np.roll(direction - self.halves, -1) - direction - self.halves
        jumps = (jumps + math.pi) % (2 * math.pi) - math.pi
        return jumps if self.closed else jumps[:-1]

    def _linearised(
        self, weights: Array, tolerance_mm: float
    ) -> tuple[float, Array, Array, Array]:
        """The sum of the squared residuals, and the normal equations of their slopes: the band of the matrix
        (unknowns, BAND), the right side, and the slopes of the seam's break, which are not in the band.
        """
        return normal(  # type: ignore[no-any-return]
            self._table(),
            (self.places[self.few], self._owner(self.few), weights / tolerance_mm),
            self._breaks() / BREAK_RAD,
            self.columns,
            self.closed,
        )

    def _table(self) -> Array:
        """The ends of each segment and half the angle that it turns."""
        return np.column_stack([self.joints[:-1], self.joints[1:], self.halves])

    def _owner(self, which: NDArray[np.int64]) -> NDArray[np.int64]:
        """The segment of each place, by its distance along the path."""
        until = np.cumsum(self._rows()[:, 3])
        return np.searchsorted(until[:-1], self.s[which] * (until[-1] / self.s[-1]))

    def _rows(self) -> Array:
        """Begin, heading, length and curvature of each segment."""
        return rows_of(self._table())


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


def _off_rows(rows: Array, points: Array) -> Array:
    """Distance of each point from the circle or line of its own row, positive to the left."""
    x, y, heading, _, bend = rows.T
    dx, dy = points[:, 0] - x, points[:, 1] - y
    square = 2 * (dy * np.cos(heading) - dx * np.sin(heading)) - bend * (dx * dx + dy * dy)
    return square / (1 + np.sqrt(np.maximum(1 - bend * square, 0.0)))
