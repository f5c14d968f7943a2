"""Taken ink: patches along which lines were followed, and onto which the head goes from no other patch.

    ━━━━━━━━┓      a stroke ends a hair before another line: across the gap, or through ink that runs together
    ───●    ┃      behind the cell's aperture, the head would go on along what it has run before
            ┃

Signals: lines that were followed in; the set-up for a line beside them out.

Source: our own; what is cut already, an operator does not cut again.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array, bounds
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.effort import SOME_PLACES
from morfax.tracer.following.line import Line
from morfax.tracer.program.nets.net_outline import may_solve
from morfax.tracer.program.setup import Setup


def kept_off(setup: Setup, taken: Iterable[int]) -> Setup:
    """The set-up for a line that goes onto none of some patches."""
    patches = frozenset(taken)
    if patches == setup.sheet.taken:
        return setup
    sheet = replace(setup.sheet, taken=patches)
    sheet.seen.update(setup.sheet.seen)  # the cells see the same
    return replace(setup, sheet=sheet)


def taken_by(setup: Setup, lines: Sequence[Line]) -> set[int]:
    """The patches along which some lines run; none where somebody says which way the head goes."""
    if not may_solve(setup) or setup.operator.reads_marks(lines):
        return set()
    return set().union(*(patches_of(setup.sheet, line) for line in lines))


def patches_of(sheet: Sheet, line: Line) -> set[int]:
    """The patches of ink along which a line runs; of one that was lost none: another may run along them."""
    if line.ending == "lost" or len(line.xy_mm) < 2:
        return set()
    places = line.places_mm[:: max(1, len(line.places_mm) // SOME_PLACES)]
    first = sheet.patch_at(places[0])
    if _lies_in(places, sheet, first):
        return {first}
    return {first, *(sheet.patch_at(place) for place in places)}


def _lies_in(places: Array, sheet: Sheet, patch: int) -> bool:
    """Whether places (n, 2) mm lie in the box of a patch."""
    top, bottom, left, right = sheet.patches.boxes[patch].tolist()
    rows, pitch_mm = sheet.drawing.darkness.shape[0], sheet.drawing.pitch_mm
    low_mm, high_mm = bounds(places)
    is_low = low_mm >= np.array([left, rows - bottom]) * pitch_mm
    return bool((is_low & (high_mm <= np.array([right, rows - top]) * pitch_mm)).all())
