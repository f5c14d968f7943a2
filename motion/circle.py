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

from morfax.motion.arrays import Array


def circle_through(places: Array) -> tuple[Array, float, float]:
    """Centre, radius and misfit (root mean square), mm, of the circle that fits places (n, 2) best."""
    middle = places.mean(axis=0)
    d = places - middle
    squares = np.sum(d * d, axis=1)
    unknowns = np.column_stack([2 * d, np.ones(len(d))])
    a, b, c = np.linalg.lstsq(unknowns, squares, rcond=None)[0]
    radius = math.sqrt(max(c + a * a + b * b, 0.0))
    off = np.hypot(*(d - [a, b]).T) - radius
    return middle + np.array([a, b]), radius, float(np.sqrt(np.mean(off**2)))
