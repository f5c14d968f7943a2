"""Closing: where a cut line comes back onto itself, without the leads to it and from it.

Signals in: the blocks of a line, the first of them its beginning, places in mm. Signals out: the indices
between which the line goes round.

    lead-in  ____        first: the line is reached      last: it is there again
                 \\___   ┌──────────────────────┐
                     `──┤first             last ├──  lead-out
                        └──────────────────────┘

Source: our own. Questions: a line counts as closed if it meets, in its last fifth, a place of its first fifth
where a block ends; leads are shorter than that.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from morfax.recorder.gcode.arc_places import length_mm
from morfax.recorder.gcode.program_text import Block

# a closed trace ends within 0.01 mm of its start, a fine line's noise on a scan is as wide
CLOSED_MM = 0.05
LEAD_SHARE = 0.2  # of the length, that a lead-in or a lead-out may have


def loop(line: Sequence[Block]) -> tuple[int, int] | None:
    """The indices of the blocks at whose ends a line begins and ends to go round; None if it is open."""
    steps_mm = [length_mm(before.place_mm, block) for before, block in pairwise(line)]
    along_mm = np.r_[0.0, np.cumsum(steps_mm)]
    whole_mm = along_mm[-1]
    if whole_mm <= 10 * CLOSED_MM:
        return None
    first = np.flatnonzero(along_mm <= LEAD_SHARE * whole_mm)
    last = np.flatnonzero(along_mm >= (1 - LEAD_SHARE) * whole_mm)
    places = np.array([block.place_mm[:2] for block in line])
    gaps_mm = np.hypot(*(places[first][:, None] - places[last][None]).transpose(2, 0, 1))
    rows, columns = np.nonzero(gaps_mm <= CLOSED_MM)
    if not len(rows):
        return None
    longest = int(np.argmax(along_mm[last[columns]] - along_mm[first[rows]]))
    return int(first[rows[longest]]), int(last[columns[longest]])
