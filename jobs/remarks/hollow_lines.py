"""Hollow lines: traced lines that may be two, since their ink is paler in its middle than at its sides.

Signals in: the drawing, and the lines as the head followed them. Signals out: figures, a remark, and the
places that a picture marks.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from morfax.jobs.remarks.broad_lines import FINER
from morfax.jobs.remarks.on_lines import OnLines
from morfax.motion.by_number import and_so

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.drawing.hollow import Hollow
    from morfax.tracer.program.program import Trace


@dataclass(frozen=True, slots=True)
class HollowLines(OnLines):
    """The hollow stretches of lines, the longest first, and how to part them."""

    called, marked = "hollow_lines", "pale middle"
    rows = (
        ("hollow_place_mm", "place_mm"),
        ("hollow_mm", "length_mm"),
        ("dark_rows_apart_mm", "apart_mm"),
    )

    of_lines: tuple[tuple[int, Hollow], ...] = ()
    finer: str = ""

    @classmethod
    def along(cls, drawing: Drawing, trace: Trace) -> HollowLines:
        """The hollow lines among those that the head followed; edges are none."""
        from morfax.tracer.drawing import coarse
        from morfax.tracer.drawing.deviation import darkness_across
        from morfax.tracer.drawing.hollow import hollow

        seen, pitch_mm = partial(darkness_across, drawing), drawing.pitch_mm
        found = [
            (line.number, there)
            for line in trace.lines
            if not line.on_edge and not drawing.edges_mm and not line.is_dot
            if (there := hollow(seen, line.places_mm, line.width_mm, pitch_mm)) is not None
        ]
        found.sort(key=lambda row: -row[1].length_mm)
        scanned_mm = drawing.pitch_mm * drawing.finer
        wants_dpi = coarse.finer_dpi(scanned_mm, FINER)
        if drawing.seen_px < coarse.SEEN_PX:  # the drawing's own note advises that
            wants_dpi = max(wants_dpi, coarse.wanted_dpi(scanned_mm))
        return cls(tuple(found), coarse.at_dpi(wants_dpi, is_rendered=drawing.is_rendered))

    def _of(self, line: str, worst: Hollow, at: str, others: int) -> str:
        """That a line may be two, of which the path follows neither."""
        return (
            f"{line} is paler in its middle than at its sides along {worst.length_mm:.0f} mm, about "
            f"{at}{and_so(others, 'is', 'are')}: if two lines {worst.apart_mm:.2g} mm apart are drawn there, "
            f"the path runs between them; {self.finer} or more to part them; if the pen has "
            "left the middle paler, the path is right"
        )
