"""The ink about a stretch of a way, and the folding rule that explains it best.

Signals: the sheet, a line and all lines in boxes, and a stretch of the line's way in; the ink about it, in
which the rest of the way and all other lines are known, and the best of some rules, out.

Source: our own.
"""

from __future__ import annotations

import pickle
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha1
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import evenly, length_mm, nearest_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines, parts_of, within
from morfax.tracer.program.against_ink.off_ink import goes_on, ink_about
from morfax.tracer.program.laid.bay_run import Bay, apart, laid
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import OF_LOOP, REACH
from morfax.tracer.program.laid.spline_fit import CORNER_RAD, TURNS_OVER, corners_of, turns_rad
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import distances, folding_rule
from morfax.tracer.tangles.folding_rule import Rule
from morfax.tracer.tangles.seen_ink import SeenInk

# of what a way leaves where a rule draws otherwise: what leaves more explains a blot, or what a rubber left
MOST_LEFT = 0.3
LONGEST = 80.0  # widths of the line: a longer stretch is no bay; by trial on plates with notches and tongues


class BayInk(NamedTuple):
    """A stretch of a way from one of its places to another, as places (n, 2) mm, and the ink about it."""

    first: int
    last: int
    own: Array
    ink: SeenInk


class Relaid(NamedTuple):
    """A line, and the places (n, 2) mm at which it was laid anew: where it ran, and where it runs now."""

    line: Line
    places_mm: Array


@dataclass(frozen=True)
class WayInk:
    """The way of one of some lines, and the ink about it."""

    setup: Setup
    line: Line
    lines: BoxedLines

    @property
    def drawing(self) -> Drawing:
        """The drawing whose ink it is."""
        return self.setup.sheet.drawing

    @property
    def is_closed(self) -> bool:
        """Whether the line comes round."""
        return self.line.ending == "closed"

    @property
    def step_mm(self) -> float:
        """The distance of the way's places."""
        return STEP_WIDTHS * self.line.width_mm

    @cached_property
    def way(self) -> Array:
        """Places (n, 2) mm along the line."""
        line = self.line
        return evenly(line.loop_mm if self.is_closed else line.places_mm, self.step_mm)

    @cached_property
    def round_mm(self) -> float:
        """How long the way is."""
        return length_mm(self.line.places_mm)

    def are_near(self, news: Array | None) -> NDArray[np.bool_]:
        """Which places of the way were not looked at, or lie near to what was laid since, (n, 2) mm: the ink
        about the others is explained as it was.
        """
        if news is None:
            return np.ones(len(self.way), bool)
        return np.asarray(nearest_mm(self.way, news) < REACH * self.line.width_mm)

    def own(self, first: int, last: int) -> Array | None:
        """The stretch (n, 2) mm from one place to another; None if it is too long, or reaches an end."""
        way, long = self.way, last - first
        if long > OF_LOOP * len(way) or long * self.step_mm > LONGEST * self.line.width_mm:
            return None
        if not self.is_closed and not 0 < first < last < len(way) - 1:
            return None
        return np.asarray(way[np.arange(first, last + 1) % len(way)])

    def about(self, first: int, last: int, beyond_mm: Array) -> BayInk | None:
        """The ink about a stretch from one place to another and about some places (n, 2) mm beside it; None
        if that is no stretch, or its ink goes on.
        """
        own = self.own(first, last)
        if own is None:
            return None
        about = np.vstack([own, beyond_mm])
        ink = self._ink(about, first, last)
        return None if goes_on(ink, about, REACH) else BayInk(first, last, own, ink)

    def rest_within(self, first: int, last: int, low: Array, high: Array) -> Iterator[Array]:
        """The parts of the way within a box, but for the stretch from one of its places to another."""
        count, near = len(self.way), within(self.way, low, high)
        if self.is_closed:
            # in the order of the way, from the end of the stretch on
            come = np.sort((near - last) % count)
            yield from parts_of(self.way, last + come[come <= first + count - last])
        else:
            yield from parts_of(self.way, near[near <= first])
            yield from parts_of(self.way, near[near >= last])

    def stretch(self, at: int, long_mm: float) -> tuple[int, int]:
        """The first and the last place of a stretch of a length about a place."""
        half = max(round(0.5 * long_mm / self.step_mm), 1)
        return at - half, at + half

    def corners_at(
        self, over_widths: float = TURNS_OVER, least_rad: float = CORNER_RAD
    ) -> list[int]:
        """The places at which the way turns by more than an angle over so many widths, the sharpest first."""
        if not self.is_closed:
            return corners_of(turns_rad(self.way, over_widths), over_widths, least_rad)
        count, over = len(self.way), round(over_widths / STEP_WIDTHS)
        on = self.way[np.arange(-over, count + over) % count]
        turned_rad = turns_rad(on, over_widths)[over:-over]
        return corners_of(turned_rad, over_widths, least_rad)

    def as_bay(self, first: int, last: int, rule: Rule | LaidWay, gain: float) -> Bay:
        """What is laid in place of a stretch from one place to another."""
        return Bay(self._along_mm(first), self._along_mm(last), rule, gain)

    def _along_mm(self, place: int) -> float:
        """How far along the way one of its places is. One below 0, or beyond the last, is another round's; a
        round is no whole number of steps.
        """
        rounds, at = divmod(place, len(self.way))
        return rounds * self.round_mm + at * self.step_mm

    def along(self, bays: list[Bay]) -> Relaid:
        """The line with the head run along those of some bays that lie apart."""
        bays, places_mm = apart(bays, self.round_mm), [np.empty((0, 2))]
        if not bays:
            return Relaid(self.line, *places_mm)
        for bay in bays:
            first, last = (round(mm / self.step_mm) for mm in (bay.first_mm, bay.last_mm))
            places_mm.append(self.way[np.arange(first, last + 1) % len(self.way)])
            places_mm.append(evenly(bay.rule.way, self.step_mm))
        line = laid(self.setup, self.line, bays, self.round_mm)
        return Relaid(line, np.vstack(places_mm))

    def explained(self, ink: SeenInk, rules: list[Rule], of_bay: bool = True) -> Rule | None:
        """The rule that explains an ink best, that of a bay or any. A bay is looked at again when another
        was mended; the same rules are fitted to the same ink once.
        """
        kept, key = self.setup.rules, sha1(pickle.dumps((ink, rules, of_bay))).digest()
        if key not in kept:
            kept[key] = folding_rule.explained(ink, rules, of_bay)
        return kept[key]

    def _ink(self, about: Array, first: int, last: int) -> SeenInk:
        """The ink about some places (n, 2) mm of a way; all but a stretch of it, and all other lines, are
        known.
        """
        ink = ink_about(self.drawing, about, self.line.width_mm, REACH)
        reach_mm = REACH * self.line.width_mm
        low, high = about.min(axis=0) - reach_mm, about.max(axis=0) + reach_mm
        known_mm = np.full(len(ink.places_mm), distances.NOWHERE_MM)
        # what is further away leaves no ink there
        for part in self.rest_within(first, last, low - reach_mm, high + reach_mm):
            known_mm = np.minimum(known_mm, distances.away_from(ink.places_mm, part))
        for line, part in self.lines.parts(low, high, self.line, around_mm=reach_mm):
            # a known line is as wide as it was felt, and drawn by this line's pen
            wider_mm = 0.5 * (line.width_mm - self.line.width_mm)
            known_mm = np.minimum(known_mm, nearest_mm(ink.places_mm, part) - wider_mm)
        return ink._replace(known_mm=known_mm)
