"""Herbert's control: each line and arc of a program is a positioning move, counted by the transducers.

Signals in: an RS-274 program. Signals out: Motion in blocks at the motion rate, from standstill to
standstill.

    moves ──► increments of all axes ──► counter 60 ──► up, constant, down ──► position servos ──┬──► tables
                                             ▲                                                   │
                                             └────────── an increment of any transducer ◄────────┤
    monitor ◄── what the servos were told, and where the transducers have them ◄─────────────────┘

`morfax play part.ngc --control herbert`. Each move begins and ends at rest, so this is a control for drilling
and for parts of long lines; a contour of many short ones takes its time. A move whose load is not at its end
goes on until it is: the place is the transducer's, not the program's.

Source: patent ES 414458, figures 3 and 4, claims 1 to 4. Questions: the patent has no arcs; here their
increments are counted quarter by quarter, where each axis moves one way. Rapids are 20 mm/s, as in the pulse
control. The limit of the following error is the drive's lag and a period at speed, and 20 um.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.drive import SOUND
from morfax.motion.faults import ProgramFault
from morfax.motion.motion import AXES, MOTION_RATE_HZ, Motion
from morfax.motion.usual import RAPID_MM_S
from morfax.player.gcode.machine_reader import read_program
from morfax.player.gcode.moves import DWELL, RAPID, Move, Program, demand_travel, length_mm
from morfax.player.gcode.pulses import STANDSTILL_S
from morfax.player.monitor.following_limit import FollowingLimit
from morfax.player.monitor.monitor import Supervised
from morfax.player.monitor.position_servo import Interpolated, PositionServo, PositionServos

TOLERANCE_MM = 0.02  # of following, at rest: twenty increments


GAIN_PER_S = 300.0  # the last 11 um of a move are run by the error alone


@dataclass(frozen=True, slots=True)
class PositionControl:
    """Settings of the control."""

    servo: PositionServo = field(default_factory=lambda: PositionServo(GAIN_PER_S))
    rapid_mm_s: float = RAPID_MM_S

    @property
    def limit(self) -> FollowingLimit:
        """The allowed following error: the drive's lag and a period, at speed, and the tolerance."""
        lag_s = self.servo.drive.lag_s + 1 / MOTION_RATE_HZ
        return FollowingLimit.linear(lag_s, TOLERANCE_MM, settle_s=2 * lag_s)


def play_positions(
    file: str | os.PathLike[str],
    *,
    settings: PositionControl | None = None,
    start_mm: Sequence[float] | None = None,
    machine: str | None = None,
) -> PositionPlayback:
    """Put an RS-274 program in the control; raises ProgramFault and FileFault before anything moves."""
    program = read_program(file, start_mm, machine)
    return PositionPlayback(program, settings or PositionControl(), str(file))


