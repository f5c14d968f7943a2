"""A run as the operator makes it: the head put down, the line followed, and cut (see `program`).

Signals: a Drawing in; out a Trace, which is a stream of Motion (X, Y, Z in sheet mm at the motion rate) and says how the run ended. Several lines: see `tour`.

A line that turns out to be open is followed from end to end: the head that was put down on its middle runs to one end first, with nothing recorded, and
begins there. A line that does not come back one way round is tried the other way; one that runs into what has been followed already is tried with
other turns at its junctions, as an operator would.

Source: patent ES 361967, section on use: the operator brings the head over the drawing and lets it run.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations

import numpy as np

from motion.faults import LineFault
from motion.motion import MOTION_RATE_HZ
from tracer.drawing import Drawing
from tracer.follower import Followed, Follower
from tracer.leg import turn
from tracer.line import Line
from tracer.lines import INK, Sheet, Stroke
from tracer.operator import Direction, Operator
from tracer.program import Trace
from tracer.settings import Settings
from tracer.stance import Stance, ends_of, put_down, turned_round
from tracer.survey import SIDES, Side

SHORTER = 0.95  # the other way round is the line itself if it is shorter than this: straight on has led elsewhere
DOUBTS = 8  # looked into, of a run
TURNS = 12  # junctions at which another turn is tried
TRIED_MM = 6000.0  # travel in all that is spent on other turns
SHORT = 0.5  # of the ink that is joined to it: a run that ends so soon is another line's, which crosses this one
ELSEWHERE = 5  # places at which the head is put down then
OVERRUN_MM = 3.0  # a stub as short, straight on from a closed line, is where the pen set out, and not another's line


Told = Callable[[float], None]


def trace(
    drawing: Drawing,
    start_mm: tuple[float, float] | None = None,
    settings: Settings | None = None,
    operator: Operator | None = None,
    progress: Callable[[float, float], None] | None = None,
) -> Trace:
    """Follow a line of the drawing: the one at `start_mm` (sheet mm), or the longest.

    `progress` hears how far the head has come and the length of the line, mm. Raises LineFault if there is no line to start on, CardFault for a stop that
    the operator cannot serve; a line that is lost on the way is no exception, but the trace's `fault`.
    """
    operator = operator or Operator()
    return Trace((followed(Sheet.of(drawing), start_mm, settings or Settings(), operator, progress),), operator)


def followed(
    sheet: Sheet,
    start_mm: tuple[float, float] | None,
    settings: Settings,
    operator: Operator,
    progress: Callable[[float, float], None] | None = None,
    number: int = 1,
) -> Line:
    """The head's best run along the line at a place, or along the longest."""
    stances = put_down(
        sheet, start_mm, settings.aperture_mm, settings.line_width_mm, settings.gap_mm, operator.reference_mm
    )
    best, others = _best(sheet, stances, start_mm, settings, operator, progress, number)
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
    """The head's best run from the open ends of a line, as of a lead line; None if it has none, or the line is lost from each."""
    stances = ends_of(
        sheet, stroke, settings.aperture_mm, settings.line_width_mm, settings.gap_mm, operator.reference_mm
    )
    best, _ = _best(sheet, iter(stances), None, settings, operator, progress, number)
    return best if best is not None and best.ending != "lost" else None


def followed_through(sheet: Sheet, stance: Stance, settings: Settings, operator: Operator) -> list[Line]:
    """The head's runs straight on through a stance, the last one round about in the direction asked for, or from end to end; no other turns are tried."""
    attempts = _Attempts(settings, (), _longest_mm(sheet.drawing, stance.view.width_mm), None)
    runs = [attempts.run(stance)]
    if runs[0].ending == "ended":
        runs.append(attempts.run(turned_round(runs[0].positions_mm[-1], runs[0].heading_rad, runs[0].view)))
    elif runs[0].ending != "closed" or (operator.direction in ("cw", "ccw") and not _goes(runs[0], operator.direction)):
        runs.append(attempts.run(_about(stance)))
    return [Line.of(run) for run in runs]


