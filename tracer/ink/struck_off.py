"""Struck off: a stroke that ends in ink which another stroke draws ends where it comes to that ink.

Signals: strokes and the sheet's darkness in; the strokes without those ends out.

    ───────────────────────      the other stroke         where the ink is no broader than one pen's it is one
       ╲__________                the end of this one      stroke's: this one ends where it comes to the other

Two lines that lie beside each other have their ink together, as broad as the two of them: half-way between
the rims of the two pens is ink, if there are two lines, and paper, if there is one. Pens that lie nearer to
each other than ink of two lines tells (see `doubled`) are one. Each place along an end has a vote, and the
stroke is cut where most votes are for it. The shorter strokes are cut first; what is cut off is no stroke
into which another could end.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
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
LEAST = 0.5  # widths: so little is not cut off, and so little that is left is no stroke


def struck_off(drawing: Drawing, strokes: Sequence[InkStroke]) -> list[InkStroke]:
    """The strokes without the ends along which others run in the same ink."""
    if not strokes:
        return []
    sheet, kept = _Struck.of(drawing, strokes), dict[int, InkStroke]()
    doubtful = sheet.doubtful(strokes)
    for n in sorted(range(len(strokes)), key=lambda n: strokes[n].length_mm):
        stroke = strokes[n]
        cuts_mm = [0.0, 0.0]
        for last in (False, True):
            if doubtful[n, int(last)]:
                cuts_mm[last] = sheet.cut_mm(n, last)
        if sum(cuts_mm) > 0:
            is_left = stroke.length_mm - sum(cuts_mm) > LEAST * stroke.width_mm
            kept |= {n: stroke.part(*cuts_mm)} if is_left else {}
        else:
            kept[n] = stroke
    return [kept[n] for n in sorted(kept)]


@dataclass(frozen=True, slots=True)
class _Struck:
    """Places along all strokes: where, (n, 2) mm, and the directions there; the stroke of each, how far along
    it and how wide it is, mm; whether it is the stroke's still. `firsts`: of each stroke, and n.
    """

    drawing: Drawing
    places: Array
    along: Array
    stroke: Indices
    come_mm: Array
    widths_mm: Array
    firsts: Indices
    every_mm: float
    are_left: NDArray[np.bool_]
    near: Neighbours

    @classmethod
    def of(cls, drawing: Drawing, strokes: Sequence[InkStroke]) -> _Struck:
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
            np.ones(len(places), bool),
            Neighbours(places),
        )

    def doubtful(self, strokes: Sequence[InkStroke]) -> NDArray[np.bool_]:
        """Which beginnings and ends of open strokes come into the ink of others within a width, (n, 2)."""
        first, behind = self.firsts[:-1, None], self.firsts[1:, None]
        on = np.minimum(np.arange(round(1 / EVERY)), behind - first - 1)
        ends = np.stack([first + on, behind - 1 - on], axis=1)
        are_one = self._votes(ends.ravel()).reshape(ends.shape) > 0
        return are_one.any(axis=2) & ~np.array([[stroke.closed] for stroke in strokes])

    def cut_mm(self, number: int, last: bool) -> float:
        """Cut off the end of a stroke that is others' ink; its length, mm."""
        own = np.arange(self.firsts[number], self.firsts[number + 1])
        own = own[self.are_left[own]][:: -1 if last else 1]
        width_mm = self.widths_mm[own[0]] if len(own) else 0.0
        count = best = votes = 0
        some = max(1, round(LONGER_WIDTHS * width_mm / self.every_mm))
        for first in range(0, len(own), some):
            for k, vote in enumerate(self._votes(own[first : first + some]).tolist()):
                votes += vote
                if votes > best:
                    best, count = votes, first + k + 1
            if votes < best - some // 2:
                break
        if (count - 1) * self.every_mm < LEAST * width_mm:
            return 0.0
        self.are_left[own[: count - 1]] = False  # the last one is where it comes there
        return (count - 1) * self.every_mm

    def _votes(self, some: Indices) -> Indices:
        """1 for each of some places that lies in the ink of another line alone, -1 for the others."""
        places, widths_mm = self.places[some], self.widths_mm[some]
        apart_mm, aside = self._beside(some)
        # half-way between the rims of the two pens, on this one's side
        middles = places + aside
        outward = -unit(aside)
        halfway = places + 0.5 * aside + 0.5 * widths_mm[:, None] * outward
        is_ink = self._darkness(halfway) > HALF * self._darkness(middles)
        is_one = np.isfinite(apart_mm) & ((apart_mm < SAME * widths_mm) | ~is_ink)
        return np.where(is_one, 1, -1)

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
        come_mm = np.abs(self.come_mm[others] - self.come_mm[some, None])
        is_other |= come_mm > LONGER_WIDTHS * widths_mm
        cosines = np.abs(np.sum(self.along[others] * along[:, None], axis=2))
        is_beside = is_other & self.are_left[others] & (cosines > ALONG_COS)
        is_beside &= np.abs(aside) < BESIDE * widths_mm
        is_beside &= np.abs(ahead) < PAST * self.every_mm
        apart = np.where(is_beside, np.abs(aside), math.inf)
        rows, nearest = np.arange(len(some)), np.argmin(apart, axis=1)
        return apart[rows, nearest], aside[rows, nearest, None] * normals

    def _darkness(self, places: Array) -> Array:
        """The sheet's darkness at some places (n, 2) mm."""
        darkness, pitch_mm = self.drawing.darkness, self.drawing.pitch_mm
        rows = darkness.shape[0] - places[:, 1] / pitch_mm - 0.5
        return between(darkness, rows, places[:, 0] / pitch_mm - 0.5, edge_goes_on=False)


def _directions(way: Array) -> Array:
    """Unit vectors along a way, (n, 2)."""
    return unit(np.gradient(way, axis=0)) if len(way) > 1 else np.array([[1.0, 0.0]])
