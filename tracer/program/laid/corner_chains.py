"""Chains of corners: teeth with sides of a few widths, of which none is a leg that tells a corner.

    ──╮ ╭──╮ ╭──      the head rounds some of the corners, and leans on the sides between: each is a little
      ╰─╯  ╰─╯        off, and none has clean legs by which it could be laid

The corners of such a chain are laid by the ink, one after the other: a folding rule over a corner and both
its neighbours, from the middle of the side before these to the middle of that behind. The corner between
counts, sharp or rounded. All of it twice: at first the neighbours are where the head took them. Where the
corners explain the ink, and the way does not, the head runs along them from memory.

Signals: the sheet and lines in; the lines with their chains laid out.

Source: our own (see `folding_rule`). Questions: a chain with a bent side is explained by no rule.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.plane import CORNER_RAD
from morfax.motion.polyline import nearest_mm
from morfax.tracer.effort import ROUNDS
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.own_ink import NEARLY, OwnInk
from morfax.tracer.program.laid.bay_run import Bay
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import LEGS, is_whole
from morfax.tracer.program.laid.spline_fit import FOLDED_RAD
from morfax.tracer.program.laid.way_ink import BayInk, Relaid, WayInk
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import folding_rule
from morfax.tracer.tangles.folding_rule import ROUNDING, Rule, turned_rad
from morfax.tracer.tangles.seen_ink import GAIN

# In widths of the line, by trial on racks, saws and ratchets drawn with known truth:
SIDE = 5.0  # of a longer side both corners have legs of their own
OVER = 0.4  # on either side of a place, by how much the way turns there
NEAR = 2.0  # from a corner of a chain to a place that runs beside its ink
OFF = 0.4  # that a corner lies off the way, at the most: the head cuts none by more
SWEEPS = 2
NONE = np.empty((0, 2))
LEG = round(LEGS[0] / STEP_WIDTHS)


class _Corner(NamedTuple):
    """A corner: the number of the place of the way at which it is, and of those on its sides that it reaches
    to; where it is, mm, by which radius it is rounded, and whether the way leaves ink about it.
    """

    first: int
    at: int
    last: int
    place_mm: Array
    radius_mm: float = 0.0
    is_asked: bool = False


def with_chains(setup: Setup, own: OwnInk, laid_mm: Array = NONE) -> OwnInk:
    """Lines, held against their ink, with their chains of corners laid where they run beside it, and where
    they were laid anew (n, 2) mm: there the corners are near to where they belong.
    """
    asked, news = own.doubtful | bool(len(laid_mm)), None
    for _ in range(ROUNDS):
        beside = [place.place_mm for place in own.beside(NEARLY)]
        left_mm = np.vstack([laid_mm, np.array(beside).reshape(-1, 2)])
        if not len(left_mm):
            break
        every = BoxedLines.of(own.lines)
        mended = [
            _Chains(setup, line, every, left_mm, news).mended()
            if is_asked
            else Relaid(line, NONE)
            for line, is_asked in zip(own.lines, asked, strict=True)
        ]
        asked = np.array([len(relaid.places_mm) > 0 for relaid in mended])
        if not asked.any():
            break
        own, laid_mm = own.mended([relaid.line for relaid in mended]), NONE
        news = _News(np.vstack([relaid.places_mm for relaid in mended]), left_mm)
    return own


class _News(NamedTuple):
    """The places (n, 2) mm that were laid anew when lines were last looked at, and those that ran beside
    their ink before that.
    """

    laid_mm: Array
    left_mm: Array


@dataclass(frozen=True, eq=False)
class _Chains(WayInk):
    """The chains of corners of one of some lines, of which some places (n, 2) mm run beside their ink; what
    is new since it was last looked at, None if it was not.
    """

    left_mm: Array
    news: _News | None

    def mended(self) -> Relaid:
        """The line as it is, or along the corners that explain its ink better."""
        if not is_whole(self.line) or self.line.as_told:
            return Relaid(self.line, NONE)
        return self.along([b for chain in self._chains() for b in self._bays(chain)])

    def _chains(self) -> Iterator[list[_Corner]]:
        """The chains of corners of which each is near to the next, in the order of the way."""
        count, at = len(self.way), np.sort(self.corners_at(OVER, CORNER_RAD))
        if len(at) < 2:
            return
        far = round(2 * SIDE / STEP_WIDTHS)
        before, after = at[0] - far, at[-1] + far
        if self.is_closed:  # from the longest side on
            begin = int(np.argmax(np.diff(at, prepend=at[-1] - count)))
            at = np.r_[at[begin:], at[:begin] + count]
            before, after = at[-1] - count, at[0] + count
        sides = np.diff(at, prepend=before, append=after)
        is_near = sides < SIDE / STEP_WIDTHS
        reach = np.where(is_near, (sides - 1) // 2, LEG)
        places = self.way[at % count]
        corners = list(map(_Corner, at - reach[:-1], at, at + reach[1:], places))
        ends = [0, *(1 + np.flatnonzero(~is_near[1:-1])).tolist(), len(at)]
        for first, last in pairwise(ends):
            if last - first > 1 and self._is_beside(places[first:last], self.left_mm):
                yield corners[first:last]

    def _is_beside(self, corners_mm: Array, left_mm: Array) -> bool:
        """Whether some corners (n, 2) mm are near to where a way runs beside its ink."""
        return bool(nearest_mm(corners_mm, left_mm).min() < NEAR * self.line.width_mm)

    @cached_property
    def _are_new(self) -> NDArray[np.bool_]:
        """Which places of the way are new."""
        return self.are_near(None if self.news is None else self.news.laid_mm)

    @cached_property
    def _inks(self) -> dict[tuple[int, int], BayInk | None]:
        """The ink about stretches that was looked at, by their first and last place."""
        return {}

    def _seen(self, run: Sequence[_Corner]) -> BayInk | None:
        """The stretch along some corners of a chain, and the ink about it; None if that goes on."""
        first, last = run[0].first, run[-1].last
        if (first, last) not in self._inks:
            self._inks[first, last] = self.about(first, last, np.empty((0, 2)))
        return self._inks[first, last]

    def _bays(self, chain: list[_Corner]) -> Iterator[Bay]:
        """What is laid along those runs of a chain's corners that explain the ink, and the way does not."""
        chain = [
            corner._replace(is_asked=self._is_asked(_about(chain, k)))
            for k, corner in enumerate(chain)
        ]
        for sweep in range(SWEEPS):
            for k in range(len(chain)):
                chain[k] = self._settled(chain, k, is_first=sweep == 0)
            for k in range(len(chain) - 2, 0, -1):
                turned = turned_rad(*(corner.place_mm for corner in chain[k - 1 : k + 2]))
                if chain[k].is_asked and not CORNER_RAD < turned < FOLDED_RAD:
                    _leave_out(chain, k)
        gains = [self._gain(chain, k) for k in range(len(chain))]
        for is_right, run in groupby(range(len(chain)), lambda k: gains[k] > -GAIN):
            numbers = list(run)
            gain = max(gains[k] for k in numbers)
            if is_right and gain > GAIN:
                yield self._bay([chain[k] for k in numbers], gain)

    def _is_asked(self, near: Sequence[_Corner]) -> bool:
        """Whether something about a corner is new, and the way leaves as much ink there as another would have
        to gain.
        """
        seen = self._seen(near) if self._is_new(near) else None
        if seen is None:
            return False
        return seen.ink.misfit_along(seen.own) > GAIN * STEP_WIDTHS * len(seen.own)

    def _is_new(self, near: Sequence[_Corner]) -> bool:
        """Whether a corner was not looked at, or something near to it and its neighbours was laid anew since,
        or runs beside its ink that did not before: it is settled as it was otherwise.
        """
        if self.news is None:
            return True
        stretch = np.arange(near[0].first, near[-1].last + 1) % len(self.way)
        places_mm = np.array([corner.place_mm for corner in near])
        is_beside = self._is_beside(places_mm, self.left_mm)
        was_beside = self._is_beside(places_mm, self.news.left_mm)
        return bool(self._are_new[stretch].any()) or (is_beside and not was_beside)

    def _settled(self, chain: Sequence[_Corner], k: int, is_first: bool) -> _Corner:
        """A corner of a chain where the rule over it and its neighbours explains the ink best; as it is, if
        that lies off the way. At first the way tells where the sides' middles are.
        """
        near, at, corner = _about(chain, k), min(k, 1), chain[k]
        seen = self._seen(near) if corner.is_asked else None
        if seen is None:
            return corner
        ends_mm = seen.own[0], seen.own[-1]
        if not is_first:
            ends_mm = _ends_mm(chain, k, ends_mm)
        rules = _rules(near, at, ends_mm, seen.ink.half_mm)
        rule = folding_rule.explained(seen.ink, rules, of_bay=False)
        if rule is None:
            return corner
        place_mm = rule.corners_mm[at]
        if nearest_mm(place_mm[None], seen.own)[0] > OFF * self.line.width_mm:
            return corner
        radius_mm = rule.radius_mm if rule.rounded[at] else 0.0
        return corner._replace(place_mm=place_mm, radius_mm=radius_mm)

    def _gain(self, chain: Sequence[_Corner], k: int) -> float:
        """How much less ink a chain leaves about a corner than the way does, for each width of its length; if
        it is not asked, it is not laid.
        """
        near = _about(chain, k)
        seen = self._seen(near) if chain[k].is_asked else None
        if seen is None:
            return -math.inf
        way = _along(near, _ends_mm(chain, k, (seen.own[0], seen.own[-1])), seen.ink.half_mm)
        gain = seen.ink.misfit_along(seen.own) - seen.ink.misfit_along(way.way)
        return gain * self.line.width_mm / way.length_mm

    def _bay(self, run: Sequence[_Corner], gain: float) -> Bay:
        """What is laid along some corners of a chain."""
        first, last = run[0].first, run[-1].last
        ends_mm = self.way[first % len(self.way)], self.way[last % len(self.way)]
        way = _along(run, ends_mm, 0.5 * self.line.width_mm)
        return self.as_bay(first, last, way, gain)


