"""The arm: the end of an arm across the heading of a line, as long as a tool's radius.

Signals: a line (n, 2) mm in; the way of the arm's end to the left of it, (m, 2) mm, out.

    away from the tool    the arm swings round the vertex: an arc
    towards the tool      the arm is drawn in, swings back, and is put out again: a loop within the radius of
                          the vertex, which trimming takes out
    by very little        the way goes straight to where the two ways beside the vertex meet

Source: our own, from first principles; as on steered copying heads.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import BEND_RAD, left_of
from morfax.motion.polyline import APART_MM, UM, WITHIN_MM, closed_up, with_places

PLAIN = WITHIN_MM  # a line is known by places between which it is straight within this
DEEP_MM = 0.05  # nearer than the radius by this: no crossing there can count
KINK_MM = 0.1 * UM  # ... if the way comes no nearer to the line than this; by trial
BACK = math.radians(179)  # a line that turns by more comes back along itself: round its tip


def sagitta_rad(radius_mm: float) -> float:
    """The angle of a chord whose sagitta is `PLAIN`, on a circle of this radius."""
    return math.sqrt(8 * PLAIN / radius_mm)


def swung(line: Array, closed: bool, radius_mm: float) -> Array:
    """The end of the arm to the left of a line, (n, 2) mm; a closed line is left open."""
    # 1. headings, lengths and arms of the straight pieces
    ways = np.diff(closed_up(line) if closed else line, axis=0)
    lengths = np.hypot(*ways.T)
    ways /= lengths[:, None]
    arms = radius_mm * left_of(ways)
    # 2. the pieces before and after each vertex
    if closed:
        vertices, after = line, ways
        before = np.roll(ways, 1, axis=0)
        arms_before = np.roll(arms, 1, axis=0)
        beside_mm = np.minimum(np.roll(lengths, 1), lengths)
    else:
        vertices, after = line[1:-1], ways[1:]
        before = ways[:-1]
        arms_before = arms[:-1]
        beside_mm = np.minimum(lengths[:-1], lengths[1:])
    turns = _turns(before, after)
    turns[np.abs(turns) > BACK] = -math.pi
    # 3. the swing at each vertex
    parts = [
        _swing(vertex, arm, turn, reach_mm, radius_mm)
        for vertex, arm, turn, reach_mm in zip(
            vertices, arms_before, turns, beside_mm, strict=True
        )
    ]
    if closed:
        return with_places(closed_up(np.vstack(parts)), APART_MM)[:-1]
    ends = line[:1] + arms[0], line[-1:] + arms[-1]
    return with_places(np.vstack([ends[0], *parts, ends[1]]), APART_MM)


def _turns(before: Array, after: Array) -> Array:
    """By how much one heading (n, 2) turns to the left to the other, rad."""
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return np.arctan2(across, np.einsum("ij,ij->i", before, after))


def _swing(vertex: Array, arm: Array, turn: float, beside_mm: float, radius_mm: float) -> Array:
    """Places of the arm's end while it turns at a vertex; the line is straight for `beside_mm` beside it."""
    # how far the meeting of the two ways is beyond the straight pieces
    beyond_mm = max(0.0, radius_mm * math.tan(max(turn, 0.0) / 2) - beside_mm)
    towards_slightly = 0 <= turn < BEND_RAD and beyond_mm * turn < KINK_MM
    if towards_slightly or -sagitta_rad(radius_mm) < turn < 0:
        middle = _turned(arm, np.array([turn / 2]))
        return np.asarray(vertex + middle / math.cos(turn / 2))
    if turn > 0:
        first, last = arm, _turned(arm, np.array([turn]))[0]
        drawn_in = max(0.0, 1 - 2 * DEEP_MM / radius_mm)
        return np.asarray(vertex + np.vstack([first, drawn_in * first, drawn_in * last, last]))
    steps = math.ceil(-turn / sagitta_rad(radius_mm))
    return np.asarray(vertex + _turned(arm, np.linspace(0, turn, steps + 1)))


def _turned(arm: Array, angles: Array) -> Array:
    """An arm turned by angles, (n, 2)."""
    c, s = np.cos(angles), np.sin(angles)
    x = c * arm[0] - s * arm[1]
    y = s * arm[0] + c * arm[1]
    return np.column_stack([x, y])
