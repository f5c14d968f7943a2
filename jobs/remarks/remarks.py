"""Remarks on a traced drawing beside its figures: what was not found or not followed, and what is cut though
that may not be meant.

Signals in: the traced lines, and what was asked of the head. Signals out: texts, each with what to do.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from morfax.jobs.remarks.on_ink import of_ink
from morfax.motion.by_number import numbered

if TYPE_CHECKING:
    from morfax.jobs.settings.settings import TraceSettings
    from morfax.tracer.cutter.cutter import Cutter, Left, LeftOut
    from morfax.tracer.following.line import Line
    from morfax.tracer.program.program import Trace

# chosen by trial on the test drawings
UNEVEN = 1.25  # the widest gap of a dashed line against the widest that was met
UNCUT_SHARE = 0.2  # of a line; corners alone leave less
# widths: ends so near to each other, so far on, are those of a closed line without a corner, perhaps
BESIDE_WIDTHS, FAR_WIDTHS = 2.5, 10.0
STEP_PER_MM = 10  # a gap is suggested in whole tenths of a mm


def remarks(
    trace: Trace, settings: TraceSettings, gap_mm: float, enlarged: float
) -> Iterator[str]:
    """Remarks on a trace, of a head that crossed gaps of up to `gap_mm`; some lines were `enlarged`."""
    if enlarged > 1:
        yield (
            f"small outlines are traced at {enlarged:g} times the scale, so there the machine goes "
            f"{enlarged:g} times slower than the head"
        )
    yield from _of_stops(trace)
    yield from _of_turns(trace)
    yield from _of_gaps(trace, gap_mm)
    yield from _of_breaks(trace, gap_mm)
    yield from _of_open(trace)
    yield from _of_stems(trace)
    yield from _of_crossing_guides(trace)
    yield from of_ink(trace, several=settings.line.are_several)


def of_cutter(beside: Trace, left: Left, cutter: Cutter) -> Iterator[str]:
    """Remarks on a program beside the lines: lines left out, long stretches not cut, lines cut in pieces."""
    if left.lines:
        yield _of_left_out(left.lines, cutter)
    by_line = sorted(left.stretches, key=lambda stretch: stretch.line)
    for number, stretches in groupby(by_line, key=lambda stretch: stretch.line):
        uncut = list(stretches)
        uncut_mm = sum(stretch.length_mm for stretch in uncut)
        of_mm = uncut[0].of_mm
        if uncut_mm > UNCUT_SHARE * of_mm:
            yield (
                f"{uncut_mm:.0f} of {of_mm:.0f} mm of line {number} are not cut, because the cutter does not "
                "reach them; the figures list the places, and a thinner --cutter reaches further"
            )
    if left.stretches:
        worst, count = left.stretches[0], len(left.stretches)
        x, y = worst.place_mm
        places = "1 place" if count == 1 else f"{count} places"
        yield (
            f"a cutter of {cutter.diameter_mm:g} mm does not reach into {places}, such as sharp inner "
            f"corners: up to {worst.left_mm:.2f} mm of material stay there, most at {x:.1f},{y:.1f} mm; the "
            "figures list them, and a thinner cutter leaves less"
        )
    for number, count in Counter(line.number for line in beside.lines).items():
        if count > 1:
            yield (
                f"line {number} is cut in {count} pieces: the cutter has no room between them; a thinner "
                "--cutter may cut it in one"
            )


def _of_left_out(lines: Sequence[LeftOut], cutter: Cutter) -> str:
    """Lines that the cutter leaves out, their stops, and the largest cutter that fits."""
    numbers = [out.line for out in lines]
    stops = [stop for out in lines for stop in out.stops]
    fits_mm = min((out.room.passes_mm for out in lines if out.room is not None), default=0.0)
    it = "it" if len(lines) == 1 else "them"
    said = (
        f"{numbered('line', numbers)} left out: a cutter of {cutter.diameter_mm:g} mm has no room "
        f"beside {it}"
    )
    if fits_mm > 0:
        said += f"; one of up to {fits_mm:g} mm fits"
    if stops:
        said += f"; {numbered('stop', stops)} left out with {it}"
    return said


def _of_stops(trace: Trace) -> Iterator[str]:
    """Stops that the card or --stop-override names and that the drawing does not have."""
    missing, stops = trace.operator.not_there(trace.lines)
    if missing:
        numbers = ", ".join(map(str, missing))
        yield (
            f"the drawing has no stop {numbers}: {stops} were found, the figures list their places; "
            "check the "
            "numbers on the card and after --stop-override"
        )


def _of_turns(trace: Trace) -> Iterator[str]:
    """Turns of the card at junctions that the head did not reach, or to sides to which no line leads."""
    turns = trace.operator.sides
    most = max((len(line.junctions_mm) for line in trace.lines), default=0)
    beyond = [
        f"{k} ({side})" for k, side in enumerate(turns, 1) if side is not None and k > most
    ]
    if beyond:
        yield (
            f"there is no junction {', '.join(beyond)} to turn at: the head came to {most}, the figures list "
            "their places; check the card's turns"
        )
    for line in trace.lines:
        for k, (side, (x, y)) in enumerate(zip(turns, line.junctions_mm, strict=False), 1):
            if side is not None and not line.turns_at((x, y), side):
                yield (
                    f"no line leads off to the {side} at junction {k} of {_named(line, trace)}, "
                    f"{x:.1f},{y:.1f} mm: the head went straight on; check the card's turns, or draw that "
                    "line up to the junction"
                )


def _of_gaps(trace: Trace, allowed_mm: float) -> Iterator[str]:
    """Lines that end where they began, but for a gap that is too wide, or that no line leads over."""
    for line in trace.lines:
        if line.gap_mm is not None and line.gap_mm <= allowed_mm:
            x, y = line.place(len(line.xy_mm) - 1)
            wide = f"{line.gap_mm:.1f}" if line.gap_mm >= 0.1 else "less than 0.1"
            yield (
                f"{_named(line, trace)} ends at {x:.1f},{y:.1f} mm before a gap of {wide} mm that"
                f" --gap {allowed_mm:.3g}mm allows, but the line behind the gap lies neither straight ahead"
                " nor along the bend: close the gap on the drawing"
            )
        elif line.gap_mm is not None:
            x, y = line.start_mm
            yield (
                f"{_named(line, trace)} is open, but ends {line.gap_mm:.1f} mm from its beginning at "
                f"{x:.1f},{y:.1f} mm: if that is a gap in a closed line, --gap "
                f"{_rounded_up(line.gap_mm):g}mm "
                "takes the head across"
            )


def _of_breaks(trace: Trace, gap_mm: float) -> Iterator[str]:
    """The first end from which ink goes on straight ahead beyond the allowed gap, and how many such ends."""
    found = [
        (line, broken)
        for line in trace.lines
        if line.gap_mm is None
        for broken in line.breaks
        if broken.gap_mm > gap_mm
    ]
    if not found:
        return
    line, ((x, y), _) = found[0]
    more = f", as at {len(found) - 1} more ends" if len(found) > 1 else ""
    wide_mm = _rounded_up(UNEVEN * max(broken.gap_mm for _, broken in found))
    yield (
        f"{_named(line, trace)} ends at {x:.1f},{y:.1f} mm, and ink goes on straight ahead of it{more}: if "
        f"that is one line, dashed or with gaps, --gap {wide_mm:g}mm takes the head across"
    )


def _of_open(trace: Trace) -> Iterator[str]:
    """One line that comes back to where it began, or where it ends, and does not close."""
    line = trace.lines[0]
    plain = line.gap_mm is None and not line.breaks and not line.is_guide
    if len(trace.lines) > 1 or line.ending != "ended" or not plain:
        return
    end = line.passes_its_end(line.width_mm, FAR_WIDTHS * line.width_mm)
    apart_mm = math.dist(line.begin_mm, line.end_mm)
    if end is not None:
        yield (
            f"the line is open, but runs past its own end at {end[0]:.1f},{end[1]:.1f} mm: if you mean a "
            "closed line, --lines contours takes it"
        )
    elif apart_mm < BESIDE_WIDTHS * line.width_mm and line.length_mm > FAR_WIDTHS * apart_mm:
        x, y = line.begin_mm
        yield (
            f"the line is open, and ends {apart_mm:.1f} mm from its beginning, at {x:.1f},{y:.1f} mm: if you "
            "mean a closed line, draw what is missing there, on the sheet or by `morfax correct --bridge`"
        )


def _of_stems(trace: Trace) -> Iterator[str]:
    """Lines that lead to a loop and are cut with it, because nothing marks them as lead lines."""
    lines = [line for line in trace.lines if line.loop_from is not None and not line.is_lead]
    stems = [(line, line.place(line.loop_from or 0)) for line in lines]
    # what is as short as it is wide is no line
    stems = [stem for stem in stems if math.dist(stem[0].start_mm, stem[1]) > stem[0].width_mm]
    if not stems:
        return
    (x, y), (u, v) = stems[0][0].start_mm, stems[0][1]
    others = f", and {len(stems) - 1} more such lines" if len(stems) > 1 else ""
    yield (
        f"the line from {x:.1f},{y:.1f} to the contour at {u:.1f},{v:.1f} mm is cut too{others}; to have a "
        "line followed with the tool up, as a lead line, mark it by a cross or ring at its beginning, by "
        "--reference-point X,Y there, or by a tick across it and --marks on"
    )


def _of_crossing_guides(trace: Trace) -> Iterator[str]:
    """Lines from a reference point that cross others and end beyond them: meant as lead lines, perhaps."""
    for line in trace.lines:
        if line.is_guide and line.junctions_mm:
            (x, y), (u, v) = line.begin_mm, line.place(len(line.xy_mm) - 1)
            yield (
                f"the line from the reference point {x:.1f},{y:.1f} crosses another and ends at "
                f"{u:.1f},{v:.1f} mm: it is taken for a guide line to a hole there; end a lead line on the "
                "contour"
            )


def _named(line: Line, trace: Trace) -> str:
    """A line as the operator knows it."""
    return f"line {line.number}" if len(trace.lines) > 1 else "the line"


def _rounded_up(gap_mm: float) -> float:
    """A gap to be suggested, mm."""
    return math.ceil(STEP_PER_MM * gap_mm) / STEP_PER_MM
