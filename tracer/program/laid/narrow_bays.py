"""Narrow bays: notches and tongues of a line hardly wider than two lines, laid where the head fails.

    ───╮   ╭───     the head cut the end short, ran out and back between the sides, or passed the bay by
       ╰───╯

Where a way leaves its ink unexplained (see `unexplained`), or comes beside itself (see
`beside_itself`), a rule of a few straight pieces is laid by the ink between clean places of the way on either
side (see `tangles.folding_rule`). If that explains the ink, and the head's own way does not, the head runs
along the rule from memory.

Signals: the sheet and lines in; the lines with their narrow bays mended, and what is still unexplained, out.

Source: our own. Questions: a tick as thick as two lines is taken for a bay; one of a single line is not.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha1
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array, bounds
from morfax.motion.polyline import broad_mm, evenly, nearest_mm
from morfax.tracer.effort import MANY, ROUNDS
from morfax.tracer.following.line import Line
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.program.against_ink.bars import bar_at
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.off_ink import goes_on, ink_about
from morfax.tracer.program.against_ink.unexplained import (
    Unexplained,
    beside_ink,
    ink_beside,
    unexplained,
)
from morfax.tracer.program.laid.bay_run import Bay, apart, laid
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import (
    LEGS,
    MOUTH,
    OF_LOOP,
    REACH,
    STILL_LEFT,
    is_beside,
    is_clear,
    is_whole,
    rest_of,
)
from morfax.tracer.program.laid.news import News, near_box
from morfax.tracer.program.laid.rim_bays import is_a_pen, rim_bays
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import beside_itself, folding_rule, pen
from morfax.tracer.tangles.folding_rule import Rule
from morfax.tracer.tangles.seen_ink import GAIN, LIKE, SeenInk

# In widths of the line, chosen by trial on plates with notches and tongues:
LONGEST = 80.0  # a longer stretch is no bay
FURTHER = 0.01  # as much more must be left for each width more of a way that runs out and back on one line
# of what a way leaves that does not come beside itself, where the rule draws otherwise: less is a blot,
# or what a rubber left
MOST_LEFT = 0.3
DOUBTFUL = 0.3  # of the limit above which a way is beside its ink: it may be wrong


LeftBy = Callable[[Setup, Sequence[Line], float], tuple[Unexplained, ...]]


class Suspect(NamedTuple):
    """A stretch of a way that may be a bay: its first and last place, places (n, 2) mm of ink beside it that
    belong to it, and whether the way comes beside itself.
    """

    first: int
    last: int
    beyond_mm: Array
    is_beside_itself: bool = False


def explained(
    setup: Setup, lines: Sequence[Line]
) -> tuple[list[Line], tuple[Unexplained, ...]]:
    """The lines with their narrow bays mended, and what they leave unexplained."""
    return _mended(setup, lines, unexplained)


def beside_mended(
    setup: Setup, lines: Sequence[Line]
) -> tuple[list[Line], tuple[Unexplained, ...]]:
    """The same of lines along all the ink of a sheet, of which none is another's bar."""
    return _mended(setup, lines, beside_ink)


def with_bars(setup: Setup, lines: Sequence[Line], others: Sequence[Line] = ()) -> list[Line]:
    """The lines with those narrow bays mended that show as bars of ink beside them and some others."""
    left = tuple(ink_beside(setup.sheet, [*lines, *others]))
    return _once_mended(setup, lines, left, others)


def _mended(
    setup: Setup, lines: Sequence[Line], left_by: LeftBy
) -> tuple[list[Line], tuple[Unexplained, ...]]:
    """The lines with their narrow bays mended, until no more is found, and what is left of what was told."""
    lines, left = list(lines), left_by(setup, lines, DOUBTFUL)
    news = None
    for _ in range(ROUNDS):
        mended = _once_mended(setup, lines, left, news=news)
        if all(new is line for new, line in zip(mended, lines, strict=True)):
            break
        before = lines, left
        lines, left = mended, left_by(setup, mended, DOUBTFUL)
        news = News.between(before, (lines, left))
    return lines, tuple(place for place in left if place.is_sure)


