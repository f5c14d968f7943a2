"""A contour or strokes: a patch of ink that its strokes do not explain is followed as one closed contour.

    ───╮   ╭───     where the sides of a notch run together, strokes are a line past it and a bar into it;
       │███│        where its end is too narrow for clean line, a stroke cuts that short
       ╰───╯

The head follows such a patch once more, as where contours are asked for. If it comes round, leaves nothing
unexplained, and its pen explains the ink where both ways differ better than the strokes' pens do, it is the
line that was drawn.

Signals: the set-up and strokes along all the ink in; the lines, some of them contours, out.

Source: our own. Questions: a patch with a bay beside other lines that are long stays strokes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import evenly, lengths_mm, nearest_mm
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.program import selection
from morfax.tracer.program.bars import THICK
from morfax.tracer.program.narrow_bays import GAIN, LIKE, explained, is_clear, with_bars
from morfax.tracer.program.one_of_each import one_of_each
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.small_rings import pen_mm
from morfax.tracer.program.unexplained import Unexplained
from morfax.tracer.tangles import beside_itself
from morfax.tracer.tangles.pen import NOWHERE_MM
from morfax.tracer.tangles.seen_ink import SeenInk

# In widths of the line, chosen by trial on plates with notches and tongues:
STEP = 0.1  # between the places of a way
NARROW, ROUND_END = (
    2.6,
    6.0,
)  # sides so near to each other, with so much way between them, have a narrow end
END = 5.0  # of a stroke: shows whether it ends in a bar
OTHERS = 0.3  # of the longest stroke: a shorter one is no part of the contour, ...
MOST_PARTS = 4  # ... which has so many at the most
DIFFER = 0.1  # between the ways: more is another way
REACH = 1.5  # from where they differ, the ink is looked at
MOST_PLACES = 6000  # of ink


def as_contours(setup: Setup, lines: Sequence[Line]) -> tuple[list[Line], list[Unexplained]]:
    """The lines, with the strokes of some patches replaced by the closed contour that explains their ink; and
    bars of ink as broad as two lines that are left.
    """
    if not lines or not is_clear(setup.sheet.drawing):
        return list(lines), []
    of_patch = dict[int, list[Line]]()
    for stroke in lines:
        of_patch.setdefault(setup.sheet.patch_at(stroke.xy_mm[0]), []).append(stroke)
    numbers = {int(p): n for n, p in enumerate(selection.lines_of(setup.sheet), 1)}
    width_mm = pen_mm(setup.sheet) if numbers else 0.0
    kept, left = list[Line](), list[Unexplained]()
    for patch, strokes in of_patch.items():
        line: Line | None = None
        bars: list[Unexplained] | None = None
        if patch in numbers:
            bars = _broken_at(setup.sheet, strokes, width_mm)
            if bars is not None or _is_folded(strokes):
                line = _contour(setup, numbers[patch], strokes)
        kept += strokes if line is None else [line]
        left += bars or [] if line is None else []
    kept.sort(key=lambda line: -line.length_mm)
    return [replace(line, number=number) for number, line in enumerate(kept, 1)], left


def _is_folded(strokes: list[Line]) -> bool:
    """Whether a patch is one stroke that has a narrow end, or that runs past its own end."""
    line = strokes[0]
    by_compass_mm = float(line.led.lengths_mm(line.xy_mm)[REDRAWN])
    if len(strokes) > 1 or by_compass_mm > 0.5 * line.length_mm:  # it lays narrow ends
        return False
    if line.ending != "closed":
        near_mm, round_mm = NARROW * line.width_mm, ROUND_END * line.width_mm
        return line.passes_its_end(near_mm, round_mm) is not None
    step_mm = STEP * line.width_mm
    way = evenly(line.loop_mm, step_mm)
    return bool(beside_itself.stretches(way, step_mm, line.width_mm, NARROW, ROUND_END))


def _broken_at(sheet: Sheet, strokes: list[Line], width_mm: float) -> list[Unexplained] | None:
    """The bars of ink at which strokes may be a closed line that is broken: a few strokes make it up, and the
    others lie within bars, or go from side to side of one. None if they are no such line.
    """
    # 1. what makes up the line, and the others
    least_mm = OTHERS * strokes[0].length_mm
    parts = [stroke.places_mm for stroke in strokes if stroke.length_mm > least_mm]
    others = [stroke.places_mm for stroke in strokes[len(parts) :]]
    others_mm = sum(stroke.length_mm for stroke in strokes[len(parts) :])
    if len(strokes) == 1 or len(parts) > MOST_PARTS or others_mm > least_mm:
        return None
    # 2. the bars that the others lie within, or in which the parts end
    end_mm, short_mm = END * width_mm, THICK[1] * width_mm
    ends = [end for way in parts for end in (_up_to(way, end_mm), _up_to(way[::-1], end_mm))]
    within = [others] if others else [[end] for end in ends]
    bars = [bar for ways in within for bar in _bars(sheet, ways, width_mm)]
    thick = [Unexplained(bar.place_mm, bar.long_mm, "broad") for bar in bars if bar.is_thick]
    if others:
        return thick if all(bar.is_thick or bar.long_mm < short_mm for bar in bars) else None
    return thick or None


def _up_to(way: Array, length_mm: float) -> Array:
    """The first places of a way (n, 2) mm, up to a length."""
    return way[: 2 + int(np.searchsorted(lengths_mm(way), length_mm))]


class _Bar(NamedTuple):
    """A bar of ink: its middle; how long it is, mm; whether it is thicker than a line, and no thicker than a
    narrow bay between two.
    """

    place_mm: tuple[float, float]
    long_mm: float
    is_thick: bool


def _bars(sheet: Sheet, ways: list[Array], width_mm: float) -> Iterator[_Bar]:
    """The bars of ink within which ways (n, 2) mm run."""
    pitch_mm = sheet.drawing.pitch_mm
    window = _Window.about(sheet, np.vstack(ways), 2 * width_mm)
    # 1. ways that lie together are one bar
    drawn = np.zeros(window.shape, np.uint8)
    for way in ways:
        px = window.pixels(way).reshape(-1, 1, 2).astype(np.int32)
        cv2.polylines(drawn, [px], False, 1, round(width_mm / pitch_mm))
    count, bars = cv2.connectedComponents(drawn)
    # 2. the ink in the narrowest box about each
    ink = np.asarray(window.of(sheet.drawing.darkness), float) > INK
    least, most = (times * width_mm for times in THICK)
    for number in range(1, count):
        box = cv2.minAreaRect(
            np.column_stack(np.nonzero(bars == number)[::-1]).astype(np.float32)
        )
        within = np.zeros(drawn.shape, np.uint8)
        cv2.fillConvexPoly(within, np.round(cv2.boxPoints(box)).astype(np.int32), 1)
        across_mm, long_mm = (pitch_mm * (side_px + 1) for side_px in sorted(box[1]))
        inked_mm2 = np.count_nonzero((within > 0) & ink) * pitch_mm**2
        is_thick = across_mm < most and float(inked_mm2) > least * long_mm
        yield _Bar(window.place_mm(*box[0]), long_mm, bool(is_thick))


def _contour(setup: Setup, number: int, strokes: list[Line]) -> Line | None:
    """The closed contour of a patch, if it explains the ink better than the strokes do."""
    asked, _ = selection.plan(setup.sheet, (number,))
    lines = with_bars(setup, one_of_each(setup, asked, "contours").lines)
    if len(lines) != 1 or lines[0].ending != "closed":
        return None
    (line,), left = explained(setup, lines)
    return line if not left and _is_better(setup.sheet, line, strokes) else None


def _is_better(sheet: Sheet, line: Line, strokes: list[Line]) -> bool:
    """Whether a line explains the ink where it differs from strokes, and these do not."""
    width_mm = min(line.width_mm, strokes[0].width_mm)
    step_mm = STEP * width_mm
    one = evenly(line.loop_mm, step_mm)
    other = np.vstack([evenly(stroke.loop_mm, step_mm) for stroke in strokes])
    mine = nearest_mm(one, other) > DIFFER * width_mm
    differ = np.vstack([one[mine], other[nearest_mm(other, one) > DIFFER * width_mm]])
    if not len(differ):
        return False
    ink = _ink_about(sheet, differ, width_mm)
    own_misfit, misfit = (
        ink.misfit(ink.best_drawn(nearest_mm(ink.places_mm, way))) for way in (other, one)
    )
    widths = STEP * np.count_nonzero(nearest_mm(one, differ) < REACH * width_mm)
    return bool(misfit < LIKE * widths and misfit < own_misfit - GAIN * widths)


def _ink_about(sheet: Sheet, places: Array, width_mm: float) -> SeenInk:
    """The ink about some places (n, 2) mm."""
    drawing, reach_mm = sheet.drawing, REACH * width_mm
    window = _Window.about(sheet, places, reach_mm)
    near = np.zeros(window.shape, np.uint8)
    column, row = window.pixels(places).T
    near[row, column] = 1
    across_px = 2 * round(reach_mm / drawing.pitch_mm) + 1
    reach = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (across_px,) * 2)
    i, j = np.nonzero(cv2.dilate(near, reach))
    every = 1 + len(i) // MOST_PLACES
    i, j = i[::every] + window.top, j[::every] + window.left
    nothing_mm = np.full(len(i), NOWHERE_MM)
    return SeenInk.of(drawing, i, j, nothing_mm, width_mm, every)


class _Window(NamedTuple):
    """A part of a sheet: its first row and column, the one after its last, and what makes pixels of mm."""

    top: int
    left: int
    bottom: int
    right: int
    rows: int
    pitch_mm: float

    @classmethod
    def about(cls, sheet: Sheet, places: Array, reach_mm: float) -> _Window:
        """About some places (n, 2) mm, as far as that."""
        pitch_mm, (rows, columns) = sheet.drawing.pitch_mm, sheet.drawing.darkness.shape
        low, high = places.min(axis=0) - reach_mm, places.max(axis=0) + reach_mm
        left, top = max(int(low[0] / pitch_mm), 0), max(int(rows - high[1] / pitch_mm), 0)
        right = min(int(high[0] / pitch_mm) + 2, columns)
        bottom = min(int(rows - low[1] / pitch_mm) + 2, rows)
        return cls(top, left, bottom, right, rows, pitch_mm)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.bottom - self.top, self.right - self.left

    def of(self, pixels: NDArray[np.generic]) -> NDArray[np.generic]:
        """The part of all pixels of the sheet."""
        return pixels[self.top : self.bottom, self.left : self.right]

    def pixels(self, places: Array) -> NDArray[np.int64]:
        """Column and row (n, 2) within it of places (n, 2) mm on the sheet."""
        column = (places[:, 0] / self.pitch_mm).astype(int) - self.left
        row = (self.rows - places[:, 1] / self.pitch_mm).astype(int) - self.top
        rows, columns = self.shape
        return np.column_stack([np.clip(column, 0, columns - 1), np.clip(row, 0, rows - 1)])

    def place_mm(self, column: float, row: float) -> tuple[float, float]:
        """The place on the sheet of the middle of a pixel within it."""
        x_px, y_px = self.left + column + 0.5, self.rows - self.top - row - 0.5
        return x_px * self.pitch_mm, y_px * self.pitch_mm
