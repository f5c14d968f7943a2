"""Trimming: of the ways that an arm's end goes, what is nowhere nearer to a line than the radius.

Signals: swung ways (see `arm`), (n, 2) mm, and the lines to keep away from in; chains of pieces out, each
from crossing to crossing.

             ______________ swung            ┐ the loop in the corner is within the radius of
            /   line  ____                   │ both legs: the way turns where they cross, and
           |    _____|    \\   loop          ┘ the corner itself is left

At a crossing a chain turns as far to the left as it can: that is the way round the free side, as one walks
round a face of a plane map.

Source: our own, from first principles.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from morfax.motion.arm import DEEP_MM
from morfax.motion.arrays import Array
from morfax.motion.crossings import crossings_of
from morfax.motion.plane import cross
from morfax.motion.polyline import UM, Nearest, at_places, closed_up, length_mm

NEARER = 0.2 * UM  # than the radius: a piece that is nearer is taken out, ...
# ... but for one of this length that is nearer by no more than this: there the line has a kink; by trial
LONG_MM, SET_BACK = 1.0, 5 * UM
SAME_MM = 0.01 * UM  # places as near as this are one
SHAKEN_MM = 1e-4 * SAME_MM  # so that no way lies exactly on another
FREE, ALONE = -1, -2  # ends that lie at no crossing: of an open line, and of a line round about

Cut = tuple[float, int]  # a place of a way, and the number of the crossing there


@dataclass(frozen=True, slots=True)
class OffsetPiece:
    """A swung way from one crossing to the next: places (n, 2) mm, its line, and its crossings or `FREE`."""

    points_mm: Array
    guide: int
    start: int
    end: int

    @property
    def length_mm(self) -> float:
        """Length of the piece, mm."""
        return length_mm(self.points_mm)


def trimmed(
    swung: Sequence[Array], closed: Sequence[bool], near: Nearest, radius_mm: float
) -> list[OffsetPiece]:
    """The pieces between the crossings of swung ways that are nowhere nearer than the radius to a line."""
    shake = np.random.default_rng(0)
    ways = list[Array]()
    for way, is_closed in zip(swung, closed, strict=True):
        shaken = way + shake.uniform(-SHAKEN_MM, SHAKEN_MM, way.shape)
        ways.append(closed_up(shaken) if is_closed else shaken)
    firsts = np.r_[0, np.cumsum([len(way) for way in ways])]
    pairs = _crossings(ways, firsts, near, radius_mm)
    at = np.concatenate([pairs[:, 0], pairs[:, 1]])
    number = np.tile(np.arange(len(pairs)), 2)
    pieces = list[OffsetPiece]()
    for guide, way in enumerate(ways):
        own = (at >= firsts[guide]) & (at < firsts[guide + 1])
        order = np.argsort(at[own])
        cuts = list(zip(at[own][order] - firsts[guide], number[own][order], strict=True))
        pieces += _parted(way, cuts, closed[guide], guide)
    cleared = (_cleared(piece, near, radius_mm) for piece in pieces)
    return [piece for piece in cleared if piece is not None]


def chains(pieces: Sequence[OffsetPiece]) -> list[list[OffsetPiece]]:
    """The pieces joined where they cross, always to the one furthest to the left: away from the lines."""
    leaving: dict[int, list[OffsetPiece]] = {}
    for piece in pieces:
        leaving.setdefault(piece.start, []).append(piece)
    made = list[list[OffsetPiece]]()
    for first in sorted(pieces, key=lambda piece: (piece.start != FREE, -piece.length_mm)):
        if not any(first is piece for piece in leaving[first.start]):
            continue  # it is in a chain already
        chain, passed = [_taken(first, leaving)], {first.start}
        end = first.end
        while end >= 0 and end != first.start and leaving.get(end):
            passed.add(end)
            onward = _next(chain[-1], leaving[end], passed - {first.start})
            chain.append(_taken(onward, leaving))
            end = onward.end
        made.append(chain)
    return made


def _crossings(ways: list[Array], firsts: Array, near: Nearest, radius_mm: float) -> Array:
    """Where the ways cross, as numbers of places of all ways, (n, 2); not deep within the radius."""
    every = np.vstack(ways)
    close = near.distances_mm(every) > radius_mm - DEEP_MM
    leads_on = np.ones(len(every), bool)
    leads_on[firsts[1:] - 1] = False
    counts = leads_on[:-1] & (close[:-1] | close[1:])
    return crossings_of(every, np.flatnonzero(counts))


def _cleared(piece: OffsetPiece, near: Nearest, radius_mm: float) -> OffsetPiece | None:
    """A piece nowhere nearer than the radius to a line, a long one set back if need be; None if nearer."""
    nearest_mm = near.distances_mm(_inner(piece.points_mm)).min()
    if nearest_mm >= radius_mm - NEARER:
        return piece
    if nearest_mm < radius_mm - SET_BACK or piece.length_mm < LONG_MM:
        return None
    piece = replace(piece, points_mm=near.set_back(piece.points_mm, radius_mm))
    nearest_mm = near.distances_mm(_inner(piece.points_mm)).min()
    return piece if nearest_mm >= radius_mm - NEARER else None


def _parted(way: Array, cuts: list[Cut], closed: bool, guide: int) -> list[OffsetPiece]:
    """A way parted at its cuts."""
    if not cuts:
        ends = ALONE if closed else FREE
        return [OffsetPiece(way, guide, ends, ends)]
    pieces = [
        OffsetPiece(_stretch(way, a, b), guide, m, n) for (a, m), (b, n) in pairwise(cuts)
    ]
    first, m = cuts[0]
    last, n = cuts[-1]
    before = _stretch(way, 0, first)
    after = _stretch(way, last, len(way) - 1)
    if closed:
        return [*pieces, OffsetPiece(np.vstack([after, before[1:]]), guide, n, m)]
    return [OffsetPiece(before, guide, FREE, m), *pieces, OffsetPiece(after, guide, n, FREE)]


def _stretch(way: Array, begin: float, end: float) -> Array:
    """The part of a polyline between two of its places, fractions included."""
    inner = np.arange(math.floor(begin) + 1, math.ceil(end))
    return at_places(way, np.r_[begin, inner, end])


def _inner(points: Array) -> Array:
    """The places of a polyline but its ends, and the middles between all."""
    return np.vstack([points[1:-1], 0.5 * (points[1:] + points[:-1])])


def _next(arriving: OffsetPiece, leaving: list[OffsetPiece], passed: set[int]) -> OffsetPiece:
    """The piece furthest to the left at a crossing, but not one that only curls back to a crossing passed."""
    on = [piece for piece in leaving if piece.end not in passed] or leaving
    return max(on, key=lambda piece: _turn(arriving, piece))


def _taken(piece: OffsetPiece, leaving: dict[int, list[OffsetPiece]]) -> OffsetPiece:
    """A piece, taken from those that are left."""
    leaving[piece.start] = [other for other in leaving[piece.start] if other is not piece]
    return piece


def _turn(arriving: OffsetPiece, leaving: OffsetPiece) -> float:
    """By how much the way turns to the left from the end of a piece onto another, rad."""
    a = arriving.points_mm[-1] - arriving.points_mm[-2]
    b = leaving.points_mm[1] - leaving.points_mm[0]
    return math.atan2(cross(a, b), a @ b)
