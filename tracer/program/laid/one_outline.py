"""One outline: the lines of a patch of ink as one closed line, where the ways within its rims show that.

    ──────╮╭──────     bays whose mouths, and stalks whose necks, are no wider than two lines: the head takes
     ╭────╯╰────╮      the outline for several closed lines with bars between them, or passes some of it by
     ╰──────────╯

The ways within the rims of the patch are joined to one (see `joined_ways`); where that runs along a line that
was found it is that (see `kept_parts`). It is the line if it leaves much less of the ink than all lines that
were found, and neither crosses itself nor goes out and back along one line.

Signals: the set-up, a patch of ink and the lines that were found on it in; the one line out, or none.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.motion.polyline import closed_up, evenly, length_mm, nearest_mm
from morfax.tracer.following.line import Line
from morfax.tracer.limits import LONGER_WIDTHS
from morfax.tracer.program.laid.joined_ways import crossings_mm, joined, uncrossed
from morfax.tracer.program.laid.kept_parts import KeptWay
from morfax.tracer.program.laid.own_rims import BETTER, MISSED, OwnRims, way_of
from morfax.tracer.program.laid.patch_ink import PatchInk
from morfax.tracer.program.laid.rim_bays import BACK, is_a_pen
from morfax.tracer.program.laid.rim_way import kinks_of
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles.beside_itself import ON_WIDTHS, partners, stretches
from morfax.tracer.tangles.seen_ink import DIFFER

MOST_SIDES = 60  # of a patch, towards areas of paper: to feel all rims of more takes seconds
# of the length of its ink: as long are both the longest sides of one line together, and of a net they are not
BOTH_SIDES = 0.9
# widths: sides of a neck whose ink is broader than a line by a fifth lie further apart
CROSSED = 0.2
# squared: the ink that no bays explain, as they do that of a part with a few
MUCH = 300.0
# widths: a way that is so near to itself for longer goes along one line; that round a tip does not
ON_ONE, TICK = 0.05, 0.4
# steps from a place of the other side within which the nearest one lies: a width
ABOUT_PARTNER = np.arange(-round(1 / STEP_WIDTHS), round(1 / STEP_WIDTHS) + 1)


class OneOutline(NamedTuple):
    """The one line that a patch of ink is, the lines that were found on it, the ink, and whether these leave
    so much of it that no bay explains that.
    """

    line: Line
    found: list[Line]
    ink: PatchInk
    is_sure: bool

    def left(self, lines: Sequence[Line]) -> float:
        """How much of the ink some lines leave, in squares of the width; without any line no end of it."""
        if not lines:
            return math.inf
        return self.ink.left(np.min([self.ink.away_mm(way_of(line)) for line in lines], axis=0))


def as_one_outline(setup: Setup, patch: int, lines: list[Line]) -> OneOutline | None:
    """The one line that a patch of ink is, on which some lines were found; None if it may be several."""
    rims = OwnRims(setup, patch, lines)
    if not _may_be_one(rims):
        return None
    width_mm = rims.pen_mm
    ways = sorted((each.way for each in rims.within(round_bars=True)), key=_length_mm)
    if len(ways) < 2:
        return None
    own = [line.loop_mm for line in lines if line.ending == "closed"]
    own.sort(key=_length_mm, reverse=True)
    way = uncrossed(joined(ways[::-1], own, rims.ink), width_mm)
    kept = KeptWay.of(way, lines, width_mm)
    if len(crossed := crossings_mm(kept.places_mm)):
        # the line that was found crosses itself there, or what is laid between its parts
        kept = KeptWay.of(way, lines, width_mm, crossed)
    own_left, left = _left(rims, kept.places_mm)
    is_better = own_left - left > MISSED and left < BETTER * own_left
    if not is_better or not _may_be_a_line(rims, kept.places_mm):
        return None
    line = kept.line(setup) or rims.run(kept.way)
    number = min(each.number for each in lines)
    return OneOutline(replace(line, number=number), lines, rims.ink, own_left - left > MUCH)


def _may_be_one(rims: OwnRims) -> bool:
    """Whether the lines that were found leave ink of a patch that may be one line."""
    if not rims.are_of(range(2, MOST_SIDES + 1)):
        return False
    sides_mm = sorted(map(_length_mm, rims.outlines))
    ink_mm = float(rims.setup.sheet.lengths_mm[rims.patch])
    return sum(sides_mm[-2:]) > BOTH_SIDES * ink_mm and rims.ink.worst(rims.own_mm) > MISSED


def _left(rims: OwnRims, way: Array) -> tuple[float, float]:
    """How much of the ink the lines that were found leave, and a closed way, where these differ, in squares
    of the width.
    """
    ink, away_mm = rims.ink, rims.ink.away_mm(closed_up(way))
    differ = np.abs(ink.wrong(away_mm) - ink.wrong(rims.own_mm)) > DIFFER
    return ink.left(rims.own_mm, differ), ink.left(away_mm, differ)


def _may_be_a_line(rims: OwnRims, way: Array) -> bool:
    """Whether a closed way neither crosses itself, nor turns off at a crossing, nor goes out and back along
    one line.
    """
    if len(crossings_mm(way)) or _goes_along_a_tick(way, rims.pen_mm):
        return False
    return not _turns_at_a_crossing(rims, way) and not _goes_round_a_line(rims, way)


def _turns_at_a_crossing(rims: OwnRims, way: Array) -> bool:
    """Whether a closed way turns at a place that it comes by again, where a line that was found goes on."""
    near_mm, step_mm = CROSSED * rims.pen_mm, STEP_WIDTHS * rims.pen_mm
    even, beyond = evenly(closed_up(way), step_mm)[:-1], round(LONGER_WIDTHS / STEP_WIDTHS)
    own = [evenly(closed_up(line.loop_mm), step_mm) for line in rims.lines if not line.is_open]
    if not own:
        return False
    own_mm, own_kinks_mm = np.vstack(own), np.vstack([each[kinks_of(each)] for each in own])
    for kink in kinks_of(even).tolist():
        place = even[kink : kink + 1]
        further = even[(kink + np.arange(beyond, len(even) - beyond)) % len(even)]
        comes_by = nearest_mm(place, further).min(initial=np.inf) < near_mm
        goes_on = nearest_mm(place, own_mm)[0] < near_mm
        goes_on &= nearest_mm(place, own_kinks_mm).min(initial=np.inf) > rims.pen_mm
        if comes_by and goes_on:
            return True
    return False


def _goes_round_a_line(rims: OwnRims, way: Array) -> bool:
    """Whether a closed way goes along both sides of ink, with no paper between, that is as broad as another
    line of the sheet.
    """
    width_mm, step_mm = rims.pen_mm, STEP_WIDTHS * rims.pen_mm
    even = evenly(closed_up(way), step_mm)[:-1]
    partner = partners(even, width_mm, round(ON_WIDTHS / STEP_WIDTHS))
    for first, last in stretches(even, step_mm, width_mm, near_widths=1.0):
        at = np.arange(first, last + 1) % len(even)
        at = at[partner[at] >= 0]
        # a partner is a place of the other side, and not the nearest
        other = even[(partner[at, None] + ABOUT_PARTNER) % len(even)]
        apart_mm = np.hypot(*(other - even[at, None]).transpose(2, 0, 1)).min(axis=1)
        if is_a_pen(rims.setup.sheet, width_mm + float(median(apart_mm))):
            return True
    return False


def _goes_along_a_tick(way: Array, width_mm: float) -> bool:
    """Whether a closed way goes out along a line, and back along the same one."""
    step_mm, apart = STEP_WIDTHS * width_mm, round(BACK / STEP_WIDTHS)
    back = partners(evenly(closed_up(way), step_mm), ON_ONE * width_mm, apart) >= 0
    changes = np.flatnonzero(np.diff(back.astype(np.int8), prepend=0, append=0))
    long = np.diff(changes)[::2]  # out and back
    return bool(long.max(initial=0) > 2 * TICK / STEP_WIDTHS)


def _length_mm(way: Array) -> float:
    """The length of a closed way."""
    return length_mm(closed_up(way))
