"""Inner rings: closed lines that are too short to be lines by themselves, but lie inside one.

    ┌──────────┐      a circle of 1 mm is as long as a letter is; inside the outline of a part, and not in a
    │  ∘    ∘  │      row of letters, it is a hole
    └──────────┘

Signals: a Sheet and its lines in; the patches that are holes out.

Source: our own; the patent's operator sees what is meant. Questions: a small o that stands alone inside an
outline is taken for a hole.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.median import median
from morfax.tracer.drawing.enclosure import NONE
from morfax.tracer.drawing.lettering import lettering
from morfax.tracer.drawing.strokes import Sheet

LEAST_WIDTHS = 2.0  # across, the ink with it: a smaller patch is a dot, whatever light is in it
LEAST_PX = 4  # of paper within: fewer are a speck in the ink


def inner_rings(sheet: Sheet, lines: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The patches that go round one area of paper, and lie inside a patch that is one of the lines."""
    none = np.empty(0, np.int64)
    if sheet.bare_rings or sheet.drawing.edges_mm or not lines.any():
        return none
    across_mm = sheet.patches.longer_sides * sheet.drawing.pitch_mm
    small = ~lines & (across_mm > LEAST_WIDTHS * median(sheet.widths_mm[lines]))
    if not small.any():
        return none
    enclosure = sheet.patches.enclosure
    small &= enclosure.loops(np.full(len(small), float(LEAST_PX))) == 1
    small &= (enclosure.inside != NONE) & lines[enclosure.inside]
    small[sorted(lettering(sheet))] = False
    return np.flatnonzero(small)