def _best(
    sheet: Sheet,
    stances: Iterator[tuple[Stance, float]],
    start_mm: tuple[float, float] | None,
    settings: Settings,
    operator: Operator,
    progress: Callable[[float, float], None] | None,
    number: int,
) -> tuple[Line | None, list[Line]]:
    """The best run from one of some stances, None if there are none; and other runs that are as good: lead lines all.

    Which of several open ends a lead line begins at is judged without the card's turns: those are counted from there.
    """
    follow = partial(_line, sheet, start_mm, settings, progress, number)
    straight = replace(operator, card=replace(operator.card, turns=()))
    best, leads, smooth = None, list[tuple[Line, Stance, float]](), list[Line]()
    for stance, length_mm in stances:
        if (leads and not stance.at_end) or len(smooth) > ELSEWHERE:
            break
        if smooth and any(_lies_on(stance, line) for line in smooth):
            continue
        try:
            line = follow(straight if _is_open(stance) else operator, stance, length_mm)
        except LineFault:
            if best is None:
                raise
            continue
        far = line.length_mm > SHORT * length_mm
        if line.is_lead and not _is_open(stance) and far:
            return line, []
        if line.is_lead and _is_open(stance):
            leads.append((line, stance, length_mm))
        best = (line, stance, length_mm) if best is None or line.length_mm > best[0].length_mm else best
        plain = not (stance.at_end and line.junctions_mm)  # at a junction a lead line may come in
        if plain and (line.ending == "closed" or (far and line.ending != "joined")):
            break
        if not stance.at_end:
            smooth.append(line)
            if best[0].ending == "closed" or best[0].length_mm > SHORT * length_mm:
                break
    if best is None:
        return None, []
    line, stance, length_mm = leads[0] if leads else best
    if operator.sides and _is_open(stance):
        line = follow(operator, stance, length_mm)
    return line, [lead for lead, _, _ in leads[1:]]


def _lies_on(stance: Stance, line: Line) -> bool:
    """Whether a stance is on a line that was followed."""
    return bool(np.hypot(*(line.places_mm - stance.place_mm).T).min() < stance.view.width_mm)


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
) -> Line:
    """The line as it is followed from a stance."""
    told = None if progress is None else partial(_tell, progress, length_mm)
    run = _run(stance, start_mm, operator, settings, _longest_mm(sheet.drawing, stance.view.width_mm), told)
    return replace(Line.of(run, number, stance.reference_mm), ink_mm=length_mm)


def _several_lead(lines: list[Line]) -> LineFault:
    """The fault of a drawing on which it is not certain which line is the lead line."""
    places = "; ".join(f"{x:.1f},{y:.1f}" for x, y in (line.start_mm for line in lines))
    return LineFault(
        f"{len(lines)} lines with a tick lead to the contour, from {places}, and no reference point tells which is the lead line;"
        " draw a cross or ring at its beginning, or give one of these places with --start X,Y or --reference X,Y"
    )


def _run(
    stance: Stance,
    start_mm: tuple[float, float] | None,
    operator: Operator,
    settings: Settings,
    longest_mm: float,
    told: Told | None,
) -> Followed:
    """The run from a stance, in the direction and with the turns that the operator asks for."""
    direction, sides = operator.direction, operator.sides
    if direction in ("left", "right"):
        if stance.at_end:
            sides = sides or (direction,)
        else:
            stance = _turned_to(stance, start_mm, direction)
    attempts = _Attempts(settings, sides, longest_mm, told)
    if direction is None:
        return attempts.all_of_it(stance)
    return attempts.round_about(stance, direction)


def _longest_mm(drawing: Drawing, width_mm: float) -> float:
    """How far a run may go before it is going round in circles: four times all the ink."""
    return 4 * float(np.count_nonzero(drawing.darkness > INK)) * drawing.pitch_mm**2 / width_mm + 20


def _tell(progress: Callable[[float, float], None], length_mm: float, come_mm: float) -> None:
    progress(min(come_mm, length_mm), length_mm)


