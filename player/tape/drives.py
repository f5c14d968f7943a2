"""The drives: the loops of all axes, stepped row by row of the tape.

Signals in: phase of each axis track in cycles (tape against reference); the reference, in cycles from row to
row. Signals out: the place of each screw in mm, what was demanded of it, and the row from which a drive is
out of its range.

    phases ─► + phase changer 155 ─► loop of phase_lock.py ─► screw ─► + place at rest ─► place, mm
                     └─────────────────────────────────────────────► + place at rest ─► demand, mm

Each loop waits most of the time for its own last step, so the axes are stepped beside each other.

Source: patent ES 361967, figure 5. Questions: none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import keeps_kinds, njit
from morfax.motion.drive import SOUND, as_rows, conditioned_step, limited
from morfax.motion.ramp import positions_mm
from morfax.player.monitor.following_limit import FollowingLimit, learn_table
from morfax.player.tape.comparator import compared, track_edges
from morfax.player.tape.phase_lock import BACK_S, PhaseLock, place
from morfax.player.tape.sector_wheel import SectorWheel, Wheels, edges_since, last_edge
from morfax.recorder.tape.format import SURE_CYCLES

TRIED_SPEEDS = 16  # points of the table of following errors, up to the top speed
ADJUSTING_MM_S = 10.0  # how fast the machine creeps while the phase changer is turned
# 25 periods of the usual loop, after which a turned phase changer is at rest
SETTLING_S = 0.1
# columns of the state of an axis; SECTOR: the one that its cell saw last, COUNT: of the edges seen, LAST:
# phase of the row before
POSITION, SPEED, DEMAND, LEAD, ERROR, SECTOR, COUNT, LAST = 0, 1, 2, 3, 4, 5, 6, 7


@dataclass(frozen=True, slots=True)
class ReferenceTrack:
    """What the reference track does at the machine: cycles from row to row, and the wheels that it turns."""

    cycles_per_row: float = 1.0
    wheel: SectorWheel = field(default_factory=SectorWheel)


class _Fields(NamedTuple):
    steps: int  # from row to row
    mm_per_cycle: float
    range_mm: float
    dt_s: float
    back: float  # share of the integrator's way back, in a step
    gain: float  # amplifier 161 and integrator 159, as `Network` has them
    zero: float
    lead_zero: float
    lead_pole: float
    motor_gain: float  # motor 163: share of the speed error made good in a step
    largest_change_mm_s: float  # of its speed in a step
    top_mm_s: float
    wheels: Wheels
    state: Array  # (axes, columns above)


@keeps_kinds
class Loops(_Fields):
    """The loops as the kernel takes them: figures of comparator, networks and motor; wheels; their state."""


class Drives:
    """The axis drives; state is carried from block to block. `steps`: loop steps from row to row."""

    def __init__(
        self,
        axes: int,
        mm_per_cycle: float,
        rate_hz: float,
        settings: PhaseLock | None = None,
        *,
        steps: int = 1,
        reference: ReferenceTrack | None = None,
    ) -> None:
        self.settings = settings or PhaseLock()
        reference = reference or ReferenceTrack()
        wheels = reference.wheel.wheels(axes, mm_per_cycle)
        self._cycles = reference.cycles_per_row / steps  # of the reference in a step
        self._stepped = 0
        dt_s = 1 / (rate_hz * steps)
        self._machine = _machine(self.settings, mm_per_cycle, dt_s, steps, wheels, axes)
        self._state = self._machine.state
        # before the first edge
        self._state[:, SECTOR], self._state[:, COUNT] = wheels.sectors - 1, -1
        self.conditions = [SOUND] * axes

    def follow(self, cycles: Array) -> Array:
        """Displacements (n, axes) in mm for phases (n, axes); fewer rows if a drive left the range."""
        still = np.zeros(cycles.shape[1])
        return self.run(cycles, still, still)[0]

    def run(self, cycles: Array, zero_cycles: Array, rest_mm: Array) -> tuple[Array, Array]:
        """Places of the screws and demands (n, axes) in mm, for phases, as `follow`.

        `zero_cycles` are added to the phases of each axis, `rest_mm` is where its screw stood at first.
        """
        cycles = np.ascontiguousarray(cycles, dtype=np.float64)
        places_mm, demands_mm = np.empty((2, *cycles.shape))
        steps = _follow(
            cycles,
            (zero_cycles, rest_mm),
            (self._stepped, self._cycles),
            self._machine,
            as_rows(self.conditions),
            places_mm,
            demands_mm,
        )
        self._stepped += steps
        rows = steps // self._machine.steps
        return places_mm[:rows], demands_mm[:rows]

    def adjust(self, shift_mm: Array) -> None:
        """Turn the phase changers 155 until the screws stand this far from before; the tape stands still."""
        rate_hz = 1 / (self._machine.dt_s * self._machine.steps)
        way = positions_mm(np.zeros(len(shift_mm)), shift_mm, ADJUSTING_MM_S, rate_hz=rate_hz)
        still = np.repeat(way[-1:], round(SETTLING_S * rate_hz), axis=0)
        self.follow(np.vstack([way, still]) / self._machine.mm_per_cycle)

    @property
    def cell_edges(self) -> Array:
        """The edges that the cells 141 have given since the start, whole numbers."""
        return self._state[:, COUNT].copy()

    @property
    def error_mm(self) -> Array:
        """The comparators' last errors, mm."""
        return self._state[:, ERROR].copy()