def _once_mended(
    setup: Setup,
    lines: Sequence[Line],
    left: Sequence[Unexplained],
    others: Sequence[Line] = (),
    news: News | None = None,
) -> list[Line]:
    """The lines, beside some others, with their narrow bays mended: all of them, or those near to news; those
    of a drawn program as they are.
    """
    mended, every = list(lines), BoxedLines.of([*lines, *others])
    if setup.operator.reads_marks(lines):
        return mended
    for k, line in enumerate(lines):
        if news is None or news.concerns(line, left):
            mended[k] = _Bays(setup, line, every, left).mended()
        setup.come(k + 1, len(lines))
    return mended


class BayInk(NamedTuple):
    """A stretch of a way from one of its places to another, as places (n, 2) mm, and the ink about it."""

    first: int
    last: int
    own: Array
    ink: SeenInk


@dataclass(frozen=True)
class _Bays:
    """The narrow bays of one of some lines, of which places are left unexplained."""

    setup: Setup
    line: Line
    lines: BoxedLines
    left: Sequence[Unexplained]

    def mended(self) -> Line:
        """The line as it is, or along the rules that explain narrow bays on it."""
        line = self.line
        if not is_whole(line) or not is_clear(self.setup.sheet.drawing):
            return line
        step_mm = STEP_WIDTHS * line.width_mm
        way = evenly(line.loop_mm if self._is_closed else line.places_mm, step_mm)
        round_mm = len(way) * step_mm
        suspects = list(self._suspects(way, step_mm))[:MANY]
        bays = [bay for each in suspects if (bay := self._bay(way, step_mm, each)) is not None]
        if line.as_told:  # it begins where it is told to
            bays = [bay for bay in bays if bay.first_mm >= 0 and bay.last_mm < round_mm]
        bays = apart(bays, round_mm)
        return laid(self.setup, line, bays, round_mm) if bays else line

    @property
    def _is_closed(self) -> bool:
        """Whether the line comes round."""
        return self.line.ending == "closed"

    def _suspects(self, way: Array, step_mm: float) -> Iterator[Suspect]:
        """Where the way may have passed a bay by or cut it short."""
        width_mm, nothing = self.line.width_mm, np.empty((0, 2))
        beside = beside_itself.stretches(way, step_mm, width_mm)
        for first, last in beside:
            yield Suspect(first, last, nothing, True)
        for place in near_box(self.left, *bounds(way), width_mm):
            if not (self._is_closed or place.is_sure):
                continue  # on ragged lines of a map each third bend is in doubt, and is none
            away_mm = np.hypot(*(way - place.place_mm).T)
            at = int(np.argmin(away_mm))
            if place.kind == "beside" and away_mm[at] < width_mm:
                half = max(round(0.5 * place.length_mm / step_mm), 1)
                yield Suspect(at - half, at + half, nothing)
            elif place.kind == "ink" and away_mm[at] < place.length_mm + width_mm:
                yield from self._round_bar(way, place, beside)

    def _round_bar(
        self, way: Array, place: Unexplained, beside: list[tuple[int, int]]
    ) -> Iterator[Suspect]:
        """The stretch of the way that a bar of ink is joined to, if it is joined to no other; all of one that
        comes beside itself.
        """
        width_mm = self.line.width_mm
        bar = bar_at(self.setup.sheet.drawing, self.lines, place, width_mm)
        mouth = np.flatnonzero(nearest_mm(way, bar) < MOUTH * width_mm)
        if not len(mouth):
            return
        first, last = beside_itself.shortest(mouth, len(way))
        for begin, end in beside:
            if begin <= last and first <= end:
                first, last = min(first, begin), max(last, end)
        yield Suspect(first, last, bar)

    def _bay(self, way: Array, step_mm: float, suspect: Suspect) -> Bay | None:
        """The bay that a stretch of the way is, if a rule explains its ink better than the way does, or else
        the way within the rim of that.
        """
        leg = round(LEGS[0] / STEP_WIDTHS)
        seen = self._seen(way, step_mm, suspect, leg)
        if seen is None:
            return None
        rules = list[Rule]()
        if not len(suspect.beyond_mm):
            rules += folding_rule.along(seen.own, seen.ink.half_mm)
        if suspect.is_beside_itself or len(suspect.beyond_mm):
            legs = np.vstack([seen.own[: leg + 1], seen.own[-leg - 1 :]])
            rules += folding_rule.round_bar(seen.ink, legs)
        rule = self._explained(seen.ink, rules)
        gain = self._gain(seen, rule, suspect) if rule is not None else None
        if rule is not None and gain is not None:
            return Bay(seen.first * step_mm, seen.last * step_mm, rule, gain)
        if not suspect.is_beside_itself and not len(suspect.beyond_mm):
            return None
        bay = self._rim_bay(seen, step_mm, suspect)
        longer = None
        if bay is None:
            longer = self._seen(way, step_mm, suspect, round(LEGS[1] / STEP_WIDTHS))
        return bay if longer is None else self._rim_bay(longer, step_mm, suspect)

    def _seen(self, way: Array, step_mm: float, suspect: Suspect, leg: int) -> BayInk | None:
        """The stretch of the way that may be a bay, with legs, and the ink about it; None if it is too long,
        or the ink goes on.
        """
        first, last = suspect.first - leg, suspect.last + leg
        long = last - first
        if long > OF_LOOP * len(way) or long * step_mm > LONGEST * self.line.width_mm:
            return None
        if not self._is_closed and not 0 < first < last < len(way) - 1:
            return None
        own = way[np.arange(first, last + 1) % len(way)]
        rest = rest_of(way, first, last, self._is_closed)
        about = np.vstack([own, suspect.beyond_mm])
        ink = self._ink(about, rest)
        return None if goes_on(ink, about, REACH) else BayInk(first, last, own, ink)

    def _rim_bay(self, seen: BayInk, step_mm: float, suspect: Suspect) -> Bay | None:
        """The bay along a stretch that lies within the rim of its ink, if that explains the ink better."""
        setup, ink, best = self.setup, seen.ink, None
        view = view_of(setup.sheet, setup.settings.aperture_mm, self.line.width_mm)
        for rim_bay in rim_bays(setup.sheet.drawing, view, seen.own, suspect.beyond_mm):
            drawn = ink.drawn_along(rim_bay.way, rim_bay.half_mm)
            rule = rim_bay._replace(misfit=ink.misfit(drawn))
            gain = self._gain(seen, rule, suspect)
            if is_a_pen(setup.sheet, self.line.width_mm + broad_mm(rule.way)):
                continue
            if gain is not None and (best is None or gain > best.gain):
                best = Bay(seen.first * step_mm, seen.last * step_mm, rule, gain)
        return best

    def _gain(self, seen: BayInk, rule: Rule | LaidWay, suspect: Suspect) -> float | None:
        """How much better a rule explains the ink than the way does; None if it does not, or badly."""
        width_mm, own, ink = self.line.width_mm, seen.own, seen.ink
        widths = rule.length_mm / width_mm
        drawn_by_own = ink.best_drawn(pen.away_from(ink.places_mm, own))
        own_misfit = ink.misfit(drawn_by_own)
        gain = own_misfit - rule.misfit + FURTHER * (STEP_WIDTHS * (len(own) - 1) - widths)
        is_like = rule.misfit < LIKE * widths
        if not self._is_closed and rule.misfit > STILL_LEFT * own_misfit:
            # the way may be right, and some of its ink another line's
            is_like &= not is_beside(own, self.line, self.lines)
        drawn = ink.drawn_along(rule.way, rule.half_mm)
        is_like &= suspect.is_beside_itself or ink.share_left(drawn, drawn_by_own) < MOST_LEFT
        return gain if is_like and gain >= GAIN * widths else None

    def _explained(self, ink: SeenInk, rules: list[Rule]) -> Rule | None:
        """The rule that explains an ink best. A bay is looked at again when another was mended; the same
        rules are fitted to the same ink once.
        """
        kept, key = self.setup.rules, sha1(pickle.dumps((ink, rules))).digest()
        if key not in kept:
            kept[key] = folding_rule.explained(ink, rules)
        return kept[key]

    def _ink(self, about: Array, rest: Sequence[Array]) -> SeenInk:
        """The ink about some places (n, 2) mm of a way; the rest of it, and all other lines, are known."""
        ink = ink_about(self.setup.sheet.drawing, about, self.line.width_mm, REACH)
        reach_mm = REACH * self.line.width_mm
        low, high = about.min(axis=0) - reach_mm, about.max(axis=0) + reach_mm
        known_mm = np.min([pen.away_from(ink.places_mm, part) for part in rest], axis=0)
        for line in self.lines.reaching(low, high, self.line):
            known_mm = np.minimum(known_mm, nearest_mm(ink.places_mm, line.places_mm))
        return ink._replace(known_mm=known_mm)
