r"""Pointed tips: where a pen that draws pointed corners leaves ink beyond the tips of a way.

         ╱╲
        ╱  ╲      beyond a tip the outer edges of both sides run on until they meet: within width / 2 of the
       ╱ /\ ╲     sides as they would run on, straight, for width / 2 · tan(turn / 2)

Signals: a closed line that was followed in; places (n, 2) mm of the sides of its tips as they would run on
out. A corner that is no tip has its point within a width.

Source: SVG 1.1, stroke-linejoin and stroke-miterlimit: a corner so sharp that its point would be longer than
4 widths is cut off there.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from morfax.motion.arrays import ROUNDED, Array
from morfax.motion.compiled import njit
from morfax.motion.plane import unit
from morfax.motion.polyline import evenly
from morfax.tracer.following.line import Line
from morfax.tracer.limits import TIP_RAD

MITRE_LIMIT = 4.0  # widths from a point to the corner's inner side
STEP_WIDTHS = 0.125  # between the places of a way
LEG = 8  # steps on either side of a corner, which show its sides
NEAR = 4  # steps: of so near places that with the most turn is the corner


def points_of(line: Line) -> Iterator[Array]:
    """The sides of each tip of a closed line that a pen may have pointed, as they would run on."""
    width_mm = line.width_mm
    way = evenly(line.loop_mm, STEP_WIDTHS * width_mm)
    if len(way) <= 2 * LEG:
        return
    if not _turns_by(way, LEG, TIP_RAD - ROUNDED):
        return
    # 1. the directions in which both sides of each place come to it, and how much they turn there
    come = unit(way - np.roll(way, LEG, axis=0))
    back = unit(way - np.roll(way, -LEG, axis=0))
    turn = np.arccos(np.clip(-np.sum(come * back, axis=1), -1, 1))
    # 2. the tips that no pen cuts off, and how far their points reach
    is_tip = (turn > TIP_RAD) & (np.cos(0.5 * turn) > 1 / MITRE_LIMIT)
    for k in np.flatnonzero(is_tip):
        if turn[k] < max(turn[(k + shift) % len(way)] for shift in range(-NEAR, NEAR + 1)):
            continue
        long_mm = 0.5 * width_mm * np.tan(0.5 * turn[k])
        on_mm = np.arange(0.0, long_mm, STEP_WIDTHS * width_mm)[:, None]
        yield way[k] + on_mm * come[k]
        yield way[k] + on_mm * back[k]


@njit(cache=True, _nrt=False)
def _turns_by(way, leg, rad):  # type: ignore[no-untyped-def]
    """Whether a closed way (n, 2) turns anywhere by more than an angle, from a chord of so many places to the
    next; most lines of a plate do not.
    """
    count, most = len(way), math.cos(rad)
    for k in range(count):
        before, after = (k - leg) % count, (k + leg) % count
        x, y = way[k, 0] - way[before, 0], way[k, 1] - way[before, 1]
        u, v = way[after, 0] - way[k, 0], way[after, 1] - way[k, 1]
        if not x * u + y * v > most * math.sqrt((x * x + y * y) * (u * u + v * v)):
            return True
    return False
