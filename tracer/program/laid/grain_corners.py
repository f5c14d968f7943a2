"""Corners in grain: the slit through which a pencil's line is seen rounds its corners; they are laid by the
ink as it was drawn.

    ───╮      near a corner the slit, which is longer than the line is wide, sees paper beside both sides: the
        │     head cuts the corner by 0.1 to 0.3 mm

Where the way turns off, its straight legs beyond the slit's reach tell where the sides meet. Held against the
ink before the slit, grain and all, that corner counts, sharp or by one of some rounds, unless the head's own
way explains the ink better, as on a small hole. The head runs along it from memory.

Signals: the sheet and lines in; the lines with their corners out.

Source: our own. Questions: corners nearer to one another than the slit's reach stay as they are.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import CORNER_RAD
from morfax.tracer.drawing import grain
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.own_ink import OwnInk
from morfax.tracer.program.laid.bay_run import Bay
from morfax.tracer.program.laid.cut_corners import met
from morfax.tracer.program.laid.line_parts import is_whole
from morfax.tracer.program.laid.way_ink import Relaid, WayInk
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import folding_rule
from morfax.tracer.tangles.folding_rule import Rule
from morfax.tracer.tangles.seen_ink import SeenInk

# Chosen on plates drawn with a pencil, grain of 35 %:
LEG = 1.5  # of the slit's reach: a leg is so long
BENT = 0.15  # widths: a leg that bends by more tells no corner
# rounds are tried that begin up to so many reaches before the corner; longer ones reach into the legs
ROUNDS, LONGEST = 6, 1.2
# squares of the width that grain leaves to chance: a round leaves so much less than the sharp corner, and the
# head's way, of which the slit has rounded each corner, as much less than both
BY_CHANCE, OWN = 0.07, 0.2


def with_grain_corners(setup: Setup, own: OwnInk) -> OwnInk:
    """Lines, held against their ink, with the corners that the slit has rounded; as they are on a sheet that
    is seen without one.
    """
    if own.drawing.drawn is None or setup.operator.reads_marks(own.lines):
        return own
    every = BoxedLines.of(own.lines)
    mended = [_GrainCorners(setup, line, every).mended() for line in own.lines]
    return own.mended([relaid.line for relaid in mended])


@dataclass(frozen=True)
class _GrainCorners(WayInk):
    """The corners of one of some lines that are seen through a slit."""

    @property
    def drawing(self) -> Drawing:
        """The sheet as it was drawn."""
        return self.setup.sheet.drawing.as_drawn

    def mended(self) -> Relaid:
        """The line as it is, or along the corners that its ink shows."""
        if not is_whole(self.line) or self.line.as_told:
            return self.along([])
        reach = round(grain.reach_mm(self.line.width_mm) / self.step_mm)
        leg = round(LEG * reach)
        turns = self.corners_at(reach * STEP_WIDTHS, CORNER_RAD)
        found = (self._bay(at - reach - leg, at + reach + leg, leg) for at in turns)
        return self.along([bay for bay in found if bay is not None])

    def _bay(self, first: int, last: int, leg: int) -> Bay | None:
        """The corner in place of a stretch with two legs of so many places, if the ink shows it."""
        own = self.own(first, last)
        corner = None if own is None else met(*_legs(own, leg), BENT * self.line.width_mm)
        seen = None if corner is None else self.about(first, last, corner[None])
        if corner is None or seen is None:
            return None
        ink = _evenly_dark(seen.ink, seen.own)
        rules = list(self._rules(seen.own, corner))
        left = [ink.misfit_along(rule.way) + BY_CHANCE * rule.rounded.any() for rule in rules]
        best, gain = int(np.argmin(left)), ink.misfit_along(seen.own) + OWN - min(left)
        if gain <= 0 or best == ROUNDS:  # or a longer one
            return None
        return self.as_bay(first, last, rules[best], gain)

    def _rules(self, own: Array, corner: Array) -> Iterator[Rule]:
        """The sharp corner between the ends of a stretch (n, 2) mm, and its rounds."""
        rule = folding_rule.sharp(own[0], own[-1], corner[None], 0.5 * self.line.width_mm)
        yield rule
        turned = folding_rule.turned_rad(own[0], corner, own[-1])
        longest_mm = LONGEST * grain.reach_mm(self.line.width_mm)
        for round_mm in np.linspace(0, longest_mm, ROUNDS + 1)[1:]:
            radius_mm = float(round_mm) / math.tan(0.5 * turned)
            yield rule._replace(rounded=np.ones(1, np.bool_), radius_mm=radius_mm)


def _legs(own: Array, leg: int) -> tuple[Array, Array]:
    """Both legs of a stretch (n, 2) mm, of so many places, each towards the corner between them."""
    return own[: leg + 1], own[: -leg - 2 : -1]


def _evenly_dark(ink: SeenInk, way: Array) -> SeenInk:
    """The ink about a way (n, 2) mm as dark on it as the pen's is drawn."""
    drawn = ink.drawn_along(way, ink.half_mm)
    return ink._replace(darkness=ink.darkness * np.sum(drawn**2) / np.sum(ink.darkness * drawn))
