"""Kept parts: where a way within a rim runs along lines that the head ran, it is these lines.

    ══════╮╭══════     the cells felt the rim of all of a patch; but only where lines share their ink is the
    ══════││══════     head's own way in doubt. Elsewhere it is nearer to its line, at corners above all
    ══════╯╰══════

Signals: a closed way and the lines that were found in; the way with the head's own parts in it, and the line
of such parts, with the rest laid between them, out.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.neighbours import Neighbours
from morfax.motion.plane import BEND_RAD, cross
from morfax.motion.polyline import between_corners, closed_up, evenly, length_mm, lengths_mm
from morfax.tracer.following.line import Line
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import LEGS, back_along, is_plain, part_of, run_on
from morfax.tracer.program.laid.rim_bays import to_ends
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS

# In widths of the pen:
ON = 0.02  # a way that is so near to a line runs along it
LEAST = 4.0  # of a part: a leg of what is laid lies on either end of it
CUT = 3.0  # the longest corner at which the rim's way is aside of a line, ...
LONGER = 0.5  # ... if it is no longer than the line's own by more than that
# places that show where the way comes to a corner from, and where it goes on
LEG = round(0.5 / STEP_WIDTHS)
NOWHERE = np.empty((0, 2))


@dataclass(frozen=True, eq=False)
class Kept:
    """A part of a closed way, from one of its places to another, perhaps over its last: that of a line from a
    length along it to another, mm, back along it where that is less; and the length of all of the line.
    """

    first: int
    last: int
    line: Line
    from_mm: float
    to_mm: float
    round_mm: float

    @property
    def is_back(self) -> bool:
        """Whether it goes back along the line."""
        return self.to_mm < self.from_mm

    @property
    def sign(self) -> int:
        """Of a length along the line in its direction: -1 for one that goes back."""
        return -1 if self.is_back else 1

    @property
    def length_mm(self) -> float:
        """Its length."""
        return abs(self.to_mm - self.from_mm)

    def goes_on(self, other: Kept, way: Array, step_mm: float) -> bool:
        """Whether another one behind it is the same line's behind a corner of their way (n, 2) mm."""
        if other.line is not self.line or other.is_back is not self.is_back:
            return False
        apart_mm, width_mm = (other.first - self.last) * step_mm, step_mm / STEP_WIDTHS
        own_mm = self.sign * (other.from_mm - self.to_mm) % self.round_mm
        if apart_mm > CUT * width_mm or abs(own_mm - apart_mm) > LONGER * width_mm:
            return False
        if apart_mm < width_mm:  # on the threshold
            return True
        at = np.array([self.last - LEG, self.last, other.first, other.first + LEG]) % len(way)
        into, out_of = way[at[1]] - way[at[0]], way[at[3]] - way[at[2]]
        return abs(math.atan2(cross(into, out_of), into @ out_of)) > BEND_RAD

    def moved(self, places: int) -> Kept:
        """It so many places further on, which is another round's."""
        return replace(self, first=self.first + places, last=self.last + places)

    def with_more(self, other: Kept) -> Kept:
        """It with another one behind it."""
        more_mm = self.sign * (other.to_mm - self.to_mm) % self.round_mm
        return replace(self, last=other.last, to_mm=self.to_mm + self.sign * more_mm)

    @property
    def is_once(self) -> bool:
        """Whether it goes along no place of the line twice, as a way does that goes round a loop and on."""
        return self.length_mm < self.round_mm or math.isclose(self.length_mm, self.round_mm)

    @cached_property
    def part(self) -> Line:
        """The part of the line."""
        come_mm = lengths_mm(closed_up(self.line.places_mm))
        ends_mm = sorted((self.from_mm, self.to_mm))
        first, last = (int(np.searchsorted(come_mm, mm % come_mm[-1])) for mm in ends_mm)
        count = len(self.line.places_mm)
        last -= first == last  # all of it
        part = part_of(self.line, first % count, last % count)
        return back_along(part) if self.is_back else part


