"""The step control: rows of a punched tape become pulses, and pulses become steps of the motors.

Signals: a `.steps` file in; counts 1 … 15 of one up/down counter for each axis and interval; from them whole
pulses of the interval, evenly spread over its 64 oscillator ticks; out come blocks of Motion, eight samples
to the interval.

    count      1   2   3   4   5   6   7   8   9  10  11  12  13  14  15
    pulses    -7  -6  -5  -4  -3  -2  -1   0   1   2   3   4   5   6   7     per interval, K = 1/interval each

    row ─► bit 5 = 1: axis decoders (figure 4) ──┐
           bit 5 = 0: ring memory (figure 9)    ─┴─► UP, DOWN ─► counters ─► gates ─► pulses ─┬─► motors
                                                                                         └──► monitor

Where the orders are the counts themselves (claim 8), each row sets the counters; a tape whose counts differ
by more than one is refused before anything moves.

The counters go up or down by one, and never above 15 or below 1: no tape of any content can ask a motor for a
change of more than one rate in an interval. The ring memory has nine inputs, both counts and the direction,
and gives nothing where the counts are no vector of a ring. The control never learns what the motors did; the
monitor counts their steps beside the pulses, and stops the machine at the first that is lost.

Source: patent ES 443122, figures 1, 2, 4 and 9, claims 1 to 39. Questions: the AND gate on bits 1 and 2
cannot tell 01 from 10; the direction is bit 2 here. Printed are the ticks 32; 16, 48; and 10, 31, 52; the
others are those nearest below (2j + 1) · 64/2n. A program that ends at speed is refused, as standing still at
once would be a change of more than one.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import ROUNDED, Array
from morfax.motion.axis import TRAVEL_MM
from morfax.motion.compiled import njit
from morfax.motion.faults import ProgramFault
from morfax.motion.motion import AXES, Motion
from morfax.player.monitor.following_limit import FollowingLimit
from morfax.player.monitor.monitor import Supervised
from morfax.player.steps.motor import SOUND, Motor, Motors
from morfax.player.steps.ring_memory import ring_memory
from morfax.recorder.steps.file import (
    HIGHEST,
    LOWEST,
    STANDSTILL,
    TICKS,
    StepFormat,
    StepProgram,
    read_program,
)
from morfax.recorder.textfile import note_of_no_sum

SAMPLES_PER_INTERVAL = 8  # of the motion: 1280 Hz at the usual oscillator
_BLOCK_INTERVALS = 4096  # of the program in memory at a time
_PRINTED_TICKS = {1: (32,), 2: (16, 48), 3: (10, 31, 52)}

Counts = NDArray[np.int8]


def pulse_ticks(pulses: int) -> tuple[int, ...]:
    """The oscillator ticks of an interval at which this many pulses come."""
    if not 0 <= pulses <= TICKS:
        raise ValueError(
            f"{pulses} pulses do not fit in an interval; it has room for 0 to {TICKS}"
        )
    spread = tuple((2 * j + 1) * TICKS // (2 * pulses) for j in range(pulses))
    return _PRINTED_TICKS.get(pulses, spread)


def decode(program: StepProgram) -> tuple[Counts, NDArray[np.int64]]:
    """Counts (k, 3) of all intervals, and the row of each."""
    counts = np.empty((2 * len(program.rows), 3), np.int8)
    source = np.empty(len(counts), np.int64)
    z_channels = program.format.channels > 5
    k = _decode(program.rows, program.format.vectors, z_channels, ring_memory(), counts, source)
    return counts[:k], source[:k]


def pulses_of(counts: Counts, rates: tuple[int, ...]) -> NDArray[np.int64]:
    """Pulses of each interval by the counts: positive above 8, negative below."""
    by_count = np.array([*(-n for n in reversed(rates)), 0, *rates], np.int64)
    return by_count[counts.astype(np.int64) - LOWEST]


def play_steps(
    file: str | os.PathLike[str], *, motor: Motor | None = None, travel_mm: float = TRAVEL_MM
) -> StepPlayback:
    """Put a step program in the machine; raises ProgramFault and FileFault before anything moves."""
    return StepPlayback(read_program(file), motor or Motor(), travel_mm, str(file))


@dataclass(frozen=True, slots=True)
class ToolChange:
    """A change of bit 8: when, and whether the tool is in the work from then on."""

    time_s: float
    down: bool


class StepPlayback(Supervised):
    """A step program in the machine: iterate for the machine's motion, as often as wanted.

    Known beforehand: `format`, `counts`, `pulses`, `duration_s`, `start_mm`. Figures of the last time
    through, one per axis: `following_error_mm` (steps lost), `end_mm`, `end_error_mm` against the end that
    the program states. `conditions`: what is wrong with the motors.
    """

    def __init__(self, program: StepProgram, motor: Motor, travel_mm: float, name: str) -> None:
        self.format, self._motor, self._program, self._name = (
            program.format,
            motor,
            program,
            name,
        )
        self.notes = () if program.summed else (note_of_no_sum(name),)
        _check_motor(name, program.format, motor)
        self.counts, self._rows = decode(program)
        self._check_counts()
        self.pulses = pulses_of(self.counts, program.format.rates)
        self.start_mm: Array = np.array(program.format.start_mm)
        self.end_mm: Array = self.start_mm.copy()
        self.end_error_mm: Array | None = None
        self.conditions = [SOUND] * len(AXES)
        self.limit = FollowingLimit.table(
            [(0.0, 0.0)], self.format.step_mm / 2, settle_s=self.format.interval_s
        )
        self._check(travel_mm)
        self.supervise(AXES, SAMPLES_PER_INTERVAL * self.format.rate_hz)

    @property
    def duration_s(self) -> float:
        """Running time of the program, s."""
        return len(self.counts) * self.format.interval_s

    @property
    def tool_changes(self) -> list[ToolChange]:
        """The changes of the tool's hole, from the first interval on."""
        down = (self._program.rows[self._rows] & self.format.tool_bit) != 0
        at = np.flatnonzero(np.diff(down, prepend=False)).tolist()
        return [ToolChange(k * self.format.interval_s, bool(down[k])) for k in at]

    def __iter__(self) -> Iterator[Motion]:
        """Play: the motion in blocks; raises FollowingFault after the last sample before a lost step."""
        fmt = self.format
        rate_hz = SAMPLES_PER_INTERVAL * fmt.rate_hz
        motors = Motors(len(AXES), fmt.interval_s, self._motor)
        motors.conditions = self.conditions
        monitor = self.supervise(AXES, rate_hz)
        self.end_error_mm = None
        yield Motion(self.start_mm[None], rate_hz, 0.0)
        for first in range(0, len(self.pulses), _BLOCK_INTERVALS):
            told, made = motors.run(
                self.pulses[first : first + _BLOCK_INTERVALS],
                tick_table(),
                SAMPLES_PER_INTERVAL,
            )
            places_mm = self.start_mm + made * fmt.step_mm
            monitor.rows_seen = first * SAMPLES_PER_INTERVAL + 1
            told_mm = self.start_mm + told * fmt.step_mm
            begin_s = (first + 1 / SAMPLES_PER_INTERVAL) * fmt.interval_s
            yield from self.followed(told_mm, places_mm, places_mm, begin_s)
        self.end_error_mm = self.end_mm - np.array(fmt.end_mm)

    def _check_counts(self) -> None:
        """Raise ProgramFault for a count that is none, or is further than one from the count before."""
        counts = self.counts.astype(np.int64)
        change = np.abs(np.diff(counts, axis=0, prepend=STANDSTILL))
        bad = np.flatnonzero(((counts < LOWEST) + (change > 1)).any(axis=1))
        if len(bad):
            line = self._line(int(bad[0]))
            raise ProgramFault(
                f"{self._name}{_place(line)}: counts {counts[bad[0]].tolist()}; they must be {LOWEST} to "
                f"{HIGHEST}, one more or less than before at most: copy it again or record it again",
                line=line,
            )

    def _check(self, travel_mm: float) -> None:
        """Raise ProgramFault for a program that leaves the travel, ends at speed, or misses its end."""
        fmt, places = self.format, np.cumsum(self.pulses, axis=0)
        places_mm = self.start_mm + places * fmt.step_mm
        out = np.flatnonzero((np.abs(places_mm) > travel_mm).any(axis=1))
        if len(out):
            axis = int(np.argmax(np.abs(places_mm[out[0]])))
            line = self._line(int(out[0]))
            raise ProgramFault(
                f"{self._name}{_place(line)}: {AXES[axis].upper()} goes to "
                f"{places_mm[out[0], axis]:.2f} mm; the machine "
                f"has ±{travel_mm:g} mm: move its start, or record it smaller",
                line=line,
            )
        if len(self.counts) and (self.counts[-1] != STANDSTILL).any():
            raise ProgramFault(
                f"{self._name} ends at speed, counts {self.counts[-1].tolist()}; it must end at standstill, "
                f"{[STANDSTILL] * 3}; copy it again or record it again"
            )
        end_mm = places_mm[-1] if len(places_mm) else self.start_mm
        axis = int(np.argmax(np.abs(end_mm - fmt.end_mm)))
        if abs(end_mm[axis] - fmt.end_mm[axis]) > fmt.step_mm / 2:
            raise ProgramFault(
                f"{self._name}: its rows lead to {AXES[axis].upper()} {end_mm[axis]:.3f} mm, but it states "
                f"{fmt.end_mm[axis]:.3f} mm; holes are wrong or missing: copy it again or record it again"
            )

    def _line(self, interval: int) -> int | None:
        """The line of an interval in the file, if there is one."""
        return (
            int(self._program.lines[self._rows[interval]]) if len(self._program.lines) else None
        )


