"""Around: ink that goes round a closed line, or may go round it, and is not cut with it.

Signals: a Drawing and the lines that were followed on it in; out for each closed line inside such ink the
numbers of both, and whether the ink is a line that was lost.

    ┌─ 1 ─────────┐    line 2 alone is asked for: it looks like the outline of a part, and is a hole of 1
    │    ( 2 )    │
    └──────── x   │    line 1 is lost at x: what lies in its hull may be its holes, or parts beside it

Which side of a line a cutter runs on hangs on what lies round it (`tracer.cutter`); who is asked for lines by
number, or loses one, has to know.

Source: our own. Questions: a patch of ink with a gap goes round nothing (`drawing.enclosure`); that a hole
lies inside one is seen only where the line along it was lost.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.enclosure import NONE
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.effort import SOME_PLACES
from morfax.tracer.following.line import Line
from morfax.tracer.program.lines.selection import lines_of


class Around(NamedTuple):
    """A closed line, by its number, and the line round it, which was lost, or was not asked for."""

    line: int
    outer: int
    is_lost: bool


def around(drawing: Drawing, lines: Sequence[Line]) -> list[Around]:
    """The closed lines that lie, or may lie, inside ink that is not cut, each with the nearest such line."""
    closed = [line for line in lines if line.comes_round and line.fault is None]
    if not closed:
        return []
    sheet = Sheet.of(drawing)
    # 1. lines that were lost: whatever lies in the hull of their ink
    found = dict[int, Around]()
    for lost in (line for line in lines if line.fault is not None):
        for number in _in_hull(sheet, lost, closed):
            found.setdefault(number, Around(number, lost.number, True))
    # 2. ink that was not asked for: by the paper that it goes round
    enclosure = sheet.patches.enclosure
    numbers = {int(patch): number for number, patch in enumerate(lines_of(sheet), 1)}
    followed = {patch for line in lines for patch in _patches(sheet, line)}
    for line in closed:
        patch = int(enclosure.inside[next(iter(_patches(sheet, line)))])
        while patch != NONE and (patch in followed or patch not in numbers):
            patch = int(enclosure.inside[patch])
        if patch != NONE:
            found.setdefault(line.number, Around(line.number, numbers[patch], False))
    return sorted(found.values())


def _in_hull(sheet: Sheet, lost: Line, closed: Sequence[Line]) -> Iterator[int]:
    """The numbers of the closed lines that lie in the hull of a lost line's ink."""
    hull = cv2.convexHull(_ink_mm(sheet, lost).astype(np.float32))
    for line in closed:
        x, y = line.place(0)
        if cv2.pointPolygonTest(hull, (x, y), False) > 0:
            yield line.number


def _patches(sheet: Sheet, line: Line) -> set[int]:
    """The patches of ink along which a line runs."""
    places = line.loop_mm[:: max(1, len(line.loop_mm) // SOME_PLACES)]
    return {sheet.patch_at(place) for place in places}


def _ink_mm(sheet: Sheet, line: Line) -> Array:
    """Places of the ink along which a line runs, (n, 2) mm."""
    runs = np.isin(sheet.patches.patch, list(_patches(sheet, line)))
    return np.vstack([sheet.run_middles_mm(np.flatnonzero(runs)), line.places_mm])
