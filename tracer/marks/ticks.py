"""Strokes beside the line, felt outward by cells: some of them are stop marks.

Signals: the path of the head at a station, a side of it and a distance in; the stroke there out: its middles
in mm along and away from the path and on the sheet, how far it reaches, and what is about it.

    away  │   ▮   │ <- paper to both sides: else it is lettering, a blot, a line beside the line
          │   ▮   │
     ─────────┴──────── path ─▶    beyond its end nothing in line with it: else it is a crossing line's dash

Source: our own (see `marks`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.median import ROBUST, median
from morfax.motion.plane import left_of
from morfax.motion.usual import INCREMENT_MM
from morfax.tracer.limits import ABOUT_WIDTHS, CLEAR_WIDTHS, LONGER_WIDTHS
from morfax.tracer.marks import sizes
from morfax.tracer.sensing.parabola import OUTLIERS
from morfax.tracer.sensing.photocell import LEVEL, STEP_PX
from morfax.tracer.sensing.probe import is_tip
from morfax.tracer.sensing.ray import Ray, end_of_ink, seen_on
from morfax.tracer.sensing.scout import SPECK_MM, SPECK_PX
from morfax.tracer.sensing.view import View

TURNS = 3  # the cells are turned this often: by then they stand square to a stroke
ACROSS = 1.2  # widths, along the path from a stroke's middle: its edges are nearer
# widths: a dash is no wider, and its middle no further from the stroke's own line
WIDE, STRAY = 1.6, 0.25
# of paper on a stroke, at most as long as a speck
SPECK_WIDTHS = 0.6
NEAREST = 0.4  # widths from the path: the line's own ink is not felt


class Base(NamedTuple):
    """Where and to which side a stroke is felt: a place of the path (mm), the path's direction there (unit
    vector), and the side, 1 left or -1 right."""

    place: Array
    along: Array
    side: int


@dataclass(frozen=True)
class SideStroke:
    """Ink beside the line, felt outward.

    Its middles (n, 2) as mm along and away from the path, and their places on the sheet; whether it touches
    the line, whether it ends, how far it reaches beyond the line's edge, whether there is paper about it, and
    whether the line's pen drew it: as wide and as dark as the line.
    """

    side: int
    middles: Array
    places: Array
    touches: bool
    ends: bool
    reach_mm: float
    is_clear: bool
    is_like: bool

    @property
    def foot_mm(self) -> float:
        """Where its middle line meets the path, mm along it."""
        return float(self._line[1])

    @property
    def length_mm(self) -> float:
        """How far it reaches beyond the line's edge along itself."""
        return self.reach_mm * math.hypot(1.0, self.slant)

    @property
    def slant(self) -> float:
        """How far it goes along the path for each mm away from it."""
        return float(self._line[0])

    @property
    def straight(self) -> bool:
        """Whether it is straight, and near enough to square."""
        slant, foot = self._line
        rest = self.middles[:, 0] - foot - slant * self.middles[:, 1]
        return bool(abs(slant) < sizes.SLANT and np.sqrt(np.mean(rest**2)) < sizes.BENT_MM)

    @property
    def is_tick(self) -> bool:
        """Whether it is drawn as a tick is."""
        return self.ends and self.straight and self.is_clear and self.is_like

    @cached_property
    def _line(self) -> Array:
        """Slope and offset of its middle line: each stroke is held against many others."""
        return np.polyfit(self.middles[:, 1], self.middles[:, 0], 1)


