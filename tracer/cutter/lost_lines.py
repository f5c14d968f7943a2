"""Lost lines beside a cutter: what has an outside and an inside when a line was lost, and what has not.

Signals: a Trace, the side of the cutter, and the lines round which a lost line may go, in; the lines out,
each with what is cut of it, or with the fault that says why nothing is.

    ┌─ 1 ─────────┐    line 1 is lost at x. Its traced part is open: it has no outside. Line 2 may be a hole
    │    ( 2 )    │    of it or a part beside it; outside of a part is inside of a hole, so it is not cut
    └──────── x   │

On the left or the right of their travel all are cut, as far as they were traced.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Literal

from morfax.motion.faults import LineFault
from morfax.tracer.cutter.contour import Cut, planned
from morfax.tracer.following.line import Line
from morfax.tracer.program.program import Trace

CutterSide = Literal["outside", "inside", "left", "right"]


def with_sides(
    trace: Trace, side: CutterSide, in_lost: Mapping[int, int]
) -> list[tuple[Line, Cut | None]]:
    """The lines with the numbers of their stops, each with what is cut of it on a side.

    `in_lost` has the lines round which a lost line may go, each with the number of that. Raises LineFault if
    nothing is left to cut.
    """
    lines = planned(trace)
    if side in ("outside", "inside"):
        for k, (line, _) in enumerate(lines):
            if line.ending == "lost":
                lines[k] = _not_cut(line, _lost(line, side)), None
            elif line.number in in_lost:
                lines[k] = _not_cut(line, _in_doubt(line, in_lost[line.number], side)), None
    if lines and all(line.ending == "lost" and cut is None for line, cut in lines):
        lost = replace(trace, lines=tuple(line for line, _ in lines))
        raise lost.fault or LineFault("no line was followed")
    return lines


def _not_cut(line: Line, fault: LineFault) -> Line:
    """A line of which nothing is run, and the fault that says why."""
    return replace(
        line,
        xy_mm=line.xy_mm[:1],
        ending="lost",
        loop_from=None,
        marks=(),
        guides=(),
        numbers=(),
        fault=fault,
    )


def _lost(line: Line, side: CutterSide) -> LineFault:
    """The fault of a line that was lost, and has no such side."""
    lost = line.fault or LineFault("the line was lost")
    return LineFault(
        f"{lost}; the traced part is open and has no {side}, so it is not cut;"
        " --side left or right cuts it, by its travel",
        x_mm=lost.x_mm,
        y_mm=lost.y_mm,
        heading_rad=lost.heading_rad,
    )


def _in_doubt(line: Line, outer: int, side: CutterSide) -> LineFault:
    """The fault of a line round which a lost one may go."""
    x, y = line.start_mm
    return LineFault(
        f"line {line.number} may be a hole of line {outer}, which was lost: its {side} is not known, and it"
        f" is not cut; mend line {outer}, or cut it alone: --lines {line.number} --side inside for a hole",
        x_mm=x,
        y_mm=y,
    )
