"""Marks on the line: they tell the operator's machine where to stop.

Signals: the path of the head (n, 2) mm at the motion rate, and a view, in; marks out, each with the place of
the path on which the axis is to stand.

    tick     a short stroke across the line, or beside it     the line ───┼───    ───┴───    ─── ╵ ───
    dot      a round of ink on the line, wider than it                 ───●───    or at its end  ───●

Two rows of cells run beside the line, right and left. Where one sees a pulse of ink as wide as a line is,
the stroke is felt outward until it ends: a mark ends within `LONGEST_PENS`, a crossing line goes on.
The foot of the mark is where its own middle line meets the path of the head. No mark is at a corner: the line
goes straight on through the foot of a mark.

Source: patent ES 361967, figure 1, stop marks: a line across the contour, or a mark beside it. Questions: the
patent gives no sizes. Chosen (see `sizes`): a mark reaches from 1.2 of the line's width (0.6 mm) to 5 mm
beyond its edge on each side (ten widths, of wide lines), to 3.5 mm (seven) if it touches the line on one side
only; it stands within 40 degrees of square to the line and no further from it than 1.5 mm, is drawn with a
pen like the line's, and has paper to both sides.
"""

from __future__ import annotations

from bisect import bisect, insort
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.long_array import blocks, released
from morfax.tracer.limits import ABOUT_WIDTHS, CLEAR_WIDTHS, USUAL_WIDTH_MM
from morfax.tracer.marks import dots, sizes
from morfax.tracer.marks.head_path import HeadPath
from morfax.tracer.marks.stroke_cells import Base
from morfax.tracer.marks.ticks import SideStroke, crossing_mm, felt
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.view import View

Bits = NDArray[np.uint8]  # eight to a byte
SPACING_PX = 0.5  # how closely the cells look along the path


@dataclass(frozen=True, slots=True)
class Mark:
    """A mark: the place on which the axis stands, mm, and which position of the path that is (a fraction).

    `correction` is the number of the correction that says so; 0: the ink does.
    """

    kind: Literal["tick", "dot"]
    place_mm: tuple[float, float]
    at: float
    correction: int = 0


def longest_mm(view: View, *, across: bool = True) -> float:
    """How far a mark reaches beyond the line's edge at most, mm."""
    pens = sizes.LONGEST_PENS if across else sizes.BESIDE_PENS
    return pens * max(view.width_mm, USUAL_WIDTH_MM)


def marks_along(view: View, positions: Array) -> list[Mark]:
    """The ticks and dots of a path, in the order in which the head comes to them."""
    path = HeadPath(positions, SPACING_PX * view.pitch_mm)
    if len(path.at_mm) < 3 or view.width_mm < sizes.LEAST_PX * view.pitch_mm:
        return []
    found = _dots(view, path)
    last = len(path.at_mm) - 1
    at = np.minimum(np.searchsorted(path.position, [dot.at for dot in found]), last)
    dots_mm = path.at_mm[at]
    for foot_mm in _ticks(view, path):
        if np.all(np.abs(foot_mm - dots_mm) > ABOUT_WIDTHS * view.width_mm):
            found.append(Mark("tick", path.place(foot_mm), path.position_at(foot_mm)))
    return sorted(found, key=lambda mark: mark.at)


# ticks


def _ticks(view: View, path: HeadPath) -> list[float]:
    """Feet of the ticks, mm along the path."""
    every = _strokes(view, path)
    feet: list[float] = []
    for stroke in every:
        is_new = all(abs(stroke.foot_mm - other) >= view.width_mm for other in feet)
        if is_new and stroke.is_tick and not _is_drawing(view, path, stroke, every):
            foot = _foot_mm(view, path, stroke, every)
            if foot is not None:
                feet.append(foot)
    return feet


