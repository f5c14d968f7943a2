"""What the page gets of a drawing: its size, its lines by number, and which pixel belongs to which line.

Signals in: the result of the job `lines`. Signals out: plain values and two arrays: `numbers` (rows,
columns) uint16, 0 where no line is, and `picture` (rows, columns) uint8 of the sheet as the head sees it,
where that is not the scan itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.components import strips

if TYPE_CHECKING:
    from morfax.jobs.lines import LinesResult
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.program.survey import Survey

LARGEST_NUMBER = np.iinfo(np.uint16).max
LEFT_OUT = LARGEST_NUMBER  # ink that has no number, ...
LETTERING = LARGEST_NUMBER - 1  # ... and likely letters
WHITE = 255


def of_lines(result: LinesResult) -> dict[str, Any]:
    """The drawing and its lines for the page."""
    drawing = result.drawing
    is_scan = drawing.flattening is None and drawing.enlarged == 1 and drawing.corrected is None
    return {
        "figures": result.figures,
        "pitch_mm": drawing.pitch_mm,
        "width_mm": drawing.width_mm,
        "height_mm": drawing.height_mm,
        "rows": drawing.darkness.shape[0],
        "columns": drawing.darkness.shape[1],
        "corrections": corrections_of(drawing),
        "numbers": numbers_of_pixels(result.survey),
        "picture": None if is_scan else picture_of(drawing),
    }


def corrections_of(drawing: Drawing) -> list[dict[str, Any]]:
    """The corrections by number: what each does, and where."""
    laid = drawing.corrected
    if laid is None:
        return []
    return [
        {
            "number": number,
            "do": one.do,
            "place_mm": list(laid.place_of(number)),
            "why": one.why,
        }
        for number, one in enumerate(laid.corrections.each, 1)
    ]


def numbers_of_pixels(seen: Survey) -> NDArray[np.uint16]:
    """The number of the line that each pixel of ink belongs to; (rows, columns)."""
    patches = seen.sheet.patches
    rows, columns = seen.sheet.drawing.darkness.shape
    of_patch = np.full(patches.count, LEFT_OUT, np.uint16)
    of_patch[list(seen.lettering)] = LETTERING
    for entry in seen.entries:
        if entry.joined_to is None:
            of_patch[entry.patch] = min(entry.number, LETTERING - 1)
    numbers = np.zeros(rows * columns, np.uint16)
    lengths = (patches.end - patches.begin).astype(np.int64)
    first = patches.row.astype(np.int64) * columns + patches.begin
    # each run's pixels: its first index, and 0, 1, 2 … from there
    within = np.arange(int(lengths.sum())) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    numbers[np.repeat(first, lengths) + within] = np.repeat(of_patch[patches.patch], lengths)
    return numbers.reshape(rows, columns)


def picture_of(drawing: Drawing) -> NDArray[np.uint8]:
    """The sheet as the head sees it, paper white and ink black; (rows, columns)."""
    picture = np.empty(drawing.darkness.shape, np.uint8)
    for top, bottom, _ in strips(drawing.darkness.shape):
        paper = WHITE * (1.0 - np.clip(drawing.darkness[top:bottom], 0.0, 1.0))
        picture[top:bottom] = paper.astype(np.uint8)
    return picture
