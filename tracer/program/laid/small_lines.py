"""Small lines: dots that stand alone, and slots whose sides run together.

Signals: the set-up in; each with its patch of ink and numbered on from the patches that are lines, out.

Source: the drill points of patent ES 361967 are dots on guide lines; a dot alone and a slot are our own.
"""

from __future__ import annotations

import numpy as np

from morfax.tracer.following.line import Line
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.marks import dots
from morfax.tracer.program.laid.small_loops import Loop, SmallLoops
from morfax.tracer.program.lines import selection
from morfax.tracer.program.lines.small_rings import maybe_slots
from morfax.tracer.program.setup import Setup


def small_lines(setup: Setup) -> list[tuple[int, Line]]:
    """The dots that stand alone on the paper, and slots whose sides run together: patch, and line; numbered
    on from the patches that are lines.
    """
    sheet, slots = setup.sheet, dict[int, Loop]()
    if not sheet.bare_rings and not sheet.drawing.edges_mm:
        loops = SmallLoops(sheet, setup.settings)
        tried = ((p, loops.of_patch(p, loops.pen_mm)) for p in maybe_slots(sheet))
        slots = {patch: loop for patch, loop in tried if loop is not None}
    first = len(selection.lines_of(sheet)) + 1
    small = _dots_alone(setup, set(slots), first)
    numbered = enumerate(slots.items(), first + len(small))
    return small + [(patch, loop.line(n)) for n, (patch, loop) in numbered]


def _dots_alone(setup: Setup, others: set[int], first: int) -> list[tuple[int, Line]]:
    """The dots that stand alone on the paper, numbered from a first on, without some patches: patch, and
    line.

    None of them is found if neither a line nor a setting shows how wide the pen is.
    """
    patches = selection.lines_of(setup.sheet)
    width_mm = setup.settings.line_width_mm
    if width_mm is None and not len(patches):
        return []
    width_mm = width_mm or float(np.median(setup.sheet.widths_mm[patches]))
    view = view_of(setup.sheet, setup.settings.aperture_mm, width_mm)
    alone = (dot for dot in dots.alone(setup.sheet, view) if dot[0] not in others)
    return [
        (patch, Line.of_dot(centre, width_mm, n))
        for n, (patch, centre) in enumerate(alone, first)
    ]
