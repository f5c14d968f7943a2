"""Ends on their ink: how well each end that a line may have, in the ink of others, explains what is there.

Signals: places about a line, in its own directions, what is seen at each, and the pen in; for each end the
sum of the squares of what is drawn less what is seen out.

The pen's ink is asked for at some hundred places for each of some hundred ends, so how it fades from its edge
is looked up, between `FADING` distances by cubics: within 1e-10 of `pen.ink_at`. What is chosen by it is the
same.

Source: our own; the pen is that of `tangles.pen`.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.compiled import njit
from morfax.tracer.limits import FADES
from morfax.tracer.tangles.pen import ink_at

PAPER = 1.0  # place that is paper, and inked by the line: it does not go on
FADING = 1024  # distances


def reach_mm_of(pen: tuple[float, float]) -> float:
    """How far beyond its end a pen may leave ink: half its width, and the softness of that, mm."""
    half_mm, softness_mm = pen
    return half_mm + math.sqrt(2.0) * FADES * softness_mm


def misfits_of(places: Array, pen: tuple[float, float], ends_mm: Array) -> Array:
    """How far each end of a line is from explaining the ink, up to where the line would cross paper; infinite
    beyond.

    Places, in order: along the line, beside it, distance from the others, mm, the direction from them, in the
    line's own, and what is seen; (n, 6). The pen: half its width, softness, mm.
    """
    misfits, sums = np.full(len(ends_mm), math.inf), np.empty((3, len(places) + 1))
    _misfits(places, (*pen, _fading()), ends_mm, sums, misfits)
    return misfits


@cache
def _fading() -> Array:
    """The ink at distances across a pen's edge, and what it gains from one to the next if that is even."""
    u = np.linspace(-FADES, FADES, FADING + 1)
    ink = [0.5 * math.erfc(each) for each in u.tolist()]
    return np.column_stack([ink, -np.exp(-u * u) / math.sqrt(math.pi) * (u[1] - u[0])])


@njit(cache=True)
def faded(away_mm, pen):  # type: ignore[no-untyped-def]
    """Darkness that a pen leaves at a distance from its way."""
    half_mm, softness_mm, fading = pen
    u = (away_mm - half_mm) / (math.sqrt(2.0) * softness_mm)
    if abs(u) >= FADES:
        return 0.0 if u > 0 else 1.0
    at = (u + FADES) * (len(fading) - 1) / (2 * FADES)
    k = min(int(at), len(fading) - 2)
    along, gained = at - k, fading[k + 1, 0] - fading[k, 0]
    first, last = fading[k, 1], fading[k + 1, 1]
    bend = along * (first + last - 2 * gained) + 3 * gained - 2 * first - last
    return fading[k, 0] + along * (first + along * bend)


@njit(cache=True, _nrt=False)
def _misfits(places, pen, ends_mm, sums, out):  # type: ignore[no-untyped-def]
    """The sums of the squares of what is drawn less what is seen, for each end up to where the line would
    cross paper.

    Places, in order: along the line, beside it, distance from the others, mm, the direction from them, in the
    line's own, and what is seen; (n, 6). The pen: half its width, softness, mm, and how its ink
    fades (see `_fading`). `sums` is room: (3, n + 1).
    """
    reach_mm, least = pen[0] + math.sqrt(2.0) * FADES * pen[1], math.inf
    # 1. what all places come to that the line has passed, or has not come to
    count = len(places)
    passed, left, others = sums
    passed[0] = left[0] = 0.0
    for k in range(count):
        others[k] = 1.0 - ink_at(places[k, 2], pen[0], pen[1])
        passed[k + 1] = passed[k] + _misfit(places[k], others[k], pen, places[k, 0])
        left[k + 1] = left[k] + _misfit(places[k], others[k], pen, places[k, 0] - reach_mm)
    # 2. those about each end by themselves
    first = last = 0
    for n in range(len(ends_mm)):
        while first < count and places[first, 0] <= ends_mm[n]:
            first += 1
        while last < count and places[last, 0] < ends_mm[n] + reach_mm:
            last += 1
        total = passed[first] + left[count] - left[last]
        for k in range(first, last):
            total += _misfit(places[k], others[k], pen, ends_mm[n])
        if total > least + PAPER:
            return
        least = min(least, total)
        out[n] = total


@njit(cache=True)
def _misfit(place, other, pen, end_mm):  # type: ignore[no-untyped-def]
    """The square of what is drawn less what is seen at a place, if the line ends there; `other`: how much
    paper the other lines leave.
    """
    if other == 0.0:  # the line leaves none either
        return (1.0 - place[5]) ** 2
    beyond, aside = max(place[0] - end_mm, 0.0), place[1]
    away = math.sqrt(beyond * beyond + aside * aside)
    paper = 1.0 - faded(away, pen)
    if other == 1.0:  # or only the line leaves some
        return (1.0 - paper - place[5]) ** 2
    alike = (beyond * place[3] + aside * place[4]) / max(away, NOT_ZERO)
    return (1.0 - _bare(paper, other, alike) - place[5]) ** 2


@njit(cache=True)
def _bare(one, other, alike):  # type: ignore[no-untyped-def]
    """How much paper shows where two pens leave some each; `alike` is the cosine between their rims.

    Softened rims at right angles leave the product, rims on one side the lesser, rims that face each other
    what their inks together leave.
    """
    product = one * other
    if alike > 0:
        return product + alike * (min(one, other) - product)
    return product - alike * (max(one + other - 1.0, 0.0) - product)
