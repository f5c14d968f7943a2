"""Remarks: what the operator is told of a traced drawing beside its figures: what was not found, not
followed, or is cut though it may not be meant.

Signals: the traced lines, and what was asked of the head, in; texts out.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from itertools import groupby
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from morfax.jobs.settings import TraceSettings
    from morfax.tracer.cutter.cutter import Cutter, Left, LeftOut
    from morfax.tracer.following.line import Line
    from morfax.tracer.program.program import Trace

UNEVEN = 1.25  # the widest gap of a dashed line over the one that was met
UNCUT = 0.2  # of a line: corners are less
FEW = 0.7  # of the ink that is joined to a line: what is left is worth a word


def remarks(
    trace: Trace, settings: TraceSettings, gap_mm: float, enlarged: int
) -> Iterator[str]:
    """All that is worth a word of a trace, the head having gone across gaps up to this, on a drawing enlarged
    so many times.
    """
    if enlarged > 1:
        yield f"edges are near one another: followed {enlarged} times enlarged, so the machine goes {enlarged} times slower than the head"
    yield from _of_solids(trace)
    yield from _of_stops(trace)
    yield from _of_turns(trace)
    yield from _of_reference(trace, settings)
    yield from _of_gaps(trace)
    yield from _of_breaks(trace, gap_mm)
    yield from _of_stems(trace)
    yield from _of_crossing_guides(trace)
    if settings.line.lines is None and trace.fault is None:
        yield from _of_rest(trace.lines[0])


def of_cutter(beside: Trace, left: Left, cutter: Cutter) -> Iterator[str]:
    """All that is worth a word of a program beside the lines: what the cutter leaves out, leaves much of, or
    runs in pieces.
    """
    if left.lines:
        yield _of_left_out(left.lines, cutter)
    for number, stretches in groupby(
        sorted(left.stretches, key=lambda u: u.line), key=lambda u: u.line
    ):
        uncut = list(stretches)
        uncut_mm, of_mm = sum(u.length_mm for u in uncut), uncut[0].of_mm
        if uncut_mm > UNCUT * of_mm:
            yield f"{uncut_mm:.0f} of {of_mm:.0f} mm of line {number} are not cut: the cutter does not reach them, see the places in the figures"
    for number, count in Counter(line.number for line in beside.lines).items():
        if count > 1:
            yield f"line {number} is cut in {count} pieces, between which the cutter has no room"


def _of_left_out(lines: list[LeftOut], cutter: Cutter) -> str:
    """Of lines that the cutter leaves out, with their stops, and which cutter would not."""
    numbers, stops = [out.line for out in lines], [stop for out in lines for stop in out.stops]
    passes_mm = min((out.room.passes_mm for out in lines if out.room is not None), default=0.0)
    one = len(lines) == 1
    return (
        f"{_numbered('line', numbers)} left out: a cutter of {cutter.diameter_mm:g} mm has no room beside {'it' if one else 'them'}"
        + (
            f", one of up to {passes_mm:g} mm has{'' if one else ' beside all'}"
            if passes_mm > 0
            else ""
        )
        + (
            f"; {_numbered('stop', stops)} left out with {'it' if one else 'them'}"
            if stops
            else ""
        )
    )


def _numbered(what: str, numbers: list[int]) -> str:
    """Some things by their numbers, with their verb."""
    return (
        f"{what} {numbers[0]} is"
        if len(numbers) == 1
        else f"{what}s {', '.join(map(str, numbers))} are"
    )


def _of_solids(trace: Trace) -> Iterator[str]:
    """Of lines in the rims of filled shapes."""
    solid = [line for line in trace.lines if line.is_solid]
    if solid:
        x, y = solid[0].start_mm
        yield f"the ink at {x:.1f},{y:.1f} mm is the rim of a dark area broader than a line: if that is a filled shape, --edge follows its outline"


def _of_stops(trace: Trace) -> Iterator[str]:
    """Of stops that the card or --stop-override names and that are not on the drawing."""
    missing, stops = trace.operator.not_there(trace.lines)
    if missing:
        numbers = ", ".join(map(str, missing))
        yield f"there is no stop {numbers}: {stops} were found, see their places in the figures; the rest is followed"


def _of_turns(trace: Trace) -> Iterator[str]:
    """Of turns that the card has for junctions to which the head did not come."""
    turns, most = (
        trace.operator.sides,
        max((len(line.junctions_mm) for line in trace.lines), default=0),
    )
    beyond = [
        f"{k} ({side})" for k, side in enumerate(turns, 1) if side is not None and k > most
    ]
    if beyond:
        yield f"there is no junction {', '.join(beyond)} to turn at: the head came to {most}, see their places in the figures; the rest is followed"
    for line in trace.lines:
        for k, (side, (x, y)) in enumerate(zip(turns, line.junctions_mm, strict=False), 1):
            if side is not None and not line.turns_at((x, y), side):
                yield f"no line leads off to the {side} at junction {k} of {_named(line, trace)}, {x:.1f},{y:.1f} mm: the head went on"


def _of_reference(trace: Trace, settings: TraceSettings) -> Iterator[str]:
    """Of a reference point that was named and from which no line begins."""
    from morfax.tracer.following.open_ends import LEAD_MM

    named = settings.line.reference_mm
    if named is None or any(line.reference_mm == named for line in trace.lines):
        return
    use = (
        "it is the machine's zero only"
        if settings.program.origin == "reference"
        else "the program does not begin there"
    )
    yield f"no line begins within {LEAD_MM:g} mm of the reference point {named[0]:g},{named[1]:g} mm: {use}"


def _of_gaps(trace: Trace) -> Iterator[str]:
    """Of lines that end where they began, but for a gap that is wider than allowed."""
    for line in trace.lines:
        if line.gap_mm is not None:
            (x, y), wide_mm = line.start_mm, math.ceil(10 * line.gap_mm) / 10
            yield (
                f"{_named(line, trace)} is open, but ends {line.gap_mm:.1f} mm from its beginning at {x:.1f},{y:.1f} mm: "
                f"if that is a gap in a closed line, --gap {wide_mm:g}mm takes the head across"
            )


def _of_breaks(trace: Trace, gap_mm: float) -> Iterator[str]:
    """Of the first end from which ink goes on straight ahead, beyond the gap that is allowed, and of how many
    there are.
    """
    lines = [line for line in trace.lines if line.gap_mm is None]
    found = [
        (line, broken) for line in lines for broken in line.breaks if broken.gap_mm > gap_mm
    ]
    if not found:
        return
    (line, ((x, y), _)), more = (
        found[0],
        f", as at {len(found) - 1} more" if len(found) > 1 else "",
    )
    wide_mm = math.ceil(10 * UNEVEN * max(broken.gap_mm for _, broken in found)) / 10
    yield (
        f"{_named(line, trace)} ends at {x:.1f},{y:.1f} mm, and ink goes on straight ahead of it{more}: if that is one line, "
        f"dashed or with gaps, --gap {wide_mm:g}mm takes the head across"
    )


def _of_stems(trace: Trace) -> Iterator[str]:
    """Of lines that lead to a loop and are cut with it, because nothing says that they are lead lines."""
    for line in trace.lines:
        if line.loop_from is not None and not line.is_lead:
            (x, y), (u, v) = line.start_mm, line.place(line.loop_from)
            yield (
                f"the line from {x:.1f},{y:.1f} to the contour at {u:.1f},{v:.1f} mm is cut too: a lead line is known "
                "by a cross or ring at its beginning, by --reference-point X,Y there, or by a tick across it"
            )


def _of_crossing_guides(trace: Trace) -> Iterator[str]:
    """Of lines from a reference point that cross others and end beyond them: they lead to a hole, and may be
    meant to lead to a contour.
    """
    for line in trace.lines:
        if line.is_guide and line.junctions_mm:
            (x, y), (u, v) = line.begin_mm, line.place(len(line.xy_mm) - 1)
            yield (
                f"the line from the reference point {x:.1f},{y:.1f} crosses another and ends at {u:.1f},{v:.1f} mm: it is taken for a guide line to a "
                "hole there; a lead line ends on the contour"
            )


def _of_rest(line: Line) -> Iterator[str]:
    """Of one line that is the smaller part of the ink in which lines cross or touch."""
    if line.length_mm < FEW * line.ink_mm:
        yield (
            f"about {line.ink_mm - line.length_mm:.0f} mm of ink that is joined to the line was not followed: "
            "--lines all follows the lines that cross or touch it too, --start X,Y another one"
        )


def _named(line: Line, trace: Trace) -> str:
    """A line as the operator knows it."""
    return f"line {line.number}" if len(trace.lines) > 1 else "the line"
