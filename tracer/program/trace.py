"""A run as the operator makes it: the head put down, the line followed, and cut (see `program`).

Signals: a Drawing in; out a Trace, which is a stream of Motion (X, Y, Z in sheet mm at the motion rate) and
says how the run ended. Several lines: see `tour`.

From each of the places where the head may be put down the line is followed in several attempts (see
`attempts`), until one of them is the line. Other turns than straight on are tried when the head has been put
down elsewhere in vain: from a chord it does not come back straight on, and with other turns it comes back
round half of the contour.

Source: patent ES 361967, section on use: the operator brings the head over the drawing and lets it run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from morfax.motion.faults import LineFault
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.following.attempts import Attempts, asked_for, goes, longest_mm, turned_about
from morfax.tracer.following.line import Line
from morfax.tracer.following.start import ends_of, put_down
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance, turned_round
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.program import Trace

# of the ink that is joined to it: a run that ends so soon is another line's, which crosses this one
SHORT = 0.5
ELSEWHERE = 5  # places at which the head is put down then

# a line, where the head was put down for it, and the length of the ink that is joined to it, mm
Run = tuple[Line, Stance, float]


def trace(
    drawing: Drawing,
    start_mm: tuple[float, float] | None = None,
    settings: Settings | None = None,
    operator: Operator | None = None,
    progress: Callable[[float, float], None] | None = None,
) -> Trace:
    """Follow a line of the drawing: the one at `start_mm` (sheet mm), or the longest.

    `progress` hears how far the head has come and the length of the line, mm. Raises LineFault if there is no
    line to start on, CardFault for a stop that the operator cannot serve; a line that is lost on the way is
    no exception, but the trace's `fault`.
    """
    operator = operator or Operator()
    return Trace(
        (followed(Sheet.of(drawing), start_mm, settings or Settings(), operator, progress),),
        operator,
    )


def followed(
    sheet: Sheet,
    start_mm: tuple[float, float] | None,
    settings: Settings,
    operator: Operator,
    progress: Callable[[float, float], None] | None = None,
    number: int = 1,
    other_turns: bool = True,
) -> Line:
    """The head's best run along the line at a place, or along the longest; with other turns than straight on
    if that does not come back, unless left out.
    """
    stances = put_down(
        sheet,
        start_mm,
        settings.aperture_mm,
        settings.line_width_mm,
        settings.gap_mm,
        operator.reference_mm,
    )
    best, others = _best(
        sheet, stances, start_mm, settings, operator, progress, number, other_turns
    )
    assert best is not None  # put_down gives a stance, or raises
    if others:
        raise _several_lead([best, *others])
    return best


def followed_from_an_end(
    sheet: Sheet,
    stroke: Stroke,
    settings: Settings,
    operator: Operator,
    progress: Callable[[float, float], None] | None = None,
    number: int = 1,
) -> Line | None:
    """The head's best run from the open ends of a line, as of a lead line; None if it has none, or the line
    is lost from each.
    """
    stances = ends_of(
        sheet,
        stroke,
        settings.aperture_mm,
        settings.line_width_mm,
        settings.gap_mm,
        operator.reference_mm,
    )
    best, _ = _best(sheet, iter(stances), None, settings, operator, progress, number)
    return best if best is not None and best.ending != "lost" else None


def followed_through(
    sheet: Sheet, stance: Stance, settings: Settings, operator: Operator
) -> list[Line]:
    """The head's runs straight on through a stance, the last one round about in the direction asked for, or
    from end to end; no other turns are tried.
    """
    attempts = Attempts(
        sheet.drawing, settings, (), longest_mm(sheet.drawing, stance.view.width_mm), None
    )
    runs = [attempts.run(stance)]
    if runs[0].ending == "ended":
        runs.append(
            attempts.run(
                turned_round(runs[0].positions_mm[-1], runs[0].heading_rad, runs[0].view)
            )
        )
    elif runs[0].ending != "closed" or (
        operator.direction in ("cw", "ccw") and not goes(runs[0], operator.direction)
    ):
        runs.append(attempts.run(turned_about(stance)))
    return [Line.of(run) for run in runs]


def _best(
    sheet: Sheet,
    stances: Iterator[tuple[Stance, float]],
    start_mm: tuple[float, float] | None,
    settings: Settings,
    operator: Operator,
    progress: Callable[[float, float], None] | None,
    number: int,
    other_turns: bool = True,
) -> tuple[Line | None, list[Line]]:
    """The best run from one of some stances, None if there are none; and other runs that are as good: lead
    lines all.

    Which of several open ends a lead line begins at is judged without the card's turns: those are counted
    from there.
    """
    follow = partial(_line, sheet, start_mm, settings, progress, number)
    straight = replace(operator, card=replace(operator.card, turns=()))
    best, leads, smooth = None, list[Run](), list[Run]()
    for stance, length_mm in stances:
        if (leads and not stance.at_end) or len(smooth) > ELSEWHERE:
            break
        if any(_lies_on(stance, line) for line, _, _ in smooth):
            continue
        try:
            line = follow(straight if _is_open(stance) else operator, stance, length_mm)
        except LineFault:
            if best is None:
                raise
            continue
        run, far = (line, stance, length_mm), line.length_mm > SHORT * length_mm
        if line.is_lead and not _is_open(stance) and far:
            return line, []
        if line.is_lead and _is_open(stance):
            leads.append(run)
        best = run if best is None or _goes_before(run, best) else best
        plain = not (
            stance.at_end and line.junctions_mm
        )  # at a junction a lead line may come in
        if plain and (line.ending == "closed" or (far and line.ending != "joined")):
            break
        if not stance.at_end:
            smooth.append(run)
            if not _ran_in(best) and (
                best[0].ending == "closed" or best[0].length_mm > SHORT * length_mm
            ):
                break
    if best is None:
        return None, []
    if other_turns:
        best = _with_other_turns(best, smooth, partial(follow, operator))
    line, stance, length_mm = leads[0] if leads else best
    if operator.sides and _is_open(stance):
        line = follow(operator, stance, length_mm)
    return line, [lead for lead, _, _ in leads[1:]]


def _goes_before(run: Run, best: Run) -> bool:
    """Whether a run is better than the best so far: the longer one, but one that closes before one that ran
    into what it had followed.
    """
    if "closed" in (run[0].ending, best[0].ending) and _ran_in(run) != _ran_in(best):
        return _ran_in(best)
    return run[0].length_mm > best[0].length_mm


def _ran_in(run: Run) -> bool:
    """Whether a run from the middle of a line, and not from an end of it, ended in what it had followed:
    perhaps it began on a chord.
    """
    line, stance, _ = run
    began_there = float(np.hypot(*(line.start_mm - stance.place_mm))) < stance.view.width_mm
    return line.ending == "joined" and not stance.at_end and began_there


def _with_other_turns(best: Run, smooth: list[Run], follow: Callable[..., Line]) -> Run:
    """The first run that closes with other turns than straight on, in place of the best if that ran into
    itself, or is shorter and a small part of the ink.
    """
    if not _ran_in(best) and not (
        best[0].ending == "closed" and best[0].length_mm < SHORT * best[2]
    ):
        return best
    for _, stance, length_mm in filter(_ran_in, smooth):
        line = follow(stance, length_mm, other_turns=True)
        if line.ending == "closed" and (_ran_in(best) or line.length_mm > best[0].length_mm):
            return line, stance, length_mm
        if best[0].ending == "closed" or line.length_mm > SHORT * length_mm:
            break
    return best


def _lies_on(stance: Stance, line: Line) -> bool:
    """Whether a stance is on a line that was followed."""
    return bool(np.hypot(*(line.own_mm - stance.place_mm).T).min() < stance.view.width_mm)


def _is_open(stance: Stance) -> bool:
    """Whether the head stands at an open end of a line that is no reference point's."""
    return stance.at_end and stance.reference_mm is None


