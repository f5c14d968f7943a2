"""The order in which lines are cut: what lies inside first, and the idle way short.

Signals: where lines begin and end (n, 2) mm, and which is cut before which, in; the order out, and which open
lines are begun at their other end.

    ┌───────────────┐        order: 2, 3, 1: an inner line is cut first, because the part comes loose when its
    │  ( 2 )   ( 3 )│        outline is cut; the idle way is 2 → 3 → 1
    └─────── 1 ─────┘

From each of several first lines the order goes on to the nearest that may be cut, and back from each of
several last ones. Then, as long as the idle way gets shorter and inner stays before outer, a stretch of the
order is turned round, or up to three lines are moved elsewhere. The place of the first line does not count:
the tool stands at clearance there when the program begins.

Source: our own. Turning stretches round is by Croes, Operations Research 6 (1958); moving short stretches by
Or (1976).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.plane import NOTHING_MM

# All limits below were chosen by trial.
FIRSTS = 16  # lines that are tried as the first of the order, and as the last
SOME = 2000  # places in all the orders that are tried: of a hundred lines 16 orders, of a thousand two
MOVED = 3  # lines moved together
TURNINGS = 6  # orders that are tried, each with the lines turned as is best for the one before


def in_order(starts_mm: Array, ends_mm: Array, before: NDArray[np.bool_]) -> list[int]:
    """The order of lines that keeps the idle way short; `before[i, j]`: i is cut before j."""
    across_mm = np.asarray(ends_mm)[:, None] - np.asarray(starts_mm)[None]
    idle_mm = np.hypot(*across_mm.transpose(2, 0, 1))
    idle_back_mm, pairs = idle_mm.T.copy(), np.ascontiguousarray(np.argwhere(before))
    there = _from_firsts(idle_mm, before)
    back = _from_firsts(idle_back_mm, before.T.copy())
    ways = [_improved(way, idle_mm, idle_back_mm, pairs) for way in there]
    ways += [_improved(way[::-1].copy(), idle_mm, idle_back_mm, pairs) for way in back]
    return [int(i) for i in min(ways, key=lambda way: idle_way_mm(way, idle_mm))]


def in_order_and_turned(
    starts_mm: Array, ends_mm: Array, before: NDArray[np.bool_], may_turn: NDArray[np.bool_]
) -> tuple[list[int], NDArray[np.bool_]]:
    """The order of lines, and which open ones to begin at their other end, so that the idle way is short."""
    ends = np.stack([np.asarray(starts_mm, float), np.asarray(ends_mm, float)])
    turned = np.zeros(len(may_turn), bool)
    best: tuple[float, list[int], NDArray[np.bool_]] | None = None
    for _ in range(TURNINGS):
        begin, finish = _turned_ends(ends, turned)
        order = in_order(begin, finish, before)
        to_turn = _to_turn(begin, finish, order, may_turn)
        turned = turned ^ to_turn
        begin, finish = _turned_ends(ends, turned)
        idle_mm = float(np.hypot(*(begin[order[1:]] - finish[order[:-1]]).T).sum())
        if best is not None and idle_mm >= best[0] - NOTHING_MM:
            break
        best = idle_mm, order, turned
        if not to_turn.any():  # the next order would be the same
            break
    assert best is not None
    return best[1], best[2]


def _turned_ends(ends: Array, turned: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Where lines begin and end (2, n, 2) mm, when some are turned round."""
    lines = np.arange(len(turned))
    return ends[np.where(turned, 1, 0), lines], ends[np.where(turned, 0, 1), lines]


