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
def nearest(places, way, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, 3) with how far places (n, 2) are from a way (m, 2) mm, on which of its pieces it comes
    nearest, and at which share of that.

    All squares first, and then the least: so four pieces are held against a place at a time.
    """
    x0, y0 = way[:-1, 0].copy(), way[:-1, 1].copy()
    along_x, along_y = way[1:, 0] - x0, way[1:, 1] - y0
    per = 1.0 / np.maximum(along_x * along_x + along_y * along_y, NOT_ZERO)
    shares, squares = np.empty(len(per)), np.empty(len(per))
    for k in range(len(places)):
        x, y = places[k, 0], places[k, 1]
        for i in range(len(per)):
            wx, wy = x - x0[i], y - y0[i]
            t = min(max((wx * along_x[i] + wy * along_y[i]) * per[i], 0.0), 1.0)
            dx, dy = wx - t * along_x[i], wy - t * along_y[i]
            shares[i], squares[i] = t, dx * dx + dy * dy
        best, piece = math.inf, 0
        for i in range(len(per)):
            if squares[i] < best:
                best, piece = squares[i], i
        out[k, 0], out[k, 1], out[k, 2] = math.sqrt(best), piece, shares[piece]


@njit(cache=True)
def at_corner(piece, share, sharp):  # type: ignore[no-untyped-def]
    """Whether a place on a piece of a way is one of its corners."""
    if sharp[piece] and (share <= 0 or sharp[piece + 1]):
        return True
    return sharp[piece + 1] and share >= 1


@njit(cache=True)
def wrong(ink, way, sharp, near, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n,) with what a pen along a way (m, 2) mm draws too dark at each place of the ink, and
    `near` (n, 3) with where the way is nearest to that; `sharp` are its corners.

    A pen's ink is round at a corner, a plotting program's may come to a point: neither is too little.
    """
    nearest(ink.places_mm, way, near)
    has_corners = np.any(sharp)
    for k in range(len(near)):
        drawn = pen.ink_at(min(near[k, 0], ink.known_mm[k]), ink.half_mm, ink.softness_mm)
        out[k] = drawn - ink.darkness[k]
        if has_corners and out[k] < 0 and at_corner(int(near[k, 1]), near[k, 2], sharp):
            out[k] = 0.0


@njit(cache=True)
def changes(ink, moved, near, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, f) with by how much each figure darkens each place of the ink, per unit of the figure;
    `moved`: the way, how far each figure moves its places, and its corners (m,); `near` (n, 3): where the way
    is nearest to each place.

    Ink that comes to a point at one of the corners is not wrong, and no figure changes that.
    """
    way, moves, sharp = moved
    for k in range(len(near)):
        out[k, :] = 0.0
        away_mm, i, t = near[k, 0], int(near[k, 1]), near[k, 2]
        fades = pen.fades_at(away_mm, ink.half_mm, ink.softness_mm)
        if fades == 0.0 or away_mm > ink.known_mm[k] or away_mm < NOT_ZERO:
            continue
        if at_corner(i, t, sharp):
            drawn = pen.ink_at(away_mm, ink.half_mm, ink.softness_mm)
            if drawn < ink.darkness[k]:
                continue
        # the ink fades along the line from the way's nearest place
        x, y, fades = ink.places_mm[k, 0], ink.places_mm[k, 1], fades / away_mm
        dx = fades * (x - way[i, 0] - t * (way[i + 1, 0] - way[i, 0]))
        dy = fades * (y - way[i, 1] - t * (way[i + 1, 1] - way[i, 1]))
        for f in range(moves.shape[1]):
            before, after = moves[i, f], moves[i + 1, f]
            along_x = (1 - t) * before[0] + t * after[0]
            out[k, f] = dx * along_x + dy * ((1 - t) * before[1] + t * after[1])
