"""The pen: what ink it would leave on a way through a tangle.

A strand leads from one leg's clean end to another's. It leaves each along the leg's heading, bends evenly to
its first vertex, and goes straight between its vertices; without a vertex it is one cubic. A stroke is a
straight line by itself. A pen of the line's width w leaves on a place at distance d

    darkness = erfc((d - w/2) / (softness·√2)) / 2

Signals: places and darkness (see `tangle`), poses (x, y, heading) of the legs' ends and vertices, mm and rad,
in; straight pieces and darkness out. Distances from these are those of `distances`; to the way that leaves
the ink that is there see `settling`.

Source: our own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.compiled import njit
from morfax.tracer.limits import FADES
from morfax.tracer.sensing.photocell import darkness_at

# Chosen by trial on the test drawings.
PIECES = 6  # straight pieces that a bend is drawn with
STEEPEST = 0.6  # cosine: a bend that leaves further aside of its chord reaches no further ahead
SPECK_PX = 1.5  # from the middle of a speck to the ink beside it
NARROW_RAD = math.radians(3)  # a tip as narrow as this is a tick


class Ink(NamedTuple):
    """The ink of a tangle: its places (n, 2), their darkness, and how far each is from what is drawn anyway.

    The pen leaves half a width of ink to either side, of some softness.
    """

    places_mm: Array
    darkness: Array
    known_mm: Array
    half_mm: float
    softness_mm: float


class Drawn(NamedTuple):
    """What is drawn: pairs of poses (k, 2, 3), the vertices that each strand has, and how many strokes."""

    ends: Array
    counts: NDArray[np.int64]
    strokes: int


@njit(cache=True)
def bend(pose, x, y, t):  # type: ignore[no-untyped-def]
    """Place at a share t of the bend that leaves a pose along its heading and ends at (x, y)."""
    x0, y0, heading = pose[0], pose[1], pose[2]
    dx, dy = x - x0, y - y0
    chord = math.hypot(dx, dy)
    c, s = math.cos(heading), math.sin(heading)
    cosine = (dx * c + dy * s) / max(chord, NOT_ZERO)
    reach = 0.5 * chord / max(cosine, STEEPEST)
    a, b, d = (1 - t) ** 2, 2 * t * (1 - t), t * t
    return a * x0 + b * (x0 + reach * c) + d * x, a * y0 + b * (y0 + reach * s) + d * y


@njit(cache=True, _nrt=False)
def bend_at(pose, x, y, shares, places):  # type: ignore[no-untyped-def]
    """Fill in the places (n, 2) at shares (n,) of a bend."""
    for k in range(len(shares)):
        places[k, 0], places[k, 1] = bend(pose, x, y, shares[k])


@njit(cache=True)
def cubic(pose, other, t):  # type: ignore[no-untyped-def]
    """Place at a share t of the cubic between two poses that face each other.

    It is `motion.curves.hermite` place by place, as a kernel needs it.
    """
    chord = math.hypot(other[0] - pose[0], other[1] - pose[1])
    h, p, q = t * t * (3 - 2 * t), chord * t * (1 - t) ** 2, chord * t * t * (1 - t)
    x = pose[0] * (1 - h) + other[0] * h + p * math.cos(pose[2]) + q * math.cos(other[2])
    y = pose[1] * (1 - h) + other[1] * h + p * math.sin(pose[2]) + q * math.sin(other[2])
    return x, y


@njit(cache=True)
def most_pieces(drawn, vertices):  # type: ignore[no-untyped-def]
    """How many straight pieces there are at the most."""
    return 2 * PIECES * len(drawn.ends) + 2 * len(vertices) + 1


@njit(cache=True)
def pieces(drawn, vertices, out):  # type: ignore[no-untyped-def]
    """Draw strands and strokes as straight pieces (4, n): x and y of either end; how many."""
    n = at = 0
    # 1. strands
    for k in range(len(drawn.ends)):
        first, last, count = drawn.ends[k, 0], drawn.ends[k, 1], drawn.counts[k]
        if count == 0:
            n = _cubic_pieces(first, last, out, n)
            continue
        n = _bend_pieces(first, vertices[at], out, n)
        for i in range(at, at + count - 1):
            n = _piece(vertices[i], vertices[i + 1], out, n)
        at += count
        n = _bend_pieces(last, vertices[at - 1], out, n)
    # 2. strokes
    for _ in range(drawn.strokes):
        n = _piece(vertices[at], vertices[at + 1], out, n)
        at += 2
    return n


@njit(cache=True)
def _piece(start, end, out, n):  # type: ignore[no-untyped-def]
    """Write one straight piece; how many there are then."""
    out[0, n], out[1, n], out[2, n], out[3, n] = start[0], start[1], end[0], end[1]
    return n + 1


@njit(cache=True)
def _cubic_pieces(first, last, out, n):  # type: ignore[no-untyped-def]
    """Write the pieces of a cubic; how many there are then."""
    start = (first[0], first[1])
    for i in range(1, 2 * PIECES + 1):
        end = cubic(first, last, i / (2 * PIECES))
        n = _piece(start, end, out, n)
        start = end
    return n


@njit(cache=True)
def _bend_pieces(pose, vertex, out, n):  # type: ignore[no-untyped-def]
    """Write the pieces of a bend; how many there are then."""
    start = (pose[0], pose[1])
    for i in range(1, PIECES + 1):
        end = bend(pose, vertex[0], vertex[1], i / PIECES)
        n = _piece(start, end, out, n)
        start = end
    return n


@njit(cache=True)
def on_paper_mm(cells, lines, count):  # type: ignore[no-untyped-def]
    """Length on paper of the first pieces of some lines (4, k), mm; a speck within the ink is no paper."""
    total, level = 0.0, cells.level
    for i in range(count):
        vx, vy = lines[2, i] - lines[0, i], lines[3, i] - lines[1, i]
        length = math.hypot(vx, vy)
        steps = max(1, math.ceil(length / cells.pitch_mm))
        aside = SPECK_PX * cells.pitch_mm / max(length, NOT_ZERO)
        for k in range(steps):
            t = (k + 0.5) / steps
            x, y = lines[0, i] + t * vx, lines[1, i] + t * vy
            if darkness_at(cells, x, y) < level and (
                darkness_at(cells, x - aside * vy, y + aside * vx) < level
                or darkness_at(cells, x + aside * vy, y - aside * vx) < level
            ):
                total += length / steps
    return total


@njit(cache=True)
def tips(drawn, vertices):  # type: ignore[no-untyped-def]
    """At how many vertices strands go back on themselves."""
    found = at = 0
    for k in range(len(drawn.ends)):
        x, y = drawn.ends[k, 0, 0], drawn.ends[k, 0, 1]
        for i in range(at, at + drawn.counts[k]):
            here_x, here_y = vertices[i, 0], vertices[i, 1]
            after_x, after_y = drawn.ends[k, 1, 0], drawn.ends[k, 1, 1]
            if i + 1 < at + drawn.counts[k]:
                after_x, after_y = vertices[i + 1, 0], vertices[i + 1, 1]
            turned = math.atan2(after_y - here_y, after_x - here_x)
            turned -= math.atan2(here_y - y, here_x - x)
            turned -= math.tau * round(turned / math.tau)
            found += abs(turned) > math.pi - NARROW_RAD
            x, y = here_x, here_y
        at += drawn.counts[k]
    return found


@njit(cache=True)
def ink_at(distance_mm, half_mm, softness_mm):  # type: ignore[no-untyped-def]
    """Darkness that a pen of half a width leaves at a distance from its way."""
    u = (distance_mm - half_mm) / (math.sqrt(2.0) * softness_mm)
    return 0.5 * math.erfc(u) if abs(u) < FADES else (0.0 if u > 0 else 1.0)


@njit(cache=True)
def fades_at(distance_mm, half_mm, softness_mm):  # type: ignore[no-untyped-def]
    """How much darker a place at a distance becomes for each mm that the pen's way comes nearer."""
    u = (distance_mm - half_mm) / (math.sqrt(2.0) * softness_mm)
    return math.exp(-u * u) / (math.sqrt(math.tau) * softness_mm) if abs(u) < FADES else 0.0


@njit(cache=True)
def ink(distance_mm, half_mm, softness_mm, out):  # type: ignore[no-untyped-def]
    """Darkness that a pen of half a width leaves at distances from its way."""
    for k in range(len(distance_mm)):
        out[k] = ink_at(distance_mm[k], half_mm, softness_mm)


@njit(cache=True, _nrt=False)
def misfits(across, half_mm, softnesses_mm, out):  # type: ignore[no-untyped-def]
    """Fill `out` with how far the ink of a pen of half a width is from what is seen across its line, a sum of
    squares, for some softnesses; `across`: distances from the line, mm, and darkness there.
    """
    away_mm, seen = across
    for n in range(len(softnesses_mm)):
        out[n] = 0.0
        for k in range(len(seen)):
            wrong = ink_at(away_mm[k], half_mm, softnesses_mm[n]) - seen[k]
            out[n] += wrong * wrong
