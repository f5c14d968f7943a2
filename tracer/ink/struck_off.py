"""Struck off: ink that one stroke draws is no other stroke's; what is left of that ends where it comes there.

Signals: strokes and the sheet's darkness in; the strokes without what others draw out.

    ───────────────────────      the other stroke         where the ink is no broader than one pen's it is one
       ╲__________                the end of this one      stroke's: this one ends where it comes to the other

Two lines that lie beside each other have their ink together, as broad as the two of them: beyond both rims of
one pen, by a quarter of what parts them, is ink if there are two, and not if there is one. Pens that lie
nearer to each other than ink of two lines tells (see `doubled`) are one, and so are those in lines of few
pixels, which tell none. Each place along a stroke has a vote, and the stroke is cut where most votes are for
it: at its ends, and in its middle where it goes along another for longer than lines do that cross or touch,
and the ink is not known to be two lines'. The shorter strokes are cut first; what is cut off is no stroke
into which another could end.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.long_array import one_in
from morfax.motion.median import median
from morfax.motion.neighbours import Neighbours
from morfax.motion.plane import left_of, unit
from morfax.motion.polyline import evenly
from morfax.motion.usual import THINNED
from morfax.tracer.drawing.between import between
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.thinning import Indices
from morfax.tracer.ink.doubled import SureWidths
from morfax.tracer.ink.track import InkStroke
from morfax.tracer.limits import LONGER_WIDTHS, WIDER

# All limits but `SAME` were chosen by trial on wedges, lines that touch, and colouring pages.
EVERY = 0.2  # widths: between places along a stroke
SAME = WIDER - 1.0  # widths: ink of two lines as near as that is as narrow as one's
BESIDE = 0.5  # widths: a line further from another has ink of its own
ALONG_COS = 0.97  # 14 degrees: a line that turns off by more crosses the other
PAST = 2.0  # places: another line is beside one so little beyond its own end
MANY = 16  # nearest places, of which some are another line's
HALF = 0.5  # of a line's darkness: what is darker is ink
COMES_AND_LEAVES = 2  # places of a stroke in others' ink that are left it
LEAST = 0.5  # widths: so little is not cut off, and so little that is left is no stroke


def struck_off(
    drawing: Drawing, strokes: Sequence[InkStroke], shared_mm: Array
) -> list[InkStroke]:
    """The strokes without the stretches along which others run in the same ink; `shared_mm`: places (n, 2)
    along ink that is known to be two lines'.
    """
    if not strokes:
        return []
    sheet, kept = _Struck.of(drawing, strokes, shared_mm), dict[int, list[InkStroke]]()
    for n in sorted(range(len(strokes)), key=lambda n: strokes[n].length_mm):
        kept[n] = list(sheet.left_of(n, strokes[n]))
    return [stroke for n in sorted(kept) for stroke in kept[n]]


@dataclass(frozen=True, slots=True)
class _Struck:
    """Places along all strokes: where, (n, 2) mm, and the directions there; the stroke of each, how far along
    it and how wide it is, mm; whether it is the stroke's still, and in ink that is two lines'. `firsts`: of
    each stroke, and n. A line no wider than `sure_mm` tells no width.
    """

    drawing: Drawing
    places: Array
    along: Array
    stroke: Indices
    come_mm: Array
    widths_mm: Array
    firsts: Indices
    every_mm: float
    sure_mm: float
    are_left: NDArray[np.bool_]
    are_shared: NDArray[np.bool_]
    near: Neighbours

    @classmethod
    def of(cls, drawing: Drawing, strokes: Sequence[InkStroke], shared_mm: Array) -> _Struck:
        """The places of some strokes, nothing of which is cut off."""
        widths_mm = np.array([stroke.width_mm for stroke in strokes])
        every_mm = EVERY * median(widths_mm)
        ways = [evenly(one_in(stroke.way_mm, THINNED), every_mm) for stroke in strokes]
        counts = np.array([len(way) for way in ways])
        numbers = np.repeat(np.arange(len(ways)), counts)
        firsts = np.r_[0, np.cumsum(counts)]
        places = np.vstack(ways)
        return cls(
            drawing,
            places,
            np.vstack([_directions(way) for way in ways]),
            numbers,
            every_mm * (np.arange(len(places)) - firsts[numbers]),
            widths_mm[numbers],
            firsts,
            every_mm,
            SureWidths.of(drawing).least_mm,
            np.ones(len(places), bool),
            Neighbours(shared_mm).nearest(places)[0] < BESIDE * widths_mm[numbers],
            Neighbours(places),
        )

    def left_of(self, number: int, stroke: InkStroke) -> Iterator[InkStroke]:
        """What is left of a stroke: all of it, if it closes or comes into others' ink nowhere."""
        own = np.arange(self.firsts[number], self.firsts[number + 1])
        width = round(1 / EVERY)
        looked_at = np.unique(np.r_[own[:width], own[::width], own[-width:]])
        if stroke.closed or self._votes(looked_at).max() < 0:
            yield stroke
            return
        some = round(LONGER_WIDTHS * stroke.width_mm / self.every_mm)
        # 1. its ends, and then what is others' ink for longer, the longest first
        for way in (own, own[::-1]):
            count = _of_end(self._votes(way), some)
            if count * self.every_mm >= LEAST * stroke.width_mm:
                self.are_left[way[:count]] = False
        are_shared = self.are_shared[own]
        while (span := _most(np.where(are_shared, -1, self._votes(own)), some)) is not None:
            self.are_left[own[slice(*span)]] = False
        # 2. the pieces between
        are_left = np.r_[False, self.are_left[own], False]
        for first, behind in np.flatnonzero(np.diff(are_left)).reshape(-1, 2).tolist():
            begin_mm, end_mm = first * self.every_mm, (len(own) - behind) * self.every_mm
            if behind - first == len(own):
                yield stroke
            elif stroke.length_mm - begin_mm - end_mm > LEAST * stroke.width_mm:
                yield stroke.part(begin_mm, end_mm)

    def _votes(self, some: Indices) -> Indices:
        """1 for each of some places that lies in the ink of another line alone, -1 for the others."""
        places, widths_mm = self.places[some], self.widths_mm[some]
        apart_mm, aside = self._beside(some)
        # beyond the rims of a pen half-way between the two
        beyond = 0.5 * widths_mm[:, None] * unit(aside) + 0.25 * aside
        halfway = places + 0.5 * aside
        rims = self._darkness(np.stack([halfway - beyond, halfway + beyond]))
        is_ink = rims.min(axis=0) > HALF * self._darkness(places + aside)
        sure_mm = np.where(widths_mm > self.sure_mm, SAME * widths_mm, BESIDE * widths_mm)
        is_one = np.isfinite(apart_mm) & ((apart_mm < sure_mm) | ~is_ink)
        return np.where(is_one & self.are_left[some], 1, -1)

    def _beside(self, some: Indices) -> tuple[Array, Array]:
        """How far the nearest other line lies beside each of some places, mm, infinite if none does; and the
        way there, (n, 2) mm.
        """
        others = self.near.several(self.places[some], min(MANY, len(self.places)))
        along, widths_mm = self.along[some], self.widths_mm[some, None]
        off = self.places[others] - self.places[some, None]
        normals = left_of(along)
        aside, ahead = (np.sum(off * way[:, None], axis=2) for way in (normals, along))
        is_other = self.stroke[others] != self.stroke[some, None]
        # the line itself, where it comes back: of both passes the one that is met first is struck off
        onward = self.come_mm[others] - self.come_mm[some, None]
        onward *= 1 if some[-1] >= some[0] else -1
        is_other |= onward > LONGER_WIDTHS * widths_mm
        cosines = np.abs(np.sum(self.along[others] * along[:, None], axis=2))
        is_beside = is_other & self.are_left[others] & (cosines > ALONG_COS)
        is_beside &= np.abs(aside) < BESIDE * widths_mm
        is_beside &= np.abs(ahead) < PAST * self.every_mm
        apart = np.where(is_beside, np.abs(aside), math.inf)
        rows, nearest = np.arange(len(some)), np.argmin(apart, axis=1)
        return apart[rows, nearest], aside[rows, nearest, None] * normals

    def _darkness(self, places: Array) -> Array:
        """The sheet's darkness at some places (..., 2) mm."""
        darkness, pitch_mm = self.drawing.darkness, self.drawing.pitch_mm
        rows = darkness.shape[0] - places[..., 1] / pitch_mm - 0.5
        return between(darkness, rows, places[..., 0] / pitch_mm - 0.5, edge_goes_on=False)


def _of_end(votes: Indices, some: int) -> int:
    """How many of a stroke's first places lie in others' ink, up to the last, where it comes there."""
    total = best = count = 0
    for k, vote in enumerate(votes.tolist()):
        total += vote
        if total > best:
            best, count = total, k
        if total < best - some // 2:
            break
    return count


def _most(votes: Indices, some: int) -> tuple[int, int] | None:
    """Between which of a stroke's places most votes are for it, more than some; None if nowhere.

    The places where it comes there and leaves are the stroke's.
    """
    come = np.r_[0, np.cumsum(votes)]
    gained = come - np.minimum.accumulate(come)
    behind = int(np.argmax(gained))
    if gained[behind] <= max(some, COMES_AND_LEAVES):
        return None
    first = behind - int(np.argmin(come[behind::-1]))
    return first + 1, behind - 1


def _directions(way: Array) -> Array:
    """Unit vectors along a way, (n, 2)."""
    return unit(np.gradient(way, axis=0)) if len(way) > 1 else np.array([[1.0, 0.0]])
