"""Moments: weighted sums of places along a line, and the parabola that lies nearest to the places.

Signals: places in, x along a line and y across it, mm, with a weight each; the parabola out.

    y = p0 + p1·x + p2·x²       by Cramer's rule from the sums of w, w·x … w·x⁴ and w·y, w·x·y, w·x²·y

Source: our own. For kernels that run through the places themselves: the head's drum and the runs of a line.
`parabola` solves the same for arrays of stations, with a degree to choose and the uncertainty.
"""

from __future__ import annotations

from typing import NamedTuple

from morfax.motion.arrays import NOT_ZERO
from morfax.motion.compiled import njit

LEAST_WEIGHT = 0.05  # of a station at the window's end


class Moments(NamedTuple):
    """Sums over the places: `s3` of w·x³, `b2` of w·x²·y."""

    s0: float = 0.0
    s1: float = 0.0
    s2: float = 0.0
    s3: float = 0.0
    s4: float = 0.0
    b0: float = 0.0
    b1: float = 0.0
    b2: float = 0.0


NO_PLACES = Moments()


@njit(cache=True, _nrt=False, inline="always")
def with_place(sums, w, x, y):  # type: ignore[no-untyped-def]
    """The sums with one place more."""
    xx = x * x
    return Moments(
        sums.s0 + w,
        sums.s1 + w * x,
        sums.s2 + w * xx,
        sums.s3 + w * xx * x,
        sums.s4 + w * xx * xx,
        sums.b0 + w * y,
        sums.b1 + w * x * y,
        sums.b2 + w * xx * y,
    )


@njit(cache=True, _nrt=False, inline="always")
def parabola_of(sums):  # type: ignore[no-untyped-def]
    """Whether the places tell a parabola, and (p0, p1, p2).

    They do not where the determinant is no share of the product of the moments: too few places, or one spot.
    """
    s0, s1, s2, s3, s4, b0, b1, b2 = sums
    d0, d1, d2 = s2 * s4 - s3 * s3, s2 * s3 - s1 * s4, s1 * s3 - s2 * s2
    det = s0 * d0 + s1 * d1 + s2 * d2
    if det <= NOT_ZERO * s0 * s2 * s4:
        return False, 0.0, 0.0, 0.0
    d11, d12, d22 = s0 * s4 - s2 * s2, s1 * s2 - s0 * s3, s0 * s2 - s1 * s1
    p0 = (d0 * b0 + d1 * b1 + d2 * b2) / det
    p1 = (d1 * b0 + d11 * b1 + d12 * b2) / det
    p2 = (d2 * b0 + d12 * b1 + d22 * b2) / det
    return True, p0, p1, p2


@njit(cache=True, _nrt=False, inline="always")
def bend_of(slope, second):  # type: ignore[no-untyped-def]
    """The bend of a curve y(x) by its derivatives at a place, 1/mm."""
    return second / (1.0 + slope * slope) ** 1.5


@njit(cache=True, inline="always")
def straight_of(sums):  # type: ignore[no-untyped-def]
    """(p0, p1, 0) of the straight line nearest to the places."""
    flat = sums.s0 * sums.s2 - sums.s1 * sums.s1
    p1 = (sums.s0 * sums.b1 - sums.s1 * sums.b0) / flat if flat > 0 else 0.0
    return (sums.b0 - p1 * sums.s1) / sums.s0, p1, 0.0
