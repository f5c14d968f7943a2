"""The order of strokes that may be run in any order and from either end, so that the idle way is short.

Signals: where strokes begin and end, (n, 2) sheet mm, in; out their order, and which are begun at their end.

First always on to the nearest end that is left; then every stretch of the order is run backwards where that
is a gain (2-opt), until none is. Some strokes are tried as the first. A closed stroke begins and ends at one
place, and may be turned as well.

Source: the textbook's 2-opt (Croes 1958). `order` has lines of which some must come before others; without
that the idle way back is as long as there, and a gain needs four distances only.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.plane import NOTHING_MM
from morfax.tracer.program.lines.order import FIRSTS

SPAN = 2000  # strokes in a stretch that is turned at most; by trial: the time stays that of the ink
# strokes tried as the first: fewer, if there are many strokes; by trial
SOME = 4000
PASSES = 60  # over all stretches; most orders need ten


def in_order(begins_mm: Array, ends_mm: Array) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Numbers of strokes in their order, and for each of these whether it is begun at its end."""
    places = np.ascontiguousarray(np.stack([begins_mm, ends_mm], axis=1), float)
    count = len(places)
    tried = []
    for first in range(0, count, max(1, count // max(1, min(FIRSTS, SOME // count)))):
        way, turned = _on_to_nearest(places, first)
        _turn_stretches(places, way, turned, SPAN, PASSES)
        tried.append((_idle_mm(places, way, turned), first, way, turned))
    _, _, way, turned = min(tried, key=lambda some: some[:2])
    return way, turned


def _idle_mm(places: Array, way: NDArray[np.int64], turned: NDArray[np.bool_]) -> float:
    """The idle way of an order, mm."""
    first, last = turned.astype(int), 1 - turned
    begins, ends = places[way, first], places[way, last]
    idle = begins[1:] - ends[:-1]
    return float(np.hypot(*idle.T).sum())


@njit(cache=True)
def _on_to_nearest(places, first):  # type: ignore[no-untyped-def]
    """From a first stroke always on to the nearest end of those that are left."""
    count = len(places)
    way, turned, left = np.zeros(count, np.int64), np.zeros(count, np.bool_), np.arange(count)
    left[0], left[first], way[0] = first, 0, first
    here = places[first, 1]
    for k in range(1, count):
        best, best_mm2, at_end = k, np.inf, False
        for n in range(k, count):
            for end in range(2):
                dx = places[left[n], end, 0] - here[0]
                dy = places[left[n], end, 1] - here[1]
                if dx * dx + dy * dy < best_mm2:
                    best, best_mm2, at_end = n, dx * dx + dy * dy, end == 1
        left[k], left[best] = left[best], left[k]
        way[k], turned[k] = left[k], at_end
        here = places[way[k], 0 if at_end else 1]
    return way, turned


@njit(cache=True)
def _turn_stretches(places, way, turned, span, passes):  # type: ignore[no-untyped-def]
    """Run stretches of the order backwards where that is a gain, until none is."""
    count = len(way)
    # of each place of the order where its stroke ends (x, y), and from the one before it to its begin, mm
    laid = np.zeros((3, count + 1))
    _lay_out(places, way, turned, (0, count), laid)
    for _ in range(passes):
        better = False
        for i in range(count):
            for j in range(i, min(count, i + span)):
                was = laid[2, i] + laid[2, j + 1]
                # most are further apart along X or Y alone, which is seen in a tenth of the time
                across, up = abs(laid[0, j] - laid[0, i - 1]), abs(laid[1, j] - laid[1, i - 1])
                if i > 0 and max(across, up) > was:
                    continue
                will = _apart(places, way, turned, (i - 1, 1), (j, 1))
                will += _apart(places, way, turned, (i, 0), (j + 1, 0))
                if was - will > NOTHING_MM:
                    way[i : j + 1] = way[i : j + 1][::-1].copy()
                    turned[i : j + 1] = ~turned[i : j + 1][::-1]
                    _lay_out(places, way, turned, (i, j + 1), laid)
                    better = True
        if not better:
            return


@njit(cache=True)
def _lay_out(places, way, turned, some, laid):  # type: ignore[no-untyped-def]
    """Fill in where the strokes at some places of the order end, and how far it is to the begin of each."""
    for k in range(some[0], min(some[1] + 1, len(way))):
        end = 0 if turned[k] else 1
        laid[0, k], laid[1, k] = places[way[k], end, 0], places[way[k], end, 1]
        laid[2, k] = _apart(places, way, turned, (k - 1, 1), (k, 0))


@njit(cache=True, inline="always")
def _apart(places, way, turned, one, other):  # type: ignore[no-untyped-def]
    """From an end of one stroke to an end of another, mm; 0 beyond the order's ends.

    Each is a place in the order and an end, 0 the first and 1 the last.
    """
    (a, a_end), (b, b_end) = one, other
    if a < 0 or b >= len(way):
        return 0.0
    begin = places[way[a], 1 - a_end if turned[a] else a_end]
    end = places[way[b], 1 - b_end if turned[b] else b_end]
    return np.hypot(end[0] - begin[0], end[1] - begin[1])
