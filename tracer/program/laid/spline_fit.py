"""The spline that explains the ink about a stretch of way, with as few corners and weights as will do.

Its corners are those of the stretch. Where it leaves ink about a place unexplained, a corner more or fewer is
tried, then weights nearer to one another. A stretch that crosses itself may have gone round a loop the wrong
way: it is tried the other way round, too.

Signals: a stretch of way and the ink about it in; the spline out.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.crossings import crossings_of
from morfax.tracer.effort import ROUNDS
from morfax.tracer.program.against_ink.off_ink import wrong_about
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles.seen_ink import SeenInk
from morfax.tracer.tangles.spline import PLACES_WIDTHS, Strip, Weights, wrong_along

# In widths of the line, chosen by trial on parts with reliefs and on racks of teeth, drawn with known truth:
EVERY = 0.75, 0.45  # between weights: the second where the first explains too little
CORNERS_APART = 0.4
TURNS_OVER = 0.25  # on either side of a place, by how much the way turns there
# of that: more is a corner; less may be one
CORNER_RAD, MAYBE_RAD = math.radians(30), math.radians(12)
FOLDED_RAD = math.radians(165)  # a corner that turns by more is no tip, but a way out and back
# a spline that turns by so much more than the stretch swings from rim to rim of ink that is broader than its
# pen: those of a felt pen's lines turned by 820 to 1950 degrees more, right ones by up to 150
SWINGS_RAD = math.tau
MOST_CORNERS = 5  # are tried at a time
PRICE = 0.001  # of a figure more, as misfit


class Spline(NamedTuple):
    """A spline along a stretch: its way (m, 2) mm and at which of its places (m,) it is broken, the corners
    of the stretch that these are; what it leaves unexplained, in all and about the worst place.
    """

    way: Array
    sharp: NDArray[np.bool_]
    corners: tuple[int, ...]
    figures: int
    misfit: float
    worst: float

    @property
    def cost(self) -> float:
        """What it leaves, and the price of the figures."""
        return self.misfit + PRICE * self.figures

    def stretches(self) -> tuple[Array, ...]:
        """Its way as stretches between corners."""
        ends = pairwise([0, *np.flatnonzero(self.sharp).tolist(), len(self.way) - 1])
        return tuple(self.way[first : last + 1] for first, last in ends)


def explained(ink: SeenInk, own: Array, step_mm: float, limit: float) -> Spline | None:
    """The spline along a stretch (n, 2) mm of places a step apart that explains the ink best; what it leaves
    about a place below a limit is noise. None if the stretch goes out and back, as along a tick, or if every
    spline swings in its ink.
    """
    if turns_rad(own).max() > FOLDED_RAD:
        return None
    starts = [own]
    crossings = crossings_of(own, np.arange(len(own) - 1))
    if len(crossings):
        first, last = np.sort(crossings[0]).astype(int).tolist()
        turned = own[first + 1 : last + 1][::-1]
        starts.append(np.vstack([own[: first + 1], turned, own[last + 1 :]]))
    crosses = len(starts) > 1
    fits = [_Fit(ink, start, step_mm, limit, crosses).best() for start in starts]
    best = min(fits, key=lambda spline: spline.cost)
    return best if math.isfinite(best.cost) else None


def left_by(ink: SeenInk, way: Array, sharp: NDArray[np.bool_]) -> float:
    """How much a pen along a way (n, 2) mm with some corners leaves, in squares of the line's width."""
    return ink.left(wrong_along(ink, way, sharp))


def about_corners(way: Array) -> NDArray[np.bool_]:
    """Which places (n,) of a way, a step apart, are at one of its corners, or next to it."""
    sharp = np.zeros(len(way), bool)
    for at in corners_of(turns_rad(way)):
        sharp[max(at - 1, 0) : at + 2] = True
    return sharp


def turns_rad(way: Array, over_widths: float = TURNS_OVER) -> Array:
    """By how much a way turns about each of its places (n, 2), which are a step apart."""
    over, count = round(over_widths / STEP_WIDTHS), len(way)
    at = np.arange(count)
    before = way - way[np.maximum(at - over, 0)]
    after = way[np.minimum(at + over, count - 1)] - way
    turned = _turned_rad(before, after)
    turned[[0, -1]] = 0.0
    return turned


