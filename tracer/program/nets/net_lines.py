"""The lines of a net, by its junctions: closed ways, and strokes that go across from end to end.

Signals: a set-up and a patch of ink in; its lines out, the longest closed one first.

    ╭──┬──────╮      the outline; closed lines within it; strokes with two free ends
    │  │ ╭──╮ │
    ╰──┴─┤  ├─┼─     bars and hatching are none: most of a way round them is along other lines
         ╰──╯ │

Each junction is solved once, with all its legs, so that all lines through it agree. The head is put down once
for each line, and never for a trial.

Source: our own. Questions: a line whose bays run together makes a net too, of which junctions show only the
way past the bays. Such a net is not clear, and the head looks for its way itself (see `net_outline`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.neighbours import Neighbours
from morfax.tracer.following.line import Line
from morfax.tracer.following.start import ends_of
from morfax.tracer.limits import OWN_WIDTHS
from morfax.tracer.marks.marks import longest_mm
from morfax.tracer.program.lines.selection import (
    LETTER_MM,
    NEW,
    SHORT,
    Contour,
    least_mm,
)
from morfax.tracer.program.nets.centre_crosses import is_centre_cross
from morfax.tracer.program.nets.net_outline import (
    CLOSES,
    NEARLY_ALL,
    are_nets,
    chain_mm,
    goes_round,
    junctions_of,
    line_along,
    may_solve,
    outline_of,
    touches_itself,
)
from morfax.tracer.program.nets.open_ink import can_stand, strokes_of
from morfax.tracer.program.setup import Setup

if TYPE_CHECKING:
    from morfax.tracer.ink.chains import Chain
    from morfax.tracer.ink.outlines import Outline


def net_of(setup: Setup, contour: Contour) -> NetLines | None:
    """The net that a patch is, if lines cross or touch on it, none of which comes from a reference point."""
    patch = contour.stroke.patch
    if not may_solve(setup) or not are_nets(setup.sheet)[patch] or _is_lead(setup, contour):
        return None
    return NetLines(setup, patch, contour.number)


def lines_of_ring(setup: Setup, contour: Contour, reads_marks: bool) -> list[Line]:
    """The lines of a patch that goes round one area and on which lines meet, by its junctions: closed ones,
    or of a small patch strokes. None if these do not show what was drawn, or come from a reference point, nor
    where marks are read and lines may end in these.
    """
    stroke = contour.stroke
    if not may_solve(setup) or not goes_round(setup.sheet, stroke.patch, 1):
        return []
    if not len(stroke.ends_mm) or _is_lead(setup, contour):
        return []
    net = NetLines(setup, stroke.patch, contour.number)
    if not (net.forks and net.is_clear):
        return []
    if net.comes_round:
        # the head reads marks
        return [] if reads_marks and net.ends_in_marks else net.round_about()
    if contour.reach_mm >= LETTER_MM or not can_stand(setup, contour):
        return []
    return strokes_of(setup, stroke.patch, contour.number)


def _is_lead(setup: Setup, contour: Contour) -> bool:
    """Whether a line of a patch comes from a reference point."""
    sheet, operator = setup.sheet, setup.operator
    ends = ends_of(sheet, contour.stroke, setup.settings, operator.reference_mm)
    leads = [stance for stance, _ in ends if stance.reference_mm is not None]
    if not leads or operator.reference_mm is not None:
        return bool(leads)
    junctions = junctions_of(setup, contour.stroke.patch)
    return not all(is_centre_cross(junctions, stance) for stance in leads)


class NetLines:
    """The lines of a net that its junctions show."""

    def __init__(self, setup: Setup, patch: int, number: int) -> None:
        """Solve the junctions of a patch; all its lines have the patch's number."""
        self._setup, self._number = setup, number
        self._junctions = junctions_of(setup, patch)
        self._ink_mm = float(setup.sheet.lengths_mm[patch])
        self._width_mm = float(setup.sheet.widths_mm[patch])

    @property
    def is_clear(self) -> bool:
        """Whether the junctions show its lines: it is not one line that touches itself."""
        from morfax.tracer.ink.closed_ways import only_cross
        from morfax.tracer.ink.outlines import straight_chains

        if not touches_itself(self._junctions):
            return True
        least_mm = NEARLY_ALL * sum(line.length_mm for line in self._junctions.net.lines)
        if _length_mm(straight_chains(self._junctions)) > least_mm:
            return True
        ways = self._closed_ways
        crosses = len(ways) > 1 and only_cross(ways, self._junctions)
        return crosses and _length_mm(ways) > least_mm

    @cached_property
    def _closed_ways(self) -> list[Outline]:
        """All closed ways."""
        from morfax.tracer.ink.closed_ways import closed_ways

        return list(closed_ways(self._junctions, set(), NEW))

    @property
    def ends_in_marks(self) -> bool:
        """Whether all lines that end are as short as marks across a line, or there is none."""
        net, view = self._junctions.net, self._junctions.net.lines[0].runs[0].view
        ends = [line for line in net.lines if not net.free_ends.isdisjoint(line.junctions)]
        return all(line.length_mm < longest_mm(view) for line in ends)

    @cached_property
    def _longest_round(self) -> Outline | None:
        """The longest closed way; None if it leaves out much of a stroke that does not come round."""
        junctions = self._junctions
        strokes_mm = (chain_mm(chain, junctions) for chain in junctions.chains())
        least_mm = CLOSES * max(strokes_mm, default=0.0)
        longest = max(self._closed_ways, key=lambda way: way.length_mm, default=None)
        return longest if longest is not None and longest.length_mm > least_mm else None

    @property
    def comes_round(self) -> bool:
        """Whether a closed way goes along most of it; the head has not run yet."""
        return self._longest_round is not None

    def round_about(self) -> list[Line]:
        """All lines, the longest closed one first, however short that is; none if it does not come round."""
        longest = self._longest_round
        if longest is None:
            return []
        return self.lines() or [self._run(longest.chain)]

    @property
    def forks(self) -> bool:
        """Whether lines meet: it is no single line with sharp bends."""
        return any(len(there.sides) > 2 for there in self._junctions.by_number.values())

    def between_ends(self, contour: Contour) -> Line | None:
        """The outline, where the head would be put down at open ends, and straight on leads from each to
        another: from there it would find no closed line. None if it may find one.
        """
        from morfax.tracer.ink.outlines import ends_freely, is_free

        junctions, setup = self._junctions, self._setup
        from_ends = [chain for chain in junctions.chains() if ends_freely(chain, junctions)]
        if not from_ends or not all(is_free(chain, junctions) for chain in from_ends):
            return None
        if not ends_of(
            setup.sheet, contour.stroke, setup.settings, setup.operator.reference_mm
        ):
            return None
        outline = outline_of(setup, contour.stroke.patch)
        return None if outline is None else replace(outline, number=self._number)

    def lines(self) -> list[Line]:
        """All lines, the longest closed one first."""
        found = self._besides(set())
        return sorted(found, key=lambda line: (line.ending != "closed", -line.length_mm))

    def besides(self, line: Line) -> list[Line]:
        """The lines beside one that was followed."""
        near_mm, way = OWN_WIDTHS * self._width_mm, Neighbours(line.places_mm)
        followed = {
            n
            for n, felt in enumerate(self._junctions.net.lines)
            if np.mean(way.nearest(felt.places_mm)[0] < near_mm) > NEW
        }
        return self._besides(followed)

    def _besides(self, taken: set[int]) -> list[Line]:
        """The lines beside those lines of the net that are taken."""
        from morfax.tracer.ink.closed_ways import closed_ways, share_beside
        from morfax.tracer.ink.outlines import is_free

        junctions, shortest_mm = self._junctions, float(least_mm(self._width_mm))
        ways = closed_ways(junctions, taken, NEW) if taken else self._closed_ways
        closed = [way.chain for way in ways]
        taken = taken.union(*({link.line for link in chain.links} for chain in closed))
        across = [
            chain
            for chain in junctions.chains()
            if is_free(chain, junctions) and share_beside(chain, taken, junctions) > NEW
        ]
        return [
            self._run(chain)
            for chain in closed + across
            if chain_mm(chain, junctions) > (shortest_mm if chain.closed else LETTER_MM)
        ]

    def _run(self, chain: Chain) -> Line:
        """The head's run along a chain."""
        line = line_along(self._setup, chain, self._junctions)
        return replace(line, number=self._number, ink_mm=self._ink_mm)


def _length_mm(ways: Iterable[Outline]) -> float:
    """The length of some ways, mm."""
    return sum(way.length_mm for way in ways)


def or_outline(setup: Setup, contour: Contour, line: Line | None) -> Line | None:
    """A line that was followed on a patch; where it is a smaller part of a net, the net's outline."""
    if line is None or line.reference_mm is not None or line.is_lead:
        return line
    if line.ending == "closed" and line.length_mm > SHORT * line.ink_mm:
        return line
    outline = outline_of(setup, contour.stroke.patch)
    if outline is None or (line.ending == "closed" and outline.length_mm < line.length_mm):
        return line
    return replace(outline, number=contour.number)
