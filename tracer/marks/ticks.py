"""Strokes beside the line, felt outward by cells: what may be a stop mark.

Signals: the way of the head at a station, a side of it and a distance in; the stroke there out: its middles
in mm along and away from the way and on the sheet, how far it reaches, and what is about it.

    away  │   ▮   │ <- paper to both sides for so many widths: else it is lettering, a blot, a line beside the line
          │   ▮   │
     ─────────┴──────── way ─▶            beyond its end nothing in line with it: else it is a dash of a line that crosses

Source: our own (see `marks`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit

from morfax.motion.arrays import Array
from morfax.tracer.sensing.photocell import STEP_PX
from morfax.tracer.sensing.probe import is_tip
from morfax.tracer.sensing.ray import Ray, end_of_ink, seen_on
from morfax.tracer.sensing.view import LEVEL, View

LEAST_MM, LEAST_WIDTHS = 0.6, 1.2  # of a stroke, beyond the line's edge
FARTHEST_MM = 1.5  # from the line's edge to a stroke beside it
SLANT = math.tan(math.radians(40))
LIKE = (0.5, 1.6)  # a stroke's width, of the line's
SEEN = (
    0.3,
    2.0,
    # the same, of a stroke that is none of the line's pen, but is seen: what crosses the line may be one half
    # by half
)
# widths from the line's middle: nearer, a stroke's ink and the line's run together
CLEAR_OF_LINE = 0.9
TURNS = 3  # the cells are turned so often until they look square to a stroke
CLEAR_WIDTHS = 1.5  # of paper to both sides of a stroke that touches the line
APART_MM, APART_WIDTHS = 1.5, 3.0  # of one that does not: lettering stands beside lines
SOILED, APART_SOILED = 0.15, 0.03  # of that may be ink
INK = (0.65, 1.4)  # a stroke's darkness, of the line's: one pen draws both
DASH_MM, DASH_WIDTHS = 2.0, 4.0  # dashes of one line are no further apart


class Base(NamedTuple):
    """Where and to which side a stroke is felt: a place of the way (mm), the way's direction there (unit
    vector), and the side, 1 left or -1 right."""

    place: Array
    along: Array
    side: int


@dataclass(frozen=True, slots=True)
class Stroke:
    """Ink beside the line, felt outward: its middles (n, 2) as mm along and away from the way, and on the
    sheet, whether it touches the line, whether it ends, how far beyond the line's edge, whether there is
    paper about it, and whether the line's pen drew it."""

    side: int
    middles: Array
    places: Array
    touches: bool
    ends: bool
    reach_mm: float
    is_clear: bool
    is_like: bool  # as wide and as dark as the line

    @property
    def foot_mm(self) -> float:
        """Where its middle line meets the way, mm along it."""
        return float(self._line()[1])

    @property
    def length_mm(self) -> float:
        """How far it reaches beyond the line's edge along itself."""
        return self.reach_mm * math.hypot(1.0, self.slant)

    @property
    def slant(self) -> float:
        """How far it goes along the way for each mm away from it."""
        return float(self._line()[0])

    @property
    def straight(self) -> bool:
        """Whether it is straight, and near enough to square."""
        slant, foot = self._line()
        rest = self.middles[:, 0] - foot - slant * self.middles[:, 1]
        return bool(abs(slant) < SLANT and np.sqrt(np.mean(rest**2)) < 0.1)

    def _line(self) -> Array:
        return np.polyfit(self.middles[:, 1], self.middles[:, 0], 1)


def felt(
    view: View, base: Base, at_mm: float, away_mm: float, longest_mm: float
) -> Stroke | None:
    """The stroke that a cell is on beside a place of the way, which is `at_mm` along it; None if it is not
    nearly as wide as the line, or too short.
    """
    width, (place, along, side) = view.width_mm, base
    seen = _stroke_at(view.cells, base, away_mm, longest_mm + width, width)
    inner = seen[:, 1] > CLEAR_OF_LINE * width
    wide = float(np.median(seen[inner, 2])) / width if inner.sum() > 2 else 0.0
    if not SEEN[0] < wide < SEEN[1]:
        return None
    nearest, reach = float(seen[:, 1].min()), float(seen[:, 1].max()) - 0.5 * width
    touches = nearest < 0.5 * width + 2 * view.pitch_mm
    long_enough = reach - max(0.0, nearest - 0.5 * width) > max(LEAST_MM, LEAST_WIDTHS * width)
    if not long_enough or nearest - 0.5 * width > FARTHEST_MM:
        return None
    middles, others = seen[inner], max(DASH_MM, DASH_WIDTHS * width)
    is_like = (
        LIKE[0] < wide < LIKE[1]
        and INK[0] < _darkness(view.cells, base, middles) * LEVEL / view.level < INK[1]
    )
    across = side * np.array([-along[1], along[0]])
    tips = [
        seen[np.argmax(seen[:, 1]), :2] - [0, 0.5 * width],
        seen[np.argmin(seen[:, 1]), :2] + [0, 0.5 * width],
    ]
    at_tips = [
        is_tip(view, place + u * along + v * across) for u, v in tips[: 1 if touches else 2]
    ]
    ends = (
        reach < longest_mm
        and all(at_tips)
        and not _goes_on(view.cells, base, middles, others, width)
    )
    clear_mm = CLEAR_WIDTHS * width if touches else max(APART_MM, APART_WIDTHS * width)
    soiled = _soiled(view.cells, base, middles, (0.4 * width, clear_mm))
    is_clear = soiled < (SOILED if touches else APART_SOILED)
    places = place + middles[:, :1] * along + middles[:, 1:2] * across
    return Stroke(
        side, middles[:, :2] + [at_mm, 0.0], places, touches, ends, reach, is_clear, is_like
    )


