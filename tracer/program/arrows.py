"""Arrows: the operator says on which place of a line it begins, and which way the head goes from there.

Signals: lines as they were followed and the operator's arrows (see `following.direction`) in; out the same
lines, those with an arrow followed anew from its place, or from their other end.

    ╭──────●──►──╮      a closed line begins at the arrow's place and goes its way
    ╰────────────╯
    ├──────◄──●──┤      an open one begins at the end from which the head comes that way

Source: our own; the patent's operator brings the head over the line and sets it off. Questions: a line that
begins at a reference point has its beginning drawn, and takes no arrow.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.motion.arrays import NOT_ZERO
from morfax.motion.faults import LineFault
from morfax.motion.polyline import area_mm2
from morfax.tracer.drawing.numbering import ALIKE
from morfax.tracer.following.direction import Arrow
from morfax.tracer.following.line import Line
from morfax.tracer.limits import ABOUT_WIDTHS
from morfax.tracer.program.head_runs import followed
from morfax.tracer.program.setup import Setup

# Both limits below were chosen by trial.
NEAR_MM = 1.0  # an arrow further from a line, and beyond `ABOUT_WIDTHS`, is on none


def with_arrows(setup: Setup, lines: list[Line]) -> list[Line]:
    """The lines, those with an arrow as it says.

    Raises LineFault for an arrow that is on none of them, or that a line cannot follow.
    """
    lines = list(lines)
    for arrow in setup.operator.arrows:
        number = _nearest(arrow, lines)
        if lines[number].as_told:
            raise _refused(arrow, f"line {lines[number].number} has another arrow already")
        lines[number] = replace(_along(setup, lines[number], arrow), as_told=True)
    return lines


def turned_round(setup: Setup, line: Line) -> Line:
    """An open line followed from its other end; as it was, if the head goes another way from there."""
    if line.is_of_net:
        led = line.led.turned_round(len(line.xy_mm))
        return replace(
            line, xy_mm=line.xy_mm[::-1], led=led, junctions_mm=line.junctions_mm[::-1]
        )
    silent = replace(setup, progress=None)
    begin_mm, end_mm = line.xy_mm[0], line.xy_mm[-1]
    # other turns are for what closes, and what closes at the one end does not come to the other
    may_close = np.hypot(*(end_mm - begin_mm)) < ABOUT_WIDTHS * line.width_mm
    turns = bool(may_close) or setup.operator.direction is not None
    try:
        other = followed(silent, line.place(len(line.xy_mm) - 1), line.number, turns)
    except LineFault:
        return line
    there = np.hypot(*(other.xy_mm[-1] - begin_mm)) < line.width_mm
    return other if there and _are_alike(other, line) else line


def _along(setup: Setup, line: Line, arrow: Arrow) -> Line:
    """A line as its arrow says."""
    if line.is_lead or line.reference_mm is not None or line.is_dot:
        raise _refused(arrow, f"line {line.number} has its beginning drawn")
    goes = _goes_along(line, arrow)
    if line.ending == "closed":
        return _closed_along(setup, line, arrow, goes)
    told = line if goes else turned_round(setup, line)
    if told is line and not goes:
        raise _refused(arrow, f"the head does not follow line {line.number} from there")
    return told


def _closed_along(setup: Setup, line: Line, arrow: Arrow, goes: bool) -> Line:
    """A closed line from its arrow on; `goes`: the head goes that way already."""
    is_ccw = (area_mm2(line.loop_mm) > 0) == goes
    operator = replace(setup.operator, direction="ccw" if is_ccw else "cw")
    silent = replace(setup, operator=operator, progress=None)
    told = followed(silent, arrow.place_mm, line.number)
    if told.ending != "closed" or not _are_alike(told, line):
        raise _refused(arrow, f"the head does not come round line {line.number} from there")
    return told


def _goes_along(line: Line, arrow: Arrow) -> bool:
    """Whether the head goes past an arrow's place the way that the arrow shows."""
    places = line.places_mm
    here = int(np.argmin(np.hypot(*(places - arrow.place_mm).T)))
    moves = places[1:] - places[:-1]
    nearest = np.argsort(abs(np.arange(len(moves)) + 0.5 - here), kind="stable")
    way = next(moves[k] for k in nearest if moves[k].any())
    return bool(way @ np.subtract(arrow.towards_mm, arrow.place_mm) > 0)


def _nearest(arrow: Arrow, lines: list[Line]) -> int:
    """The index of the line on which an arrow is; raises LineFault if it is on none."""
    away_mm = [float(np.hypot(*(line.places_mm - arrow.place_mm).T).min()) for line in lines]
    number = int(np.argmin(away_mm))
    if away_mm[number] > max(ABOUT_WIDTHS * lines[number].width_mm, NEAR_MM):
        raise _refused(
            arrow, f"the nearest line that is followed is {away_mm[number]:.1f} mm away"
        )
    return number


def _are_alike(one: Line, other: Line) -> bool:
    """Whether two lines are as long as each other."""
    return abs(one.length_mm / max(other.length_mm, NOT_ZERO) - 1) < ALIKE


def _refused(arrow: Arrow, why: str) -> LineFault:
    """The fault of an arrow that cannot be served."""
    x, y = arrow.place_mm
    return LineFault(
        f"--arrow at {x:g},{y:g}: {why}; move the arrow, or leave it out", x_mm=x, y_mm=y
    )
