"""One line of each patch: the first line that is followed on each patch of ink that is asked for.

Signals: contours in; a line of each out, and how many patches are letters.

The head is put down at an open end of the patch, or at the plainest of its places. A patch along which a line
was followed before is a piece of that line, which has gaps. A line that is lost is cut as far as it was
followed.

Source: our own; the patent has one contour to a tape. Questions: a small patch on which the head can nowhere
be put down is taken for a letter; a larger one counts as a lost line.
"""

from __future__ import annotations

import numpy as np

from morfax.motion import nesting
from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.motion.polyline import nearest_mm
from morfax.tracer.following.line import Line
from morfax.tracer.program import selection
from morfax.tracer.program.selection import Contour, Which
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace import SHORT, followed, followed_from_an_end


def one_of_each(setup: Setup, asked: list[Contour], which: Which) -> tuple[list[Line], int]:
    """One line of each patch that is asked for, and how many patches are letters."""
    total_mm = sum(contour.stroke.length_mm for contour in asked)
    lines, letters = list[Line](), 0
    for contour in asked:
        if _is_done(contour, lines) or (which == "outer" and _is_inner(contour, lines)):
            continue
        come_mm = sum(line.length_mm for line in lines)
        line = _follow(setup.after(come_mm, total_mm), contour)
        if line is not None:
            lines.append(line)
        elif isinstance(which, str) or contour.number not in which:
            letters += 1
        else:
            raise _a_letter(contour)
    return lines, letters


def are_of_reference(places: Array, lines: list[Line]) -> bool:
    """Whether places (n, 2) mm are the reference point from which a line, or a lead line, begins."""
    begins = [line.begin_mm for line in lines if line.is_lead or line.reference_mm is not None]
    return selection.are_about(places, begins)


def is_inside(line: Line, lines: list[Line]) -> bool:
    """Whether a line lies inside one of some others."""
    around = [other for other in lines if not other.is_open]
    return any(nesting.lies_inside(line.places_mm, other.loop_mm) for other in around)


def _is_done(contour: Contour, lines: list[Line]) -> bool:
    """Whether a patch is the reference point of a line, or a line was followed along it already."""
    if are_of_reference(contour.stroke.middles_mm, lines):
        return True
    return any(contour.lies_on(line.places_mm) for line in lines)


def _is_inner(contour: Contour, lines: list[Line]) -> bool:
    """Whether a patch lies inside one of the lines."""
    return any(not line.is_open and contour.lies_in(line.loop_mm) for line in lines)


def _follow(setup: Setup, contour: Contour) -> Line | None:
    """Follow a line of a patch from an open end, or from the plainest place; None if the patch is a letter.

    If the line from an end goes along less than half of the ink, a line from a plain place goes before it
    where that closes and is longer.
    """
    from_end = followed_from_an_end(setup, contour.stroke, contour.number)
    if from_end is not None:
        goes_far = from_end.length_mm > SHORT * from_end.ink_mm
        if from_end.ending != "joined" or goes_far:
            return from_end
    about = _follow_from_plain_places(setup, contour)
    if isinstance(about, Line):
        if from_end is None:
            return about
        is_better = about.ending == "closed" and about.length_mm > from_end.length_mm
        return about if is_better else from_end
    if from_end is not None:
        return from_end
    if contour.reach_mm < selection.LETTER_MM:
        return None
    place_mm = np.array(contour.starts_mm()[:1])
    return Line(place_mm, "lost", contour.stroke.width_mm, 0.0, about, contour.number)


def _follow_from_plain_places(setup: Setup, contour: Contour) -> Line | LineFault:
    """Follow a line from the plainest of its places; the fault if the head can be put down at none.

    From a place that does not lead round, as on a chord, other turns are tried only after straight on has
    been tried from the other places.
    """
    in_vain, passed = list[tuple[float, float]](), list[Array]()
    fault = LineFault("no place to put the head down")
    for start_mm in contour.starts_mm():
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
            return line
        in_vain.append(start_mm)
        passed.append(line.own_mm)
    return followed(setup, in_vain[0], contour.number) if in_vain else fault


def _a_letter(contour: Contour) -> LineFault:
    """The fault of a patch that was asked for by number, and on which the head can nowhere be put down."""
    x, y = contour.stroke.middles_mm.mean(axis=0)
    return LineFault(
        f"line {contour.number}, about {x:.1f},{y:.1f} mm, is taken for a letter: the head can be put down"
        " nowhere on it; give the other numbers, or --start X,Y at a plain stretch of it",
        x_mm=float(x),
        y_mm=float(y),
    )
