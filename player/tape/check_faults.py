"""The faults that the check signal tells: which track, at which tape time, what is wrong, what to do next.

Signals in: tracks from 0, names of the axes, s and cycles; out: faults, to be raised or given out.

Source: patent ES 361967, figure 5 (fault circuit 162) asks for a stop. Questions: none.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from morfax.motion.faults import DropoutFault, LockFault, TapeFault
from morfax.player.tape.counts import Off
from morfax.player.tape.gap import Gap
from morfax.player.tape.standstill import track_name
from morfax.recorder.tape.format import SURE_CYCLES

Names = Sequence[str]  # of the axes


def _called(track: int, names: Names) -> str:
    """Number and name of a track."""
    name = track_name(track, names) if track <= len(names) else "none of this tape"
    return f"track {track + 1} ({name})"


def wrong_track(track: int, says: int, names: Names, time_s: float) -> TapeFault:
    """The fault of a track that says to be another."""
    what = (
        track_name(says, names) if says <= len(names) else f"track {says + 1} of another tape"
    )
    return TapeFault(
        f"track {track + 1} says that it is the {what}, and should be the {track_name(track, names)}: the "
        "tracks are in another order, or one is a copy of another; say which tracks are reference, "
        f"{', '.join(name.upper() for name in names)} (--tracks)",
        time_s=time_s,
    )


def demand_tracks(says: Sequence[int | None], names: Names) -> None:
    """Raise TapeFault unless each track says to be the one that it is."""
    for track, said in enumerate(says):
        if said is None:
            raise silent_track(track, names)
        if said != track:
            raise wrong_track(track, said, names, 0.0)


def silent_track(track: int, names: Names) -> TapeFault:
    """The fault of a track that says nothing at the start, while others do."""
    return TapeFault(
        f"the check signal of {_called(track, names)} cannot be read at the tape's start, though others can; "
        "copy the tape again",
        time_s=0.0,
    )


def unreadable(track: int, names: Names, time_s: float) -> TapeFault:
    """The fault of a check signal that cannot be read for too long."""
    return TapeFault(
        f"the check signal of {_called(track, names)} cannot be read from {max(time_s, 0.0):.3f} s on: a "
        "stretch of the tape is lost or damaged there; copy the tape again",
        time_s=max(time_s, 0.0),
    )


def disordered(track: int, names: Names, off_s: float, time_s: float) -> TapeFault:
    """The fault of a frame that is not the next: later by `off_s`, or earlier."""
    what = "are missing" if off_s > 0 else "come a second time"
    return TapeFault(
        f"{abs(off_s):.2f} s of {_called(track, names)} {what} before {time_s:.3f} s; copy the tape again",
        time_s=time_s,
    )


def too_late(
    track: int, names: Names, late_s: float, allowed_s: float, time_s: float
) -> TapeFault:
    """The fault of a track that is later than can be put right."""
    return TapeFault(
        f"{_called(track, names)} is {abs(late_s) * 1e6:.0f} us off the reference at {time_s:.3f} s, "
        f"{allowed_s * 1e6:.0f} is allowed: its head is not straight, or samples were lost or repeated; copy "
        "the tape again",
        time_s=time_s,
    )


def stepped(track: int, names: Names, step_s: float, time_s: float) -> TapeFault:
    """The fault of a delay that makes a step."""
    return TapeFault(
        f"the delay of {_called(track, names)} steps by {step_s * 1e6:.0f} us at about {time_s:.3f} s: "
        "samples were lost or repeated there; copy the tape again",
        time_s=time_s,
    )


def replaced(track: int, names: Names, time_s: float) -> TapeFault:
    """The fault of a carrier that stands without its check signal."""
    return TapeFault(
        f"{_called(track, names)} loses its check signal at {time_s:.3f} s, and not its carrier: another "
        "signal stands there; copy the tape again",
        time_s=time_s,
    )


def swings(track: int, names: Names, swing_s: float, time_s: float) -> TapeFault:
    """The fault of a delay that swings faster than can be followed."""
    return TapeFault(
        f"the delay of {_called(track, names)} swings by {swing_s * 1e6:.0f} us at about {time_s:.3f} s, "
        "faster than can be followed: its head or its tape shakes; copy the tape again",
        time_s=time_s,
    )


def miscounted(axis: str, off: Off, time_s: float, place_mm: float) -> LockFault:
    """The fault of a count that differs from what the track says."""
    why = (
        "cycles were lost shortly before; copy the tape again, or mend it (morfax mend)"
        if abs(off.cycles) > SURE_CYCLES
        else "its phase was turned on shortly before, as a filter or an echo does; copy the tape again"
    )
    return LockFault(
        f"{axis.upper()} is {off.cycles:+.3f} cycles off what its check signal says at {time_s:.3f} s, "
        f"{off.limit_cycles:.3f} is allowed; last certain position {place_mm:.3f} mm: {why}",
        axis=axis,
        time_s=time_s,
        error_cycles=off.cycles,
        position_mm=place_mm,
    )


def no_end(time_s: float) -> TapeFault:
    """The fault of a tape whose last frames are missing."""
    return TapeFault(
        f"the tape's end is missing: the check signal says after {time_s:.3f} s that more is to come; get "
        "the whole tape",
        time_s=time_s,
    )


class Behind(NamedTuple):
    """Where the axes are known again behind a gap: tape time, places, and how far its count lies off."""

    time_s: float
    places_mm: tuple[float, ...]
    off_cycles: float


def lost_way(
    gap: Gap, axis: str, rate_hz: float, position_mm: float, known: Behind | None
) -> DropoutFault:
    """The fault of a gap whose way is not known."""
    time_s = gap.first / rate_hz
    length_s = (gap.last - gap.first) / rate_hz
    behind = "and the tape does not say where it is behind that: mend it (morfax mend) or copy it again"
    if known is not None:
        places = ",".join(f"{place_mm:.4f}" for place_mm in known.places_mm)
        behind = (
            f"it is picked up again at {known.time_s:.3f} s: have the way laid (morfax mend), copy the tape "
            f"again, or go on there (--resume-at {known.time_s:.6f}s --from={places})"
        )
    return DropoutFault(
        f"{axis.upper()} was lost for {length_s * 1e3:.1f} ms at {time_s:.3f} s, last certain position "
        f"{position_mm:.3f} mm: the way within is not known, {behind}",
        axis=axis,
        time_s=time_s,
        error_cycles=math.nan if known is None else known.off_cycles,
        position_mm=position_mm,
        length_s=length_s,
        resumes=None if known is None else (known.time_s, known.places_mm),
    )
