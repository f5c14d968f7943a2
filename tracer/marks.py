"""Marks on the line: what tells the operator's machine to stop.

Signals: the way of the head (n, 2) mm at the motion rate, and the cells' picture, in; marks out, each with the place of the way on which the axis is to
stand.

    tick     a short stroke across the line, or beside it     the line ───┼───    ───┴───    ─── ╵ ───
    dot      a round of ink on the line, wider than it                 ───●───    or at its end  ───●

Two rows of cells ride beside the line, right and left. Where one sees a pulse of ink as wide as a line is, the stroke is felt outward until it ends: a mark
ends within `LONGEST_MM`, a crossing line goes on beyond it. The foot of the mark is where its own middle line meets the way of the head. No mark is at a
corner: the line goes straight on through the foot of one.

Source: patent ES 361967, figure 1, stop marks: a line across the contour, or a mark beside it. Questions: the patent gives no sizes. Chosen: a mark reaches
from 0.8 of the line's width to 5 mm beyond its edge on each side (ten widths, of wide lines), to 3.5 mm (seven) if it touches the line on one side only,
stands within 40 degrees of square to it and not further from it than 1.5 mm, and is drawn with a pen like the line's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numba import njit

from tracer import dots, photocell
from tracer.leg import is_tip
from tracer.view import Array, View

LEAST_WIDTHS = 0.8
LONGEST_MM, LONGEST_WIDTHS = 5.0, 10.0  # of a mark across the line, beyond its edge on each side
BESIDE_MM, BESIDE_WIDTHS = (
    3.5,
    7.0,
)  # of a mark that touches the line on one side: what is longer is a line that begins there
FARTHEST_MM = 1.5  # from the line's edge to a mark beside it
SLANT = math.tan(math.radians(40))
LIKE = (0.5, 1.6)  # a mark's width, of the line's
SPACING = 0.5  # of a pixel: how closely the cells look


@dataclass(frozen=True, slots=True)
class Mark:
    """A mark: the place on which the axis stands, mm, and which position of the way that is, fractions included."""

    kind: Literal["tick", "dot", "end"]
    place_mm: tuple[float, float]
    at: float


@dataclass(frozen=True, slots=True)
class _Stroke:
    """Ink beside the line, felt outward: its middles (n, 2) as mm along and away from the way, and on the sheet, whether it touches the line, whether it
    ends, and how far beyond the line's edge."""

    side: int
    middles: Array
    places: Array
    touches: bool
    ends: bool
    reach_mm: float

    @property
    def foot_mm(self) -> float:
        """Where its middle line meets the way, mm along it."""
        return float(self._line()[1])

    @property
    def straight(self) -> bool:
        """Whether it is straight, and near enough to square."""
        slant, foot = self._line()
        rest = self.middles[:, 0] - foot - slant * self.middles[:, 1]
        return bool(abs(slant) < SLANT and np.sqrt(np.mean(rest**2)) < 0.1)

    def _line(self) -> Array:
        return np.polyfit(self.middles[:, 1], self.middles[:, 0], 1)


class Way:
    """The way of the head by its length: places and headings every `step_mm`, and which position each one is."""

    def __init__(self, positions: Array, step_mm: float) -> None:
        lengths = np.r_[0.0, np.cumsum(np.hypot(*np.diff(positions, axis=0).T))]
        self.step_mm = step_mm
        moving = np.r_[True, np.diff(lengths) > 0]
        self.at_mm = np.arange(0.0, lengths[-1], step_mm)
        self.position = np.interp(self.at_mm, lengths[moving], np.flatnonzero(moving))
        self.places = np.column_stack([np.interp(self.at_mm, lengths, positions[:, k]) for k in (0, 1)])
        steps = np.gradient(self.places, axis=0) if len(self.places) > 1 else np.ones((len(self.places), 2))
        self.along = steps / np.maximum(np.hypot(*steps.T), 1e-12)[:, None]

    def place(self, mm: float) -> tuple[float, float]:
        """Where the way is after a length."""
        return float(np.interp(mm, self.at_mm, self.places[:, 0])), float(np.interp(mm, self.at_mm, self.places[:, 1]))

    def position_at(self, mm: float) -> float:
        """Which position of the way is there after a length."""
        return float(np.interp(mm, self.at_mm, self.position))

    def goes_straight(self, mm: float, half_mm: float, within_mm: float) -> bool:
        """Whether the way about a place, as far as it goes there, leaves its own chord by less."""
        near = self.places[np.abs(self.at_mm - mm) <= half_mm]
        if len(near) < 3:
            return False
        chord = near[-1] - near[0]
        d = near - near[0]
        aside = (d[:, 1] * chord[0] - d[:, 0] * chord[1]) / max(np.hypot(*chord), 1e-9)
        return bool(np.abs(aside).max() < within_mm)


