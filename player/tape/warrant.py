"""The warrant: what stands between the certain rows of a tape and the drives, bare or checked.

Signals in: certain rows, the gaps that were bridged in them, and the fault behind them. Signals out: rows
that may be given out, and the first that may not, with its fault.

    bare       bare.py       gives rows on at once; what can be found out is told at the end
    checked    vouching.py   holds rows until the check signal has vouched for them

Source: our own. Questions: none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

from morfax.motion.arrays import Array
from morfax.player.tape.calm_frames import Heard
from morfax.player.tape.gap import Gap
from morfax.player.tape.phases import Phases, Uncertain
from morfax.player.tape.told_bounds import ToldBounds
from morfax.recorder.tape.tape import Stored

StandsMm = Callable[[], Sequence[float]]  # where the machine stands, axis by axis
PlaceMm = Callable[[int, float], float]  # where an axis is at a phase, cycles
Given = tuple[Phases, Uncertain | None]


class Certain(NamedTuple):
    """Rows that the dropouts have left certain, the first row that is not, and the gaps bridged so far."""

    rows: Phases
    fault: Uncertain | None
    gaps: Sequence[Gap] = ()


class Warrant(Protocol):
    """Stands for the rows of one tape."""

    is_checked: bool
    notes: tuple[str, ...]  # on the tape, once it has begun

    def listen(self, frames: Stored) -> list[Heard]:
        """What the check signal says by the next frames of the tape; may run in a thread of its own."""
        ...

    def hear(self, heard: list[Heard]) -> None:
        """Take what it says, as far as rows were read."""

    def begin(self, rows: Phases) -> Phases:
        """The first rows of the tape, put right; raises TapeFault for a wrong track."""
        ...

    def bear(self, zero_cycles: Array | None, place_mm: PlaceMm) -> None:
        """Take the zeros of the axes, or None on a tape that is resumed."""

    def bounds(self) -> Sequence[ToldBounds]:
        """What the track of each axis tells of the program; of a bare tape nothing."""
        ...

    def feed(self, certain: Certain, stands_mm: StandsMm, *, last: bool = False) -> Given:
        """Take the next rows; those that may be given out, and the fault behind them."""
        ...

    def end(self, time_s: float) -> None:
        """The tape ends; raises TapeFault for what shows only then."""
