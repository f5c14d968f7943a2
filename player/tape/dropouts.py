"""Dropouts: where a track fails for a moment, what its motion was is told from both sides, or the machine
stops.

Signals: rows of the discriminator in (cycles, surprise, levels), at the motion rate; the same rows out, a few
ms later, with the gaps filled and the cycles beyond them counted on; or the row from which nothing is
certain, with its fault.

A row is lost while the level of its track (or of the reference) is a fifth off what it was 20 ms ago, or
below a fifth of its level at standstill, and as long as the discriminator's filter reaches into such rows.
On a checked tape a row is lost as well where an axis moves as its program never does (surprises.py). What the
rows on both sides say of the gap is in bridges.py.

    bare       a gap that is not certain by its sides is a fault; so is one of more than 0.1 s
    checked    every gap up to 1.1 s is bridged and told of; what vouches for the rows decides; one that
               reaches the tape's end is passed over where the axis tells that it stands still there

Source: patent ES 361967, figure 5 (fault circuit 162) asks for it; the bounds: docs/background/player.md.
Questions: A is not on a bare tape: it is taken as what the machine's own motors can do, 5 m/s², and may be
given where the program is known to be smoother. A check signal tells it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.faults import Fault, LockFault, TapeFault
from morfax.motion.usual import MOTION_RATE_HZ
from morfax.player.tape.bridges import SIDE_ROWS, Bridge, GapEdge, side
from morfax.player.tape.discriminator import Discriminator
from morfax.player.tape.gap import Gap
from morfax.player.tape.motion_edges import END_ROWS, furthest
from morfax.player.tape.phases import Phases, Uncertain
from morfax.player.tape.predictor import recount
from morfax.player.tape.riding import Riding
from morfax.player.tape.standstill import LEVEL_STEADY
from morfax.player.tape.surprises import Surprises
from morfax.recorder.tape.format import TapeFormat

LEVEL_KEPT = 0.2  # of the level at standstill
STEADY_S = 0.02  # ago: the level that a row is compared with
SIDE_S = SIDE_ROWS / MOTION_RATE_HZ  # of sound tape on each side
LONGEST_S = 0.1  # a track that is away longer has ended
# the same with a check signal: 1 s is asked, and the filter reaches 2 ms further; levels need some time
LONGEST_CHECKED_S = 1.1
# a frame of the check signal is read two symbols (10 ms at the lowest reference) behind its end
TOLD_LATE_S = 0.02
TRIES = 3  # of looking for surprises: behind one that was bridged others are less, or elsewhere


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
    at: GapEdge,
    cycles: Array,
    surprise: NDArray[np.float32],
) -> None:
    """Count an axis anew from a place on to the discriminator's last row."""
    discriminator.state[axis] = recount(cycles, discriminator.gains, at.row_before, surprise)


def _furthest(gap: Gap, cycles: Array, within: tuple[int, int]) -> float:
    """The furthest that a motion within the bound may lie off what is laid from row to before row, cycles."""
    a, b = within
    behind = np.unwrap(cycles[b : b + END_ROWS], period=1.0)
    behind += round(gap.after.place - behind[0])
    most = (gap.bound.acceleration, gap.bound.speed)
    return furthest((cycles[a - END_ROWS : a], behind), gap.laid(), most, gap.noise)


def _longer(marks: NDArray[np.bool_], rows: int) -> NDArray[np.bool_]:
    """Marks of rows (n, columns), and so many rows that are not marked."""
    longer = np.zeros((len(marks) + rows, marks.shape[1]), bool)
    longer[: len(marks)] = marks
    return longer