def tick_table() -> NDArray[np.int64]:
    """Pulses that have come by each tick: [pulses of the interval, ticks since its start]."""
    table = np.zeros((TICKS + 1, TICKS + 1), np.int64)
    for pulses in range(1, TICKS + 1):
        for tick in pulse_ticks(pulses):
            table[pulses, tick + (pulses == TICKS) :] += 1
    return table


def _check_motor(name: str, fmt: StepFormat, motor: Motor) -> None:
    """Raise ProgramFault for an oscillator or rates beyond the motor."""
    asked = fmt.acceleration_steps_s2
    if asked > motor.acceleration_steps_s2 * (1 + ROUNDED):
        raise ProgramFault(
            f"{name}: its oscillator of {fmt.oscillator_hz:g} Hz and rates of {fmt.rates} ask for "
            f"changes of {asked:g} "
            f"steps/s²; the motor gives {motor.acceleration_steps_s2:g}: record it with a slower oscillator"
        )


def _place(line: int | None) -> str:
    """The line for a message."""
    return "" if line is None else f", line {line}"


@njit(cache=True)
def _counted(count, up, down):  # type: ignore[no-untyped-def]
    """A counter after UP or DOWN; NAND gate 39 bars it above 15, OR gate 44 below 1."""
    if up and not down and count < HIGHEST:
        return count + 1
    if down and not up and count > LOWEST:
        return count - 1
    return count


