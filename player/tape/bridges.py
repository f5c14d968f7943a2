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
is tried again with two thirds of its rows.

Else the way is laid as the cubic that joins both sides: of all motions the one with the least acceleration,
root mean square. Any other motion between them that keeps to A, and to the largest speed V, lies between an
upper and a lower edge (motion_edges.py); `freedom` is the furthest that an edge lies off what is laid, from
the ends of the parabolas; `furthest` the same from ends that need no parabola.

Source: patent ES 361967, figure 5 (fault circuit 162) asks for it; the bounds: docs/background/player.md.
Questions: a motion that changes its acceleration several times within the 6 ms of a side is no parabola; so
what both sides do not agree in (`between`) is added to the freedom before a gap is called known.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.player.tape.motion_edges import upper_edge
from morfax.player.tape.standstill import ALLOWED_CYCLES

COUNT_MARGIN = 0.1  # cycles, for noise
ROUGH_CYCLES = 0.04  # what is left of the parabola; 26 dB of noise leave 0.015
# the same of sides on which a changing acceleration would show: one of 0.5 m/s² that turns over leaves 0.008
SMOOTH_CYCLES = 0.003
SIDE_ROWS = 36  # of sound tape on each side, 6 ms at 6 kHz
SHORT_ROWS = 24  # the same where the acceleration changes further off: 4 ms at 6 kHz
# what may be left of the travel, halved, and of the way between: half of what is allowed, for the drives;
# what sides of 4 ms may be off beside a change of acceleration (0.013 in 12 ms at 0.5 m/s²) is well within
AGREED_CYCLES = ALLOWED_CYCLES / 2
# by how much the speeds of both sides may differ beyond what the program's acceleration explains: of a row's
# noise, sqrt(2) * 13.9 / 36^1.5 (the end of a parabola) * sqrt(8) (rows that are noisy together) ...
SPEED_NOISE = 0.26
# ... and of a misfit, which bends the end of a side's parabola; estimated. A tenth for what is told late
SPEED_MISFIT, SHARPER = 12 / SIDE_ROWS, 1.1
# three samples of 48 kHz that are lost on all tracks, or there twice, move the time by 0.375 row, and no path
SLIPPED_ROWS = 0.4
# of the level, from one side to the other: one that wavers by 1 dB at 5 Hz changes by so much in 20 ms
LEVEL_STEP = 0.08
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
    travel = rows * before.speed + first * turn * (rows - turn / 2) + last * left**2 / 2
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
    return np.asarray(
        before.place + v0 * u + (3 * way - 2 * v0 - v1) * u**2 + (v0 + v1 - 2 * way) * u**3
    )


