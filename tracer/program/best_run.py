"""The head's best run along a line, of those from the places where it may be put down.

Signals: what is asked for and the stances in; the best run's line, and further lead lines that are as good,
out.

From each stance the line is followed in several attempts (see `attempts`), until one of them is the line.
Other turns than straight on are tried only when the head has been put down elsewhere in vain: from a chord
the head does not come back straight on, and with other turns it comes back round half of the contour.

Source: patent ES 361967, section on use: the operator brings the head over the drawing and lets it run.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import takewhile
from typing import NamedTuple

import numpy as np

from morfax.motion.faults import LineFault
from morfax.tracer.following.attempts import Attempts, longest_mm
from morfax.tracer.following.line import Line
from morfax.tracer.head.stance import Stance
from morfax.tracer.program.lines.selection import SHORT
from morfax.tracer.program.setup import Setup

ELSEWHERE = 5  # places at which the head is put down when a run leads nowhere; by trial


class StanceRun(NamedTuple):
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

    def goes_before(self, best: StanceRun) -> bool:
        """Whether it is better than the best so far: longer; one that closes goes before one that ran in."""
        closes = "closed" in (self.line.ending, best.line.ending)
        if closes and self.ran_in != best.ran_in:
            return best.ran_in
        return self.line.length_mm > best.line.length_mm


@dataclass(frozen=True, slots=True)
class Target:
    """The line that is asked for: the set-up, the place that the operator points at, and its number."""

    setup: Setup
    start_mm: tuple[float, float] | None = None
    number: int = 1

    def run(self, stance: Stance, ink_mm: float, *, other_turns: bool = False) -> StanceRun:
        """Follow from a stance; with other turns also where straight on does not go round as asked."""
        sheet, operator = self.setup.sheet, self.setup.operator
        self.setup.runs.make_room()
        if stance.reference_mm is not None:  # the line leads onto the contour
            stance = replace(stance, view=replace(stance.view, others=None))
        attempts = Attempts(
            sheet.drawing,
            self.setup.settings,
            longest_mm(sheet.drawing, stance.view.width_mm),
            operator.sides,
            self.setup.told(ink_mm),
            other_turns,
            branches=self.setup.runs,
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
        return StanceRun(replace(line, ink_mm=ink_mm, is_solid=is_solid), stance, ink_mm)

    def without_turns(self) -> Target:
        """The same line, straight on at every junction."""
        return replace(self, setup=self.setup.without_turns())


@dataclass(slots=True)
class _Search:
    """The runs so far: the best, the lead lines from open ends, and the runs from smooth places."""

    best: StanceRun | None = None
    leads: list[StanceRun] = field(default_factory=list)
    smooth: list[StanceRun] = field(default_factory=list)
    # the best is the lead line from the reference point: nothing else is tried
    settled: bool = False

    def is_over(self, stance: Stance) -> bool:
        """Whether no more stances are tried from this one on."""
        return (bool(self.leads) and not stance.at_end) or len(self.smooth) > ELSEWHERE

    def has_passed(self, stance: Stance) -> bool:
        """Whether a run from a smooth place has passed a stance."""
        return any(_lies_on(stance, run.line) for run in self.smooth)

    def add(self, run: StanceRun) -> bool:
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


def best_of(
    wanted: Target, stances: Iterator[tuple[Stance, float]], other_turns: bool = True
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


def _searched(wanted: Target, stances: Iterator[tuple[Stance, float]]) -> _Search:
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


def _with_other_turns(wanted: Target, best: StanceRun, smooth: list[StanceRun]) -> StanceRun:
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