class Gaps:
    """Bridges the gaps of one tape; holds rows back that the next rows may show to be lost."""

    def __init__(
        self,
        discriminator: Discriminator,
        levels: Array,
        fmt: TapeFormat,
        riding: Riding,
        place_mm: Callable[[int, float], float],
    ) -> None:
        self._riding, self._discriminator = riding, discriminator
        self.doubtful: dict[tuple[int, int], Bridge] = {}
        self._new: list[Gap] = []
        self._rate_hz, self._names = fmt.motion_rate_hz, fmt.axes
        self._place_mm = place_mm
        self._least, self._tracked = levels * LEVEL_KEPT, levels.copy()
        self._follow = LEVEL_STEADY, 1 - math.exp(-1 / (STEADY_S * fmt.motion_rate_hz))
        self._side = max(round(SIDE_S * self._rate_hz), 6)
        self._spread = -(-discriminator.filter_frames // (2 * discriminator.decimation))
        self._surprises = Surprises(discriminator.gains, fmt)
        told_late = 0 if riding.bounds is None else math.ceil(TOLD_LATE_S * self._rate_hz)
        self._held = max(self._spread, told_late)
        self._longest_s = LONGEST_S if riding.bounds is None else LONGEST_CHECKED_S
        self._rows: Phases | None = None  # from `side` before the first not yet given out on
        self._lost, self._surprised = (
            np.zeros((0, columns), bool) for columns in (fmt.tracks, len(fmt.axes))
        )
        self._given: int | None = None  # the row up to which rows were given out
        # tape time in s and axis: length in s
        self.bridged: dict[tuple[float, str], float] = {}

    def found(self) -> list[Gap]:
        """The gaps that were bridged since this was asked last."""
        found, self._new = self._new, []
        return found

    def feed(self, phases: Phases, *, last: bool = False) -> tuple[Phases, Uncertain | None]:
        """Take the next rows; the rows that are certain now, and the first that is not, with its fault."""
        held = len(self._lost)
        self._lost = _longer(self._lost, len(phases))
        self._surprised = _longer(self._surprised, len(phases))
        _mark(phases.levels, self._least, self._follow, self._tracked, self._lost[held:])
        self._given = phases.first_row if self._given is None else self._given
        rows = phases if self._rows is None else self._rows.joined(phases)
        self._rows = rows
        ready, fault = self._bridged(rows, last)
        out = rows.cut(self._given - rows.first_row, ready)
        self._given = max(self._given, rows.first_row + ready)
        fault = fault and Uncertain(len(out), fault.fault)
        keep = max(ready - self._side - self._spread, 0)
        self._rows, self._lost = rows.cut(keep, len(rows)), self._lost[keep:]
        self._surprised = self._surprised[keep:]
        return out, fault

    def _bridged(self, rows: Phases, last: bool) -> tuple[int, Uncertain | None]:
        """Bridge what is lost; and, on a checked tape, what surprises in the rows that would be given out."""
        most = len(rows) - (0 if last else self._held)
        ready, fault = self._bridge_all(rows, most, last)
        for _ in range(TRIES if self._riding.bounds is not None else 0):
            if not self._mark_surprises(rows, ready):
                break
            self._new.clear()
            ready, fault = self._bridge_all(rows, most, last)
        return ready, fault

    def _mark_surprises(self, rows: Phases, ready: int) -> bool:
        """Mark the rows at which an axis moves as its program never does; whether any was not lost before."""
        assert self._riding.bounds is not None, (
            "only a checked tape tells what a program asks for"
        )
        found = self._surprises.rows(rows, self._riding.bounds())
        if found is None:
            return False
        # what was given out reached to `spread` rows before those that are looked at
        found[: max((self._given or 0) - rows.first_row + self._spread, 0)] = False
        found[ready + self._spread :] = False
        new = bool((found & ~self._surprised).any())
        self._surprised |= found
        return new

    def _bridge_all(self, rows: Phases, ready: int, last: bool) -> tuple[int, Uncertain | None]:
        """Bridge the gaps of all axes; the number of certain rows, and the fault that ends the tape there."""
        first: Uncertain | None = None
        if not (self._lost.any() or self._surprised.any()):
            return ready, None
        for axis in range(len(self._names)):
            sure, fault = self._bridge_axis(rows, axis, last)
            ready = min(ready, sure)
            if fault is not None and (first is None or sure < first.row):
                first = Uncertain(sure, fault)
        if first is not None and first.row > ready:
            first = None  # an earlier gap is still open
        return ready, first

    def _bridge_axis(self, rows: Phases, axis: int, last: bool) -> tuple[int, Fault | None]:
        """Bridge the gaps of an axis; its certain rows, and the fault that ends the tape there."""
        for a, b in self._gaps_of(axis):
            if rows.first_row + b <= (self._given or 0):
                continue
            is_open = not last and b + self._side + self._held > len(rows)
            if is_open and b - a <= self._longest_s * self._rate_hz:
                return a, None  # what comes after it is not yet there
            fault = self._bridge(rows, axis, a, b)
            if fault is not None:
                return a, fault
        return len(rows), None

    def _gaps_of(self, axis: int) -> list[tuple[int, int]]:
        """First and last row (past it) of each gap of an axis; gaps close to each other are one."""
        lost = np.flatnonzero(
            self._lost[:, 0] | self._lost[:, axis + 1] | self._surprised[:, axis]
        )
        if not len(lost):
            return []
        apart = self._side + 2 * self._spread
        cuts = np.flatnonzero(np.diff(lost) > apart)
        firsts = lost[np.r_[0, cuts + 1]]
        lasts = lost[np.r_[cuts, len(lost) - 1]]
        return [
            (max(int(a) - self._spread, 0), int(b) + 1 + self._spread)
            for a, b in zip(firsts, lasts, strict=True)
        ]

    def _bridge(self, rows: Phases, axis: int, a: int, b: int) -> Fault | None:
        """Fill a gap and count on behind it; the fault if it is too long to be certain."""
        cycles = rows.cycles[:, axis]
        time_s = (rows.first_row + a) / self._rate_hz
        is_short = b - a <= self._longest_s * self._rate_hz
        if is_short and b + self._side > len(rows) and self._rests_from(rows, axis, a):
            cycles[a:], rows.surprise[a:, axis] = cycles[max(a - 1, 0)], 0
            return None
        if b + self._side > len(rows) or not is_short:
            return self._ended(rows, axis, a, time_s)
        if a < self._side:
            return self._uncertain(axis, cycles[max(a - 1, 0)], time_s, b - a)
        gap = self._riding.across(rows, axis, (a, b), self._side)
        steady = self._surprised[min(a + self._spread, len(rows) - 1), axis]
        noise = self._surprises.noise(axis)
        gap = replace(gap, steady=bool(steady), noise=noise)
        if self._riding.bounds is not None and not gap.certain:
            gap = replace(gap, furthest=_furthest(gap, cycles, (a, b)))
        if self._riding.bounds is None and not gap.bridge.certain:
            if self._riding.told is None:
                return self._uncertain(axis, gap.before.place, time_s, b - a)
            self.doubtful[gap.first, axis] = gap.bridge
            gap = gap.ending(self._riding.told.get((gap.first, axis), 0))
        cycles[a:b] = gap.laid()
        rows.surprise[a:b, axis] = 0
        _count_on(self._discriminator, axis, gap.after, cycles[b:], rows.surprise[b:, axis])
        self.bridged[time_s, self._names[axis]] = (b - a) / self._rate_hz
        self._new.append(gap)
        return None

    def _rests_from(self, rows: Phases, axis: int, a: int) -> bool:
        """Whether an axis tells that it stands still from a row to the last."""
        if self._riding.bounds is None:
            return False
        first, last = rows.first_row + a, rows.first_row + len(rows)
        return self._riding.bounds()[axis].rests(first, last)

    def _ended(self, rows: Phases, axis: int, a: int, time_s: float) -> TapeFault:
        """The fault of a track that does not come back."""
        at = min(a + self._spread, len(rows) - 1)
        track = 0 if self._lost[at, 0] else axis + 1
        name = "reference" if track == 0 else self._names[track - 1].upper()
        return TapeFault(
            f"track {track + 1} ({name}) lost its carrier at {time_s:.3f} s, for more than "
            f"{self._longest_s * 1e3:g} ms or to "
            f"the tape's end; record or copy the tape again",
            time_s=time_s,
        )

    def _uncertain(self, axis: int, place: float, time_s: float, rows: int) -> LockFault:
        """The fault of so many rows with an uncertain count; `place` is the last certain one, cycles."""
        name, position_mm = self._names[axis], self._place_mm(axis, place)
        gap_s, cut = rows / self._rate_hz, ""
        # the filter alone makes these of an edge between two signals
        if rows <= 4 * self._spread:
            cut = " (or the tape is cut there, and any length is missing)"
        return LockFault(
            f"{name.upper()} was lost for {gap_s * 1e3:.1f} ms at {time_s:.3f} s{cut}, last certain position "
            f"{position_mm:.3f} mm: how many cycles passed there is not certain; copy the tape again, "
            f"mend it (morfax mend), or go on behind it from a position given by hand (--resume-at "
            f"{time_s + gap_s + SIDE_S:.2f}s --from ...)",
            axis=name,
            time_s=time_s,
            error_cycles=float("nan"),
            position_mm=position_mm,
        )


@njit(cache=True, nogil=True)
def _mark(levels, least, follow, tracked, lost):  # type: ignore[no-untyped-def]
    """Mark the rows whose level is off; `tracked` follows the others: a share of the way from row to row.

    All tracks row by row: each waits for its own last row, and they can wait together.
    """
    steady, share = follow
    for row in range(len(levels)):
        for track in range(levels.shape[1]):
            level, slow = levels[row, track], tracked[track]
            is_near = level >= steady * slow and level * steady <= slow
            if level >= least[track] and is_near:
                tracked[track] = slow + share * (level - slow)
            else:
                lost[row, track] = True
