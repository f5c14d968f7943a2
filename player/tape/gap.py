"""The gap: how far what was laid over it may lie off, and whether it may be ridden over.

Signals in: both sides of a gap and its bridge (bridges.py), cycles, and the bound of the program there
(cycles/row², cycles/row). Signals out: the rows within it, and what is not known of them, cycles.

Any motion between both sides that keeps to the acceleration A and the largest speed V of the bound lies
between an upper and a lower edge (motion_edges.py). `freedom` is the furthest that an edge lies off what is
laid, from the ends of the parabolas; `furthest` the same from ends that need no parabola.

Source: patent ES 361967, figure 5 (fault circuit 162) asks for it; the bounds: docs/background/player.md.
Questions: none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.player.tape.bridges import ROUGH_CYCLES, SIDE_ROWS, Bound, Bridge, GapEdge, filled
from morfax.player.tape.motion_edges import upper_edge
from morfax.player.tape.standstill import ALLOWED_CYCLES

# what is left of a side's parabola where a changing acceleration would show: one of 0.5 m/s² that turns over
# leaves 0.008
SMOOTH_CYCLES = 0.003
# by how much the speeds of both sides may differ beyond what the program's acceleration explains: of a row's
# noise, sqrt(2) * 13.9 / 36^1.5 (the end of a parabola) * sqrt(8) (rows that are noisy together) ...
SPEED_NOISE = 0.26
# ... and of a misfit, which bends the end of a side's parabola; estimated. A tenth for what is told late
SPEED_MISFIT, SHARPER = 12 / SIDE_ROWS, 1.1
# three samples of 48 kHz that are lost on all tracks, or there twice, move the time by 0.375 row, and no path
SLIPPED_ROWS = 0.4
# of the level, from one side to the other: one that wavers by 1 dB at 5 Hz changes by so much in 20 ms
LEVEL_STEP = 0.08


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
