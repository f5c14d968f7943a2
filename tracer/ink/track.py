"""The head on a chain of lines: it follows each clean run, and runs through what lies between from memory.

Signals: a chain and the junctions it goes through in; a stroke out, positions of the screws (n, 2) mm at the
motion rate.

    clean run ───── junction ───── clean run ───── corner ───── …
     kernel          way            kernel          way

The head follows by its swinging cell up to its lead before a run's end. Where its guard cells see what is no
clean line it goes on along what was felt there: slowly by its cell, if that keeps to it, else by stations. It
never has to search: all junctions are known. If its path leaves the line that was felt it goes back to where
it was on it, and runs that piece from memory.

Source: our own; see `tracer.head` for the head itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.plane import direction
from morfax.motion.polyline import length_mm, lengths_mm, nearest_mm
from morfax.tracer.following.felt_line import bare_from_mm, bare_stretch
from morfax.tracer.following.follower import SWELLS
from morfax.tracer.head import course
from morfax.tracer.head.carriage import CHUNK, Carriage
from morfax.tracer.head.leaders import STATIONS, Led
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.slow_cell import SHORTEST_MM
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import CHANGED, MORE, Home, Moment
from morfax.tracer.head.windows import shortest_lead_mm
from morfax.tracer.ink.chains import Chain, Junctions, Side
from morfax.tracer.ink.partners import way_through
from morfax.tracer.ink.pieces import Piece, cut_open, pieces_of
from morfax.tracer.ink.run import Run
from morfax.tracer.junctions.planner import Planner
from morfax.tracer.limits import NEAR
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.view import View

# All limits below were chosen by trial on drawings of nets.
NODES_MM = 0.25  # between the felt places that a course goes through
ONTO_MM, ONTO_SHARE = 0.3, 0.4  # from the last onto a leg: so far, or this share of its run
# a way round half a circle to its chord, and mm: so far along a run the head may be from where it was
ROUND, SLACK_MM = 1.6, 1.0
LEAST_MM = 0.15  # a shorter way before that is none
NEAR_MM = 2.0  # a head further from a leg's end is before it, however the line has come round
BEYOND_LEADS = 0.5  # leads: a piece that is no longer beyond its lead is run from memory
LOOKED_AT = 60  # one position in so many is held against what was felt
SLOWLY_LEGS = 3.0  # the cell goes on by itself for so many legs, then fast again
PAST_MM = 0.3  # stations lead beyond a stub, until its ink no longer draws the cell
NEVER_HOME = Home(0.0, 0.0, 0.0, math.inf)

Told = Callable[[float], None]


class InkStroke(NamedTuple):
    """A stroke: its way (n, 2) mm at the motion rate and its length, whether it closes, the line's width in
    mm, who led.
    """

    way_mm: Array
    length_mm: float
    closed: bool
    width_mm: float
    led: Led = Led()

    def part(self, begin_mm: float, end_mm: float) -> InkStroke:
        """The stroke without so much of its beginning and of its end, mm."""
        come_mm = lengths_mm(self.way_mm)
        first, last = np.searchsorted(come_mm, (begin_mm, come_mm[-1] - end_mm)).tolist()
        last = max(last, first + 1)
        way_mm = self.way_mm[first : last + 1]
        led = Led.along(self.led.of(len(way_mm), first))
        return self._replace(way_mm=way_mm, length_mm=length_mm(way_mm), led=led)


def stroke_along(
    chain: Chain, junctions: Junctions, settings: Settings, told: Told | None = None
) -> InkStroke:
    """Run the head along a chain; `told` hears the travel, mm."""
    pieces = pieces_of(chain, junctions)
    width_mm = _wide_mm(pieces)
    if chain.closed:
        pieces = cut_open(pieces)
    first, last = pieces[0].run, pieces[-1].run
    begins, ends = _stands_at(first, 0), _stands_at(last, -1)
    if not chain.closed:
        begin, end = chain.links[0], chain.links[-1]
        back_mm = junctions.end_mm(Side(begin.line, begin.back))
        on_mm = junctions.end_mm(Side(end.line, not end.back))
        out, into = first.leg_out(), last.leg_in()
        begins = out.at(-back_mm), out.heading_at(-back_mm)
        ends = into.at(on_mm), into.heading_at(on_mm)
    stroke = along_pieces(pieces, begins, ends, settings, told)
    return stroke._replace(closed=chain.closed, width_mm=width_mm)


def along_pieces(
    pieces: Sequence[Piece],
    begins: tuple[Array, float],
    ends: tuple[Array, float],
    settings: Settings,
    told: Told | None = None,
) -> InkStroke:
    """Run the head along pieces, from one place and heading to another."""
    first = pieces[0].run
    carriage = Carriage(Stance(*begins, first.view), settings, MOTION_RATE_HZ)
    head = InkHead(carriage, settings, told)
    head.set_out(first, *begins)
    for k, piece in enumerate(pieces):
        head.follow(piece.run)
        if k + 1 < len(pieces):
            head.through(piece.run, pieces[k + 1])
    head.arrive(pieces[-1].run, ends)
    way_mm = carriage.positions_mm
    return InkStroke(way_mm, length_mm(way_mm), False, _wide_mm(pieces), carriage.led)


def _wide_mm(pieces: Sequence[Piece]) -> float:
    """How wide the line of the longest of some pieces is, mm."""
    return max(pieces, key=lambda piece: len(piece.run)).run.view.width_mm


@dataclass
class InkHead:
    """The head on its carriage."""

    carriage: Carriage
    settings: Settings
    told: Told | None = None
    at: int = 0  # the station at which it left off following the newest run
    from_mm: float = 0.0  # the travel when its station was asked for last

    def set_out(self, run: Run, place_mm: Array, heading_rad: float) -> None:
        """Stand at the beginning of a stroke, aimed along it."""
        self.carriage.aim(
            run.view, Leg(place_mm, heading_rad, 0.0, run.view.width_mm, run.stations())
        )

    def follow(self, run: Run) -> None:
        """Follow a run, from about its first station, up to the lead before its end."""
        at, view, carriage = 0, run.view, self.carriage
        self.from_mm = carriage.travel_mm
        while True:
            self.at = at = self._station(run, at)
            left_mm = self._left_mm(run, at)
            if self._is_at_end(run, at):
                return
            if run.is_strand:
                at = self._along(run, at, math.floor(left_mm / view.step_mm), view)
            else:
                view, at = self._chunk(run, view, at, left_mm)
            if self.told is not None:
                self.told(carriage.travel_mm)

    def _chunk(self, run: Run, view: View, at: int, left_mm: float) -> tuple[View, int]:
        """Follow for a while; from memory where the cells see no clean line, or have left it."""
        carriage = self.carriage
        mark = carriage.mark()
        samples = math.ceil(left_mm / self.settings.speed_mm_s * MOTION_RATE_HZ)
        why = carriage.follow(view, NEVER_HOME, min(samples, CHUNK))
        if self._strayed(run, at, mark):
            carriage.back_to(mark)
        elif why == MORE:
            return view, at
        elif why == CHANGED:
            view = view.like(*carriage.stands(), follows=SWELLS)
            carriage.retune(view)
            return view, at
        at = self._station(run, at)
        if self._slowly(run, view, at):
            return view, self._station(run, at)
        if self._is_at_end(run, at):
            return view, at
        return view, self._along(run, at, self._past(run, view, at), view)

    def _left_mm(self, run: Run, at: int) -> float:
        """How far the head may go by its cell from a station of a run: up to its lead before the end, mm."""
        return (len(run) - 1 - at) * run.view.step_mm - self.carriage.tuning.lead_mm

    def _is_at_end(self, run: Run, at: int) -> bool:
        """Whether what is left of a run from a station is run with what follows it, from memory."""
        return self._left_mm(run, at) < BEYOND_LEADS * self.carriage.tuning.lead_mm

    def _past(self, run: Run, view: View, at: int) -> int:
        """How many stations lead past what stopped the cell: a leg's, or fewer past a stub."""
        leg = round(view.leg_mm / view.step_mm)
        ahead = run.part(at, at + leg + 1)
        bare_mm = bare_from_mm(view, ahead.places_mm, ahead.stations())
        return leg if bare_mm is None else math.ceil((bare_mm + PAST_MM) / view.step_mm)

    def _slowly(self, run: Run, view: View, at: int) -> bool:
        """Whether the cell itself, slow and with a short lead, goes on along what was felt."""
        lead_mm = shortest_lead_mm(self.carriage.tuning)
        left_mm = (len(run) - 1 - at) * view.step_mm - lead_mm
        if left_mm < SHORTEST_MM:
            return False
        on = at + round(min(left_mm, SLOWLY_LEGS * view.leg_mm) / view.step_mm)
        way = self._course(run.part(0, on + 1), at, _stands_at(run, on))
        stretch = bare_stretch(view, self.carriage, way, run.stations()[at : on + 1])
        if stretch is None:
            return False
        to_end_mm = left_mm + lead_mm - length_mm(way)
        stretch = stretch._replace(clear_mm=min(stretch.clear_mm, to_end_mm))
        return self.carriage.follow_slowly(view, NEVER_HOME, stretch) is not None

    def _strayed(self, run: Run, at: int, mark: Moment) -> bool:
        """Whether the newest positions have left what was felt."""
        newest = self.carriage.since(mark)[::LOOKED_AT]
        if not len(newest):
            return False
        beyond = round(
            (len(newest) * LOOKED_AT / MOTION_RATE_HZ * self.settings.speed_mm_s + 1)
            / run.view.step_mm
        )
        felt = run.places_mm[max(0, at - 20) : at + beyond]
        return bool(nearest_mm(newest, felt).max() > NEAR * run.view.width_mm)

    def through(self, run: Run, onward: Piece) -> None:
        """From a run's end through what parts it from the next, and aimed at that."""
        incoming, outgoing = run.leg_in(), onward.run.leg_out()
        back_mm = min(ONTO_MM, ONTO_SHARE * run.length_mm)
        stands, before = self.carriage.stands(), list[Array]()
        if self._ahead_mm(incoming) > back_mm + LEAST_MM:
            onto = incoming.at(-back_mm), incoming.heading_at(-back_mm)
            before, stands = [self._course(run, self._station(run, self.at), onto)], onto
        planner = Planner(run.view, stands, self.carriage.trail, self.settings)
        way = way_through(planner, (incoming, outgoing), onward.between, onward.ink)
        self.carriage.run([np.vstack([*before, way[0]]), *way[1:]], self.settings.speed_mm_s)
        # aimed at the line where the way has come onto it
        along_mm = max(0.0, -course.ahead_mm(way[-1][-1], outgoing))
        leg = outgoing.shifted(along_mm, onward.run.stations())
        self.carriage.aim(onward.run.view, leg)

    def _ahead_mm(self, leg: Leg) -> float:
        """How far the head is before a leg's clean end, mm along the leg."""
        place, _ = self.carriage.stands()
        ahead_mm = course.ahead_mm(place, leg)
        return ahead_mm if math.dist(place, leg.end_mm) < NEAR_MM else math.inf

    def arrive(self, run: Run, end: tuple[Array, float]) -> None:
        """From a run's end to the end of the stroke."""
        self.carriage.run([self._course(run, self._station(run, self.at), end)])

    def _along(self, run: Run, at: int, stations: int, view: View) -> int:
        """Run along so many stations from memory, aimed at what follows; the station come to."""
        on = min(len(run) - 1, at + stations)
        way = self._course(run.part(0, on + 1), at, _stands_at(run, on))
        self.carriage.run([way], self.settings.speed_mm_s, STATIONS)
        self.carriage.aim(view, _leg_at(run, on))
        return on

    def _course(self, run: Run, at: int, end: tuple[Array, float]) -> Array:
        """From where the head stands along a run's stations to a place and heading at its end, (n, 2) mm."""
        stands = self.carriage.stands()
        step_mm = run.view.step_mm
        spacing = max(1, round(NODES_MM / step_mm))
        nodes = [stands]
        way = direction(end[1])
        for k in range(at + spacing, len(run), spacing):
            place, left_mm = run.places_mm[k], (len(run) - 1 - k) * step_mm
            # a loop comes by its end at its beginning, too
            if (end[0] - place) @ way < 0.5 * NODES_MM and left_mm < NEAR_MM:
                break
            nodes.append((place, float(run.headings_rad[k])))
        return course.through_nodes([*nodes, end])

    def _station(self, run: Run, at: int) -> int:
        """The station of a run, from one on, at which the head stands."""
        place, _ = self.carriage.stands()
        # the nearest of those to which it can have come: a small loop ends where it begins
        away_mm = float(np.hypot(*(run.places_mm[at] - place)))
        come_mm = max(self.carriage.travel_mm - self.from_mm, ROUND * away_mm) + SLACK_MM
        self.from_mm = self.carriage.travel_mm
        near = run.places_mm[at : at + 1 + round(come_mm / run.view.step_mm)]
        return at + int(np.argmin(np.hypot(*(near - place).T)))


def _stands_at(run: Run, at: int) -> tuple[Array, float]:
    """The place and heading of a run at a station."""
    return run.places_mm[at], float(run.headings_rad[at])


def _leg_at(run: Run, at: int) -> Leg:
    """A leg that begins at a station of a run."""
    return Leg(
        *_stands_at(run, at),
        float(run.bends_per_mm[at]),
        run.view.width_mm,
        run.stations()[at:],
    )
