"""A run as the operator makes it: the head put down, the line followed, and cut (see `program`).

Signals: a Drawing in; out a Trace, which is a stream of Motion (X, Y, Z in sheet mm at the motion rate) and says how the run ended. Several lines: see `tour`.

A line that turns out to be open is followed from end to end: the head that was put down on its middle runs to one end first, with nothing recorded, and
begins there. A line that does not come back one way round is tried the other way; one that runs into what has been followed already is tried with
other turns at its junctions, as an operator would.

Source: patent ES 361967, section on use: the operator brings the head over the drawing and lets it run.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import combinations

import numpy as np

from motion.motion import MOTION_RATE_HZ
from tracer.drawing import Drawing
from tracer.follower import Followed, Follower
from tracer.line import Line
from tracer.lines import INK, Sheet
from tracer.operator import Operator
from tracer.program import Trace
from tracer.settings import Settings
from tracer.stance import Stance, put_down, turned_round

SHORTER = 0.95  # the other way round is the line itself if it is shorter than this: straight on has led elsewhere
TURNS = 12  # junctions at which another turn is tried


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
    best: tuple[Followed, Stance] | None = None
    stances = put_down(
        sheet, start_mm, settings.aperture_mm, settings.line_width_mm, settings.gap_mm, operator.reference_mm
    )
    for stance, length_mm in stances:
        told = None if progress is None else partial(_tell, progress, length_mm)
        run = _all_of_it(stance, settings, _longest_mm(sheet.drawing, stance.view.width_mm), told)
        best = (run, stance) if best is None or run.travel_mm > best[0].travel_mm else best
        if run.ending == "closed" or run.travel_mm > 0.5 * length_mm:
            break
    assert best is not None  # put_down gives a stance, or raises
    return Line.of(best[0], number, best[1].reference_mm)


def _longest_mm(drawing: Drawing, width_mm: float) -> float:
    """How far a run may go before it is going round in circles: four times all the ink."""
    return 4 * float(np.count_nonzero(drawing.darkness > INK)) * drawing.pitch_mm**2 / width_mm + 20


def _tell(progress: Callable[[float, float], None], length_mm: float, come_mm: float) -> None:
    progress(min(come_mm, length_mm), length_mm)


def _all_of_it(stance: Stance, settings: Settings, longest_mm: float, told: Callable[[float], None] | None) -> Followed:
    """Follow a line from a stance: either way round, an open one from end to end, and one that does not come back with other turns."""
    run = Follower(stance, settings, MOTION_RATE_HZ).follow(longest_mm, told)
    if stance.at_end or (run.ending == "closed" and run.junctions == 0):
        return run
    round_about = replace(stance, heading_rad=math.remainder(stance.heading_rad + math.pi, math.tau))
    other = Follower(round_about, settings, MOTION_RATE_HZ).follow(longest_mm)
    if run.ending == "closed":
        return other if other.ending == "closed" and other.travel_mm < SHORTER * run.travel_mm else run
    if other.ending == "closed":
        return other
    if run.ending == "ended":
        back = turned_round(run.positions_mm[-1], run.heading_rad, run.view)
        return max(run, Follower(back, settings, MOTION_RATE_HZ).follow(longest_mm, told), key=lambda r: r.travel_mm)
    if run.ending == "joined":
        return _with_other_turns(stance, settings, longest_mm, run)
    return run


def _with_other_turns(stance: Stance, settings: Settings, longest_mm: float, run: Followed) -> Followed:
    """The shortest run that closes because it takes another turn at one junction, or else at two; else the run as it was."""
    places = range(min(run.junctions, TURNS))
    for turns in ([(k,) for k in places], list(combinations(places, 2))):
        others = [Follower(stance, settings, MOTION_RATE_HZ, t).follow(longest_mm) for t in turns]
        closed = [other for other in others if other.ending == "closed"]
        if closed:
            return min(closed, key=lambda other: other.travel_mm)
    return run
