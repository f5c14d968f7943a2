"""The head's runs along a line: from where it is put down, the best way along one line of the drawing.

Signals: a set-up and a place, the open ends of a line, or a stance, in; the line out, or the runs.

The line is the best of the head's runs from the places where it may be put down (see `best_run`). Where the
head is lost on a line that closes, the junctions of its ink show the way round (see `net_outline`).

Source: patent ES 361967, section on use: the operator brings the head over the drawing and lets it run.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.motion.faults import LineFault
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.deviation import darkness_across
from morfax.tracer.drawing.strokes import Stroke
from morfax.tracer.following.attempts import Attempts, longest_mm
from morfax.tracer.following.direction import goes, turned_about
from morfax.tracer.following.followed import Followed
from morfax.tracer.following.line import Line
from morfax.tracer.following.start import ends_of, put_down
from morfax.tracer.head.stance import Stance, turned_round
from morfax.tracer.program.against_ink.unexplained import bare_ways
from morfax.tracer.program.best_run import Target, best_of
from morfax.tracer.program.nets.net_outline import round_ring
from morfax.tracer.program.setup import Setup


def followed(
    setup: Setup,
    start_mm: tuple[float, float] | None,
    number: int = 1,
    other_turns: bool = True,
) -> Line:
    """The head's best run along the line at a place, or along the longest line; of ink that closes, and on
    which the head is lost, the way round that its junctions show, unless that leads over bare paper.

    With `other_turns` it tries other turns than straight on if the line does not come back.
    """
    stances = put_down(setup.sheet, start_mm, setup.settings, setup.operator.reference_mm)
    best, others = best_of(Target(setup, start_mm, number), stances, other_turns)
    assert best is not None  # put_down gives a stance, or raises
    if _is_from_hole(setup, best):
        return followed(_without_references(setup), start_mm, number, other_turns)
    if others:
        raise _several_lead([best, *others])
    found = round_ring(setup, best) if best.ending in ("lost", "joined") else None
    if found is None or any(bare_ways(setup.sheet, [found], setup.settings.gap_mm)):
        return best
    return replace(found, number=number)


def followed_from_an_end(setup: Setup, stroke: Stroke, number: int = 1) -> Line | None:
    """The head's best run from the open ends of a line; None without open ends, or if lost from each."""
    stances = ends_of(setup.sheet, stroke, setup.settings, setup.operator.reference_mm)
    best, _ = best_of(Target(setup, number=number), iter(stances))
    if best is not None and _is_from_hole(setup, best):
        return followed_from_an_end(_without_references(setup), stroke, number)
    return best if best is not None and best.ending != "lost" else None


def _is_from_hole(setup: Setup, line: Line) -> bool:
    """Whether a line begins at a ring that is a hole of the part, and no reference point: it leads to no
    contour, and nobody says that a program is drawn.
    """
    if line.reference_mm is None or line.ending != "ended" or setup.operator.means_program:
        return False
    place = np.array([line.reference_mm])
    middle = darkness_across(setup.sheet.drawing, place, np.zeros(1), np.zeros(1)).item()
    return bool(middle < INK)  # a cross has ink in its middle


def _without_references(setup: Setup) -> Setup:
    """The set-up on a sheet whose crosses and rings are no reference points."""
    return replace(setup, sheet=replace(setup.sheet, has_references=False))


def followed_through(setup: Setup, stance: Stance) -> list[Followed]:
    """The head's runs straight on through a stance, without other turns.

    The last run goes round about in the direction asked for, or from end to end.
    """
    drawing, direction = setup.sheet.drawing, setup.operator.direction
    attempts = Attempts(drawing, setup.settings, longest_mm(drawing, stance.view.width_mm))
    first = attempts.run(stance)
    runs = [first]
    wrong_way = direction in ("cw", "ccw") and not goes(first, direction)
    if first.ending == "ended":
        back = turned_round(first.positions_mm[-1], first.heading_rad, first.view)
        runs.append(attempts.run(back))
    elif first.ending != "closed" or wrong_way:
        runs.append(attempts.run(turned_about(stance)))
    return runs


def _several_lead(lines: list[Line]) -> LineFault:
    """The fault of a drawing on which several lines may be the lead line."""
    places = "; ".join(f"{x:.1f},{y:.1f}" for x, y in (line.start_mm for line in lines))
    return LineFault(
        f"{len(lines)} lines with a tick lead to the contour, from {places}, and no reference point shows"
        " which of them is the lead line; draw a cross or ring at its beginning, or give one of these places"
        " with --start X,Y or --reference-point X,Y"
    )
