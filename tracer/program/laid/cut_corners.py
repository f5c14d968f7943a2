"""Cut corners: where sides of two or three widths meet, the head may round a corner, or cut it.

    ──────╮      a way that is less than half a width off is on its ink nearly everywhere: what is over
           ╲     there is far below what tells a wrong way, but far above what the paper's noise leaves
            │

There, and where the head ran out of a tangle, a folding rule of one to four corners is laid by the ink
between clean places of the way on either side, as at narrow bays (see `narrow_bays`). If it explains the ink
better, and lies as near to the way, the head runs along it from memory.

    │  ╱╱        a corner within the ink of another side: the ink shows it nowhere. Where the way leaves its
    └─╱╱──       straight legs, and the corner at which these meet explains the ink as well, it is that

A corner rounded by so little that no ink beside the way tells is that, too, where it explains the ink better.

Signals: the sheet and lines in; the lines with their corners out.

Source: our own; a draughtsman's sides are straight up to where they meet. Questions: none.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array, bounds
from morfax.motion.plane import cross, left_of, meeting
from morfax.motion.polyline import evenly, lengths_mm, nearest_mm
from morfax.tracer.effort import MANY, ROUNDS
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.own_ink import NEARLY, BesideInk, OwnInk
from morfax.tracer.program.laid.bay_run import Bay
from morfax.tracer.program.laid.corner_chains import with_chains
from morfax.tracer.program.laid.line_parts import LEGS, is_clear, is_plain
from morfax.tracer.program.laid.news import near_box
from morfax.tracer.program.laid.outer_rims import ON, with_outer_rims
from morfax.tracer.program.laid.way_ink import MOST_LEFT, BayInk, Relaid, WayInk
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.leg import STRAIGHT
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import distances, folding_rule
from morfax.tracer.tangles.folding_rule import Rule
from morfax.tracer.tangles.seen_ink import LIKE, PRICE, SURE

OFF = 0.45  # widths: a rule that lies further off the head's way runs out along a tick, or is another line
BENT = 0.05  # widths: a leg that bends by more tells no corner
HALF = 0.8  # widths from the middle of a corner to its legs: the head rounds none by more
LEFT_LEGS = 0.1  # widths: a way that leaves its legs by less is as they are


def with_corners(setup: Setup, own: OwnInk) -> OwnInk:
    """Lines, held against their ink, with the corners that were cut. Those of a drawn program are as they
    are, and those on pixels that were made finer: in their steps a corner cut by a tenth of a width is lost.
    """
    is_clear_and_fine = is_clear(own.drawing) and own.drawing.finer == 1
    if not is_clear_and_fine or setup.operator.reads_marks(own.lines):
        return own
    news: Array | None = None
    own = _with_outer_rims(setup, with_chains(setup, own), own.doubtful)
    for _ in range(ROUNDS):
        lines = own.lines
        left = [place for place in own.beside(NEARLY) if not place.is_sure]
        every = BoxedLines.of(lines)
        mended = [_Corners(setup, line, every, left, news).mended() for line in lines]
        news = np.vstack([np.empty((0, 2)), *(relaid.places_mm for relaid in mended)])
        if not len(news):
            break
        own = own.mended([relaid.line for relaid in mended])
    return own


def _with_outer_rims(setup: Setup, own: OwnInk, asked: NDArray[np.bool_]) -> OwnInk:
    """Lines, held against their ink, those asked along their outer rims, and their chains of corners laid
    from there.
    """
    own, asked, laid_mm = with_outer_rims(setup, own, asked)
    for _ in range(ROUNDS):
        if not asked.any():
            break
        own = with_chains(setup, own, laid_mm)
        own, asked, laid_mm = with_outer_rims(setup, own, asked, ON)
    return own


@dataclass(frozen=True)
class _Corners(WayInk):
    """The corners of one of some lines, which run beside their ink at some places."""

    left: Sequence[BesideInk]
    news: Array | None  # the places (n, 2) mm that were laid anew when it was last looked at

    def mended(self) -> Relaid:
        """The line as it is, or along the rules that explain what was cut."""
        if not is_plain(self.line) or self.line.as_told:
            return self.along([])
        over, is_first = list(self._beside_ink()), self.news is None
        is_new = self.are_near(self.news)
        is_asked = self._are_within(over) if is_first else is_new
        bays = [self._bay(*each, is_asked) for each in [*over, *self._redrawn()][:MANY]]
        turns = (each for each in self._rounded() if is_new[self._places(*each)].any())
        bays += [self._sharp(*each) for each in turns]
        return self.along([bay for bay in bays if bay is not None])

    def _are_within(self, stretches: Sequence[tuple[int, int]]) -> NDArray[np.bool_]:
        """Which places lie within some stretches."""
        within = np.zeros(len(self.way), bool)
        for each in stretches:
            within[self._places(*each)] = True
        return within

    def _places(self, first: int, last: int) -> NDArray[np.int64]:
        """The numbers of the places from one to another."""
        return np.arange(first, last + 1) % len(self.way)

    def _beside_ink(self) -> Iterator[tuple[int, int]]:
        """The stretches that run beside their ink: their first and last places."""
        for place in near_box(self.left, *bounds(self.way), self.step_mm):
            away_mm = np.hypot(*(self.way - place.place_mm).T)
            at = int(np.argmin(away_mm))
            if away_mm[at] < self.step_mm:  # else another line's
                yield self.stretch(at, place.length_mm)

    def _redrawn(self) -> Iterator[tuple[int, int]]:
        """The same of those along which the head ran out of a tangle: there a corner may be within the ink of
        another line.
        """
        led, places = self.line.led, self.line.xy_mm
        if REDRAWN not in led.leaders:
            return
        along = np.rint(lengths_mm(places) / self.step_mm).astype(int)
        for first, last, leader in zip(
            led.firsts, [*led.firsts[1:], len(places)], led.leaders, strict=True
        ):
            if leader == REDRAWN:
                yield int(along[first]), int(along[last - 1])

    def _rounded(self) -> Iterator[tuple[int, int]]:
        """The same of those along which the way turns off."""
        half = round(HALF / STEP_WIDTHS)
        return ((at - half, at + half) for at in _turns(self.way, half))

    def _sharp(self, first: int, last: int) -> Bay | None:
        """The corner in place of a stretch that is rounded, if it explains the ink better."""
        leg = round(LEGS[0] / STEP_WIDTHS)
        own = self.own(first - leg, last + leg)
        rule = None if own is None else self._along_legs(own, leg)
        if rule is None:
            return None
        seen = self.about(first - leg, last + leg, np.empty((0, 2)))
        found = None if seen is None else self._by_legs(seen, rule)
        if seen is None or found is None or found[1] <= PRICE:
            return None
        return self.as_bay(seen.first, seen.last, *found)

    def _bay(self, first: int, last: int, is_asked: NDArray[np.bool_]) -> Bay | None:
        """The rule in place of a stretch, if it explains the ink better, of which that of some places is
        asked, or as well along the legs.
        """
        leg, by_ink = round(LEGS[0] / STEP_WIDTHS), is_asked[self._places(first, last)].any()
        own = self.own(first - leg, last + leg)
        legs = None if own is None else self._along_legs(own, leg)
        if own is None or not (by_ink or legs is not None):
            return None
        seen = self.about(first - leg, last + leg, np.empty((0, 2)))
        if seen is None:
            return None
        found = self._by_ink(seen) if by_ink else None
        if found is None and legs is not None:
            found = self._by_legs(seen, legs)
        return None if found is None else self.as_bay(seen.first, seen.last, *found)

    def _by_ink(self, seen: BayInk) -> tuple[Rule, float] | None:
        """The rule that explains the ink of a stretch better than the way does, and by how much."""
        own, ink, width_mm = seen.own, seen.ink, self.line.width_mm
        by_own = ink.best_drawn(distances.away_from(ink.places_mm, own))
        if ink.misfit(by_own) < SURE * STEP_WIDTHS * len(own):
            return None
        rule = self.explained(ink, list(folding_rule.along(own, ink.half_mm)))
        if rule is None or nearest_mm(rule.way, own).max() > OFF * width_mm:
            return None
        gain, widths = ink.misfit(by_own) - rule.misfit, rule.length_mm / width_mm
        is_like = rule.misfit < LIKE * widths
        is_like &= ink.share_left(ink.drawn_along(rule.way, rule.half_mm), by_own) < MOST_LEFT
        return (rule, gain) if is_like and gain > SURE * widths else None

    def _along_legs(self, own: Array, leg: int) -> Rule | None:
        """The rule along both legs of a stretch (n, 2) mm to where these meet, if the way leaves them."""
        width_mm = self.line.width_mm
        corner = met(own[: leg + 1], own[: -leg - 2 : -1], BENT * width_mm)
        if corner is None or nearest_mm(corner[None], own)[0] > width_mm:
            return None
        rule = folding_rule.sharp(own[0], own[-1], corner[None], 0.5 * width_mm)
        straight = evenly(rule.way, self.step_mm)
        off_mm = max(nearest_mm(own, straight).max(), nearest_mm(straight, own).max())
        return rule if LEFT_LEGS * width_mm < off_mm < width_mm else None

    def _by_legs(self, seen: BayInk, rule: Rule) -> tuple[Rule, float] | None:
        """A rule that explains the ink of a stretch as well as the way does, and by how much better."""
        gain = seen.ink.misfit_along(seen.own) - seen.ink.misfit_along(rule.way)
        return (rule, gain) if gain > -PRICE else None


def _turns(way: Array, half: int) -> list[int]:
    """The numbers of places at which a way (n, 2) mm turns off most, from so many places before to so many
    after.
    """
    places = way[:, 0] + 1j * way[:, 1]
    before, after = places - np.roll(places, half), np.roll(places, -half) - places
    turn = np.abs(np.angle(after * before.conj()))
    if turn.max() <= STRAIGHT:
        return []
    most = np.max([np.roll(turn, by) for by in range(-half, half + 1)], axis=0)
    return np.flatnonzero((turn == most) & (turn > STRAIGHT)).tolist()


def met(before: Array, after: Array, bent_mm: float) -> Array | None:
    """Where two legs (n, 2) mm, each towards a corner, meet ahead of both, (x, y) mm; None if one of them is
    bent by more, or both lie in line.
    """
    middles, ways, half_mm = list[Array](), list[Array](), list[float]()
    for leg in (before, after):
        middle = leg.mean(axis=0)
        way = np.linalg.svd(leg - middle)[2][0]
        way = way if way @ (leg[-1] - leg[0]) > 0 else -way
        if np.abs((leg - middle) @ left_of(way)).max() > bent_mm:
            return None
        middles.append(middle)
        ways.append(way)
        half_mm.append(0.5 * float(np.ptp(leg @ way)))
    if abs(cross(*ways)) < math.sin(STRAIGHT):
        return None
    corner = meeting(middles[0], ways[0], middles[1], ways[1])
    parts = zip(middles, ways, half_mm, strict=True)
    is_ahead = all((corner - middle) @ way > half for middle, way, half in parts)
    return corner if is_ahead else None
