"""The ink of a crossing: its pixels in a window, and what a pen along some ways would leave of them.

Signals: a crossing, and ways (n, 2) mm through it, in; by how much they are off the ink, widths², and corners
moved to where they explain it best, out.

Source: our own; the pen and how corners move are those of `tangles`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import evenly
from morfax.tracer.effort import LOOKED_MM
from morfax.tracer.ink.partners import Pair, without_partner
from morfax.tracer.tangles import distances, pen, settling
from morfax.tracer.tangles.sketch import ALL, softness_of
from morfax.tracer.tangles.tangle import DARKEST

if TYPE_CHECKING:
    from morfax.tracer.ink.crossing import Crossing

# by trial on crowded sheets of lines, circles and rectangles
REACH = 1.2  # widths from ways and felt ink: so far ink is the crossing's
ENDED = 20  # places of the end of a line


class WaysOn(NamedTuple):
    """How lines go on through a crossing: pairs of legs, and of some the corners (n, 2) mm between them."""

    pairs: tuple[Pair, ...]
    corners: Mapping[Pair, Array]


class Boxes(NamedTuple):
    """Rows and columns of some pixels in a window, the shape of that, and from pixel to pixel, mm."""

    pixels: tuple[NDArray[np.int64], NDArray[np.int64]]
    shape: tuple[int, int]
    pitch_mm: float

    def worst(self, wrong: Array, width_mm: float) -> float:
        """The sum of the squares of what is wrong (n,), too dark or too pale, in the worst box as wide as a
        line, in squares of that width.
        """
        return float(self.sums(wrong, width_mm).max()) * (self.pitch_mm / width_mm) ** 2

    def sums(self, wrong: Array, width_mm: float) -> Array:
        """The larger of both sums in a box about each pixel of the window."""
        side, most = 2 * round(0.5 * width_mm / self.pitch_mm) + 1, np.zeros(self.shape)
        for signed in (wrong, -wrong):
            squares = np.zeros(self.shape)
            squares[self.pixels] = np.maximum(signed, 0.0) ** 2
            sums = cv2.boxFilter(squares, -1, (side, side), normalize=False)
            most = np.maximum(most, sums)
        return most


@dataclass(frozen=True)
class CrossingInk:
    """The ink of a crossing: its pixels in a window, with how far each is from the crossing's legs."""

    ink: pen.Ink
    pixels: tuple[NDArray[np.int64], NDArray[np.int64]]
    shape: tuple[int, int]
    pitch_mm: float

    @classmethod
    def about(cls, crossing: Crossing, ways: list[Array]) -> CrossingInk:
        """The ink about the ways through a crossing, and what was felt within it."""
        view, width_mm = crossing.views[0], crossing.width_mm
        felt = [inner.run.places_mm for inner in crossing.inked]
        ends = np.array([leg.end_mm for leg in crossing.legs])
        about = np.vstack([ends, *ways, *felt])
        # 1. pixels of a window that are near
        reach_mm = REACH * width_mm
        seen, _, grid = view.seen_about(about, reach_mm)
        places, away_mm = grid.reshape(-1, 2), np.full(seen.size, distances.NOWHERE_MM)
        for way in (*ways, *felt):
            away_mm = np.minimum(away_mm, distances.away_from(places, _thinned(way)))
        near = np.flatnonzero(away_mm < reach_mm)
        # 2. their ink, and how far the legs are
        dark = np.minimum(seen.ravel()[near] / (2 * view.level), DARKEST).astype(float)
        known_mm = np.full(len(near), distances.NOWHERE_MM)
        low_mm, high_mm = about.min(axis=0) - reach_mm, about.max(axis=0) + reach_mm
        for leg in crossing.near:
            if len(leg) > 1:
                within = np.all((leg > low_mm) & (leg < high_mm), axis=1)
                if within.sum() > 1:
                    known_mm = np.minimum(
                        known_mm, distances.away_from(places[near], leg[within])
                    )
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
                    known_mm, distances.away_from(self.ink.places_mm, _thinned(way))
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
        return self._boxes.worst(wrong, 2 * self.ink.half_mm)

    def worst_at_mm(self, wrong: Array) -> Array:
        """The place, (x, y) mm, at the middle of that box, or the nearest that is looked at."""
        sums = self._boxes.sums(wrong, 2 * self.ink.half_mm)
        return self.ink.places_mm[int(np.argmax(sums[self.pixels]))]

    @property
    def _boxes(self) -> Boxes:
        return Boxes(self.pixels, self.shape, self.pitch_mm)

    def settled(self, crossing: Crossing, drawn: WaysOn) -> WaysOn:
        """The same pairs with their corners moved to where they explain the ink best."""
        some = crossing.as_drawn(drawn)
        smooth = [some.way(pair) for pair in drawn.pairs if pair not in drawn.corners]
        known_mm = self.known_with([*smooth, *ended_mm(some)])
        poses = np.array([(*leg.end_mm, leg.heading_rad) for leg in crossing.legs])
        ends = poses[np.array(list(drawn.corners), np.int64)]
        counts = np.array([len(some) for some in drawn.corners.values()], np.int64)
        vertices = np.vstack(list(drawn.corners.values()))
        ink, cells = self.ink._replace(known_mm=known_mm), crossing.views[0].cells
        settling.weighed(ink, cells, pen.Drawn(ends, counts, 0), vertices, ALL)
        parts = np.split(vertices, np.cumsum(counts)[:-1])
        return drawn._replace(corners=dict(zip(drawn.corners, parts, strict=True)))


def ended_mm(crossing: Crossing) -> list[Array]:
    """Places of the lines that end in a crossing, from their clean ends on, (n, 2) mm."""
    alone = without_partner(crossing.pairs, len(crossing.legs))
    return [crossing.legs[k].at(np.linspace(0.0, crossing.end_mm(k), ENDED)) for k in alone]


def _thinned(way: Array) -> Array:
    """A way (n, 2) mm by places so far apart that its ink tells no difference."""
    if len(way) < 3:
        return way
    return np.vstack([evenly(way, LOOKED_MM), way[-1]])
