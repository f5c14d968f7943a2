"""Turned back: where a closed line turns back twice, tip towards tip, it may be two lines that go through.

    ╲       ╱      a circle leaves a side at a small angle and comes back: between the tips its ink and the
     >─────<       side's look like one line, and are one stretch of the net. The way round goes out along one
    ╱       ╲      line and back along the other

Signals: a closed way in; the stretches about such pairs of tips out, as where a line touches itself.

Source: our own. Questions: on a coast each tip faces some other; that one far away is its own headland.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import unit
from morfax.tracer.limits import BACK_RAD

# In widths of the line; chosen by trial on circles that touch lines and each other:
NEAR = 1.3  # sides that are nearer leave one ink
LONG = 60.0  # a longer stretch is no touch
LEG = 2.0  # of clean line before and after


class Touch(NamedTuple):
    """Where two lines touch, or one touches itself: the lines' numbers, from where to where along each, mm,
    with legs; whether both run the same way; and whether the line turns back there.
    """

    lines: tuple[int, int]
    first_mm: tuple[float, float]
    last_mm: tuple[float, float]
    is_parallel: bool
    turns_back: bool = False


def tip_to_tip(number: int, way: Array, step: float, width_mm: float) -> Iterator[Touch]:
    """Where a closed line, of a number and a width, turns back twice, tip towards tip: its way (n, 2) mm, a
    step of so many widths from place to place. With legs, where its sides are no longer near each other.
    """
    for one, other in combinations(_tips(way, round(LEG / step)), 2):
        between = way[other.at] - way[one.at]
        ahead = unit(between)
        is_far = float(np.hypot(*between)) > LONG * width_mm
        if is_far or min(one.ahead @ ahead, -other.ahead @ ahead) < -math.cos(BACK_RAD):
            continue
        half = [_reach(way, tip.at, NEAR * width_mm) + LEG / step for tip in (one, other)]
        first, begin = (
            step * width_mm * (tip.at - by) for tip, by in zip((one, other), half, strict=True)
        )
        last, end = (
            step * width_mm * (tip.at + by) for tip, by in zip((one, other), half, strict=True)
        )
        if last < begin:
            yield Touch((number, number), (first, begin), (last, end), True, True)


class _Tip(NamedTuple):
    """The place of a way at which it turns back, and the direction in which it came, (x, y)."""

    at: int
    ahead: Array


def _tips(way: Array, over: int) -> list[_Tip]:
    """Where a closed way (n, 2) turns back, from so many places before to so many behind."""
    before, after = way - np.roll(way, over, axis=0), np.roll(way, -over, axis=0) - way
    cosines = np.sum(unit(before) * unit(after), axis=1)
    least = np.min([np.roll(cosines, by) for by in range(-over, over + 1)], axis=0)
    found = np.flatnonzero((cosines == least) & (cosines < math.cos(BACK_RAD)))
    return [_Tip(at, unit(before[at] - after[at])) for at in found.tolist()]


def _reach(way: Array, at: int, near_mm: float) -> int:
    """How many places before and behind a tip the sides of a closed way (n, 2) mm are near each other; half
    of all at the most.
    """
    by = np.arange(1, len(way) // 2)
    sides = way[(at + by) % len(way)], way[at - by]
    return int(np.argmax(np.r_[np.hypot(*(sides[0] - sides[1]).T), math.inf] > near_mm))
