"""Tracing of drawn programs without a reference point: the operator says that ticks and dots are marks."""

from __future__ import annotations

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program import trace as one
from morfax.tracer.program import trace_lines as several
from morfax.tracer.program.program import Trace

MARKED = Operator(marks="on")


def trace(
    drawing: Drawing,
    start_mm: tuple[float, float] | None = None,
    settings: Settings | None = None,
    operator: Operator = MARKED,
) -> Trace:
    """The line at a place, or the longest, with its marks."""
    return one.trace(drawing, start_mm, settings, operator)


def trace_lines(drawing: Drawing) -> Trace:
    """All contours, with their marks."""
    return several.trace_lines(drawing, operator=MARKED)
