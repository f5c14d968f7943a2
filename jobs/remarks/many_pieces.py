"""Many pieces: a sheet on which nearly all pieces of ink are too short to be lines is told of before it is
traced, which may take long; what is printed on the paper in another colour can be left out.

Signals in: a drawing. Signals out: texts, each with what to do.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing

# of the pieces of ink; of a fetched sketch on printed paper 0.92 are, of plans and maps at most 0.88
NEARLY_ALL = 0.9
FEWEST_PIECES = 200  # fewer take no time


def of_many_pieces(drawing: Drawing) -> Iterator[str]:
    """That nearly all pieces of ink are too short to be lines."""
    from morfax.tracer.program.lines import selection

    if drawing.edges_mm:
        return
    pieces = drawing.sheet.patches.count
    if pieces < FEWEST_PIECES:
        return
    short = pieces - len(np.unique(selection.lines_of(drawing.sheet)))
    if short < NEARLY_ALL * pieces:
        return
    if drawing.of_colour:
        yield (
            f"{short} of {pieces} pieces of the ink that you named are too short to be lines: if they are"
            " print or the grain of the paper, cut them off the picture"
        )
        return
    yield (
        f"{short} of {pieces} pieces of ink are too short to be lines: if they are printed in another"
        " colour than your lines, name the colour of yours, such as --ink black; if they are the grain"
        " of the paper, cut it off or raise the contrast"
    )
