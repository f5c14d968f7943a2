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

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array, bounds
from morfax.motion.polyline import broad_mm, evenly, nearest_mm
from morfax.tracer.effort import MANY, ROUNDS
from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.bars import bar_at
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.in_one_box import with_boxes
from morfax.tracer.program.against_ink.own_ink import OwnInk
from morfax.tracer.program.against_ink.unexplained import (
    Unexplained,
    beside_ink,
    ink_beside,
    unexplained,
)
from morfax.tracer.program.laid.bay_run import Bay
from morfax.tracer.program.laid.cut_corners import with_corners
from morfax.tracer.program.laid.cut_tips import with_tips
from morfax.tracer.program.laid.grain_corners import with_grain_corners
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import (
    LEGS,
    MOUTH,
    REACH,
    STILL_LEFT,
    is_beside,
    is_clear,
    is_whole,
)
from morfax.tracer.program.laid.news import News, near_box
from morfax.tracer.program.laid.rim_bays import is_a_pen, rim_bays, turned_less_rad
from morfax.tracer.program.laid.way_ink import MOST_LEFT, BayInk, Relaid, WayInk
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import beside_itself, distances, folding_rule
from morfax.tracer.tangles.folding_rule import Rule
from morfax.tracer.tangles.seen_ink import GAIN, LIKE

# In widths of the line, chosen by trial on plates with notches and tongues:
FURTHER = 0.01  # as much more must be left for each width more of a way that runs out and back on one line
LEFT_BY_RAD = 1.0  # as much more may be left for each rad by which a way turns less

LeftBy = Callable[[Setup, OwnInk], tuple[Unexplained, ...]]


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
    return [relaid.line for relaid in _once_mended(setup, lines, left, others)]


def _mended(
    setup: Setup, lines: Sequence[Line], left_by: LeftBy
) -> tuple[list[Line], tuple[Unexplained, ...]]:
    """The lines with their narrow bays mended, until no more is found, then with what corners were cut, and
    what is left of what was told.
    """
    own = OwnInk(setup.sheet.drawing, list(lines))
    left, news = left_by(setup, own), None
    for _ in range(ROUNDS):
        mended = _once_mended(setup, own.lines, left, news=news)
        if not any(len(relaid.places_mm) for relaid in mended):
            break
        own, before = own.mended([relaid.line for relaid in mended]), left
        left = left_by(setup, own)
        news = News.of(mended, before, left)
    uncut = with_grain_corners(setup, with_corners(setup, own))
    if uncut is not own:
        own, left = uncut, left_by(setup, uncut)
    told = _told(setup, own, left)
    with_tips_laid = with_tips(setup, own, told)
    if with_tips_laid is not own:
        own = with_tips_laid
        told = _told(setup, own, left_by(setup, own))
    return list(own.lines), told


def _told(setup: Setup, own: OwnInk, left: Sequence[Unexplained]) -> tuple[Unexplained, ...]:
    """What is told of some places that lines leave unexplained, and of what a box shows."""
    sure = tuple(place for place in left if place.is_sure)
    return sure if setup.operator.reads_marks(own.lines) else with_boxes(own, sure)


def _once_mended(
    setup: Setup,
    lines: Sequence[Line],
    left: Sequence[Unexplained],
    others: Sequence[Line] = (),
    news: News | None = None,
) -> list[Relaid]:
    """The lines, beside some others, with their narrow bays mended: all of them, or those near to news; those
    of a drawn program as they are.
    """
    mended, every = list[Relaid](), BoxedLines.of([*lines, *others])
    is_drawn = not setup.operator.reads_marks(lines)
    for k, line in enumerate(lines):
        is_asked = is_drawn and (news is None or news.concerns(line, left))
        bays = _Bays(setup, line, every, left, news)
        mended.append(bays.mended() if is_asked else bays.along([]))
        setup.come(k + 1, len(lines))
    return mended


