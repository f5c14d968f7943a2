"""Rehearsal: a motion run past the player's own limits before it is recorded, so that no tape is made that
cannot be played.

Signals in: the blocks of a motion that is to be recorded, mm. Signals out: the same blocks; a fault where the
tape could not be read; and, told at the end, where a drive could not follow it.

    motion ──► cycles ──┬──► predictor ──► jumps, shaking (watch.py)      no player reads such a tape: a fault
                        └──► axis drives ──► lock lost (drives.py)        followed perhaps at another override

Source: our own. Questions: the tape's filter rounds a jump a little, so it is found here at speeds up to 0.5
% lower; noise, which no rehearsal knows, comes on top.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import MotionFault
from morfax.motion.median import medians
from morfax.motion.motion import Motion
from morfax.player.tape.drives import Drives, ReferenceTrack
from morfax.player.tape.phase_lock import PhaseLock
from morfax.player.tape.predictor import count_turns, predictor_gains
from morfax.player.tape.standstill import STANDSTILL_S
from morfax.player.tape.watch import SHAKE_CYCLES, SHAKE_STRIDE, shake_rows
from morfax.recorder.tape.format import SURE_CYCLES, TapeFormat

WINDOWS = 4  # of shaking, a quarter of one from each to the next
WITHIN_ROWS = 16  # of the motion: a jump surprises most within these


@dataclass(frozen=True, slots=True)
class Unfollowed:
    """The place where a drive would lose its lock: axis, time in the motion in s, place in mm."""

    axis: str
    time_s: float
    place_mm: tuple[float, ...]


class Rehearsal:
    """Rehearses one motion for a tape of a format; `unfollowed` is the first loss of lock."""

    def __init__(self, fmt: TapeFormat, settings: PhaseLock | None = None) -> None:
        rate_hz, axes = fmt.motion_rate_hz, len(fmt.axes)
        self._format, self._gains = fmt, predictor_gains(rate_hz)
        self._state = np.full((axes, 3), np.nan)
        self._drives = Drives(
            axes,
            fmt.mm_per_cycle,
            rate_hz,
            (settings or PhaseLock()).suited_to(rate_hz),
            reference=ReferenceTrack(fmt.reference_hz / rate_hz),
        )
        self._shown = np.zeros((0, axes), np.float32)  # surprises from the next window on
        self._loud = np.zeros(axes, int)  # windows in a row in which an axis shook
        self._before = np.zeros((0, axes))  # positions just before the block
        self._start_mm: Array | None = None
        self._rows = 0
        self.unfollowed: Unfollowed | None = None

    def of(self, stream: Iterable[Motion]) -> Iterator[Motion]:
        """Pass the blocks of a motion on; raises MotionFault behind a block that no player could read."""
        for block in stream:
            yield block
            self._run(np.asarray(block.positions_mm, np.float64))
        self._run(
            np.repeat(
                self._before[-1:], round(STANDSTILL_S * self._format.motion_rate_hz), axis=0
            )
        )

    def _run(self, positions_mm: Array) -> None:
        """Run a block of positions past all limits."""
        if not len(positions_mm):
            return
        self._start_mm = positions_mm[0] if self._start_mm is None else self._start_mm
        cycles = (positions_mm - self._start_mm) * self._format.cycles_per_mm
        counted, surprise = np.empty_like(cycles), np.empty(cycles.shape, np.float32)
        count_turns(np.ascontiguousarray(cycles.T), self._gains, self._state, counted, surprise)
        self._refuse_jumps(positions_mm, surprise)
        self._refuse_shaking(positions_mm, surprise)
        self._follow(positions_mm, cycles)
        self._before = np.vstack([self._before, positions_mm])[-WITHIN_ROWS:]
        self._rows += len(positions_mm)

    def _refuse_jumps(self, positions_mm: Array, surprise: NDArray[np.float32]) -> None:
        """Raise MotionFault where an axis changes its speed at once by more than can be counted."""
        jumps = ~(np.abs(surprise) < SURE_CYCLES)
        if not jumps.any():
            return
        row, axis = (int(i) for i in np.argwhere(jumps)[0])
        around = np.vstack([self._before, positions_mm])[: len(self._before) + row + 1, axis][
            -WITHIN_ROWS:
        ]
        # the first one stands
        speeds = np.diff(around, prepend=around[:1]) * self._format.motion_rate_hz
        by_mm_s = float(np.ptp(speeds))
        raise self._fault(
            f"changes its speed by {by_mm_s:.3g} mm/s at once, and a tape can be read up to "
            f"{self._largest_jump_mm_s:.3g} mm/s: "
            "run it slower, or round the corner",
            (row, axis),
            positions_mm,
            by_mm_s,
        )

    def _refuse_shaking(self, positions_mm: Array, surprise: NDArray[np.float32]) -> None:
        """Raise MotionFault for an axis that shakes like noise, wherever the player's windows begin."""
        held, window = len(self._shown), shake_rows(self._format.motion_rate_hz)
        self._shown, step, first = (
            np.vstack([self._shown, np.abs(surprise)]),
            window // WINDOWS,
            0,
        )
        if len(self._shown) < window:
            return
        windows = sliding_window_view(self._shown, window, axis=0)[::step, :, ::SHAKE_STRIDE]
        for shakes in medians(windows):
            self._loud = np.where(shakes > SHAKE_CYCLES, self._loud + 1, 0)
            if self._loud.max() >= WINDOWS:
                axis = int(np.argmax(self._loud))
                raise self._fault(
                    f"shakes by {shakes[axis]:.4f} cycle, as the stairs of stepping motors or a "
                    "tight bend at speed do, and "
                    f"from {SHAKE_CYCLES:g} on a player takes that for noise: run it slower or "
                    "smoother, or record the path from "
                    "which it was made",
                    (max(first - held, 0), axis),
                    positions_mm,
                )
            first += step
        self._shown = self._shown[first:]

    def _follow(self, positions_mm: Array, cycles: Array) -> None:
        """Have the drives follow, as long as they do."""
        if self.unfollowed is not None:
            return
        row = len(self._drives.follow(cycles))
        if row < len(cycles):
            axis = int(np.argmax(np.abs(self._drives.error_mm)))
            time_s = (self._rows + row) / self._format.motion_rate_hz
            self.unfollowed = Unfollowed(
                self._format.axes[axis], time_s, tuple(positions_mm[row].tolist())
            )

    @property
    def _largest_jump_mm_s(self) -> float:
        """The largest change of speed that the predictor's limit lets through, mm/s."""
        fmt, ramp = self._format, 1e-3 * np.arange(200.0)[None]  # cycles a row
        surprise = np.empty((ramp.shape[1], 1), np.float32)
        count_turns(ramp, self._gains, np.zeros((1, 3)), np.empty(surprise.shape), surprise)
        by_cycles = SURE_CYCLES / float(np.abs(surprise).max()) * 1e-3
        return by_cycles * fmt.mm_per_cycle * fmt.motion_rate_hz

    def _fault(
        self,
        what: str,
        at: tuple[int, int],
        positions_mm: Array,
        speed_mm_s: float | None = None,
    ) -> MotionFault:
        """The fault of a row and axis of a block."""
        row, axis = at
        name = self._format.axes[axis]
        time_s = (self._rows + row) / self._format.motion_rate_hz
        place = ",".join(f"{mm:.2f}" for mm in positions_mm[row, :2])
        return MotionFault(
            f"{name.upper()}, at {place} mm and {time_s:.3f} s, {what}",
            axis=name,
            time_s=time_s,
            speed_mm_s=speed_mm_s,
        )