def _to_turn(
    starts_mm: Array, ends_mm: Array, order: list[int], may_turn: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Which lines are best turned round: the shortest way through an order, each line as it is or turned."""
    ends = np.stack([starts_mm, ends_mm])
    idle_mm, came = np.where([True, bool(may_turn[order[0]])], 0.0, np.inf), []
    for a, b in pairwise(order):
        # from a (as is, turned) to b (as is, turned)
        ways = ends[:, b][None] - ends[::-1, a][:, None]
        steps = np.hypot(*ways.transpose(2, 0, 1))
        total = idle_mm[:, None] + steps
        total[:, 1] = total[:, 1] if may_turn[b] else np.inf
        came.append(total.argmin(axis=0))
        idle_mm = total.min(axis=0)
    turned = np.zeros(len(may_turn), bool)
    state = int(idle_mm.argmin())
    for line, before in zip(order[::-1], [*came[::-1], None], strict=True):
        turned[line] = bool(state)
        state = int(before[state]) if before is not None else 0
    return turned


def idle_way_mm(way: Sequence[int] | NDArray[np.int64], idle_mm: Array) -> float:
    """Idle way of an order, mm; `idle_mm[i, j]` is the way from the end of i to the start of j."""
    way = np.asarray(way)
    return float(idle_mm[way[:-1], way[1:]].sum())


def _from_firsts(idle_mm: Array, before: NDArray[np.bool_]) -> list[NDArray[np.int64]]:
    """Orders that go on to the nearest line, from some of those that may be first."""
    firsts = np.flatnonzero(~before.any(axis=0))
    tried = min(FIRSTS, max(1, SOME // len(idle_mm)))
    some = firsts[:: -(-len(firsts) // tried)]
    return [_on_to_nearest(int(first), idle_mm, before) for first in some]


@njit(cache=True)
def _on_to_nearest(first, idle_mm, before):  # type: ignore[no-untyped-def]
    """From the first line always on to the nearest one all whose inner lines are cut."""
    lines = len(idle_mm)
    way, cut = np.empty(lines, np.int64), np.zeros(lines, np.bool_)
    waits_for = np.zeros(
        lines, np.int64
    )  # how many lines that are cut before it are not yet cut
    for i in range(lines):
        waits_for += before[i]
    way[0], cut[first] = first, True
    for k in range(1, lines):
        waits_for -= before[way[k - 1]]
        best = -1
        for i in range(lines):
            waits = cut[i] or waits_for[i] > 0
            if not waits and (best < 0 or idle_mm[way[k - 1], i] < idle_mm[way[k - 1], best]):
                best = i
        way[k], cut[best] = best, True
    return way


class _Legs(NamedTuple):
    """Idle ways from line to line and back, and `onward[b]`, the way to place b of the order from the one
    before it, and `homeward[b]`, the way back, mm.

    `back[i, j]` is `there[j, i]`: what is asked one after the other lies side by side in memory.
    """

    there: Array
    back: Array
    onward: Array
    homeward: Array


@njit(cache=True)
def _improved(way, idle_mm, idle_back_mm, pairs):  # type: ignore[no-untyped-def]
    """The order made shorter by turning stretches and moving up to three lines, until neither helps.

    `idle_back_mm[i, j]` is `idle_mm[j, i]`; of each of `pairs` the first line is cut before the second.
    """
    legs = _Legs(idle_mm, idle_back_mm, np.zeros(len(way) + 1), np.zeros(len(way) + 1))
    may = np.empty_like(way), np.empty_like(way), pairs
    _lay_out(way, legs)
    better = True
    while better:
        better = _turn_stretches(way, legs, may)
        better = _move_lines(way, legs, may) or better
    return way


@njit(cache=True)
def _lay_out(way, legs):  # type: ignore[no-untyped-def]
    """Fill in the idle ways from place to place of an order."""
    for b in range(1, len(way)):
        legs.onward[b] = legs.there[way[b - 1], way[b]]
        legs.homeward[b] = legs.there[way[b], way[b - 1]]


@njit(cache=True)
def _turn_stretches(way, legs, may):  # type: ignore[no-untyped-def]
    """Turn round every stretch of the order where that is a gain; whether there was any."""
    lines, better, other = len(way), False, may[0]
    saved = _saved(legs)
    for i in range(lines - 1):
        if i > 0 and not _best_turn(way, legs, saved, i) > NOTHING_MM / 2:
            continue
        there = back = 0.0
        for j in range(i + 1, lines):
            there += legs.onward[j]
            back += legs.homeward[j]
            was = legs.onward[i] + there + legs.onward[j + 1]
            into = legs.there[way[i - 1], way[j]] if i > 0 else 0.0
            out = legs.there[way[i], way[j + 1]] if j + 1 < lines else 0.0
            if was - into - back - out > NOTHING_MM:
                for k in range(lines):
                    other[k] = way[i + j - k] if i <= k <= j else way[k]
                if _taken(way, legs, may):
                    there, back, better = back, there, True
                    saved = _saved(legs)
    return better


@njit(cache=True)
def _saved(legs):  # type: ignore[no-untyped-def]
    """By how much the way to each place of the order is longer than the way back from there, mm."""
    saved, total = np.zeros(len(legs.onward) - 1), 0.0
    for k in range(1, len(saved)):
        total += legs.onward[k] - legs.homeward[k]
        saved[k] = total
    return saved


@njit(cache=True, fastmath={"nnan", "nsz"})
def _best_turn(way, legs, saved, i):  # type: ignore[no-untyped-def]
    """The most that is gained by turning a stretch round that begins at place i, but the first, mm."""
    into, out, last = legs.there[way[i - 1]], legs.there[way[i]], len(way) - 1
    most = saved[last] - into[way[last]]
    for j in range(i + 1, last):
        gain = legs.onward[j + 1] + saved[j] - into[way[j]] - out[way[j + 1]]
        if gain > most:
            most = gain
    return legs.onward[i] - saved[i] + most


@njit(cache=True)
def _move_lines(way, legs, may):  # type: ignore[no-untyped-def]
    """Move up to three lines to where they are better off in the order; whether there was any gain."""
    lines, onward = len(way), legs.onward
    for i in range(lines):
        for j in range(i, min(i + MOVED, lines)):
            gap = legs.there[way[i - 1], way[j + 1]] if i > 0 and j + 1 < lines else 0.0
            out = onward[i] + onward[j + 1] - gap
            to_first, from_last = legs.back[way[i]], legs.there[way[j]]
            least = from_last[way[0]] if i > 0 else to_first[way[lines - 1]]
            if j + 1 < lines:
                least = min(least, to_first[way[lines - 1]])
            least = min(least, _least_into(way, (to_first, from_last), onward, (0, i - 1)))
            last = j + 1, lines - 1
            least = min(least, _least_into(way, (to_first, from_last), onward, last))
            if not out - least > NOTHING_MM:
                continue
            for k in range(-1, lines):
                if i - 1 <= k <= j:
                    continue
                into = to_first[way[k]] if k >= 0 else 0.0
                into += from_last[way[k + 1]] if k + 1 < lines else 0.0
                if out - (into - onward[k + 1]) > NOTHING_MM:
                    _move(way, (i, j, k), may[0])
                    if _taken(way, legs, may):
                        return True
    return False


@njit(cache=True, fastmath={"nnan", "nsz"})
def _least_into(way, to_and_from, onward, places):  # type: ignore[no-untyped-def]
    """The least way that lines add between a place and the next, of some places, mm."""
    (to_first, from_last), least = to_and_from, np.inf
    for k in range(places[0], places[1]):
        into = to_first[way[k]] + from_last[way[k + 1]] - onward[k + 1]
        if into < least:
            least = into
    return least


@njit(cache=True)
def _move(way, places, other):  # type: ignore[no-untyped-def]
    """Fill `other` with the order with places i … j put behind place k."""
    (i, j, k), lines, n = places, len(way), 0
    if k < i:
        parts = (0, k + 1), (i, j + 1), (k + 1, i), (j + 1, lines)
    else:
        parts = (0, i), (j + 1, k + 1), (i, j + 1), (k + 1, lines)
    for first, end in parts:
        for a in range(first, end):
            other[n] = way[a]
            n += 1


@njit(cache=True)
def _taken(way, legs, may):  # type: ignore[no-untyped-def]
    """Take another order, if in it every line comes after those that must be cut before it."""
    other, place, pairs = may
    for k in range(len(other)):
        place[other[k]] = k
    for n in range(len(pairs)):
        if place[pairs[n, 0]] > place[pairs[n, 1]]:
            return False
    for k in range(len(other)):
        way[k] = other[k]
    _lay_out(way, legs)
    return True