def _is_drawing(
    view: View, path: HeadPath, stroke: SideStroke, every: list[SideStroke]
) -> bool:
    """Whether a stroke beside the path is a part of the drawing, though drawn as a tick is."""
    # 1. a line that crosses, and goes on on the other side, in dashes perhaps
    if any(not (stroke.touches and o.ends) for o in _opposite(view, stroke, every)):
        return True
    # 2. a corner
    half_mm = max(sizes.CORNER_WIDTHS * view.width_mm, sizes.CORNER_MM)
    if not path.goes_straight(stroke.foot_mm, half_mm, sizes.CORNER_ASIDE * view.width_mm):
        return True
    # 3. the line itself, which comes by here again, or a stroke that touches the line elsewhere
    elsewhere = not stroke.touches and any(_is_same(view, stroke, o) for o in every)
    return elsewhere or _is_path(view, path, stroke)


def _foot_mm(
    view: View, path: HeadPath, stroke: SideStroke, every: list[SideStroke]
) -> float | None:
    """Where the middle line of a tick meets the path, mm along it; None if a line begins there."""
    opposite = _opposite(view, stroke, every)
    across = [o for o in opposite if o.ends and o.straight and o.is_like]
    is_long = stroke.length_mm > longest_mm(view, across=False)
    if not across and stroke.touches and is_long:
        return None
    nearest = round(stroke.foot_mm / path.step_mm)
    station = int(np.clip(nearest, 0, len(path.places) - 1))
    place = path.places[station]
    along = path.along[station]
    return float(path.at_mm[station] + crossing_mm(view, place, along, [stroke, *across]))


def _opposite(view: View, stroke: SideStroke, every: list[SideStroke]) -> list[SideStroke]:
    """The strokes on the other side of the line with the same foot."""
    within_mm = sizes.SAME_WIDTHS * view.width_mm
    others = [o for o in every if o.side != stroke.side]
    return [o for o in others if abs(o.foot_mm - stroke.foot_mm) < within_mm]


def _is_path(view: View, path: HeadPath, stroke: SideStroke) -> bool:
    """Whether a stroke is a piece of the line itself, which comes by here again."""
    others = path.places[np.abs(path.at_mm - stroke.foot_mm) > 2 * view.width_mm]
    return _mostly_on(view, stroke, others)


def _is_same(view: View, stroke: SideStroke, other: SideStroke) -> bool:
    """Whether a stroke beside the line is one that touches the line elsewhere."""
    is_elsewhere = abs(other.foot_mm - stroke.foot_mm) > view.width_mm
    return other.touches and is_elsewhere and _mostly_on(view, stroke, other.places)


