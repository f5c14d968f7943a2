"""Pulse servo: command pulses in, a moving table out, with its instantaneous command register, unit circuit
and lag.

Signals in: command pulses -1, 0, +1 per recirculation. Signals out: position of the table in mm, once in
`sampled` recirculations.

    command pulses ──┬──► × 2 ──► counter 104 ──► frequency 105 ──► amplifier 106 ──► motor 107 ──┬──► table
                     │              ▲   ▲ −                                                       │
                     │              │   └──────── quantizer 47: 4 pulses to a position count ◄────┤
                     │      overflow 118                                                          ▼
                     └──► ICR 54 ──► lag subtractor 116, lag register 117 ◄── position register 51

The instantaneous command register (ICR) holds the low bits of where the axis has been told to be. The unit
circuit joins them to the high bits of the position register, and adds or takes one there where the two
straddle a carry:

    difference = (position low bits - ICR) as a number of that many bits
    no borrow, difference negative: + 1        borrow, difference positive: - 1

The lag is added to itself in each recirculation, and its overflows are further pulses to the servo: the
position loop.

    speed demanded = gain · count,   count' = V + k · lag - v,
    k = recirculations per s / 2^(stages of the lag register)

Source: patent from US application 631 214 of 1967, figures 7, 18, 20 and 21, claims 13 and 17 to 22.
Questions: with an ICR of 5 bits the unit circuit is right for lags of -15 … +16 counts only (the text's own
example, 24, is not); beyond that is a fault here. The lag counts half position counts, as the command does:
with the whole counts of the text an axis told to stand between two counts would never rest. The text says
that the lag stays in proportion to the speed; its counter adds up lag pulses, so here the lag goes to nothing
at constant speed. A lag register of 5 stages is right at 6000 recirculations per s, as the historic control
has; at 48 000 it asks for a servo faster than the motor, so there 10 stages. The gain is 500 1/s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.drive import SOUND, Drive, as_rows, conditioned_step
from morfax.motion.usual import INCREMENT_MM

PULSES_PER_COUNT = 2  # 0.0005 in and 0.001 in
QUANTA_PER_PULSE = 2  # multiplier 111
COMMAND, HALF, ICR, QUANTA, COUNT, LAG, LARGEST = range(7)  # registers of an axis
PLACE, SPEED = range(2)  # its table: mm, mm/s


Counts = NDArray[np.int64]
Pulses = NDArray[np.int8]


@dataclass(frozen=True, slots=True)
class PulseServo:
    """Settings of the pulse servos; HISTORIC has the patent's own."""

    pulse_mm: float = INCREMENT_MM
    register_bits: int = 24
    icr_bits: int = 8
    lag_stages: int = 10
    gain_per_s: float = 500.0
    drive: Drive = field(default_factory=Drive)

    @property
    def lag_counts(self) -> tuple[int, int]:
        """The smallest and largest lag in position counts for which the unit circuit is right."""
        half = 1 << (self.icr_bits - 1)
        return 1 - half, half

    @property
    def travel_mm(self) -> float:
        """Reach of the position register to either side, mm."""
        return float((1 << (self.register_bits - 1)) - 1) * PULSES_PER_COUNT * self.pulse_mm


# the gain is ours: a faster loop asks the drive for more than its 5 m/s² where 13 pulses come at once
HISTORIC = PulseServo(
    pulse_mm=0.0127, register_bits=16, icr_bits=5, lag_stages=5, gain_per_s=120.0
)


