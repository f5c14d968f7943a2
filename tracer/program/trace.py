"""One line as the operator traces it: the head put down, the line followed, and cut (see `program`).

Signals: a Drawing in; out a Trace, which is a stream of Motion (X, Y, Z in sheet mm at the motion rate) and
says how the line ended. Several lines: see `trace_lines`.

From each place where the head may be put down the line is followed in several attempts (see `attempts`),
until one of them is the line. Other turns than straight on are tried only when the head has been put down
elsewhere in vain: from a chord the head does not come back straight on, and with other turns it comes back
round half of the contour.

Source: patent ES 361967, section on use: the operator brings the head over the drawing and lets it run.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import takewhile
from typing import NamedTuple

import numpy as np

from morfax.motion.faults import LineFault
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Stroke
from morfax.tracer.following.attempts import Attempts, longest_mm
from morfax.tracer.following.direction import goes, turned_about
from morfax.tracer.following.line import Line
from morfax.tracer.following.start import ends_of, put_down
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance, turned_round
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.marks_read import with_marks_read
from morfax.tracer.program.net_outline import OfNet, of_net
from morfax.tracer.program.program import Trace
from morfax.tracer.program.selection import NO_OTHERS, others_than
from morfax.tracer.program.setup import HeadProgress, Setup
from morfax.tracer.program.unexplained import unexplained

# of the ink that is joined to it: a shorter run is along another line, which crosses this one; by trial
SHORT = 0.5
ELSEWHERE = 5  # places at which the head is put down when a run leads nowhere; by trial


def trace(
    drawing: Drawing,
    start_mm: tuple[float, float] | None = None,
    settings: Settings | None = None,
    operator: Operator | None = None,
    progress: HeadProgress | None = None,
) -> Trace:
    """Follow a line of the drawing: the one at `start_mm` (sheet mm), or the longest; of lines that cross or
    touch the longest closed outline (see `net_outline`).

    `progress` hears how far the head has come and the length of the line, mm. Raises LineFault if no line is
    there to start on, CardFault for a stop that the operator cannot serve; a line that is lost on the way is
    no exception, but the trace's `fault`.
    """
    operator = operator or Operator()
    setup = Setup(drawing.sheet, settings or Settings(), operator, progress)
    found = OfNet(setup) if start_mm is not None else of_net(setup)
    line = found.line or followed(found.setup, start_mm)
    others = NO_OTHERS if start_mm is not None else others_than(setup.sheet, line)
    lines, unread = with_marks_read([line], operator)
    beside = unexplained(setup, lines)
    return Trace(tuple(lines), operator, others=others, unread=unread, unexplained=beside)


def followed(
    setup: Setup,
    start_mm: tuple[float, float] | None,
    number: int = 1,
    other_turns: bool = True,
) -> Line:
    """The head's best run along the line at a place, or along the longest line.

    With `other_turns` it tries other turns than straight on if the line does not come back.
    """
    stances = put_down(setup.sheet, start_mm, setup.settings, setup.operator.reference_mm)
    best, others = _best(_Target(setup, start_mm, number), stances, other_turns)
    assert best is not None  # put_down gives a stance, or raises
    if others:
        raise _several_lead([best, *others])
    return best


def followed_from_an_end(setup: Setup, stroke: Stroke, number: int = 1) -> Line | None:
    """The head's best run from the open ends of a line; None without open ends, or if lost from each."""
    stances = ends_of(setup.sheet, stroke, setup.settings, setup.operator.reference_mm)
    best, _ = _best(_Target(setup, number=number), iter(stances))
    return best if best is not None and best.ending != "lost" else None


def followed_through(setup: Setup, stance: Stance) -> list[Line]:
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
    return [Line.of(run, stops=drawing.told_stops) for run in runs]


class Run(NamedTuple):
    """A line, where the head was put down for it, and the length of the ink that is joined to it, mm."""

    line: Line
    stance: Stance
    ink_mm: float

    @property
    def goes_far(self) -> bool:
        """Whether it goes along most of the ink."""
        return self.line.length_mm > SHORT * self.ink_mm

    @property
    def ran_in(self) -> bool:
        """Whether it began in the middle of a line, perhaps on a chord, and ended in what it had followed."""
        away_mm = float(np.hypot(*(self.line.start_mm - self.stance.place_mm)))
        began_there = away_mm < self.stance.view.width_mm
        return self.line.ending == "joined" and not self.stance.at_end and began_there

    @property
    def is_certain(self) -> bool:
        """Whether it is the line without doubt; if it passed a junction, a lead line may come in there."""
        if self.stance.at_end and self.line.junctions_mm:
            return False
        ending = self.line.ending
        return ending == "closed" or (self.goes_far and ending != "joined")

    @property
    def from_open_end(self) -> bool:
        """Whether it began at an open end that is no reference point's."""
        return _is_open(self.stance)

    def goes_before(self, best: Run) -> bool:
        """Whether it is better than the best so far: longer; one that closes goes before one that ran in."""
        closes = "closed" in (self.line.ending, best.line.ending)
        if closes and self.ran_in != best.ran_in:
            return best.ran_in
        return self.line.length_mm > best.line.length_mm


