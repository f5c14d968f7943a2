"""Offsets: the way of a round tool that runs along lines, its middle a radius away from them and nowhere
nearer to any.

Signals: polylines in mm, each with the side on which the tool runs, in; out the ways of the tool's middle,
closed where the line is.

    swung     the end of an arm as long as the radius, across the heading. Where the line turns away, the arm swings round the vertex: an arc. Where
              it turns towards the tool, the arm is drawn in, swings back, and is put out again: that is within the radius of the vertex.
    trimmed   what of that is nearer than the radius to any line is taken out. What is left ends where two of the swung ways cross, and there one
              goes on into the other.

             ______________ swung            ┐ the loop in the corner is within the radius of
            /   line  ____                   │ both legs: the way turns where they cross, and
           |    _____|    \\   loop          ┘ the corner itself is left

A way of the tool never changes the side: a place a radius away along the normal, and not nearer to any line,
has no line between.

Source: our own, from first principles (patent ES 361967 has the draughtsman allow for the cutter). At a
crossing the way turns as far to the left as it can, which is the way round the free side, as one walks round
a face of a plane map. Questions: the end of an open line has no cap: the tool does not go round it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numba import njit

from morfax.motion.arrays import Array
from morfax.motion.polyline import APART_MM, UM, Nearest, crossings_of, plain, with_places

PLAIN = 0.05 * UM  # a line is known by places between which it is straight within this
NEARER = 0.2 * UM  # than the radius: taken out
SET_BACK, LONG_MM = (
    5 * UM,
    1.0,
)  # so much nearer in places does not make a piece as long as this a loop: a kink of the line does
FREE, ALONE = (
    -1,
    -2,
)  # ends of a piece that lie at no crossing: of an open line, and of one round about
DEEP_MM = 0.05  # nearer than the radius by this: no crossing there can count
SAME_MM = 0.01 * UM  # places as near as this are one
SHAKEN_MM = 1e-4 * SAME_MM
LEAST_MM = 0.05  # a shorter way is none,
BROKEN = 0.1  # nor is one from crossing to crossing, shorter than this share of the radius
SLIGHT = math.radians(
    10
)  # turns towards the tool by less go straight to where the two ways beside the vertex meet,
KINK_MM = (
    0.1 * UM
)  # if that is no nearer to the line than this: it is, where the line beside the vertex is short
BACK = math.radians(
    179
)  # a line that turns by more comes back along itself: the tool goes round its tip


@dataclass(frozen=True, slots=True)
class Guide:
    """A line (n, 2) mm along which the tool runs on its left or its right."""

    points_mm: Array
    closed: bool
    left: bool


@dataclass(frozen=True, slots=True)
class Way:
    """A way of the tool's middle (n, 2) mm, and the number of the guide that most of it runs along; a closed
    one ends where it begins.
    """

    points_mm: Array
    closed: bool
    guide: int


def offset(guides: Sequence[Guide], radius_mm: float) -> list[Way]:
    """Ways of a tool of this radius along guides, each as the guide goes; none where the tool does not fit."""
    lines = [_guided(guide, radius_mm) for guide in guides]
    near = Nearest(
        [_closed_up(line, guide.closed) for line, guide in zip(lines, guides, strict=True)],
        radius_mm,
    )
    swung = [
        _swung(line, guide.closed, radius_mm) for line, guide in zip(lines, guides, strict=True)
    ]
    pieces = _parted(swung, [guide.closed for guide in guides], near, radius_mm)
    ways = list[Way]()
    for chain in _chains(pieces):
        closed = chain[0].start == chain[-1].end != FREE
        points = np.vstack([piece.points_mm for piece in chain])
        points = points[np.r_[True, np.hypot(*np.diff(points, axis=0).T) > SAME_MM]]
        guide = max(chain, key=lambda piece: piece.length_mm).guide
        broken = not closed and FREE not in (chain[0].start, chain[-1].end)
        if not _is_scrap(points, closed, radius_mm, BROKEN * radius_mm if broken else LEAST_MM):
            points = _begun(points, swung[guide][0]) if closed else points
            ways.append(Way(points if guides[guide].left else points[::-1], closed, guide))
    return ways


def _guided(guide: Guide, radius_mm: float) -> Array:
    """The places of a guide that count for a tool, the tool on its left; of a closed one the last is not the
    first again.
    """
    points = np.ascontiguousarray(
        guide.points_mm if guide.left else guide.points_mm[::-1], float
    )
    points = plain(points, PLAIN)
    points = points[np.r_[True, np.hypot(*np.diff(points, axis=0).T) > PLAIN]]
    if guide.closed and len(points) > 1 and np.hypot(*(points[-1] - points[0])) <= APART_MM:
        points = points[:-1]
    return points[_within_reach(points, math.sqrt(8 * PLAIN * radius_mm))]


@njit(cache=True)
def _within_reach(points, wide_mm):  # type: ignore[no-untyped-def]
    """Which places of a line the tool on its left may touch: not one that is set back between two so near
    that the tool does not sink in between.
    """
    kept, count = np.empty(len(points), np.int64), 0
    for k in range(len(points)):
        while count > 1:
            a, b = points[kept[count - 2]], points[kept[count - 1]]
            ux, uy, wx, wy = b[0] - a[0], b[1] - a[1], points[k, 0] - a[0], points[k, 1] - a[1]
            if ux * wy - uy * wx <= 0 or wx * wx + wy * wy > wide_mm * wide_mm:
                break
            count -= 1
        kept[count] = k
        count += 1
    return kept[:count].copy()


def _closed_up(points: Array, closed: bool) -> Array:
    """A polyline with its first place once more at its end, if it is closed."""
    return np.vstack([points, points[:1]]) if closed else points


def _swung(line: Array, closed: bool, radius_mm: float) -> Array:
    """The end of the arm to the left of a line, (n, 2) mm; of a closed line the last place is not the first
    again.
    """
    whole = _closed_up(line, closed)
    ways = np.diff(whole, axis=0)
    lengths = np.hypot(*ways.T)
    ways /= lengths[:, None]
    arms = radius_mm * np.column_stack([-ways[:, 1], ways[:, 0]])
    before = np.roll(ways, 1, axis=0) if closed else ways[:-1]
    after = ways if closed else ways[1:]
    turns = np.arctan2(
        before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0],
        np.einsum("ij,ij->i", before, after),
    )
    turns[np.abs(turns) > BACK] = -math.pi
    at_vertices = line if closed else line[1:-1]
    arms_before = np.roll(arms, 1, axis=0) if closed else arms[:-1]
    beside = (
        np.minimum(np.roll(lengths, 1), lengths)
        if closed
        else np.minimum(lengths[:-1], lengths[1:])
    )
    parts = [
        _swing(*each, radius_mm)
        for each in zip(at_vertices, arms_before, turns, beside, strict=True)
    ]
    if closed:
        way = np.vstack(parts)
        return with_places(_closed_up(way, True), APART_MM)[:-1]
    return with_places(np.vstack([line[:1] + arms[0], *parts, line[-1:] + arms[-1]]), APART_MM)


def _swing(vertex: Array, arm: Array, turn: float, beside_mm: float, radius_mm: float) -> Array:
    """Places of the arm's end while it turns at a vertex, to either side of which the line is straight for so
    many mm at least.
    """
    back_mm = max(
        0.0, radius_mm * math.tan(max(turn, 0.0) / 2) - beside_mm
    )  # beyond where the two ways beside it meet
    if (0 <= turn < SLIGHT and back_mm * turn < KINK_MM) or -math.sqrt(
        8 * PLAIN / radius_mm
    ) < turn < 0:
        return np.asarray(vertex + _turned(arm, np.array([turn / 2])) / math.cos(turn / 2))
    if turn > 0:
        arms, drawn_in = (
            np.vstack([arm, _turned(arm, np.array([turn]))]),
            max(0.0, 1 - 2 * DEEP_MM / radius_mm),
        )
        return np.asarray(vertex + np.vstack([arms[0], drawn_in * arms, arms[1]]))
    steps = math.ceil(-turn / math.sqrt(8 * PLAIN / radius_mm))
    return np.asarray(vertex + _turned(arm, np.linspace(0, turn, steps + 1)))


def _turned(arm: Array, angles: Array) -> Array:
    """An arm turned by angles, (n, 2)."""
    c, s = np.cos(angles), np.sin(angles)
    return np.column_stack([c * arm[0] - s * arm[1], s * arm[0] + c * arm[1]])


@dataclass(frozen=True, slots=True)
class _Piece:
    """A stretch of a swung way from one crossing to the next: its places (n, 2) mm and the numbers of the
    crossings, -1 for a free end.
    """

    points_mm: Array
    guide: int
    start: int
    end: int

    @property
    def length_mm(self) -> float:
        """Length of the piece, mm."""
        return float(np.hypot(*np.diff(self.points_mm, axis=0).T).sum())


def _parted(
    swung: list[Array], closed: list[bool], near: Nearest, radius_mm: float
) -> list[_Piece]:
    """The pieces between the crossings of swung ways that are nowhere nearer than the radius to a line."""
    shake = np.random.default_rng(
        0
    )  # no way lies exactly on another, and none crosses exactly in one of its places
    swung = [way + shake.uniform(-SHAKEN_MM, SHAKEN_MM, way.shape) for way in swung]
    ways = [
        _closed_up(way, round_about) for way, round_about in zip(swung, closed, strict=True)
    ]
    firsts = np.r_[0, np.cumsum([len(way) for way in ways])]
    every = np.vstack(ways)
    close = near.distances_mm(every) > radius_mm - DEEP_MM
    leads_on = np.ones(len(every), bool)
    leads_on[firsts[1:] - 1] = False
    pairs = crossings_of(every, np.flatnonzero(leads_on[:-1] & (close[:-1] | close[1:])))
    at = np.concatenate([pairs[:, 0], pairs[:, 1]])
    number = np.tile(np.arange(len(pairs)), 2)
    pieces = list[_Piece]()
    for guide, way in enumerate(ways):
        own = (at >= firsts[guide]) & (at < firsts[guide + 1])
        order = np.argsort(at[own])
        cuts = list(zip(at[own][order] - firsts[guide], number[own][order], strict=True))
        pieces += _between(way, cuts, closed[guide], guide)
    return [
        clear for piece in pieces if (clear := _cleared(piece, near, radius_mm)) is not None
    ]


def _cleared(piece: _Piece, near: Nearest, radius_mm: float) -> _Piece | None:
    """A piece that is nowhere nearer than the radius to a line, a long one with its places set back by some
    um if need be; None if it is nearer.
    """
    nearest_mm = near.distances_mm(_inner(piece.points_mm)).min()
    if nearest_mm >= radius_mm - NEARER:
        return piece
    if nearest_mm < radius_mm - SET_BACK or piece.length_mm < LONG_MM:
        return None
    piece = replace(piece, points_mm=near.set_back(piece.points_mm, radius_mm))
    return (
        piece
        if near.distances_mm(_inner(piece.points_mm)).min() >= radius_mm - NEARER
        else None
    )


def _between(
    way: Array, cuts: list[tuple[float, int]], closed: bool, guide: int
) -> list[_Piece]:
    """A way parted at its cuts: how far along it in places, and the number of the crossing."""
    if not cuts:
        return [_Piece(way, guide, *((ALONE, ALONE) if closed else (FREE, FREE)))]
    pieces = [_Piece(_stretch(way, a, b), guide, m, n) for (a, m), (b, n) in pairwise(cuts)]
    (first, m), (last, n) = cuts[0], cuts[-1]
    before, after = _stretch(way, 0, first), _stretch(way, last, len(way) - 1)
    if closed:
        return [*pieces, _Piece(np.vstack([after, before[1:]]), guide, n, m)]
    return [_Piece(before, guide, FREE, m), *pieces, _Piece(after, guide, n, FREE)]


def _stretch(way: Array, begin: float, end: float) -> Array:
    """The part of a polyline between two of its places, which may lie between those given."""
    inner = np.arange(math.floor(begin) + 1, math.ceil(end))
    at = np.r_[begin, inner, end]
    return np.column_stack([np.interp(at, np.arange(len(way)), column) for column in way.T])


def _inner(points: Array) -> Array:
    """The places of a polyline but its ends, and the middles between all."""
    return np.vstack([points[1:-1], 0.5 * (points[1:] + points[:-1])])


def _chains(pieces: list[_Piece]) -> list[list[_Piece]]:
    """The pieces, one joined to the next where they cross, always the one furthest to the left: away from the
    lines.
    """
    leaving: dict[int, list[_Piece]] = {}
    for piece in pieces:
        leaving.setdefault(piece.start, []).append(piece)
    chains = list[list[_Piece]]()
    for first in sorted(pieces, key=lambda piece: (piece.start != FREE, -piece.length_mm)):
        if not any(first is piece for piece in leaving[first.start]):
            continue  # it is in a chain already
        chain, passed = [_taken(first, leaving)], {first.start}
        while (
            chain[-1].end >= 0 and chain[-1].end != first.start and leaving.get(chain[-1].end)
        ):
            passed.add(chain[-1].end)
            chain.append(
                _taken(
                    _next(chain[-1], leaving[chain[-1].end], passed - {first.start}), leaving
                )
            )
        chains.append(chain)
    return chains


def _next(arriving: _Piece, leaving: list[_Piece], passed: set[int]) -> _Piece:
    """The piece furthest to the left of those at a crossing, but for one that only curls back to a crossing
    passed already, within `NEARER`.
    """
    on = [piece for piece in leaving if piece.end not in passed] or leaving
    return max(on, key=lambda piece: _turn(arriving, piece))


def _taken(piece: _Piece, leaving: dict[int, list[_Piece]]) -> _Piece:
    """A piece, taken from those that are left."""
    leaving[piece.start] = [other for other in leaving[piece.start] if other is not piece]
    return piece


def _turn(arriving: _Piece, leaving: _Piece) -> float:
    """By how much the way turns to the left from the end of a piece onto another, rad."""
    a, b = (
        arriving.points_mm[-1] - arriving.points_mm[-2],
        leaving.points_mm[1] - leaving.points_mm[0],
    )
    return math.atan2(a[0] * b[1] - a[1] * b[0], a @ b)


def _is_scrap(points: Array, closed: bool, radius_mm: float, least_mm: float) -> bool:
    """Whether a way is none: too short, or round nothing, though to the right it must go round a line."""
    length_mm = float(np.hypot(*np.diff(points, axis=0).T).sum())
    area_mm2 = 0.5 * float(
        np.sum(points[:-1, 0] * points[1:, 1] - points[1:, 0] * points[:-1, 1])
    )
    round_a_line = area_mm2 < 0 and length_mm > 6 * radius_mm
    return length_mm < least_mm or (
        closed and not round_a_line and 2 * area_mm2 < NEARER * length_mm
    )


def _begun(points: Array, start_mm: Array) -> Array:
    """A closed way begun at the place of the guide's own start, or furthest from where it turns sharply."""
    points = points[:-1]
    away = np.hypot(*(points - start_mm).T)
    first = int(np.argmin(away))
    if away[first] > SAME_MM:
        ways = np.diff(_closed_up(points, True), axis=0)
        turns = np.abs(
            np.angle(np.exp(1j * np.diff(np.r_[0, np.arctan2(ways[:, 1], ways[:, 0])])))
        )
        sharp = np.flatnonzero(turns > SLIGHT)
        gaps = np.diff(np.r_[sharp, sharp[:1] + len(points)])
        first = int(sharp[np.argmax(gaps)] + gaps.max() // 2) % len(points) if len(sharp) else 0
    return _closed_up(np.roll(points, -first, axis=0), True)
