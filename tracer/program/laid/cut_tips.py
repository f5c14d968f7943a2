"""Cut tips: tips, steps and bumps of about a width, laid where a box shows that the way runs beside its ink.

    ──────╮         the way cuts a tip: its pen draws on paper on one side of it, and leaves ink on the other
      ──╮ ╰───

What one box shows both of is no tick and no gap (see `in_one_box`). So the way may run further aside there
than at a corner that the head cut a little (see `cut_corners`): a folding rule is laid by the ink between
clean places on either side, along the way or by the tip of the ink that is left: sharp, of three corners at
the most. Several strands may come by; it is laid in place of that of which it takes the fewest figures.

Signals: the sheet and lines, held against their ink, in; the lines with their tips out.

Source: our own. Questions: within ink that several sides share a tip may lie elsewhere, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array, bounds
from morfax.motion.crossings import crossings_of
from morfax.motion.polyline import evenly, nearest_mm
from morfax.tracer.drawing.components import INK
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.own_ink import OwnInk
from morfax.tracer.program.against_ink.unexplained import Unexplained
from morfax.tracer.program.laid.bay_run import Bay
from morfax.tracer.program.laid.line_parts import is_clear, is_plain
from morfax.tracer.program.laid.news import near_box
from morfax.tracer.program.laid.way_ink import MOST_LEFT, BayInk, Relaid, WayInk
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import distances, folding_rule
from morfax.tracer.tangles.folding_rule import Rule
from morfax.tracer.tangles.seen_ink import LIKE, SURE

# widths of the line: from a place that is told to the strands that may be what is beside its ink; the places
# of one box are no further
STRANDS = 1.6
LEGS = 1.5, 2.5  # widths: of a tip the way is clean so near to it, or within the longer leg


class _Laid(NamedTuple):
    """A rule in place of a stretch of a way, by how much better it explains the ink, and the stretch."""

    rule: Rule
    gain: float
    seen: BayInk


def with_tips(setup: Setup, own: OwnInk, left: Sequence[Unexplained]) -> OwnInk:
    """Lines, held against their ink, of which some places are left unexplained, with the tips that were cut
    there.
    """
    places = [place for place in left if place.kind == "beside"]
    if not places or not is_clear(own.drawing) or setup.operator.reads_marks(own.lines):
        return own
    every = BoxedLines.of(own.lines)
    mended = [_Tips(setup, line, every, places).mended() for line in own.lines]
    is_any = any(len(relaid.places_mm) for relaid in mended)
    return own.mended([relaid.line for relaid in mended]) if is_any else own


@dataclass(frozen=True)
class _Tips(WayInk):
    """The tips of one of some lines, which run beside their ink at some places."""

    places: Sequence[Unexplained]

    def mended(self) -> Relaid:
        """The line as it is, or along the rules that explain its tips."""
        if not is_plain(self.line) or self.line.as_told:
            return self.along([])
        near = near_box(self.places, *bounds(self.way), self.line.width_mm)
        bays = [bay for place in near if (bay := self._bay(place)) is not None]
        return self.along(bays)

    def _bay(self, place: Unexplained) -> Bay | None:
        """The rule about a place that takes least, if one explains its ink."""
        laid = [
            found
            for at in self._strands(np.array(place.place_mm))
            for leg in LEGS
            if (found := self._laid(at, place.length_mm, leg)) is not None
        ]
        if not laid:
            return None
        best = min(laid, key=lambda found: found.rule.cost)
        return self.as_bay(best.seen.first, best.seen.last, best.rule, best.gain)

    def _strands(self, place_mm: Array) -> Iterator[int]:
        """The numbers of the places at which the way comes nearest to a place (x, y) mm, once a strand."""
        away_mm, count = np.hypot(*(self.way - place_mm).T), len(self.way)
        near = np.flatnonzero(away_mm < STRANDS * self.line.width_mm)
        strands = np.split(near, np.flatnonzero(np.diff(near) > 1) + 1)
        if len(strands) > 1 and near[0] == 0 and near[-1] == count - 1:
            strands = [np.append(strands[-1] - count, strands[0]), *strands[1:-1]]
        for strand in strands if len(near) else ():
            yield int(strand[np.argmin(away_mm[strand % count])])

    def _laid(self, at: int, long_mm: float, leg_widths: float) -> _Laid | None:
        """The rule in place of a stretch about a place of the way, if it explains the ink and the way does
        not.
        """
        leg, (first, last) = round(leg_widths / STEP_WIDTHS), self.stretch(at, long_mm)
        seen = self.about(first - leg, last + leg, np.empty((0, 2)))
        if seen is None:
            return None
        own, ink = seen.own, seen.ink
        by_own = ink.best_drawn(distances.away_from(ink.places_mm, own))
        left_mm = ink.without_specks(ink.darkness - by_own > INK)
        tip_mm = _tip(own, left_mm, ink.half_mm) if len(left_mm) else None
        rules = list(folding_rule.by_tip(own, tip_mm, ink.half_mm))
        rule = self.explained(ink, rules, of_bay=False)
        if rule is None or _crosses_itself(rule, self.step_mm):
            return None
        gain, widths = ink.misfit(by_own) - rule.misfit, rule.length_mm / self.line.width_mm
        is_like = rule.misfit < LIKE * widths and gain > SURE * widths
        is_like &= ink.share_left(ink.drawn_along(rule.way, rule.half_mm), by_own) < MOST_LEFT
        return _Laid(rule, gain, seen) if is_like else None


def _tip(own: Array, left_mm: Array, half_mm: float) -> Array:
    """Where a pen of half a width turned that left some ink (n, 2) mm beside a way (m, 2) mm, (x, y) mm."""
    furthest = left_mm[int(np.argmax(nearest_mm(left_mm, own)))]
    back = own[int(np.argmin(np.hypot(*(own - furthest).T)))] - furthest
    return np.asarray(furthest + half_mm * back / np.hypot(*back))


def _crosses_itself(rule: Rule, step_mm: float) -> bool:
    """Whether a rule's way crosses itself."""
    way = evenly(rule.way, step_mm)
    return len(crossings_of(way, np.arange(len(way) - 1))) > 0
