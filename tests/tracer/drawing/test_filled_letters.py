"""Filled shapes in a row are parts, however like letters they are in height."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.tracer.drawing.lettering import lettering
from morfax.tracer.drawing.strokes import Sheet
from tests.tracer.drawing.test_lettering import FRAME, word
from tests.tracer.inked import inked


def test_what_is_filled_is_no_letter() -> None:
    """Of the word LVI the V is: two letters are left, and they are no word."""
    sheet = Sheet.of(inked(FRAME, *word(8, 8), width_mm=0.35, seed=1))
    letters = lettering(sheet)
    assert len(letters) == 3
    middle = sorted(letters, key=lambda patch: float(sheet.patches.boxes[patch, 2]))[1]
    is_filled = np.arange(sheet.patches.count) == middle
    filled = replace(sheet, are_solid=is_filled, _known={}, _asked={})
    assert lettering(filled) == set()