def longest_mm(view: View, *, across: bool = True) -> float:
    """How far a mark reaches beyond the line's edge at most, mm."""
    return max(LONGEST_MM, LONGEST_WIDTHS * view.width_mm) if across else max(BESIDE_MM, BESIDE_WIDTHS * view.width_mm)


def marks_along(view: View, positions: Array) -> list[Mark]:
    """The ticks and dots of a way, in the order in which the head comes to them."""
    way = Way(positions, SPACING * view.pitch_mm)
    if len(way.at_mm) < 3:
        return []
    found = _dots(view, way)
    dots = [
        way.at_mm[np.searchsorted(way.position, dot.at)] if dot.at < way.position[-1] else way.at_mm[-1]
        for dot in found
    ]
    for foot_mm in _ticks(view, way):
        if all(abs(foot_mm - dot) > 3 * view.width_mm for dot in dots):
            found.append(Mark("tick", way.place(foot_mm), way.position_at(foot_mm)))
    return sorted(found, key=lambda mark: mark.at)


def _ticks(view: View, way: Way) -> list[float]:
    """Feet of the ticks, mm along the way."""
    strokes = [stroke for side in (1, -1) for stroke in _strokes(view, way, side)]
    feet: list[float] = []
    for stroke in strokes:
        foot = stroke.foot_mm
        if not stroke.ends or not stroke.straight or any(abs(foot - other) < view.width_mm for other in feet):
            continue
        opposite = [o for o in strokes if o.side != stroke.side and abs(o.foot_mm - foot) < 0.6 * view.width_mm]
        if any(o.touches and not o.ends for o in opposite):
            continue  # it is a line that crosses and goes on on the other side
        if not way.goes_straight(foot, max(1.2 * view.width_mm, 0.5), 0.25 * view.width_mm):
            continue  # that is a corner
        if _is_way(view, way, stroke) or (not stroke.touches and any(_is_same(view, stroke, o) for o in strokes)):
            continue
        across = [o for o in opposite if o.ends and o.straight]
        if not across and stroke.touches and stroke.reach_mm > longest_mm(view, across=False):
            continue  # that is a line that begins here
        feet.append(float(np.mean([foot, *(o.foot_mm for o in across)])))
    return feet


def _is_way(view: View, way: Way, stroke: _Stroke) -> bool:
    """Whether a stroke is a piece of the line itself, which comes by here again."""
    others = way.places[np.abs(way.at_mm - stroke.foot_mm) > 2 * view.width_mm]
    return _mostly_on(view, stroke, others)


def _is_same(view: View, stroke: _Stroke, other: _Stroke) -> bool:
    """Whether a stroke beside the line is one that touches the line elsewhere."""
    return other.touches and abs(other.foot_mm - stroke.foot_mm) > view.width_mm and _mostly_on(view, stroke, other.places)


