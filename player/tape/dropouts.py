"""Dropouts: where a track fails for a moment, what its motion was is told from both sides, or the machine
stops.

Signals: rows of the discriminator in (cycles, surprise, levels), at the motion rate; the same rows out, a few
ms later, with the gaps filled and the cycles beyond them counted on; or the row from which nothing is
certain, with its fault.

A row is lost while the level of its track (or of the reference) is a fifth off what it was 20 ms ago, or
below a fifth of its level at standstill, and as long as the discriminator's filter reaches into such rows. A
parabola through the 6 ms before the gap (p0, v0, a0: held, as rewound past the filter) and one through the 6
ms after it (p1, v1, a1) then give

    d      = T (v0 + v1) / 2 + T² (a0 - a1) / 12      travel over the gap of a motion of even jerk
    r      = (p1 - p0) - d,  less the nearest whole   what was measured against what was held
    dv     = (v1 - v0) - T (a0 + a1) / 2              change of speed that the accelerations do not explain
    H      = A T² / 4 + |dv| T / 2                    furthest that a motion of acceleration A may lie off d

The count is certain where no other whole number is possible:      H < 1 - |r| - 0.1     (cycles)
and the way between where it lies within a twentieth of a cycle:   |r| / 2 + |dv| T / 8 < 0.05

    ________  p0                                       v0  _/\\_  longest way there and back that begins and
            \\ ................ /  what may have been       \\/   ends with the same speed: A T² / 4 of travel
                gap, T          p1 _______

Source: patent ES 361967, figure 5 (fault circuit 162) asks for it; the bounds: docs/background/player.md.
Questions: A is not on the tape: it is taken as what the machine's own motors can do, 5 m/s², and may be given
where the program is known to be smoother.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import Fault, LockFault, TapeFault
from morfax.player.tape.discriminator import Discriminator, Phases
from morfax.player.tape.predictor import recount
from morfax.player.tape.standstill import ALLOWED_CYCLES, LEVEL_STEADY

LEVEL_KEPT = 0.2  # of the level at standstill
STEADY_S = 0.02  # ago: the level that a row is compared with
SIDE_S = 0.006  # of sound tape on each side
SIDE_ROWS = 36  # the same at 6 kHz
LONGEST_S = 0.1  # a track that is away longer has ended
COUNT_MARGIN = 0.1  # cycles, for noise
ROUGH_CYCLES = 0.04  # what is left of the parabola; 26 dB of noise leave 0.015


@dataclass(frozen=True, slots=True)
class Side:
    """Motion at the edge of a gap, in cycles and rows: place, speed, half the acceleration, worst misfit."""

    place: float
    speed: float
    bend: float
    misfit: float


@dataclass(frozen=True, slots=True)
class Bridge:
    """A gap and what its sides say, in cycles: `reach` is H, `off` is r, `between` the error in the gap."""

    travel: float
    off: float
    reach: float
    between: float
    misfit: float

    @property
    def certain(self) -> bool:
        """Whether only one number of whole cycles is possible, and the way between is known."""
        sure = self.reach < 1 - abs(self.off) - COUNT_MARGIN
        return sure and self.between < ALLOWED_CYCLES and self.misfit < ROUGH_CYCLES


def side(cycles: Array, at: int) -> Side:
    """Parabola through the rows beside a gap, taken at row `at` (the nearest to the gap)."""
    steps = np.arange(len(cycles)) - at
    bend, speed, place = np.polyfit(steps, cycles - cycles[at], 2)
    misfit = np.abs(cycles - cycles[at] - np.polyval([bend, speed, place], steps)).max()
    return Side(float(place + cycles[at]), float(speed), float(bend), float(misfit))


def bridge(before: Side, after: Side, rows: int, acceleration: float) -> Bridge:
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


def longest_s(acceleration_mm_s2: float, cycles_per_mm: float) -> float:
    """The longest gap with a certain count if both sides agree, with filter, s: A T² / 4 = 0.9 cycle."""
    return float(np.sqrt(4 * (1 - COUNT_MARGIN) / (acceleration_mm_s2 * cycles_per_mm)))


def filled(before: Side, after: Side, travel: float, rows: int) -> Array:
    """The rows within a gap: a cubic with the place and speed of both sides."""
    u = np.arange(1, rows) / rows
    v0, v1, way = before.speed * rows, after.speed * rows, travel
    return np.asarray(
        before.place + v0 * u + (3 * way - 2 * v0 - v1) * u**2 + (v0 + v1 - 2 * way) * u**3
    )


def under_way(rows: Phases, discriminator: Discriminator) -> Array:
    """Count the first rows of a tape that begins in the middle of a motion; the start places, cycles."""
    places = np.zeros(rows.cycles.shape[1])
    for axis in range(rows.cycles.shape[1]):
        first = side(np.unwrap(rows.cycles[:SIDE_ROWS, axis], period=1.0), 0)
        _count_on(discriminator, axis, first, rows.cycles[:, axis], rows.surprise[:, axis])
        places[axis] = first.place
    return places


def _count_on(
    discriminator: Discriminator,
    axis: int,
    at: Side,
    cycles: Array,
    surprise: NDArray[np.float32],
) -> None:
    """Count an axis anew from a place on to the discriminator's last row."""
    state = np.array([at.place - at.speed + at.bend, at.speed - 2 * at.bend, at.bend])
    discriminator.state[axis] = recount(cycles, discriminator.gains, state, surprise)