class PulseServos:
    """The servos of a machine, at rest at first; registers and tables are carried from block to block."""

    def __init__(
        self,
        start: Counts,
        recirculations_hz: float,
        settings: PulseServo | None = None,
        sampled: int = 8,
    ):
        self.settings, self.sampled = settings or PulseServo(), sampled
        self._dt_s, self._phase = 1 / recirculations_hz, 0
        self._registers = np.zeros((len(start), 7), np.int64)
        self._tables = np.zeros((len(start), 2))
        self._registers[:, COMMAND] = start
        self._registers[:, HALF] = self._registers[:, COMMAND] & 1
        self._registers[:, ICR] = (self._registers[:, COMMAND] >> 1) & (
            (1 << self.settings.icr_bits) - 1
        )
        self._registers[:, QUANTA] = self._registers[:, COMMAND] * QUANTA_PER_PULSE
        self._tables[:, PLACE] = self._registers[:, COMMAND] * self.settings.pulse_mm
        self.conditions = [SOUND] * len(start)

    @property
    def largest_lag(self) -> Counts:
        """The largest lag of each axis so far, position counts."""
        return self._registers[:, LARGEST].copy()

    @property
    def count(self) -> Counts:
        """Counter 104 of each axis, in quantizer pulses."""
        return self._registers[:, COUNT].copy()

    @property
    def lag_register(self) -> Counts:
        """Lag register 117 of each axis: the lags added up since its last overflow, pulses."""
        return self._registers[:, LAG].copy()

    @property
    def position(self) -> Counts:
        """The place of each axis by its quantizer 47, pulses."""
        return self._registers[:, QUANTA] // QUANTA_PER_PULSE

    @property
    def command(self) -> Counts:
        """The commanded place of each axis, pulses."""
        return self._registers[:, COMMAND].copy()

    def follow(self, pulses: Pulses) -> tuple[Array, Array, int]:
        """Commands and places (n, axes) in mm once in `sampled` recirculations, and the recirculations done.

        They are fewer than the pulses given where a lag left the range of the unit circuit.
        """
        s, sampled, phase = self.settings, self.sampled, self._phase
        samples = (len(pulses) + phase) // sampled
        commands, places = (
            np.empty((samples, len(self._tables))),
            np.empty((samples, len(self._tables))),
        )
        drive = s.drive.gain(self._dt_s), s.drive.acceleration_mm_s2 * self._dt_s
        quantum_mm = s.pulse_mm / QUANTA_PER_PULSE
        analogue = np.array(
            [s.gain_per_s * quantum_mm, *drive, quantum_mm, self._dt_s, s.pulse_mm]
        )
        timing = np.array([sampled, phase, s.icr_bits, s.lag_stages])
        wrong = as_rows(self.conditions)
        done = _follow(
            pulses, analogue, timing, wrong, self._registers, self._tables, commands, places
        )
        self._phase = (phase + done) % sampled
        kept = (done + phase) // sampled
        return commands[:kept], places[:kept], done


@njit(cache=True, inline="always")
def subtracted(position, icr, bits):  # type: ignore[no-untyped-def]
    """Figure 20, subtractor 116: the position's low bits less the ICR, in as many bits, and the borrow."""
    mask = (1 << bits) - 1
    low = position & mask
    return (low - icr) & mask, low < icr


@njit(cache=True, inline="always")
def unit_circuit(position, icr, bits):  # type: ignore[no-untyped-def]
    """Figure 20: the high bits of the position, one more or less by borrow and sign, joined to the ICR."""
    difference, borrow = subtracted(position, icr, bits)
    negative = difference >> (bits - 1)
    high = position >> bits
    if negative and not borrow:
        high += 1
    if borrow and not negative:
        high -= 1
    return (high << bits) | icr


@njit(cache=True, inline="always")
def lag(position, icr, bits):  # type: ignore[no-untyped-def]
    """Figure 21: the lag behind the command in position counts, a signed number of that many bits."""
    difference, _ = subtracted(position, icr, bits)
    return -(difference - ((difference >> (bits - 1)) << bits))


@njit(cache=True, nogil=True)
def _follow(pulses, analogue, timing, conditions, registers, tables, commands, places):  # type: ignore[no-untyped-def]
    """Step all axes through figure 7; the recirculations done before a lag was out of range."""
    speed_per_count, share, largest_change, quantum_mm, dt_s, pulse_mm = analogue
    sampled, phase, bits, stages = timing
    mask, overflow = (1 << bits) - 1, 1 << stages
    done = len(pulses)
    for axis in range(len(tables)):
        command, half, icr, quanta, count, lags, largest = registers[axis]
        place, speed = tables[axis]
        for row in range(done):
            pulse = pulses[row, axis]
            command += pulse
            count += 2 * pulse
            half += pulse  # adder 112 keeps one bit, and hands on whole counts
            icr = (icr + (half >> 1)) & mask
            half &= 1
            position = quanta >> 2
            behind = lag(position, icr, bits)
            largest = max(largest, abs(behind))
            if unit_circuit(position, icr, bits) != command >> 1:
                done = row
                break
            lags += 2 * behind + half - ((quanta >> 1) & 1)
            if abs(lags) >= overflow:
                further = 1 if lags > 0 else -1
                lags -= further * overflow
                count += 2 * further
            speed = conditioned_step(
                speed, count * speed_per_count, share, largest_change, conditions[axis]
            )
            place += speed * dt_s
            moved = math.floor(place / quantum_mm + 0.5) - quanta
            quanta += moved
            count -= moved
            if (row + phase + 1) % sampled == 0:
                commands[(row + phase) // sampled, axis] = command * pulse_mm
                places[(row + phase) // sampled, axis] = place
        registers[axis] = command, half, icr, quanta, count, lags, largest
        tables[axis] = place, speed
    return done
