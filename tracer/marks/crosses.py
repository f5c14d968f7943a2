"""Crosses that a draughtsman drew: reference points, and symbols, which are crosses in a circle.

Signals in: a view, and the places at which strokes end, mm. Out: crosses: middle, reach of the arms, kind.

A ring of cells sees arms square to each other that end alike, four of them, or three and the lead line. The
place of the cross is where the middle lines of the arms meet.

    ─┼─   cross      ─⊕─   symbol: the position of something, or the middle of a hole

Source: our own; see `reference`. Questions: the patent does not say how a reference point is drawn.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.motion.plane import heading_of, meeting
from morfax.tracer.marks.sizes import ALIKE, CROSS_MM, INKED, SQUARE
from morfax.tracer.sensing.probe import TIP_WIDTHS, is_tip, lines_on
from morfax.tracer.sensing.view import View

LEAST_MM, LARGEST_MM = CROSS_MM
# widths from a cross's middle: the rings of cells that seek a circle
CIRCLED_FROM, CIRCLED_STEP = 1.5, 0.3
CIRCLED = 0.9  # share of a ring of cells that is ink, on a circle; the arms alone leave 0.43


@dataclass(frozen=True, slots=True)
class Cross:
    """A cross: its middle (2,), mm, how far its arms reach from there, mm; a circle makes it a symbol."""

    centre_mm: Array
    reach_mm: float
    kind: Literal["cross", "symbol"]


def crosses(view: View, tips_mm: Array) -> Iterator[Cross]:
    """The crosses whose arms end at some places."""
    tips = [tip for tip in tips_mm if is_tip(view, tip)]
    for i, a in enumerate(tips):
        for b in tips[i + 1 :]:
            if not LEAST_MM < math.dist(a, b) + view.width_mm < LARGEST_MM:
                continue
            others = [c for c in tips if c is not a and c is not b]
            found = (_cross(view, a, b, c) for c in others)
            yield from (cross for cross in found if cross is not None)


def _cross(view: View, a: Array, b: Array, c: Array) -> Cross | None:
    """The cross whose arms end at three tips, a and b of one stroke.

    The fourth arm may run on as the lead line, or another line may begin anywhere on it.
    """
    # 1. three arms square to each other, and a fourth, all of them inked
    half = 0.5 * (b - a)
    middle = a + 0.5 * (b - a)
    arm = c - middle
    reach = float(np.hypot(*half))
    length = float(np.hypot(*arm))
    if abs(length - reach) >= ALIKE * reach or abs(arm @ half) > SQUARE * length * reach:
        return None
    fourth = -arm * min(1.0, reach / length)
    if not all(_inked(view, middle, middle + way) for way in (-half, half, arm, fourth)):
        return None
    # 2. their middle lines cross in one place, as far from all the tips
    arms = [_felt_inward(view, tip, middle) for tip in (a, b, c)]
    if min(len(arm) for arm in arms) < 4:
        return None
    centre = _crossing(np.vstack(arms[:2]), arms[2])
    reaches = np.hypot(*(np.array([a, b, c]) - centre).T)
    if np.ptp(reaches) > ALIKE * median(reaches):
        return None
    # 3. no lines pass or cross here
    reach_mm = float(reaches.max())
    if lines_on(view, centre, reach_mm + TIP_WIDTHS * view.width_mm) > 1:
        return None
    return Cross(centre, reach_mm, "symbol" if _is_circled(view, centre) else "cross")


def _is_circled(view: View, centre: Array) -> bool:
    """Whether a circle of a reference point's size is drawn about a cross."""
    from_mm, step_mm = CIRCLED_FROM * view.width_mm, CIRCLED_STEP * view.width_mm
    for radius_mm in np.arange(from_mm, LARGEST_MM / 2, step_mm):
        arcs = view.ring(centre, float(radius_mm))
        if float(np.sum(arcs[:, 1] - arcs[:, 0])) > CIRCLED * math.tau:
            return True
    return False


def _inked(view: View, a: Array, b: Array) -> bool:
    """Whether there is ink all along a straight stretch, but for a speck of paper."""
    count = 2 + int(math.dist(a, b) / view.pitch_mm)
    return bool(np.mean([view.dark(place) for place in np.linspace(a, b, count)]) > INKED)


def _felt_inward(view: View, tip: Array, middle: Array) -> Array:
    """The clean stations (n, 2) of an arm, felt from its tip towards the middle."""
    way = middle - tip
    length = float(np.hypot(*way))
    start = tip + 0.3 * view.width_mm * way / length
    return view.feel(start, heading_of(way), length - view.width_mm)[:, :2]


def _crossing(one: Array, other: Array) -> Array:
    """Where the straight lines through two strokes' places (n, 2) cross."""
    return meeting(*_straight(one), *_straight(other))


def _straight(places: Array) -> tuple[Array, Array]:
    """Middle and direction of the straight line through places (n, 2), least squares."""
    middle = places.mean(axis=0)
    return middle, np.linalg.svd(places - middle)[2][0]
