"""Attempts: the head's runs from where it was put down, and which of them is the line.

Signals: a stance in; the run that is kept out: positions and how it ended.

A line that turns out to be open is followed from end to end: the head that was put down on its middle runs to
one end first, with nothing recorded, and begins there. A line that does not come back one way round is tried
the other way; one that runs into what has been followed already is tried with other turns at its junctions,
as an operator would: but not before the head has been put down elsewhere (see `sequence`). It may stand on a
chord, and the line is what that leads to.

Source: patent ES 361967, section on use: the operator brings the head over the drawing and lets it run.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from scipy.spatial import cKDTree

from morfax.motion.faults import LineFault
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import lengths_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import INK
from morfax.tracer.following.direction import Direction, Route
from morfax.tracer.following.edge_check import kept_to
from morfax.tracer.following.enlarger import enlarged, reduced
from morfax.tracer.following.follower import Followed, Follower
from morfax.tracer.following.thinning import THINNED
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance, turned_round
from morfax.tracer.sensing.leg import turn
from morfax.tracer.sensing.side import SIDES, Side

# the other way round is the line itself if it is shorter than this: straight on has led elsewhere
SHORTER = 0.95
DOUBTS = 8  # looked into, of a run
TURNS = 12  # junctions at which another turn is tried
TRIED_MM = 6000.0  # travel in all that is spent on other turns
TWICE = 0.1  # of a run: legs that end in one tip run together for less, as crossing lines do
# widths from place to place of it, and twice that from a place on its way back along the same line
ALONG = 0.1
AGAIN = 4  # widths on from a place, the run may come by it again
# a stub as short, straight on from a closed line, is where the pen set out, and not another's line
OVERRUN_MM = 3.0

Told = Callable[[float], None]


def asked_for(
    drawing: Drawing,
    stance: Stance,
    start_mm: tuple[float, float] | None,
    route: Route,
    settings: Settings,
    told: Told | None,
    other_turns: bool = True,
) -> Followed:
    """The run from a stance, in the direction and with the turns that the operator asks for; with other turns
    than those, or straight on only.
    """
    direction, sides = route
    if direction in ("left", "right"):
        if stance.at_end:
            sides = sides or (direction,)
        else:
            stance = _turned_to(stance, start_mm, direction)
    attempts = Attempts(
        drawing,
        settings,
        sides,
        longest_mm(drawing, stance.view.width_mm),
        told,
        other_turns=other_turns,
    )
    if direction is None:
        return attempts.all_of_it(stance)
    return attempts.round_about(stance, direction)


def longest_mm(drawing: Drawing, width_mm: float) -> float:
    """How far a run may go before it is going round in circles: four times all the ink."""
    return (
        4 * float(np.count_nonzero(drawing.darkness > INK)) * drawing.pitch_mm**2 / width_mm
        + 20
    )


@dataclass(frozen=True, slots=True)
class Attempts:
    """How a line of a drawing may be followed: the head's settings, the turns that the operator asks for, and
    how long a run may be.
    """

    drawing: Drawing
    settings: Settings
    sides: tuple[Side | None, ...]
    longest_mm: float
    told: Told | None
    tips: bool = False  # go back from a tip in which two lines end
    other_turns: bool = True  # where straight on does not come back

    def run(self, stance: Stance, turns: tuple[int, ...] = ()) -> Followed:
        """Follow from a stance."""
        times, told = self.drawing.enlarged, self.told
        follower = Follower(
            enlarged(stance, times), self.settings, MOTION_RATE_HZ, turns, self.sides, self.tips
        )
        reduced_told = None if told is None else lambda come_mm: told(come_mm / times)
        run = reduced(follower.follow(times * self.longest_mm, reduced_told))
        return kept_to(self.drawing.edges_mm, run)

    def all_of_it(self, stance: Stance) -> Followed:
        """Follow a line from a stance: either way round, an open one from end to end, and one that does not
        come back with other turns.
        """
        run = self.run(stance)
        if stance.at_end or (run.ending == "closed" and not run.junctions_mm):
            return self._taken_in(stance, run)
        if (there_and_back := self._through_tips(stance, run)) is not None:
            return there_and_back
        other = self.run(turned_about(stance))
        if (
            run.ending != "closed"
            and (there_and_back := self._through_tips(turned_about(stance), other)) is not None
        ):
            return there_and_back
        if run.ending == "closed":
            if other.ending == "closed" and other.travel_mm < SHORTER * run.travel_mm:
                return self._taken_in(turned_about(stance), other)
            return self._taken_in(stance, run)
        if run.ending == "ended":
            back = self.run(turned_round(run.positions_mm[-1], run.heading_rad, run.view))
            if (
                other.ending == "closed"
                and not other.travel_mm < back.travel_mm < other.travel_mm + OVERRUN_MM
            ):
                return other
            return max(run, back, key=lambda r: r.travel_mm)
        if other.ending == "closed":
            return other
        return (
            self._with_other_turns(stance, run)
            if run.ending == "joined" and self.other_turns
            else run
        )

    def _through_tips(self, stance: Stance, run: Followed) -> Followed | None:
        """The run from a stance that goes back from tips in which two lines end, if the one that does not
        ended in such a tip, and this one closes.

        It does not if it goes back from there along the line that it came by.
        """
        if not run.at_tip:
            return None
        both = replace(self, tips=True)
        there_and_back = both.run(stance)
        closes = there_and_back.ending == "closed" and not _goes_twice(there_and_back)
        return both._taken_in(stance, there_and_back) if closes else None

    def _taken_in(self, stance: Stance, run: Followed) -> Followed:
        """A run that closes, with the ink taken in that it left out where another way would have done as
        well: the longest of `DOUBTS` more runs.
        """
        best, tried = run, 0
        open_runs: list[tuple[Followed, tuple[int, ...]]] = [(run, ())]
        while open_runs and best.doubts:
            run, turns = open_runs.pop(
                int(np.argmax([some.travel_mm for some, _ in open_runs]))
            )
            for number, rank in run.doubts if run.ending == "closed" else ():
                if number in turns or tried == DOUBTS:
                    continue
                more = (*turns, *(number,) * rank)
                other, tried = self.run(stance, more), tried + 1
                open_runs.append((other, more))
                best = (
                    other
                    if other.ending == "closed" and other.travel_mm > best.travel_mm
                    else best
                )
        return best

    def _with_other_turns(self, stance: Stance, run: Followed) -> Followed:
        """The shortest run that closes because it takes another turn at one junction, or else at two; else
        the run as it was.

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
        """Follow a line in the direction that the operator asks for; raises LineFault if it has none, or does
        not come back in it.
        """
        run = self.all_of_it(stance)
        if direction in ("left", "right") or goes(run, direction):
            return run
        sided = [replace(self, sides=(side,)) for side in SIDES]
        tries = (
            [other.run(stance) for other in sided]
            if stance.at_end
            else [self.run(turned_about(stance))]
        )
        for other in tries:
            if other.ending == run.ending and goes(other, direction):
                return other
        what = (
            "the line is open"
            if run.ending == "ended"
            else "the line does not come back that way round"
        )
        raise LineFault(
            f"direction {direction}: {what}; leave --direction out, or look at the drawing"
        )