@dataclass(frozen=True, slots=True)
class _Target:
    """The line that is asked for: the set-up, the place that the operator points at, and its number."""

    setup: Setup
    start_mm: tuple[float, float] | None = None
    number: int = 1

    def run(self, stance: Stance, ink_mm: float, *, other_turns: bool = False) -> Run:
        """Follow from a stance; with other turns also where straight on does not go round as asked."""
        sheet, operator = self.setup.sheet, self.setup.operator
        attempts = Attempts(
            sheet.drawing,
            self.setup.settings,
            longest_mm(sheet.drawing, stance.view.width_mm),
            operator.sides,
            self.setup.told(ink_mm),
            other_turns,
        )
        try:
            run = attempts.asked_for(stance, operator.direction, self.start_mm)
        except LineFault:
            if other_turns:
                raise
            attempts = replace(attempts, other_turns=True)
            run = attempts.asked_for(stance, operator.direction, self.start_mm)
        stops = sheet.drawing.told_stops
        line = Line.of(run, self.number, stance.reference_mm, stops)
        is_solid = sheet.is_solid_at(stance.place_mm)
        return Run(replace(line, ink_mm=ink_mm, is_solid=is_solid), stance, ink_mm)

    def without_turns(self) -> _Target:
        """The same line, straight on at every junction."""
        return replace(self, setup=self.setup.without_turns())


@dataclass(slots=True)
class _Search:
    """The runs so far: the best, the lead lines from open ends, and the runs from smooth places."""

    best: Run | None = None
    leads: list[Run] = field(default_factory=list)
    smooth: list[Run] = field(default_factory=list)
    settled: bool = (
        False  # the best is the lead line from the reference point: nothing else is tried
    )

    def is_over(self, stance: Stance) -> bool:
        """Whether no more stances are tried from this one on."""
        return (bool(self.leads) and not stance.at_end) or len(self.smooth) > ELSEWHERE

    def has_passed(self, stance: Stance) -> bool:
        """Whether a run from a smooth place has passed a stance."""
        return any(_lies_on(stance, run.line) for run in self.smooth)

    def add(self, run: Run) -> bool:
        """Take in a run; returns whether no better one need be looked for."""
        line, stance, _ = run
        if line.is_lead and run.from_open_end:
            self.leads.append(run)
        best = run if self.best is None or run.goes_before(self.best) else self.best
        self.best = best
        # 1. a run without doubt
        if run.is_certain:
            return True
        if stance.at_end:
            return False
        # 2. from a smooth place the best so far will do, if it did not run in
        self.smooth.append(run)
        return not best.ran_in and (best.line.ending == "closed" or best.goes_far)


def _best(
    wanted: _Target, stances: Iterator[tuple[Stance, float]], other_turns: bool = True
) -> tuple[Line | None, list[Line]]:
    """The best run from one of some stances, None if there are no stances; and further lead lines that are as
    good.

    The card's turns are counted from the beginning of the lead line: so at which open end a lead line begins
    is judged without them.
    """
    search = _searched(wanted, stances)
    if search.best is None or search.settled:
        return (search.best.line if search.best else None), []
    best = _with_other_turns(wanted, search.best, search.smooth) if other_turns else search.best
    first = search.leads[0] if search.leads else best
    if wanted.setup.operator.sides and first.from_open_end:
        first = wanted.run(first.stance, first.ink_mm)
    return first.line, [lead.line for lead in search.leads[1:]]


def _searched(wanted: _Target, stances: Iterator[tuple[Stance, float]]) -> _Search:
    """The runs from one stance after the other, until no better one need be looked for."""
    search, straight = _Search(), wanted.without_turns()
    in_reach = takewhile(lambda place: not search.is_over(place[0]), stances)
    for stance, ink_mm in in_reach:
        if search.has_passed(stance):
            continue
        try:
            run = (straight if _is_open(stance) else wanted).run(stance, ink_mm)
        except LineFault:
            if search.best is None:
                raise
            continue
        if run.line.is_lead and not run.from_open_end and run.goes_far:
            return _Search(run, settled=True)
        if search.add(run):
            break
    return search


def _with_other_turns(wanted: _Target, best: Run, smooth: list[Run]) -> Run:
    """The first run that closes with other turns than straight on, in place of a best run that ran in, or
    closed round a small part of the ink.
    """
    closes_short = best.line.ending == "closed" and best.line.length_mm < SHORT * best.ink_mm
    if not best.ran_in and not closes_short:
        return best
    for tried in filter(lambda run: run.ran_in, smooth):
        run = wanted.run(tried.stance, tried.ink_mm, other_turns=True)
        is_longer = best.ran_in or run.line.length_mm > best.line.length_mm
        if run.line.ending == "closed" and is_longer:
            return run
        if best.line.ending == "closed" or run.goes_far:
            break
    return best


def _lies_on(stance: Stance, line: Line) -> bool:
    """Whether a stance is on a line that was followed."""
    away_mm = np.hypot(*(line.own_mm - stance.place_mm).T)
    return bool(away_mm.min() < stance.view.width_mm)


def _is_open(stance: Stance) -> bool:
    """Whether the head stands at an open end of a line that is no reference point's."""
    return stance.at_end and stance.reference_mm is None


def _several_lead(lines: list[Line]) -> LineFault:
    """The fault of a drawing on which several lines may be the lead line."""
    places = "; ".join(f"{x:.1f},{y:.1f}" for x, y in (line.start_mm for line in lines))
    return LineFault(
        f"{len(lines)} lines with a tick lead to the contour, from {places}, and no reference point shows"
        " which of them is the lead line; draw a cross or ring at its beginning, or give one of these places"
        " with --start X,Y or --reference-point X,Y"
    )