def _turned_rad(before: Array, after: Array) -> Array:
    """By how much each of some steps (n, 2) turns to those after them, (n,)."""
    turned = np.arctan2(after[:, 1], after[:, 0]) - np.arctan2(before[:, 1], before[:, 0])
    return np.asarray(np.abs(turned - math.tau * np.round(turned / math.tau)))


def _turned_in_all_rad(way: Array) -> float:
    """By how much a way (n, 2) turns, to either side, all along."""
    steps = np.diff(way, axis=0)
    return float(_turned_rad(steps[:-1], steps[1:]).sum())


def corners_of(
    turned_rad: Array, over_widths: float = TURNS_OVER, least_rad: float = CORNER_RAD
) -> list[int]:
    """The places at which a way turns sharply, each the sharpest of those about it."""
    apart, found = round(over_widths / STEP_WIDTHS), list[int]()
    sharpest, is_near = np.argsort(-turned_rad), np.zeros(len(turned_rad), bool)
    for at in sharpest[: np.count_nonzero(turned_rad >= least_rad)].tolist():
        if not is_near[at]:
            found.append(at)
            is_near[max(at - apart, 0) : at + apart + 1] = True
    return found


@dataclass(frozen=True)
class _Fit:
    """What splines along a stretch (n, 2) mm are fitted to: the ink about it, what may be left, and whether
    the head's way there crosses itself.
    """

    ink: SeenInk
    own: Array
    step_mm: float
    limit: float
    crosses: bool

    @cached_property
    def turned_rad(self) -> Array:
        """By how much the stretch turns about each place."""
        return turns_rad(self.own)

    def best(self) -> Spline:
        """The spline that costs least of those with the stretch's corners, or some more or fewer."""
        corners, last = corners_of(self.turned_rad), len(self.own) - 1
        best = self._settled(tuple(sorted(at for at in corners if 0 < at < last)), EVERY[0])
        for _ in range(ROUNDS):
            if best.worst < self.limit:
                return best
            tried = [self._settled(more, EVERY[0]) for more in self._changed(best.corners)]
            likest = min(tried, key=lambda spline: spline.cost, default=best)
            if likest.cost >= best.cost - PRICE:
                break
            best = likest
        closer = self._settled(best.corners, EVERY[1])
        return min(best, closer, key=lambda spline: spline.cost)

    def _folds(self, way: Array, at: NDArray[np.int64]) -> bool:
        """Whether a way (m, 2) mm crosses itself, or as the stretch does not, or turns back at a corner."""
        if not self.crosses and len(crossings_of(way, np.arange(len(way) - 1))):
            return True
        before, after = way[at] - way[at - 1], way[at + 1] - way[at]
        return bool(np.any(_turned_rad(before, after) > FOLDED_RAD))

    def _swings(self, way: Array) -> bool:
        """Whether a way (m, 2) mm turns much more than the stretch."""
        return _turned_in_all_rad(way) - _turned_in_all_rad(self.own) > SWINGS_RAD

    def _changed(self, corners: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        """Some corners with one more, where the way turns most, or one fewer."""
        apart, more = round(CORNERS_APART / STEP_WIDTHS), list[int]()
        for at in np.argsort(-self.turned_rad).tolist():
            if self.turned_rad[at] < MAYBE_RAD or len(more) == MOST_CORNERS:
                break
            is_within = apart < at < len(self.own) - 1 - apart
            if is_within and all(abs(at - other) > apart for other in (*corners, *more)):
                more.append(at)
                yield tuple(sorted((*corners, at)))
        for k in range(len(corners)):
            yield corners[:k] + corners[k + 1 :]

    def _settled(self, corners: tuple[int, ...], every_widths: float) -> Spline:
        """The spline with some corners and weights so far apart, where it explains most."""
        ink = self.ink
        weights = Weights.apart(len(self.own), corners, every_widths / STEP_WIDTHS)
        strip = Strip.along(self.own, self.step_mm, weights, PLACES_WIDTHS * ink.width_mm)
        way = strip.settled(ink)
        is_none = self._folds(way, np.flatnonzero(strip.sharp)) or self._swings(way)
        misfit = math.inf if is_none else left_by(ink, way, strip.sharp)
        worst = float(wrong_about(ink, way, strip.sharp, PLACES_WIDTHS).max())
        return Spline(way, strip.sharp, corners, strip.figures, misfit, worst)
