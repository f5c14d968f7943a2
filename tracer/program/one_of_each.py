"""One line of each patch: the first line that is followed on each patch of ink that is asked for.

Signals: contours in; a line of each out, and the contours that are filled shapes, or give the head no place.

The head is put down at an open end of the patch, or at the plainest of its places. A patch along which a line
was followed before is a piece of that line, which has gaps. A line that is lost is cut as far as it was
followed. Where lines cross or touch, and the line that the head finds does not close or is a smaller part of
them, their longest closed outline goes before it, as where one line is asked for (see `net_outline`).

Source: our own; the patent has one contour to a tape. Questions: a small patch on which the head can nowhere
be put down may be a letter, and is left out; a larger one counts as a lost line.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion import nesting
from morfax.motion.arrays import Array, bounds
from morfax.motion.faults import LineFault
from morfax.motion.polyline import nearest_mm
from morfax.tracer.drawing.lettering import lettering
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.following.line import Line
from morfax.tracer.following.start import a_dark_area
from morfax.tracer.marks.reference import LARGEST_MM, may_lead, reach_mm
from morfax.tracer.program.head_runs import followed, followed_from_an_end
from morfax.tracer.program.laid.bridges import bridged
from morfax.tracer.program.laid.small_loops import SmallLoops
from morfax.tracer.program.laid.touches import touching
from morfax.tracer.program.lines import selection
from morfax.tracer.program.lines.selection import SHORT, Contour, Which
from morfax.tracer.program.nets.net_lines import lines_of_ring, net_of, or_outline
from morfax.tracer.program.nets.net_outline import ABOUT_WIDTHS, goes_round, may_solve
from morfax.tracer.program.nets.open_ink import can_stand, is_open, strokes_of, strokes_told
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.taken import kept_off, taken_by

# mm from a patch to the edge of the window: twice as far as reference points and lead lines are looked for
ABOUT_MM = 40.0
# the same for a patch without ends: only a reference point whose lead line touches it can matter
ENDLESS_ABOUT_MM = 1.5 * LARGEST_MM


class OneOfEach(NamedTuple):
    """One line of each patch; the patches that are filled shapes, or nowhere a place for the head; and of the
    patches whose junctions showed all their strokes the others of these, by the patch's number.
    """

    lines: list[Line]
    unclear: list[Contour]
    others: dict[int, list[Line]]


class _Found(NamedTuple):
    """A line of a patch, None on a letter; and the other strokes, where the junctions showed them all."""

    line: Line | None
    others: list[Line] | None = None


def one_of_each(setup: Setup, asked: list[Contour], which: Which) -> OneOfEach:
    """Follow one line of each patch that is asked for."""
    total_mm = sum(contour.stroke.length_mm for contour in asked)
    lines, boxes_mm, come_mm = list[Line](), np.empty((len(asked), 2, 2)), 0.0
    begins_mm, unclear = list[tuple[float, float]](), list[Contour]()
    loops = SmallLoops(setup.sheet, setup.settings)
    others, taken = dict[int, list[Line]](), set[int]()
    letters = lettering(setup.sheet) if may_solve(setup) else set[int]()
    telling = list[Line]()  # as many of the lines as tell whether marks are read
    for contour in asked:
        near = [lines[k] for k in _near(contour, boxes_mm[: len(lines)])]
        is_inner = which == "outer" and _is_inner(contour, lines)
        if is_inner or _is_done(contour, near, begins_mm):
            continue
        if isinstance(which, str) and selection.is_shape(setup.sheet, contour, asked):
            unclear.append(contour)
            continue
        is_letter = contour.stroke.patch in letters
        reads_marks = setup.operator.reads_marks(telling)
        here = kept_off(setup.after(come_mm, total_mm), taken - {contour.stroke.patch})
        found = _found(here, loops, contour, is_letter, reads_marks)
        line = found.line
        if line is not None:
            taken |= taken_by(setup, [line])
            if found.others is not None:
                others[contour.number] = found.others
            boxes_mm[len(lines)] = line.box_mm
            lines.append(line)
            if line.reference_mm is not None or not (line.is_dot or telling):
                telling.append(line)
            begins_mm += references_of([line])
            come_mm += line.length_mm
        elif isinstance(which, str) or contour.number not in which:
            unclear.append(contour)
        else:
            raise selection.a_letter(contour)
    lines = [line for line in lines if not _is_reference(line, begins_mm)]
    return OneOfEach(lines, unclear, others)


def references_of(lines: list[Line]) -> list[tuple[float, float]]:
    """Where lines, or lead lines, begin at a reference point, mm."""
    return [line.begin_mm for line in lines if line.is_lead or line.reference_mm is not None]


def is_inside(line: Line, lines: list[Line]) -> bool:
    """Whether a line lies inside one of some others."""
    around = [other for other in lines if not other.is_open]
    return any(nesting.lies_inside(line.places_mm, other.loop_mm) for other in around)


def _near(contour: Contour, boxes_mm: Array) -> NDArray[np.int64]:
    """The numbers of the boxes (n, 2, 2), lowest and highest place of a line, in which a patch may lie."""
    low_mm, high_mm = boxes_mm[:, 0], boxes_mm[:, 1]
    beside_mm, (lowest_mm, highest_mm) = selection.BESIDE_MM, bounds(contour.stroke.middles_mm)
    meets = highest_mm > low_mm - beside_mm
    meets &= lowest_mm < high_mm + beside_mm
    return np.flatnonzero(meets.all(axis=1))


def _is_done(contour: Contour, near: list[Line], begins_mm: list[tuple[float, float]]) -> bool:
    """Whether a patch is the reference point of a line, or one near to it was followed along it already."""
    is_reference = selection.are_about(contour.stroke.middles_mm, begins_mm)
    return is_reference or any(contour.lies_on(line.places_mm) for line in near)


def _is_reference(line: Line, begins_mm: list[tuple[float, float]]) -> bool:
    """Whether a line is the reference point from which another begins, which was followed after it."""
    return not references_of([line]) and selection.are_about(line.places_mm, begins_mm)


def _is_inner(contour: Contour, lines: list[Line]) -> bool:
    """Whether a patch lies inside one of the lines."""
    return any(not line.is_open and contour.lies_in(line.loop_mm) for line in lines)


def _found(
    setup: Setup, loops: SmallLoops, contour: Contour, is_letter: bool, reads_marks: bool
) -> _Found:
    """A line of a patch as the head follows it, as the outline of a net, or as the small loop that it is."""
    stroke = contour.stroke
    if setup.sheet.are_solid[stroke.patch]:
        return _Found(_lost(contour, a_dark_area(setup.sheet, stroke)))
    if (loop := loops.slot(stroke.patch)) is None:
        about = _about(setup, contour)
        net = net_of(about, contour)
        lines = net.lines() if net is not None and net.is_clear else []
        if not lines and not is_letter:
            lines = lines_of_ring(about, contour, reads_marks)
        elif lines and lines[0].ending != "closed":
            lines = []
        if lines:
            return _as_found(setup, [loops.mended(line) for line in lines])
        own = None if is_letter or net is None else net.between_ends(contour)
        found = _Found(own) if own else _follow_in_window(setup, about, contour, is_letter)
        own = own or or_outline(setup, contour, found.line)
        if own is not None:
            line = loops.mended(own)
            if net is not None and not line.is_lead:
                return _as_found(setup, [line, *net.besides(line)])
            return _Found(line, found.others if line is own else None)
        loop = loops.of_patch(stroke.patch, stroke.width_mm)
    return _Found(None if loop is None else loop.line(contour.number))


def _as_found(setup: Setup, lines: list[Line]) -> _Found:
    """The lines that a patch is, the first and the others: those that bars join as one, and those that touch
    each along its own rim.
    """
    lines = touching(setup, bridged(setup, lines))
    return _Found(lines[0], lines[1:])


def _about(setup: Setup, contour: Contour) -> Setup:
    """The set-up with cells that see no more of a large sheet than what is about a patch."""
    settings, stroke = setup.settings, contour.stroke
    looks_mm = settings.gap_mm + settings.recatch_mm + ABOUT_WIDTHS * stroke.width_mm
    near = setup.sheet.about(stroke.patch, _off_mm(setup.sheet, stroke) + looks_mm)
    return setup if near is setup.sheet else replace(setup, sheet=near)


def _off_mm(sheet: Sheet, stroke: Stroke) -> float:
    """How far off a patch the head may come without seeing the edge of the window about it, mm."""
    if may_lead(sheet, stroke):
        return ABOUT_MM if len(stroke.ends_mm) else ENDLESS_ABOUT_MM
    return reach_mm(stroke.width_mm, sheet.drawing.pitch_mm)


def _follow_in_window(setup: Setup, about: Setup, contour: Contour, is_letter: bool) -> _Found:
    """Follow a patch with cells that see no more of a large sheet than what is about it; with all of it if
    the head came so far off the patch that it may have looked beyond that.
    """
    line, _ = found = _follow(about, contour, is_letter)
    if about is setup:
        return found
    is_found = line is not None and line.ending != "lost" and _keeps_to(contour, line)
    is_seen = is_found or about.runs.kept_to(
        *_box_mm(contour, _off_mm(setup.sheet, contour.stroke))
    )
    is_lead = line is not None and line.reference_mm is not None
    return found if is_seen and not is_lead else _follow(setup, contour, is_letter)


def _keeps_to(contour: Contour, line: Line) -> bool:
    """Whether a line runs nowhere beyond its own patch."""
    low_mm, high_mm = _box_mm(contour, contour.stroke.width_mm)
    line_low_mm, line_high_mm = line.box_mm
    return bool(((line_low_mm > low_mm) & (line_high_mm < high_mm)).all())


def _box_mm(contour: Contour, around_mm: float) -> tuple[Array, Array]:
    """The lowest and the highest place about a patch, mm."""
    low_mm, high_mm = bounds(contour.stroke.middles_mm)
    return low_mm - around_mm, high_mm + around_mm


def _follow(setup: Setup, contour: Contour, is_letter: bool) -> _Found:
    """Follow a line of a patch from an open end, or from the plainest place; none if the head can nowhere be
    put down on a small patch. Of what is likely a letter, and of open ink on its own that is small or of
    several strokes, the strokes (see `open_ink`).

    A line from a plain place that closes goes before one from an end that runs into itself, if it comes by
    all of that: the end was a tip in which two sides meet. If that goes along less than half of the ink, it
    does so if it is longer.
    """
    strokes = strokes_told(setup, contour, is_letter)
    if strokes is not None:
        return _Found(strokes[0], strokes[1:])
    stroke, is_small = contour.stroke, contour.reach_mm < selection.LETTER_MM
    if is_small and goes_round(setup.sheet, stroke.patch, 1) and not can_stand(setup, contour):
        return _Found(None)  # the head would take another line nearby for it
    from_end = followed_from_an_end(setup, stroke, contour.number)
    if from_end is not None and from_end.ending != "joined":
        return _Found(from_end)
    about = _follow_from_plain_places(setup, contour)
    if isinstance(about, _Found) and (from_end is None or _goes_before(about, from_end)):
        return about
    if from_end is not None or is_small:
        return _Found(from_end)
    assert isinstance(about, LineFault)
    return _Found(_lost(contour, about))


def _goes_before(about: _Found, from_end: Line) -> bool:
    """Whether what was found from plain places goes before a line from an end that ran into itself."""
    line, goes_far = about.line, from_end.length_mm > SHORT * from_end.ink_mm
    if line is None or about.others is not None:
        return not goes_far
    if line.ending != "closed":
        return False
    if not goes_far:
        return line.length_mm > from_end.length_mm
    away_mm = nearest_mm(from_end.places_mm, line.loop_mm)
    return bool(away_mm.max() < 0.5 * from_end.width_mm)


def _lost(contour: Contour, fault: LineFault) -> Line:
    """The line of a patch that was never begun."""
    place_mm = np.array(contour.starts_mm[:1])
    return Line(place_mm, "lost", contour.stroke.width_mm, 0.0, fault, contour.number)


def _strokes(setup: Setup, contour: Contour) -> _Found | None:
    """All strokes of a patch, the longest as its line; None if nothing is felt of it."""
    found = strokes_of(setup, contour.stroke.patch, contour.number)
    return _Found(found[0], found[1:]) if found else None


def _follow_from_plain_places(setup: Setup, contour: Contour) -> _Found | LineFault:
    """Follow a line from the plainest of its places; the fault if the head can be put down at none.

    From a place that does not lead round, as on a chord, other turns are tried only after straight on has
    been tried from the other places; on ink of which no line comes round neither is.
    """
    in_vain, passed = list[tuple[float, float]](), list[Array]()
    fault = LineFault("no place to put the head down")
    for start_mm in contour.starts_mm:
        here = np.array([start_mm])
        if any(nearest_mm(here, way)[0] < contour.stroke.width_mm for way in passed):
            continue
        try:
            line = followed(setup, start_mm, contour.number, other_turns=False)
        except LineFault as refused:
            fault = refused
            continue
        goes_far = not in_vain or line.length_mm > SHORT * line.ink_mm
        if line.ending != "joined" and goes_far:
            return _Found(line)
        if not in_vain and _keeps_to(contour, line) and is_open(setup, contour.stroke):
            strokes = _strokes(setup, contour)
            if strokes is not None:
                return strokes
        in_vain.append(start_mm)
        passed.append(line.own_mm)
    return _Found(followed(setup, in_vain[0], contour.number)) if in_vain else fault
