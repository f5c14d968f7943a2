"""Marks on the line: what tells the operator's machine to stop.

Signals: the way of the head (n, 2) mm at the motion rate, and the cells' picture, in; marks out, each with
the place of the way on which the axis is to stand.

    tick     a short stroke across the line, or beside it     the line ───┼───    ───┴───    ─── ╵ ───
    dot      a round of ink on the line, wider than it                 ───●───    or at its end  ───●

Two rows of cells ride beside the line, right and left. Where one sees a pulse of ink as wide as a line is,
the stroke is felt outward until it ends: a mark ends within `LONGEST_MM`, a crossing line goes on beyond it.
The foot of the mark is where its own middle line meets the way of the head. No mark is at a corner: the line
goes straight on through the foot of one.

Source: patent ES 361967, figure 1, stop marks: a line across the contour, or a mark beside it. Questions: the
patent gives no sizes. Chosen: a mark reaches from 1.2 of the line's width (0.6 mm) to 5 mm beyond its edge on
each side (ten widths, of wide lines), to 3.5 mm (seven) if it touches the line on one side only, stands
within 40 degrees of square to it and not further from it than 1.5 mm, is drawn with a pen like the line's,
and has paper to both sides.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numba import njit

from morfax.motion.arrays import Array
from morfax.motion.polyline import lengths_mm
from morfax.tracer.marks import dots
from morfax.tracer.marks import ticks as strokes
from morfax.tracer.marks.ticks import Stroke
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.view import View

LONGEST_MM, LONGEST_WIDTHS = (
    5.0,
    10.0,
)  # of a mark across the line, beyond its edge on each side
BESIDE_MM, BESIDE_WIDTHS = (
    3.5,
    7.0,
)  # of a mark that touches the line on one side: what is longer is a line that begins there
LEAST_PX = 2.5  # a line's width: of a thinner one the cells cannot tell a mark from a burr
BESIDE_DOT = 1.5  # widths, from a dot's edge to where the line is by itself, and on
SPACING = 0.5  # of a pixel: how closely the cells look


@dataclass(frozen=True, slots=True)
class Mark:
    """A mark: the place on which the axis stands, mm, and which position of the way that is, fractions
    included.
    """

    kind: Literal["tick", "dot"]
    place_mm: tuple[float, float]
    at: float


class Way:
    """The way of the head by its length: places and headings every `step_mm`, and which position each one is."""

    def __init__(self, positions: Array, step_mm: float) -> None:
        lengths = lengths_mm(positions)
        self.step_mm = step_mm
        moving = np.r_[True, np.diff(lengths) > 0]
        self.at_mm = np.arange(0.0, lengths[-1], step_mm)
        self.position = np.interp(self.at_mm, lengths[moving], np.flatnonzero(moving))
        self.places = np.column_stack(
            [np.interp(self.at_mm, lengths, positions[:, k]) for k in (0, 1)]
        )
        steps = (
            np.gradient(self.places, axis=0)
            if len(self.places) > 1
            else np.ones((len(self.places), 2))
        )
        self.along = steps / np.maximum(np.hypot(*steps.T), 1e-12)[:, None]

    def place(self, mm: float) -> tuple[float, float]:
        """Where the way is after a length."""
        return float(np.interp(mm, self.at_mm, self.places[:, 0])), float(
            np.interp(mm, self.at_mm, self.places[:, 1])
        )

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
    return (
        max(LONGEST_MM, LONGEST_WIDTHS * view.width_mm)
        if across
        else max(BESIDE_MM, BESIDE_WIDTHS * view.width_mm)
    )


def marks_along(view: View, positions: Array) -> list[Mark]:
    """The ticks and dots of a way, in the order in which the head comes to them."""
    way = Way(positions, SPACING * view.pitch_mm)
    if len(way.at_mm) < 3 or view.width_mm < LEAST_PX * view.pitch_mm:
        return []
    found = _dots(view, way)
    dots_mm = [
        way.at_mm[np.searchsorted(way.position, dot.at)]
        if dot.at < way.position[-1]
        else way.at_mm[-1]
        for dot in found
    ]
    for foot_mm in _ticks(view, way):
        if all(abs(foot_mm - dot_mm) > 3 * view.width_mm for dot_mm in dots_mm):
            found.append(Mark("tick", way.place(foot_mm), way.position_at(foot_mm)))
    return sorted(found, key=lambda mark: mark.at)


def _ticks(view: View, way: Way) -> list[float]:
    """Feet of the ticks, mm along the way."""
    every = [stroke for side in (1, -1) for stroke in _strokes(view, way, side)]
    feet: list[float] = []
    for stroke in every:
        foot = stroke.foot_mm
        if not (stroke.ends and stroke.straight and stroke.is_clear and stroke.is_like) or any(
            abs(foot - other) < view.width_mm for other in feet
        ):
            continue
        opposite = [
            o
            for o in every
            if o.side != stroke.side and abs(o.foot_mm - foot) < 0.6 * view.width_mm
        ]
        if any(not (stroke.touches and o.ends) for o in opposite):
            continue  # it is a line that crosses and goes on on the other side, in dashes perhaps
        if not way.goes_straight(foot, max(1.2 * view.width_mm, 0.5), 0.25 * view.width_mm):
            continue  # that is a corner
        if _is_way(view, way, stroke) or (
            not stroke.touches and any(_is_same(view, stroke, o) for o in every)
        ):
            continue
        across = [o for o in opposite if o.ends and o.straight and o.is_like]
        if not across and stroke.touches and stroke.length_mm > longest_mm(view, across=False):
            continue  # that is a line that begins here
        station = int(np.clip(round(foot / way.step_mm), 0, len(way.places) - 1))
        feet.append(
            way.at_mm[station]
            + strokes.crossing_mm(
                view, way.places[station], way.along[station], [stroke, *across]
            )
        )
    return feet


def _is_way(view: View, way: Way, stroke: Stroke) -> bool:
    """Whether a stroke is a piece of the line itself, which comes by here again."""
    others = way.places[np.abs(way.at_mm - stroke.foot_mm) > 2 * view.width_mm]
    return _mostly_on(view, stroke, others)


def _is_same(view: View, stroke: Stroke, other: Stroke) -> bool:
    """Whether a stroke beside the line is one that touches the line elsewhere."""
    return (
        other.touches
        and abs(other.foot_mm - stroke.foot_mm) > view.width_mm
        and _mostly_on(view, stroke, other.places)
    )


def _mostly_on(view: View, stroke: Stroke, others: Array) -> bool:
    """Whether a stroke lies on other places (n, 2) for the most part."""
    places = stroke.places[:: max(1, len(stroke.places) // 8)]
    near = [
        len(others) > 0 and np.hypot(*(others - place).T).min() < 0.5 * view.width_mm
        for place in places
    ]
    return bool(np.mean(near) > 0.5)


def _strokes(view: View, way: Way, side: int) -> list[Stroke]:
    """Ink of about a line's width that stands beside the way on one side."""
    rows = view.width_mm + np.arange(
        0.0, strokes.FARTHEST_MM + 0.1, max(0.5 * view.width_mm, 2 * view.pitch_mm)
    )
    found: list[Stroke] = []
    for away in rows:
        dark = _row(view.cells, way.places, way.along, side * away) > view.level
        edges = np.flatnonzero(np.diff(np.r_[False, dark, False].astype(np.int8)))
        for begin, end in zip(edges[::2], edges[1::2], strict=True):
            if (
                not strokes.SEEN[0] * view.width_mm
                < (end - begin) * way.step_mm
                < 2 * strokes.SEEN[1] * view.width_mm
            ):
                continue
            i = (begin + end) // 2
            base = strokes.Base(way.places[i], way.along[i], side)
            stroke = strokes.felt(view, base, way.at_mm[i], away, longest_mm(view))
            if stroke is not None and all(
                abs(stroke.foot_mm - o.foot_mm) > 0.6 * view.width_mm for o in found
            ):
                found.append(stroke)
    return found


