"""Attempts: the head's runs from where it was put down, and which of them is the line.

Signals: a stance in; the run that is kept out: positions (mm) and the ending.

An open line is followed from end to end: a head that was put down in the middle first runs to one end with
nothing recorded, and begins there. A line that does not come back one way round is tried the other way. A
line that runs into what has been followed already is tried with other turns at its junctions, as an operator
would try; but only after the head has been put down elsewhere (see `program.trace`), because the head may
stand on a chord, and the line is what the chord leads to.

Source: patent ES 361967, section on use: the operator brings the head over the drawing and lets it run.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import combinations

import numpy as np

from morfax.motion.faults import LineFault
from morfax.motion.long_array import one_in
from morfax.motion.neighbours import crowds
from morfax.motion.polyline import evenly
from morfax.motion.usual import MOTION_RATE_HZ, THINNED
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.speckled import ENOUGH_PX
from morfax.tracer.following import knots
from morfax.tracer.following.branches import Branches
from morfax.tracer.following.direction import Direction, goes, turned_about, turned_to
from morfax.tracer.following.edge_check import kept_to
from morfax.tracer.following.enlarger import enlarged, reduced
from morfax.tracer.following.followed import Followed
from morfax.tracer.following.follower import Follower
from morfax.tracer.following.ways_out import Turns
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance, turned_round
from morfax.tracer.limits import LONGER_WIDTHS
from morfax.tracer.sensing.side import SIDES, Side
from morfax.tracer.sensing.view import STEP_WIDTHS

# All limits below were chosen by trial on the test drawings.
SHORTER = 0.95  # the other way round is the line if as short: straight on has led elsewhere
DOUBTS = 8  # doubts of a run that are looked into
TURNS = 12  # junctions at which another turn is tried
TRIED_MM = 6000.0  # travel in all that is spent on other turns
TWICE = 0.1  # of a run: crossing lines and legs that end in one tip run together for less
OVERRUN_MM = 3.0  # a stub as short, straight on from a closed line, is where the pen set out
LONGEST = 4.0  # times all the ink, and ...
LONGEST_MM = 20.0  # ... this: a run that goes further is going round in circles

Told = Callable[[float], None]
Keep = Callable[[Follower], None]


def longest_mm(drawing: Drawing, width_mm: float) -> float:
    """How far a run may go on a drawing before it is going round in circles, mm."""
    ink_mm2 = drawing.ink_px * drawing.pitch_mm**2
    return LONGEST * ink_mm2 / width_mm + LONGEST_MM


@dataclass(frozen=True, slots=True)
class _Doubtful:
    """A run with the turns that it took, and its doubts that have not been looked into."""

    run: Followed
    turns: tuple[int, ...]
    left: list[tuple[int, int]]

    @classmethod
    def of(cls, run: Followed, turns: tuple[int, ...] = ()) -> _Doubtful:
        """A run with all its doubts at junctions that are not among its turns; none if it did not close."""
        doubts = run.doubts if run.ending == "closed" else ()
        return cls(run, turns, [doubt for doubt in doubts if doubt[0] not in turns])

    def next_turns(self) -> tuple[int, ...]:
        """The turns of a run that takes another way at the next doubt, which is looked into now."""
        number, rank = self.left.pop(0)
        return (*self.turns, *(number,) * rank)


@dataclass(frozen=True, slots=True)
class Attempts:
    """How a line of a drawing may be followed: the head's settings, the operator's turns, the longest run."""

    drawing: Drawing
    settings: Settings
    longest_mm: float
    sides: tuple[Side | None, ...] = ()
    told: Told | None = None
    other_turns: bool = True  # tried where straight on does not come back
    tips: bool = False  # go back from a tip in which two lines end
    by_stations: bool = False  # the slow cell does not lead
    branches: Branches = field(default_factory=Branches)

    def run(self, stance: Stance, turns: tuple[int, ...] = ()) -> Followed:
        """Follow from a stance, with other turns at the junctions of those numbers."""
        times, told = self.drawing.times_at(stance.place_mm), self.told
        told_turns = tuple(turn.enlarged(times) for turn in self.drawing.told_turns)
        wanted = Turns(turns, self.sides, self.tips, self.by_stations, told_turns)
        known = self.branches.known(stance, wanted)
        if known is not None:
            return kept_to(self.drawing.known_edges, reduced(known))
        follower, keep = self._taken_up(stance, wanted)
        branch, before = self.branches.head(stance, wanted)
        follower = follower or branch
        if follower is None:
            put_down, slower = enlarged(stance, times), min(times, 1.0)
            head = replace(self.settings, speed_mm_s=slower * self.settings.speed_mm_s)
            follower = _kind(put_down)(put_down, head, MOTION_RATE_HZ, wanted)
        reduced_told = None if told is None else lambda come_mm: told(come_mm / times)
        run = follower.follow(times * self.longest_mm, reduced_told, keep, before)
        self.branches.ended(follower, run)
        return kept_to(self.drawing.known_edges, reduced(run))

    def _taken_up(self, stance: Stance, turns: Turns) -> tuple[Follower | None, Keep | None]:
        """The head of an earlier run that began as this one will, and what keeps its knots; if anybody asks
        for that.
        """
        memory = knots.memory()
        if (
            memory is None or stance.view.cells.tiles.rows
        ):  # a large sheet's tiles are not copied
            return None, None
        view, place = stance.view, tuple(stance.place_mm.tolist())
        cells = view.cells
        seen = view.width_mm, view.usual_mm, view.level, cells.shape, cells.beyond, view.others
        start = place, stance.heading_rad, stance.reference_mm, seen, repr(self.settings)
        return memory.head(self.drawing, start, turns, view)

    def asked_for(
        self,
        stance: Stance,
        direction: Direction | None,
        start_mm: tuple[float, float] | None = None,
    ) -> Followed:
        """The run from a stance in the direction that the operator asks for; None is any direction.

        Raises LineFault if the line does not go that way round.
        """
        if direction is None:
            return self.all_of_it(stance)
        if direction not in ("left", "right"):
            return self._round_about(stance, direction)
        if stance.at_end:
            return replace(self, sides=self.sides or (direction,)).all_of_it(stance)
        return self.all_of_it(turned_to(stance, start_mm, direction))

    def all_of_it(self, stance: Stance) -> Followed:
        """Follow a line from a stance: either way round, an open one from end to end, and one that does not
        come back with other turns. By stations, if only that closes: on a line of two or three pixels, a few
        um decide what is a leg of a junction.
        """
        run, view = self._all_ways(stance), stance.view
        is_fine = view.width_mm < ENOUGH_PX * view.parted * view.pitch_mm
        if run.ending == "closed" or not (run.went_slowly and is_fine):
            return run
        other = replace(self, by_stations=True)._all_ways(stance)
        return other if other.ending == "closed" else run

    def _all_ways(self, stance: Stance) -> Followed:
        """The run from a stance, the other way round, back from an end, or with other turns."""
        # 1. straight on
        run = self.run(stance)
        if stance.at_end or (run.ending == "closed" and not run.junctions_mm):
            return self._with_doubts(stance, run)
        there_and_back = self._through_tips(stance, run)
        if there_and_back is not None:
            return there_and_back
        # 2. open: back from its end the head has run all of it, and the other way round as well
        back = self._back_from(run) if run.ending == "ended" else None
        if back is not None and _ran_all(back, run, stance):
            return back
        # 3. the other way round
        about = turned_about(stance)
        other = self.run(about)
        if run.ending == "closed":
            is_other = other.ending == "closed" and other.travel_mm < SHORTER * run.travel_mm
            return self._with_doubts(*((about, other) if is_other else (stance, run)))
        there_and_back = self._through_tips(about, other)
        if there_and_back is not None:
            return there_and_back
        # 4. from end to end, or on with other turns
        if back is not None:
            return self._from_end(run, back, other)
        if other.ending == "closed":
            return other
        tries = run.ending == "joined" and self.other_turns
        return self._with_other_turns(stance, run) if tries else run

    def _from_end(self, run: Followed, back: Followed, other: Followed) -> Followed:
        """An open line from end to end; or the other way round, if that closes and the end is no overrun.

        Where the head cannot set out from the one end, as on a few pixels that bend, it does from the other.
        """
        beyond_mm = back.travel_mm - other.travel_mm
        if other.ending == "closed" and not 0 < beyond_mm < OVERRUN_MM:
            return other
        found = max(run, back, key=lambda r: r.travel_mm)
        if other.ending == "ended" and found.travel_mm < other.travel_mm:
            found = max(other, self._back_from(other), key=lambda r: r.travel_mm)
        return found

    def _back_from(self, run: Followed) -> Followed:
        """The run back from where another has ended."""
        return self.run(turned_round(run.positions_mm[-1], run.heading_rad, run.view))

    def _through_tips(self, stance: Stance, run: Followed) -> Followed | None:
        """A run that goes back from tips in which two lines end, if the run without that ended in such a tip.

        None if it does not close, or goes back along the line that it came by.
        """
        if not run.at_tip:
            return None
        both = replace(self, tips=True)
        there_and_back = both.run(stance)
        closes = there_and_back.ending == "closed" and not _goes_twice(there_and_back)
        return both._with_doubts(stance, there_and_back) if closes else None

    def _with_doubts(self, stance: Stance, run: Followed) -> Followed:
        """A closed run with the ink that it left out where another way would have fitted as well: the longest
        of at most `DOUBTS` more runs. It is not looked for beyond one that leaves no such ink out.

        Each leaves the longest run so far: a junction's doubts are settled before those further on.
        """
        best, runs = run, [_Doubtful.of(run)]
        for _ in range(DOUBTS):
            in_doubt = [some for some in runs if some.left]
            if not in_doubt or not best.doubts:
                break
            turns = max(in_doubt, key=lambda some: some.run.travel_mm).next_turns()
            other = self.run(stance, turns)
            runs.append(_Doubtful.of(other, turns))
            if other.ending == "closed" and other.travel_mm > best.travel_mm:
                best = other
        return best

    def _with_other_turns(self, stance: Stance, run: Followed) -> Followed:
        """The shortest run that closes with another turn at one junction, or else at two; else the run given.

        No more turns are tried when the head has gone `TRIED_MM` with them.
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

    def _round_about(self, stance: Stance, direction: Direction) -> Followed:
        """Follow a line round in a direction; raises LineFault if it does not come back that way."""
        run = self.all_of_it(stance)
        if goes(run, direction):
            return run
        if stance.at_end:
            tries = [replace(self, sides=(side,)).run(stance) for side in SIDES]
        else:
            tries = [self.run(turned_about(stance))]
        for other in tries:
            if other.ending == run.ending and goes(other, direction):
                return other
        is_open = run.ending == "ended"
        what = "the line is open" if is_open else "the line does not come back that way round"
        raise LineFault(
            f"--direction {direction}: {what}; leave --direction out, or look at the drawing"
        )


def _ran_all(back: Followed, run: Followed, stance: Stance) -> bool:
    """Whether the run back from the end of another came by where that began, and went on to another end."""
    beyond_mm = back.travel_mm - run.travel_mm
    if back.ending != "ended" or back.at_tip or beyond_mm < stance.view.leg_mm:
        return False
    away_mm = np.hypot(*(one_in(back.positions_mm, THINNED) - stance.place_mm).T)
    return bool(away_mm.min() < stance.view.width_mm)


def _goes_twice(run: Followed) -> bool:
    """Whether more than `TWICE` of a run goes along what it has followed before."""
    step_mm, longer = STEP_WIDTHS * run.view.width_mm, LONGER_WIDTHS / STEP_WIDTHS
    places = evenly(run.positions_mm[::THINNED], step_mm)
    again, _ = crowds(places, 2 * step_mm, math.floor(longer) + 1)
    return int(np.count_nonzero(again)) > TWICE * len(places) + longer


def _kind(put_down: Stance) -> type[Follower]:
    """The head for a line, or for the edge of a filled shape."""
    if not put_down.view.on_edge:
        return Follower
    from morfax.tracer.following.edge_follower import EdgeFollower

    return EdgeFollower