def _mostly_on(view: View, stroke: _Stroke, others: Array) -> bool:
    """Whether a stroke lies on other places (n, 2) for the most part."""
    places = stroke.places[:: max(1, len(stroke.places) // 8)]
    near = [len(others) > 0 and np.hypot(*(others - place).T).min() < 0.5 * view.width_mm for place in places]
    return bool(np.mean(near) > 0.5)


def _strokes(view: View, way: Way, side: int) -> list[_Stroke]:
    """Ink of about a line's width that stands beside the way on one side."""
    rows = view.width_mm + np.arange(0.0, FARTHEST_MM + 0.1, max(0.6 * LEAST_WIDTHS * view.width_mm, 2 * view.pitch_mm))
    found: list[_Stroke] = []
    for away in rows:
        dark = _row(view.cells, view.pitch_mm, way.places, way.along, side * away) > view.level
        edges = np.flatnonzero(np.diff(np.r_[False, dark, False].astype(np.int8)))
        for begin, end in zip(edges[::2], edges[1::2], strict=True):
            if not LIKE[0] * view.width_mm < (end - begin) * way.step_mm < 2 * LIKE[1] * view.width_mm:
                continue
            stroke = _felt(view, way, side, (begin + end) // 2, away)
            if stroke is not None and all(abs(stroke.foot_mm - o.foot_mm) > 0.6 * view.width_mm for o in found):
                found.append(stroke)
    return found


@njit(cache=True)
def _row(cells, pitch_mm, places, along, away_mm):  # type: ignore[no-untyped-def]
    """Darkness that a cell sees riding beside a way, `away_mm` to its left."""
    out = np.empty(len(places))
    for k in range(len(places)):
        x, y = places[k, 0] - away_mm * along[k, 1], places[k, 1] + away_mm * along[k, 0]
        out[k] = photocell.darkness_at(cells, pitch_mm, x, y)
    return out


def _felt(view: View, way: Way, side: int, i: int, away_mm: float) -> _Stroke | None:
    """The stroke that a cell beside station i of the way is on; None if it is not like a line's."""
    longest = longest_mm(view)
    t = way.along[i]
    seen = _stroke_at(
        view.cells, view.pitch_mm, way.places[i], t, side, away_mm, longest + view.width_mm, view.width_mm, view.level
    )
    inner = seen[:, 1] > 0.9 * view.width_mm  # nearer, its ink and the line's run together
    if inner.sum() < 3 or not LIKE[0] < np.median(seen[inner, 2]) / view.width_mm < LIKE[1]:
        return None
    nearest, reach = float(seen[:, 1].min()), float(seen[:, 1].max()) - 0.5 * view.width_mm
    touches = nearest < 0.5 * view.width_mm + 2 * view.pitch_mm
    long_enough = reach - max(0.0, nearest - 0.5 * view.width_mm) > LEAST_WIDTHS * view.width_mm
    if not long_enough or nearest - 0.5 * view.width_mm > FARTHEST_MM:
        return None
    n = side * np.array([-t[1], t[0]])
    u, v = seen[np.argmax(seen[:, 1]), :2]
    ends = reach < longest and is_tip(view, way.places[i] + u * t + (v - 0.5 * view.width_mm) * n)
    places = way.places[i] + seen[inner, :1] * t + seen[inner, 1:2] * n
    return _Stroke(side, seen[inner, :2] + [way.at_mm[i], 0.0], places, touches, ends, reach)


@njit(cache=True)
def _stroke_at(cells, pitch_mm, place, along, side, away_mm, farthest_mm, width_mm, level):  # type: ignore[no-untyped-def]
    """Middles (along, away) and widths of a stroke, (n, 3) mm, felt inward and outward from a place beside the way until there is no ink, specks apart."""
    step = 0.5 * pitch_mm
    speck_mm = max(0.16, 2.5 * pitch_mm)
    seen = np.empty((2 * int(farthest_mm / step) + 4, 3))
    count = 0
    for way in (-1, 1):
        u, v = 0.0, away_mm if way < 0 else away_mm + step
        if way > 0 and count:
            u = seen[0, 0]
        last = v
        while 0.4 * width_mm < v <= farthest_mm:
            right, left = _across(cells, pitch_mm, place, along, side, u, v, 1.2 * width_mm, level)
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
def _across(cells, pitch_mm, place, along, side, u_mm, v_mm, reach_mm, level):  # type: ignore[no-untyped-def]
    """Where ink about u ends, back and forth along the way, at a distance v from it; NaN without ink, or without an end in reach."""
    x, y = place[0] - side * v_mm * along[1], place[1] + side * v_mm * along[0]
    step = 0.35 * pitch_mm
    if photocell.darkness_at(cells, pitch_mm, x + u_mm * along[0], y + u_mm * along[1]) < level:
        return math.nan, math.nan
    found = (math.nan, math.nan)
    for way in (-1, 1):
        before, u = 1.0, u_mm
        while abs(u - u_mm) <= reach_mm:
            now = photocell.darkness_at(cells, pitch_mm, x + u * along[0], y + u * along[1])
            if now < level:
                edge = u - way * step * (level - now) / max(before - now, 1e-9)
                found = (edge, found[1]) if way < 0 else (found[0], edge)
                break
            before = now
            u += way * step
    return found


def _dots(view: View, way: Way) -> list[Mark]:
    """Dots on the way and at its ends (see `dots`)."""
    least = dots.LEAST_WIDTHS * view.width_mm
    inked = np.minimum(
        *(_row(view.cells, view.pitch_mm, way.places, way.along, side * 0.75 * least) for side in (1, -1))
    )
    edges = np.flatnonzero(np.diff(np.r_[False, inked > view.level, False].astype(np.int8)))
    found: list[Mark] = []
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        middle = (begin + end - 1) // 2
        centre = dots.disc(view, way.places[middle], way.along[middle])
        if centre is None:
            continue
        nearest = int(np.argmin(np.hypot(*(way.places - centre).T)))
        if all(abs(way.position_at(way.at_mm[nearest]) - o.at) > 1 for o in found):
            found.append(Mark("dot", way.place(way.at_mm[nearest]), way.position_at(way.at_mm[nearest])))
    return found
