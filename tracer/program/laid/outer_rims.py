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
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.neighbours import Neighbours
from morfax.motion.polyline import at_lengths, between_corners, closed_up, length_mm
from morfax.tracer.effort import MANY
from morfax.tracer.limits import ABOUT_WIDTHS
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.own_ink import OwnInk
from morfax.tracer.program.laid.bay_run import Bay
from morfax.tracer.program.laid.bent import LONGER, TURNS_OVER, runs_of
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import LEGS, is_plain
from morfax.tracer.program.laid.rim_bays import runs_back, within_outer_rims
from morfax.tracer.program.laid.spline_fit import CORNER_RAD, turns_rad
from morfax.tracer.program.laid.way_ink import MOST_LEFT, BayInk, Relaid, WayInk
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import distances
from morfax.tracer.tangles.seen_ink import GAIN

# widths: a way that is so near to another is on it; where a line was laid anew, all of it that is not is
# asked, else what is so far off
ON, OFF = 0.05, 0.1
SIGMAS = 5.0  # of what noise of the paper gains: a way that gains more explains the ink better


class AlongRims(NamedTuple):
    """Lines held against their ink, which of them were laid anew, and the places (n, 2) mm where."""

    own: OwnInk
    laid: NDArray[np.bool_]
    places_mm: Array


def with_outer_rims(
    setup: Setup, own: OwnInk, asked: NDArray[np.bool_], least_off: float = OFF
) -> AlongRims:
    """Lines, held against their ink, those asked along their outer rims where these explain it better, and
    the lines are so many widths off them.
    """
    every = BoxedLines.of(own.lines)
    mended = [
        _OuterRims(setup, line, every, least_off).mended()
        if is_asked
        else Relaid(line, np.empty((0, 2)))
        for line, is_asked in zip(own.lines, asked, strict=True)
    ]
    laid = np.array([len(relaid.places_mm) > 0 for relaid in mended], bool)
    places_mm = np.vstack([np.empty((0, 2)), *(relaid.places_mm for relaid in mended)])
    lines = [relaid.line for relaid in mended]
    return AlongRims(own.mended(lines) if laid.any() else own, laid, places_mm)


@dataclass(frozen=True, eq=False)
class _OuterRims(WayInk):
    """The way of one of some lines, and the ink about it; it is asked where it is so many widths off."""

    least_off: float

    def mended(self) -> Relaid:
        """The line as it is, or along its outer rims where these explain its ink better."""
        bays = list[Bay]()
        if is_plain(self.line) and not self.line.as_told:
            for way in within_outer_rims(self.setup, self.line.width_mm, self.way):
                beside = _Beside.of(self.way, way, ON * self.line.width_mm)
                off = beside.off(self.least_off * self.line.width_mm)
                bays += [bay for each in off if (bay := self._bay(beside, *each)) is not None]
        return self.along(bays)

    def _bay(self, beside: _Beside, first: int, last: int) -> Bay | None:
        """What is laid along a way beside a stretch that is off it, if that explains the ink better."""
        ends = beside.ends(first, last)
        own = None if ends is None else self.own(*ends)
        if ends is None or own is None:
            return None
        way = np.vstack([own[0], beside.between(*ends)[1:-1], own[-1]])
        if not _is_along(way, own, ABOUT_WIDTHS * self.line.width_mm):
            return None
        laid = LaidWay(tuple(between_corners(way)), 0.5 * self.line.width_mm)
        seen = self.about(*ends, laid.way)
        gain = 0.0 if seen is None else _gain(seen, laid)
        return self.as_bay(*ends, laid, gain) if gain > 0 else None


def _is_along(way: Array, own: Array, near_mm: float) -> bool:
    """Whether a way (n, 2) mm goes along another (m, 2) mm, and not round one of its lobes the other way."""
    each = np.linspace(0.0, 1.0, max(len(way), len(own)))
    both = [at_lengths(line, each * length_mm(line)) for line in (way, own)]
    return bool(np.hypot(*(both[0] - both[1]).T).max() < near_mm)