@dataclass(frozen=True, slots=True)
class Gap:
    """A gap of an axis from row `first` to before `last` of the tape, as it was bridged.

    `after.place` is where the axis is behind it as it was counted. `bound` is what the program asks for there
    at most, as far as the tape tells it. `short`: the count is certain even if the program asks for all that
    the motors can do, as on a bare tape. `steady`: it began with a surprise, while the level was right.
    `noise`: six standard deviations of a row, cycles. `furthest`: of any motion within the bound off what is
    laid, whatever the shape of its sides (motion_edges.py), if that was asked for. `level_step`: how far the
    levels of its sides lie apart, as a share.
    """

    axis: int
    first: int
    last: int
    before: GapEdge
    after: GapEdge
    bridge: Bridge
    bound: Bound
    short: bool = False
    steady: bool = False
    noise: float = 0.0
    furthest: float = math.inf
    level_step: float = 0.0

    @property
    def rows(self) -> int:
        """Rows from the one before the gap to the first behind it."""
        return self.last - self.first + 1

    @property
    def freedom(self) -> float:
        """The furthest that the motion may lie off what was laid, if the count is right, cycles."""
        return freedom(self.before, self.after, self.laid(), self.bound)

    @property
    def known(self) -> bool:
        """Whether the way between is known, if the count behind it is vouched for."""
        found = self.bridge
        if self.furthest < ALLOWED_CYCLES and found.misfit < self.noise:
            return True
        known = self.freedom + found.between < ALLOWED_CYCLES
        return known and found.misfit < ROUGH_CYCLES

    @property
    def certain(self) -> bool:
        """Whether it may be ridden over, if the count behind it is vouched for.

        Either no motion within the bound lies further off; or both sides agree and are smooth, so that a
        motion which turns its acceleration over there and back within the gap alone is left out. Neither
        counts where a side is foreign.
        """
        agreed = self.bridge.certain and (self.short or self.bridge.misfit < SMOOTH_CYCLES)
        return (self.known or agreed) and not (self.is_foreign or (self.steady and self.astray))

    @property
    def is_foreign(self) -> bool:
        """Whether a side is not the program's own: of another level, of a speed not gained here, or at a
        place not reached from the other.
        """
        before, after, rows = self.before, self.after, self.rows
        hardest = SHARPER * self.bound.acceleration
        doubt = SPEED_NOISE * self.noise + SPEED_MISFIT * self.bridge.misfit
        gained = abs(after.speed - before.speed)
        swerve = abs(after.place - before.place - rows * (before.speed + after.speed) / 2)
        slip = SLIPPED_ROWS * max(abs(before.speed), abs(after.speed))
        far = swerve > hardest * rows**2 / 4 + doubt * rows / 2 + self.noise + slip
        return far or gained > hardest * rows + doubt or self.level_step > LEVEL_STEP

    @property
    def astray(self) -> bool:
        """Whether a side looks as if what surprised reached further than the gap.

        The level did not show where it began and ended. A side is rougher than noise, or the places of both
        are further apart than one change of speed within the gap explains, by half of what is allowed.
        """
        before, after, found = self.before, self.after, self.bridge
        jolt = abs(after.speed - before.speed - self.rows * (before.bend + after.bend))
        unexplained = abs(found.off) - jolt * self.rows / 2
        return found.misfit > self.noise or unexplained > ALLOWED_CYCLES / 2

    @property
    def sound_until(self) -> float:
        """The row until which the way before it is sound: its side is not, where that is rough.

        What surprises has led the axis astray for some rows, within what the program may ask for.
        """
        rough = self.steady or self.bridge.misfit >= ROUGH_CYCLES
        return float(self.first - SIDE_ROWS if rough else self.first)

    def moved(self, cycles: float) -> Gap:
        """The same gap of an axis that stands some cycles further on."""
        before = replace(self.before, place=self.before.place + cycles)
        return replace(self.ending(cycles), before=before, furthest=self.furthest)

    def ending(self, cycles: float) -> Gap:
        """The same gap with some cycles more behind it."""
        after = replace(self.after, place=self.after.place + cycles)
        return replace(self, after=after, furthest=math.inf if cycles else self.furthest)

    def upto(self, later: Gap) -> Gap:
        """One gap from the start of this to the end of a later one."""
        acceleration = max(self.bound.acceleration, later.bound.acceleration)
        speed = max(self.bound.speed, later.bound.speed)
        return replace(
            self,
            last=later.last,
            after=later.after,
            bridge=replace(self.bridge, turn=None),
            bound=Bound(acceleration, speed),
            furthest=math.inf,
        )

    def laid(self) -> Array:
        """The rows within."""
        before, after, turn = self.before, self.after, self.bridge.turn
        travel = after.place - before.place
        if turn is None or round(travel - self.bridge.travel):
            return filled(before, after, travel, self.rows)
        t = np.arange(1, self.rows)
        until = np.minimum(
            t, turn
        )  # a turn just before the gap counts from there, as in its travel
        way = before.speed * t + 2 * before.bend * until * (t - until / 2)
        way += after.bend * (t - until) ** 2
        u = t / self.rows
        return np.asarray(before.place + way + self.bridge.off * u**2 * (3 - 2 * u))


def freedom(before: GapEdge, after: GapEdge, laid: Array, bound: Bound) -> float:
    """The furthest that a motion within a bound may lie off what is laid between two sides, cycles."""
    ends, rows = np.array([before.place, before.speed, after.place, after.speed]), len(laid) + 1
    above = upper_edge(ends, rows, bound.acceleration, bound.speed) - laid
    below = upper_edge(-ends, rows, bound.acceleration, bound.speed) + laid
    return float(max(np.abs(above).max(initial=0.0), np.abs(below).max(initial=0.0)))
