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

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import evenly, lengths_mm, nearest_mm
from morfax.tracer.drawing.discs import disc
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.program.against_ink.bars import THICK, bars_along
from morfax.tracer.program.against_ink.off_ink import REACH
from morfax.tracer.program.against_ink.own_ink import STATION_WIDTHS
from morfax.tracer.program.against_ink.unexplained import Unexplained
from morfax.tracer.program.against_ink.window import SheetWindow
from morfax.tracer.program.laid.line_parts import is_clear
from morfax.tracer.program.laid.narrow_bays import explained, with_bars
from morfax.tracer.program.lines import selection
from morfax.tracer.program.lines.small_rings import pen_mm
from morfax.tracer.program.one_of_each import one_of_each
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import beside_itself
from morfax.tracer.tangles.distances import NOWHERE_MM
from morfax.tracer.tangles.seen_ink import GAIN, LIKE, SeenInk

# In widths of the line, chosen by trial on plates with notches and tongues:
# sides so near to each other, with so much way between them, have a narrow end
NARROW, ROUND_END = 2.6, 6.0
END = 5.0  # of a stroke: shows whether it ends in a bar
OTHERS = 0.3  # of the longest stroke: a shorter one is no part of the contour, nor are all those together
MOST_PARTS = 4  # strokes that make up the contour; a patch with more is a net
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
            may_close = bars is not None and not _has_free_end(setup.sheet, strokes, width_mm)
            if may_close or _is_folded(strokes):
                line = _contour(setup, numbers[patch], strokes)
        if line is not None:
            kept.append(line)
        else:
            kept += strokes
            left += bars or []
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
    step_mm = STATION_WIDTHS * line.width_mm
    way = evenly(line.loop_mm, step_mm)
    return bool(beside_itself.stretches(way, step_mm, line.width_mm, NARROW, ROUND_END))


def _broken_at(sheet: Sheet, strokes: list[Line], width_mm: float) -> list[Unexplained] | None:
    """The bars of ink at which strokes may be a closed line that is broken: a few strokes make it up, and the
    others lie within bars, or go from side to side of one. None if they are no such line.
    """
    # 1. what makes up the line, and the others
    parts, others = _parts_and_others(strokes)
    others_mm = sum(stroke.length_mm for stroke in others)
    too_much = others_mm > OTHERS * strokes[0].length_mm
    if len(strokes) == 1 or len(parts) > MOST_PARTS or too_much:
        return None
    # 2. the bars that the others lie within, or in which the parts end
    end_mm, short_mm = END * width_mm, THICK[1] * width_mm
    ways = [stroke.places_mm for stroke in parts]
    ends = [end for way in ways for end in (_up_to(way, end_mm), _up_to(way[::-1], end_mm))]
    bars = bars_along(sheet, [stroke.places_mm for stroke in others] or ends, width_mm)
    thick = [Unexplained(bar.place_mm, bar.long_mm, "broad") for bar in bars if bar.is_thick]
    if not others:
        return thick or None
    # 3. one that the head felt to be as broad is a bar, however bent; another may be a line
    slim = [each.places_mm for each in others if each.width_mm < THICK[0] * width_mm]
    may_be = bars_along(sheet, slim, width_mm)
    return thick if all(bar.is_thick or bar.long_mm < short_mm for bar in may_be) else None


def _parts_and_others(strokes: list[Line]) -> tuple[list[Line], list[Line]]:
    """The strokes that may make up a closed line, and the others."""
    least_mm = OTHERS * strokes[0].length_mm
    parts, others = list[Line](), list[Line]()
    for stroke in strokes:
        is_part = stroke.ending == "closed" or stroke.length_mm > least_mm
        (parts if is_part else others).append(stroke)
    return parts, others


def _has_free_end(sheet: Sheet, strokes: list[Line], width_mm: float) -> bool:
    """Whether one of the strokes that may make up a closed line ends on bare paper: in no bar, and beside no
    line. A closed line would leave it out.
    """
    end_mm, near_mm = END * width_mm, NARROW * width_mm
    for part in _parts_and_others(strokes)[0]:
        others = [stroke.places_mm for stroke in strokes if stroke is not part]
        ways = (part.places_mm, part.places_mm[::-1]) if part.ending != "closed" else ()
        for way in ways:
            end, further = np.split(way, [len(_up_to(way, end_mm))])
            lines_mm = np.vstack([further, *others])
            is_beside = len(lines_mm) and nearest_mm(end[:1], lines_mm)[0] < near_mm
            if not is_beside and not any(
                bar.is_thick for bar in bars_along(sheet, [end], width_mm)
            ):
                return True
    return False


def _up_to(way: Array, length_mm: float) -> Array:
    """The first places of a way (n, 2) mm, up to a length."""
    return way[: 2 + int(np.searchsorted(lengths_mm(way), length_mm))]


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
    step_mm = STEP_WIDTHS * width_mm
    one = evenly(line.loop_mm, step_mm)
    other = np.vstack([evenly(stroke.loop_mm, step_mm) for stroke in strokes])
    mine = nearest_mm(one, other) > step_mm
    differ = np.vstack([one[mine], other[nearest_mm(other, one) > step_mm]])
    if not len(differ):
        return False
    ink = _ink_about(sheet, differ, width_mm)
    own_misfit, misfit = (
        ink.misfit(ink.best_drawn(nearest_mm(ink.places_mm, way))) for way in (other, one)
    )
    widths = STEP_WIDTHS * np.count_nonzero(nearest_mm(one, differ) < REACH * width_mm)
    return bool(misfit < LIKE * widths and misfit < own_misfit - GAIN * widths)


def _ink_about(sheet: Sheet, places: Array, width_mm: float) -> SeenInk:
    """The ink about some places (n, 2) mm."""
    drawing, reach_mm = sheet.drawing, REACH * width_mm
    window = SheetWindow.about(sheet.drawing, places, reach_mm)
    near = np.zeros(window.shape, np.uint8)
    last = np.array(window.shape) - 1  # a place on the sheet's very edge is in its last pixel
    row, column = np.clip(window.pixels(places)[:, ::-1], 0, last).T
    near[row, column] = 1
    i, j = np.nonzero(cv2.dilate(near, disc(round(reach_mm / drawing.pitch_mm))))
    every = 1 + len(i) // MOST_PLACES
    i, j = i[::every] + window.top, j[::every] + window.left
    nothing_mm = np.full(len(i), NOWHERE_MM)
    return SeenInk.of(drawing, (i, j), nothing_mm, width_mm, every)
