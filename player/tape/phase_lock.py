"""Phase lock: the axis drives, from the phase on the tape to the turning of the lead screw, stepped at the
motion rate.

Signals in: phase of the axis track in cycles (tape against reference, from zero at standstill); the
reference, in cycles from row to row. Signals out: displacement of the machine's screw in mm.

    track ─► trigger 152 ─► comparator 153 ─► amplifier 161 ─► integrator 159 ─► motor 163 ─► screw ─┬─►
                             ▲  decoder 158      lead             PI          velocity servo         │
    cell 141 ─► trigger 157 ─┘                                                                       │
       ▲  edges (see sector_wheel)                                                                   │
       └── wheel 115 ◄── motor 116 ◄── reference track              lamp and cell on the arm 118 ◄───┘

The error is the time between the edges of two pulse trains (see comparator); the decoder counts whole cycles,
so it is known over several of them and not over half of one. Beyond its range fault circuit 162 stops the
drive. With e the error in mm, lag T of the motor under its tacho, and s
the complex frequency:

    lead    w = e · (1 + T s) / (1 + s/b)            answers the motor's lag
    PI      u = K (w + a ∫ w dt)                     mm/s, demand to the motor
    motor   x = u / (s (1 + T s))

    loop    s² (1 + s/b) + K (s + a) = 0          type 2: no standing error at rest or at constant speed,
                                                     and at constant acceleration  e = acceleration / (K a)

K, a and b are placed so that the loop has the pair of poles (natural frequency, damping) and a third real one
further out. The placing is done for the stepped loop itself, exactly: with g the motor's gain per period, l =
1 - g, and z the shift by one period,

    (z - 1)² (z - pole) + k (z + 1)(z - zero) = (z - p1)(z - p2)(z - p3),       k = gain · g · dt / 2.

Source: patent ES 361967, figure 5. Questions: the patent gives neither the networks nor a figure. Chosen: no
path from the tape's speed round the comparator (feed-forward is not in the patent); natural frequency 250 Hz,
damping 1, third pole at 500 Hz: a stop with 0.5 m/s² to 0.5 um, a phase margin of 49 degrees. Twice as fast
would follow noise of 26 dB up to the motor's limit. Without the lead in amplifier 161 a loop beyond about 70
Hz round a motor of 1 ms cannot be damped. While the motor's current is at its limit the integrator goes back
to what that gives, else it would run on and the screw far past; in half a millisecond and not at once, else
noise that meets the limit on one side only would push the screw off the tape. The decoder's range is 4 cycles
(0.2 mm): a start or stop from 40 mm/s at once is still followed, more is a fault (off a tape 34 mm/s at once
can be counted, see `rehearsal`). That range is one limit for all speeds; below it `following_limit` allows
what a sound drive needs at the tape's speed.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, field, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.drive import SOUND, Drive, as_rows, conditioned_step, limited
from morfax.motion.ramp import positions_mm
from morfax.player.monitor.monitor import FollowingLimit, learn_table
from morfax.player.tape.comparator import compared, track_edges
from morfax.player.tape.sector_wheel import SectorWheel, edges_since, last_edge

TOLERANCE_CYCLES = 0.25  # of following: noise of the phase, and what a dropout leaves unknown
TRIED_SPEEDS = 16  # points of the table of following errors, up to the top speed
ADJUSTING_MM_S = 10.0  # how fast the machine creeps while the phase changer is turned
# 25 periods of the usual loop, after which a turned phase changer is at rest
SETTLING_S = 0.1
BACK_S = 0.5e-3  # a third of the way in a period of 6 kHz
STEPS_PER_PERIOD = 20.0  # of the natural frequency, at a low motion rate
FEWEST_STEPS = 10.0  # per natural period
# columns of the state of an axis; SECTOR: the one that its cell saw last, COUNT: of the edges seen
POSITION, SPEED, DEMAND, LEAD, ERROR, SECTOR, COUNT = range(7)


# A DC motor of 3 000/min on a screw of 5 mm.
ELECTRIC = Drive(lag_s=0.001, acceleration_mm_s2=5000.0, top_speed_mm_s=250.0)
# A motor of 20 cm³/rev on the same screw: 9 MPa over it are 29 N m, on 4 g m² of screw and table 7 200
# rad/s². A servo valve of 40 l/min turns it 2 000/min, and is itself a lag of some ms (W. J. Thayer, Transfer
# Functions for Moog Servovalves, 1958).
HYDRAULIC = Drive(lag_s=0.003, acceleration_mm_s2=5700.0, top_speed_mm_s=167.0)


@dataclass(frozen=True, slots=True)
class PhaseLock:
    """Settings of an axis drive; `third_pole` is the real pole over the natural frequency."""

    natural_hz: float = 250.0
    damping: float = 1.0
    third_pole: float = 2.0
    range_cycles: float = 4.0
    drive: Drive = ELECTRIC

    def suited_to(self, rate_hz: float) -> PhaseLock:
        """The settings for a motion rate: at a low one the loop is slower, 20 steps to a natural period."""
        return replace(self, natural_hz=min(self.natural_hz, rate_hz / STEPS_PER_PERIOD))

    def poles(self, dt_s: float) -> Array:
        """The three poles of the stepped loop."""
        natural = 2 * math.pi * self.natural_hz * dt_s
        pair = natural * (-self.damping + 1j * cmath.sqrt(1 - self.damping**2))
        other = natural * (-self.damping - 1j * cmath.sqrt(1 - self.damping**2))
        return np.exp([pair, other, -natural * self.third_pole])


# The spring of 40 cm³ of oil (1.4 GPa) under that motor swings at 95 Hz. It is not simulated; the loop stays
# below it.
MOTORS = {"electric": PhaseLock(), "hydraulic": PhaseLock(natural_hz=60.0, drive=HYDRAULIC)}


@dataclass(frozen=True, slots=True)
class Network:
    """Amplifier 161 and integrator 159, stepped: gain in mm/s per mm, lead (zero, pole), zero of the PI."""

    gain: float
    zero: float
    lead_zero: float
    lead_pole: float


def place(settings: PhaseLock, dt_s: float) -> Network:
    """Solve the loop equation for these poles; raises ValueError if the motion rate is too low."""
    if not 0 < settings.natural_hz * dt_s * FEWEST_STEPS <= 1:
        raise ValueError(
            f"a loop of {settings.natural_hz:g} Hz cannot be stepped at {1 / dt_s:g} Hz; "
            f"give more than 0 and at most {1 / dt_s / FEWEST_STEPS:g} Hz"
        )
    one, a2, a1, a0 = np.poly(settings.poles(dt_s)).real
    g = settings.drive.gain(dt_s)
    lead_pole = -1 - (-one + a2 - a1 + a0) / 4
    k = a2 + 2 + lead_pole
    zero = 1 - (one + a2 + a1 + a0) / (2 * k)
    return Network(2 * k / (g * dt_s), zero, 1 - g, lead_pole)


@dataclass(frozen=True, slots=True)
class Reference:
    """What the reference track does at the machine: cycles from row to row, and the wheels that it turns."""

    cycles_per_row: float = 1.0
    wheel: SectorWheel = field(default_factory=SectorWheel)


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
        reference: Reference | None = None,
    ) -> None:
        self.settings = settings or PhaseLock()
        self._mm_per_cycle, self._dt_s, self._steps = mm_per_cycle, 1 / (rate_hz * steps), steps
        reference = reference or Reference()
        self._wheels = reference.wheel.wheels(axes, mm_per_cycle)
        self._cycles = reference.cycles_per_row / steps  # of the reference in a step
        self._stepped = 0
        network = place(self.settings, self._dt_s)
        self._network = np.array(
            [network.gain, network.zero, network.lead_zero, network.lead_pole]
        )
        drive = self.settings.drive
        self._drive = np.array(
            [
                drive.gain(self._dt_s),
                drive.acceleration_mm_s2 * self._dt_s,
                drive.top_speed_mm_s,
            ]
        )
        self._state = np.zeros((axes, 7))
        # before the first edge
        self._state[:, SECTOR], self._state[:, COUNT] = self._wheels.sectors - 1, -1
        self._last = np.zeros((1, axes))  # row of phases
        self.conditions = [SOUND] * axes

    def follow(self, cycles: Array) -> Array:
        """Displacements (n, axes) in mm for phases (n, axes); fewer rows if a drive left the range."""
        cycles = self._between(np.ascontiguousarray(cycles, dtype=np.float64))
        moved = np.empty_like(cycles)
        range_mm = self.settings.range_cycles * self._mm_per_cycle
        back = -math.expm1(-self._dt_s / BACK_S)
        scale = np.array([self._mm_per_cycle, range_mm, self._dt_s, back])
        rows = _follow(
            cycles,
            (self._stepped, self._cycles),
            self._wheels,
            scale,
            self._network,
            self._drive,
            as_rows(self.conditions),
            self._state,
            moved,
        )
        self._stepped += rows
        return moved[self._steps - 1 : rows : self._steps]

    def _between(self, cycles: Array) -> Array:
        """The phases at each step of the loop, interpolated from row to row."""
        if self._steps == 1 or not len(cycles):
            return cycles
        before, self._last = np.vstack([self._last, cycles[:-1]]), cycles[-1:]
        share = np.arange(1, self._steps + 1)[None, :, None] / self._steps
        return (before[:, None] + share * (cycles - before)[:, None]).reshape(
            -1, cycles.shape[1]
        )

    def adjust(self, shift_mm: Array) -> None:
        """Turn the phase changers 155 until the screws stand this far from before; the tape stands still."""
        rate_hz = 1 / (self._dt_s * self._steps)
        way = positions_mm(np.zeros(len(shift_mm)), shift_mm, ADJUSTING_MM_S, rate_hz=rate_hz)
        still = np.repeat(way[-1:], round(SETTLING_S * rate_hz), axis=0)
        self.follow(np.vstack([way, still]) / self._mm_per_cycle)

    @property
    def cell_edges(self) -> Array:
        """The edges that the cells 141 have given since the start, whole numbers."""
        return self._state[:, COUNT].copy()

    @property
    def error_mm(self) -> Array:
        """The comparators' last errors, mm."""
        return self._state[:, ERROR].copy()


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
    return FollowingLimit.table(points, TOLERANCE_CYCLES * mm_per_cycle, hold_s=hold_s)


