"""The bare tape: what can be found out where nothing on the tape vouches for it, and what cannot.

Signals in: the certain rows of the whole tape, from its first row. Signals out, at its end: nothing, or a
fault.

    stands       X or Y stands from start to end while another axis moves: its track may be a copy of the
                 reference
    alike        two axes run alike from start to end: one track may be a copy of the other
    backwards    a tape that ends before it begins plays every move from its end and with the other sign. So
                 the tool, which comes down to the work and goes up again, only goes up from its start

What is meant so is allowed: by the text chunk, whose entries the recorder writes, or by hand.

Source: patent ES 361967 has four bare tracks. Questions: the text chunk turns no screws, but it may allow
what the tracks show; it is no proof, as a copied track may be one of those that are allowed. Z and further
axes stand in many programs, so they are not asked to move. A tool that starts in the work may well go up
only; one that starts above it and never comes down makes nothing, whichever way the tape runs. A closed
line whose tool stays where it is, played backwards, is a right tape of another part: nothing tells it.
"""

from __future__ import annotations

from collections.abc import Sequence

from morfax.motion.arrays import Array
from morfax.motion.faults import TapeFault
from morfax.motion.motion import IN_WORK_BELOW_MM
from morfax.player.tape.calm_frames import Heard
from morfax.player.tape.phases import Phases
from morfax.player.tape.told_bounds import ToldBounds
from morfax.player.tape.warrant import Certain, Given, PlaceMm, StandsMm
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.tape.own_motion import OWN_CYCLES, STATED_CYCLES, OwnMotion
from morfax.recorder.tape.tape import Stored

TOOL = "z"
NOT_VOUCHED = (
    "the tape is bare, it has no check signal: lost or repeated samples, a late track, X and Y in each "
    "other's places and a tape that runs backwards show only where it ends elsewhere than it states"
)
NOT_PLACED = (
    "the tape does not say where it starts: places count from zero, or from that of --from"
)


class BareTape:
    """What warrants the rows of a bare tape: nothing but its own motion, at the end."""

    is_checked = False

    def __init__(self, fmt: TapeFormat, start_mm: Array) -> None:
        self._format, self._start_mm = fmt, start_mm
        is_placed = fmt.stated is not None or any(fmt.start_mm)
        self.notes: tuple[str, ...] = (NOT_VOUCHED,) if is_placed else (NOT_VOUCHED, NOT_PLACED)
        self._own = OwnMotion(len(fmt.axes))

    def listen(self, frames: Stored) -> list[Heard]:
        """Nothing is to be heard in the next frames of the tape."""
        return []

    def hear(self, heard: list[Heard]) -> None:
        """Take what there is not."""

    def begin(self, rows: Phases) -> Phases:
        """The first rows of the tape, as they are."""
        return rows

    def bear(self, zero_cycles: Array | None, place_mm: PlaceMm) -> None:
        """Take the zeros of the axes, which nothing vouches for."""

    def bounds(self) -> Sequence[ToldBounds]:
        """Nothing tells what the program asks for."""
        return ()

    def feed(self, certain: Certain, stands_mm: StandsMm, *, last: bool = False) -> Given:
        """Take the next rows and the fault behind them; give them on as they are."""
        self._own.feed(certain.rows.cycles)
        return certain.rows, certain.fault

    def end(self, time_s: float) -> None:
        """Raise TapeFault for tracks that may be copies, or a tape that runs backwards."""
        _demand_moving(self._own, self._format, time_s)
        _demand_apart(self._own, self._format, time_s)
        _demand_forwards(self._own, self._format, self._start_mm.tolist(), time_s)


def _demand_moving(own: OwnMotion, fmt: TapeFormat, time_s: float) -> None:
    """Raise TapeFault for X or Y that stands while another axis moves."""
    for axis in own.standing(fmt.axes, OWN_CYCLES):
        if axis not in fmt.still:
            raise TapeFault(
                f"{axis.upper()} stands from start to end while other axes move: track "
                f"{fmt.axes.index(axis) + 2} may be a copy of the reference; get another copy, or say that "
                f"it is meant to stand (--still {axis})",
                time_s=time_s,
            )


def _demand_apart(own: OwnMotion, fmt: TapeFormat, time_s: float) -> None:
    """Raise TapeFault for two axes that run alike."""
    for pair in own.pairs(OWN_CYCLES):
        one, other = (fmt.axes[axis] for axis in pair)
        if one not in fmt.alike or other not in fmt.alike:
            raise TapeFault(
                f"{one.upper()} and {other.upper()} run alike from start to end: track {pair[1] + 2} may be "
                f"a copy of track {pair[0] + 2}; get another copy, or say that they are meant to (--alike "
                f"{one},{other})",
                time_s=time_s,
            )


def _demand_forwards(
    own: OwnMotion, fmt: TapeFormat, start_mm: Sequence[float], time_s: float
) -> None:
    """Raise TapeFault for a tool that starts above the work and only goes further up."""
    if TOOL not in fmt.axes:
        return
    axis = fmt.axes.index(TOOL)
    rises, falls = own.above_cycles[axis], own.below_cycles[axis]
    if rises >= STATED_CYCLES and falls < OWN_CYCLES and start_mm[axis] > IN_WORK_BELOW_MM:
        raise TapeFault(
            f"the tool goes up by {rises * fmt.mm_per_cycle:.3f} mm from its start at {start_mm[axis]:.3f} "
            "mm and never down to the work: the tape runs backwards, and ends before it begins; turn it "
            "round, or give the place of the tool at its start (--from X,Y,Z)",
            time_s=time_s,
        )
