"""Ink beside lines: ink of their patches along which no line runs.

    ───╮  ╭───     a tip that the head passed by: its ink lies more than a width and a quarter beside every
       │──│        way; the points of pointed tips apart (see `pointed`)

      ▂▄▄▄▄▄▂      a brush that was pressed, or another pen, draws as broad to both sides of the way: such ink
    ───────────    is no tip
      ▀▀▀▀▀▀▀

Signals: the sheet and the lines that were followed in; pieces of such ink out.

Source: our own. Questions: whether ink beside a line belongs to it, or is another line that touches it, the
pen cannot know; nor whether broad ink is one line, or two whose gap the scan does not show.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.clusters import clusters
from morfax.motion.neighbours import Neighbours
from morfax.motion.plane import heading_of, left_of, unit
from morfax.motion.polyline import WITHIN_MM, at_lengths, nearest_mm
from morfax.tracer.drawing.components import joined
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.limits import ABOUT_WIDTHS, CLEAR_WIDTHS, PAPER
from morfax.tracer.program.against_ink.pointed import points_of
from morfax.tracer.sensing.photocell import darkness_along, without_aperture

# darkness: on a coarse scan a line's middle is darker; of 135 right paths on lines of 1 to 2 pixels 3 come
# below it, in blurred corners, and all of 10 wrong ones; by trial
PALE = 0.6
# widths: ink further from all ways was missed, by a tip whose round end is as far but for half a width. Of 48
# right plates none comes above 0.72, of 13 right outlines with spikes none above 0.78; where pixels were made
# finer, ink looks broader at corners
MISSED, MISSED_COARSE = 1.25, 2.0
AHEAD = np.radians(np.linspace(-80.0, 80.0, 17))  # of a line's end: where its ink would go on
# of the way from a line to where ink beside it ends, and to the other side: it is dark all that way
ACROSS = -1.0, -0.5, 0.5, 1.0


class MissedInk(NamedTuple):
    """A piece of ink beside all ways: where it is furthest from them, and how far it reaches; or, if it is as
    broad to both sides of a way, a place on the way, and for how long; mm.
    """

    place_mm: tuple[float, float]
    length_mm: float
    is_broad: bool = False


def pieces_beside(sheet: Sheet, lines: Sequence[Line]) -> Iterator[MissedInk]:
    """The ink, beside all ways, of the patches of those of some lines that must account for all of theirs."""
    whole = _accountable(sheet, lines)
    if not whole:
        return
    # how wide the widest of them is on each patch
    widths_mm = np.zeros(sheet.patches.count)
    for line in whole:
        patch = sheet.patch_at(line.loop_mm[0])
        widths_mm[patch] = max(widths_mm[patch], line.width_mm)
    tips = [side for line in whole if line.ending == "closed" for side in points_of(line)]
    ways = np.vstack([*(line.places_mm for line in lines), *tips])
    missed = _Runs.of(sheet, widths_mm, ways)
    if len(missed.numbers):
        broad = _BroadInk.of(sheet, missed, ways)
        is_broad = broad.are_broad(len(missed.numbers))
        yield from broad.stretches(is_broad, float(missed.width_mm.max()))
        yield from missed.pieces(sheet, ~is_broad)


class _Runs(NamedTuple):
    """Runs of ink of which an end is far from all ways: their numbers (n,), both ends (2, n, 2) mm, how far
    these are from the ways (2, n), how wide lines are there, and from where on it is far (n,), mm.
    """

    numbers: NDArray[np.int64]
    ends_mm: Array
    away_mm: Array
    width_mm: Array
    far_mm: Array

    @classmethod
    def of(cls, sheet: Sheet, widths_mm: Array, ways: Array) -> _Runs:
        """Those of the patches with lines so wide."""
        patches, finer = sheet.patches, sheet.drawing.finer
        own = np.flatnonzero((widths_mm > 0)[patches.patch] & ~sheet.are_solid[patches.patch])
        ends = np.stack([sheet.run_begins_mm(own), sheet.run_ends_mm(own)])
        away_mm = nearest_mm(ends.reshape(-1, 2), ways).reshape(2, -1)
        wide_mm = widths_mm[patches.patch[own]]
        far_mm = MISSED * wide_mm
        if finer > 1:
            far_mm = MISSED_COARSE * (wide_mm - sheet.drawing.pitch_mm * finer)
        far = away_mm.max(axis=0) > far_mm
        return cls(own[far], ends[:, far], away_mm[:, far], wide_mm[far], far_mm[far])

    def places(self) -> tuple[NDArray[np.int64], Array]:
        """Places along the runs, no further than a width apart: of which run each is (m,), and (m, 2) mm."""
        first, last = self.ends_mm
        counts = 2 + (np.hypot(*(last - first).T) / self.width_mm).astype(int)
        run = np.repeat(np.arange(len(first)), counts)
        nth = np.arange(len(run)) - np.repeat(np.cumsum(counts) - counts, counts)
        share = nth / (counts - 1)[run]
        return run, first[run] + share[:, None] * (last - first)[run]

    def pieces(self, sheet: Sheet, which: NDArray[np.bool_]) -> Iterator[MissedInk]:
        """Those of some that lie together, where each reaches furthest."""
        patches, own = sheet.patches, self.numbers[which]
        ends, away_mm = self.ends_mm[:, which], self.away_mm[:, which]
        group, count = joined(patches.row[own], patches.begin[own], patches.end[own], True)
        for number in range(count):
            mine = np.flatnonzero(group == number)
            furthest = np.unravel_index(np.argmax(away_mm[:, mine]), (2, len(mine)))
            x, y = ends[:, mine][furthest].tolist()
            yield MissedInk((x, y), float(away_mm[:, mine].max()))


class _BroadInk(NamedTuple):
    """Places of runs that are far from all ways: of which run each is (m,), the nearest place of a way (m, 2)
    mm, whether the ink there is as broad to its other side, and for longer than where a line crosses; and
    whether it is broader than a line, of which a coarse scan shows the edges a pixel further apart.
    """

    run: NDArray[np.int64]
    on_way: Array
    is_so: NDArray[np.bool_]
    is_broader: NDArray[np.bool_]

    @classmethod
    def of(cls, sheet: Sheet, runs: _Runs, ways: Array) -> _BroadInk:
        """Places of the runs, no further than a width apart."""
        run, places = runs.places()
        away_mm, nearest = Neighbours(ways).nearest(places)
        far = away_mm > runs.far_mm[run]
        run, away_mm, places, on_way = run[far], away_mm[far], places[far], ways[nearest[far]]
        wide_mm, outward = runs.width_mm[run], unit(places - on_way)
        # 1. to where the round of a pen would still be dark, and as far along as no line crosses
        out = (away_mm - 0.5 * wide_mm)[:, None] * outward
        along = (CLEAR_WIDTHS * wide_mm)[:, None] * left_of(outward)
        asked = [on_way + side * out + step * along for side in ACROSS for step in (-1, 0, 1)]
        is_so = np.min([darkness_at(sheet, some) for some in asked], axis=0) > PALE
        # 2. where it ends there is none further along
        is_so |= nearest_mm(on_way, on_way[is_so]) < CLEAR_WIDTHS * wide_mm
        return cls(run, on_way, is_so, away_mm > MISSED * wide_mm)

    def are_broad(self, count: int) -> NDArray[np.bool_]:
        """Whether most places of each of the runs are so."""
        every = np.bincount(self.run, minlength=count)
        so_many = np.bincount(self.run[self.is_so], minlength=count)
        return np.asarray((every > 0) & (2 * so_many >= every))

    def stretches(self, which: NDArray[np.bool_], width_mm: float) -> Iterator[MissedInk]:
        """The stretches of the ways beside which some of the runs lie."""
        beside = self.on_way[self.is_so & self.is_broader & which[self.run]]
        cluster = clusters(beside, ABOUT_WIDTHS * width_mm)
        for number in range(cluster.max(initial=-1) + 1):
            own = beside[cluster == number]
            x, y = own[len(own) // 2].tolist()
            yield MissedInk((x, y), float(np.hypot(*np.ptp(own, axis=0))), True)


def _accountable(sheet: Sheet, lines: Sequence[Line]) -> list[Line]:
    """Those of some lines that must account for all their ink: that came round, or ended and are alone, or
    where it goes on.
    """
    is_alone = len(lines) == 1
    return [
        line
        for line in lines
        if line.ending in ("closed", "joined")
        or (line.ending == "ended" and (is_alone or _ends_in_ink(sheet, line)))
    ]


def _ends_in_ink(sheet: Sheet, line: Line) -> bool:
    """Whether ink goes on from an end of an open line as one line does, farther than the round end of a pen;
    where it goes on to both sides, another line passes.
    """
    places, reach_mm = line.places_mm, MISSED * line.width_mm
    for way in (places, places[::-1]):
        end, before = at_lengths(way, np.array([0.0, line.width_mm]))
        headings = heading_of(end - before) + AHEAD
        ahead_mm = end + reach_mm * np.column_stack([np.cos(headings), np.sin(headings)])
        is_ink = darkness_at(sheet, ahead_mm) > PALE
        is_ink &= nearest_mm(ahead_mm, places) > reach_mm - WITHIN_MM  # no other part's
        if np.sum(np.diff(is_ink, prepend=False) & is_ink) == 1:
            return True
    return False


def darkness_at(sheet: Sheet, places_mm: Array) -> Array:
    """Darkness of the drawing at places (n, 2) mm, under a cell as small as a point."""
    cells = without_aperture(sheet.drawing, PAPER)
    return np.asarray(darkness_along(cells, places_mm))
