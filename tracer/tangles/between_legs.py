"""A tangle between legs: the ink of a junction whose legs are known, as far as their clean ends.

Signals: how the head sees the lines, and their legs as they come in, in; the tangle out.

    ──┤▒▒▒▒▒▒├──       the ink is cut off across each leg at its clean end; what hangs together with the
        ▒▒▒▒           ends between them is the tangle's
      ──┤  ├──

Source: our own; where legs are not known yet a wave finds them (see `tangle`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import cv2
import numpy as np

from morfax.motion.plane import direction, left_of
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.tangle import Tangle, ink_of

# Chosen by trial on drawings of nets.
MARGIN = 2.0  # widths of the line: ink about the legs' ends
CUT = 1.0, 1.2  # widths before a leg's clean end and to either side of it: its own ink


def tangle_between(view: View, legs: Sequence[Leg]) -> Tangle | None:
    """The ink between legs that come in, the first of them the way in; None if it does not hang together, or
    leads on elsewhere.
    """
    pitch, width_mm = view.pitch_mm, view.width_mm
    # 1. the ink about the legs' ends
    ends = np.array([leg.end_mm for leg in legs])
    seen, (top, left), places = view.seen_about(ends, MARGIN * width_mm)
    ink = seen > view.level
    # 2. cut off across the legs
    for leg in legs:
        come = places - leg.end_mm
        t = direction(leg.heading_rad)
        before_mm, aside_mm = -(come @ t), np.abs(come @ left_of(t))
        ink &= ~(
            (before_mm > 0) & (before_mm < CUT[0] * width_mm) & (aside_mm < CUT[1] * width_mm)
        )
    # 3. what hangs together with each of them
    _, label = cv2.connectedComponents(ink.view(np.uint8), connectivity=4)
    ahead, sheet_rows = [leg.at(pitch) for leg in legs], view.cells.shape[0]
    found = {
        int(label[math.floor(sheet_rows - y / pitch) - top, math.floor(x / pitch) - left])
        for x, y in ahead
    }
    inside = label == min(found)
    rim = np.ones(inside.shape, bool)
    rim[1:-1, 1:-1] = False
    if len(found) > 1 or 0 in found or (inside & rim).any():
        return None
    own = [legs[0], *(leg.turned_round() for leg in legs[1:])]
    return Tangle(own, *ink_of(view, inside, (top, left)), whole=True)
