"""The tour over several lines of a drawing: which the head follows, and in what order they become one
program.

Signals: a Drawing and what is asked for in; out a Trace over all those lines, inner before outer, the idle
way from one to the next short.

The lines are followed one after the other, the widest spread first, and ordered when it is known where each
begins and ends. One that is lost is cut as far as it was followed, and the others all the same. A stroke
along which a line was followed before is a piece of that line, which has gaps. Lines that cross or touch one
another are one patch of ink: the others of it are followed when one has been (see `joined`), and numbered on
from the patches.

Source: patent ES 361967 has one contour to a tape, and an operator who brings the head over it; the tour is
that operator's, our own. Questions: a small stroke on which the head can nowhere be put down is taken for a
letter, as is one too short (see `contours`); a larger one counts as lost.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from morfax.motion import nesting
from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.following.start import view_of
from morfax.tracer.following.thinning import THINNED
from morfax.tracer.head.settings import Settings
from morfax.tracer.marks import dots
from morfax.tracer.marks.reference import LARGEST_MM
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program import order
from morfax.tracer.program import selection as contours
from morfax.tracer.program.joined_lines import joined_to
from morfax.tracer.program.program import Trace
from morfax.tracer.program.selection import Contour, Which
from morfax.tracer.program.trace import SHORT, followed, followed_from_an_end

ALIKE = 0.02  # a line is as long from its other end, within this share

Told = Callable[[float, float], None]


def trace_lines(
    drawing: Drawing,
    which: Which = "all",
    settings: Settings | None = None,
    operator: Operator | None = None,
    progress: Told | None = None,
) -> Trace:
    """Follow several lines of the drawing: "all", those that lie inside no other ("outer"), or some by their
    numbers (1 is the longest).

    `progress` hears how far the head has come and the length of all the lines, mm. Raises LineFault if there
    is no line to start on, or none of a number.
    """
    sheet, settings, operator = (
        Sheet.of(drawing),
        settings or Settings(),
        operator or Operator(),
    )
    patches = len(contours.lines_of(sheet))
    beyond = (
        not isinstance(which, str) and max(which) > patches
    )  # a number that only a line joined to another may have
    asked, left_out = contours.plan(sheet, "all" if beyond else which)
    lines, refused = _follow_each(sheet, asked, which, settings, operator, progress)
    left_out += refused
    joined, left_mm = _joined(sheet, asked, lines, settings, operator)
    if beyond or isinstance(which, str):
        numbered = enumerate(sorted(joined, key=lambda line: -line.length_mm), patches + 1)
        lines += [
            replace(line, number=number)
            for number, line in numbered
            if which != "outer" or not _is_in(line, lines)
        ]
    if beyond or which == "all":
        holes = _dots(
            sheet, asked, settings, max((line.number for line in lines), default=patches)
        )
        lines, left_out = lines + holes, left_out - len(holes)
    if beyond:
        lines = _numbered(lines, which)
    again = partial(_turned_round, sheet, settings=settings, operator=operator)
    if not any(len(line.xy_mm) > 1 for line in lines):
        raise _none_begun(lines)
    return Trace(
        tuple(_in_order(lines, again)), operator, left_out=left_out, left_out_mm=left_mm
    )


def _follow_each(
    sheet: Sheet,
    asked: list[Contour],
    which: Which,
    settings: Settings,
    operator: Operator,
    progress: Told | None,
) -> tuple[list[Line], int]:
    """One line of each patch that is asked for, and how many patches are letters."""
    total_mm, lines, refused = (
        sum(contour.stroke.length_mm for contour in asked),
        list[Line](),
        0,
    )
    for contour in asked:
        if (
            _is_reference(contour, lines)
            or _is_done(contour, lines)
            or (which == "outer" and _is_inner(contour, lines))
        ):
            continue
        come_mm = sum(line.length_mm for line in lines)
        told = None if progress is None else partial(_tell_on, progress, come_mm, total_mm)
        line = _follow(sheet, contour, settings, operator, told)
        if line is None and not isinstance(which, str) and contour.number in which:
            raise _a_letter(contour)
        refused += line is None
        lines += [] if line is None else [line]
    return lines, refused


def _joined(
    sheet: Sheet,
    asked: list[Contour],
    lines: list[Line],
    settings: Settings,
    operator: Operator,
) -> tuple[list[Line], float]:
    """Further lines of the patches of which one line was followed each, and the length of the ink that is
    left of them, mm.
    """
    joined, left_mm, own = list[Line](), 0.0, {line.number: line for line in lines}
    for contour in asked:
        line = own.get(contour.number)
        if line is not None and len(line.xy_mm) > 1:  # not one that was never begun
            others, more_mm = joined_to(line, contour, sheet, settings, operator)
            joined, left_mm = joined + others, left_mm + more_mm
    return [line for line in joined if not _are_reference(line.places_mm, lines)], left_mm


def _numbered(lines: list[Line], numbers: Which) -> list[Line]:
    """The lines that have one of some numbers; raises LineFault for a number that none has."""
    have = {line.number for line in lines}
    for number in numbers:
        if number not in have:
            raise contours.no_line(int(number), sorted(have))
    return [line for line in lines if line.number in numbers]


def _follow(
    sheet: Sheet, contour: Contour, settings: Settings, operator: Operator, told: Told | None
) -> Line | None:
    """Follow a line from an open end, or from the plainest of its places where the head can be put down; None
    for a letter, where it cannot be.

    From an end that leads round less than half of the ink, the line has to be longer than round about from
    such a place.
    """
    from_end = followed_from_an_end(
        sheet, contour.stroke, settings, operator, told, contour.number
    )
    if from_end is not None and (
        from_end.ending != "joined" or from_end.length_mm > SHORT * from_end.ink_mm
    ):
        return from_end
    about = _follow_from_plain_places(sheet, contour, settings, operator, told)
    if isinstance(about, Line):
        closes = from_end is None or (
            about.ending == "closed" and about.length_mm > from_end.length_mm
        )
        return about if closes else from_end
    if from_end is not None:
        return from_end
    if contour.reach_mm < contours.LETTER_MM:
        return None
    place_mm = np.array(contour.starts_mm()[:1])
    return Line(place_mm, "lost", contour.stroke.width_mm, 0.0, about, contour.number)


def _follow_from_plain_places(
    sheet: Sheet, contour: Contour, settings: Settings, operator: Operator, told: Told | None
) -> Line | LineFault:
    """Follow a line from the plainest of its places where the head can be put down; the fault if it can be
    nowhere.

    From a place that does not lead round, as on a chord, no other turns are tried before straight on is from
    some others.
    """
    in_vain, tried, fault = (
        list[tuple[float, float]](),
        list[Array](),
        LineFault("no place to put the head down"),
    )
    for start_mm in contour.starts_mm():
        if any(
            np.hypot(*(places_mm - start_mm).T).min() < contour.stroke.width_mm
            for places_mm in tried
        ):
            continue
        try:
            line = followed(
                sheet, start_mm, settings, operator, told, contour.number, other_turns=False
            )
        except LineFault as refused:
            fault = refused
            continue
        if line.ending != "joined" and (not in_vain or line.length_mm > SHORT * line.ink_mm):
            return line
        in_vain, tried = [*in_vain, start_mm], [*tried, line.own_mm]
    return (
        followed(sheet, in_vain[0], settings, operator, told, contour.number)
        if in_vain
        else fault
    )


def _dots(sheet: Sheet, asked: list[Contour], settings: Settings, last: int) -> list[Line]:
    """The dots that stand alone on the paper, numbered on from the lines; none if neither a line nor a
    setting says how wide the pen is.
    """
    if settings.line_width_mm is None and not asked:
        return []
    width_mm = settings.line_width_mm or float(
        np.median([contour.stroke.width_mm for contour in asked])
    )
    centres = dots.alone(sheet, view_of(sheet, settings.aperture_mm, width_mm))
    return [
        Line.of_dot(centre, width_mm, number) for number, centre in enumerate(centres, last + 1)
    ]


def _none_begun(lines: list[Line]) -> LineFault:
    """The fault of a tour on which no line could be begun, or of a sheet that has none."""
    fault = lines[0].fault if lines else None
    return fault or LineFault(
        "no line can be begun: what is on the sheet is too short, or is letters; give --start X,Y at a plain stretch, or, if dots"
        " are to be drilled, the --line-width of their pen"
    )


def _a_letter(contour: Contour) -> LineFault:
    """The fault of a line that was asked for by its number, and on which the head can nowhere be put down."""
    x, y = contour.stroke.middles_mm.mean(axis=0)
    return LineFault(
        f"line {contour.number}, about {x:.1f},{y:.1f} mm, is taken for a letter: the head can nowhere be put down on it; give the other numbers,"
        " or --start X,Y at a plain stretch of it",
        x_mm=float(x),
        y_mm=float(y),
    )


def _is_done(contour: Contour, lines: list[Line]) -> bool:
    """Whether one of the lines was followed along this stroke already."""
    return any(contour.lies_on(line.places_mm) for line in lines)


def _is_reference(contour: Contour, lines: list[Line]) -> bool:
    """Whether this stroke is the reference point from which one of the lines begins."""
    return _are_reference(contour.stroke.middles_mm, lines)


def _are_reference(places: Array, lines: list[Line]) -> bool:
    """Whether some places (n, 2) mm are those of the reference point from which one of the lines, or a lead
    line, begins.
    """
    references_mm = [
        line.begin_mm for line in lines if line.is_lead or line.reference_mm is not None
    ]
    return any(
        np.hypot(*(places - reference_mm).T).max() < 0.5 * LARGEST_MM + 1
        for reference_mm in references_mm
    )


def _is_inner(contour: Contour, lines: list[Line]) -> bool:
    """Whether this stroke lies inside one of the lines."""
    return any(_goes_round(line) and contour.lies_in(_loop(line)) for line in lines)


def _is_in(line: Line, lines: list[Line]) -> bool:
    """Whether a line lies inside one of some others."""
    return any(
        _goes_round(other) and nesting.lies_inside(line.places_mm, _loop(other))
        for other in lines
    )


def _in_order(lines: list[Line], again: Callable[[Line], Line]) -> list[Line]:
    """The lines in the order in which they are cut; open ones are followed once more from their other end
    where that is nearer.
    """
    inner = nesting.nested(
        [_loop(line) for line in lines], [_goes_round(line) for line in lines]
    )
    starts, ends = (
        np.array([getattr(line, end) for line in lines]) for end in ("begin_mm", "end_mm")
    )
    may_turn = np.array([line.ending == "ended" and not line.goes_back for line in lines])
    sequence, turned = order.in_order_and_turned(starts, ends, inner, may_turn)
    return [again(lines[i]) if turned[i] else lines[i] for i in sequence]


def _turned_round(sheet: Sheet, line: Line, settings: Settings, operator: Operator) -> Line:
    """An open line followed from its other end; as it was, if the head goes another way from there."""
    try:
        other = followed(
            sheet, line.place(len(line.xy_mm) - 1), settings, operator, number=line.number
        )
    except LineFault:
        return line
    there = np.hypot(*(other.xy_mm[-1] - line.xy_mm[0])) < line.width_mm
    return other if there and abs(other.length_mm / line.length_mm - 1) < ALIKE else line


def _goes_round(line: Line) -> bool:
    """Whether something can lie inside a line: not if it is known to be open."""
    return line.ending != "ended"


def _loop(line: Line) -> Array:
    """Places along the loop of a line, without the lead line to it, (n, 2) mm."""
    return line.xy_mm[line.loop_from or 0 :: THINNED]


def _tell_on(
    progress: Told, before_mm: float, total_mm: float, come_mm: float, length_mm: float
) -> None:
    """Tell how far the head has come in all, within a line of a known length."""
    progress(min(before_mm + come_mm, total_mm), total_mm)
