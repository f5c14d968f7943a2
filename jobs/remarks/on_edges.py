"""Remarks on lines that the picture's edge cuts: of their ink a part is missing, so its middle is another.

Signals in: the traced lines, and how large the sheet is. Signals out: texts, each with what to do.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.long_array import bounds_by_blocks
from morfax.motion.polyline import steps_mm

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.program.program import Trace

# of a line's width along the edge: where a line only crosses the edge it is as near for half a width
ALONG_WIDTHS = 2.0


def of_picture_edge(trace: Trace, drawing: Drawing) -> Iterator[str]:
    """Lines of which the picture's edge cuts a pixel of ink or more."""
    sheet_mm = np.array([drawing.width_mm, drawing.height_mm])
    for line in () if drawing.edges_mm else trace.lines:
        if line.on_edge:
            continue
        xy_mm, cut_to_mm = line.xy_mm, 0.5 * line.width_mm - drawing.pitch_mm
        low_mm, high_mm = bounds_by_blocks(xy_mm)
        if min(*low_mm, *(sheet_mm - high_mm)) >= cut_to_mm:  # as nearly all lines
            continue
        is_cut = np.minimum(xy_mm, sheet_mm - xy_mm).min(axis=1) < cut_to_mm
        cut_mm = float(steps_mm(xy_mm)[is_cut[1:] & is_cut[:-1]].sum())
        if cut_mm > ALONG_WIDTHS * line.width_mm:
            x, y = xy_mm[np.argmax(is_cut)]
            yield (
                f"line {line.number} runs along the picture's edge for {cut_mm:.0f} mm, at {x:.1f},{y:.1f} "
                "mm: a part of its ink is cut off, and the path is in the middle of the rest; scan it with "
                "paper all round"
            )