def _mostly_on(view: View, stroke: SideStroke, others: Array) -> bool:
    """Whether most of a stroke lies on other places (n, 2)."""
    if not len(others):
        return False
    places = stroke.places[:: max(1, len(stroke.places) // 8)]
    away_mm = [np.hypot(*(others - place).T).min() for place in places]
    return bool(np.mean(np.array(away_mm) < 0.5 * view.width_mm) > 0.5)


def _strokes(view: View, path: HeadPath) -> list[SideStroke]:
    """Strokes of about a line's width that stand beside the path: first those to its left."""
    row_mm = max(0.5 * view.width_mm, 2 * view.pitch_mm)
    rows = view.width_mm + np.arange(0.0, sizes.FARTHEST_MM + 0.1, row_mm)
    dark = _are_dark(view, path, np.r_[rows, -rows])
    left = dark[: len(rows)]
    right = dark[len(rows) :]
    return [*_of_side(view, path, 1, rows, left), *_of_side(view, path, -1, rows, right)]


def _of_side(
    view: View, path: HeadPath, side: int, rows: Array, dark: Bits
) -> list[SideStroke]:
    """The strokes of one side, from where the cells of its rows see ink."""
    least_mm = sizes.SEEN[0] * view.width_mm
    most_mm = 2 * sizes.SEEN[1] * view.width_mm
    found, feet_mm = list[SideStroke](), list[float]()  # the feet in their order
    is_any = dark.any(axis=1)  # beside most lines there is nothing
    for away, ink in zip(rows[is_any], dark[is_any], strict=True):
        for begin, end in _pulses(ink, len(path.places)):
            if not least_mm < (end - begin) * path.step_mm < most_mm:
                continue
            i = (begin + end) // 2
            base = Base(path.places[i], path.along[i], side)
            stroke = felt(view, base, path.at_mm[i], away, longest_mm(view))
            if stroke is not None and not _is_among(view, stroke.foot_mm, feet_mm):
                found.append(stroke)
                insort(feet_mm, stroke.foot_mm)
    return found


def _is_among(view: View, foot_mm: float, feet_mm: list[float]) -> bool:
    """Whether a stroke with this foot has been found already, from another row of cells."""
    within_mm = sizes.SAME_WIDTHS * view.width_mm
    at = bisect(feet_mm, foot_mm)
    return any(
        abs(foot_mm - other_mm) <= within_mm for other_mm in feet_mm[max(0, at - 1) : at + 1]
    )


def _pulses(dark: Bits, count: int) -> Iterator[tuple[int, int]]:
    """First and last number + 1 of each run of ones among so many bits."""
    ones = np.zeros(count + 2, np.uint8)
    ones[1:-1] = np.unpackbits(dark, count=count)
    edges = np.flatnonzero(np.diff(ones))
    yield from zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)


def _are_dark(view: View, path: HeadPath, away_mm: Array) -> Bits:
    """Where cells that run beside a path, so far to its left, see ink: a row for each cell."""
    packed, done = list[Bits](), 0
    for places in blocks(path.places, every=8):  # whole bytes
        along = path.along[done : done + len(places)]
        dark = np.empty((len(away_mm), len(places)), bool)
        _look_beside(view.cells, places, along, np.asarray(away_mm, float), dark)
        packed.append(np.packbits(dark, axis=1))
        released(along)
        done += len(places)
    return np.concatenate(packed, axis=1)


@njit(cache=True, _nrt=False)
def _look_beside(cells, places, along, away_mm, out):  # type: ignore[no-untyped-def]
    """Fill `out`: all cells at one place, then at the next, so that tiles of a large sheet are made
    once.
    """
    for k in range(len(places)):
        for row in range(len(away_mm)):
            x = places[k, 0] - away_mm[row] * along[k, 1]
            y = places[k, 1] + away_mm[row] * along[k, 0]
            out[row, k] = photocell.darkness_at(cells, x, y) > cells.level


# dots


def _dots(view: View, path: HeadPath) -> list[Mark]:
    """Dots on the path and at its ends (see `dots`)."""
    beside_mm = 0.75 * sizes.DOT_LEAST_WIDTHS * view.width_mm
    left, right = _are_dark(view, path, np.array([beside_mm, -beside_mm]))
    found: list[Mark] = []
    for begin, end in _pulses(left & right, len(path.places)):
        middle = (begin + end - 1) // 2
        beside = _beside_dot(view, path, begin, end)
        centre = dots.disc(beside, path.places[middle], path.along[middle])
        if centre is None:
            continue
        nearest_mm = path.at_mm[np.argmin(np.hypot(*(path.places - centre).T))]
        at = path.position_at(nearest_mm)
        if all(abs(at - other.at) > 1 for other in found):
            found.append(Mark("dot", path.place(nearest_mm), at))
    return found


def _beside_dot(view: View, path: HeadPath, begin: int, end: int) -> View:
    """The view with the line's width on both sides of a dot, which is seen between two stations.

    A ragged line is wide in places.
    """
    reach = int(CLEAR_WIDTHS * view.width_mm / path.step_mm)
    before = range(begin - 2 * reach, begin - reach)
    behind = range(end + reach, end + 2 * reach)
    near = [*before, *behind]
    widths = []
    for k in near[::2]:
        if 0 <= k < len(path.places):
            heading = float(np.arctan2(path.along[k, 1], path.along[k, 0]))
            right, left = view.edges(path.places[k], heading, 2 * view.width_mm)
            widths.append(left - right)
    if not np.isfinite(widths).any():
        return view
    return replace(view, width_mm=max(float(np.nanmedian(widths)), view.width_mm))
