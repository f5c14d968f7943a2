"""Where the pen was lifted in the ink of other lines: told by the ink that all the pens would have left.

Signals: the legs of lines that end at a junction, places of the others there (n, 2) mm, and the views of
these lines in; how far beyond its leg's clean end each line ends out, mm.

    ══════════════════════      the other line; its rim bulges as far as the ending line stands out of its ink
      ╲╲▁▁
         ╲╲                     the line that ends; the round of its pen shows beside it, beyond, or nowhere

For each end that the line may have, the darkness of its pen and of the others' together is held against the
sheet's: a place is as dark as the nearest of the pens leaves it. All ends that explain the ink about as well
as the best are possible; within the other's ink an end leaves no mark. Of those the one nearest to the middle
of the other line is taken. Lines that end in each other's ink have their ends found in turn, each as ink of
the others up to where it was last found to end.

Source: our own; the pen is that of `tangles.pen`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.neighbours import Neighbours, those_near
from morfax.motion.plane import left_of_headings
from morfax.tracer.effort import EVERY_MM, ROUNDS
from morfax.tracer.ink.ends_on_ink import misfits_of, reach_mm_of
from morfax.tracer.limits import LONGER_WIDTHS, NEAR
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.parabola import FEWEST
from morfax.tracer.sensing.probe import reach_of_ink
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.sketch import softness_of
from morfax.tracer.tangles.tangle import DARKEST

# All limits below were chosen by trial on drawings of two lines and of nets.
FOOT_MM = 1.0  # as far ahead a line that bends ends on others; both together
# as far where it comes onto another at a small angle: 15 widths at 4 degrees
FARTHEST_WIDTHS = 30.0
POKES_WIDTHS = 5.0  # the end of a line that pokes out further has a stretch of its own
ON_IT = 0.5  # widths: its straight way on has come to the others
TOUCHES = 1.0  # widths: two that both end here end beside each other, in ink that runs together
AHEAD = 12.0  # times its length a leg says where its line goes on
STEP_MM = 0.01  # of ends that are tried
FIRST_WIDTHS = 4.0  # of ends that are tried first
MORE = 4  # times as many if that was not enough
ASIDE_WIDTHS = 1.0  # to either side the ink of the line is looked at
EVERY_PX = 0.7  # a place is looked at
# of the line's darkness: no pen leaves its ink more exactly; and deviations, for places share what they see
INEXACT, DEVIATIONS = 0.05, 5.0


class Loose(NamedTuple):
    """A line without a partner at a junction: its view, its leg, and places felt near that, (n, 2) mm."""

    view: View
    leg: Leg
    near_mm: Array

    def way_mm(self, end_mm: float) -> Array:
        """Its places, and those on from its leg to an end, (n, 2) mm."""
        return np.vstack([self.near_mm, self.leg.at(np.arange(0.0, end_mm, EVERY_MM))])


class _Others(NamedTuple):
    """The other lines about one: places of those that have partners, (n, 2) mm and none behind them; what
    finds the nearest; and the ways of the others that have none.
    """

    places_mm: Array
    nearest_of: Neighbours
    ways: list[Array]

    def nearest(self, places: Array) -> tuple[Array, Array]:
        """How far each of some places is from the nearest of the others, mm, and that place, (n, 2) mm."""
        away_mm, number = self.nearest_of.nearest(places)
        nearest_mm = self.places_mm[number]
        near = list(those_near(self.ways, places, float(away_mm.max())))
        if near:
            there_mm = np.vstack(near)
            off_mm, number = Neighbours(there_mm).nearest(places)
            is_nearer = off_mm < away_mm
            away_mm = np.where(is_nearer, off_mm, away_mm)
            nearest_mm = np.where(is_nearer[:, None], there_mm[number], nearest_mm)
        return away_mm, nearest_mm


def ends_in_ink_mm(
    loose: Sequence[Loose], lines_mm: Array, *, are_tips: bool = False
) -> list[float | None]:
    """How far beyond their legs' clean ends some lines of a junction end in its ink, mm; `lines_mm`: places
    (n, 2) of the other lines there, as far as `FARTHEST_WIDTHS` from it.

    Each is ink for the others, at first as far as ink lies ahead of it. None for one that comes onto none;
    tips may also lie beside each other, and are None where no leg tells of them.
    """
    found = list[float | None]([None for _ in loose])
    if not loose:
        return found
    ends = [_inked_mm(line) for line in loose]
    ways = [line.way_mm(end_mm) for line, end_mm in zip(loose, ends, strict=True)]
    places_mm, nearest_of = np.vstack([lines_mm, (np.nan, np.nan)]), Neighbours(lines_mm)
    held_against = list[list[float] | None]([None for _ in loose])
    for _ in range(ROUNDS if len(loose) > 1 else 1):
        for k, line in enumerate(loose):
            ended = ends[:k] + ends[k + 1 :]
            if held_against[k] == ended:
                continue  # all others still end where they did
            held_against[k] = ended
            others = _Others(places_mm, nearest_of, ways[:k] + ways[k + 1 :])
            end_mm = _end_in_ink_mm(line, others, are_tips)
            if end_mm is not None:
                found[k] = ends[k] = end_mm
                ways[k] = line.way_mm(end_mm)
    return found


def _inked_mm(line: Loose) -> float:
    """How far ink lies straight ahead of a line, mm."""
    farthest_mm = FARTHEST_WIDTHS * line.leg.width_mm
    ahead_mm = reach_of_ink(line.view, line.leg, farthest_mm)
    return farthest_mm if ahead_mm is None else ahead_mm


def _end_in_ink_mm(line: Loose, others: _Others, is_tip: bool) -> float | None:
    """How far beyond its leg's clean end a line ends in the ink of the others, mm; None if it does not come
    to them.
    """
    leg = line.leg
    width_mm = leg.width_mm
    # 1. where the line comes onto the others
    ahead_mm = np.arange(0.0, FARTHEST_WIDTHS * width_mm, STEP_MM)
    away_mm, _ = others.nearest(leg.at(ahead_mm))
    come = np.flatnonzero(away_mm < ON_IT * width_mm)
    if not len(come) and is_tip:
        come = np.flatnonzero(away_mm < TOUCHES * width_mm)
    if not len(come):
        return None
    near_mm = away_mm[come[0] : come[0] + round(2 * width_mm / STEP_MM)]
    foot_mm = float(ahead_mm[come[0] + int(np.argmin(near_mm))])
    # 2. up to where it may end: beyond the last of the others, if no paper lies before
    ends_mm = ahead_mm[: come[-1] + round(POKES_WIDTHS * width_mm / STEP_MM)]
    seen_mm = math.dist(leg.seen[0, :2], leg.seen[-1, :2]) if len(leg.seen) else 0.0
    is_unknown = 0.5 * abs(leg.bend_per_mm) * ends_mm**2 > NEAR * width_mm
    is_unknown |= ends_mm > AHEAD * seen_mm
    ends_mm = ends_mm[~is_unknown]
    # 3. the ends that explain the ink
    if len(ends_mm) and len(leg.seen) >= FEWEST:
        low, high = _possible(line, others, ends_mm)
        if high < len(ends_mm) - 1 or not (is_tip and is_unknown.any()):
            return float(ends_mm[low + int(np.argmin(away_mm[low : high + 1]))])
    return foot_mm if foot_mm < LONGER_WIDTHS * width_mm + FOOT_MM else None


def _possible(line: Loose, others: _Others, ends_mm: Array) -> tuple[int, int]:
    """The numbers of the nearest and the farthest of some ends that explain the ink as well as the best.

    Most lines soon come to paper: so the nearest ends are looked at first, and more only if none lies there.
    """
    pen = 0.5 * line.leg.width_mm, softness_of(line.view, line.leg)
    count = round(FIRST_WIDTHS * line.leg.width_mm / STEP_MM)
    while True:
        misfits = _held_against_ink(line, others, pen, ends_mm, count)
        if count >= len(ends_mm) or not np.isfinite(misfits[-1]):
            break
        count *= MORE
    # those that differ from the best by no more than places do
    good = np.flatnonzero(misfits < misfits.min() + (INEXACT * DEVIATIONS) ** 2)
    return int(good[0]), int(good[-1])


def _held_against_ink(
    line: Loose, others: _Others, pen: tuple[float, float], ends_mm: Array, count: int
) -> Array:
    """How far the first of some ends are from explaining the ink about the line, see `ends_on_ink`; infinite
    for those beyond paper. The pen: half its width, softness, mm.
    """
    view, leg = line.view, line.leg
    # 1. places along the line, in its own directions, as far as they tell of these ends
    some, reach_mm = ends_mm[:count], reach_mm_of(pen)
    until_mm = min(ends_mm[-1], some[-1] + reach_mm) + leg.width_mm
    every_mm, beside_mm = EVERY_PX * view.pitch_mm, ASIDE_WIDTHS * leg.width_mm
    s, u = (
        grid.ravel()
        for grid in np.meshgrid(
            np.arange(0.0, until_mm, every_mm),
            np.arange(-beside_mm, beside_mm + every_mm, every_mm),
            indexing="ij",
        )
    )
    heading = leg.heading_rad + np.arctan(leg.bend_per_mm * s)
    places = leg.at(s) + u[:, None] * left_of_headings(heading)
    # 2. what the sheet shows there, and how far the others are, in which direction
    seen = np.minimum(view.darkness_along(places) / (2 * view.level), DARKEST)
    away_mm, nearest_mm = others.nearest(places)
    off = (places - nearest_mm) / np.maximum(away_mm, NOT_ZERO)[:, None]
    off_s = off[:, 0] * np.cos(heading) + off[:, 1] * np.sin(heading)
    off_u = off[:, 1] * np.cos(heading) - off[:, 0] * np.sin(heading)
    columns = np.column_stack([s, u, away_mm, off_s, off_u, seen])
    return misfits_of(columns, pen, some)
