"""The edges of solid areas: of those among lines, after the lines' strokes; of silhouettes all edges.

Signals: a Drawing that was read for both, and the Trace over its strokes, in; out a Trace over strokes and
outlines, which are numbered on.

Source: our own; the patent's follower has lines only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.shapes import NoShape, ShapeCut
from morfax.tracer.drawing.shapes_among_lines import edges_of
from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.left_out import Area, InkLeft
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.lines.lost_outlines import without_lost
from morfax.tracer.program.program import Trace
from morfax.tracer.program.setup import HeadProgress
from morfax.tracer.program.trace_lines import trace_lines

BESIDE_PX = 2.0  # an edge lies where the lens is half open, the box where a pixel is ink
HALF = 0.5  # of an outline's way: within an area's box it is that area's


def of_silhouettes(
    drawing: Drawing, settings: Settings, operator: Operator, progress: HeadProgress | None
) -> Trace:
    """Follow all edges of a sheet of silhouettes; raises DrawingFault if it has none."""
    edges = edges_of(drawing)
    found = trace_lines(edges, "contours", settings, operator, progress)
    whole, lost = without_lost(edges, found.lines)
    enlarged = _enlarged(edges, whole)
    return replace(found, lines=whole, lost_outlines=lost, enlarged=enlarged, notes=edges.notes)


def with_outlines(trace: Trace, drawing: Drawing, left: InkLeft, settings: Settings) -> Trace:
    """A trace of the lines that are left, and after them the edges of the solid areas."""
    assert trace.ink is not None
    ink = trace.ink._replace(outlines_asked=True)
    trace = replace(trace, ink=ink)
    if not left.packed_solid.any():
        return trace
    try:
        solid = edges_of(drawing, left.solid)
    except NoShape:  # all are too small; the balance lists them
        return trace
    except ShapeCut as cut:
        return replace(trace, notes=(f"left out: {cut}",))
    # crosses and ticks are ink on such a sheet: nothing stops the head at an edge either
    found = trace_lines(solid, "contours", settings)
    whole, lost = without_lost(solid, found.lines)
    last = max(line.number for line in trace.lines)
    outlines = [replace(line, number=last + line.number, on_edge=True) for line in whole]
    areas = tuple(_told(area, outlines, BESIDE_PX * drawing.pitch_mm) for area in ink.areas)
    return replace(
        trace,
        lines=(*trace.lines, *outlines),
        ink=ink._replace(areas=areas),
        lost_outlines=lost,
        enlarged=_enlarged(solid, outlines),
        notes=solid.notes,
    )


def _enlarged(edges: Drawing, outlines: Sequence[Line]) -> float:
    """How many times enlarged, at most, the head follows some outlines."""
    return max((edges.times_at(line.xy_mm[0]) for line in outlines), default=1.0)


def _told(area: Area, outlines: Sequence[Line], beside_mm: float) -> Area:
    """An area as outlined, if an outline runs within its box or beside it."""
    x0, y0 = (side - beside_mm for side in area.box_mm[:2])
    x1, y1 = (side + beside_mm for side in area.box_mm[2:])
    for line in outlines if area.what == "solid area" else ():
        x, y = line.places_mm.T
        within = (x0 <= x) & (x <= x1) & (y0 <= y) & (y <= y1)
        if np.mean(within) > HALF:
            return area._replace(what="outlined area")
    return area
