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

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit

# All limits below were chosen by trial.
FIRSTS = 16  # lines that are tried as the first of the order, and as the last
SOME = 2000  # places in all the orders that are tried: of a hundred lines 16 orders, of a thousand two
MOVED = 3  # lines moved together
TURNINGS = 6  # orders that are tried, each with the lines turned as is best for the one before
GAIN_MM = 1e-9  # a smaller gain is rounding


def in_order(starts_mm: Array, ends_mm: Array, before: NDArray[np.bool_]) -> list[int]:
    """The order of lines that keeps the idle way short; `before[i, j]`: i is cut before j."""
    across_mm = np.asarray(ends_mm)[:, None] - np.asarray(starts_mm)[None]
    idle_mm = np.hypot(*across_mm.transpose(2, 0, 1))
    there = _from_firsts(idle_mm, before)
    back = _from_firsts(idle_mm.T.copy(), before.T.copy())
    ways = [_improved(way, idle_mm, before) for way in there]
    ways += [_improved(way[::-1].copy(), idle_mm, before) for way in back]
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
        turned = turned ^ _to_turn(begin, finish, order, may_turn)
        begin, finish = _turned_ends(ends, turned)
        idle_mm = float(np.hypot(*(begin[order[1:]] - finish[order[:-1]]).T).sum())
        if best is not None and idle_mm >= best[0] - GAIN_MM:
            break
        best = idle_mm, order, turned
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
        steps = np.hypot(*(ends[:, b][None] - ends[::-1, a][:, None]).transpose(2, 0, 1))
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


@njit(cache=True)
def _improved(way, idle_mm, before):  # type: ignore[no-untyped-def]
    """The order made shorter by turning stretches and moving up to three lines, until neither helps."""
    better = True
    while better:
        better = _turn_stretches(way, idle_mm, before) | _move_lines(way, idle_mm, before)
    return way


@njit(cache=True)
def _turn_stretches(way, idle_mm, before):  # type: ignore[no-untyped-def]
    """Turn round every stretch of the order where that is a gain; whether there was any."""
    better = False
    for i in range(len(way) - 1):
        there = back = 0.0
        for j in range(i + 1, len(way)):
            there += idle_mm[way[j - 1], way[j]]
            back += idle_mm[way[j], way[j - 1]]
            was = _leg(way, idle_mm, i - 1, i) + there + _leg(way, idle_mm, j, j + 1)
            if (
                was - _leg(way, idle_mm, i - 1, j) - back - _leg(way, idle_mm, i, j + 1)
                > GAIN_MM
            ):
                turned = np.concatenate((way[:i], way[i : j + 1][::-1], way[j + 1 :]))
                if _allowed(turned, before):
                    way[:] = turned
                    there, back, better = back, there, True
    return better


@njit(cache=True)
def _move_lines(way, idle_mm, before):  # type: ignore[no-untyped-def]
    """Move up to three lines to where they are better off in the order; whether there was any gain."""
    for i in range(len(way)):
        for j in range(i, min(i + MOVED, len(way))):
            out = (
                _leg(way, idle_mm, i - 1, i)
                + _leg(way, idle_mm, j, j + 1)
                - _leg(way, idle_mm, i - 1, j + 1)
            )
            for k in range(-1, len(way)):
                if i - 1 <= k <= j:
                    continue
                into = (
                    _leg(way, idle_mm, k, i)
                    + _leg(way, idle_mm, j, k + 1)
                    - _leg(way, idle_mm, k, k + 1)
                )
                if out - into > GAIN_MM:
                    moved = _moved(way, i, j, k)
                    if _allowed(moved, before):
                        way[:] = moved
                        return True
    return False


@njit(cache=True)
def _moved(way, i, j, k):  # type: ignore[no-untyped-def]
    """The order with places i … j put behind place k."""
    if k < i:
        return np.concatenate((way[: k + 1], way[i : j + 1], way[k + 1 : i], way[j + 1 :]))
    return np.concatenate((way[:i], way[j + 1 : k + 1], way[i : j + 1], way[k + 1 :]))


@njit(cache=True)
def _leg(way, idle_mm, i, j):  # type: ignore[no-untyped-def]
    """Idle way from one place of the order to another, mm; none before the first and after the last."""
    return 0.0 if i < 0 or j >= len(way) else idle_mm[way[i], way[j]]


@njit(cache=True)
def _allowed(way, before):  # type: ignore[no-untyped-def]
    """Whether every line comes after those that must be cut before it."""
    for a in range(len(way)):
        for b in range(a + 1, len(way)):
            if before[way[b], way[a]]:
                return False
    return True
