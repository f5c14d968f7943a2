"""Pulse control: a program of lines and arcs in, the motion of the machine's own tables out.

Signals in: an RS-274 program. Signals out: Motion in blocks at the motion rate, from standstill to
standstill; a fault comes after the last sample that was still right.

    rs274 ──► command registers ──► residues, feed_control ──► command pulses ──► pulse_servo ──► tables
                                                                              └──► monitor ◄──┘

Each move is brought to rest at its end point by the interpolator: the approach depends on the error alone,
with the time constant L / recirculations per s, so L is the servos' time constant in recirculations. Arcs of
half a turn and more are cut into equal ones below it. What leaves the registers' range, or asks for a speed
that has no feed number, is refused before anything moves.

The interpolator works on where the axes have been told to be. The unit circuit gives it that number, and a
lag for which it would not is a fault; so interpolator and servos can be stepped one after the other, a block
at a time.

Source: patent from US application 631 214 of 1967, figures 3, 7 and 9. Questions: the patent gives no rate
and no L. Chosen: 48 000 recirculations per s (8 to a sample), L = 480 (10 ms), pulses of 1 um, rapids at 20
mm/s, which the servos start to at once within their lag. The historic control has the patent's pulses,
registers and lag stages; 6000 recirculations per s (a clock of 96 kHz) and L = 60 (10 ms) are ours. At the
end of a move counter 81 is full, and the next begins with up to 13 pulses at once (256 eighths in pulses of
20): 13 um, but 0.17 mm of the historic pulses, which its limit allows. The cut of long arcs is ours; arcs up
to 170 degrees are run whole.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.axis import TRAVEL_MM
from morfax.motion.drive import SOUND
from morfax.motion.faults import FollowingFault, ProgramFault
from morfax.motion.motion import AXES, MOTION_RATE_HZ, Motion
from morfax.motion.usual import AT_ONCE, RAPID_MM_S
from morfax.player.gcode.feed_control import feed_number, override_number
from morfax.player.gcode.machine_reader import read_program
from morfax.player.gcode.moves import DWELL, RAPID, Move, Program, demand_travel, length_mm
from morfax.player.gcode.pulse_servo import HISTORIC, PulseServo, PulseServos
from morfax.player.gcode.residues import LINE, Feed, ResidueInterpolator
from morfax.player.monitor.following_limit import FollowingLimit
from morfax.player.monitor.monitor import Supervised

LARGEST_ARC = math.radians(170)  # below the half turn that the residue loops take
STANDSTILL_S = 0.25  # before the first move and behind the last: the lag runs off

Counts = NDArray[np.int64]
Pulses = NDArray[np.int8]


@dataclass(frozen=True, slots=True)
class PulseControl:
    """Settings of the control."""

    servo: PulseServo = field(default_factory=PulseServo)
    recirculations_hz: float = 8 * MOTION_RATE_HZ
    servo_constant: int = 480
    rapid_mm_s: float = RAPID_MM_S
    override: float = 1.0
    true_norm: bool = False
    limit_pulses: int = 4  # that a sound drive may be off beside its lag

    @property
    def limit(self) -> FollowingLimit:
        """The allowed following error: the servo's lag, its start to a speed at once, and some pulses.

        That is its lag, and at speed what the motor's current takes to bring it there.
        """
        lag_s, most_mm_s2 = 1 / self.servo.gain_per_s, self.servo.drive.acceleration_mm_s2
        # a pulse in each recirculation
        speeds = np.linspace(0, self.recirculations_hz * self.servo.pulse_mm, 17)
        errors_mm = lag_s * speeds + speeds**2 / (2 * most_mm_s2)
        points = list(zip(speeds.tolist(), errors_mm.tolist(), strict=True))
        return FollowingLimit.table(
            points, 0.05 + self.limit_pulses * self.servo.pulse_mm, settle_s=2 * lag_s
        )


HISTORIC_CONTROL = PulseControl(HISTORIC, MOTION_RATE_HZ, servo_constant=60, limit_pulses=13)


def play_pulses(
    file: str | os.PathLike[str],
    *,
    settings: PulseControl | None = None,
    start_mm: Sequence[float] | None = None,
    true_norm: bool | None = None,
    override: float | None = None,
    machine: str | None = None,
    fastest_mm_s: float | None = None,
) -> PulsePlayback:
    """Put an RS-274 program in the control; `true_norm` and `override` replace those of the settings.

    Without the name of the `machine` that it is for, the program says so itself. Feeds above the fastest, if
    it is given, are run at that.

    Raises ProgramFault with the line, FileFault, or ValueError for an override that is none, before anything
    moves.
    """
    asked: dict[str, Any] = {"true_norm": true_norm, "override": override}
    control = replace(
        settings or PulseControl(),
        **{name: value for name, value in asked.items() if value is not None},
    )
    program = read_program(file, start_mm, machine)
    most_mm_s = held_mm_s = fastest_mm_s or math.inf
    if program.machine and fastest_mm_s is None:
        # a program for a faster machine is run as fast as this one's rapids, which keeps it within 10 um
        most_mm_s = control.recirculations_hz * control.servo.pulse_mm
        held_mm_s = control.rapid_mm_s
    moves = [
        move._replace(feed_mm_s=held_mm_s) if move.feed_mm_s > most_mm_s else move
        for move in program.moves
    ]
    playback = PulsePlayback(replace(program, moves=moves), control, str(file))
    playback.as_read = program
    if moves != program.moves and fastest_mm_s is None:
        playback.notes += (
            f"{file} asks for feeds above {most_mm_s:g} mm/s, the fastest of this control; they are played "
            f"at {held_mm_s:g} mm/s, along the same path",
        )
    return playback


class PulsePlayback(Supervised):
    """A program in the control: iterate for the machine's motion; figures are those of the last run.

    `conditions` say what is wrong with the drives.
    """

    def __init__(self, program: Program, settings: PulseControl, name: str = "program") -> None:
        self.program, self.settings, self.name = program, settings, name
        self.as_read = program  # where its feeds are above what this control runs
        self.start_mm: Array = np.array(program.start_mm)
        self.end_mm: Array = self.start_mm.copy()
        self.end_error_mm: Array | None = None
        self.conditions, self.limit = [SOUND] * len(AXES), settings.limit
        self.notes = program.notes
        self.supervise(AXES, MOTION_RATE_HZ)
        self._jobs = [self._job(move) for move in program.moves]

    @property
    def duration_s(self) -> float:
        """Approximate running time, s."""
        place, seconds = self.program.start_mm, 2 * STANDSTILL_S
        for move, (feed, _) in zip(self.program.moves, self._jobs, strict=True):
            long_mm = length_mm(place, move)
            seconds += move.dwell_s
            if long_mm > 0:
                approach_s = self.settings.servo_constant / self.settings.recirculations_hz * 6
                seconds += long_mm / (feed * self.settings.override or math.inf) + approach_s
            place = move.end_mm
        return seconds

    def __iter__(self) -> Iterator[Motion]:
        """Play; raises FollowingFault after the last good sample."""
        control = self.settings
        start = self._pulses(self.start_mm)
        interpolator = ResidueInterpolator(start, control.servo_constant)
        servos = PulseServos(start, control.recirculations_hz, control.servo, self._sampled)
        servos.conditions = self.conditions
        self.supervise(AXES, MOTION_RATE_HZ)
        self.end_error_mm, samples = None, 0
        for pulses in self._all_pulses(interpolator):
            commands, places, done = servos.follow(pulses)
            yield from self.followed(commands, places, places, samples / MOTION_RATE_HZ)
            samples += len(places)
            if done < len(pulses):
                raise self._lag_fault(servos, samples / MOTION_RATE_HZ)
        self.end_error_mm = self.end_mm - np.array(self.program.end_mm)

    @property
    def _sampled(self) -> int:
        """Recirculations to a sample of the motion."""
        return round(self.settings.recirculations_hz / MOTION_RATE_HZ)

    def _all_pulses(self, interpolator: ResidueInterpolator) -> Iterator[Pulses]:
        """Command pulses of the whole program, standstill included."""
        yield from self._stand(STANDSTILL_S)
        for move, (_, run) in zip(self.program.moves, self._jobs, strict=True):
            yield from self._stand(move.dwell_s) if move.kind == DWELL else run(interpolator)
        yield from self._stand(STANDSTILL_S)

    def run_moves(self) -> Iterator[tuple[float, Iterator[Pulses]]]:
        """Programmed speed in mm/s and command pulses of each move but dwells, to be run in this order."""
        interpolator = ResidueInterpolator(
            self._pulses(self.start_mm), self.settings.servo_constant
        )
        for move, (speed_mm_s, run) in zip(self.program.moves, self._jobs, strict=True):
            if move.kind != DWELL:
                yield speed_mm_s, run(interpolator)

    def _stand(self, seconds: float) -> Iterator[Pulses]:
        """No pulses for a time, in whole samples."""
        left = round(seconds * MOTION_RATE_HZ) * self._sampled
        while left > 0:
            yield np.zeros((min(left, AT_ONCE), len(AXES)), np.int8)
            left -= AT_ONCE

    def _job(
        self, move: Move
    ) -> tuple[float, Callable[[ResidueInterpolator], Iterator[Pulses]]]:
        """The speed of a move in mm/s, and the function that runs it; raises ProgramFault."""
        control = self.settings
        speed_mm_s = control.rapid_mm_s if move.kind == RAPID else move.feed_mm_s
        feed = Feed()
        if move.kind != DWELL:
            try:
                number = feed_number(
                    speed_mm_s / control.servo.pulse_mm, control.recirculations_hz
                )
            except ValueError as error:
                raise ProgramFault(
                    f"{self.name}, line {move.line}: F{speed_mm_s * 60:g}: {error}",
                    line=move.line,
                ) from None
            feed = Feed(number, override_number(control.override), control.true_norm)
            self._check_travel(move)
        return speed_mm_s, lambda interpolator: self._run(move, feed, interpolator)

    def _check_travel(self, move: Move) -> None:
        """Raise ProgramFault if a move leaves the machine's travel or the range of the registers."""
        servo = self.settings.servo
        if servo.travel_mm < TRAVEL_MM:
            what = f"the registers of {servo.register_bits} bits hold"
            remedy = "move the zero, or use longer ones"
            demand_travel(self.name, move, servo.travel_mm, what, remedy)
        else:
            demand_travel(self.name, move)

    def _run(
        self, move: Move, feed: Feed, interpolator: ResidueInterpolator
    ) -> Iterator[Pulses]:
        """Command pulses of a line or an arc."""
        end = self._pulses(move.end_mm)
        if not move.turned_rad:
            yield from interpolator.recirculate(end, (0, 0), LINE, feed)
            return
        parts = math.ceil(abs(move.turned_rad) / LARGEST_ARC)
        sense = int(math.copysign(1, move.turned_rad))
        centre = self._pulses(move.centre_mm)
        radius = math.dist(move.centre_mm, move.end_mm[:2])
        last = math.atan2(
            move.end_mm[1] - move.centre_mm[1], move.end_mm[0] - move.centre_mm[0]
        )
        for left in range(parts - 1, -1, -1):
            angle = last - move.turned_rad * left / parts
            way = (
                move.centre_mm[0] + radius * math.cos(angle),
                move.centre_mm[1] + radius * math.sin(angle),
            )
            place = np.r_[self._pulses(way), end[2]] if left else end
            yield from interpolator.recirculate(place, centre, sense, feed)

    def _pulses(self, place_mm: Sequence[float] | Array) -> Counts:
        """A place in whole pulses."""
        return np.rint(np.asarray(place_mm) / self.settings.servo.pulse_mm).astype(np.int64)

    def _lag_fault(self, servos: PulseServos, time_s: float) -> FollowingFault:
        """The fault of a lag that is too large for the command register."""
        servo = self.settings.servo
        axis = int(np.argmax(servos.largest_lag))
        limit_mm = servo.lag_counts[1] * 2 * servo.pulse_mm
        demand_mm, actual_mm = (
            float(servos.command[axis]) * servo.pulse_mm,
            float(self.end_mm[axis]),
        )
        return FollowingFault(
            f"the lag of {AXES[axis].upper()} left the range of the {servo.icr_bits} bits of its "
            "command register at "
            f"{time_s:.3f} s: allowed {servo.lag_counts[0]} to {servo.lag_counts[1]} counts, "
            f"{limit_mm:.3f} mm; "
            "run it slower, or give a register of more bits",
            axis=AXES[axis],
            time_s=time_s,
            demand_mm=demand_mm,
            actual_mm=actual_mm,
            limit_mm=limit_mm,
        )
