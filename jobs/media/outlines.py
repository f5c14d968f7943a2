"""Drawings from CAD for the jobs: the path of a DXF, an SVG or a plotter file.

Signals: a file in; out a Path with the tool in the work along its lines, inner ones before outer ones and the
idle way short. What was left out of the file goes to the listener.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.jobs.listener import Listener
from morfax.jobs.media import files as medium
from morfax.jobs.wrong_use import WrongUse

if TYPE_CHECKING:
    from morfax.motion.motion import Path
    from morfax.recorder.drawings.outline import CadOutline

MOST_ORDERED = 200  # contours; a way through more takes longer than it saves


def read_path(file: FilePath, unit: str | None, feed_mm_s: float, listener: Listener) -> Path:
    """The path of a drawing from CAD at a feed; raises DrawingFault, FileFault."""
    from morfax.recorder.media import read_outline

    with listener.progress("reading the drawing", 1.0):
        outline = read_outline(file, unit)
    for note in outline.notes:
        listener.note(note)
    listener.detail(f"{file}: {len(outline.contours_mm)} contours")
    return _in_order(outline).path(feed_mm_s)


def check_unit(unit: str | None, *files: FilePath) -> None:
    """Raise WrongUse for a unit that none of the files needs."""
    if unit is None or any(medium.kind_of(file) == "outline" for file in files):
        return
    names = " and ".join(map(str, files))
    raise WrongUse(
        f"--unit is for drawings from CAD, {', '.join(medium.OUTLINES)}; leave it out for {names}"
    )


def _in_order(outline: CadOutline) -> CadOutline:
    """The contours in the order of cutting: inner before outer, the idle way short."""
    contours = outline.contours_mm
    if not 1 < len(contours) <= MOST_ORDERED:
        return outline
    import numpy as np

    from morfax.motion.nesting import nested
    from morfax.tracer.program.lines.order import in_order_and_turned

    closed = [len(c) > 2 and bool((c[0] == c[-1]).all()) for c in contours]
    begins, ends = (np.array([contour[at] for contour in contours]) for at in (0, -1))
    may_turn = np.array([not is_closed for is_closed in closed])
    order, turned = in_order_and_turned(begins, ends, nested(contours, closed), may_turn)
    return replace(
        outline, contours_mm=tuple(contours[k][:: -1 if turned[k] else 1] for k in order)
    )
