"""Cut corners: where sides of two or three widths meet, the head may round a corner, or cut it.

    ──────╮      a way that is less than a third of a width off is on its ink nearly everywhere: what is over
           ╲     there is far below what tells a wrong way, but far above what the paper's noise leaves
            │

There a folding rule of one to four corners is laid by the ink between clean places of the way on either
side, as at narrow bays (see `narrow_bays`). If it explains the ink better, and lies as near to the way, the
head runs along it from memory.

Signals: the sheet and lines in; the lines with their corners out.

Source: our own. Questions: a corner within another line's ink is not seen to be cut.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from morfax.motion.polyline import nearest_mm
from morfax.tracer.effort import MANY, ROUNDS
from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.own_ink import NEARLY, BesideInk, beside
from morfax.tracer.program.laid.bay_run import Bay, apart, laid
from morfax.tracer.program.laid.line_parts import LEGS, is_clear, is_whole
from morfax.tracer.program.laid.way_ink import WayInk
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import folding_rule, pen
from morfax.tracer.tangles.folding_rule import Rule
from morfax.tracer.tangles.seen_ink import GAIN, LIKE

OFF = 0.3  # widths: a rule that lies further off the head's way runs out along a tick, or is another line
# of what a way leaves where the rule draws otherwise: what leaves more explains something else
MOST_LEFT = 0.3


def with_corners(setup: Setup, lines: Sequence[Line]) -> list[Line]:
    """The lines with the corners that were cut; those of a drawn program as they are."""
    lines, drawing = list(lines), setup.sheet.drawing
    if not lines or not is_clear(drawing) or setup.operator.reads_marks(lines):
        return lines
    for _ in range(ROUNDS):
        left = [place for place in beside(drawing, lines, NEARLY) if not place.is_sure]
        every = BoxedLines.of(lines)
        mended = [_Corners(setup, line, every, left).mended() for line in lines]
        if all(new is line for new, line in zip(mended, lines, strict=True)):
            break
        lines = mended
    return lines


@dataclass(frozen=True)
class _Corners(WayInk):
    """The corners of one of some lines, which run beside their ink at some places."""

    left: Sequence[BesideInk]

    def mended(self) -> Line:
        """The line as it is, or along the rules that explain what was cut."""
        line = self.line
        if not self.is_closed or not is_whole(line) or line.as_told:
            return line
        low, high = line.places_mm.min(axis=0), line.places_mm.max(axis=0)
        bays = list[Bay]()
        for place in self.left:
            is_in = bool(((place.place_mm >= low) & (place.place_mm <= high)).all())
            bay = self._bay(place) if is_in and len(bays) < MANY else None
            if bay is not None:
                bays.append(bay)
        bays = apart(bays, self.round_mm)
        return laid(self.setup, line, bays, self.round_mm) if bays else line

    def _bay(self, place: BesideInk) -> Bay | None:
        """The rule in place of the way about a place, if it explains the ink better."""
        away_mm = np.hypot(*(self.way - place.place_mm).T)
        at, leg = int(np.argmin(away_mm)), round(LEGS[0] / STEP_WIDTHS)
        if away_mm[at] > self.step_mm:
            return None  # another line's
        half = max(round(0.5 * place.length_mm / self.step_mm), 1)
        seen = self.about(at - half - leg, at + half + leg, np.empty((0, 2)))
        if seen is None:
            return None
        own, ink = seen.own, seen.ink
        rule = self.explained(ink, list(folding_rule.along(own, ink.half_mm)))
        if rule is None or nearest_mm(rule.way, own).max() > OFF * self.line.width_mm:
            return None
        by_own = ink.best_drawn(pen.away_from(ink.places_mm, own))
        gain = ink.misfit(by_own) - rule.misfit
        is_like = rule.misfit < LIKE * self._widths(rule)
        is_like &= ink.share_left(ink.drawn_along(rule.way, rule.half_mm), by_own) < MOST_LEFT
        if not is_like or gain < GAIN * self._widths(rule):
            return None
        return Bay(seen.first * self.step_mm, seen.last * self.step_mm, rule, gain)

    def _widths(self, rule: Rule) -> float:
        """How long a rule is, in widths of the line."""
        return rule.length_mm / self.line.width_mm
