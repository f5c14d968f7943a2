"""Cut lines as chords: places in mm, for media without arcs, and how far they reach.

Signals in: cut lines, and how far a chord may be from its arc, mm. Signals out: places in mm.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.usual import PLOTTER_MM
from morfax.recorder.drawings.curve_chords import bulged
from morfax.recorder.drawings.cut_lines import CutLine, Place

WITHIN_MM = PLOTTER_MM / 2


def chords(line: CutLine, within_mm: float = WITHIN_MM) -> list[Place]:
    """Places of a line after its first, arcs as chords that stay within a distance of them."""
    places, begin = list[Place](), line.begin_mm
    for piece in line.pieces:
        if piece.turned_rad:
            ends = np.array(begin), np.array(piece.end_mm)
            arc = bulged(*ends, piece.turned_rad, within_mm)
            places += [(float(x), float(y)) for x, y in arc[:-1]]
        places.append(piece.end_mm)
        begin = piece.end_mm
    return places


def box(lines: list[CutLine]) -> tuple[Place, Place]:
    """Lower left and upper right corner of all that is cut, mm."""
    places = [place for line in lines for place in (line.begin_mm, *chords(line))]
    x_mm, y_mm = zip(*places, strict=True)
    return (min(x_mm), min(y_mm)), (max(x_mm), max(y_mm))
