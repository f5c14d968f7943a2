"""Broad lines: traced lines that may be two, since their ink is twice as wide as the sheet's pen draws.

Signals in: the drawing, and the lines as the head followed them. Signals out: figures, a remark, and the
places that a picture marks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from morfax.jobs.remarks.on_lines import OnLines
from morfax.motion.by_number import and_so

if TYPE_CHECKING:
    from morfax.motion.arrays import Array
    from morfax.tracer.drawing.broad import Broad
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.drawing.hollow import Seen
    from morfax.tracer.following.line import Line
    from morfax.tracer.program.program import Trace

FINER = 2.0  # times the resolution shows a gap that this one does not show
LOOKED_AT = 12  # lines that were not followed: they only show the pen


@dataclass(frozen=True, slots=True)
class BroadLines(OnLines):
    """The broad stretches of lines, the longest first; the width of the sheet's pen, mm, and how to see
    two lines.
    """

    called, marked = "broad_lines", "broad line"
    rows = (
        ("broad_place_mm", "place_mm"),
        ("broad_mm", "length_mm"),
        ("broad_width_mm", "width_mm"),
    )

    of_lines: tuple[tuple[int, Broad], ...] = ()
    pen_mm: float = 0.0
    finer: str = ""

    @classmethod
    def along(cls, drawing: Drawing, trace: Trace, told: frozenset[int]) -> BroadLines:
        """The broad lines among those that the head followed; edges are none, nor what is told as hollow."""
        import numpy as np

        from morfax.tracer.drawing import coarse
        from morfax.tracer.drawing.broad import broad, pen_of, widths_along
        from morfax.tracer.drawing.deviation import darkness_across
        from morfax.tracer.drawing.hollow import pieces_mm

        if drawing.edges_mm:
            return cls()
        lines = [line for line in trace.lines if not line.on_edge and not line.is_dot]
        seen, pitch_mm = partial(darkness_across, drawing), drawing.pitch_mm
        widths = [widths_along(seen, each.places_mm, each.width_mm, pitch_mm) for each in lines]
        # 1. the pen, by the lines that were followed and those that were not
        piece_mm, beside = pieces_mm(pitch_mm), _not_followed(drawing, seen, lines)
        known = np.concatenate([np.empty(0), *widths])
        known = known[np.isfinite(known)]
        shown_mm = np.r_[known, beside[:, 0]]
        pen_mm = pen_of(shown_mm, np.r_[np.full(len(known), piece_mm), beside[:, 1]])
        # 2. lines of which much is broader
        found = [
            (line.number, there)
            for line, wide in zip(lines, widths, strict=True)
            if line.number not in told
            and (there := broad(line.places_mm, wide, piece_mm, pen_mm)) is not None
        ]
        found.sort(key=lambda row: -row[1].length_mm)
        wants_dpi = coarse.finer_dpi(pitch_mm * drawing.finer, FINER)
        finer = coarse.at_dpi(wants_dpi, is_rendered=drawing.is_rendered)
        return cls(tuple(found), pen_mm, finer)

    def _of(self, line: str, worst: Broad, at: str, others: int) -> str:
        """That a line may be two, of which the path follows neither."""
        off_mm = 0.5 * (worst.width_mm - self.pen_mm)
        return (
            f"{line} is {worst.width_mm:.2g} mm wide along {worst.length_mm:.0f} mm, about "
            f"{at}{and_so(others, 'is', 'are')}, twice as wide as the sheet's pen "
            f"draws ({self.pen_mm:.2g} mm): if two lines run side by side there, the path runs between them, "
            f"{off_mm:.2g} mm or more off; {self.finer}, or draw them further apart; if a "
            "broader pen has drawn it, the path is right"
        )


def _not_followed(drawing: Drawing, seen: Seen, lines: list[Line]) -> Array:
    """Widths and lengths of the longest lines of the sheet that were not followed, (n, 2) mm."""
    import numpy as np

    from morfax.tracer.drawing.broad import width_of
    from morfax.tracer.program.lines.selection import lines_of

    sheet = drawing.sheet
    own = {sheet.patch_at(line.places_mm[0]) for line in lines}
    others = [patch for patch in lines_of(sheet).tolist() if patch not in own]
    rows = list[tuple[float, float]]()
    for stroke in (sheet.stroke(patch) for patch in others[:LOOKED_AT]):
        width_mm = width_of(seen, stroke.middles_mm, stroke.width_mm)
        if math.isfinite(width_mm):
            rows.append((width_mm, stroke.length_mm))
    return np.array(rows).reshape(-1, 2)
