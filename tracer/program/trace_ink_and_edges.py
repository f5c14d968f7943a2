"""All the ink of a drawing with solid areas: its lines in strokes, then the edges of the solid areas.

Signals: a Drawing that was read for both in; out a Trace over strokes and outlines, which are numbered on.

Source: our own; the patent's follower has lines only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from morfax.motion.faults import DrawingFault
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.shapes_among_lines import edges_of, has_lines
from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.left_out import FOLLOWED_MM, Area, InkLeft, ink_left
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.program import Trace
from morfax.tracer.program.setup import HeadProgress
from morfax.tracer.program.trace_ink import trace_left
from morfax.tracer.program.trace_lines import trace_lines

HALF = 0.5  # of an outline's way: within an area's box it is that area's


def trace_ink_and_edges(
    drawing: Drawing,
    settings: Settings | None = None,
    operator: Operator | None = None,
    progress: HeadProgress | None = None,
    letters_from_mm: float = FOLLOWED_MM,
) -> Trace:
    """Follow the lines of a drawing, and the edges of its solid areas; of silhouettes all edges.

    Raises LineFault if the head can be put down nowhere, DrawingFault for silhouettes that have no edges.
    """
    settings = settings or Settings()
    if not has_lines(drawing):
        edges = edges_of(drawing)
        found = trace_lines(edges, "contours", settings, operator, progress)
        return replace(found, enlarged=_enlarged(edges, found.lines), notes=edges.notes)
    left = ink_left(drawing.sheet, letters_from_mm)
    trace = trace_left(drawing.sheet, left, settings, operator, progress)
    solid = _edges(drawing, left)
    if solid is None:
        return trace
    # crosses and ticks are ink on such a sheet: nothing stops the head at an edge either
    found = trace_lines(solid, "contours", settings)
    last = max(line.number for line in trace.lines)
    outlines = [replace(line, number=last + line.number, on_edge=True) for line in found.lines]
    assert trace.ink is not None
    areas = tuple(_told(area, outlines) for area in trace.ink.areas)
    return replace(
        trace,
        lines=(*trace.lines, *outlines),
        ink=trace.ink._replace(areas=areas),
        enlarged=_enlarged(solid, outlines),
        notes=solid.notes,
    )


def _enlarged(edges: Drawing, outlines: Sequence[Line]) -> int:
    """How many times enlarged, at most, the head follows some outlines."""
    return max((edges.times_at(line.xy_mm[0]) for line in outlines), default=1)


def _edges(drawing: Drawing, left: InkLeft) -> Drawing | None:
    """The edges of a drawing's solid areas; None if there are none, or too small ones only."""
    if not left.solid.any():
        return None
    try:
        return edges_of(drawing, left.solid)
    except DrawingFault:
        return None


def _told(area: Area, outlines: Sequence[Line]) -> Area:
    """An area as outlined, if an outline runs within its box."""
    x0, y0, x1, y1 = area.box_mm
    for line in outlines if area.what == "solid area" else ():
        x, y = line.places_mm.T
        within = (x0 <= x) & (x <= x1) & (y0 <= y) & (y <= y1)
        if np.mean(within) > HALF:
            return area._replace(what="outlined area")
    return area
