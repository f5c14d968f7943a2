"""A way whose places are moved by some figures: by how much each figure darkens the ink's places.

    place of ink
      ●                d darkness     how the figure moves the way's nearest place, along the line from there
       ╲               ──────────  =  to the place of ink · how much darker that becomes for each mm that the
        ●──►── way      d figure      pen comes nearer (`pen.fades_at`)

A fit that moves each figure in turn draws the ink once for every figure. Here it is drawn once, and the
slopes do not depend on where on the sheet the way lies: a figure that is moved by a ten-thousandth of itself
is moved by 28 um at 280 mm, about as far as ink fades.

Signals: places of ink (see `pen.Ink`), a way (m, 2) mm and how far each figure moves its places, (m, f, 2) mm
per unit of the figure, in; by how much each figure darkens each place out.

Source: our own. It serves the spline and the bent rule; the compass knows its core's slopes.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import NOT_ZERO
from morfax.motion.compiled import njit
from morfax.tracer.tangles import pen


@njit(cache=True)
def pieces_of(way):  # type: ignore[no-untyped-def]
    """The pieces of a way (m, 2), for `nearest`: where each begins, x and y, along which way it leads, x and
    y, one over the square of its length, and room.
    """
    last = len(way) - 1
    x, y, along_x, along_y = np.empty(last), np.empty(last), np.empty(last), np.empty(last)
    per, room = np.empty(last), np.empty(last)
    for i in range(last):
        x[i], y[i] = way[i, 0], way[i, 1]
        along_x[i], along_y[i] = way[i + 1, 0] - way[i, 0], way[i + 1, 1] - way[i, 1]
        per[i] = 1.0 / max(along_x[i] * along_x[i] + along_y[i] * along_y[i], NOT_ZERO)
    return x, y, along_x, along_y, per, room


@njit(cache=True)
def nearest(pieces, x, y):  # type: ignore[no-untyped-def]
    """Where the pieces of a way are nearest to a place: which piece, the share of that, the distance, mm.

    All squares first, and then the least: so four pieces are held against the place at a time.
    """
    x0, y0, along_x, along_y, per, squares = pieces
    for i in range(len(squares)):
        wx, wy = x - x0[i], y - y0[i]
        t = min(max((wx * along_x[i] + wy * along_y[i]) * per[i], 0.0), 1.0)
        dx, dy = wx - t * along_x[i], wy - t * along_y[i]
        squares[i] = dx * dx + dy * dy
    best, piece = math.inf, 0
    for i in range(len(squares)):
        if squares[i] < best:
            best, piece = squares[i], i
    wx, wy = x - x0[piece], y - y0[piece]
    share = (wx * along_x[piece] + wy * along_y[piece]) * per[piece]
    return piece, min(max(share, 0.0), 1.0), math.sqrt(best)


@njit(cache=True)
def at_corner(piece, share, sharp):  # type: ignore[no-untyped-def]
    """Whether a place on a piece of a way is one of its corners."""
    if sharp[piece] and (share <= 0 or sharp[piece + 1]):
        return True
    return sharp[piece + 1] and share >= 1


@njit(cache=True)
def away_from_ink(ink, way):  # type: ignore[no-untyped-def]
    """How far the ink's places are from a way (m, 2) mm or from what is drawn anyway, (n,) mm."""
    last = len(way) - 1
    lines, out = np.empty((4, last)), np.empty(len(ink.places_mm))
    for i in range(last):
        lines[0, i], lines[1, i] = way[i, 0], way[i, 1]
        lines[2, i], lines[3, i] = way[i + 1, 0], way[i + 1, 1]
    out[:] = pen.NOWHERE_MM
    pen.away(ink.places_mm, lines, last, out)
    for k in range(len(out)):
        out[k] = min(out[k], ink.known_mm[k])
    return out


@njit(cache=True)
def wrong(ink, way, sharp, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n,) with what a pen along a way (m, 2) mm draws too dark at each place of the ink; `sharp`
    are its corners.

    A pen's ink is round at a corner, a plotting program's may come to a point: neither is too little.
    """
    near_mm, pieces, has_corners = away_from_ink(ink, way), pieces_of(way), np.any(sharp)
    for k in range(len(near_mm)):
        drawn = pen.ink_at(near_mm[k], ink.half_mm, ink.softness_mm)
        out[k] = drawn - ink.darkness[k]
        if has_corners and out[k] < 0:
            i, t, _ = nearest(pieces, ink.places_mm[k, 0], ink.places_mm[k, 1])
            out[k] = 0.0 if at_corner(i, t, sharp) else out[k]


@njit(cache=True)
def changes(ink, moved, near_mm, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, f) with by how much each figure darkens each place of the ink, per unit of the figure;
    `moved`: the way, how far each figure moves its places, and its corners (m,); `near_mm` (n,): how far each
    place is from the way, or from what is drawn anyway.

    Only where the ink fades is the nearest piece looked for. Ink that comes to a point at one of the corners
    is not wrong, and no figure changes that.
    """
    way, moves, sharp = moved
    pieces = pieces_of(way)
    for k in range(len(near_mm)):
        out[k, :] = 0.0
        if pen.fades_at(near_mm[k], ink.half_mm, ink.softness_mm) == 0.0:
            continue
        x, y = ink.places_mm[k, 0], ink.places_mm[k, 1]
        i, t, away_mm = nearest(pieces, x, y)
        if away_mm > ink.known_mm[k] or away_mm < NOT_ZERO:
            continue
        is_less = pen.ink_at(away_mm, ink.half_mm, ink.softness_mm) < ink.darkness[k]
        if is_less and at_corner(i, t, sharp):
            continue
        # the ink fades along the line from the way's nearest place
        fades = pen.fades_at(away_mm, ink.half_mm, ink.softness_mm) / away_mm
        dx = fades * (x - way[i, 0] - t * (way[i + 1, 0] - way[i, 0]))
        dy = fades * (y - way[i, 1] - t * (way[i + 1, 1] - way[i, 1]))
        for f in range(moves.shape[1]):
            before, after = moves[i, f], moves[i + 1, f]
            along_x = (1 - t) * before[0] + t * after[0]
            out[k, f] = dx * along_x + dy * ((1 - t) * before[1] + t * after[1])