@dataclass(frozen=True)
class _Bays(WayInk):
    """The narrow bays of one of some lines, of which places are left unexplained."""

    left: Sequence[Unexplained]
    news: News | None = None

    def mended(self) -> Relaid:
        """The line as it is, or along the rules that explain narrow bays on it."""
        line = self.line
        if not is_whole(line) or not is_clear(self.setup.sheet.drawing):
            return self.along([])
        suspects = [each for each in self._suspects() if self._is_asked(each)][:MANY]
        bays = [bay for each in suspects if (bay := self._bay(each)) is not None]
        if line.as_told:  # it begins where it is told to
            bays = [bay for bay in bays if bay.first_mm >= 0 and bay.last_mm < self.round_mm]
        return self.along(bays)

    def _is_asked(self, suspect: Suspect) -> bool:
        """Whether a stretch is asked: it was not looked at before, or something is new near to it."""
        if self.news is None:
            return True
        way = self.way[np.arange(suspect.first, suspect.last + 1) % len(self.way)]
        near_mm = 2 * REACH * self.line.width_mm
        return self.news.is_near(*bounds(np.vstack([way, suspect.beyond_mm])), near_mm)

    def _suspects(self) -> Iterator[Suspect]:
        """Where the way may have passed a bay by or cut it short."""
        way, width_mm, nothing = self.way, self.line.width_mm, np.empty((0, 2))
        beside = beside_itself.stretches(way, self.step_mm, width_mm)
        for first, last in beside:
            yield Suspect(first, last, nothing, True)
        for place in near_box(self.left, *bounds(way), width_mm):
            if not (self.is_closed or place.is_sure):
                continue  # on ragged lines of a map each third bend is in doubt, and is none
            away_mm = np.hypot(*(way - place.place_mm).T)
            at = int(np.argmin(away_mm))
            if place.kind == "beside" and away_mm[at] < width_mm:
                yield Suspect(*self.stretch(at, place.length_mm), nothing)
            elif place.kind == "ink" and away_mm[at] < place.length_mm + width_mm:
                yield from self._round_bar(place, beside)

    def _round_bar(
        self, place: Unexplained, beside: list[tuple[int, int]]
    ) -> Iterator[Suspect]:
        """The stretch of the way that a bar of ink is joined to, if it is joined to no other; all of one that
        comes beside itself.
        """
        way, width_mm = self.way, self.line.width_mm
        bar = bar_at(self.setup.sheet.drawing, self.lines, place, width_mm)
        mouth = np.flatnonzero(nearest_mm(way, bar) < MOUTH * width_mm)
        if not len(mouth):
            return
        first, last = beside_itself.shortest(mouth, len(way))
        for begin, end in beside:
            if begin <= last and first <= end:
                first, last = min(first, begin), max(last, end)
        yield Suspect(first, last, bar)

    def _bay(self, suspect: Suspect) -> Bay | None:
        """The bay that a stretch of the way is, if a rule explains its ink better than the way does, or else
        the way within the rim of that.
        """
        leg = round(LEGS[0] / STEP_WIDTHS)
        seen = self._seen(suspect, leg)
        if seen is None:
            return None
        rules = list[Rule]()
        if not len(suspect.beyond_mm):
            rules += folding_rule.along(seen.own, seen.ink.half_mm)
        if suspect.is_beside_itself or len(suspect.beyond_mm):
            legs = np.vstack([seen.own[: leg + 1], seen.own[-leg - 1 :]])
            rules += folding_rule.round_bar(seen.ink, legs)
            rules = folding_rule.not_far(seen.ink, rules)
        rule = self.explained(seen.ink, rules)
        gain = self._gain(seen, rule, suspect) if rule is not None else None
        if rule is not None and gain is not None:
            laid = self._is_laid(seen.own, rule)
            return None if laid else self.as_bay(seen.first, seen.last, rule, gain)
        is_asked = suspect.is_beside_itself or len(suspect.beyond_mm)
        if not is_asked and self._is_explained(seen):
            return None
        bay = self._rim_bay(seen, suspect)
        longer = None
        if bay is None:
            longer = self._seen(suspect, round(LEGS[1] / STEP_WIDTHS))
        return bay if longer is None else self._rim_bay(longer, suspect)

    def _is_explained(self, seen: BayInk) -> bool:
        """Whether a stretch explains its ink."""
        own, ink = seen.own, seen.ink
        misfit = ink.misfit(ink.best_drawn(distances.away_from(ink.places_mm, own)))
        return misfit < LIKE * STEP_WIDTHS * (len(own) - 1)

    def _is_laid(self, own: Array, rule: Rule) -> bool:
        """Whether a stretch that was looked at before runs within half a step of a rule: it was laid along
        that, and would be again and again.
        """
        if self.news is None:
            return False
        fine_mm = 0.1 * self.step_mm
        way, ran = evenly(rule.way, fine_mm), evenly(own, fine_mm)
        off_mm = max(nearest_mm(ran, way).max(), nearest_mm(way, ran).max())
        return bool(off_mm < 0.5 * self.step_mm)

    def _seen(self, suspect: Suspect, leg: int) -> BayInk | None:
        """The stretch of the way that may be a bay, with legs, and the ink about it."""
        return self.about(suspect.first - leg, suspect.last + leg, suspect.beyond_mm)

    def _rim_bay(self, seen: BayInk, suspect: Suspect) -> Bay | None:
        """The bay along a stretch that lies within the rim of its ink, if that explains the ink better."""
        setup, ink, width_mm, best = self.setup, seen.ink, self.line.width_mm, None
        for rim_bay in rim_bays(setup, width_mm, seen.own, suspect.beyond_mm):
            if is_a_pen(setup.sheet, width_mm + broad_mm(rim_bay.way)):
                continue
            drawn = ink.drawn_along(rim_bay.way, rim_bay.half_mm)
            rule = rim_bay._replace(misfit=ink.misfit(drawn))
            gain = self._gain(seen, rule, suspect)
            if gain is not None and (best is None or gain > best.gain):
                best = self.as_bay(seen.first, seen.last, rule, gain)
        return best

    def _gain(self, seen: BayInk, rule: Rule | LaidWay, suspect: Suspect) -> float | None:
        """How much better a rule explains the ink than the way does; None if it does not, or badly."""
        width_mm, own, ink = self.line.width_mm, seen.own, seen.ink
        widths = rule.length_mm / width_mm
        drawn_by_own = ink.best_drawn(distances.away_from(ink.places_mm, own))
        own_misfit = ink.misfit(drawn_by_own)
        gain = own_misfit - rule.misfit + FURTHER * (STEP_WIDTHS * (len(own) - 1) - widths)
        if suspect.is_beside_itself:
            gain += LEFT_BY_RAD * turned_less_rad(rule.way, own, width_mm)
        drawn = ink.drawn_along(rule.way, rule.half_mm)
        misfit = rule.misfit
        if len(suspect.beyond_mm):
            # what both leave alike is no matter of this choice
            misfit = ink.left_where(drawn, drawn_by_own)
        is_like = misfit < LIKE * widths
        if not self.is_closed and rule.misfit > STILL_LEFT * own_misfit:
            # the way may be right, and some of its ink another line's
            is_like &= not is_beside(own, self.line, self.lines)
        is_like &= suspect.is_beside_itself or ink.share_left(drawn, drawn_by_own) < MOST_LEFT
        return gain if is_like and gain >= GAIN * widths else None
