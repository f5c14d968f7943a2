"""Several contours of one drawing: which lines, which of them lie inside which, and in what order they are cut. Plans only, never the path.

Signals: a Drawing and what is asked for ("all", "outer" or numbers) in; contours out, each a stroke of ink with its number. Then the places where the followed
lines begin and end, and which lie inside which, in; the order out (all mm on the sheet).

    ┌───────────────┐        numbers: 1 is the longest line, then as they get shorter
    │  ( 2 )   ( 3 )│        order: 2, 3, 1: what lies inside is cut first, as what lies outside
    └─────── 1 ─────┘        comes loose when it is cut; the idle way is 2 → 3 → 1

Order: from each of several first lines always on to the nearest that may be cut, and back from each of several last ones; then, as long as it makes the idle
way shorter and keeps inner before outer, a stretch of the order is turned round, or up to three lines are moved elsewhere. Where the first line is does not
count: the tool stands at clearance there when the program begins.

Source: patent ES 361967 has one contour to a tape; several are our own. Improving by turning stretches round is Croes, Operations Research 6 (1958); by
moving short stretches, Or (1976).

Questions: what is a line and what a speck, a letter or a burr? A patch of ink shorter than 4 mm, or than six of its widths, is none unless it reaches over
12 mm: the hole of 2 mm that is drawn with 0.8 mm has 6.3 mm and eight widths, and a long line that runs into a blot has a large mean width. A larger letter is
a line, and is left out by asking for the others by number.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from morfax.motion.faults import LineFault
from morfax.tracer.drawing.strokes import Array, Sheet, Stroke

Which = str | tuple[int, ...]  # "all", "outer", or the numbers of lines

LEAST_MM, LEAST_WIDTHS = 4.0, 6.0  # a shorter patch is a speck, a letter or a burr,
LETTER_MM = 12.0  # unless it reaches as far as this
PLAIN = 0.06  # ink about a place of a plain stretch differs by less than this share from what is usual on the line
STARTS = 8  # places at which the head may be put down on a line
LOOKED_AT = 400  # places of a line that are looked at for them
COVERED = 0.8  # a stroke is a part of a followed line if as much of it lies on that line
FIRSTS = 16  # lines that are tried as the first of the order, and as the last
SOME = 2000  # places in all the orders that are tried: of a hundred lines all FIRSTS are, of a thousand two
MOVED = 3  # lines moved together
TURNINGS = 6  # orders that are tried, each with the lines turned as is best for the one before


@dataclass(frozen=True, slots=True)
class Contour:
    """A line that is asked for: its number, its stroke of ink, and how far it reaches in X or Y."""

    number: int
    stroke: Stroke
    reach_mm: float

    def starts_mm(self) -> list[tuple[float, float]]:
        """Places to put the head down, the plainest first: those furthest from corners, crossings and ends; a few, apart."""
        stroke = self.stroke
        some = slice(None, None, max(1, len(stroke.middles_mm) // LOOKED_AT))
        places, filled = stroke.middles_mm[some], stroke.filled[some]
        odd = places[np.abs(filled / np.median(filled) - 1) > PLAIN]
        clear_mm = _nearest_mm(places, odd) if len(odd) else np.zeros(len(places))
        kept: list[Array] = []
        for place in places[np.argsort(-clear_mm, kind="stable")]:
            if len(kept) < STARTS and all(np.hypot(*(place - k)) > 4 * stroke.width_mm for k in kept):
                kept.append(place)
        return [(float(x), float(y)) for x, y in kept]

    def lies_on(self, line_mm: Array) -> bool:
        """Whether a followed line (n, 2) mm runs along most of this stroke, as it does along a line with gaps."""
        places = self.stroke.middles_mm[:: max(1, len(self.stroke.middles_mm) // 40)]
        near = (places > line_mm.min(axis=0) - 1) & (places < line_mm.max(axis=0) + 1)
        if near.all(axis=1).mean() < COVERED:
            return False
        return bool(np.mean(_nearest_mm(places, line_mm) < self.stroke.width_mm) > COVERED)

    def lies_in(self, line_mm: Array) -> bool:
        """Whether this stroke lies inside a followed line (n, 2) mm."""
        return lies_inside(self.stroke.middles_mm, line_mm)


def plan(sheet: Sheet, which: Which) -> tuple[list[Contour], int]:
    """Contours that are asked for, the widest spread first (so none comes before one that it lies in), and how many patches are too short.

    "outer" is still all of them: what lies inside which is known when they have been followed. Raises LineFault for a number that no line has.
    """
    reach_mm, patches = _reach_mm(sheet), lines_of(sheet)
    numbers = _numbers(which, len(patches))
    asked = [int(patches[number - 1]) for number in numbers]
    contours = [Contour(n, sheet.stroke(p), float(reach_mm[p])) for n, p in zip(numbers, asked, strict=True)]
    spread = [float(np.prod(np.ptp(c.stroke.middles_mm, axis=0) + c.stroke.width_mm)) for c in contours]
    return [contours[i] for i in np.argsort(spread)[::-1]], sheet.patches.count - len(patches)


def lines_of(sheet: Sheet) -> NDArray[np.int64]:
    """The patches that are lines, the longest first: of those along edges all."""
    least_mm = 0.0 if sheet.drawing.edges_mm else np.maximum(LEAST_MM, LEAST_WIDTHS * sheet.widths_mm)
    long_enough = sheet.lengths_mm >= least_mm
    patches = np.flatnonzero(long_enough | (_reach_mm(sheet) >= LETTER_MM))
    return patches[np.argsort(-sheet.lengths_mm[patches], kind="stable")]


def _reach_mm(sheet: Sheet) -> Array:
    """How far each patch reaches in X or Y, mm."""
    return np.asarray(sheet.patches.longer_sides * sheet.drawing.pitch_mm)


def nested(lines_mm: Sequence[Array], round_about: Sequence[bool]) -> NDArray[np.bool_]:
    """Which line (n, 2) mm lies inside which: `nested[i, j]` if i lies inside j, and j goes round about something."""
    inner = [
        [
            round_j and a is not b and lies_inside(a, b)
            for b, round_j in zip(lines_mm, round_about, strict=True)
        ]
        for a in lines_mm
    ]
    return np.array(inner, bool).reshape(len(lines_mm), len(lines_mm))


def in_order(starts_mm: Array, ends_mm: Array, before: NDArray[np.bool_]) -> list[int]:
    """The order of lines that keeps the idle way from each end to the next start short; `before[i, j]`: i is cut before j."""
    idle_mm = np.hypot(*(np.asarray(ends_mm)[:, None] - np.asarray(starts_mm)[None]).transpose(2, 0, 1))
    ways = [_improved(way, idle_mm, before) for way in _from_firsts(idle_mm, before)]
    ways += [
        _improved(way[::-1].copy(), idle_mm, before)
        for way in _from_firsts(idle_mm.T.copy(), before.T.copy())
    ]
    return [int(i) for i in min(ways, key=lambda way: idle_way_mm(way, idle_mm))]


def in_order_and_turned(
    starts_mm: Array, ends_mm: Array, before: NDArray[np.bool_], may_turn: NDArray[np.bool_]
) -> tuple[list[int], NDArray[np.bool_]]:
    """The order of lines, and which of those that may be begun at their other end are to be, that keep the idle way short."""
    ends = np.stack([np.asarray(starts_mm, float), np.asarray(ends_mm, float)])
    turned = np.zeros(len(may_turn), bool)
    best: tuple[float, list[int], NDArray[np.bool_]] | None = None
    for _ in range(TURNINGS):
        begin, finish = (ends[np.where(turned, 1 - k, k), np.arange(len(turned))] for k in (0, 1))
        order = in_order(begin, finish, before)
        turned = turned ^ _to_turn(begin, finish, order, may_turn)
        begin, finish = (ends[np.where(turned, 1 - k, k), np.arange(len(turned))] for k in (0, 1))
        idle_mm = float(np.hypot(*(begin[order[1:]] - finish[order[:-1]]).T).sum())
        if best is not None and idle_mm >= best[0] - 1e-9:
            break
        best = idle_mm, order, turned
    assert best is not None
    return best[1], best[2]


def _to_turn(
    starts_mm: Array, ends_mm: Array, order: list[int], may_turn: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Which lines of an order are best turned round: the shortest way through it, each line as it is or turned."""
    ends = np.stack([starts_mm, ends_mm])
    idle_mm, came = np.where([True, bool(may_turn[order[0]])], 0.0, np.inf), []
    for a, b in pairwise(order):
        steps = np.hypot(
            *(ends[:, b][None] - ends[::-1, a][:, None]).transpose(2, 0, 1)
        )  # from a (as is, turned) to b
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
    """Length of the rapid moves of an order; `idle_mm[i, j]` is the way from the end of i to the start of j."""
    way = np.asarray(way)
    return float(idle_mm[way[:-1], way[1:]].sum())