def felt(
    view: View, base: Base, at_mm: float, away_mm: float, longest_mm: float
) -> SideStroke | None:
    """The stroke that a cell is on beside a place of the path, which is `at_mm` along it.

    None if the stroke is not nearly as wide as the line, or too short.
    """
    width = view.width_mm
    seen = _stroke_at(view.cells, base, away_mm, longest_mm + width, width)
    # 1. as wide, as long and as near as a stroke may be
    middles = seen[seen[:, 1] > sizes.CLEAR_OF_LINE * width]
    wide = median(middles[:, 2]) / width if len(middles) > 2 else 0.0
    if not sizes.SEEN[0] < wide < sizes.SEEN[1]:
        return None
    nearest = float(seen[:, 1].min())
    reach = float(seen[:, 1].max()) - 0.5 * width
    from_line_mm = nearest - 0.5 * width
    least_mm = max(sizes.LEAST_MM, sizes.LEAST_WIDTHS * width)
    if reach - max(0.0, from_line_mm) <= least_mm or from_line_mm > sizes.FARTHEST_MM:
        return None
    # 2. what the cells see of it
    touches = from_line_mm < 2 * view.pitch_mm
    darkness = _darkness(view.cells, base, middles) * LEVEL / view.level
    is_like = sizes.LIKE[0] < wide < sizes.LIKE[1] and sizes.INK[0] < darkness < sizes.INK[1]
    ends = reach < longest_mm and _ends(view, base, seen, touches)
    is_clear = _is_clear(view, base, middles, touches)
    # 3. where it is
    across = base.side * left_of(base.along)
    places = base.place + middles[:, :1] * base.along + middles[:, 1:2] * across
    on_path = middles[:, :2] + [at_mm, 0.0]
    return SideStroke(base.side, on_path, places, touches, ends, reach, is_clear, is_like)


def _ends(view: View, base: Base, seen: Array, touches: bool) -> bool:
    """Whether a stroke ends at its far end, and at the near one if it does not touch the line."""
    width, across = view.width_mm, base.side * left_of(base.along)
    far = seen[np.argmax(seen[:, 1]), :2] - [0, 0.5 * width]
    near = seen[np.argmin(seen[:, 1]), :2] + [0, 0.5 * width]
    for u, v in [far] if touches else [far, near]:
        if not is_tip(view, base.place + u * base.along + v * across):
            return False
    middles = seen[seen[:, 1] > sizes.CLEAR_OF_LINE * width]
    others_mm = max(sizes.DASH_MM, LONGER_WIDTHS * width)
    return not _goes_on(view.cells, base, middles, others_mm, width)


def _is_clear(view: View, base: Base, middles: Array, touches: bool) -> bool:
    """Whether there is paper to both sides of a stroke."""
    width = view.width_mm
    clear_mm = CLEAR_WIDTHS * width
    if not touches:
        clear_mm = max(sizes.APART_MM, ABOUT_WIDTHS * width)
    beside_mm = sizes.CLEAR_OF_EDGE * width, clear_mm
    soiled = float(_soiled(view.cells, base, middles, beside_mm))
    return soiled < (sizes.SOILED if touches else sizes.APART_SOILED)


def crossing_mm(view: View, place: Array, along: Array, mark: Sequence[SideStroke]) -> float:
    """Where the middle line of a mark meets the path, mm along it from a place near by.

    The mark is one stroke, or one on either side. It is felt square to itself: felt along the path, its round
    tips and the corners at its foot would draw the middle of a slanted mark aside.
    """
    left = left_of(along)
    slant, foot_mm = mark[0].side * mark[0].slant, 0.0
    for _ in range(TURNS):
        square = (along - slant * left) / math.hypot(1.0, slant)
        found = (
            np.vstack([_square_to(view, place, square, slant, stroke) for stroke in mark])
            - place
        )
        slant, foot_mm = _robust_line(found @ left, found @ along)
    return foot_mm


def _square_to(
    view: View, place: Array, square: Array, slant: float, stroke: SideStroke
) -> Array:
    """Middles (n, 2) of a stroke on the sheet, felt square to it and clear of the line.

    Too few of them are left: the middles as they were.
    """
    width, lean, away = view.width_mm, math.hypot(1.0, slant), stroke.middles[:, 1]
    base = Base(place, square, stroke.side)
    away_mm = median(away) * lean
    farthest_mm = float(away.max()) * lean + width
    seen = _stroke_at(view.cells, base, away_mm, farthest_mm, width)
    seen = seen[seen[:, 1] > sizes.CLEAR_OF_LINE * width * lean + 0.5 * width * abs(slant)]
    out = stroke.side * left_of(square)
    return place + seen[:, :1] * square + seen[:, 1:2] * out if len(seen) > 3 else stroke.places


def _robust_line(x: Array, y: Array) -> tuple[float, float]:
    """Slope and offset of the straight line y(x), without places that a speck has drawn aside."""
    for _ in range(2):
        rest = np.abs(y - np.polyval(np.polyfit(x, y, 1), x))
        good = rest <= OUTLIERS * max(ROBUST * median(rest), INCREMENT_MM)
        x, y = x[good], y[good]
    slope, offset = np.polyfit(x, y, 1)
    return float(slope), float(offset)