@njit(cache=True)
def _decode(rows, vectors, has_z, memory, counts, source):  # type: ignore[no-untyped-def]
    """Run all rows through the decoders; the number of intervals."""
    x = y = z = 8
    k = 0
    for row in range(len(rows)):
        code = rows[row]
        if vectors == 0:  # the order is the count itself: the counters are set
            for axis in range(3):
                counts[k, axis] = code >> 4 * axis & 15
            source[k] = row
            k += 1
            continue
        if has_z:
            z = _counted(z, code >> 5 & 1, code >> 6 & 1)
        if code >> 4 & 1:  # axis extension: figure 4, once for each axis
            x = _counted(x, code & 1, code >> 1 & 1)
            y = _counted(y, code >> 2 & 1, code >> 3 & 1)
            counts[k, 0], counts[k, 1], counts[k, 2] = x, y, z
            source[k] = row
            k += 1
            continue
        for second in range(vectors):  # figure 11: bits 4 and 3 are the second vector's
            one, two = code >> 2 * second & 1, code >> 2 * second + 1 & 1
            if one ^ two:  # exclusive OR 65 lets the memory speak
                out = memory[x << 5 | y << 1 | two]
                x = _counted(x, out & 1, out >> 1 & 1)
                y = _counted(y, out >> 2 & 1, out >> 3 & 1)
            counts[k, 0], counts[k, 1], counts[k, 2] = x, y, z
            source[k] = row
            k += 1
    return k