def _line(
    sheet: Sheet,
    start_mm: tuple[float, float] | None,
    settings: Settings,
    progress: Callable[[float, float], None] | None,
    number: int,
    operator: Operator,
    stance: Stance,
    length_mm: float,
    other_turns: bool = False,
) -> Line:
    """The line as it is followed from a stance; with other turns also where straight on does not go round in
    the direction asked for.
    """
    told = None if progress is None else partial(_tell, progress, length_mm)
    try:
        run = asked_for(
            sheet.drawing, stance, start_mm, operator.route, settings, told, other_turns
        )
    except LineFault:
        if other_turns:
            raise
        run = asked_for(sheet.drawing, stance, start_mm, operator.route, settings, told)
    line = Line.of(run, number, stance.reference_mm)
    return replace(line, ink_mm=length_mm, is_solid=sheet.is_solid_at(stance.place_mm))


def _several_lead(lines: list[Line]) -> LineFault:
    """The fault of a drawing on which it is not certain which line is the lead line."""
    places = "; ".join(f"{x:.1f},{y:.1f}" for x, y in (line.start_mm for line in lines))
    return LineFault(
        f"{len(lines)} lines with a tick lead to the contour, from {places}, and no reference point tells which is the lead line;"
        " draw a cross or ring at its beginning, or give one of these places with --start X,Y or --reference X,Y"
    )


def _tell(progress: Callable[[float, float], None], length_mm: float, come_mm: float) -> None:
    progress(min(come_mm, length_mm), length_mm)
