"""Gaps that the pen has left in its line: where nobody sets the widest gap, the drawing does.

Signals: a drawing, the line's settings and the head's in; the gap to cross out, mm.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from morfax.jobs.settings import LineSettings
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.head.settings import Settings


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
