"""Own rims: closed lines that touch, each as the way within the rim towards the paper on one side of it.

    ╭────────╮╭───╮      lines that touch share their ink for a while: legs tell little of how each goes on,
    │        ││   │      and between two touches there may be none. But each has a side along which no other
    ╰────────╯╰───╯      line comes by: the paper within it, or that about all of them

The cells feel the rim of a patch towards each area of paper; the way of the pen lies half a width within it.
Of all sets of such ways that explain the ink of the patch one turns least: its ways are the lines, if those
that were found leave ink, or cross where these explain it better.

Signals: the set-up, a patch of ink and the lines that were found on it in; the lines out.

Source: our own (see `ink.rim`). Questions: a line that others touch on both its sides has no such rim.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.crossings import crossings_of
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.plane import BEND_RAD
from morfax.motion.polyline import (
    between_corners,
    closed_up,
    evenly,
    length_mm,
    nearest_mm,
    plain,
)
from morfax.tracer.drawing.lettering import lettering
from morfax.tracer.following.line import Line
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.head.stance import Stance
from morfax.tracer.ink.crossing_on_ink import OFF
from morfax.tracer.ink.rim import Rim, RimCorners, felt_rim
from morfax.tracer.limits import ABOUT_WIDTHS, AS_WIDE, CLEAR_WIDTHS, LONGER_WIDTHS
from morfax.tracer.program.against_ink.window import view_about
from morfax.tracer.program.laid.line_parts import closed_anew, is_bare, is_clear
from morfax.tracer.program.laid.patch_ink import PatchInk
from morfax.tracer.program.laid.rim_loops import DISTINCT, LONGEST, felt_pen_mm, outlines_of
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import beside_itself

MOST_AREAS = 8  # of paper: of more all sets would take seconds
ON = 0.1  # widths: a way that is so near to another, or to a polygon, is on it
END_RAD = math.pi / 2  # an end of a line counts as so much turning, ...
LEFT_RAD = 1.0  # ... and so does ink that is left, a square of the width
LESS_RAD = 0.5  # so much less turning is less
KINK_OVER = 1.0  # widths to either side of a place, by how much a way turns there
BETTER = 0.5  # of what lines leave that cross: ways that leave less explain the ink better


def within_own_rims(setup: Setup, patch: int, lines: Sequence[Line]) -> list[Line]:
    """The lines of a patch of ink as they were found, or each within its own rim."""
    rims = _OwnRims(setup, patch, lines)
    return list(lines) if not rims.are_asked else rims.lines_told()


class _Way(NamedTuple):
    """A closed way (n, 2) mm, not closed up, at a step from place to place; how far the ink's places are from
    it; by how much it turns in all; and at which of its places it has a kink.
    """

    way: Array
    even: Array
    away_mm: Array
    turned_rad: float
    kinks: NDArray[np.int64]

    def has_kink_on(self, other: _Way, near_mm: float, beyond: int) -> bool:
        """Whether a kink lies on another way, or on this one further on by so many places."""
        if other is not self:
            return bool((nearest_mm(self.even[self.kinks], other.even) < near_mm).any())
        count = len(self.even)
        for kink in self.kinks.tolist():
            further = self.even[(kink + np.arange(beyond, count - beyond)) % count]
            if nearest_mm(self.even[kink : kink + 1], further).min(initial=math.inf) < near_mm:
                return True
        return False


@dataclass(frozen=True, eq=False)
class _OwnRims:
    """The rims of a patch of ink, and the lines that were found on it."""

    setup: Setup
    patch: int
    lines: Sequence[Line]

    @property
    def are_asked(self) -> bool:
        """Whether the patch may be closed lines that touch, and those that were found may be others."""
        sheet, operator = self.setup.sheet, self.setup.operator
        # of most patches it is no more than two outlines; to feel a pen takes longer
        if not 2 < len(self.outlines) <= MOST_AREAS:
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
    def _own_mm(self) -> Array:
        """How far the ink's places are from the lines that were found."""
        ways = [line.places_mm if line.is_open else line.loop_mm for line in self.lines]
        return np.min([self.ink.away_mm(way) for way in ways], axis=0)

    def _crosses_itself(self, line: Line) -> bool:
        """Whether a closed line crosses itself."""
        if line.is_open:
            return False
        way = evenly(line.loop_mm, STEP_WIDTHS * self.pen_mm)
        return len(crossings_of(way, np.arange(len(way) - 1))) > 0

    def lines_told(self) -> list[Line]:
        """The lines as they were found, or those within the rims that explain the ink."""
        own_rad = sum(map(self._turned_rad, self.lines)) + LEFT_RAD * self.ink.left(
            self._own_mm
        )
        ways = self._fewest_turns(own_rad - LESS_RAD + END_RAD)
        if not ways or self._are_as_found(ways) or not self._are_better(ways, own_rad):
            return list(self.lines)
        longest_first = sorted(ways, key=lambda way: -length_mm(closed_up(way.way)))
        return [self._run(way.way) for way in longest_first]

    def _are_as_found(self, ways: Sequence[_Way]) -> bool:
        """Whether some ways are the lines that were found."""
        near_mm, loops = AS_WIDE * self.pen_mm, [line.loop_mm for line in self.lines]
        return len(ways) == len(loops) and all(
            any(
                nearest_mm(way.even, loop).max() < near_mm
                and nearest_mm(loop, way.even).max() < near_mm
                for loop in loops
            )
            for way in ways
        )

    def _are_better(self, ways: Sequence[_Way], own_rad: float) -> bool:
        """Whether some ways within the rims turn and leave less than the lines that were found; one that
        crosses itself counts as one with an end, if it leaves much more.
        """
        own_mm, ink = self._own_mm, self.ink
        away_mm = np.min([way.away_mm for way in ways], axis=0)
        left = ink.left(away_mm)
        leave_less = left < BETTER * ink.left(own_mm)
        if leave_less and ink.worst(away_mm) < BETTER * ink.worst(own_mm):
            own_rad += END_RAD * any(map(self._crosses_itself, self.lines))
        return sum(way.turned_rad for way in ways) + LEFT_RAD * left < own_rad - LESS_RAD

    def _turned_rad(self, line: Line) -> float:
        """By how much a line turns; an end of an open one counts as a corner."""
        polygon = plain(line.places_mm if line.is_open else line.loop_mm, ON * self.pen_mm)
        return _turned_rad(polygon, is_closed=not line.is_open) + 2 * END_RAD * line.is_open

    def _fewest_turns(self, most_rad: float) -> list[_Way]:
        """Those of the ways within the rims that explain the ink, and turn least, and by less than that; none
        if all do not.

        No way has a kink where it lies on another: there lines end, or cross.
        """
        near_mm, beyond = ON * self.pen_mm, round(LONGER_WIDTHS / STEP_WIDTHS)
        ways = [way for way in self._ways() if way.turned_rad < most_rad]
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
        for turned_rad, some in sorted(sets):
            if turned_rad > most_rad:
                break
            if self.ink.worst(np.min([ways[k].away_mm for k in some], axis=0)) < OFF:
                return [ways[k] for k in some]
        return []

    def _ways(self) -> Iterator[_Way]:
        """The ways within the rims."""
        for outline in self.outlines:
            rim = self._felt(outline)
            if rim is None:
                continue
            way = self._likest(rim.corners(0.5 * self.pen_mm))
            way = way[_are_apart(way, DISTINCT * STEP_WIDTHS * self.pen_mm)]
            polygon = plain(closed_up(way), ON * self.pen_mm)
            even = evenly(closed_up(way), STEP_WIDTHS * self.pen_mm)
            if beside_itself.stretches(even, STEP_WIDTHS * self.pen_mm, self.pen_mm):
                continue  # it goes round a bar
            turned_rad = _turned_rad(polygon, is_closed=True)
            yield _Way(way, even, self.ink.away_mm(closed_up(way)), turned_rad, _kinks(even))

    def _felt(self, outline: Array) -> Rim | None:
        """The rim that the cells feel about an outline."""
        sheet, aperture_mm = self.setup.sheet, self.setup.settings.aperture_mm
        reach_mm = ABOUT_WIDTHS * self.pen_mm
        return felt_rim(view_about(sheet, aperture_mm, self.pen_mm, outline, reach_mm), outline)

    def _likest(self, corners: RimCorners) -> Array:
        """The way with those corners sharp that explain the ink better so."""
        sharp, round_ = corners.mitred(), corners.way
        off = [self.ink.wrong(self.ink.away_mm(closed_up(way))) ** 2 for way in (sharp, round_)]
        are_sharp = np.zeros(len(corners.at), bool)
        near_mm = CLEAR_WIDTHS * self.pen_mm
        for k, (first, last) in enumerate(corners.at.tolist()):
            middle = corners.way[(first + last) // 2 % len(corners.way)]
            about = np.hypot(*(self.ink.places_mm - middle).T) < near_mm
            are_sharp[k] = off[0][about].sum() <= off[1][about].sum()
        return corners.mitred(are_sharp)

    def _run(self, way: Array) -> Line:
        """The head's run along a closed way from memory."""
        sheet, settings, width_mm = self.setup.sheet, self.setup.settings, self.pen_mm
        stretches = between_corners(closed_up(way))
        ahead = stretches[0][1] - stretches[0][0]
        view = view_about(sheet, settings.aperture_mm, width_mm, way, ABOUT_WIDTHS * width_mm)
        stance = Stance(way[0], math.atan2(ahead[1], ahead[0]), view)
        carriage = Carriage(stance, settings, MOTION_RATE_HZ)
        carriage.run(stretches, leader=REDRAWN)
        xy_mm = carriage.positions_mm
        return closed_anew(self.lines[0], xy_mm, carriage.led, width_mm, length_mm(xy_mm))


def _are_apart(way: Array, least_mm: float) -> NDArray[np.bool_]:
    """Which places (n, 2) of a closed way are so far from the one before."""
    return np.asarray(np.hypot(*np.diff(way, axis=0, prepend=way[-1:]).T) > least_mm)


def _kinks(even: Array) -> NDArray[np.int64]:
    """The places of a closed way (n, 2) at which it turns more than about them."""
    over, count = round(KINK_OVER / STEP_WIDTHS), len(even)
    if count <= 4 * over:
        return np.empty(0, np.int64)
    ahead = np.roll(even, -over, axis=0) - even
    turns = np.arctan2(ahead[:, 1], ahead[:, 0])
    turns = turns - np.roll(turns, over)
    turns -= math.tau * np.round(turns / math.tau)
    about = 0.5 * (np.roll(turns, -2 * over) + np.roll(turns, 2 * over))
    return np.flatnonzero(np.abs(turns) - np.abs(about) > BEND_RAD)


def _turned_rad(polygon: Array, *, is_closed: bool) -> float:
    """By how much a polygon (n, 2), closed up, turns to either side in all."""
    steps = np.diff(polygon, axis=0)
    headings = np.arctan2(steps[:, 1], steps[:, 0])
    turns = np.diff(headings, append=headings[:is_closed])
    return float(np.abs(turns - math.tau * np.round(turns / math.tau)).sum())
