"""The tour over several lines of a drawing: which the head follows, and in what order they become one program.

Signals: a Drawing and what is asked for in; out a Trace over all those lines, inner before outer, the idle way from one to the next short.

The lines are followed one after the other, the widest spread first, and ordered when it is known where each begins and ends. One that is lost is cut as far as
it was followed, and the others all the same. A stroke along which a line was followed before is a piece of that line, which has gaps.

Source: patent ES 361967 has one contour to a tape, and an operator who brings the head over it; the tour is that operator's, our own.
Questions: a small stroke on which the head can nowhere be put down is taken for a letter, as is one too short (see `contours`); a larger one counts as lost.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from motion.faults import LineFault
from tracer import contours, dots
from tracer.contours import Contour, Which
from tracer.drawing import Drawing
from tracer.line import Line
from tracer.lines import Sheet
from tracer.operator import Operator
from tracer.program import Trace
from tracer.reference import LARGEST_MM
from tracer.sequence import followed, followed_from_an_end
from tracer.settings import Settings
from tracer.stance import view_of
from tracer.view import Array

ALIKE = 0.02  # a line is as long from its other end, within this share
THINNED = 30  # of the positions one in so many tells where a line is: every 50 um at 10 mm/s

Told = Callable[[float, float], None]


def trace_lines(
    drawing: Drawing,
    which: Which = "all",
    settings: Settings | None = None,
    operator: Operator | None = None,
    progress: Told | None = None,
) -> Trace:
    """Follow several lines of the drawing: "all", those that lie inside no other ("outer"), or some by their numbers (1 is the longest).

    `progress` hears how far the head has come and the length of all the lines, mm. Raises LineFault if there is no line to start on, or none of a number.
    """
    sheet, operator = Sheet.of(drawing), operator or Operator()
    asked, left_out = contours.plan(sheet, which)
    total_mm, lines = sum(contour.stroke.length_mm for contour in asked), list[Line]()
    for contour in asked:
        if (
            _is_reference(contour, lines)
            or _is_done(contour, lines)
            or (which == "outer" and _is_inner(contour, lines))
        ):
            continue
        told = (
            None if progress is None else partial(_tell_on, progress, sum(line.length_mm for line in lines), total_mm)
        )
        line = _follow(sheet, contour, settings or Settings(), operator, told)
        if line is None:
            left_out += 1
        else:
            lines.append(line)
    if which == "all" and asked:
        holes = _dots(sheet, asked, settings or Settings())
        lines, left_out = lines + holes, left_out - len(holes)
    again = partial(_turned_round, sheet, settings=settings or Settings(), operator=operator)
    if not any(len(line.xy_mm) > 1 for line in lines):
        raise _none_begun(lines)
    return Trace(tuple(_in_order(lines, again)), operator, left_out=left_out)


def _follow(sheet: Sheet, contour: Contour, settings: Settings, operator: Operator, told: Told | None) -> Line | None:
    """Follow a line from an open end, or from the plainest of its places where the head can be put down; None for a letter, where it cannot be."""
    from_end = followed_from_an_end(sheet, contour.stroke, settings, operator, told, contour.number)
    if from_end is not None:
        return from_end
    stroke, starts_mm = contour.stroke, contour.starts_mm()
    for start_mm in starts_mm:
        try:
            return followed(sheet, start_mm, settings, operator, told, contour.number)
        except LineFault as fault:
            refused = fault
    if contour.reach_mm < contours.LETTER_MM:
        return None
    return Line(np.array(starts_mm[:1]), "lost", stroke.width_mm, 0.0, refused, contour.number)


def _dots(sheet: Sheet, asked: list[Contour], settings: Settings) -> list[Line]:
    """The dots that stand alone on the paper, numbered on from the lines."""
    width_mm = settings.line_width_mm or float(np.median([contour.stroke.width_mm for contour in asked]))
    last = max(contour.number for contour in asked)
    centres = dots.alone(sheet, view_of(sheet, settings.aperture_mm, width_mm))
    return [Line.of_dot(centre, width_mm, number) for number, centre in enumerate(centres, last + 1)]


def _none_begun(lines: list[Line]) -> LineFault:
    """The fault of a tour on which no line could be begun."""
    fault = lines[0].fault if lines else None
    return fault or LineFault(
        "none of the lines can be begun; look at the drawing, or give --start X,Y at a plain stretch"
    )


def _is_done(contour: Contour, lines: list[Line]) -> bool:
    """Whether one of the lines was followed along this stroke already."""
    return any(contour.lies_on(_places(line)) for line in lines)


def _is_reference(contour: Contour, lines: list[Line]) -> bool:
    """Whether this stroke is the reference point from which one of the lines begins."""
    places_mm = [line.reference_mm for line in lines if line.reference_mm is not None]
    return any(
        np.hypot(*(contour.stroke.middles_mm - place_mm).T).max() < 0.5 * LARGEST_MM + 1 for place_mm in places_mm
    )


def _is_inner(contour: Contour, lines: list[Line]) -> bool:
    """Whether this stroke lies inside one of the lines."""
    return any(_goes_round(line) and contour.lies_in(_loop(line)) for line in lines)


def _in_order(lines: list[Line], again: Callable[[Line], Line]) -> list[Line]:
    """The lines in the order in which they are cut; open ones are followed once more from their other end where that is nearer."""
    inner = contours.nested([_loop(line) for line in lines], [_goes_round(line) for line in lines])
    starts, ends = (np.array([getattr(line, end) for line in lines]) for end in ("begin_mm", "end_mm"))
    may_turn = np.array([line.ending == "ended" and not line.goes_back for line in lines])
    order, turned = contours.in_order_and_turned(starts, ends, inner, may_turn)
    return [again(lines[i]) if turned[i] else lines[i] for i in order]


def _turned_round(sheet: Sheet, line: Line, settings: Settings, operator: Operator) -> Line:
    """An open line followed from its other end; as it was, if the head goes another way from there."""
    try:
        other = followed(sheet, line.place(len(line.xy_mm) - 1), settings, operator, number=line.number)
    except LineFault:
        return line
    there = np.hypot(*(other.xy_mm[-1] - line.xy_mm[0])) < line.width_mm
    return other if there and abs(other.length_mm / line.length_mm - 1) < ALIKE else line


def _goes_round(line: Line) -> bool:
    """Whether something can lie inside a line: not if it is known to be open."""
    return line.ending != "ended"


def _places(line: Line) -> Array:
    """Places along a line, (n, 2) mm."""
    return line.xy_mm[::THINNED]


def _loop(line: Line) -> Array:
    """Places along the loop of a line, without the lead line to it, (n, 2) mm."""
    return line.xy_mm[line.loop_from or 0 :: THINNED]


def _tell_on(progress: Told, before_mm: float, total_mm: float, come_mm: float, length_mm: float) -> None:
    """Tell how far the head has come in all, within a line of a known length."""
    progress(min(before_mm + come_mm, total_mm), total_mm)
