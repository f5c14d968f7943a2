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
def nearest(way, x, y):  # type: ignore[no-untyped-def]
    """Where a way (m, 2) is nearest to a place: its piece, the share of that, and the distance, mm."""
    best, piece, share = math.inf, 0, 0.0
    for i in range(len(way) - 1):
        vx, vy = way[i + 1, 0] - way[i, 0], way[i + 1, 1] - way[i, 1]
        wx, wy = x - way[i, 0], y - way[i, 1]
        t = min(max((wx * vx + wy * vy) / max(vx * vx + vy * vy, NOT_ZERO), 0.0), 1.0)
        dx, dy = wx - t * vx, wy - t * vy
        if dx * dx + dy * dy < best:
            best, piece, share = dx * dx + dy * dy, i, t
    return piece, share, math.sqrt(best)


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
def changes(ink, way, sharp, moves, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, f) with by how much each figure darkens each place of the ink, per unit of the figure.

    Only where the ink fades is the nearest piece looked for. Ink that comes to a point at one of the corners,
    which are `sharp` (m,), is not wrong, and no figure changes that.
    """
    near_mm = away_from_ink(ink, way)
    for k in range(len(near_mm)):
        out[k, :] = 0.0
        if pen.fades_at(near_mm[k], ink.half_mm, ink.softness_mm) == 0.0:
            continue
        x, y = ink.places_mm[k, 0], ink.places_mm[k, 1]
        i, t, away_mm = nearest(way, x, y)
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
