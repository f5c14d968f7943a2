"""Outer rims: the way of a line with short sides, half a width within the rim on the outer side of each bend.

    ──╮ ╭──╮ ╭──      between the corners of teeth the head finds no clean leg, and rounds them, or takes two
      ╰─╯  ╰─╯        for one; but the ink has two rims, and that on the outer side of a corner goes round it
                      half a width from the line, as clear as that of any leg

Along a side both rims are half a width from the line; where one turns towards the ink, and shows no more than
where the sides meet, the way goes over to the other, if that is a pen's width from it before and behind.
Where the way leaves its ink, and that within the rims does not, the head runs along that from memory.

Signals: the sheet and lines in; the lines along their outer rims out.

Source: our own (see `ink.rim`). Questions: where the ink of two sides runs together there is no outer rim.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import between_corners, closed_up
from morfax.tracer.effort import MANY
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.own_ink import OwnInk
from morfax.tracer.program.laid.bay_run import Bay
from morfax.tracer.program.laid.bent import runs_of
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import LEGS, is_plain
from morfax.tracer.program.laid.rim_bays import within_outer_rims
from morfax.tracer.program.laid.way_ink import BayInk, Relaid, WayInk
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import pen
from morfax.tracer.tangles.seen_ink import GAIN

ON = 0.05  # widths: a way that is so near to another is on it
SIGMAS = 5.0  # of what noise of the paper gains: a way that gains more explains the ink better


class AlongRims(NamedTuple):
    """Lines held against their ink, which of them were laid anew, and the places (n, 2) mm where."""

    own: OwnInk
    laid: NDArray[np.bool_]
    places_mm: Array


def with_outer_rims(setup: Setup, own: OwnInk, asked: NDArray[np.bool_]) -> AlongRims:
    """Lines, held against their ink, those asked along their outer rims where these explain it better."""
    every = BoxedLines.of(own.lines)
    mended = [
        _OuterRims(setup, line, every).mended() if is_asked else Relaid(line, np.empty((0, 2)))
        for line, is_asked in zip(own.lines, asked, strict=True)
    ]
    laid = np.array([len(relaid.places_mm) > 0 for relaid in mended], bool)
    places_mm = np.vstack([np.empty((0, 2)), *(relaid.places_mm for relaid in mended)])
    lines = [relaid.line for relaid in mended]
    return AlongRims(own.mended(lines) if laid.any() else own, laid, places_mm)


@dataclass(frozen=True, eq=False)
class _OuterRims(WayInk):
    """The way of one of some lines, and the ink about it."""

    def mended(self) -> Relaid:
        """The line as it is, or along its outer rims where these explain its ink better."""
        bays = list[Bay]()
        if is_plain(self.line) and not self.line.as_told:
            for way in within_outer_rims(self.setup, self.line.width_mm, self.way):
                bays += [bay for each in self._off(way) for bay in self._bays(way, *each)]
        return self.along(bays)

    def _off(self, way: Array) -> list[tuple[int, int]]:
        """The stretches that are off a closed way (n, 2) mm: their first and last places."""
        is_off = pen.away_from(self.way, closed_up(way)) > ON * self.line.width_mm
        return list(runs_of(is_off, 1, True))[:MANY]

    def _bays(self, way: Array, first: int, last: int) -> Iterator[Bay]:
        """What is laid along a closed way about a stretch, on either side of the ink, if that explains it."""
        leg, further = (round(widths / STEP_WIDTHS) for widths in LEGS)
        begin, width_mm = first - leg - further, self.line.width_mm
        own = self.own(begin, last + leg + further)
        if own is None:
            return
        for part in _along(way, own, further, ON * width_mm):
            laid = LaidWay(tuple(between_corners(part.way)), 0.5 * width_mm)
            seen = self.about(begin + part.first, begin + part.last, laid.way)
            if seen is not None and (gain := _gain(seen, laid)) > 0:
                yield self.as_bay(seen.first, seen.last, laid, gain)


class _Part(NamedTuple):
    """A part of a way (n, 2) mm, and from which place of a stretch to which it lies."""

    way: Array
    first: int
    last: int


def _along(way: Array, own: Array, further: int, near_mm: float) -> Iterator[_Part]:
    """The parts of a closed way (n, 2) mm along a stretch (m, 2) mm, on either side of its ink: from the last
    of so many first places of that at which both are near to one another, to the first of as many last.
    """
    steps = np.gradient(own, axis=0)
    for side in (1, -1):
        on = dict(_on(way, side, own, steps, near_mm))
        firsts = [place for place in range(further, -1, -1) if place in on]
        lasts = [place for place in range(len(own) - 1 - further, len(own)) if place in on]
        if firsts and lasts:
            first, last = firsts[0], lasts[0]
            count = side * (on[last] - on[first]) % len(way)
            part = way[(on[first] + side * np.arange(count + 1)) % len(way)]
            yield _Part(np.vstack([own[first], part[1:-1], own[last]]), first, last)


def _on(
    way: Array, side: int, own: Array, steps: Array, near_mm: float
) -> Iterator[tuple[int, int]]:
    """The places of a stretch (m, 2) mm at which a closed way (n, 2) mm, which goes the same way on one side
    of the ink and back on the other, is near to it; each with the place of the way.
    """
    goes = side * (np.roll(way, -1, axis=0) - np.roll(way, 1, axis=0))
    low, high = own.min(axis=0) - near_mm, own.max(axis=0) + near_mm
    within = np.flatnonzero(((way > low) & (way < high)).all(axis=1))
    for place, (place_mm, step) in enumerate(zip(own, steps, strict=True)):
        along = within[goes[within] @ step > 0]
        away_mm = np.hypot(*(way[along] - place_mm).T)
        if away_mm.min(initial=math.inf) < near_mm:
            yield place, int(along[np.argmin(away_mm)])


def _gain(seen: BayInk, laid: LaidWay) -> float:
    """How much better a laid way explains the ink of a stretch than the way does; 0 if not surely, since
    noise may gain as much where their ink differs, or if it is no more than a corner has to gain.
    """
    ink = seen.ink
    by_own, by_laid = (
        ink.best_drawn(pen.away_from(ink.places_mm, way)) for way in (seen.own, laid.way)
    )
    gain, differ = ink.misfit(by_own) - ink.misfit(by_laid), np.sum((by_own - by_laid) ** 2)
    # gain = sum of (own - laid) * (own + laid - 2 * seen), and what is seen has the paper's noise
    of_noise = 2 * math.sqrt(differ * ink.noise / len(by_own)) * ink.area_mm2 / ink.width_mm**2
    least = max(SIGMAS * of_noise, GAIN * laid.length_mm / ink.width_mm)
    return gain if gain > least else 0.0