def goes(run: Followed, direction: Direction) -> bool:
    """Whether a run goes round in a direction."""
    if run.ending not in ("closed", "joined") or (
        run.ending == "joined" and run.loop_from is None
    ):
        return False
    x, y = run.positions_mm[run.loop_from or 0 :].T
    area = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    return (area > 0) == (direction == "ccw")


def _goes_twice(run: Followed) -> bool:
    """Whether more than `TWICE` of a run goes along what it has followed before."""
    way_mm, step_mm = run.positions_mm[::THINNED], ALONG * run.view.width_mm
    travel_mm = lengths_mm(way_mm)
    at_mm = np.arange(0.0, travel_mm[-1], step_mm)
    places = np.column_stack([np.interp(at_mm, travel_mm, column) for column in way_mm.T])
    near = cKDTree(places).query_pairs(2 * step_mm, output_type="ndarray")
    again = near[np.ptp(near, axis=1) * ALONG > AGAIN] if len(near) else near
    return len(np.unique(again[:, 1])) > TWICE * len(places) + AGAIN / ALONG


def turned_about(stance: Stance) -> Stance:
    """The same place, the other way."""
    return replace(stance, heading_rad=math.remainder(stance.heading_rad + math.pi, math.tau))


def _turned_to(stance: Stance, start_mm: tuple[float, float] | None, side: Side) -> Stance:
    """The stance as the head comes to it from the place where it was put down, turning to a side; raises
    LineFault if that is on the line.
    """
    way = stance.place_mm - np.asarray(stance.place_mm if start_mm is None else start_mm)
    if np.hypot(*way) < 0.5 * stance.view.width_mm:
        raise LineFault(
            f"direction {side}: the head comes to the line from nowhere; give --start X,Y beside the line, or --direction cw or ccw"
        )
    ahead = turn(math.atan2(way[1], way[0]), stance.heading_rad)
    return stance if (ahead > 0) == (side == "left") else turned_about(stance)