def _about(chain: Sequence[_Corner], k: int) -> Sequence[_Corner]:
    """A corner of a chain and its neighbours."""
    return chain[max(k - 1, 0) : k + 2]


def _ends_mm(
    chain: Sequence[_Corner], k: int, ends_mm: tuple[Array, Array]
) -> tuple[Array, Array]:
    """The middles of the sides before and after a corner with its neighbours; at an end of the chain that of
    the way.
    """
    first_mm, last_mm = ends_mm
    if k > 1:
        first_mm = _middle_mm(*chain[k - 2 : k])
    if k < len(chain) - 2:
        last_mm = _middle_mm(*chain[k + 1 : k + 3])
    return first_mm, last_mm


def _middle_mm(one: _Corner, other: _Corner) -> Array:
    """The middle of the side between two corners."""
    return np.asarray(0.5 * (one.place_mm + other.place_mm))


def _leave_out(chain: list[_Corner], k: int) -> None:
    """Leave a corner between two others out: these reach to where it was."""
    at = chain.pop(k).at
    chain[k - 1 : k + 1] = chain[k - 1]._replace(last=at), chain[k]._replace(first=at)


def _rules(
    near: Sequence[_Corner], at: int, ends_mm: tuple[Array, Array], half_mm: float
) -> Iterator[Rule]:
    """The rules over a corner and those near to it, from end to end: sharp there, and rounded."""
    corners_mm = np.array([corner.place_mm for corner in near])
    for is_rounded in (False, True):
        rounded = np.array([corner.radius_mm > 0 for corner in near])
        rounded[at] = is_rounded
        radius_mm = ROUNDING * half_mm if rounded.any() else 0.0
        yield Rule(*ends_mm, corners_mm, rounded, radius_mm, half_mm)


def _along(run: Sequence[_Corner], ends_mm: tuple[Array, Array], half_mm: float) -> LaidWay:
    """The way over some corners, from end to end."""
    first_mm, last_mm = ends_mm
    middles = [first_mm, *(_middle_mm(*side) for side in pairwise(run)), last_mm]
    stretches = [first_mm[None]]
    for corner, (before_mm, after_mm) in zip(run, pairwise(middles), strict=True):
        rounded, radius_mm = np.array([corner.radius_mm > 0]), corner.radius_mm
        rule = Rule(before_mm, after_mm, corner.place_mm[None], rounded, radius_mm, half_mm)
        come, *gone = rule.stretches()
        stretches[-1] = np.vstack([stretches[-1], come])
        stretches += gone
    return LaidWay(tuple(stretches), half_mm)
