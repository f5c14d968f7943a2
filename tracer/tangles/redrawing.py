"""Redrawings: ways to draw a tangle, and what makes one of them dearer than another.

Every leg is the end of a strand, and each strand has two. A strand goes over vertices, where the pen turned;
a stroke belongs to no strand: a tick, or the end of another line.

Signals: numbers of legs, places in sheet mm, and the tip of ink that is left over in; redrawings out.

Source: our own (see `sketch`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.tangles import pen

Pair = tuple[int, int]

# Chosen by trial on the test drawings; VERTEX is a misfit, STROKE and DOUBLED are vertices.
VERTEX = 0.03  # what a vertex costs: a wrong stretch of 3 % of the line's width
IN_GRAIN = (
    5.0  # times as much in ink with grain: that leaves more unexplained than a vertex gains
)
CLEAR = 0.25  # a misfit up to which a redrawing explains the ink
STROKE = 2.5
DOUBLED = 4.0  # a vertex at which a strand goes back on itself: a tick
NONE = np.empty((0, 2))


@dataclass(frozen=True, slots=True)
class Redrawing:
    """A way to draw a tangle: pairs of legs, the vertices (n, 2) between each, and strokes (2, 2) besides.

    `misfit` is the ink that it leaves unexplained; `cost` adds what vertices and strokes cost.
    """

    pairs: tuple[Pair, ...]
    vertices: tuple[Array, ...]
    strokes: tuple[Array, ...] = ()
    misfit: float = math.inf
    cost: float = math.inf

    @property
    def effort(self) -> float:
        """What its vertices and strokes cost, as misfit."""
        return self.cost - self.misfit

    @property
    def partner(self) -> int | None:
        """The leg with which the incoming one, number 0, is joined."""
        return next((b for a, b in self.pairs if a == 0), None)

    @property
    def own(self) -> Array:
        """The vertices of the incoming leg's strand."""
        return next(v for (a, _), v in zip(self.pairs, self.vertices, strict=True) if a == 0)

    def with_strand(self, k: int, vertices: Array) -> Redrawing:
        """The redrawing with other vertices in one strand."""
        return replace(self, vertices=(*self.vertices[:k], vertices, *self.vertices[k + 1 :]))

    def moved(self, vertices: Array, misfit: float, cost: float) -> Redrawing:
        """The redrawing with other places for its vertices, strand after strand, and then for its strokes."""
        parts, at = list[Array](), 0
        for part in (*self.vertices, *self.strokes):
            parts.append(vertices[at : at + len(part)])
            at += len(part)
        strands = len(self.vertices)
        return Redrawing(
            self.pairs, tuple(parts[:strands]), tuple(parts[strands:]), misfit, cost
        )

    def without_own(self) -> Redrawing:
        """The redrawing without the strand of the incoming leg."""
        strands = zip(self.pairs, self.vertices, strict=True)
        others = [(pair, v) for pair, v in strands if pair[0] != 0]
        return Redrawing(
            tuple(pair for pair, _ in others), tuple(v for _, v in others), self.strokes
        )


def matchings(legs: int) -> list[tuple[Pair, ...]]:
    """Every way to join legs in pairs; of an odd number one is left over."""

    def of(rest: tuple[int, ...], spare: bool) -> list[tuple[Pair, ...]]:
        """Every way to join the rest, one of which may be left over."""
        if not rest:
            return [()]
        out = [
            ((rest[0], rest[k]), *more)
            for k in range(1, len(rest))
            for more in of(rest[1:k] + rest[k + 1 :], spare)
        ]
        return out + (of(rest[1:], False) if spare else [])

    return of(tuple(range(legs)), legs % 2 == 1)


def with_more(way: Redrawing, tip: Array, foot: Array, piece: int) -> list[Redrawing]:
    """The redrawing with ink added from a foot, which is on a piece of it, to a tip.

    First as a stroke; then the strand of that piece gets the tip as a vertex, or a spike of it.
    """
    more = [replace(way, strokes=(*way.strokes, np.array([foot, tip])))]
    for k, v in enumerate(way.vertices):
        # 1. the strand that the piece belongs to
        pieces = 2 * pen.PIECES + max(len(v) - 1, 0)
        if not 0 <= piece < pieces:
            piece -= pieces
            continue
        # 2. a vertex or a spike in the gap of the foot, and a vertex in any other
        gap = min(max(piece - pen.PIECES + 1, 0), len(v))
        spikes = [[tip], [foot, tip], [tip, foot], [foot, tip, foot]]
        elsewhere = [(at, [tip]) for at in range(len(v) + 1) if at != gap]
        for at, vertices in [*((gap, spike) for spike in spikes), *elsewhere]:
            more.append(way.with_strand(k, np.vstack([v[:at], *vertices, v[at:]])))
        break
    return more