@njit(cache=True, nogil=True, _nrt=False)
def _follow(cycles, reference, wheels, scale, network, drive, conditions, state, moved_mm):  # type: ignore[no-untyped-def]
    """Step all axes through a block; the rows done before an error was out of range.

    `reference`: steps before the block, and cycles of the reference in a step.
    """
    mm_per_cycle, range_mm, dt_s, back = scale
    gain, zero, lead_zero, lead_pole = network
    # mm/s that a demand may lie off the speed before the current is at its limit
    reach = drive[1] / drive[0]
    top = drive[2]
    for row in range(len(cycles)):
        # the reference since the wheels' last whole turn; motor 116 turns them by it
        told = (reference[0] + row) * reference[1]
        turned = np.floor(told / wheels.sectors)
        phase = told - turned * wheels.sectors
        wheel_turned = phase / wheels.sectors
        for axis in range(len(state)):
            position, speed = state[axis, POSITION], state[axis, SPEED]
            demand, lead = state[axis, DEMAND], state[axis, LEAD]
            error, count = state[axis, ERROR], state[axis, COUNT]
            moved_mm[row, axis] = position
            # 1. the cell's edges (141, 157), the tape's (152), and how far they are apart (153, 158)
            share = 0.0
            if wheels.is_lit:
                seen, share = last_edge(position, wheel_turned, axis, wheels)
                count += edges_since(seen, state[axis, SECTOR], wheels.sectors)
                state[axis, SECTOR], state[axis, COUNT] = seen, count
            tape_count, tape_share = track_edges(phase, cycles[row, axis])
            tape = tape_count + turned * wheels.sectors, tape_share
            now = compared(tape, (count, share)) * mm_per_cycle
            state[axis, ERROR] = now
            # 2. amplifier, integrator, motor
            if not abs(now) <= range_mm:  # fault circuit 162; also where the phase is no number
                return row
            lead_now = lead_pole * lead + now - lead_zero * error  # amplifier 161
            demand += gain * (lead_now - zero * lead)  # integrator 159
            # what the motor can answer: its current,
            given = limited(demand, speed - reach, speed + reach)
            given = limited(given, -top, top)  # and its speed
            demand += back * (given - demand)
            # motor 163, tacho
            speed_now = conditioned_step(speed, given, drive[0], drive[1], conditions[axis])
            speed_now = limited(speed_now, -top, top)
            state[axis, POSITION] = position + (speed + speed_now) / 2 * dt_s
            state[axis, SPEED], state[axis, DEMAND], state[axis, LEAD] = (
                speed_now,
                demand,
                lead_now,
            )
    return len(cycles)