class _Beside(NamedTuple):
    """A closed way (n, 2) mm beside that of a line: to which of its places each of the line's is nearest
    (m,), how far from it these are, mm, which are on it, and whether it goes the same way (1) or back (-1).
    """

    way: Array
    nearest: NDArray[np.int64]
    away_mm: Array
    is_on: NDArray[np.bool_]
    side: int

    @classmethod
    def of(cls, own: Array, way: Array, near_mm: float) -> _Beside:
        """That beside the closed way (m, 2) mm of a line; what is so near to it is on it."""
        nearest = Neighbours(way).nearest(own)[1]
        away_mm = distances.away_from(own, closed_up(way))
        is_on = away_mm < near_mm
        goes = (np.roll(way, -1, axis=0) - np.roll(way, 1, axis=0))[nearest]
        along = np.sum(goes * (np.roll(own, -1, axis=0) - np.roll(own, 1, axis=0)), axis=1)
        side = 1 if np.sum(along[is_on]) > 0 else -1
        return cls(way, nearest, away_mm, is_on & (side * along > 0), side)

    def off(self, least_mm: float) -> list[tuple[int, int]]:
        """The stretches of the line that are further off than that somewhere, the furthest first."""
        runs = list(runs_of(~self.is_on, 1, True))
        count = len(self.away_mm)
        furthest_mm = [self.away_mm[np.arange(a, b + 1) % count].max() for a, b in runs]
        order = np.argsort(furthest_mm)[::-1][:MANY].tolist()
        return [runs[k] for k in order if furthest_mm[k] > least_mm]

    def ends(self, first: int, last: int) -> tuple[int, int] | None:
        """The places on the way that are nearest before and behind a stretch with its legs."""
        leg, further = (round(widths / STEP_WIDTHS) for widths in LEGS)
        reach, count = np.arange(leg, leg + further + 1), len(self.is_on)
        before, after = (
            np.flatnonzero(self.is_on[at % count]) for at in (first - reach, last + reach)
        )
        if not len(before) or not len(after):
            return None
        return first - int(reach[before[0]]), last + int(reach[after[0]])

    def between(self, first: int, last: int) -> Array:
        """The way (k, 2) mm from one place of the line to another."""
        at, to = self.nearest[np.array([first, last]) % len(self.nearest)]
        count = self.side * (to - at) % len(self.way)
        return np.asarray(self.way[(at + self.side * np.arange(count + 1)) % len(self.way)])


def _gain(seen: BayInk, laid: LaidWay) -> float:
    """How much better a laid way explains the ink of a stretch than the way does; 0 if not surely, since
    noise may gain as much where their ink differs, or if it is no more than a corner has to gain.

    A longer way beside one that hardly turns goes out along a burr, and comes back.
    """
    ink, width_mm = seen.ink, seen.ink.width_mm
    is_longer = laid.length_mm - length_mm(seen.own) > LONGER * width_mm
    if is_longer and turns_rad(seen.own, TURNS_OVER).max() < CORNER_RAD:
        return 0.0
    if runs_back(laid.way, width_mm) and not runs_back(seen.own, width_mm):
        return 0.0
    by_own, by_laid = (
        ink.best_drawn(distances.away_from(ink.places_mm, way)) for way in (seen.own, laid.way)
    )
    gain, differ = ink.misfit(by_own) - ink.misfit(by_laid), np.sum((by_own - by_laid) ** 2)
    # gain = sum of (own - laid) * (own + laid - 2 * seen), and what is seen has the paper's noise
    of_noise = 2 * math.sqrt(differ * ink.noise / len(by_own)) * ink.area_mm2 / width_mm**2
    least = max(SIGMAS * of_noise, GAIN * laid.length_mm / width_mm)
    is_surely = gain > least and ink.share_left(by_laid, by_own) < MOST_LEFT
    return gain if is_surely else 0.0
