"""The spline: a strip that a draughtsman bends between weights, laid along a stretch of line by its ink.

    ─────●     ●──●       ● weights, which move across the strip; it bends smoothly from one to the next
          ╲___╱    ╲
       corner       ●     at a corner it is broken, and its weight moves anywhere

Between places of a line on which it is clean, the weights move to where a pen along the strip leaves least of
the ink unexplained. What no compass and no folding rule draws is drawn so: an arc that begins at a corner, a
step with a round, the relief of an inner corner.

Between two weights the strip is a cubic, and its curvature goes on over each weight, as a thin strip's does.
It comes to its ends on the headings of the line there. From a corner it leaves on an arc.

Signals: a stretch of way, its corners, and the ink about it in; the way of the strip that explains the ink
out.

Source: our own; the strip is the natural cubic spline of ship's draughtsmen.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.plane import left_of, unit
from morfax.tracer.tangles import moved_way
from morfax.tracer.tangles.figured import Figured
from morfax.tracer.tangles.least_squares import fitted
from morfax.tracer.tangles.seen_ink import SeenInk

PLACES_WIDTHS = 0.12  # between the places that a strip is drawn with
ASIDE = 3  # places on either side of one: they show across what its weight moves
ENDS = 3  # places from an end, and as many on, show its heading
MOST_STEPS = (
    12  # times that the ink is drawn: weights that lie 0.3 widths off settle within six
)


class Weights(NamedTuple):
    """Where the weights of a strip lie: numbers (k,) of places along its stretch, fractions included, the
    first and the last of which stay, and which of them (k,) are corners.
    """

    at: Array
    sharp: NDArray[np.bool_]

    @classmethod
    def apart(cls, count: int, corners: Sequence[int], every: float) -> Weights:
        """Weights on a stretch of so many places with corners at some, and about every so many between."""
        cuts = [0, *sorted(corners), count - 1]
        at, sharp = [0.0], [False]
        for first, last in pairwise(cuts):
            pieces = max(1, round((last - first) / every))
            at += np.linspace(first, last, pieces + 1)[1:].tolist()
            sharp += [False] * (pieces - 1) + [last != cuts[-1]]
        return cls(np.array(at), np.array(sharp))


class Strip(NamedTuple):
    """A strip's way (m, 2) mm as its weights lie, how far each figure moves its places, (m, f, 2), and at
    which of its places (m,) it is broken.
    """

    way_mm: Array
    moves: Array
    sharp: NDArray[np.bool_]

    @classmethod
    def along(cls, own: Array, step_mm: float, weights: Weights, apart_mm: float) -> Strip:
        """A strip along a stretch (n, 2) mm, a step from place to place, drawn with places so far apart."""
        at, sharp = weights
        ends = np.flatnonzero(np.r_[True, sharp[1:-1], True])
        come_mm = at * step_mm
        # 1. each part by the cubics between its weights
        shares, slopes, corners = list[Array](), list[Array](), list[int]()
        drawn = 0
        for first, last in pairwise(ends.tolist()):
            clamped = first == 0, last == len(at) - 1
            part_mm = come_mm[first : last + 1]
            places = max(2, 1 + math.ceil((part_mm[-1] - part_mm[0]) / apart_mm))
            drawn_mm = np.linspace(part_mm[0], part_mm[-1], places)
            shared = _cubics(part_mm, drawn_mm, clamped)
            of_all = np.zeros((places, len(at) + 2))
            of_all[:, first : last + 1] = shared[:, :-2]
            of_all[:, -2:] = shared[:, -2:]
            shares.append(of_all[drawn > 0 :, :-2])
            slopes.append(of_all[drawn > 0 :, -2:])
            drawn += places - (drawn > 0)
            corners.append(drawn - 1)
        # 2. where the weights lie, and what moves them
        number = np.arange(len(own))
        lie = np.column_stack([np.interp(at, number, column) for column in own.T])
        heading = unit(np.array([_leaves(own), -_leaves(own[::-1])]))
        share = np.vstack(shares)
        way = share @ lie + np.vstack(slopes) @ heading
        broken = np.isin(np.arange(len(way)), corners[:-1])
        return cls(way, _moves(own, weights, share), broken)

    @property
    def figures(self) -> int:
        """How many figures it has."""
        return self.moves.shape[1]

    def moved(self, figures: Array) -> Array:
        """Its way (m, 2) mm with its weights moved by some figures (f,), mm."""
        return np.asarray(self.way_mm + np.tensordot(self.moves, figures, (1, 0)))

    def settled(self, ink: SeenInk) -> Array:
        """Its way (m, 2) mm where a pen along it leaves least of the ink unexplained."""
        if not self.figures:
            return self.way_mm
        shape = Figured.moved(self.way_mm, self.moves, self.sharp)
        return self.moved(fitted(shape, ink.for_kernel(), np.zeros(self.figures), MOST_STEPS))


def _leaves(own: Array) -> Array:
    """Along which way (x, y) a stretch (n, 2) leaves its first place, if it bends evenly there."""
    return np.asarray(4 * (own[ENDS] - own[0]) - (own[2 * ENDS] - own[0]))


def _moves(own: Array, weights: Weights, share: Array) -> Array:
    """How far each figure moves places (m, f, 2), of which so much (m, k) is each weight's: a weight between
    the ends moves across its stretch (n, 2), one at a corner along x and y.
    """
    moves = list[Array]()
    for k in range(1, len(weights.at) - 1):
        ways = np.eye(2)
        if not weights.sharp[k]:
            i = round(float(weights.at[k]))
            ahead = own[min(i + ASIDE, len(own) - 1)] - own[max(i - ASIDE, 0)]
            ways = left_of(ahead / max(float(np.hypot(*ahead)), NOT_ZERO))[None]
        moves += [share[:, k, None] * way for way in ways]
    return np.stack(moves, axis=1) if moves else np.empty((len(share), 0, 2))


def _cubics(weights_mm: Array, places_mm: Array, clamped: tuple[bool, bool]) -> Array:
    """Which share of each place (m,) along a strip comes from each of its weights (k,), and from the slopes
    at its ends, if it is clamped there: (m, k + 2). At an end that is not its curvature stays the same.
    """
    count, long_mm = len(weights_mm), np.diff(weights_mm)
    # 1. the curvature at the weights
    left, right = np.zeros((count, count)), np.zeros((count, count + 2))
    for k in range(1, count - 1):
        a, b = long_mm[k - 1], long_mm[k]
        left[k, k - 1 : k + 2] = a, 2 * (a + b), b
        right[k, k - 1 : k + 2] = 6 / a, -6 / a - 6 / b, 6 / b
    for end, beside, sign, a in ((0, 1, 1, long_mm[0]), (-1, -2, -1, long_mm[-1])):
        if clamped[end]:
            left[end, end], left[end, beside] = 2 * a, a
            at = 0 if end == 0 else count - 1
            right[end, at], right[end, at + sign] = -6 / a, 6 / a
            right[end, count if end == 0 else count + 1] = -6 * sign
        elif count > 2 or clamped[-1 - end]:
            left[end, end], left[end, beside] = 1.0, -1.0
        else:
            left[end, end] = 1.0
    bends = np.linalg.solve(left, right)
    # 2. the cubic between two weights
    piece = np.clip(np.searchsorted(weights_mm, places_mm, side="right") - 1, 0, count - 2)
    each_mm, row = long_mm[piece], np.arange(len(places_mm))
    before = (weights_mm[piece + 1] - places_mm) / each_mm
    after = 1 - before
    share = np.zeros((len(places_mm), count + 2))
    share[row, piece] += before
    share[row, piece + 1] += after
    for part, bend in ((before, bends[piece]), (after, bends[piece + 1])):
        share += ((part**3 - part) * each_mm**2 / 6)[:, None] * bend
    return share


def wrong_along(ink: SeenInk, way: Array, sharp: NDArray[np.bool_]) -> Array:
    """What a pen along a way (m, 2) mm, with some corners, draws too dark at places of an ink, (n,)."""
    return wrong_and_where(ink, way, sharp)[0]


def wrong_and_where(
    ink: SeenInk, way: Array, sharp: NDArray[np.bool_]
) -> tuple[Array, NDArray[np.int64]]:
    """The same, and the number of the place of the way that each is nearest to."""
    out, near = np.empty(len(ink.places_mm)), np.empty((len(ink.places_mm), 3))
    moved_way.wrong(ink.for_kernel(), np.ascontiguousarray(way), sharp, near, out)
    return out, np.round(near[:, 1] + near[:, 2]).astype(int)
