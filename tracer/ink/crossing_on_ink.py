"""Crossings on their ink: where the ways that legs tell leave a crossing's ink, others are held against it.

    ────────┬────       the corner of one line lies in the ink of another: its legs meet beside the place
       ╱    │           where all lines meet, and how they go on is told by the ink that a pen would leave

A pen along all ways through a crossing, along its legs and the ends of lines without a partner is held
against the ink there. Where it leaves ink for a third of a line's width, or draws as much on paper, other
pairs are tried, the likeliest first, with a corner wherever two legs meet in ink; corners move to where the
pen leaves least. What explains the ink goes before what the legs tell. Not where lines are of several widths,
as those of letters are, nor on scans whose pixels were made finer, or of pencil: their ink shows no pen, and
blots and arrowheads were run to and fro.

Signals: a crossing in; its pairs, and the corners between them, out.

Four legs of one pen that turn are redrawn over as many vertices as it takes instead, if that explains their
ink (see `redrawn_crossing`).

Source: our own; the pen and how corners move are those of `tangles`, whose lines have no legs of their own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import evenly
from morfax.tracer.effort import LOOKED_MM
from morfax.tracer.head.course import on_ink
from morfax.tracer.ink.partners import MOST_LEGS, SMOOTHLY, Pair, likeliest, turnings
from morfax.tracer.junctions.corner import Corner
from morfax.tracer.tangles import pen, settling
from morfax.tracer.tangles.redrawing import VERTEX
from morfax.tracer.tangles.sketch import ALL, softness_of
from morfax.tracer.tangles.tangle import DARKEST

if TYPE_CHECKING:
    from morfax.tracer.ink.crossing import Crossing

# All limits below were chosen by trial on crowded sheets of lines, circles and rectangles.
OFF = 0.08  # widths², in a box as wide as a line: of crossings that are right to 0.1 mm none comes above
MUCH = 0.3  # widths²: so much less is left by what explains not all of the ink, and is better all the same
REACH = 1.2  # widths from ways and felt ink: so far ink is the crossing's
TRIED = 5  # pairings
ENDED = 20  # places of the end of a line
PLAIN = math.radians(6)  # lines that turn by less, all of which go on, are plain


class WaysOn(NamedTuple):
    """How lines go on through a crossing: pairs of legs, and of some the corners (n, 2) mm between them."""

    pairs: tuple[Pair, ...]
    corners: Mapping[Pair, Array]


@dataclass(frozen=True)
class AsDrawn:
    """A crossing as it would be drawn: what its pen leaves, and draws on paper, of the ink about it."""

    crossing: Crossing
    ink: _Ink

    @cached_property
    def ways(self) -> list[Array]:
        """The ways through it, and the ends of lines without a partner, (n, 2) mm."""
        return [*self.crossing.ways_mm, *_ended_mm(self.crossing)]

    @cached_property
    def _wrong(self) -> Array:
        return self.ink.wrong(self.ways)

    @property
    def off(self) -> float:
        """By how much it is off the ink in the worst box as wide as a line, widths²."""
        return self.ink.worst(self._wrong)

    @property
    def cost(self) -> float:
        """What is wrong in all, and the price of its corners, widths²."""
        corners = sum(map(len, self.crossing.solution.corners.values()))
        return self.ink.left(self._wrong) + VERTEX * corners


def told_by_ink(crossing: Crossing, told: WaysOn) -> WaysOn:
    """How lines go on through a crossing: as the legs tell, or otherwise, if that explains the ink."""
    if not 3 <= len(crossing.legs) <= MOST_LEGS or _is_plain(crossing, told):
        return told
    view = crossing.views[0]
    if view.parted > 1 or view.grainy or not crossing.is_of_one_pen:
        return told  # no pen is told by such ink
    by_legs = crossing.as_drawn(told)
    ink = _Ink.about(crossing, by_legs.ways_mm)
    now = AsDrawn(by_legs, ink)
    if ink.is_empty or now.off < OFF:
        return told
    tried = [AsDrawn(crossing.as_drawn(drawn), ink) for drawn in _others(crossing, told, ink)]
    best = min(tried, key=lambda each: each.cost, default=now)
    gain = 0.0 if best.off < OFF else MUCH
    if best.off < now.off and best.cost < now.cost - gain:
        return best.crossing.solution
    return told


def is_one_with_a_tip(crossing: Crossing, pair: Pair) -> bool:
    """Whether two legs that come in side by side explain their ink as one line with a corner, and not as two
    that end there.
    """
    ends = crossing.as_drawn(WaysOn((), {}))
    one = crossing.as_drawn(WaysOn((pair,), {}))
    ink = _Ink.about(crossing, one.ways_mm)
    if ink.is_empty or AsDrawn(ends, ink).off < OFF:
        return False
    cornered = _cornered(crossing, (pair,), ink)
    return cornered is not None and AsDrawn(crossing.as_drawn(cornered), ink).off < OFF


def is_explained(crossing: Crossing) -> bool:
    """Whether a pen along the ways of a crossing leaves its ink."""
    ink = _Ink.about(crossing, crossing.ways_mm)
    return ink.is_empty or AsDrawn(crossing, ink).off < OFF


def _is_plain(crossing: Crossing, told: WaysOn) -> bool:
    """Whether all lines of a crossing go straight on."""
    costs = crossing.turnings_rad
    return 2 * len(told.pairs) == len(crossing.legs) and all(
        costs[pair] < PLAIN for pair in told.pairs
    )


def _others(crossing: Crossing, told: WaysOn, ink: _Ink) -> Iterator[WaysOn]:
    """Other ways to go on, with their corners where these explain the ink best."""
    legs, view = crossing.legs, crossing.views[0]
    costs = turnings(legs, crossing.width_mm, view)
    for pairs in dict.fromkeys([told.pairs, *likeliest(costs, TRIED)]):
        if (drawn := _cornered(crossing, pairs, ink)) is not None:
            yield drawn


def _cornered(crossing: Crossing, pairs: tuple[Pair, ...], ink: _Ink) -> WaysOn | None:
    """Ways to go on with a corner wherever two legs turn, where it explains the ink best; None if it leads
    over paper.
    """
    legs, corners = crossing.legs, dict[Pair, Array]()
    for a, b in pairs:
        corner = Corner.of(legs[a], legs[b].turned_round())
        if corner is not None and corner.deflection_rad > SMOOTHLY:
            corners[a, b] = corner.vertex_mm[None]
    drawn = WaysOn(pairs, corners)
    if not corners:
        return drawn
    drawn = ink.settled(crossing, drawn)
    some = crossing.as_drawn(drawn)
    ways = [way for pair, way in zip(pairs, some.ways_mm, strict=True) if pair in corners]
    return drawn if all(on_ink(crossing.views[0], [way]) for way in ways) else None


def _ended_mm(crossing: Crossing) -> list[Array]:
    """Places of the lines that end in a crossing, from their clean ends on, (n, 2) mm."""
    paired = {leg for pair in crossing.pairs for leg in pair}
    alone = [k for k in range(len(crossing.legs)) if k not in paired]
    return [crossing.legs[k].at(np.linspace(0.0, crossing.end_mm(k), ENDED)) for k in alone]


@dataclass(frozen=True)
class _Ink:
    """The ink of a crossing: its pixels in a window, with how far each is from the crossing's legs."""

    ink: pen.Ink
    pixels: tuple[NDArray[np.int64], NDArray[np.int64]]
    shape: tuple[int, int]
    pitch_mm: float

    @classmethod
    def about(cls, crossing: Crossing, ways: list[Array]) -> _Ink:
        """The ink about the ways through a crossing, and what was felt within it."""
        view, width_mm = crossing.views[0], crossing.width_mm
        felt = [inner.run.places_mm for inner in crossing.inked]
        ends = np.array([leg.end_mm for leg in crossing.legs])
        about = np.vstack([ends, *ways, *felt])
        # 1. pixels of a window that are near
        reach_mm = REACH * width_mm
        seen, _, grid = view.seen_about(about, reach_mm)
        places, away_mm = grid.reshape(-1, 2), np.full(seen.size, pen.NOWHERE_MM)
        for way in (*ways, *felt):
            away_mm = np.minimum(away_mm, pen.away_from(places, _thinned(way)))
        near = np.flatnonzero(away_mm < reach_mm)
        # 2. their ink, and how far the legs are
        dark = np.minimum(seen.ravel()[near] / (2 * view.level), DARKEST).astype(float)
        known_mm = np.full(len(near), pen.NOWHERE_MM)
        low_mm, high_mm = about.min(axis=0) - reach_mm, about.max(axis=0) + reach_mm
        for leg in crossing.near:
            if len(leg) > 1:
                within = np.all((leg > low_mm) & (leg < high_mm), axis=1)
                if within.sum() > 1:
                    known_mm = np.minimum(known_mm, pen.away_from(places[near], leg[within]))
        softness_mm = softness_of(view, crossing.legs[0])
        ink = pen.Ink(places[near], dark, known_mm, 0.5 * width_mm, softness_mm)
        rows, columns = np.unravel_index(near, seen.shape)
        return cls(ink, (rows, columns), seen.shape, view.pitch_mm)

    @property
    def is_empty(self) -> bool:
        """Whether no pixel is near."""
        return not len(self.ink.darkness)

    def known_with(self, ways: list[Array]) -> Array:
        """How far each pixel is from the legs and some ways, mm."""
        known_mm = self.ink.known_mm
        for way in ways:
            if len(way) > 1:
                known_mm = np.minimum(
                    known_mm, pen.away_from(self.ink.places_mm, _thinned(way))
                )
        return known_mm

    def wrong(self, ways: list[Array]) -> Array:
        """What a pen along the legs and some ways draws too dark at each pixel."""
        drawn = np.empty(len(self.ink.darkness))
        pen.ink(self.known_with(ways), self.ink.half_mm, self.ink.softness_mm, drawn)
        return np.asarray(drawn - self.ink.darkness)

    def left(self, wrong: Array) -> float:
        """The sum of the squares of what is wrong, widths²."""
        return float(np.sum(wrong**2)) * (self.pitch_mm / (2 * self.ink.half_mm)) ** 2

    def worst(self, wrong: Array) -> float:
        """The same of ink that is left, or drawn on paper, in the worst box as wide as a line."""
        side, most = 2 * round(self.ink.half_mm / self.pitch_mm) + 1, 0.0
        for signed in (wrong, -wrong):
            squares = np.zeros(self.shape)
            squares[self.pixels] = np.maximum(signed, 0.0) ** 2
            sums = cv2.boxFilter(squares, -1, (side, side), normalize=False)
            most = max(most, float(sums.max()))
        return most * (self.pitch_mm / (2 * self.ink.half_mm)) ** 2

    def settled(self, crossing: Crossing, drawn: WaysOn) -> WaysOn:
        """The same pairs with their corners moved to where they explain the ink best."""
        some = crossing.as_drawn(drawn)
        smooth = [some.way(pair) for pair in drawn.pairs if pair not in drawn.corners]
        known_mm = self.known_with([*smooth, *_ended_mm(some)])
        poses = np.array([(*leg.end_mm, leg.heading_rad) for leg in crossing.legs])
        ends = poses[np.array(list(drawn.corners), np.int64)]
        counts = np.array([len(some) for some in drawn.corners.values()], np.int64)
        vertices = np.vstack(list(drawn.corners.values()))
        ink, cells = self.ink._replace(known_mm=known_mm), crossing.views[0].cells
        settling.weighed(ink, cells, pen.Drawn(ends, counts, 0), vertices, ALL)
        parts = np.split(vertices, np.cumsum(counts)[:-1])
        return drawn._replace(corners=dict(zip(drawn.corners, parts, strict=True)))


def _thinned(way: Array) -> Array:
    """A way (n, 2) mm by places so far apart that its ink tells no difference."""
    if len(way) < 3:
        return way
    return np.vstack([evenly(way, LOOKED_MM), way[-1]])
