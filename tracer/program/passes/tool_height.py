"""The height of the tool: level, on a slope down into the work, raised over a tab, at clearance above it.

Signals: positions of X and Y along the way, (n, 2) mm, in; Z beside them out, mm.

    level  ───────────────      slope  ──╲            tab       ┌────┐
                                          ╲────               ──┘    └──

Source: our own; the moves of Z while X and Y stand are the Z unit's (see `zunit`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from morfax.motion import ramp
from morfax.motion.arrays import ROUNDED, Array
from morfax.motion.plane import NOTHING_MM
from morfax.motion.polyline import lengths_mm
from morfax.tracer.operator.work import Descent, Work
from morfax.tracer.operator.zunit import QuillMove, z_moves

PlaceMm = Array | tuple[float, float]


@dataclass(slots=True)
class ToolHeight:
    """Where the tool is: its height beside the tabs, the slope it is on and how far it has come there, and
    the top of the tab that it is passing, mm.
    """

    z_mm: float
    entry: Descent | None = None
    come_mm: float = 0.0
    top_mm: float | None = None

    @property
    def left_mm(self) -> float:
        """How much of the slope is left, mm."""
        return 0.0 if self.entry is None else self.entry.length_mm - self.come_mm

    def go_down(self, entry: Descent | None) -> None:
        """Begin a slope, or none."""
        self.entry, self.come_mm = entry, 0.0

    def along(self, xy_mm: Array, length_mm: float) -> Array:
        """Go along a piece (n, 2) mm of the way, which is so long on the line: Z beside it, (n,) mm.

        In a bend the positions are a little less apart than the line is long, and Z goes by the line.
        """
        z_mm = np.full(len(xy_mm), self.z_mm)
        if self.entry is not None:
            lengths = lengths_mm(xy_mm)
            share = lengths / lengths[-1] if lengths[-1] > 0 else lengths
            z_mm = self.entry.z_mm(self.come_mm + share * length_mm)
            self.come_mm += length_mm
            if self.left_mm <= NOTHING_MM:
                z_mm[-1] = -self.entry.depth_mm
                self.entry = None
            self.z_mm = float(z_mm[-1])
        return z_mm if self.top_mm is None else np.maximum(z_mm, self.top_mm)


def slowed(positions_mm: Array, feed_mm_s: float, rate_hz: float) -> Array:
    """The same way (n, 3) mm with more time where Z would move faster than its feed."""
    periods = np.abs(np.diff(positions_mm[:, 2])) * rate_hz / feed_mm_s
    if not len(periods) or periods.max() <= 1 + ROUNDED:
        return positions_mm
    times = np.r_[0.0, np.cumsum(np.maximum(periods, 1.0))]
    uniform = np.arange(1, int(np.ceil(times[-1] - ROUNDED)))
    between = [np.interp(uniform, times, column) for column in positions_mm.T]
    return np.vstack([positions_mm[:1], np.column_stack(between), positions_mm[-1:]])


def rapid(work: Work, start_mm: PlaceMm, end_mm: PlaceMm, rate_hz: float) -> Array:
    """Straight from a place to another at clearance, (n, 3) mm."""
    way = ramp.positions_mm(start_mm, end_mm, work.rapid_mm_s, rate_hz=rate_hz)
    return at_height(way, work.clearance_mm)


def standing(
    work: Work, xy_mm: Array, from_mm: float, moves: Sequence[QuillMove], rate_hz: float
) -> Array:
    """X and Y stand while Z makes its moves, (n, 3) mm."""
    z_mm = z_moves(from_mm, moves, work.acceleration_mm_s2, rate_hz)
    return _together(xy_mm, z_mm, len(z_mm))


def at_height(xy_mm: Array, z_mm: float | Array) -> Array:
    """X and Y move while Z stands, or moves with them, (n, 3) mm."""
    return _together(xy_mm, z_mm, len(xy_mm))


def _together(xy_mm: Array, z_mm: float | Array, rows: int) -> Array:
    """X, Y and Z beside each other, (rows, 3) mm; to stack them, numpy goes row by row."""
    positions_mm = np.empty((rows, 3))
    positions_mm[:, :2], positions_mm[:, 2] = xy_mm, z_mm
    return positions_mm
