"""Bridges: what the sound tape on both sides of a gap says of the motion within it, and how far off it may
be.

Signals in: rows of phases beside a gap, cycles, and the bound of the program there (cycles/row², cycles/row).
Signals out: the travel over the gap, the rows within it, and what is not known of them, cycles.

A parabola through the 6 ms before the gap (p0, v0, a0: held, as rewound past the filter) and one through the
6 ms after it (p1, v1, a1) give

    d      = T (v0 + v1) / 2 + T² (a0 - a1) / 12      travel over the gap of a motion of even jerk
    r      = (p1 - p0) - d,  less the nearest whole   what was measured against what was held
    dv     = (v1 - v0) - T (a0 + a1) / 2              change of speed that the accelerations do not explain
    H      = A T² / 4 + |dv| T / 2                    furthest that a motion of acceleration A may lie off d

The count is certain where no other whole number is possible:      H < 1 - |r| - 0.1     (cycles)
and the way between where it lies within a fortieth of a cycle:    |r| / 2 + |dv| T / 8 < 0.025

A fortieth, since a drive at the limit of its acceleration makes twice as much of it: where a speed jumps by
8 mm/s within a gap of 2 ms, 0.047 cycle on the tape become 0.105 at the machine.

A program that starts, stops or goes round a corner within the gap changes its acceleration there once, from
a0 to a1. The change of speed tells when (s rows from p0), and then the travel is another:

    s = (dv' - a1 T) / (a0 - a1),    d = T v0 + a0 s (T - s / 2) + a1 (T - s)² / 2,    dv' = v1 - v0

If what was measured agrees with that, the way is laid so (`turned`). A side on which the acceleration changed
is tried again with two thirds of its rows. Else the way is laid as the cubic that joins both sides: of all
motions the one with the least acceleration, root mean square.

Source: patent ES 361967, figure 5 (fault circuit 162) asks for it; the bounds: docs/background/player.md.
Questions: a motion that changes its acceleration several times within the 6 ms of a side is no parabola; so
what both sides do not agree in (`between`) is added to the freedom before a gap is called known (gap.py).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.player.tape.standstill import ALLOWED_CYCLES

COUNT_MARGIN = 0.1  # cycles, for noise
ROUGH_CYCLES = 0.04  # what is left of the parabola; 26 dB of noise leave 0.015
SIDE_ROWS = 36  # of sound tape on each side, 6 ms at 6 kHz
SHORT_ROWS = 24  # the same where the acceleration changes further off: 4 ms at 6 kHz
# what may be left of the travel, halved, and of the way between: half of what is allowed, for the drives;
# what sides of 4 ms may be off beside a change of acceleration (0.013 in 12 ms at 0.5 m/s²) is well within
AGREED_CYCLES = ALLOWED_CYCLES / 2
TURNED_ROWS = 3.0  # beside the gap: half of what the band filter blurs


@dataclass(frozen=True, slots=True)
class Bound:
    """The most that a program asks of an axis: cycles/row² and cycles/row."""

    acceleration: float
    speed: float


@dataclass(frozen=True, slots=True)
class GapEdge:
    """Motion at the edge of a gap, in cycles and rows: place, speed, half the acceleration, worst misfit."""

    place: float
    speed: float
    bend: float
    misfit: float

    @property
    def row_before(self) -> Array:
        """Place, speed and bend a row earlier."""
        place = self.place - self.speed + self.bend
        speed = self.speed - 2 * self.bend
        return np.array([place, speed, self.bend])


@dataclass(frozen=True, slots=True)
class Bridge:
    """A gap and what its sides say, in cycles: `reach` is H, `off` is r, `between` the error in the gap.

    `turn`: the row, from the one before the gap, at which the acceleration changes, if it changes once.
    """

    travel: float
    off: float
    reach: float
    between: float
    misfit: float
    turn: float | None = None

    @property
    def counted(self) -> bool:
        """Whether only one number of whole cycles is possible."""
        return self.reach < 1 - abs(self.off) - COUNT_MARGIN

    @property
    def certain(self) -> bool:
        """Whether only one number of whole cycles is possible, and the way between is known."""
        return self.counted and self.between < AGREED_CYCLES and self.misfit < ROUGH_CYCLES


def side(cycles: Array, at: int) -> GapEdge:
    """Parabola through the rows beside a gap, taken at row `at` (the nearest to the gap)."""
    steps = np.arange(len(cycles)) - at
    bend, speed, place = np.polyfit(steps, cycles - cycles[at], 2)
    misfit = np.abs(cycles - cycles[at] - np.polyval([bend, speed, place], steps)).max()
    return GapEdge(float(place + cycles[at]), float(speed), float(bend), float(misfit))


def bridge(before: GapEdge, after: GapEdge, rows: int, acceleration: float) -> Bridge:
    """A gap of this many rows between two sides; the acceleration in cycles per row²."""
    travel = rows * (before.speed + after.speed) / 2 + rows**2 * (before.bend - after.bend) / 6
    off = after.place - before.place - travel
    off -= round(off)
    jolt = abs(after.speed - before.speed - rows * (before.bend + after.bend))
    reach = acceleration * rows**2 / 4 + jolt * rows / 2
    return Bridge(
        travel + off,
        off,
        reach,
        abs(off) / 2 + jolt * rows / 8,
        max(before.misfit, after.misfit),
    )


def turned(before: GapEdge, after: GapEdge, rows: int, acceleration: float) -> Bridge | None:
    """The same gap, if the acceleration changes once within it; None where the sides do not say so."""
    first, last, gained = 2 * before.bend, 2 * after.bend, after.speed - before.speed
    if abs(first - last) < NOT_ZERO:
        return None
    turn = (gained - last * rows) / (first - last)
    if not -TURNED_ROWS <= turn <= rows + TURNED_ROWS:
        return None
    left = rows - turn
    gained_by_first = first * turn * (rows - turn / 2)
    gained_by_last = last * left**2 / 2
    travel = rows * before.speed + gained_by_first + gained_by_last
    off = after.place - before.place - travel
    off -= round(off)
    if abs(off) / 2 > AGREED_CYCLES:
        return None
    reach = acceleration * rows**2 / 4
    misfit = max(before.misfit, after.misfit)
    return Bridge(travel + off, off, reach, abs(off) / 2, misfit, turn)


def filled(before: GapEdge, after: GapEdge, travel: float, rows: int) -> Array:
    """The rows within a gap: a cubic with the place and speed of both sides."""
    u = np.arange(1, rows) / rows
    v0, v1, way = before.speed * rows, after.speed * rows, travel
    bend = 3 * way - 2 * v0 - v1
    twist = v0 + v1 - 2 * way
    return np.asarray(before.place + v0 * u + bend * u**2 + twist * u**3)
