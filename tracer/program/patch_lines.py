"""Lines of a patch of ink: all that the head finds on it, and which of them a line is that it followed alone.

      ╱╲          a line that shares its ink with others is right when these are known too: which legs go on
     ╱╭╮╲         into which, and within which rims each lies
    ╱_╰╯_╲

Signals: the set-up and patches of ink in; their lines, as they explain the ink, out.

Source: our own; the patent has one contour to a tape. Questions: lines that end on others are found, but a
line that was followed alone is taken for a closed one, which is what people cut.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.motion.polyline import nearest_mm
from morfax.motion.usual import THINNED
from morfax.tracer.following.line import Line
from morfax.tracer.ink.crossing_on_ink import OFF
from morfax.tracer.limits import ABOUT_WIDTHS
from morfax.tracer.program.against_ink.unexplained import Unexplained, ink_beside
from morfax.tracer.program.joined_lines import joined_to
from morfax.tracer.program.laid.explained import explained
from morfax.tracer.program.laid.narrow_bays import with_bars
from morfax.tracer.program.laid.own_rims import (
    MISSED,
    MOST_AREAS,
    OwnRims,
    way_of,
    within_own_rims,
)
from morfax.tracer.program.lines import selection
from morfax.tracer.program.lines.repeated import without_repeats
from morfax.tracer.program.lines.selection import Contour
from morfax.tracer.program.one_of_each import one_of_each, references_of
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.taken import kept_off, taken_by
from morfax.tracer.tangles.seen_ink import DIFFER


def among_others(setup: Setup, line: Line) -> tuple[Line, tuple[Unexplained, ...]] | None:
    """That closed line of its patch of ink which a line is that was followed alone, and what it leaves
    unexplained; None where the lines of the patch do not explain its ink, or where it is an open one.
    """
    patch = setup.sheet.patch_at(line.loop_mm[0])
    contour = _contour_of(setup, patch) if setup.sheet.loops()[patch] < MOST_AREAS else None
    if contour is None:
        return None
    lines, left, _ = explained(setup, lines_of_patch(setup, contour))
    if not _are_along(line, lines) or not _explain(setup, patch, lines, line):
        return None
    whole = [each for each in lines if each.ending in ("closed", line.ending)]
    nearest = min(whole, key=lambda each: _apart_mm(each, line), default=line)
    if nearest.ending != "closed":
        return None
    about_mm = ABOUT_WIDTHS * nearest.width_mm
    places = [place for place in left if place.kind != "ink"]
    places = [
        it
        for it in places
        if nearest_mm(np.array([it.place_mm]), nearest.loop_mm)[0] < about_mm
    ]
    return replace(nearest, number=line.number), (*ink_beside(setup.sheet, [nearest]), *places)


def lines_of_patch(setup: Setup, contour: Contour) -> list[Line]:
    """All lines that the head finds on a patch of ink."""
    first, _, strokes = one_of_each(setup, [contour], "contours")
    others = [line for some in strokes.values() for line in some]
    lines = with_bars(setup, first, others)
    further, _ = further_lines(setup, [contour], lines, strokes)
    return without_repeats([*lines, *(line for line, _ in further)])


def further_lines(
    setup: Setup, asked: list[Contour], lines: list[Line], strokes: dict[int, list[Line]]
) -> tuple[list[tuple[Line, int]], dict[int, float]]:
    """Further lines of the patches on which a line was followed, each with its patch's number: the strokes
    that are known, or those that the head finds; and the length of ink left over of each, mm.
    """
    joined, left_mm = list[tuple[Line, int]](), dict[int, float]()
    own, taken = {line.number: k for k, line in enumerate(lines)}, taken_by(setup, lines)
    for k, contour in enumerate(asked):
        setup.come(k, len(asked))
        if (n := own.get(contour.number)) is not None and len(lines[n].xy_mm) > 1:
            line = lines[n]  # not one that was never begun
            here = kept_off(setup, taken - {contour.stroke.patch})
            others, more_mm = joined_to(line, contour, here, strokes.get(contour.number))
            found = [line, *others]
            told = within_own_rims(here, contour.stroke.patch, found)
            if told is not found:
                (lines[n], *others), more_mm = told, 0.0
            joined += [(other, contour.number) for other in others]
            left_mm[contour.stroke.patch] = more_mm
    begins_mm = references_of(lines)
    kept = [each for each in joined if not selection.are_about(each[0].places_mm, begins_mm)]
    return kept, left_mm


def _contour_of(setup: Setup, patch: int) -> Contour | None:
    """A patch of ink as a line that is asked for; None if it is none."""
    numbers = np.flatnonzero(selection.lines_of(setup.sheet) == patch) + 1
    return selection.plan(setup.sheet, tuple(numbers.tolist()))[0][0] if len(numbers) else None


def _explain(setup: Setup, patch: int, lines: list[Line], line: Line) -> bool:
    """Whether the lines of a patch explain its ink where a line that was followed alone runs elsewhere, or
    leave less of it; the same line, laid otherwise, must leave much less.
    """
    rims = OwnRims(setup, patch, [line])
    ink, own_mm = rims.ink, rims.own_mm
    away_mm = np.min([ink.away_mm(way_of(each)) for each in lines], axis=0)
    less = ink.left(own_mm) - ink.left(away_mm)
    if len(lines) == 1:
        return less > MISSED
    differ = np.abs(ink.wrong(away_mm) - ink.wrong(own_mm)) > DIFFER
    return less > MISSED or ink.worst(away_mm, differ) < OFF


def _are_along(line: Line, lines: list[Line]) -> bool:
    """Whether some lines run along all that a line does, but for what it cut short."""
    ways = np.vstack([each.places_mm for each in lines])
    return bool(np.mean(nearest_mm(line.places_mm, ways) < line.width_mm) > selection.COVERED)


def _apart_mm(one: Line, other: Line) -> float:
    """How far two closed lines are apart on the mean, from either to the other."""
    ways = one.loop_mm[::THINNED], other.loop_mm[::THINNED]
    return float(sum(np.mean(nearest_mm(*pair)) for pair in (ways, ways[::-1])))
