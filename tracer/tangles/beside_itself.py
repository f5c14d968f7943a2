"""Stretches of a closed way that come beside itself, nearer than two lines can be drawn.

    ───╮   ╭───     where the sides of a notch run together, the head may run out and back in the middle of
       │ ↑↓│        them, or straight across the mouth and round the notch as well
       ╰───╯

Signals: places of a closed way, one step apart, in; from which place to which it comes beside itself out.

Source: our own. Questions: a spike comes beside itself at its tip, as it should.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.tracer.limits import ABOUT_WIDTHS

NEAR_WIDTHS = 0.6  # sides that are nearer to each other are one line
# of way between them, at the least: a spike of 28 degrees has its sides so near
ON_WIDTHS = 2.5


def stretches(
    way: Array,
    step_mm: float,
    width_mm: float,
    near_widths: float = NEAR_WIDTHS,
    on_widths: float = ON_WIDTHS,
) -> list[tuple[int, int]]:
    """From which place of a closed way (n, 2) to which it comes so near to itself after so much way between;
    the last may be over n.
    """
    count = len(way)
    partner = partners(way, near_widths * width_mm, round(on_widths * width_mm / step_mm))
    found = np.flatnonzero(partner >= 0)
    if not len(found):
        return []
    # 1. places that follow one another, and those beside them
    apart = round(ABOUT_WIDTHS * width_mm / step_mm)
    group = np.zeros(count, np.int64)
    group[found] = np.cumsum(np.diff(found, prepend=found[0]) > apart)
    if found[0] + count - found[-1] <= apart:
        group[found[group[found] == group[found[-1]]]] = 0
    joined = _joined(group[found], group[partner[found]], int(group.max()) + 1)
    # 2. the shortest way round all of each
    return [
        shortest(found[joined[group[found]] == number], count)
        for number in sorted(set(joined[group[found]].tolist()))
    ]


def partners(way: Array, near_mm: float, apart: int) -> NDArray[np.int64]:
    """For each place of a closed way (n, 2) mm one that is near to it, so many places apart along it or more;
    -1 where none is.
    """
    cell = np.floor((way - way.min(axis=0)) / near_mm).astype(np.int64) + 1
    partner = np.full(len(way), -1)
    heads = np.full(tuple(cell.max(axis=0) + 2), -1)
    _find_partners(way, cell, near_mm, apart, heads, partner)
    return partner


def _joined(
    some: NDArray[np.int64], others: NDArray[np.int64], count: int
) -> NDArray[np.int64]:
    """For each of some groups the least group that it is joined to."""
    least = np.arange(count)
    for _ in range(count):
        before = least.copy()
        np.minimum.at(least, some, least[others])
        np.minimum.at(least, others, least[some])
        if np.array_equal(before, least):
            break
    return least


def shortest(places: NDArray[np.int64], count: int) -> tuple[int, int]:
    """The shortest stretch of a closed way that has all of some places, which are in order."""
    gaps = [b - a for a, b in pairwise([*places.tolist(), int(places[0]) + count])]
    widest = int(np.argmax(gaps))
    first, last = int(places[(widest + 1) % len(places)]), int(places[widest])
    return first, last if last >= first else last + count


@njit(cache=True)
def _find_partners(way, cell, near_mm, on, heads, partner):  # type: ignore[no-untyped-def]
    """For each place of a closed way one that is near it, and more than so many places on; else -1.

    `heads` has room for a cell of that size about each place: the last of the places that are in it.
    """
    count = len(way)
    nexts = np.full(count, -1)
    for k in range(count):
        i, j = cell[k, 0], cell[k, 1]
        nexts[k], heads[i, j] = heads[i, j], k
    for k in range(count):
        for i in range(cell[k, 0] - 1, cell[k, 0] + 2):
            for j in range(cell[k, 1] - 1, cell[k, 1] + 2):
                other = heads[i, j]
                while other >= 0 and partner[k] < 0:
                    between = abs(other - k)
                    if min(between, count - between) > on:
                        dx, dy = way[other, 0] - way[k, 0], way[other, 1] - way[k, 1]
                        if dx * dx + dy * dy < near_mm * near_mm:
                            partner[k] = other
                    other = nexts[other]