@dataclass(frozen=True, eq=False)
class KeptWay:
    """A closed way (n, 2) mm, a step from place to place, of a pen, with the parts of it that are kept."""

    way: Array
    width_mm: float
    kept: Sequence[Kept]

    @classmethod
    def of(
        cls, way: Array, lines: Sequence[Line], width_mm: float, doubts_mm: Array = NOWHERE
    ) -> KeptWay:
        """The way with the parts of some lines along which it runs, but for what is about some places (n, 2)
        mm in doubt.
        """
        even = evenly(closed_up(way), STEP_WIDTHS * width_mm)[:-1]
        found = [
            kept
            for line in lines
            if is_plain(line)
            for kept in _along(even, line, width_mm, doubts_mm)
        ]
        apart, taken = list[Kept](), np.zeros(len(even), bool)
        for kept in sorted(found, key=lambda kept: kept.first - kept.last):
            at = np.arange(kept.first, kept.last + 1) % len(even)
            if not taken[at].any():
                taken[at] = True
                apart.append(kept)
        return cls(even, width_mm, sorted(apart, key=lambda kept: kept.first))

    @property
    def whole(self) -> Line | None:
        """The line that it is all along; None if it is not one."""
        if len(self.kept) != 1:
            return None
        (kept,) = self.kept
        is_all = kept.last - kept.first >= len(self.way) - 2 * LEG
        is_all = is_all and kept.length_mm > kept.round_mm - LONGER * self.width_mm
        return kept.line if is_all else None

    @cached_property
    def sides(self) -> list[LaidWay]:
        """What is laid, from the end of each part onto a leg of the next, or the first."""
        sides, leg_mm = list[LaidWay](), LEGS[0] * self.width_mm
        for k, kept in enumerate(self.kept):
            onto = self.kept[(k + 1) % len(self.kept)]
            before, behind = kept.part.places_mm, onto.part.places_mm
            ends = np.vstack(
                [before[-1], behind[int(np.searchsorted(lengths_mm(behind), leg_mm))]]
            )
            first, last = self._nearest(ends[0], kept.last), self._nearest(ends[1], onto.first)
            last += len(self.way) * (last < first)
            between = self.way[np.arange(first, last + 1) % len(self.way)]
            side = to_ends(between, ends, leg_mm)
            sides.append(LaidWay(tuple(between_corners(side)), 0.5 * self.width_mm))
        return sides

    def _nearest(self, place_mm: Array, about: int) -> int:
        """The place of the way that is nearest to another one, of those a few widths about one of them."""
        reach = round(LEAST / STEP_WIDTHS)
        at = about + np.arange(-reach, reach + 1)
        away_mm = np.hypot(*(self.way[at % len(self.way)] - place_mm).T)
        return int(at[np.argmin(away_mm)]) % len(self.way)

    @property
    def laid_mm(self) -> Array:
        """Places of the way that are no kept part's, (n, 2) mm."""
        if self.whole is not None:
            return np.empty((0, 2))
        return np.vstack([side.way for side in self.sides]) if self.kept else self.way

    @cached_property
    def places_mm(self) -> Array:
        """The way with its kept parts, (n, 2) mm, not closed up."""
        if self.whole is not None:
            return self.whole.loop_mm
        if not self.kept:
            return self.way
        pieces, leg_mm = list[Array](), LEGS[0] * self.width_mm
        for kept, side in zip(self.kept, self.sides, strict=True):
            part = kept.part.places_mm
            pieces += [part[lengths_mm(part) > leg_mm], side.way[1:]]
        return np.vstack(pieces)

    def line(self, setup: Setup) -> Line | None:
        """The line of the kept parts with the head run along the rest; None if none is kept."""
        if self.whole is not None or not self.kept:
            return self.whole
        return run_on(setup, [kept.part for kept in self.kept], self.sides)


def _along(way: Array, line: Line, width_mm: float, doubts_mm: Array) -> list[Kept]:
    """The parts of a closed way (n, 2) mm that run along a line, apart from some places (m, 2) mm."""
    step_mm, count = STEP_WIDTHS * width_mm, len(way)
    loop = closed_up(line.places_mm)
    round_mm, fine_mm = length_mm(loop), 0.5 * ON * width_mm
    places = evenly(loop, fine_mm)
    away_mm, nearest = Neighbours(places).nearest(way)
    is_on = away_mm < ON * width_mm
    if len(doubts_mm):
        is_on &= Neighbours(doubts_mm).nearest(way)[0] > LEAST * width_mm
    # 1. begun where it is not on the line
    begin = int(np.argmin(is_on))
    changes = np.flatnonzero(
        np.diff(np.roll(is_on, -begin).astype(np.int8), prepend=0, append=0)
    )
    found = list[Kept]()
    for first, last in changes.reshape(-1, 2).tolist():
        at = begin + np.arange(first, last)
        steps_mm = np.diff(fine_mm * nearest[at % count])
        come_mm = float((steps_mm - round_mm * np.round(steps_mm / round_mm)).sum())
        long_mm = (last - first - 1) * step_mm
        if abs(abs(come_mm) - long_mm) > LONGER * width_mm or last - first < 2:
            continue  # across the line, or from one of its sides to another
        from_mm = float(fine_mm * nearest[at[0] % count])
        to_mm = from_mm + come_mm
        found.append(Kept(int(at[0]), int(at[-1]), line, from_mm, to_mm, round_mm))
    # 2. those on both sides of a corner are one
    least = LEAST / STEP_WIDTHS
    joined = _joined(found, way, step_mm)
    return [
        kept.moved(kept.first // count * -count)
        for kept in joined
        if kept.last - kept.first > least and kept.is_once
    ]


def _joined(found: Sequence[Kept], way: Array, step_mm: float) -> list[Kept]:
    """The parts of a closed way (n, 2) mm, those that go on behind a corner as one."""
    joined, count = list[Kept](), len(way)
    for kept in found:
        if joined and joined[-1].goes_on(kept, way, step_mm):
            joined[-1] = joined[-1].with_more(kept)
        else:
            joined.append(kept)
    if not joined or not joined[-1].goes_on(again := joined[0].moved(count), way, step_mm):
        return joined
    if len(joined) > 1:
        return [*joined[1:-1], joined[-1].with_more(again)]
    kept = joined[0]  # all of it
    return [
        replace(
            kept, last=kept.first + count - 1, to_mm=kept.from_mm + kept.sign * kept.round_mm
        )
    ]
