"""Bars of ink: what is joined to a line and along which no line runs, and what strokes run within.

Signals: the drawing, the lines on it, and a place on ink beside them in; places (n, 2) mm of the bar out.
Ways of strokes in; the bars of ink that they run within out, and whether they are as thick as a narrow bay.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.limits import ABOUT_WIDTHS
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.unexplained import Unexplained
from morfax.tracer.program.against_ink.window import SheetWindow
from morfax.tracer.tangles.seen_ink import middles_mm

OF_WIDTH = 1.3  # about a way ink is the line's own
ABOUT = 2.0  # times as far as the ink reaches from the line, and ...
# widths: the ink of a bay is two lines thick at the least; it may come to a point, and a part of it at the
# mouth counts as the line's own
THICK = 1.2, 4.0
# the same with half a width on either side; a line that a tick stands on counts there
THICK_BESIDE = 1.5
NOTHING = np.empty((0, 2))


def bar_at(drawing: Drawing, lines: BoxedLines, place: Unexplained, width_mm: float) -> Array:
    """The places of the bar of ink at a place beside the lines; none of a single line's, or of one that
    goes on further away.
    """
    # 1. the ink about the place
    place_mm = np.array([place.place_mm])
    about_mm = ABOUT * place.length_mm + ABOUT_WIDTHS * width_mm
    window = SheetWindow.about(drawing, place_mm, about_mm)
    bare = (np.asarray(window.of(drawing.darkness), float) > INK).astype(np.uint8)
    # 2. without that of the lines
    wide_px = max(1, round(OF_WIDTH * width_mm / drawing.pitch_mm))
    reach_mm = about_mm + (wide_px + 3) * drawing.pitch_mm
    low_mm, high_mm = place_mm[0] - reach_mm, place_mm[0] + reach_mm
    for way in lines.stretches(low_mm, high_mm):
        cv2.polylines(bare, [window.pixels(way).reshape(-1, 1, 2)], False, 0, wide_px)
    # 3. what is joined to the place
    _, label = cv2.connectedComponents(bare, connectivity=4)
    i, j = np.nonzero(label)
    if not len(i):
        return NOTHING
    ((column, row),) = window.pixels(place_mm)
    nearest = int(np.argmin(np.hypot(i - row, j - column)))
    i, j = np.nonzero(label == label[i[nearest], j[nearest]])
    goes_on = min(i.min(), j.min()) == 0 or i.max() == len(bare) - 1
    if goes_on or j.max() == bare.shape[1] - 1:
        return NOTHING
    bar = middles_mm(drawing, i + window.top, j + window.left)
    return bar if _is_thick(bar, drawing.pitch_mm, width_mm) else NOTHING


def _is_thick(bar: Array, pitch_mm: float, width_mm: float) -> bool:
    """Whether a bar is thicker than one line, and no thicker than two with a narrow bay between."""
    sides_mm = cv2.minAreaRect((bar - bar[0]).astype(np.float32))[1]
    thick_mm = len(bar) * pitch_mm**2 / (max(sides_mm) + pitch_mm)
    least, most = THICK
    return least * width_mm < thick_mm < most * width_mm


class Bar(NamedTuple):
    """A bar of ink: its middle; how long it is, mm; whether it is thicker than a line, and no thicker than a
    narrow bay between two.
    """

    place_mm: tuple[float, float]
    long_mm: float
    is_thick: bool


def bars_along(sheet: Sheet, ways: Sequence[Array], width_mm: float) -> Iterator[Bar]:
    """The bars of ink within which ways (n, 2) mm run; those that lie together run within one."""
    drawing, pitch_mm = sheet.drawing, sheet.drawing.pitch_mm
    pen_px = max(1, round(width_mm / pitch_mm))
    for together in _together(ways, width_mm):
        window = SheetWindow.about(drawing, np.vstack(together), 2 * width_mm)
        drawn = np.zeros(window.shape, np.uint8)
        for way in together:
            cv2.polylines(drawn, [window.pixels(way).reshape(-1, 1, 2)], False, 1, pen_px)
        ink = np.asarray(window.of(drawing.darkness), float) > INK
        count, bars = cv2.connectedComponents(drawn)
        for number in range(1, count):
            yield _bar(window, bars == number, ink, width_mm)


def _bar(
    window: SheetWindow, bar: NDArray[np.bool_], ink: NDArray[np.bool_], width_mm: float
) -> Bar:
    """A bar, by the ink in the narrowest box about it."""
    pitch_mm, (least, most) = window.pitch_mm, THICK
    places_px = np.column_stack(np.nonzero(bar)[::-1]).astype(np.float32)
    middle_px, (side_px, other_px), degrees = cv2.minAreaRect(places_px)
    across_mm, long_mm = (pitch_mm * (side + 1) for side in sorted((side_px, other_px)))
    # one stroke in the middle of a bar: there is ink beside it, too
    more_px = width_mm / pitch_mm
    wider_px = (
        (side_px + more_px, other_px) if side_px < other_px else (side_px, other_px + more_px)
    )
    is_thick = False
    for sides_px, times in (((side_px, other_px), least), (wider_px, THICK_BESIDE)):
        within = np.zeros(window.shape, np.uint8)
        corners = cv2.boxPoints((middle_px, sides_px, degrees))
        cv2.fillConvexPoly(within, np.round(corners).astype(np.int32), 1)
        inked_mm2 = float(np.count_nonzero((within > 0) & ink)) * pitch_mm**2
        is_thick |= inked_mm2 > times * width_mm * long_mm
    return Bar(window.place_mm(*middle_px), long_mm, is_thick and across_mm < most * width_mm)


def _together(ways: Sequence[Array], width_mm: float) -> list[list[Array]]:
    """Ways in groups: those whose boxes come nearer to each other than a width."""
    groups = list[tuple[Array, Array, list[Array]]]()
    for way in ways:
        low, high, group = way.min(axis=0) - width_mm, way.max(axis=0) + width_mm, [way]
        apart = list[tuple[Array, Array, list[Array]]]()
        for first, last, others in groups:
            if np.all(first < high) and np.all(last > low):
                low, high = np.minimum(low, first), np.maximum(high, last)
                group = others + group
            else:
                apart.append((first, last, others))
        groups = [*apart, (low, high, group)]
    return [group for _, _, group in groups]
