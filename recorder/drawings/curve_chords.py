"""Curve chords: arcs, ellipses and Béziers become chords that stay within a distance of them.

Signals in: curves by their own figures, and how far a chord may be off, in any one unit of length. Signals
out: places (n, 2), those after the curve's beginning.

    arc of radius r    a chord over the angle a is r (1 - cos(a / 2)) off: a = 2 acos(1 - off / r)
    Bézier B(t)        n chords are at most max|B''| / (8 n²) off (linear interpolation's error)

Questions: an ellipse is a circle seen aslant, which brings no chord further off than on its larger circle.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from morfax.motion.arrays import Array

MOST_CHORDS = 100_000  # of one curve; a circle of 1 m has 2 223 at INCREMENT_MM


def chords_of(radius: float, turned_rad: float, off: float) -> int:
    """How many chords an arc needs so that none is further off."""
    if not off < radius:
        return max(1, math.ceil(abs(turned_rad) / math.pi))
    widest_rad = 2 * math.acos(1 - off / radius)
    return max(1, min(MOST_CHORDS, math.ceil(abs(turned_rad) / widest_rad)))


def bulged(begin: Array, end: Array, turned_rad: float, off: float) -> Array:
    """Places on an arc between two places that turns by an angle, rad, + left, not 0.

    A chord from the beginning is turned out of the whole chord by half of the angle that is left.
    """
    chord = complex(*end) - complex(*begin)
    radius = abs(chord) / abs(2 * math.sin(turned_rad / 2))
    count = chords_of(radius, turned_rad, off)
    share = np.arange(1, count) / count
    part = np.sin(share * turned_rad / 2) / math.sin(turned_rad / 2)
    places = complex(*begin) + chord * part * np.exp(-0.5j * (1 - share) * turned_rad)
    return np.vstack([np.column_stack([places.real, places.imag]), np.asarray(end, float)])


def bezier(points: Array, off: float) -> Array:
    """Places on a Bézier of two, three or four points (n, 2)."""
    degree = len(points) - 1
    if degree < 2:
        return np.asarray(points[-1:], float)
    bend = np.abs(np.diff(points, n=2, axis=0))
    most = degree * (degree - 1) * float(np.hypot(*bend.T).max())
    count = min(MOST_CHORDS, max(1, math.ceil(math.sqrt(most / (8 * off)))))
    t = (np.arange(1, count + 1) / count)[:, None]
    level = [np.broadcast_to(point, (count, 2)) for point in np.asarray(points, float)]
    while len(level) > 1:  # de Casteljau
        level = [(1 - t) * a + t * b for a, b in pairwise(level)]
    places = np.array(level[0])
    places[-1] = points[-1]
    return places