def _numbers(which: Which, lines: int) -> list[int]:
    """Numbers of the lines to follow; raises LineFault for one that there is not."""
    if isinstance(which, str):
        if which not in ("all", "outer"):
            raise ValueError(f"{which!r} names no lines; give 'all', 'outer', or their numbers")
        return list(range(1, lines + 1))
    numbers = sorted(set(which))
    for number in numbers:
        if not 1 <= number <= lines:
            raise no_line(number, range(1, lines + 1))
    return numbers


def no_line(number: int, have: Sequence[int]) -> LineFault:
    """The fault of a number that no line has, with those that there are."""
    lines = f"{'line' if len(have) == 1 else 'lines'} {_told(have)}" if have else "none"
    return LineFault(
        f"no line {number}: the drawing has {lines}, numbered from the longest on (no specks, letters, pieces of a line with gaps);"
        " give --lines all and a --picture to see them"
    )


def _told(numbers: Sequence[int]) -> str:
    """Numbers as people read them, "1 to 3, 5"."""
    runs = [
        [n for _, n in run] for _, run in groupby(enumerate(sorted(numbers)), key=lambda at: at[1] - at[0])
    ]
    return ", ".join(f"{run[0]} to {run[-1]}" if len(run) > 2 else ", ".join(map(str, run)) for run in runs)