@njit(cache=True)
def _row(base, v_mm):  # type: ignore[no-untyped-def]
    """The ray along the path at a distance away from it."""
    place, along, side = base
    x = place[0] - side * v_mm * along[1]
    y = place[1] + side * v_mm * along[0]
    return Ray(x, y, along[0], along[1], 0.0)


@njit(cache=True)
def _darkness(cells, base, middles):  # type: ignore[no-untyped-def]
    """The darkness of a stroke along its middle."""
    seen = np.empty(len(middles))
    for k in range(len(middles)):
        seen[k] = seen_on(cells, _row(base, middles[k, 1]), middles[k, 0])
    return np.median(seen)


@njit(cache=True)
def _soiled(cells, base, middles, beside_mm):  # type: ignore[no-untyped-def]
    """The share of ink to both sides of a stroke, between two distances from its edges."""
    dark = count = 0
    for k in range(len(middles)):
        for out in np.arange(beside_mm[0], beside_mm[1], cells.pitch_mm):
            for to in (-1, 1):
                u = middles[k, 0] + to * (0.5 * middles[k, 2] + out)
                dark += seen_on(cells, _row(base, middles[k, 1]), u) > cells.level
                count += 1
    return dark / max(count, 1)


@njit(cache=True)
def _goes_on(cells, base, middles, beyond_mm, width_mm):  # type: ignore[no-untyped-def]
    """Whether a stroke goes on in its own line after a gap, for one and a half widths or more."""
    last = np.argmax(middles[:, 1])
    first = np.argmin(middles[:, 1])
    u, v = middles[last, 0], middles[last, 1]
    slant = (u - middles[first, 0]) / max(v - middles[first, 1], 0.5 * width_mm)
    step, run = 0.5 * cells.pitch_mm, 0.0
    for k in range(1, int(beyond_mm / step)):
        there = u + slant * k * step
        right, left = _across(cells, base, there, v + k * step, ACROSS * width_mm)
        stray = abs(0.5 * (left + right) - there)
        like = left - right < WIDE * width_mm and stray < STRAY * width_mm
        run = run + step if like else 0.0
        if run > CLEAR_WIDTHS * width_mm:
            return True
    return False


@njit(cache=True)
def _stroke_at(cells, base, away_mm, farthest_mm, width_mm):  # type: ignore[no-untyped-def]
    """Middles (along, away) and widths of a stroke, (n, 3) mm, felt inward and outward from a place on it.

    It ends where no ink is left but specks.
    """
    step = 0.5 * cells.pitch_mm
    speck_mm = min(max(SPECK_MM, SPECK_PX * cells.pitch_mm), SPECK_WIDTHS * width_mm)
    seen = np.empty((2 * int(farthest_mm / step) + 4, 3))
    count = 0
    for way in (-1, 1):
        u, v = 0.0, away_mm if way < 0 else away_mm + step
        if way > 0 and count:
            u = seen[0, 0]
        last = v
        while NEAREST * width_mm < v <= farthest_mm:
            right, left = _across(cells, base, u, v, ACROSS * width_mm)
            if math.isnan(left - right):
                if abs(v - last) > speck_mm:
                    break
                v += way * step
                continue
            last = v
            u = 0.5 * (left + right)
            seen[count, 0], seen[count, 1], seen[count, 2] = u, v, left - right
            count += 1
            v += way * step
    return seen[:count].copy()


@njit(cache=True)
def _across(cells, base, u_mm, v_mm, reach_mm):  # type: ignore[no-untyped-def]
    """Where ink about u ends, back and forth along the path, at a distance v from it; NaN if it does not."""
    ahead = _row(base, v_mm)
    x, y = ahead.x_mm + u_mm * ahead.cosine, ahead.y_mm + u_mm * ahead.sine
    ahead = Ray(x, y, ahead.cosine, ahead.sine, 0.0)
    back = Ray(x, y, -ahead.cosine, -ahead.sine, 0.0)
    last_mm = reach_mm - STEP_PX * cells.pitch_mm  # no sample beyond the reach
    behind = end_of_ink(cells, back, 0.0, last_mm)
    before = end_of_ink(cells, ahead, 0.0, last_mm)
    return u_mm - behind, u_mm + before
