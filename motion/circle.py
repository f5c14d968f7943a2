"""The circle through places: linear least squares, as Kåsa's fit.

Signals: places (n, 2) mm in; centre, radius and misfit, mm, out. The circle is that for which the sum of
(|place - centre|² - radius²)² is least. The fit needs no first guess; noise on a short arc makes the radius
come out too small.

Source: I. Kåsa, A circle fitting procedure and its error analysis, IEEE Transactions on Instrumentation and
Measurement 25 (1976).
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import ROUNDED_SQUARE, Array
from morfax.motion.compiled import njit


def circle_through(places: Array) -> tuple[Array, float, float]:
    """Centre, radius and misfit (root mean square), mm, of the circle that fits places (n, 2) best."""
    x, y, radius = kasa(np.ascontiguousarray(places, float))
    centre = np.array([x, y])
    off = np.hypot(*(places - centre).T) - radius
    return centre, radius, float(np.sqrt(np.mean(off**2)))


@njit(cache=True)
def kasa(places):  # type: ignore[no-untyped-def]
    """Centre (x, y) and radius of that circle, mm; of places on a straight line the radius is infinite."""
    x, y, xx, xy, yy = spread(places)
    xr, yr, rr = 0.0, 0.0, 0.0
    for i in range(len(places)):
        dx = places[i, 0] - x
        dy = places[i, 1] - y
        square = dx * dx + dy * dy
        xr += dx * square
        yr += dy * square
        rr += square
    across = xx * yy - xy * xy
    if not across > ROUNDED_SQUARE * (xx + yy) ** 2:  # more than of a straight line
        return x, y, math.inf
    a = 0.5 * (xr * yy - yr * xy) / across
    b = 0.5 * (yr * xx - xr * xy) / across
    return x + a, y + b, math.sqrt(rr / len(places) + a * a + b * b)


@njit(cache=True)
def spread(places):  # type: ignore[no-untyped-def]
    """The middle of some places, and the sums of their squares about it: xx, xy, yy."""
    x, y, xx, xy, yy = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(places)):
        x += places[i, 0]
        y += places[i, 1]
    x /= len(places)
    y /= len(places)
    for i in range(len(places)):
        dx = places[i, 0] - x
        dy = places[i, 1] - y
        xx += dx * dx
        xy += dx * dy
        yy += dy * dy
    return x, y, xx, xy, yy
