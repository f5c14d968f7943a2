"""The pen: what ink it would leave on a way through a tangle, and the way that leaves the ink that is there.

A strand leads from one leg's clean end to another's. It leaves each along the leg's heading, bends evenly to
its first vertex, and goes straight between its vertices; without a vertex it is one cubic. A stroke is a
straight line by itself. A pen of the line's width w leaves on a place at distance d

    darkness = erfc((d - w/2) / (softness·√2)) / 2

The vertices are moved until the square of what is wrong, summed over the tangle, is least (Levenberg and
Marquardt).

Signals: places and darkness (see `tangle`), poses (x, y, heading) of the legs' ends, mm and rad; vertices in
and out.

Source: our own.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from morfax.tracer.sensing.photocell import darkness_at

PIECES = 6  # straight pieces that a bend is drawn with
NUDGE_MM = 0.01
FARTHEST_MM = 0.3  # a vertex is moved at a time
SPECK_PX = 1.5  # from the middle of a speck to the ink beside it
MOST_DAMPED = 6  # times that a step is tried again, shorter


@njit(cache=True)
def bend(x0, y0, heading, x1, y1, t):  # type: ignore[no-untyped-def]
    """Place at a share t of the bend that leaves (x0, y0) along a heading and ends at (x1, y1)."""
    dx, dy = x1 - x0, y1 - y0
    chord = math.hypot(dx, dy)
    c, s = math.cos(heading), math.sin(heading)
    reach = 0.5 * chord / max((dx * c + dy * s) / max(chord, 1e-9), 0.6)
    a, b, d = (1 - t) ** 2, 2 * t * (1 - t), t * t
    return a * x0 + b * (x0 + reach * c) + d * x1, a * y0 + b * (y0 + reach * s) + d * y1


@njit(cache=True)
def cubic(pose, other, t):  # type: ignore[no-untyped-def]
    """Place at a share t of the cubic between two poses that face each other."""
    chord = math.hypot(other[0] - pose[0], other[1] - pose[1])
    h, p, q = t * t * (3 - 2 * t), chord * t * (1 - t) ** 2, chord * t * t * (1 - t)
    x = pose[0] * (1 - h) + other[0] * h + p * math.cos(pose[2]) + q * math.cos(other[2])
    y = pose[1] * (1 - h) + other[1] * h + p * math.sin(pose[2]) + q * math.sin(other[2])
    return x, y


@njit(cache=True)
def pieces(ends, counts, strokes, vertices, out):  # type: ignore[no-untyped-def]
    """Straight pieces (4, n) of strands between pairs of poses (k, 2, 3) with `counts` vertices each, and of
    single strokes; how many.
    """
    n = at = 0
    for k in range(len(ends)):
        first, last = ends[k, 0], ends[k, 1]
        x, y = first[0], first[1]
        if counts[k] == 0:
            for i in range(1, 2 * PIECES + 1):
                to_x, to_y = cubic(first, last, i / (2 * PIECES))
                out[0, n], out[1, n], out[2, n], out[3, n] = x, y, to_x, to_y
                n, x, y = n + 1, to_x, to_y
            continue
        for i in range(1, PIECES + 1):
            to_x, to_y = bend(
                first[0], first[1], first[2], vertices[at, 0], vertices[at, 1], i / PIECES
            )
            out[0, n], out[1, n], out[2, n], out[3, n] = x, y, to_x, to_y
            n, x, y = n + 1, to_x, to_y
        for i in range(at, at + counts[k] - 1):
            out[0, n], out[1, n] = vertices[i, 0], vertices[i, 1]
            out[2, n], out[3, n] = vertices[i + 1, 0], vertices[i + 1, 1]
            n += 1
        at += counts[k]
        x, y = last[0], last[1]
        for i in range(1, PIECES + 1):
            to_x, to_y = bend(
                last[0], last[1], last[2], vertices[at - 1, 0], vertices[at - 1, 1], i / PIECES
            )
            out[0, n], out[1, n], out[2, n], out[3, n] = x, y, to_x, to_y
            n, x, y = n + 1, to_x, to_y
    for _ in range(strokes):
        out[0, n], out[1, n] = vertices[at, 0], vertices[at, 1]
        out[2, n], out[3, n] = vertices[at + 1, 0], vertices[at + 1, 1]
        n, at = n + 1, at + 2
    return n


@njit(cache=True, fastmath=True)
def away(places, lines, count, out):  # type: ignore[no-untyped-def]
    """Bring distances (n,) of places down to those from the first pieces of some lines (4, k), where these
    are nearer; mm.
    """
    x0, y0 = lines[0, :count].copy(), lines[1, :count].copy()
    vx, vy = lines[2, :count] - x0, lines[3, :count] - y0
    per = 1.0 / (vx * vx + vy * vy + 1e-18)
    for k in range(len(places)):
        best = out[k] * out[k]
        x, y = places[k, 0], places[k, 1]
        for i in range(count):
            wx, wy = x - x0[i], y - y0[i]
            t = min(max((wx * vx[i] + wy * vy[i]) * per[i], 0.0), 1.0)
            wx, wy = wx - t * vx[i], wy - t * vy[i]
            best = min(best, wx * wx + wy * wy)
        out[k] = math.sqrt(best)


@njit(cache=True)
def on_paper_mm(cells, lines, count):  # type: ignore[no-untyped-def]
    """Length of the first pieces of some lines (4, k) that lies on paper, mm; a speck of it with ink on both
    sides is none.
    """
    total, pitch_mm, level = 0.0, cells.pitch_mm, cells.level
    for i in range(count):
        vx, vy = lines[2, i] - lines[0, i], lines[3, i] - lines[1, i]
        length = math.hypot(vx, vy)
        steps = max(1, math.ceil(length / pitch_mm))
        aside = SPECK_PX * pitch_mm / max(length, 1e-9)
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
def ink(distance_mm, half_mm, softness_mm, out):  # type: ignore[no-untyped-def]
    """Darkness that a pen of half a width leaves at distances from its way."""
    for k in range(len(distance_mm)):
        u = (distance_mm[k] - half_mm) / (math.sqrt(2.0) * softness_mm)
        out[k] = 0.5 * math.erfc(u) if abs(u) < 3.0 else (0.0 if u > 0 else 1.0)


@njit(cache=True)
def _wrong(  # type: ignore[no-untyped-def]
    places, darkness, known_mm, pen, ends, counts, strokes, vertices, lines, distance, out
):
    """What is drawn too dark at each place, into `out`; the sum of its squares."""
    distance[:] = known_mm
    away(places, lines, pieces(ends, counts, strokes, vertices, lines), distance)
    ink(distance, pen[0], pen[1], out)
    total = 0.0
    for k in range(len(places)):
        out[k] -= darkness[k]
        total += out[k] * out[k]
    return total


@njit(cache=True)
def settle(places, darkness, known_mm, pen, ends, counts, strokes, vertices, rounds):  # type: ignore[no-untyped-def]
    """Move the vertices (k, 2), in place, to where the pen (half a width, softness) leaves the ink that is
    there; the sum of squares that is left.

    `known_mm` is how far each place is from what is drawn anyway: the legs.
    """
    n, p = len(places), 2 * len(vertices)
    lines = np.empty((4, 2 * PIECES * len(ends) + p + 1))
    now, trial, distance = np.empty(n), np.empty(n), np.empty(n)
    best = _wrong(
        places, darkness, known_mm, pen, ends, counts, strokes, vertices, lines, distance, now
    )
    change = np.empty((p, n))
    damping = 1e-2
    for _ in range(rounds if p > 0 else 0):
        for i in range(p):
            old = vertices[i // 2, i % 2]
            vertices[i // 2, i % 2] = old + NUDGE_MM
            _wrong(
                places,
                darkness,
                known_mm,
                pen,
                ends,
                counts,
                strokes,
                vertices,
                lines,
                distance,
                change[i],
            )
            vertices[i // 2, i % 2] = old
            change[i] = (change[i] - now) / NUDGE_MM
        square, right = change @ change.T, change @ now
        before = best
        for _ in range(MOST_DAMPED):
            step = np.linalg.solve(square + np.diag(damping * np.diag(square) + 1e-6), right)
            step *= min(1.0, FARTHEST_MM / (np.max(np.abs(step)) + 1e-12))
            moved = vertices - step.reshape(-1, 2)
            total = _wrong(
                places,
                darkness,
                known_mm,
                pen,
                ends,
                counts,
                strokes,
                moved,
                lines,
                distance,
                trial,
            )
            if total < best:
                best, damping = total, max(0.3 * damping, 1e-4)
                vertices[:] = moved
                now[:] = trial
                break
            damping *= 4
        if best > before * (1 - 1e-3):
            break
    return best
