"""Own rims: closed lines that touch, each as the way within the rim towards the paper on one side of it.

    ╭────────╮╭───╮      lines that touch share their ink for a while: legs tell little of how each goes on,
    │        ││   │      and between two touches there may be none. But each has a side along which no other
    ╰────────╯╰───╯      line comes by: the paper within it, or that about all of them

The cells feel the rim of a patch towards each area of paper; the way of the pen lies half a width within it.
Where it runs along a line that was found it is that (see `kept_parts`). Of all sets of such ways, and lobes
(see `lobes`), that explain the ink of the patch one turns least: its ways are the lines, if those that were
found leave ink, or cross.

Signals: the set-up, a patch of ink and the lines that were found on it in; the lines out.

Source: our own (see `ink.rim`). Questions: a line that others touch on both its sides has no such rim.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.crossings import crossings_of
from morfax.motion.polyline import (
    closed_up,
    evenly,
    length_mm,
    nearest_mm,
    plain,
    turned_rad,
)
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.lettering import lettering
from morfax.tracer.following.line import Line
from morfax.tracer.ink.crossing_on_ink import OFF
from morfax.tracer.ink.rim import Rim, felt_rim
from morfax.tracer.limits import ABOUT_WIDTHS, AS_WIDE, CLEAR_WIDTHS, LONGER_WIDTHS
from morfax.tracer.program.against_ink.window import view_about
from morfax.tracer.program.laid.kept_parts import KeptWay
from morfax.tracer.program.laid.line_parts import is_bare, is_clear, run_anew
from morfax.tracer.program.laid.lobes import lobes
from morfax.tracer.program.laid.patch_ink import PatchInk
from morfax.tracer.program.laid.rim_loops import DISTINCT, felt_pen_mm, outlines_of
from morfax.tracer.program.laid.rim_way import RimWay, kinks_of
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import beside_itself
from morfax.tracer.tangles.seen_ink import DIFFER

MOST_AREAS = 12  # of paper: of more all sets would take seconds, ...
LONGEST = 4000.0  # widths of ink: ... and so would longer ones
ON = 0.1  # widths: a way that is so near to another, or to a polygon, is on it
END_RAD = math.pi / 2  # an end of a line counts as so much turning, ...
LEFT_RAD = 1.0  # ... and so does ink that is left, a square of the width
LESS_RAD = 0.5  # so much less turning is less
# ways that do not cross may turn by so much more than one that does: two that touch turn by twice the angle
# at which that crosses itself
SAME_RAD = 0.15
MISSED = 0.5  # of a box: along so much ink some line was missed; a corner that is cut leaves up to 0.3
BETTER = (
    0.5  # of what the lines that were found leave: ways that leave less explain the ink better
)


def within_own_rims(setup: Setup, patch: int, lines: list[Line]) -> list[Line]:
    """The lines of a patch of ink as they were found, in the same list, or each within its own rim."""
    rims = OwnRims(setup, patch, lines)
    return lines if not rims.are_asked else rims.lines_told()


@dataclass(frozen=True, eq=False)
class OwnRims:
    """The rims of a patch of ink, and the lines that were found on it."""

    setup: Setup
    patch: int
    lines: list[Line]

    @property
    def are_asked(self) -> bool:
        """Whether the patch may be closed lines that touch, and those that were found may be others."""
        # of most patches it is no more than two outlines; to feel a pen takes longer
        return self.are_of(range(3, MOST_AREAS + 1))

    def are_of(self, areas: range) -> bool:
        """Whether the patch has sides towards so many areas of paper, shows where a pen was, and may be other
        closed lines than those that were found.
        """
        sheet, operator = self.setup.sheet, self.setup.operator
        if len(self.outlines) not in areas:
            return False
        if float(sheet.lengths_mm[self.patch]) > LONGEST * self.pen_mm:
            return False
        if not is_clear(sheet.drawing) or not all(map(is_bare, self.lines)):
            return False
        # letters are looked for on the whole sheet
        return not operator.reads_marks(self.lines) and self.patch not in lettering(sheet)

    @cached_property
    def outlines(self) -> list[Array]:
        """The outlines of the ink, towards each area of paper."""
        return outlines_of(self.setup.sheet, self.patch)

    @cached_property
    def pen_mm(self) -> float:
        """The width of its lines, as the cells feel it."""
        sheet, aperture_mm = self.setup.sheet, self.setup.settings.aperture_mm
        return felt_pen_mm(sheet, aperture_mm, float(sheet.widths_mm[self.patch]))

    @cached_property
    def ink(self) -> PatchInk:
        """The ink of the patch."""
        return PatchInk.of(self.setup.sheet, self.patch, self.pen_mm)

    @cached_property
    def own_mm(self) -> Array:
        """How far the ink's places are from the lines that were found."""
        return np.min([self.ink.away_mm(way_of(line)) for line in self.lines], axis=0)

    def _crosses_itself(self, line: Line) -> bool:
        """Whether a closed line crosses itself."""
        if line.is_open:
            return False
        way = evenly(line.loop_mm, STEP_WIDTHS * self.pen_mm)
        return len(crossings_of(way, np.arange(len(way) - 1))) > 0

    def lines_told(self) -> list[Line]:
        """The lines as they were found, or those within the rims that explain the ink better."""
        ways = self._better_ways()
        if not ways:
            return self.lines
        longest_first = sorted(ways, key=lambda way: -length_mm(closed_up(way.way)))
        return [way.kept.line(self.setup) or self.run(way.way) for way in longest_first]

    def _better_ways(self) -> list[RimWay]:
        """Of the sets of ways within the rims that explain the ink, where the lines that were found run
        elsewhere, the first that does so better; none if none does.
        """
        for ways in self._sets():
            away_mm = np.min([way.away_mm for way in ways], axis=0)
            changed = self._changed(ways)
            explain = changed.any() and self.ink.worst(away_mm, changed) < OFF
            if explain and self._are_better(ways, away_mm, changed):
                return ways
        return []

    def _changed(self, ways: Sequence[RimWay]) -> NDArray[np.bool_]:
        """Which of the ink's places are about what is laid of some ways, or what they leave of the lines that
        were found.
        """
        new, old = np.vstack([way.even for way in ways]), self._own_places
        is_left = nearest_mm(old, new) > AS_WIDE * self.pen_mm
        moved = np.vstack([old[is_left], *(way.kept.laid_mm for way in ways)])
        return nearest_mm(self.ink.places_mm, moved) < CLEAR_WIDTHS * self.pen_mm

    def _are_better(
        self, ways: Sequence[RimWay], away_mm: Array, changed: NDArray[np.bool_]
    ) -> bool:
        """Whether some ways within the rims, so far from the ink's places (n,), that explain it where they
        were laid, do so better than the lines that were found: these miss some ink, or turn and leave more.
        One that crosses itself counts as one with an end, if it leaves much more, or beside its lobes; else
        it need not turn more.
        """
        own_mm, ink, own_rad = self.own_mm, self.ink, self._own_rad
        if (most := ink.worst(own_mm)) > MISSED:
            return ink.worst(away_mm) < BETTER * most
        # where both leave as much, the head's own parts are kept
        changed = changed & (np.abs(ink.wrong(away_mm) - ink.wrong(own_mm)) > DIFFER)
        left, own_left = (ink.left(each, changed) for each in (away_mm, own_mm))
        worst, own_worst = (ink.worst(each, changed) for each in (away_mm, own_mm))
        less_rad = -SAME_RAD if worst < BETTER * own_worst and own_worst > OFF else LESS_RAD
        if any(map(self._crosses_itself, self.lines)):
            leave_less = left < BETTER * own_left and worst < BETTER * own_worst
            less_rad = LESS_RAD - END_RAD if leave_less else -SAME_RAD
        if any(way is lobe for way in ways for lobe in self._lobes):
            less_rad = -END_RAD
        turned_rad = sum(way.turned_rad for way in ways)
        return turned_rad + LEFT_RAD * left < own_rad + LEFT_RAD * own_left - less_rad

    @cached_property
    def _own_rad(self) -> float:
        """By how much the lines that were found turn in all."""
        return sum(map(self._turned_rad, self.lines))

    @cached_property
    def _own_places(self) -> Array:
        """Places along the lines that were found, a step apart, (n, 2) mm."""
        step_mm = STEP_WIDTHS * self.pen_mm
        return np.vstack(
            [
                evenly(line.places_mm if line.is_open else closed_up(line.loop_mm), step_mm)
                for line in self.lines
            ]
        )

    def _turned_rad(self, line: Line) -> float:
        """By how much a line turns; an end of an open one counts as a corner."""
        polygon = plain(way_of(line), ON * self.pen_mm)
        return turned_rad(polygon, is_closed=not line.is_open) + 2 * END_RAD * line.is_open

    def _sets(self) -> Iterator[list[RimWay]]:
        """All sets of the ways within the rims, those that turn least first.

        No way has a kink where it lies on another: there lines end, or cross.
        """
        near_mm, beyond = ON * self.pen_mm, round(LONGER_WIDTHS / STEP_WIDTHS)
        ways = [*self.within(round_bars=False), *self._lobes]
        are_kinked = np.array(
            [[one.has_kink_on(other, near_mm, beyond) for other in ways] for one in ways]
        )
        numbers = range(len(ways))
        sets = [
            (sum(ways[k].turned_rad for k in some), some)
            for count in numbers
            for some in combinations(numbers, count + 1)
            if not are_kinked[np.ix_(some, some)].any()
        ]
        # most leave much of the ink bare: it takes less to see that than how well they explain it
        is_bare = np.array([self._is_bare(way.away_mm) for way in ways])
        seen = self.ink.seen
        most = self._is_bare(self.own_mm).sum() + MISSED * seen.width_mm**2 / seen.area_mm2
        for _, some in sorted(sets):
            if is_bare[list(some)].all(axis=0).sum() < most:
                yield [ways[k] for k in some]

    def _is_bare(self, away_mm: Array) -> NDArray[np.bool_]:
        """Which of the ink's places are beyond a pen along ways that are so far from them (n,)."""
        seen = self.ink.seen
        return (seen.darkness > INK) & (away_mm > (0.5 + AS_WIDE) * seen.width_mm)

    def run(self, way: Array) -> Line:
        """The head's run along a closed way from memory."""
        return run_anew(self.setup, self.lines[0], way, self.pen_mm)

    def within(self, *, round_bars: bool) -> Iterator[RimWay]:
        """The ways within the rims, those that go round bars of ink too if they are wanted."""
        for outline in self.outlines:
            rim = self._felt(outline)
            if rim is None:
                continue
            corners = rim.corners(0.5 * self.pen_mm)
            way = corners.likest(self.ink.places_mm, self._left, CLEAR_WIDTHS * self.pen_mm)
            rim_way = self._rim_way(way[_are_apart(way, DISTINCT * STEP_WIDTHS * self.pen_mm)])
            if round_bars or not self._goes_round_a_bar(rim_way.even):
                yield rim_way

    @cached_property
    def _lobes(self) -> list[RimWay]:
        """The lobes of lines that turn where they cross themselves; their tips may lie on other lines."""
        ways = [(lobe[:1], self._rim_way(lobe)) for lobe in lobes(self.lines, self.pen_mm)]
        about_mm = CLEAR_WIDTHS * self.pen_mm
        return [
            way.without_kinks(nearest_mm(way.even[way.kinks], tip) < about_mm)
            for tip, way in ways
        ]

    def _rim_way(self, way: Array) -> RimWay:
        """A closed way as it is compared with others, with the parts of lines along which it runs."""
        kept = KeptWay.of(way, self.lines, self.pen_mm)
        way = kept.places_mm if kept.kept else way
        polygon = plain(closed_up(way), ON * self.pen_mm)
        even = evenly(closed_up(way), STEP_WIDTHS * self.pen_mm)
        away_mm = self.ink.away_mm(closed_up(way))
        turns_rad = turned_rad(polygon, is_closed=True)
        return RimWay(way, kept, even, away_mm, turns_rad, kinks_of(even))

    def _goes_round_a_bar(self, even: Array) -> bool:
        """Whether a closed way (n, 2), a step from place to place, comes beside itself where no line does."""
        step_mm, near_mm = STEP_WIDTHS * self.pen_mm, AS_WIDE * self.pen_mm
        return any(
            nearest_mm(even[np.arange(first, last + 1) % len(even)], self._own_places).max()
            > near_mm
            for first, last in beside_itself.stretches(even, step_mm, self.pen_mm)
        )

    def _left(self, way: Array) -> Array:
        """What a pen along a way (n, 2) mm leaves at each of the ink's places, in squares of the width."""
        return self.ink.seen.left_at(self.ink.wrong(self.ink.away_mm(way)))

    def _felt(self, outline: Array) -> Rim | None:
        """The rim that the cells feel about an outline."""
        sheet, aperture_mm = self.setup.sheet, self.setup.settings.aperture_mm
        reach_mm = ABOUT_WIDTHS * self.pen_mm
        return felt_rim(view_about(sheet, aperture_mm, self.pen_mm, outline, reach_mm), outline)


def way_of(line: Line) -> Array:
    """Places along a line, without the lead line of a closed one, (n, 2) mm."""
    return line.places_mm if line.is_open else line.loop_mm


def _are_apart(way: Array, least_mm: float) -> NDArray[np.bool_]:
    """Which places (n, 2) of a closed way are so far from the one before."""
    return np.asarray(np.hypot(*np.diff(way, axis=0, prepend=way[-1:]).T) > least_mm)
