"""The path of the head by its length: places and headings a step apart, and the position that each one is.

Signals: positions (n, 2) mm at the motion rate in; places, and unit vectors along the path, every `step_mm`
out.

Source: our own.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.compiled import njit
from morfax.motion.long_array import LongArray, blocks
from morfax.motion.plane import unit


class HeadPath:
    """Where the head went: at each of `at_mm` along its path the place, the direction and the position."""

    def __init__(self, positions: Array, step_mm: float) -> None:
        self.step_mm = step_mm
        places, position, at = LongArray(), LongArray(1), np.zeros(3)
        for block in blocks(positions, before=1):
            walked = _walked(block, step_mm, len(places), at)
            places.add(walked[:, :2])
            position.add(walked[:, 2:])
            at[0] += len(block) - 1
        count = math.ceil(at[1] / step_mm)
        if len(places) < count:  # the last length is the end of the path, but for rounding
            places.add(positions[-1:, :2])
            position.add(at[None, 2:])
        self.at_mm = step_mm * np.arange(count)
        self.position = position.whole()[:count, 0]
        self.places = places.whole()[:count]
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
        chord_mm = max(np.hypot(*chord), NOT_ZERO)
        aside = (d[:, 1] * chord[0] - d[:, 0] * chord[1]) / chord_mm
        return bool(np.abs(aside).max() < within_mm)


def _walked(block: Array, step_mm: float, number: int, at: Array) -> Array:
    """Place and position (n, 3) at each multiple of a step from a number on, as far as a block of positions
    goes.

    `at` is moved along: the number of the block's first position, the length up to there, and the newest
    position to which the head came by moving.
    """
    count = math.ceil(_end_mm(block, at[1]) / step_mm) - number + 1
    walked = np.empty((max(count, 0), 3))
    return walked[: _walk(block, step_mm, number, at, walked)]


@njit(cache=True, _nrt=False)
def _end_mm(block, come_mm):  # type: ignore[no-untyped-def]
    """The length at the end of a block of positions, rounded otherwise than by hypot, which takes longer."""
    for k in range(len(block) - 1):
        dx = block[k + 1, 0] - block[k, 0]
        dy = block[k + 1, 1] - block[k, 1]
        come_mm += math.sqrt(dx * dx + dy * dy)
    return come_mm


@njit(cache=True, _nrt=False)
def _walk(block, step_mm, number, at, walked):  # type: ignore[no-untyped-def]
    """Fill in what is walked, and give how many places that are: with room that grows it takes five times as
    long.
    """
    count = 0
    first, come_mm, moved = at[0], at[1], at[2]
    for k in range(len(block) - 1):
        x = block[k, 0]
        y = block[k, 1]
        dx = block[k + 1, 0] - x
        dy = block[k + 1, 1] - y
        next_mm = come_mm + math.hypot(dx, dy)
        if next_mm == come_mm:
            continue
        long_mm = next_mm - come_mm
        while (number + count) * step_mm < next_mm:
            on_mm = (number + count) * step_mm - come_mm
            walked[count, 0] = dx / long_mm * on_mm + x
            walked[count, 1] = dy / long_mm * on_mm + y
            walked[count, 2] = (first + k + 1 - moved) / long_mm * on_mm + moved
            count += 1
        come_mm, moved = next_mm, first + k + 1
    at[1], at[2] = come_mm, moved
    return count


def _along(places: Array) -> Array:
    """Unit vectors along a way, from the places about each."""
    if len(places) < 2:
        return np.full((len(places), 2), 0.5**0.5)
    along, done = LongArray(), 0
    for block in blocks(places, before=2):
        steps = unit(np.gradient(block, axis=0))
        # the outermost are known where the way begins and ends; else they are the next block's
        first = 1 if done else 0
        done += len(block) - 1 - first
        along.add(steps[first:] if done + 1 == len(places) else steps[first:-1])
    return along.whole()
