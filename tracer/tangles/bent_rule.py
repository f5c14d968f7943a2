"""The way of a folding rule, bent at its corners, and how that way's ink differs from the ink that is seen.

    first ●────╮ rounded     an arc leaves each side where it touches it: as far from the corner as its
               │             radius asks for, and no further than the sides have room for
         sharp └────● last

Signals: the two ends of a rule (2, 2) mm, its figures (corners, radius, half the pen's width, mm) and which
corners are rounded in; places (n, 2) mm along it, and darkness drawn too much at each place of the ink, out.

Source: our own (see `folding_rule`). A fit draws a rule some ten times: in kernels.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import NOT_ZERO
from morfax.motion.compiled import njit
from morfax.tracer.tangles import moved_way, pen

# between the places of an arc: they lie within 1 um of one of 0.7 mm
ARC_RAD = math.radians(6.0)
MOST_OF_ARC = 2 + math.ceil(math.pi / ARC_RAD)
STRAIGHT = 1e-3  # tangent of half a turn: a smaller one is not rounded
# of a piece: an arc takes half of it at the most, and all but this of one that ends where it is sharp
KEPT = 0.02
# by which a figure is moved to see where that moves the places: less than a thousandth of what ink fades over
NUDGE_MM = 1e-6


@njit(cache=True)
def most_places(corners):  # type: ignore[no-untyped-def]
    """How many places a rule with so many corners has, at the most."""
    return 2 + corners * MOST_OF_ARC


@njit(cache=True, _nrt=False)
def bent(rule, corners, radius_mm, counts, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, 3) with places along a rule, x and y in mm, and 1 where it turns sharply; how many.

    `rule`: its ends (2, 2) mm, and which of its corners (k,) are rounded. `counts` (k,): how many places each
    corner has, filled in where it is 0: an arc has as many as its turn asks for.
    """
    (ends, rounded), last = rule, len(corners) - 1
    out[0, 0], out[0, 1], out[0, 2] = ends[0, 0], ends[0, 1], 0.0
    n = 1
    for k in range(last + 1):
        before = corners[k - 1] if k > 0 else ends[0]
        after = corners[k + 1] if k < last else ends[1]
        # a side is all of a corner's own if the corner at its other end is sharp
        own = k == 0 or not rounded[k - 1], k == last or not rounded[k + 1]
        near = before, corners[k], after
        arc = _arc(near, own, radius_mm, counts[k], out[n:]) if rounded[k] else 0
        if arc == 0:
            counts[k] = max(counts[k], 1)
            for i in range(n, n + counts[k]):
                out[i, 0], out[i, 1], out[i, 2] = corners[k, 0], corners[k, 1], 1.0
        else:
            counts[k] = arc
        n += counts[k]
    out[n, 0], out[n, 1], out[n, 2] = ends[1, 0], ends[1, 1], 0.0
    return n + 1


@njit(cache=True, _nrt=False)
def _arc(places, own, radius_mm, count, out):  # type: ignore[no-untyped-def]
    """Fill `out` with the places of the arc at the middle one of three places: how many, 0 where there is no
    room for an arc. `own`: whether the side before it, and that after it, are the corner's own; `count`: how
    many, 0 for as many as its turn asks for, 1 for none.
    """
    before, corner, after = places
    x, y = corner[0] - before[0], corner[1] - before[1]
    u, v = after[0] - corner[0], after[1] - corner[1]
    before_mm, after_mm = math.hypot(x, y), math.hypot(u, v)
    x, y = x / max(before_mm, NOT_ZERO), y / max(before_mm, NOT_ZERO)
    u, v = u / max(after_mm, NOT_ZERO), v / max(after_mm, NOT_ZERO)
    turned = math.atan2(x * v - y * u, x * u + y * v)
    slope = math.tan(min(0.5 * abs(turned), 1.5))
    # 1. how far from the corner it begins
    room_mm = min(
        before_mm * (1 - KEPT if own[0] else 0.5), after_mm * (1 - KEPT if own[1] else 0.5)
    )
    reach_mm = min(abs(radius_mm) * slope, room_mm)
    # a fit may throw a corner so far that nothing is known of its turn
    is_arc = abs(turned) <= math.pi and slope >= STRAIGHT and reach_mm >= 1e-6
    if count == 1 or not is_arc:
        return 0
    # 2. about its middle
    radius_mm = reach_mm / slope
    side = math.copysign(radius_mm, turned)
    middle_x = corner[0] - reach_mm * x - side * y
    middle_y = corner[1] - reach_mm * y + side * x
    count = count if count > 0 else 2 + math.ceil(abs(turned) / ARC_RAD)
    for k in range(count):
        along = abs(turned) * k / (count - 1)
        sine, cosine = radius_mm * math.sin(along), side * math.cos(along)
        out[k, 0] = middle_x + sine * x + cosine * y
        out[k, 1] = middle_y + sine * y - cosine * x
        out[k, 2] = 0.0
    return count


@njit(cache=True)
def wrong(ink, rule, figures, near, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n,) with the darkness that a rule of some figures draws too much at the places of an ink,
    and `near` (n, 3) with where it is nearest to these; `rule`: its ends, and which of its corners are
    rounded.
    """
    way = _way(rule, figures, np.zeros(len(rule[1]), np.int64))
    moved_way.wrong(_drawn_with(ink, figures[-1]), way, np.zeros(len(way), np.bool_), near, out)


@njit(cache=True)
def changes(ink, rule, figures, near, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, figures) with by how much each figure of a rule changes what is wrong at the places of
    an ink, to which it is nearest at `near` (n, 3), per mm.
    """
    # 1. how far each figure but the pen's moves the places of the way, each arc in as many steps
    last, counts = len(figures) - 1, np.zeros(len(rule[1]), np.int64)
    way = _way(rule, figures, counts)
    moves = np.empty((len(way), last, 2))
    for i in range(last):
        old = figures[i]
        figures[i] = old + NUDGE_MM
        moved = _way(rule, figures, counts)
        figures[i] = old
        moves[:, i] = (moved - way) / NUDGE_MM
    # 2. what that darkens, and what a wider pen does
    half_mm, sharp = figures[-1], np.zeros(len(way), np.bool_)
    moved_way.changes(_drawn_with(ink, half_mm), (way, moves, sharp), near, out[:, :last])
    for k in range(len(near)):
        away_mm = min(near[k, 0], ink.known_mm[k])
        out[k, last] = pen.fades_at(away_mm, half_mm, ink.softness_mm)


@njit(cache=True)
def _drawn_with(ink, half_mm):  # type: ignore[no-untyped-def]
    """An ink, with the pen that is to draw it."""
    return pen.Ink(ink.places_mm, ink.darkness, ink.known_mm, half_mm, ink.softness_mm)


@njit(cache=True)
def _way(rule, figures, counts):  # type: ignore[no-untyped-def]
    """The way (n, 2) mm of a rule of some figures, with as many places at each corner as `counts` says."""
    corners = figures[: 2 * len(counts)].reshape(-1, 2)
    radius_mm = figures[2 * len(counts)] if len(figures) > 2 * len(counts) + 1 else 0.0
    places = np.empty((most_places(len(counts)), 3))
    count = bent(rule, corners, radius_mm, counts, places)
    return places[:count, :2].copy()