def _from_firsts(idle_mm: Array, before: NDArray[np.bool_]) -> list[NDArray[np.int64]]:
    """Orders that go on to the nearest line from each of those that may be first, or from some of them if they are many."""
    firsts = np.flatnonzero(~before.any(axis=0))
    tried = min(FIRSTS, max(1, SOME // len(idle_mm)))
    return [_on_to_nearest(int(first), idle_mm, before) for first in firsts[:: -(-len(firsts) // tried)]]


def lies_inside(inner_mm: Array, outer_mm: Array) -> bool:
    """Whether a line begins inside another, whose end is joined to its start, and reaches less far than that one."""
    x, y = float(inner_mm[0, 0]), float(inner_mm[0, 1])
    if not (np.ptp(inner_mm, axis=0) < np.ptp(outer_mm, axis=0)).all():
        return False  # lines that cross are in neither's inside: an order there must be
    return cv2.pointPolygonTest(np.asarray(outer_mm, np.float32), (x, y), False) > 0


def _nearest_mm(places_mm: Array, others_mm: Array) -> Array:
    """Distance of each place from the nearest of others, mm."""
    return np.array([np.hypot(*(others_mm - place).T).min() for place in places_mm])


@njit(cache=True)
def _on_to_nearest(first, idle_mm, before):  # type: ignore[no-untyped-def]
    """From the first line always on to the nearest one all whose inner lines are cut."""
    lines = len(idle_mm)
    way, cut = np.empty(lines, np.int64), np.zeros(lines, np.bool_)
    way[0], cut[first] = first, True
    for k in range(1, lines):
        best = -1
        for i in range(lines):
            waits = cut[i] or np.any(before[:, i] & ~cut)
            if not waits and (best < 0 or idle_mm[way[k - 1], i] < idle_mm[way[k - 1], best]):
                best = i
        way[k], cut[best] = best, True
    return way


@njit(cache=True)
def _improved(way, idle_mm, before):  # type: ignore[no-untyped-def]
    """The order made shorter by turning stretches round and by moving up to three lines, until neither helps."""
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
            if was - _leg(way, idle_mm, i - 1, j) - back - _leg(way, idle_mm, i, j + 1) > 1e-9:
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
                _leg(way, idle_mm, i - 1, i) + _leg(way, idle_mm, j, j + 1) - _leg(way, idle_mm, i - 1, j + 1)
            )
            for k in range(-1, len(way)):
                if i - 1 <= k <= j:
                    continue
                into = _leg(way, idle_mm, k, i) + _leg(way, idle_mm, j, k + 1) - _leg(way, idle_mm, k, k + 1)
                if out - into > 1e-9:
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
