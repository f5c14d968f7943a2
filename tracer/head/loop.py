"""Where a run comes back onto its own way: a lead line, and the loop that it leads to.

Signals: positions of the head (n, 2) mm in; the positions between which the run is a loop out.

                     ╭──────╮         first    where the loop begins: the head came here from the lead line,
    start ───────────┤ loop │         last     and came back here at the end
                     ╰──────╯

A run that has come onto its own way again may end some way beyond the join, on what was followed already.
Then the run and the earlier way are gone back together for as long as they are one line. A run that ends
square to its earlier way, and a little beyond it, is cut off where the two cross.

Source: patent ES 361967, section on use: a lead line from the reference point to the contour, and round that
to where it was joined.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.crossings import crossings
from morfax.motion.plane import unit
from morfax.motion.polyline import lengths_by_blocks
from morfax.tracer.limits import AHEAD_RAD, NEAR, PIECE_MM

# Chosen by trial on the test drawings.
STEP_MM = 0.03  # between the places that are compared
ON_IT = 0.05  # of the line's width: two ways nearer than this are the same line, as felt twice
AT_ALL = 1.0  # of the line's width: a run that stays further away has not come back
ALIKE = math.cos(AHEAD_RAD)  # cosine between headings that are about one


def loop_in(positions: Array, width_mm: float) -> tuple[int, int] | None:
    """First and last position of the loop with which a run ends; None if its end is not on its own way."""
    # 1. places of the run at equal distances, and the earlier one that is nearest to the run's end
    index = _index_every(positions)
    if not len(index):
        return None
    places = positions[index]
    m = len(places) - 1
    # the newest piece does not count as followed before
    old = places[: max(0, m - round(PIECE_MM / STEP_MM))]
    if not len(old):
        return None
    away = np.hypot(*(old - positions[-1]).T)
    j = int(np.argmin(away))
    if away[j] > AT_ALL * width_mm:
        return None
    # 2. a run that is square to its earlier way is cut off where it crosses that
    apart, alike = _apart(places[m::-1], places[j::-1])
    back = _first_not((apart < NEAR * width_mm) & alike)
    if back == 0:
        crossed = _crossed(places, index, j, round(2 * AT_ALL * width_mm / STEP_MM))
        return crossed or (int(index[j]), len(positions) - 1)
    # 3. else it is gone back for as long as both are one line: there it had left the corner onto the loop
    same = np.flatnonzero(apart[:back] < ON_IT * width_mm)
    back = int(same[-1]) if len(same) else 0
    return int(index[j - back]), int(index[m - back])


def _index_every(positions: Array) -> NDArray[np.int64]:
    """The first positions of a run that have come so far: one every `STEP_MM`."""
    found, count = list[NDArray[np.int64]](), 0
    for first, places, lengths in lengths_by_blocks(positions):
        at_mm = STEP_MM * np.arange(count, np.ceil(lengths[-1] / STEP_MM))
        if first + len(places) < len(positions):
            at_mm = at_mm[at_mm <= lengths[-1]]
        found.append(first + np.searchsorted(lengths, at_mm))
        count += len(at_mm)
    return np.concatenate(found)


def _crossed(
    places: Array, index: NDArray[np.int64], j: int, reach: int
) -> tuple[int, int] | None:
    """The positions at which the end of a run crosses the earlier way about place j; None if it does not.

    `reach` places about either are looked at.
    """
    first, last = max(0, j - reach), max(0, len(places) - 1 - reach)
    met = crossings(places[last:], places[first : min(j + reach, last)])
    if not len(met):
        return None
    there, here = np.interp(met[0] + [last, first], np.arange(len(index)), index)
    return round(float(here)), round(float(there))


def comes_again(places: Array, step_mm: float, width_mm: float) -> bool:
    """Whether the newest stretch of a trail (n, 2), a place every `step_mm`, runs along an earlier one in the
    same sense.
    """
    fresh = round(PIECE_MM / step_mm)
    old, newest = places[: -2 * fresh], places[-fresh:]
    if len(old) < fresh:
        return False
    away = np.hypot(*(old - newest[-1]).T)
    j = int(np.argmin(away))
    if away[j] > NEAR * width_mm:
        return False
    apart, alike = _apart(newest[::-1], old[j::-1])
    return _first_not((apart < NEAR * width_mm) & alike) == len(newest) - 1


def _first_not(good: NDArray[np.bool_]) -> int:
    """The last of the places, from the first on, up to which all are good."""
    return len(good) - 1 if good.all() else max(0, int(np.argmin(good)) - 1)


def _apart(run: Array, old: Array) -> tuple[Array, NDArray[np.bool_]]:
    """How far two ways are apart, mm, and whether their headings are alike, from the newest place back."""
    n = min(len(run), len(old))
    apart = np.full(n, math.inf)
    for shift in (-1, 0, 1):  # the places of one need not fall on the other's
        shifted = old[np.clip(np.arange(n) + shift, 0, len(old) - 1)]
        apart = np.minimum(apart, np.hypot(*(run[:n] - shifted).T))
    headings = [_headings(way[:n]) for way in (run, old)]
    return apart, np.sum(headings[0] * headings[1], axis=1) > ALIKE


def _headings(places: Array) -> Array:
    """Unit vectors along a way, from the places about each."""
    if len(places) < 2:
        return np.zeros((len(places), 2))
    return unit(np.gradient(places, axis=0))
