"""The lens: how far it draws the outline of a corner inside the vertex.

Signals: the angle between the legs of a corner (rad) and the radius of its round in; the way of the outline
inside the vertex out, all lengths in standard deviations of the lens. A sharp corner whose legs are an angle
a apart has its outline a way w inside, where

    ∫ φ(x - w) · erf(x · tan(a/2) / √2) dx  (x > 0) = 1/2          right angle 0.77    36 degrees 2.5

The radius of a round corner is that with which the same integral, over the corner's own width, is a half.

Source: the half-plane and the wedge seen through a normal distribution; our own.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

# standard deviations from the place, and what the lens sees there of the place, by the rule of trapezoids
AWAY = np.linspace(-5, 5, 1001)
WEIGHTS = np.exp(-0.5 * AWAY**2) * (AWAY[1] - AWAY[0]) / math.sqrt(2 * math.pi)
WEIGHTS[[0, -1]] *= 0.5


@lru_cache(maxsize=4096)
def way_inside(angle: float) -> float:
    """How far inside a sharp corner its outline is, in standard deviations of the lens."""
    from scipy.optimize import brentq

    return float(brentq(lambda way: _seen(angle, 0.0, way) - 0.5, 0, 30))


@lru_cache(maxsize=4096)
def radius_of(angle: float, way: float) -> float:
    """Radius of the round whose outline is so far inside the vertex, standard deviations; 0: sharp."""
    from scipy.optimize import brentq

    if way <= way_inside(angle):
        return 0.0
    alone = way / (1 / math.sin(angle / 2) - 1)  # with a perfect lens
    return float(brentq(lambda radius: _seen(angle, radius, way) - 0.5, 0, alone, xtol=1e-3))


def _seen(angle: float, radius: float, way: float) -> float:
    """Share of the shape that a lens sees so far (standard deviations) inside a rounded corner."""
    from scipy.special import erf

    half = angle / 2
    middle = radius / math.sin(half)
    x = way + AWAY
    across = np.maximum(x, 0) * math.tan(half)
    if radius:
        on_round = np.sqrt(np.maximum(radius**2 - (x - middle) ** 2, 0))
        on_round[x < middle - radius] = 0
        across = np.where(x < middle * math.cos(half) ** 2, on_round, across)
    return float(erf(across / math.sqrt(2)) @ WEIGHTS)
