"""Settling: the vertices of a way through a tangle move to where the pen leaves the ink that is there.

The sum over the tangle's places of what is drawn too dark, squared, is made least (Levenberg and Marquardt).
A vertex moves few of the straight pieces that are drawn (see `_span`): for each place only the nearest of
those is sought anew, and held against the nearest of the others.

Signals: the tangle's ink, what is drawn, its vertices (k, 2) mm in; the vertices moved, and the sum of the
squares of what is still wrong, out.

Source: our own. Questions: scipy has a Levenberg and Marquardt too. This one runs in the kernel, on a few
vertices, some hundred times per tangle; calls from there into Python would take longer than the fit.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import NOT_ZERO
from morfax.motion.compiled import njit
from morfax.motion.plane import NOTHING_MM2
from morfax.tracer.effort import ROUNDS
from morfax.tracer.tangles.pen import (
    PIECES,
    ink_at,
    most_pieces,
    on_paper_mm,
    pieces,
    tips,
)

# Chosen by trial on the test drawings.
NUDGE_MM = 0.01  # by which a vertex is moved to see what that changes
FARTHEST_MM = 0.3  # a vertex is moved at a time
DAMPING, LEAST_DAMPING = 1e-2, 1e-4  # of the step: at first, and at the least
EASED, DAMPED = 0.3, 4  # times: after a step that was good, and after one that was not
LEAST_GAIN = 1e-3  # of what is wrong: a smaller gain ends the fit


@njit(cache=True, fastmath=True, _nrt=False)
def _near(places, lines, first, last, squares):  # type: ignore[no-untyped-def]
    """Lower the squares (n,), mm2, of distances of places (2, n) to those from some pieces of lines (4, k).

    Piece by piece and not place by place, as `distances.away` goes: so four places are held against a piece
    at a time.
    """
    x, y = places[0], places[1]
    for i in range(first, last):
        x0, y0 = lines[0, i], lines[1, i]
        vx, vy = lines[2, i] - x0, lines[3, i] - y0
        per = 1.0 / (vx * vx + vy * vy + NOTHING_MM2)
        for k in range(len(squares)):
            wx, wy = x[k] - x0, y[k] - y0
            t = min(max((wx * vx + wy * vy) * per, 0.0), 1.0)
            wx, wy = wx - t * vx, wy - t * vy
            squares[k] = min(squares[k], wy * wy + wx * wx)


@njit(cache=True)
def _wrong(seen, places, drawn, vertices, lines, out):  # type: ignore[no-untyped-def]
    """What is drawn too dark at each place, into `out` (2, n) after the squares of the distances (mm2); the
    sum of its squares.
    """
    squares, wrong = out[0], out[1]
    squares[:] = seen.known_mm * seen.known_mm
    _near(places, lines, 0, pieces(drawn, vertices, lines), squares)
    total = 0.0
    for k in range(len(wrong)):
        darkness = ink_at(math.sqrt(squares[k]), seen.half_mm, seen.softness_mm)
        wrong[k] = darkness - seen.darkness[k]
        total += wrong[k] * wrong[k]
    return total


@njit(cache=True)
def _span(drawn, vertex):  # type: ignore[no-untyped-def]
    """The pieces that a vertex moves: the first of them, and the last and one more.

    A strand: bend to its first vertex, a piece from each to the next, bend from the last; see `pen.pieces`.
    """
    n = at = 0
    for count in drawn.counts:
        between = max(count - 1, 0)
        if vertex < at + count:
            i = vertex - at
            first = n if i == 0 else n + PIECES + i - 1
            ends_at = n + 2 * PIECES + between
            return first, ends_at if i == count - 1 else n + PIECES + i + 1
        at += count
        n += 2 * PIECES + between
    stroke = n + (vertex - at) // 2
    return stroke, stroke + 1


@njit(cache=True)
def _rests(seen, places, drawn, vertices, lines):  # type: ignore[no-untyped-def]
    """Squares (k, n), mm2, of the distances of places from all that each of the k vertices leaves in place.

    The spans of the vertices follow one another: each piece is sought once before them, and once after them.
    """
    count = pieces(drawn, vertices, lines)
    rests = np.empty((len(vertices), len(seen.known_mm)))
    squares = seen.known_mm * seen.known_mm
    at = 0
    for i in range(len(vertices)):
        first, _ = _span(drawn, i)
        _near(places, lines, at, first, squares)
        rests[i], at = squares, first
    squares[:] = seen.known_mm * seen.known_mm
    at = count
    for i in range(len(vertices) - 1, -1, -1):
        _, last = _span(drawn, i)
        _near(places, lines, last, at, squares)
        rests[i], at = np.minimum(rests[i], squares), last
    return rests


@njit(cache=True)
def _changes(seen, places, drawn, vertices, now):  # type: ignore[no-untyped-def]
    """By how much each coordinate of the vertices changes what is wrong at each place, per mm.

    `now`: squares of the distances, and what is wrong, (2, n).
    """
    n = now.shape[1]
    change, squares = np.zeros((2 * len(vertices), n)), np.empty(n)
    lines = np.empty((4, most_pieces(drawn, vertices)))
    # 1. the pieces that each vertex does not move
    rests = _rests(seen, places, drawn, vertices, lines)
    for i in range(len(change)):
        vertex, axis = i // 2, i % 2
        first, last = _span(drawn, vertex)
        # 2. those that it moves
        old = vertices[vertex, axis]
        vertices[vertex, axis] = old + NUDGE_MM
        pieces(drawn, vertices, lines)
        vertices[vertex, axis] = old
        squares[:] = rests[vertex]
        _near(places, lines, first, last, squares)
        # 3. the ink, where any of them was or is the nearest
        for k in range(n):
            if squares[k] != now[0, k]:
                darkness = ink_at(math.sqrt(squares[k]), seen.half_mm, seen.softness_mm)
                change[i, k] = (darkness - seen.darkness[k] - now[1, k]) / NUDGE_MM
    return change


@njit(cache=True)
def settle(seen, drawn, vertices, rounds):  # type: ignore[no-untyped-def]
    """Move the vertices (k, 2), in place, to where the pen leaves the ink that is there.

    Returns the sum of squares of what is still wrong.
    """
    n = len(seen.places_mm)
    places = seen.places_mm.T.copy()
    lines = np.empty((4, most_pieces(drawn, vertices)))
    now, out = np.empty((2, n)), np.empty((2, n))
    best = _wrong(seen, places, drawn, vertices, lines, now)
    damping = DAMPING
    for _ in range(rounds if len(vertices) > 0 else 0):
        # 1. the normal equations
        change = _changes(seen, places, drawn, vertices, now)
        square, right = change @ change.T, change @ now[1]
        before = best
        # 2. a step that makes less wrong, damped until it does
        for _ in range(ROUNDS):
            damped = square + np.diag(damping * np.diag(square) + 1e-6)
            step = np.linalg.solve(damped, right)
            step *= min(1.0, FARTHEST_MM / (np.max(np.abs(step)) + NOT_ZERO))
            moved = vertices - step.reshape(-1, 2)
            total = _wrong(seen, places, drawn, moved, lines, out)
            if total < best:
                best, damping = total, max(EASED * damping, LEAST_DAMPING)
                vertices[:] = moved
                now[:] = out
                break
            damping *= DAMPED
        # 3. until no step gains much
        if best > before * (1 - LEAST_GAIN):
            break
    return best


@njit(cache=True)
def weighed(seen, cells, drawn, vertices, rounds):  # type: ignore[no-untyped-def]
    """Settle the vertices; the squares of what is still wrong, the length on paper in mm, and narrow tips."""
    wrong = settle(seen, drawn, vertices, rounds)
    lines = np.empty((4, most_pieces(drawn, vertices)))
    count = pieces(drawn, vertices, lines)
    return wrong, on_paper_mm(cells, lines, count), tips(drawn, vertices)
