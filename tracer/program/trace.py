"""One line as the operator traces it: the head put down, the line followed, and cut (see `program`).

Signals: a Drawing in; out a Trace, which is a stream of Motion (X, Y, Z in sheet mm at the motion rate) and
says how the line ended. Several lines: see `trace_lines`.

The line is the best of the head's runs from the places where it may be put down (see `best_run`). Where lines
cross or touch, or the head is lost on a line that closes, the junctions of its ink show the way round (see
`net_outline`).

Source: patent ES 361967, section on use: the operator brings the head over the drawing and lets it run.
"""

from __future__ import annotations

from dataclasses import replace

from morfax.motion.faults import LineFault
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.against_ink.unexplained import Unexplained, ink_beside
from morfax.tracer.program.head_runs import followed
from morfax.tracer.program.laid.explained import Explained, mended
from morfax.tracer.program.laid.line_parts import in_direction, is_bare, is_clear
from morfax.tracer.program.laid.small_loops import SmallLoops
from morfax.tracer.program.laid.touches import touching
from morfax.tracer.program.lines.marks_read import with_marks_read
from morfax.tracer.program.lines.selection import NO_OTHERS, others_than
from morfax.tracer.program.nets.net_outline import OfNet, may_solve, of_net
from morfax.tracer.program.program import Trace
from morfax.tracer.program.setup import HeadProgress, Setup


def trace(
    drawing: Drawing,
    start_mm: tuple[float, float] | None = None,
    settings: Settings | None = None,
    operator: Operator | None = None,
    progress: HeadProgress | None = None,
) -> Trace:
    """Follow a line of the drawing: the one at `start_mm` (sheet mm), or the longest; of lines that cross or
    touch the longest closed outline (see `net_outline`), or a longer closed way that the head finds.

    `progress` hears how far the head has come and the length of the line, mm. Raises LineFault if no line is
    there to start on, CardFault for a stop that the operator cannot serve; a line that is lost on the way is
    no exception, but the trace's `fault`.
    """
    operator = operator or Operator()
    setup = Setup(drawing.sheet, settings or Settings(), operator, progress)
    line = _way_round(setup, start_mm)
    others = NO_OTHERS if start_mm is not None else others_than(setup.sheet, line)
    # the way along the line is told, and has come to its end; the head's runs so far are given up
    setup = replace(setup, progress=None)
    told = _among_others(setup, line) if start_mm is None else None
    line = in_direction(told[0], operator.direction) if told else line
    lines, unread = with_marks_read([line], operator)
    lines, left, _ = Explained(lines, told[1]) if told else mended(setup, lines)
    return Trace(tuple(lines), operator, others=others, unread=unread, unexplained=left)


def _among_others(setup: Setup, line: Line) -> tuple[Line, tuple[Unexplained, ...]] | None:
    """The same line as it is where the others of its patch of ink are known; None if it has none, or they
    show no other.
    """
    if not _may_share(setup, line):
        return None
    from morfax.tracer.program.patch_lines import among_others

    return among_others(setup, line)


def _may_share(setup: Setup, line: Line) -> bool:
    """Whether a line may share its patch of ink with others, and nobody says where it goes: the patch goes
    round several areas, or round one and the line leaves ink of it.
    """
    if line.ending == "lost" or not is_bare(line) or not is_clear(setup.sheet.drawing):
        return False
    if not may_solve(setup) or setup.operator.reads_marks([line]):
        return False
    areas = int(setup.sheet.loops()[setup.sheet.patch_at(line.loop_mm[0])])
    is_round = line.ending == "closed" and areas > 1
    if is_round or areas == 0:
        return is_round
    return any(place.kind == "ink" for place in ink_beside(setup.sheet, [line]))


def _way_round(setup: Setup, start_mm: tuple[float, float] | None) -> Line:
    """The line at a place, or the longest, as the head ran along it, small loops and touches laid anew."""
    found = OfNet(setup) if start_mm is not None else of_net(setup)
    line = _along_net(found) or followed(found.setup, start_mm)
    line = SmallLoops(found.setup.sheet, setup.settings).mended(line)
    if start_mm is not None:
        return line
    return max(touching(found.setup, [line]), key=lambda each: each.length_mm)


def _along_net(found: OfNet) -> Line | None:
    """The line along the outline of a net; where that leaves bays out and the head finds a longer closed way
    through them, that.
    """
    if not found.leaves_out:
        return found.line
    assert found.line is not None
    try:
        own = followed(found.setup, None)
    except LineFault:
        return found.line
    return (
        own if own.ending == "closed" and own.length_mm > found.line.length_mm else found.line
    )
