"""Marks: whether ticks and dots on the lines of a drawing are stops and holes of a drawn program, or ink.

Signals: lines as they were followed in; out the same lines, with their marks or without, and how many ticks
and dots were taken for ink.

On a page of drawings and handwriting, strokes across a line and full stops beside it are no orders to a
machine. A dot that stands alone is a hole of a drawn program, and a speck on any other sheet.

Source: patent ES 361967, section on use, has a reference point in every program; see `operator`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator


def with_marks_read(lines: Sequence[Line], operator: Operator) -> tuple[list[Line], int]:
    """Some lines of a drawing as the operator takes them, and how many ticks and dots were taken for ink."""
    if operator.reads_marks(lines):
        return list(lines), 0
    unread = sum(mark.correction == 0 for line in lines for mark in line.marks)
    told = [tuple(mark for mark in line.marks if mark.correction) for line in lines]
    kept = [replace(line, marks=marks) for line, marks in zip(lines, told, strict=True)]
    return [line for line in kept if not line.is_dot], unread
