"""Narrow gaps: traced lines that run over the paper between two lines, where it is a pixel or two wide.

Signals in: the drawing, and the lines as the head followed them. Signals out: figures, a remark, and the
places that a picture marks.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from morfax.jobs.remarks.on_lines import OnLines
from morfax.motion.by_number import and_so

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.drawing.narrow import NarrowGap
    from morfax.tracer.program.program import Trace


@dataclass(frozen=True, slots=True)
class NarrowGaps(OnLines):
    """The narrow gaps that lines run over, the longest first; the width of two pixels, mm, and how to part
    the lines.
    """

    called, marked = "narrow_gaps", "narrow gap"
    rows = (
        ("narrow_place_mm", "place_mm"),
        ("narrow_mm", "length_mm"),
    )

    of_lines: tuple[tuple[int, NarrowGap], ...] = ()
    wide_mm: float = 0.0
    finer: str = ""

    @classmethod
    def along(cls, drawing: Drawing, trace: Trace) -> NarrowGaps:
        """The narrow gaps on the ways of the lines that the head followed."""
        from morfax.tracer.drawing import coarse
        from morfax.tracer.drawing.narrow import NARROW_PX, PARTED, narrow_gaps

        lines = [line for line in trace.lines if not line.on_edge and not line.is_dot]
        gaps = narrow_gaps(drawing, [(line.places_mm, line.width_mm) for line in lines])
        found = [
            (line.number, gap) for line, gap in zip(lines, gaps, strict=True) if gap is not None
        ]
        found.sort(key=lambda row: -row[1].length_mm)
        scanned_mm = drawing.pitch_mm * drawing.finer
        wants_dpi = coarse.finer_dpi(scanned_mm, PARTED)
        finer = coarse.at_dpi(wants_dpi, is_rendered=drawing.is_rendered)
        return cls(tuple(found), NARROW_PX * scanned_mm, finer)

    def _of(self, line: str, worst: NarrowGap, at: str, others: int) -> str:
        """That a path may go over from one line to another."""
        return (
            f"{line} runs over the paper between two lines at {at}{and_so(others, 'does', 'do')}: that is at "
            f"most two pixels ({self.wide_mm:.2g} mm) wide along {worst.length_mm:.0f} mm, and the path may "
            f"go over from one line to the other; {self.finer} or more to part the two lines"
        )