class Gaps:
    """Bridges the gaps of one tape; holds rows back that the next rows may show to be lost."""

    def __init__(
        self,
        discriminator: Discriminator,
        levels: Array,
        rate_hz: float,
        acceleration: float,
        place_mm: Callable[[int, float], float],
        names: Sequence[str],
        told: dict[tuple[int, int], int] | None = None,
    ) -> None:
        self._told = told  # whole cycles to add at a gap (row, axis); None: what is not certain is a fault
        self.doubtful: dict[tuple[int, int], Bridge] = {}
        self._discriminator, self._rate_hz = discriminator, rate_hz
        self._place_mm, self._names = place_mm, names
        self._levels, self._tracked = levels, levels.copy()
        self._acceleration = acceleration  # cycles/row²
        self._side = max(round(SIDE_S * rate_hz), 6)
        self._spread = -(-discriminator.filter_frames // (2 * discriminator.decimation))
        # from `side` rows before the first that is not yet given out
        self._rows: Phases | None = None
        self._lost = np.zeros((0, len(levels)), bool)
        self._given: int | None = None  # the row up to which rows were given out
        # tape time in s and axis: length in s
        self.bridged: dict[tuple[float, str], float] = {}

    def feed(
        self, phases: Phases, *, last: bool = False
    ) -> tuple[Phases, tuple[int, Fault] | None]:
        """Take the next rows; the rows that are certain now, and the first that is not, with its fault."""
        lost = np.zeros((len(phases), len(self._levels)), bool)
        share = 1 - np.exp(-1 / (STEADY_S * self._rate_hz))
        _mark(
            phases.levels, self._levels * LEVEL_KEPT, LEVEL_STEADY, share, self._tracked, lost
        )
        self._lost = np.vstack([self._lost, lost])
        self._given = phases.first_row if self._given is None else self._given
        rows = phases if self._rows is None else self._rows.joined(phases)
        self._rows = rows
        ready = len(rows) - (0 if last else self._spread)
        fault: tuple[int, Fault] | None = None
        if self._lost.any():
            ready, fault = self._bridge_all(rows, ready, last)
        out = rows.cut(self._given - rows.first_row, ready)
        self._given = max(self._given, rows.first_row + ready)
        fault = fault and (len(out), fault[1])
        keep = max(ready - self._side - self._spread, 0)
        self._rows, self._lost = rows.cut(keep, len(rows)), self._lost[keep:]
        return out, fault

    def _bridge_all(
        self, rows: Phases, ready: int, last: bool
    ) -> tuple[int, tuple[int, Fault] | None]:
        """Bridge the gaps of all axes; the number of certain rows, and the fault that ends the tape there."""
        first: tuple[int, Fault] | None = None
        for axis in range(len(self._names)):
            for a, b in self._gaps_of(axis):
                if rows.first_row + b <= (self._given or 0):
                    continue
                if (
                    b + self._side + self._spread > len(rows)
                    and not last
                    and b - a <= LONGEST_S * self._rate_hz
                ):
                    ready = min(ready, a)  # what comes after it is not yet there
                    break
                fault = self._bridge(rows, axis, a, b)
                if fault is not None:
                    ready = min(ready, a)
                    if first is None or a < first[0]:
                        first = a, fault
                    break
        if first is not None and first[0] > ready:
            first = None  # an earlier gap is still open
        return ready, first

    def _gaps_of(self, axis: int) -> list[tuple[int, int]]:
        """First and last row (past it) of each gap of an axis; gaps close to each other are one."""
        lost = np.flatnonzero(self._lost[:, 0] | self._lost[:, axis + 1])
        if not len(lost):
            return []
        apart = self._side + 2 * self._spread
        cuts = np.flatnonzero(np.diff(lost) > apart)
        firsts, lasts = lost[np.r_[0, cuts + 1]], lost[np.r_[cuts, len(lost) - 1]]
        return [
            (max(int(a) - self._spread, 0), int(b) + 1 + self._spread)
            for a, b in zip(firsts, lasts, strict=True)
        ]

    def _bridge(self, rows: Phases, axis: int, a: int, b: int) -> Fault | None:
        """Fill a gap and count on behind it; the fault if it is too long to be certain."""
        cycles, time_s = rows.cycles[:, axis], (rows.first_row + a) / self._rate_hz
        if b + self._side > len(rows) or b - a > LONGEST_S * self._rate_hz:
            return self._ended(rows, axis, a, time_s)
        if a < self._side:
            return self._uncertain(axis, cycles[max(a - 1, 0)], time_s, (b - a) / self._rate_hz)
        before = side(cycles[a - self._side : a], self._side - 1)
        after = side(np.unwrap(cycles[b : b + self._side], period=1.0), 0)
        found = bridge(before, after, b - a + 1, self._acceleration)
        if not found.certain:
            if self._told is None:
                return self._uncertain(axis, before.place, time_s, (b - a) / self._rate_hz)
            gap = rows.first_row + a, axis
            self.doubtful[gap] = found
            found = replace(found, travel=found.travel + self._told.get(gap, 0))
        cycles[a:b] = filled(before, after, found.travel, b - a + 1)
        after = replace(after, place=before.place + found.travel)
        rows.surprise[a:b, axis] = 0
        _count_on(self._discriminator, axis, after, cycles[b:], rows.surprise[b:, axis])
        self.bridged[time_s, self._names[axis]] = (b - a) / self._rate_hz
        return None

    def _ended(self, rows: Phases, axis: int, a: int, time_s: float) -> TapeFault:
        """The fault of a track that does not come back."""
        at = min(a + self._spread, len(rows) - 1)
        track = 0 if self._lost[at, 0] else axis + 1
        name = "reference" if track == 0 else self._names[track - 1].upper()
        return TapeFault(
            f"track {track + 1} ({name}) lost its carrier at {time_s:.3f} s, for more than "
            f"{LONGEST_S * 1e3:g} ms or to "
            f"the tape's end; record or copy the tape again",
            time_s=time_s,
        )

    def _uncertain(self, axis: int, place: float, time_s: float, gap_s: float) -> LockFault:
        """The fault of a gap with an uncertain count; `place` is the last certain one, cycles."""
        name, position_mm = self._names[axis], self._place_mm(axis, place)
        return LockFault(
            f"{name.upper()} was lost for {gap_s * 1e3:.1f} ms at {time_s:.3f} s, last certain position "
            f"{position_mm:.3f} mm: how many cycles passed there is not certain; copy the tape "
            "again, mend it "
            "(morfax mend), or go on behind it from a position given by hand (--resume-at "
            f"{time_s + gap_s + SIDE_S:.2f}s --from ...)",
            axis=name,
            time_s=time_s,
            error_cycles=float("nan"),
            position_mm=position_mm,
        )


@njit(cache=True, nogil=True)
def _mark(levels, least, steady, share, tracked, lost):  # type: ignore[no-untyped-def]
    """Mark the rows whose level is off; `tracked` follows the others."""
    for track in range(levels.shape[1]):
        slow = tracked[track]
        for row in range(len(levels)):
            level = levels[row, track]
            if not (
                level >= least[track] and level >= steady * slow and level * steady <= slow
            ):
                lost[row, track] = True
            else:
                slow += share * (level - slow)
        tracked[track] = slow