@dataclass(frozen=True, slots=True)
class _Attempts:
    """How a line may be followed: the head's settings, the turns that the operator asks for, and how long a run may be."""

    settings: Settings
    sides: tuple[Side | None, ...]
    longest_mm: float
    told: Told | None
    tips: bool = False  # go back from a tip in which two lines end

    def run(self, stance: Stance, turns: tuple[int, ...] = ()) -> Followed:
        """Follow from a stance."""
        follower = Follower(stance, self.settings, MOTION_RATE_HZ, turns, self.sides, self.tips)
        return follower.follow(self.longest_mm, self.told)

    def all_of_it(self, stance: Stance) -> Followed:
        """Follow a line from a stance: either way round, an open one from end to end, and one that does not come back with other turns."""
        run = self.run(stance)
        if stance.at_end or (run.ending == "closed" and not run.junctions_mm):
            return self._taken_in(stance, run)
        if run.at_tip:
            both = replace(self, tips=True)
            there_and_back = both.run(stance)
            if there_and_back.ending == "closed":
                return both._taken_in(stance, there_and_back)
        other = self.run(_about(stance))
        if run.ending == "closed":
            if other.ending == "closed" and other.travel_mm < SHORTER * run.travel_mm:
                return self._taken_in(_about(stance), other)
            return self._taken_in(stance, run)
        if run.ending == "ended":
            back = self.run(turned_round(run.positions_mm[-1], run.heading_rad, run.view))
            if other.ending == "closed" and not other.travel_mm < back.travel_mm < other.travel_mm + OVERRUN_MM:
                return other
            return max(run, back, key=lambda r: r.travel_mm)
        if other.ending == "closed":
            return other
        return self._with_other_turns(stance, run) if run.ending == "joined" else run

    def _taken_in(self, stance: Stance, run: Followed) -> Followed:
        """A run that closes, with the ink taken in that it left out where another way would have done as well: the longest of `DOUBTS` more runs."""
        best, tried = run, 0
        open_runs: list[tuple[Followed, tuple[int, ...]]] = [(run, ())]
        while open_runs and best.doubts:
            run, turns = open_runs.pop(int(np.argmax([some.travel_mm for some, _ in open_runs])))
            for number, rank in run.doubts if run.ending == "closed" else ():
                if number in turns or tried == DOUBTS:
                    continue
                more = (*turns, *(number,) * rank)
                other, tried = self.run(stance, more), tried + 1
                open_runs.append((other, more))
                best = other if other.ending == "closed" and other.travel_mm > best.travel_mm else best
        return best

    def _with_other_turns(self, stance: Stance, run: Followed) -> Followed:
        """The shortest run that closes because it takes another turn at one junction, or else at two; else the run as it was.

        No more are tried when the head has gone `TRIED_MM` with them.
        """
        places, gone_mm = range(min(len(run.junctions_mm), TURNS)), 0.0
        for turns in ([(k,) for k in places], list(combinations(places, 2))):
            closed = []
            for some in turns:
                if gone_mm < TRIED_MM:
                    other = self.run(stance, some)
                    gone_mm += other.travel_mm
                    closed += [other] if other.ending == "closed" else []
            if closed:
                return min(closed, key=lambda other: other.travel_mm)
        return run

    def round_about(self, stance: Stance, direction: Direction) -> Followed:
        """Follow a line in the direction that the operator asks for; raises LineFault if it has none, or does not come back in it."""
        run = self.all_of_it(stance)
        if direction in ("left", "right") or _goes(run, direction):
            return run
        sided = [replace(self, sides=(side,)) for side in SIDES]
        tries = [other.run(stance) for other in sided] if stance.at_end else [self.run(_about(stance))]
        for other in tries:
            if other.ending == run.ending and _goes(other, direction):
                return other
        what = "the line is open" if run.ending == "ended" else "the line does not come back that way round"
        raise LineFault(f"direction {direction}: {what}; leave --direction out, or look at the drawing")


def _goes(run: Followed, direction: Direction) -> bool:
    """Whether a run goes round in a direction."""
    if run.ending not in ("closed", "joined") or (run.ending == "joined" and run.loop_from is None):
        return False
    x, y = run.positions_mm[run.loop_from or 0 :].T
    area = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    return (area > 0) == (direction == "ccw")


def _about(stance: Stance) -> Stance:
    """The same place, the other way."""
    return replace(stance, heading_rad=math.remainder(stance.heading_rad + math.pi, math.tau))


def _turned_to(stance: Stance, start_mm: tuple[float, float] | None, side: Side) -> Stance:
    """The stance as the head comes to it from the place where it was put down, turning to a side; raises LineFault if that is on the line."""
    way = stance.place_mm - np.asarray(stance.place_mm if start_mm is None else start_mm)
    if np.hypot(*way) < 0.5 * stance.view.width_mm:
        raise LineFault(
            f"direction {side}: the head comes to the line from nowhere; give --start X,Y beside the line, or --direction cw or ccw"
        )
    ahead = turn(math.atan2(way[1], way[0]), stance.heading_rad)
    return stance if (ahead > 0) == (side == "left") else _about(stance)