def _machine(
    settings: PhaseLock, mm_per_cycle: float, dt_s: float, steps: int, wheels: Wheels, axes: int
) -> Loops:
    """The loops for so many steps from row to row; raises ValueError if the motion rate is too low."""
    drive = settings.drive
    network = place(settings, dt_s)
    return Loops(
        steps=steps,
        mm_per_cycle=mm_per_cycle,
        range_mm=settings.range_cycles * mm_per_cycle,
        dt_s=dt_s,
        back=-math.expm1(-dt_s / BACK_S),
        gain=network.gain,
        zero=network.zero,
        lead_zero=network.lead_zero,
        lead_pole=network.lead_pole,
        motor_gain=drive.gain(dt_s),
        largest_change_mm_s=drive.acceleration_mm_s2 * dt_s,
        top_mm_s=drive.top_speed_mm_s,
        wheels=wheels,
        state=np.zeros((axes, 8)),
    )


def following_limit(settings: PhaseLock, mm_per_cycle: float, rate_hz: float) -> FollowingLimit:
    """The following error that a speed explains: the largest of a sound drive turned round at once.

    No program whose axis runs at a speed can ask for a greater change than from there to as fast the other
    way. A rate is held for twice the time in which the motor stops out of the fastest speed that it can be
    stopped from at once.
    """
    range_mm, most_mm_s2 = (
        settings.range_cycles * mm_per_cycle,
        settings.drive.acceleration_mm_s2,
    )
    speeds = np.linspace(0, math.sqrt(range_mm * most_mm_s2 / 2), TRIED_SPEEDS + 1)[1:]
    half = round(rate_hz * (0.05 + 4 * speeds[-1] / most_mm_s2))
    turn = (half - np.abs(np.arange(2 * half) - half))[:, None] / rate_hz * speeds
    sound = Drives(TRIED_SPEEDS, 1.0, rate_hz, replace(settings, range_cycles=math.inf)).follow(
        turn
    )
    learnt = learn_table(turn, sound, rate_hz, [0.0, *(speeds[:-1] * (1 + 1e-6))])
    hold_s = 2 * math.sqrt(2 * range_mm / most_mm_s2)
    points = [(speed, min(error_mm, range_mm)) for speed, error_mm in learnt] + [
        (float(speeds[-1]), range_mm)
    ]
    return FollowingLimit.table(points, SURE_CYCLES * mm_per_cycle, hold_s=hold_s)


@njit(cache=True, nogil=True, _nrt=False)
def _follow(cycles, moved, reference, machine, conditions, places_mm, demands_mm):  # type: ignore[no-untyped-def]
    """Step all axes through a block; the steps done before an error was out of range.

    `moved`: cycles added to the phases, mm to the places; `reference`: steps before the block, and cycles of
    the reference in a step.
    """
    state, sectors = machine.state, machine.wheels.sectors
    zero_cycles, rest_mm = moved
    for row in range(len(cycles)):
        for step in range(machine.steps):
            # the reference since the wheels' last whole turn; motor 116 turns them by it
            done = row * machine.steps + step
            told = (reference[0] + done) * reference[1]
            turned = np.floor(told / sectors)
            phase = told - turned * sectors
            wheel_turned = phase / sectors
            for axis in range(len(state)):
                places_mm[row, axis] = state[axis, POSITION] + rest_mm[axis]
                track = cycles[row, axis] + zero_cycles[axis]
                if machine.steps > 1:
                    before = state[axis, LAST]
                    track = before + (step + 1) / machine.steps * (track - before)
                tape_count, tape_share = track_edges(phase, track)
                tape = tape_count + turned * sectors, tape_share
                if not _stepped(tape, wheel_turned, machine, conditions, axis):
                    return done
        for axis in range(len(state)):
            track = cycles[row, axis] + zero_cycles[axis]
            demands_mm[row, axis] = track * machine.mm_per_cycle + rest_mm[axis]
            state[axis, LAST] = track
    return len(cycles) * machine.steps


@njit(cache=True, inline="always", _nrt=False)
def _stepped(tape, wheel_turned, machine, conditions, axis):  # type: ignore[no-untyped-def]
    """Step the loop of an axis by what the tape tells (count, share); whether its error is in range."""
    state, wheels = machine.state, machine.wheels
    position, speed = state[axis, POSITION], state[axis, SPEED]
    demand, lead = state[axis, DEMAND], state[axis, LEAD]
    error, count = state[axis, ERROR], state[axis, COUNT]
    # 1. the cell's edges (141, 157), the tape's (152), and how far they are apart (153, 158)
    share = 0.0
    if wheels.is_lit:
        seen, share = last_edge(position, wheel_turned, axis, wheels)
        count += edges_since(seen, state[axis, SECTOR], wheels.sectors)
        state[axis, SECTOR], state[axis, COUNT] = seen, count
    now = compared(tape, (count, share)) * machine.mm_per_cycle
    state[axis, ERROR] = now
    # 2. amplifier, integrator, motor
    if not abs(now) <= machine.range_mm:  # fault circuit 162; also where the phase is no number
        return False
    lead_now = machine.lead_pole * lead + now - machine.lead_zero * error  # amplifier 161
    demand += machine.gain * (lead_now - machine.zero * lead)  # integrator 159
    # what the motor can answer: its current,
    # mm/s that a demand may lie off the speed before the current is at its limit
    reach = machine.largest_change_mm_s / machine.motor_gain
    given = limited(demand, speed - reach, speed + reach)
    given = limited(given, -machine.top_mm_s, machine.top_mm_s)  # and its speed
    demand += machine.back * (given - demand)
    # motor 163, tacho
    motor = machine.motor_gain, machine.largest_change_mm_s
    speed_now = conditioned_step(speed, given, motor[0], motor[1], conditions[axis])
    speed_now = limited(speed_now, -machine.top_mm_s, machine.top_mm_s)
    state[axis, POSITION] = position + (speed + speed_now) / 2 * machine.dt_s
    state[axis, SPEED], state[axis, DEMAND], state[axis, LEAD] = speed_now, demand, lead_now
    return True
