"""The path of the head by its length: places and headings a step apart, and the position that each one is.

Signals: positions (n, 2) mm at the motion rate in; places, and unit vectors along the path, every `step_mm`
out.

Source: our own.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import lengths_mm


class HeadPath:
    """Where the head went: at each of `at_mm` along its path the place, the direction and the position."""

    def __init__(self, positions: Array, step_mm: float) -> None:
        lengths = lengths_mm(positions)
        moving = np.r_[True, np.diff(lengths) > 0]
        x, y = positions.T[:2]
        self.step_mm = step_mm
        self.at_mm = np.arange(0.0, lengths[-1], step_mm)
        self.position = np.interp(self.at_mm, lengths[moving], np.flatnonzero(moving))
        self.places = np.column_stack(
            [np.interp(self.at_mm, lengths, x), np.interp(self.at_mm, lengths, y)]
        )
        steps = np.ones((len(self.places), 2))
        if len(self.places) > 1:
            steps = np.gradient(self.places, axis=0)
        self.along = steps / np.maximum(np.hypot(*steps.T), 1e-12)[:, None]

    def place(self, mm: float) -> tuple[float, float]:
        """Where the path is after a length."""
        x, y = (np.interp(mm, self.at_mm, column) for column in self.places.T)
        return float(x), float(y)

    def position_at(self, mm: float) -> float:
        """Which position is there after a length."""
        return float(np.interp(mm, self.at_mm, self.position))

    def goes_straight(self, mm: float, half_mm: float, within_mm: float) -> bool:
        """Whether the path leaves its own chord by less than this, `half_mm` to both sides of a place."""
        near = self.places[np.abs(self.at_mm - mm) <= half_mm]
        if len(near) < 3:
            return False
        chord = near[-1] - near[0]
        d = near - near[0]
        aside = (d[:, 1] * chord[0] - d[:, 0] * chord[1]) / max(np.hypot(*chord), 1e-9)
        return bool(np.abs(aside).max() < within_mm)
