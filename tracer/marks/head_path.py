"""The path of the head by its length: places and headings a step apart, and the position that each one is.

Signals: positions (n, 2) mm at the motion rate in; places, and unit vectors along the path, every `step_mm`
out.

Source: our own.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.long_array import LongArray, blocks
from morfax.motion.polyline import lengths_by_blocks


class HeadPath:
    """Where the head went: at each of `at_mm` along its path the place, the direction and the position."""

    def __init__(self, positions: Array, step_mm: float) -> None:
        self.step_mm = step_mm
        position, there = LongArray(1), LongArray()
        # the newest position that the head came to by moving, and how far it had come there
        moved = np.zeros((1, 2))
        for first, places, lengths in lengths_by_blocks(positions):
            new = np.flatnonzero(np.diff(lengths) > 0) + 1
            moved = np.vstack([moved[-1:], np.column_stack([lengths[new], first + new])])
            is_last = first + len(places) == len(positions)
            at_mm = step_mm * np.arange(len(there), np.ceil(lengths[-1] / step_mm))
            at_mm = at_mm if is_last else at_mm[at_mm < lengths[-1]]
            columns = [np.interp(at_mm, lengths, column) for column in places.T[:2]]
            there.add(np.column_stack(columns))
            position.add(np.interp(at_mm, *moved.T)[:, None])
        self.at_mm, self.position = step_mm * np.arange(len(there)), position.whole()[:, 0]
        self.places = there.whole()
        self.along = _along(self.places)

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
        chord_mm = max(np.hypot(*chord), 1e-9)
        aside = (d[:, 1] * chord[0] - d[:, 0] * chord[1]) / chord_mm
        return bool(np.abs(aside).max() < within_mm)


def _along(places: Array) -> Array:
    """Unit vectors along a way, from the places about each."""
    if len(places) < 2:
        return np.full((len(places), 2), 0.5**0.5)
    along, done = LongArray(), 0
    for block in blocks(places, before=2):
        steps = np.gradient(block, axis=0)
        steps = steps / np.maximum(np.hypot(*steps.T), 1e-12)[:, None]
        # the outermost are known where the way begins and ends; else they are the next block's
        first = 1 if done else 0
        done += len(block) - 1 - first
        along.add(steps[first:] if done + 1 == len(places) else steps[first:-1])
    return along.whole()