@njit(cache=True)
def _row(cells, places, along, away_mm):  # type: ignore[no-untyped-def]
    """Darkness that a cell sees riding beside a way, `away_mm` to its left."""
    out = np.empty(len(places))
    for k in range(len(places)):
        x, y = places[k, 0] - away_mm * along[k, 1], places[k, 1] + away_mm * along[k, 0]
        out[k] = photocell.darkness_at(cells, x, y)
    return out


def _dots(view: View, way: Way) -> list[Mark]:
    """Dots on the way and at its ends (see `dots`)."""
    least = dots.LEAST_WIDTHS * view.width_mm
    inked = np.minimum(
        *(_row(view.cells, way.places, way.along, side * 0.75 * least) for side in (1, -1))
    )
    edges = np.flatnonzero(np.diff(np.r_[False, inked > view.level, False].astype(np.int8)))
    found: list[Mark] = []
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        middle = (begin + end - 1) // 2
        centre = dots.disc(
            _beside_dot(view, way, begin, end), way.places[middle], way.along[middle]
        )
        if centre is None:
            continue
        nearest = int(np.argmin(np.hypot(*(way.places - centre).T)))
        if all(abs(way.position_at(way.at_mm[nearest]) - o.at) > 1 for o in found):
            found.append(
                Mark("dot", way.place(way.at_mm[nearest]), way.position_at(way.at_mm[nearest]))
            )
    return found


def _beside_dot(view: View, way: Way, begin: int, end: int) -> View:
    """The view with the line's width on both sides of a dot that is seen between two stations: a ragged line
    is wide in places.
    """
    reach = int(BESIDE_DOT * view.width_mm / way.step_mm)
    near = [*range(begin - 2 * reach, begin - reach), *range(end + reach, end + 2 * reach)]
    found = []
    for k in near[::2]:
        if 0 <= k < len(way.places):
            heading = float(np.arctan2(way.along[k, 1], way.along[k, 0]))
            right, left = view.edges(way.places[k], heading, 2 * view.width_mm)
            found.append(left - right)
    width_mm = float(np.nanmedian(found)) if np.isfinite(found).any() else view.width_mm
    return replace(view, width_mm=max(width_mm, view.width_mm))