def crossing_mm(view: View, place: Array, along: Array, mark: Sequence[Stroke]) -> float:
    """Where the middle line of a mark, which is one stroke or one on either side, meets the way, mm along it
    from a place of it near by.

    Felt square to the mark: along the way, its round tips and the corners at its foot would draw the middle
    of a slanted one aside.
    """
    left = np.array([-along[1], along[0]])
    slant, foot_mm = mark[0].side * mark[0].slant, 0.0
    for _ in range(TURNS):
        square = (along - slant * left) / math.hypot(1.0, slant)
        found = (
            np.vstack([_square_to(view, place, square, slant, stroke) for stroke in mark])
            - place
        )
        slant, foot_mm = _robust_line(found @ left, found @ along)
    return foot_mm


def _square_to(view: View, place: Array, square: Array, slant: float, stroke: Stroke) -> Array:
    """Middles (n, 2) of a stroke on the sheet, felt along a direction square to it from clear of the line on;
    as they were, if there are too few.
    """
    width, lean, away = view.width_mm, math.hypot(1.0, slant), stroke.middles[:, 1]
    base = Base(place, square, stroke.side)
    away_mm, farthest_mm = float(np.median(away)) * lean, float(away.max()) * lean + width
    seen = _stroke_at(view.cells, base, away_mm, farthest_mm, width)
    seen = seen[seen[:, 1] > CLEAR_OF_LINE * width * lean + 0.5 * width * abs(slant)]
    out = stroke.side * np.array([-square[1], square[0]])
    return place + seen[:, :1] * square + seen[:, 1:2] * out if len(seen) > 3 else stroke.places


def _robust_line(x: Array, y: Array) -> tuple[float, float]:
    """Slope and offset of the straight line y(x), places that a speck has drawn aside left out."""
    for _ in range(2):
        rest = np.abs(y - np.polyval(np.polyfit(x, y, 1), x))
        good = rest <= 3 * max(1.4826 * float(np.median(rest)), 0.001)
        x, y = x[good], y[good]
    slope, offset = np.polyfit(x, y, 1)
    return float(slope), float(offset)


@njit(cache=True)
def _row(base, v_mm):  # type: ignore[no-untyped-def]
    """The ray along the way at a distance away from it."""
    place, along, side = base
    x, y = place[0] - side * v_mm * along[1], place[1] + side * v_mm * along[0]
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
        right, left = _across(cells, base, there, v + k * step, 1.2 * width_mm)
        like = (
            left - right < 1.6 * width_mm
            and abs(0.5 * (left + right) - there) < 0.25 * width_mm
        )
        run = run + step if like else 0.0
        if run > 1.5 * width_mm:
            return True
    return False


@njit(cache=True)
def _stroke_at(cells, base, away_mm, farthest_mm, width_mm):  # type: ignore[no-untyped-def]
    """Middles (along, away) and widths of a stroke, (n, 3) mm, felt inward and outward from a place beside
    the way until there is no ink, specks apart.
    """
    step = 0.5 * cells.pitch_mm
    speck_mm = min(max(0.16, 2.5 * cells.pitch_mm), 0.6 * width_mm)
    seen = np.empty((2 * int(farthest_mm / step) + 4, 3))
    count = 0
    for way in (-1, 1):
        u, v = 0.0, away_mm if way < 0 else away_mm + step
        if way > 0 and count:
            u = seen[0, 0]
        last = v
        while 0.4 * width_mm < v <= farthest_mm:
            right, left = _across(cells, base, u, v, 1.2 * width_mm)
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
    """Where ink about u ends, back and forth along the way, at a distance v from it; NaN without ink, or
    without an end in reach.
    """
    ahead = _row(base, v_mm)
    x, y = ahead.x_mm + u_mm * ahead.cosine, ahead.y_mm + u_mm * ahead.sine
    ahead = Ray(x, y, ahead.cosine, ahead.sine, 0.0)
    back = Ray(x, y, -ahead.cosine, -ahead.sine, 0.0)
    last_mm = reach_mm - STEP_PX * cells.pitch_mm  # no sample beyond the reach
    behind = end_of_ink(cells, back, 0.0, last_mm)
    before = end_of_ink(cells, ahead, 0.0, last_mm)
    return u_mm - behind, u_mm + before
