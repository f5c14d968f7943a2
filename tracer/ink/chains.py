"""Chains: lines that go on into each other at their junctions, as a pen would have drawn them in one stroke.

Signals: a net in; out chains, each its lines in order and the way each is run, and where it begins and ends.

Each junction is solved once, with all its legs (see `partners`), so that every stroke through it agrees. A
leg without a partner ends on the middle of the lines that pass, or where the pen was lifted.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Hashable
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array, bounds
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.crossing import Crossing
from morfax.tracer.ink.felt_lines import end_leg, trimmed, without_waist
from morfax.tracer.ink.lifted import FARTHEST_WIDTHS
from morfax.tracer.ink.net import Inner, Net
from morfax.tracer.ink.partners import Pair, are_side_by_side
from morfax.tracer.ink.swelling import TWO
from morfax.tracer.limits import LONGER_WIDTHS
from morfax.tracer.sensing.leg import TURNS_OFF, Leg, turn
from morfax.tracer.sensing.probe import end_of
from morfax.tracer.sensing.view import View

# Chosen by trial on drawings of nets.
# widths: legs of a wider junction are taken from further off, by a share of its size, and longer
TRIM, LEGS = 0.1, 0.5


class Side(NamedTuple):
    """An end of a line: the line's number, and whether it is its last place."""

    line: int
    last: bool


class Link(NamedTuple):
    """A line of a chain: its number, and whether it is run from its last place to its first."""

    line: int
    back: bool


class Chain(NamedTuple):
    """Lines run one after the other; a closed chain goes on from its last into its first."""

    links: list[Link]
    closed: bool


@dataclass
class Junction:
    """The sides of lines that meet, in the order of their legs, and how they cross."""

    sides: list[Side]
    is_free: bool  # an end of the ink
    crossing: Crossing

    @property
    def legs(self) -> list[Leg]:
        """The legs of its sides as they come in."""
        return self.crossing.legs

    @property
    def pairs(self) -> list[Pair]:
        """The sides, by their numbers here, that are one line."""
        return self.crossing.pairs

    def leg(self, side: Side) -> Leg:
        """The leg of a side as it comes in."""
        return self.legs[self.sides.index(side)]

    def partner(self, side: Side) -> Side | None:
        """The side onto which a side goes on; None if it ends here."""
        k = self.sides.index(side)
        for a, b in self.pairs:
            if k in (a, b):
                return self.sides[b if k == a else a]
        return None


