"""Onward: whether a line goes on at a junction, smoothly and drawn by the same pen.

Signals: a side of a line at a junction of a net in; whether it goes on there out.

    thick ━━━━┳────  thin      a line that ink of another pen goes on from ends there: an outline where an
              ┃                extension line begins, a wall where the leaf of a door does

Source: our own; the two pens of a drawing differ by 1.4 or more (ISO 128).
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from morfax.tracer.ink.apertures import PENS_SHARE
from morfax.tracer.ink.chains import Junctions, Side
from morfax.tracer.ink.outlines import turned_by
from morfax.tracer.limits import WIDER
from morfax.tracer.sensing.leg import FACING

# All limits below were chosen by trial on drawings of parts and plans.
OTHER_PEN = 1.35  # times as wide
SURE_WIDTHS = 15.0  # a line as long tells its pen: ink that two lines share is wider, but short


@dataclass
class Onward:
    """How the lines of a net go on, if some of them stand aside from its contours."""

    junctions: Junctions
    aside: Set[int] = frozenset()
    _known: dict[Side, bool] = field(default_factory=dict)

    def goes_on(self, side: Side) -> bool:
        """Whether a line goes on smoothly at one of its sides, by its own pen, and not into a line aside."""
        if side not in self._known:
            self._known[side] = self._goes_on(side)
        return self._known[side]

    def _goes_on(self, side: Side) -> bool:
        """The same, asked for the first time."""
        there = self.junctions.at(side)
        partner = there.partner(side)
        if partner is None or partner.line in self.aside or self.are_of_two_pens(side, partner):
            return False
        return turned_by(there.leg(side), there.leg(partner).turned_round()) < FACING

    def are_of_two_pens(self, one: Side, other: Side) -> bool:
        """Whether the lines of two sides have other widths, and each tells its pen, or is as wide as another
        line there: ink that two lines share is wider, too.
        """
        there = self.junctions.at(one)
        widths_mm = [there.leg(side).width_mm for side in (one, other)]
        whole_mm = [self._whole_mm(side) for side in (one, other)]
        if any(max(mm) < OTHER_PEN * min(mm) for mm in (widths_mm, whole_mm)):
            return False
        others = [
            leg.width_mm
            for side, leg in zip(there.sides, there.legs, strict=True)
            if side not in (one, other)
        ]
        return all(
            (side.line in self._sure and self._has_two_pens)
            or any(max(mm, own) < OTHER_PEN * min(mm, own) for own in others)
            for side, mm in zip((one, other), widths_mm, strict=True)
        )

    def _whole_mm(self, side: Side) -> float:
        """The width of all of a side's line, if that tells its pen: an arrowhead that touches the line next
        to a junction makes it wider there.
        """
        if side.line in self._sure:
            return self.junctions.net.lines[side.line].width_mm
        return self.junctions.at(side).leg(side).width_mm

    @cached_property
    def _sure(self) -> set[int]:
        """The lines, by their numbers, that are clean for long enough to tell their pens."""
        lines = self.junctions.net.lines
        clean_mm = [sum(run.length_mm for run in line.runs) for line in lines]
        return {n for n, line in enumerate(lines) if clean_mm[n] > SURE_WIDTHS * line.width_mm}

    @cached_property
    def _has_two_pens(self) -> bool:
        """Whether no line is about as wide as what parts the wide from the narrow ones."""
        sure = [self.junctions.net.lines[n] for n in self._sure]
        widths_mm = np.array([line.width_mm for line in sure])
        order = np.argsort(widths_mm)
        share = np.cumsum(np.array([line.length_mm for line in sure])[order])
        if not len(share):
            return False
        between = widths_mm[order][1:] > WIDER * widths_mm[order][:-1]
        return bool(np.any(between & (np.abs(share[:-1] / share[-1] - 0.5) < 0.5 - PENS_SHARE)))
