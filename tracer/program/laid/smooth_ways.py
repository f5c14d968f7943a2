"""Smooth ways: how a line goes on through ink that it shares with another, by its clean legs alone.

    ──╲________╱──      the rims of shared ink tell its lines where each keeps to its own side. Lines that
    ──╱‾‾‾‾‾‾‾‾╲──      cross at a small angle change sides: each bends evenly from its leg before to that
                        behind, and the ink tells which leg behind is whose

Signals: the ways (n, 2) mm of which the one has the leg before and the other the leg after, a step from place
to place, in; the way from leg to leg out.

Source: our own; the cubic that is nearest to an arc, and is one within 2 um per mm of its radius over 120
degrees.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.curves import cubic
from morfax.motion.plane import direction
from morfax.tracer.ink.run import parabolas
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.sensing.view import STEP_WIDTHS

Left = Callable[[Array, Array], float]


class BothWays(NamedTuple):
    """The ways of two sides through their ink, in the direction of the one, which is that from where the one
    comes; whether they end on the other's side; and what they leave unexplained for each width.
    """

    one: LaidWay
    other: LaidWay
    is_exchanged: bool
    left: float


def smooth_ways(
    one: Array,
    other: Array,
    leg_widths: float,
    width_mm: float,
    left: Left,
    *,
    may_exchange: bool,
) -> BothWays:
    """The ways that leave least, from the middles of the legs at the beginnings of two ways (n, 2) mm to the
    middles of those at their ends: each to its own, or each to the other's.
    """
    leg, found = round(leg_widths / STEP_WIDTHS), list[BothWays]()
    for is_exchanged in (False, True)[: 1 + may_exchange]:
        onto = (other, one) if is_exchanged else (one, other)
        first, second = (
            _smooth_way(into, out_of, leg, width_mm)
            for into, out_of in zip((one, other), onto, strict=True)
        )
        found.append(BothWays(first, second, is_exchanged, left(first.way, second.way)))
    return min(found, key=lambda both: both.left)


def _smooth_way(into: Array, out_of: Array, leg: int, width_mm: float) -> LaidWay:
    """The way from the middle of the leg at the beginning of one way, so many places from either end of the
    leg, as smoothly as it goes to the middle of the leg at the end of another.
    """
    step_mm = STEP_WIDTHS * width_mm
    first, heading = _pose(into[: 2 * leg + 1], step_mm)
    last, heading_back = _pose(out_of[: -2 * leg - 2 : -1], step_mm)
    way = _cubic(first, direction(heading), last, direction(heading_back), step_mm)
    return LaidWay((way,), 0.5 * width_mm)


def _pose(leg: Array, step_mm: float) -> tuple[Array, float]:
    """The place in the middle of a leg (n, 2) mm, and along which way it goes on there, rad."""
    middle = len(leg) // 2
    _, headings, _ = parabolas(np.ascontiguousarray(leg), middle * step_mm, step_mm)
    return leg[middle], float(headings[middle])


def _cubic(first: Array, ahead: Array, last: Array, back: Array, step_mm: float) -> Array:
    """The cubic from a place ahead along one direction to another, from which it goes back along another;
    (n, 2) mm.
    """
    chord = last - first
    long_mm = max(float(np.hypot(*chord)), step_mm)
    # an arc's slopes: the chord, over the square of the cosine of half the angle to it
    leaves, comes = (1 + max(float(way @ chord) / long_mm, 0.0) for way in (ahead, -back))
    leaving, arriving = 2 * long_mm / leaves * ahead, -2 * long_mm / comes * back
    count = 1 + math.ceil(long_mm / step_mm)
    return cubic(first, leaving.tolist(), last, arriving.tolist(), count)