class PositionPlayback(Supervised):
    """A program in the control: iterate for the machine's motion; figures are those of the last run.

    `conditions` say what is wrong with the drives; `servos` are those of the last run.
    """

    def __init__(
        self, program: Program, settings: PositionControl, name: str = "program"
    ) -> None:
        self.program, self.settings, self.name = program, settings, name
        self.as_read = program
        self.start_mm: Array = np.array(program.start_mm, np.float64)
        self.end_mm: Array = self.start_mm.copy()
        self.end_error_mm: Array | None = None
        self.conditions, self.limit = [SOUND] * len(AXES), settings.limit
        self.notes = program.notes
        for move in program.moves:
            self._check(move)
        self.servos = PositionServos(self.start_mm, settings=settings.servo)
        self.supervise(AXES, MOTION_RATE_HZ)

    @property
    def duration_s(self) -> float:
        """Approximate running time, s: ramps up and down, and the feed between."""
        place, seconds = self.program.start_mm, 2 * STANDSTILL_S
        most_mm_s2 = self.settings.servo.acceleration_mm_s2
        for move in self.program.moves:
            long_mm, feed = length_mm(place, move), self._feed_mm_s(move)
            seconds += move.dwell_s
            if long_mm > 0:
                feed = min(feed, math.sqrt(long_mm * most_mm_s2))
                seconds += long_mm / feed + feed / most_mm_s2
            place = move.end_mm
        return seconds

    def __iter__(self) -> Iterator[Motion]:
        """Play; raises FollowingFault after the last good sample."""
        self.servos = PositionServos(self.start_mm, settings=self.settings.servo)
        self.servos.conditions = self.conditions
        self.supervise(AXES, MOTION_RATE_HZ)
        self.end_error_mm, samples = None, 0
        for told, places in self._run():
            yield from self.followed(told, places, places, samples / MOTION_RATE_HZ)
            samples += len(places)
        self.end_error_mm = self.end_mm - np.array(self.program.end_mm)

    def _run(self) -> Iterator[tuple[Array, Array]]:
        """What the axes are told and where they are, block by block, standstill included."""
        place = self.program.start_mm
        yield self._stand(place, STANDSTILL_S)
        for move in self.program.moves:
            if move.kind == DWELL:
                yield self._stand(place, move.dwell_s)
            elif (way := self._way(place, move)).increments:
                yield from self.servos.go(np.array(move.end_mm), way)
            place = move.end_mm
        yield self._stand(place, STANDSTILL_S)

    def _stand(self, place: Sequence[float], seconds: float) -> tuple[Array, Array]:
        """Hold a place for a time."""
        increment_mm = self.settings.servo.increment_mm
        held = (
            np.rint(np.array(place) / increment_mm) * increment_mm
        )  # what a transducer can give
        demand = np.tile(held, (round(seconds * MOTION_RATE_HZ), 1))
        return demand, self.servos.follow(demand)

    def _way(self, place: tuple[float, float, float], move: Move) -> Interpolated:
        """A move as the servos take it: its increments on all axes together, and its arc."""
        increment_mm = self.settings.servo.increment_mm
        places = [place, move.end_mm]
        if move.turned_rad:
            places = [place, *_quarters(place, move), move.end_mm]
        counts = np.rint(np.array(places) / increment_mm).astype(np.int64)
        increments = int(sum(np.abs(b - a).sum() for a, b in pairwise(counts)))
        path_mm = length_mm(place, move) / max(1, increments)
        way = Interpolated(self._feed_mm_s(move), increments, path_mm)
        if not move.turned_rad:
            return way
        radius_mm = math.dist(move.centre_mm, move.end_mm[:2])
        sense = int(math.copysign(1, move.turned_rad))
        return way._replace(centre_mm=move.centre_mm, radius_mm=radius_mm, sense=sense)

    def _feed_mm_s(self, move: Move) -> float:
        """The speed of a move."""
        return self.settings.rapid_mm_s if move.kind == RAPID else move.feed_mm_s

    def _check(self, move: Move) -> None:
        """Raise ProgramFault for a move that leaves the travel, or has no feed that the drives can run."""
        demand_travel(self.name, move)
        if move.kind != DWELL and not 0 < self._feed_mm_s(move) < math.inf:
            raise ProgramFault(
                f"{self.name}, line {move.line}: a feed of {move.feed_mm_s * 60:g} mm/min never arrives; "
                "give one above zero",
                line=move.line,
            )


def _quarters(
    place: tuple[float, float, float], move: Move
) -> list[tuple[float, float, float]]:
    """The places of an arc where an axis turns back, in the order of the way."""
    x, y = move.centre_mm
    radius = math.dist(move.centre_mm, move.end_mm[:2])
    first = math.atan2(place[1] - y, place[0] - x)
    low, high = sorted((first, first + move.turned_rad))
    steps = range(math.floor(low / (math.pi / 2)) + 1, math.ceil(high / (math.pi / 2)))
    angles = [k * math.pi / 2 for k in steps]
    return [
        (x + radius * math.cos(angle), y + radius * math.sin(angle), place[2])
        for angle in (angles if move.turned_rad > 0 else reversed(angles))
    ]
