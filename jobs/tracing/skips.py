"""Gaps that the pen has left in its line: where nobody sets the widest gap, the drawing does.

Signals: a drawing, the line's settings and the head's in; the gap to cross out, mm; and, of what was traced,
remarks on small lines that skips have left in pieces too short for lines.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from morfax.jobs.settings.settings import LineSettings
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.head.settings import Settings
    from morfax.tracer.program.program import Trace

# by trial on holes drawn with a pencil: shorter ink is a speck, and fewer pieces are burrs and blots
PIECE_WIDTHS, FEWEST_PIECES = 2.0, 3


def gap_across_skips(drawing: Drawing, line: LineSettings, of_head: Settings) -> float | None:
    """The widest gap, mm, where the pen has skipped; None if it has not, or if a gap was set.

    What the operator has put right does not count: a gap that is closed was the pen's too.
    """
    from morfax.tracer.drawing.skips import gap_to_cross_mm
    from morfax.tracer.head.settings import Settings

    is_set = line.gap_mm is not None or of_head.gap_mm != Settings().gap_mm
    if is_set or drawing.edges_mm:
        return None
    gap_mm = gap_to_cross_mm((drawing.bare or drawing).sheet)
    return gap_mm if gap_mm is not None and gap_mm > of_head.gap_mm else None


def of_pieces(drawing: Drawing, trace: Trace, of_head: Settings) -> Iterator[str]:
    """Where the pen has skipped: pieces of ink too short for contours, and on no line that was followed."""
    from morfax.motion.polyline import nearest_mm
    from morfax.tracer.head.settings import Settings
    from morfax.tracer.program.lines import selection

    if drawing.edges_mm or of_head.gap_mm <= Settings().gap_mm:
        return
    sheet = drawing.sheet
    short = np.ones(sheet.patches.count, bool)
    short[selection.lines_of(sheet)] = False
    short &= (sheet.lengths_mm > PIECE_WIDTHS * sheet.widths_mm) & ~sheet.are_solid
    pieces = np.flatnonzero(short)
    if len(pieces) < FEWEST_PIECES:
        return
    middles_mm = sheet.middles_mm(pieces)
    away_mm = np.full(len(pieces), np.inf)
    for line in trace.lines:
        away_mm = np.minimum(away_mm, nearest_mm(middles_mm, line.places_mm))
    alone = away_mm > sheet.lengths_mm[pieces]
    if np.count_nonzero(alone) < FEWEST_PIECES:
        return
    lengths_mm = np.where(alone, sheet.lengths_mm[pieces], 0.0)
    x, y = middles_mm[np.argmax(lengths_mm)]
    yield (
        f"{np.count_nonzero(alone)} pieces of ink, {lengths_mm.sum():.0f} mm in all, are too short to be"
        f" contours and lie on no line that is traced, the longest at {x:.1f},{y:.1f} mm: if they are a small"
        " line in which the pen has skipped, draw it over; --lines all follows all ink"
    )
