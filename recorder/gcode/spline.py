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
from typing import Any

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import lengths_mm
from morfax.recorder.gcode.pieces import SPACING_MM, Piece, curvature_per_mm

ROUNDS = 20  # of Levenberg and Marquardt; what has not settled by then is taken as it is
BREAK_RAD = 1e-4  # a break that weighs as much as a place at the edge of the tolerance
_STEP = 1e-7  # mm and rad, of the slopes by differences


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
        columns = np.r_[np.full(2, -1), np.arange(2 * n - 2), np.full(2, -1)].reshape(
            -1, 2
        )  # of the joints; -1 is fixed
        of_halves = np.where(curved, 2 * n - 3 + np.cumsum(curved), -1)
        # of each segment's five numbers
        self.columns = np.column_stack([columns[:-1], columns[1:], of_halves])

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
        from scipy.sparse import identity  # half a second that `--help` need not wait for
        from scipy.sparse.linalg import spsolve

        damping, cost = 1e-3, np.inf
        for _ in range(ROUNDS):
            residuals, slopes = self._linearised(weights, tolerance_mm)
            if not slopes.shape[1]:
                return
            cost, before = float(residuals @ residuals), (self.joints, self.halves)
            square, pull = (slopes.T @ slopes).tocsc(), slopes.T @ residuals
            scale = identity(square.shape[0], format="csc") * float(square.diagonal().mean())
            for _ in range(5):
                self._step(-spsolve(square + damping * 1e-4 * scale, pull), *before)
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
        off = _off_rows(self._rows()[self._owner(self.few)], self.places[self.few])
        return np.r_[weights * off / tolerance_mm, self._breaks() / BREAK_RAD]

    def _breaks(self) -> Array:
        """The jump of the direction at each joint, and at the seam of a closed line, rad."""
        chords = np.diff(self.joints, axis=0)
        direction = np.arctan2(chords[:, 1], chords[:, 0])
        jumps = np.roll(direction - self.halves, -1) - direction - self.halves
        jumps = (jumps + math.pi) % (2 * math.pi) - math.pi
        return jumps if self.closed else jumps[:-1]

    def _linearised(self, weights: Array, tolerance_mm: float) -> tuple[Array, Any]:
        """Residuals, and their slopes as a sparse matrix."""
        from scipy.sparse import coo_matrix

        residuals, n = self._residuals(weights, tolerance_mm), len(self.few)
        table = np.column_stack([self.joints[:-1], self.joints[1:], self.halves])
        owner = self._owner(self.few)
        own = _off_table(table, self.places[self.few], owner)
        rows, columns, values = [], [], []
        for k in range(5):  # each distance depends on the five numbers of its own segment only
            moved = table.copy()
            moved[:, k] += _STEP
            slope = (_off_table(moved, self.places[self.few], owner) - own) / _STEP
            rows.append(np.arange(n))
            columns.append(self.columns[owner, k])
            values.append(slope * weights / tolerance_mm)
        chords = np.diff(self.joints, axis=0)
        turn = np.column_stack([-chords[:, 1], chords[:, 0]]) / (chords**2).sum(axis=1)[:, None]
        # of a chord's direction, and of half an angle
        slopes = np.column_stack([-turn, turn, np.ones(len(turn))])
        for j in range(len(residuals) - n):
            after = (j + 1) % len(turn)
            for segment, sign in ((j, -1.0), (after, 1.0)):
                rows.append(np.full(5, n + j))
                columns.append(self.columns[segment])
                values.append(slopes[segment] * [sign, sign, sign, sign, -1.0] / BREAK_RAD)
        row, column, value = (
            np.concatenate(rows),
            np.concatenate(columns),
            np.concatenate(values),
        )
        free = column >= 0
        shape = (len(residuals), int(self.columns.max()) + 1)
        return residuals, coo_matrix((value[free], (row[free], column[free])), shape).tocsr()

    def _owner(self, which: NDArray[np.int64]) -> NDArray[np.int64]:
        """The segment of each place, by its distance along the path."""
        until = np.cumsum(self._rows()[:, 3])
        return np.searchsorted(until[:-1], self.s[which] * (until[-1] / self.s[-1]))

    def _rows(self) -> Array:
        """Begin, heading, length and curvature of each segment."""
        return rows_of(np.column_stack([self.joints[:-1], self.joints[1:], self.halves]))


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


def _off_table(table: Array, points: Array, owner: NDArray[np.int64]) -> Array:
    """Distance of each point from the circle or line of its segment, given as in `rows_of`."""
    return _off_rows(rows_of(table)[owner], points)


def _off_rows(rows: Array, points: Array) -> Array:
    """Distance of each point from the circle or line of its own row, positive to the left."""
    x, y, heading, _, bend = rows.T
    dx, dy = points[:, 0] - x, points[:, 1] - y
    square = 2 * (dy * np.cos(heading) - dx * np.sin(heading)) - bend * (dx * dx + dy * dy)
    return square / (1 + np.sqrt(np.maximum(1 - bend * square, 0.0)))
