"""Bridges: two closed lines that a bar as broad as two lines joins are one line, laid within the bar's rim.

    ╭─────╮         a keyhole, a ring with a slit, two lobes with a neck: where the sides run together the
    │ ╭─╮ │         junctions show two closed lines, and a bar between them along which no line runs
    │ ╰┬╯ │
    ╰──┴──╯         one line: round the one, along one side of the bar, round the other, and back

The head ran along both; only the sides of the bar are run from memory (see `rim_bays`).

Signals: the set-up and the closed lines of a patch of ink in; the lines, those that are one as one, out.

Source: our own. Questions: a bar drawn by a broader pen is taken for two lines, unless a line of the sheet is
as broad.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import cv2
import numpy as np

from morfax.motion.arrays import Array, bounds
from morfax.motion.median import median
from morfax.motion.plane import cross
from morfax.motion.polyline import lengths_mm, nearest_mm
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.bars import OF_WIDTH
from morfax.tracer.program.against_ink.off_ink import ink_about
from morfax.tracer.program.against_ink.window import SheetWindow
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import (
    LEGS,
    MOUTH,
    REACH,
    back_along,
    is_clear,
    is_plain,
    part_of,
    run_on,
)
from morfax.tracer.program.laid.rim_bays import is_a_pen, ways_within_rims
from morfax.tracer.program.setup import Setup
from morfax.tracer.tangles.beside_itself import shortest
from morfax.tracer.tangles.distances import away_from
from morfax.tracer.tangles.seen_ink import LIKE, middles_mm

# In widths of the line; chosen by trial on keyholes, slit rings and necks:
LEAST = 0.3  # squared: a smaller bar is a flaw of the ink


class _Mouth(NamedTuple):
    """Where a bar joins a line: the thinned places before and after it; whether it is to the left."""

    first: int
    last: int
    is_left: bool


def bridged(setup: Setup, lines: Sequence[Line]) -> list[Line]:
    """The lines of a patch; of its closed lines those that broad bars join as one."""
    lines = list(lines)
    if not is_clear(setup.sheet.drawing):
        return lines
    while (found := _first_pair(setup, lines)) is not None:
        one, other, line = found
        lines = [line if each is one else each for each in lines if each is not other]
    return lines


def _first_pair(setup: Setup, lines: list[Line]) -> tuple[Line, Line, Line] | None:
    """Two of the lines that a bar joins, and the one line that they are."""
    closed = [line for line in lines if is_plain(line)]
    if len(closed) < 2:
        return None
    ways = [line.places_mm for line in closed]
    boxes = [bounds(way) for way in ways]
    for bar in _bars(setup.sheet.drawing, lines, closed):
        low_mm, high_mm = bounds(bar)
        beside = [
            line
            for line, way, (first_mm, last_mm) in zip(closed, ways, boxes, strict=True)
            if (first_mm < high_mm + MOUTH * line.width_mm).all()
            and (last_mm > low_mm - MOUTH * line.width_mm).all()
            and nearest_mm(bar, way).min() < MOUTH * line.width_mm
        ]
        for leg in LEGS if len(beside) == 2 else ():
            one, other = beside
            line = _joined(setup, (one, other), bar, leg * one.width_mm)
            if line is not None:
                return one, other, line
    return None


def _bars(drawing: Drawing, lines: Sequence[Line], closed: Sequence[Line]) -> Iterator[Array]:
    """The places (n, 2) mm of each piece of ink about closed lines along which no line runs."""
    width_mm = max(line.width_mm for line in closed)
    window = SheetWindow.about(
        drawing, np.vstack([line.places_mm for line in closed]), width_mm
    )
    bare = (np.asarray(window.of(drawing.darkness), float) > INK).astype(np.uint8)
    for line in lines:
        wide_px = max(1, round(OF_WIDTH * line.width_mm / drawing.pitch_mm))
        way_px = window.pixels(line.places_mm).reshape(-1, 1, 2)
        cv2.polylines(bare, [way_px], line.comes_round, 0, wide_px)
    count, label, of_each, _ = cv2.connectedComponentsWithStats(bare, connectivity=4)
    least_px = (LEAST * width_mm / drawing.pitch_mm) ** 2
    for number in range(1, count):
        left, top, across, down, area_px = of_each[number].tolist()
        if area_px > least_px:
            i, j = np.nonzero(label[top : top + down, left : left + across] == number)
            yield middles_mm(drawing, i + window.top + top, j + window.left + left)


def _mouth(line: Line, bar: Array, leg_mm: float) -> _Mouth | None:
    """Where a bar joins a line, with a leg on either side; None where it does along most of it."""
    places = line.places_mm
    near = np.flatnonzero(nearest_mm(places, bar) < MOUTH * line.width_mm)
    if not len(near):
        return None
    first, last = shortest(near, len(places))
    come_mm = lengths_mm(places)
    round_mm = float(come_mm[-1])
    begin_mm = float(come_mm[first])
    end_mm = float(come_mm[last % len(places)]) + round_mm * (last >= len(places))
    middle = (first + last) // 2 % len(places)
    heading = places[(middle + 1) % len(places)] - places[middle - 1]
    is_left = cross(heading, bar.mean(axis=0) - places[middle]) > 0
    if end_mm - begin_mm + 2 * leg_mm > 0.5 * round_mm:
        return None
    at_mm = (begin_mm - leg_mm) % round_mm, (end_mm + leg_mm) % round_mm
    before, after = (int(np.searchsorted(come_mm, mm)) % len(places) for mm in at_mm)
    return _Mouth(before, after, bool(is_left))


def _joined(setup: Setup, pair: tuple[Line, Line], bar: Array, leg_mm: float) -> Line | None:
    """Two closed lines and the bar between them as one line, with legs beside the bar; None if that does not
    explain the ink.
    """
    one, other = pair
    mouths = _mouth(one, bar, leg_mm), _mouth(other, bar, leg_mm)
    if mouths[0] is None or mouths[1] is None:
        return None
    # 1. the head's ways, each from behind the bar round to before it, with the bar on the same side
    first = part_of(one, mouths[0].last, mouths[0].first)
    second = part_of(other, mouths[1].last, mouths[1].first)
    if mouths[0].is_left != mouths[1].is_left:
        second = back_along(second)
    ways = first.places_mm, second.places_mm
    # 2. the sides of the bar, from the end of each way to a leg of the other
    legs = tuple(int(np.searchsorted(lengths_mm(way), leg_mm)) for way in ways)
    sides = _sides(setup, one.width_mm, ways, legs, bar)
    return None if sides is None else run_on(setup, (first, second), sides)


def _sides(
    setup: Setup, width_mm: float, ways: tuple[Array, Array], legs: tuple[int, ...], bar: Array
) -> tuple[LaidWay, LaidWay] | None:
    """The ways along both sides of a bar, from the end of the first of two ways to a leg, so many places, of
    the second, and from its end to a leg of the first; None if they are no two sides, or do not explain the
    ink.
    """
    drawing = setup.sheet.drawing
    # 1. the shortest on each side
    found = list[LaidWay]()
    for into, out_of, leg in ((*ways, legs[1]), (*ways[::-1], legs[0])):
        own = np.vstack([into[-2:], out_of[: leg + 1]])
        every = ways_within_rims(setup, width_mm, own, bar)
        found += sorted(every, key=lambda side: side.length_mm)[:1]
    if len(found) < 2:
        return None
    there, back = found
    # 2. of no pen that is as broad
    apart_mm = away_from(_middle_half(there.way), back.way)
    if is_a_pen(setup.sheet, median(apart_mm) + width_mm):
        return None
    # 3. held against the ink
    ink = ink_about(drawing, np.vstack([bar, there.way, back.way]), width_mm, REACH)
    every_way = [*ways, there.way, back.way]
    away_mm = np.min([away_from(ink.places_mm, way) for way in every_way], axis=0)
    misfit = ink.misfit(ink.best_drawn(away_mm))
    long_mm = there.length_mm + back.length_mm
    return (there, back) if misfit < LIKE * long_mm / width_mm else None


def _middle_half(way: Array) -> Array:
    """The places of a way but for a quarter at either end."""
    quarter = len(way) // 4
    return way[quarter : len(way) - quarter]