@dataclass
class Junctions:
    """All junctions of a net, each solved once; crossings that are `known` need not be solved again."""

    net: Net
    settings: Settings
    known: dict[Hashable, Crossing] = field(default_factory=dict)

    @cached_property
    def by_number(self) -> dict[int, Junction]:
        """The junctions by their numbers."""
        self._trim()
        found = dict[int, Junction]()
        for n, line in enumerate(self.net.lines):
            for last in (False, True):
                number = line.junctions[last]
                if number not in found:
                    nothing = Crossing([], [], self.settings)
                    found[number] = Junction([], number in self.net.free_ends, nothing)
                there = found[number]
                there.sides.append(Side(n, last))
                there.crossing.legs.append(end_leg(line, last))
                there.crossing.views.append(self._view(there.sides[-1]))
                there.crossing.near.append(self._near(there.sides[-1]))
        for inner in self.net.inner:
            if inner.junction in found:
                found[inner.junction].crossing.inked.append(inner)
        for there in found.values():
            there.crossing = self.known.setdefault(there.crossing.key, there.crossing)
        return found

    def places_along(self, chain: Chain) -> Array:
        """The places (n, 2) mm of a chain's lines, one after the other as it goes along them."""
        every = ((self.net.lines[n].places_mm, back) for n, back in chain.links)
        return np.vstack([places[:: -1 if back else 1] for places, back in every])

    @cached_property
    def middles_mm(self) -> Array:
        """The middle place of each line, once its ends are trimmed, (n, 2) mm."""
        every = (line.places_mm for line in self.net.lines)
        return np.array([places[len(places) // 2] for places in every]).reshape(-1, 2)

    @cached_property
    def lengths_mm(self) -> Array:
        """The length of each line's ink, (n,) mm."""
        return np.array([line.length_mm for line in self.net.lines])

    @cached_property
    def boxes_mm(self) -> Array:
        """The lowest and the highest place of each line, once its ends are trimmed, (n, 2, 2) mm."""
        return np.array([bounds(line.places_mm) for line in self.net.lines]).reshape(-1, 2, 2)

    def _trim(self) -> None:
        """Take the legs of wide junctions from further off, and longer: near to where two lines run together
        each has felt the other's rim.
        """
        at, ends = dict[int, list[Side]](), dict[int, list[tuple[Side, Leg]]]()
        for n, line in enumerate(self.net.lines):
            for last in (False, True):
                at.setdefault(line.junctions[last], []).append(Side(n, last))
        for number, sides in at.items():
            for side in sides if len(sides) > 2 else ():
                without_waist(self.net.lines[side.line], side.last)
            ends[number] = [
                (side, end_leg(self.net.lines[side.line], side.last)) for side in sides
            ]
        for number, there in ends.items():
            wide_mm = self._wide_mm(number, [leg for _, leg in there])
            if wide_mm > LONGER_WIDTHS * there[0][1].width_mm:
                for side, _ in there:
                    trim_mm, legs_mm = TRIM * wide_mm, LEGS * wide_mm
                    trimmed(self.net.lines[side.line], side.last, trim_mm, legs_mm)

    def _wide_mm(self, number: int, legs: list[Leg]) -> float:
        """How far the ink reaches in which lines meet, mm: the tip of two that run side by side too."""
        if len(legs) > 2:
            return float(np.hypot(*np.ptp([leg.end_mm for leg in legs], axis=0)))
        if len(legs) < 2 or not are_side_by_side(*legs):
            return 0.0
        tips = [inner.run.length_mm for inner in self.net.inner if inner.junction == number]
        return max(tips, default=0.0)

    def at(self, side: Side) -> Junction:
        """The junction at a side."""
        return self.by_number[self.net.lines[side.line].junctions[side.last]]

    def chains(self) -> list[Chain]:
        """All lines, each in one chain."""
        done, made = set[int](), list[Chain]()
        sides = [Side(n, last) for n in range(len(self.net.lines)) for last in (False, True)]
        # chains from where they end first; what is left are closed
        for only_ends in (True, False):
            for side in sides:
                if side.line in done or (only_ends and self.at(side).partner(side) is not None):
                    continue
                made.append(self._chain(side))
                done |= {link.line for link in made[-1].links}
        return made

    def _chain(self, first: Side) -> Chain:
        """The chain that begins at a side."""
        links, side = list[Link](), first
        while True:
            links.append(Link(side.line, side.last))
            far = Side(side.line, not side.last)
            onto = self.at(far).partner(far)
            if onto is None:
                return Chain(links, False)
            if onto == first:
                return Chain(links, True)
            side = onto

    def covers(self, inner: Inner) -> bool:
        """Whether ways through a junction go along a stretch within it."""
        there = self.by_number.get(inner.junction)
        return there is not None and there.crossing.covers(inner)

    def single_mm(self, number: int, wide_mm: float) -> float | None:
        """The width of each of two lines that run together as one line, mm; None if that is one line.

        At both its ends two lines go on from it that are narrower than `wide_mm`.
        """
        line, widths = self.net.lines[number], list[float]()
        for last in (False, True):
            onward = self._onward_mm(Side(number, last), wide_mm)
            if len(onward) != 2:
                return None
            widths += onward
        width_mm = float(np.mean(widths))
        return width_mm if line.width_mm < TWO * width_mm else None

    def _onward_mm(self, side: Side, wide_mm: float) -> list[float]:
        """The widths of the lines that are narrower than `wide_mm` and go on from a side, mm: straight on by
        their headings, or if these are not two as smooth ways do, which bend.
        """
        there = self.at(side)
        k, leg = there.sides.index(side), there.leg(side)
        turned = [turn(leg.heading_rad, other.heading_rad + math.pi) for other in there.legs]
        for turns_rad in (np.abs(turned), there.crossing.turnings_rad[k]):
            narrow = zip(there.legs, turns_rad < TURNS_OFF, strict=True)
            onward = [
                other.width_mm
                for other, goes_on in narrow
                if goes_on and other.width_mm < wide_mm and other is not leg
            ]
            if len(onward) == 2:
                break
        return onward

    def end_mm(self, side: Side) -> float:
        """How far beyond its leg's clean end a line ends that has no partner, mm."""
        if (end_mm := self.net.lines[side.line].ends_mm[side.last]) is not None:
            return end_mm
        there = self.at(side)
        k = there.sides.index(side)
        if k not in there.crossing.ends_mm and (there.is_free or len(there.sides) == 1):
            return max(0.0, end_of(self._view(side), there.leg(side)) or 0.0)
        return there.crossing.end_mm(k)

    def _view(self, side: Side) -> View:
        """How the head sees a line at one of its ends."""
        return self.net.lines[side.line].runs[-1 if side.last else 0].view

    def _near(self, side: Side) -> Array:
        """Places that were felt along a line near one of its ends, (n, 2) mm."""
        run = self.net.lines[side.line].runs[-1 if side.last else 0]
        count = math.ceil(FARTHEST_WIDTHS * run.view.width_mm / run.view.step_mm)
        return run.places_mm[-count:] if side.last else run.places_mm[:count]
