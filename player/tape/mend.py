"""Mending: where the end of a tape tells how many whole cycles were lost in which dropout, the tape is
recorded anew.

Signals: a tape in; a tape out whose dropouts are gone, and what was found of each that the player would stop
at.

The tape is read through with every dropout bridged as the motion on both sides suggests. A travel over a
dropout may still be wrong by whole cycles N, within what the acceleration A allows (dropouts.py: |r + N| < H
+ 0.1). Each axis then ends whole cycles off the end that the tape states, or off its start where the program
is closed:

    N of the first doubtful dropout + N of the second + ...  =  cycles missing at the end

If just one set of N fulfils that, it is known, and the tape is read again with it. If there are several (two
dropouts that could each have lost the cycle), or none, or what is missing is no whole number, it cannot be
known.

Source: patent ES 361967 (a program is a tape, and may be copied); fault circuit 162 asks for it. Questions:
within a dropout the way between both sides is laid as a cubic; `unknown_mm` says how far off it may be. What
the tape's noise did to the motion is recorded with it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import LockFault, TapeFault
from morfax.motion.motion import Motion
from morfax.player.tape.bridges import COUNT_MARGIN, Bridge
from morfax.player.tape.playback import TapePlayback, play
from morfax.player.tape.track_order import END_CYCLES
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.tape.recording import Progress, Recording, record

END_S = 0.05  # of the standstill at the end, over which the place is averaged
KEPT_DWELL = 0.1  # of the standstills: the tape may have run this much fast, and gets new ones
MANY = 2  # sets of numbers that fulfil the end: more need not be counted


Gap = tuple[int, int]  # first row, axis


@dataclass(frozen=True, slots=True)
class Mend:
    """A dropout that would have stopped the player: time, whole cycles put back, largest error within it."""

    axis: str
    time_s: float
    cycles: int
    unknown_mm: float


@dataclass(frozen=True, slots=True)
class Mended:
    """The new tape, the doubtful dropouts in it, and how many there were in all."""

    recording: Recording
    mends: tuple[Mend, ...]
    dropouts: int


def mend(
    file: str | os.PathLike[str],
    mended: str | os.PathLike[str],
    *,
    reference_hz: float | None = None,
    cycles_per_mm: float | None = None,
    start_mm: Sequence[float] | None = None,
    order: Sequence[int] | None = None,
    still: Sequence[str] | None = None,
    alike: Sequence[str] | None = None,
    closed: bool = False,
    acceleration_mm_s2: float | None = None,
    progress: Progress | None = None,
) -> Mended:
    """Mend a tape; raises TapeFault if the loss cannot be known, and the faults of playing and recording."""
    by_hand = {
        "reference_hz": reference_hz,
        "cycles_per_mm": cycles_per_mm,
        "start_mm": start_mm,
        "order": order,
        "still": still,
        "alike": alike,
    }
    limits = {"closed": closed, "acceleration_mm_s2": acceleration_mm_s2}
    playback = play(file, **by_hand, **limits)  # type: ignore[arg-type]
    fmt, reader = playback.format, playback.reader
    if fmt.end_mm is None:
        raise TapeFault(
            f"{file} does not state where it ends, so nothing tells what was lost; if its program "
            "returns to its start, say so "
            f"(--closed)"
        )
    reader.told, reader.trusts_counts = {}, False
    missing = (np.array(fmt.end_mm) - _end_mm(playback)) * fmt.cycles_per_mm
    doubtful = dict(reader.doubtful)
    reader.told, reader.trusts_counts = _lost(doubtful, missing, fmt), True
    total_s = playback.duration_s
    recording = record(
        _motion(playback),
        mended,
        replace(fmt, checked=reader.is_checked),
        None if progress is None else lambda done_s, _: progress(done_s, total_s),
    )
    mends = tuple(_mend(gap, doubtful[gap], reader.told[gap], fmt) for gap in sorted(doubtful))
    return Mended(recording, mends, len(reader.bridged))


def _mend(gap: Gap, found: Bridge, cycles: int, fmt: TapeFormat) -> Mend:
    """The mend of a dropout; a motion of acceleration A in it may swing out by A T² / 16."""
    unknown_cycles = abs(found.off + cycles) / 2 + found.reach / 4
    return Mend(
        fmt.axes[gap[1]], gap[0] / fmt.motion_rate_hz, cycles, unknown_cycles * fmt.mm_per_cycle
    )


def _read(playback: TapePlayback) -> Iterator[tuple[int, Array]]:
    """Read the tape: blocks of places in mm with their first row; raises the tape's faults."""
    place_mm, fmt = playback.start_mm.copy(), playback.format
    for phases, bearings, fault in playback.reader.read(lambda: place_mm.tolist()):
        fault = bearings.first_fault(phases, fmt.motion_rate_hz, place_mm.tolist()) or fault
        if fault is not None:
            raise fault[1]
        places_mm = (
            playback.start_mm + (phases.cycles - bearings.zero_cycles) * fmt.mm_per_cycle
        )
        if len(places_mm):
            place_mm[:] = places_mm[-1]
            yield phases.first_row, places_mm


def _end_mm(playback: TapePlayback) -> Array:
    """The stated end of the tape, mm."""
    rows = max(round(END_S * playback.format.motion_rate_hz), 1)
    last = np.zeros((0, len(playback.format.axes)))
    for _, places_mm in _read(playback):
        last = np.concatenate([last, places_mm])[-rows:]
    return np.asarray(np.median(last, axis=0))


def _motion(playback: TapePlayback) -> Iterator[Motion]:
    """The motion between the standstills at both ends; the recorder makes the standstills anew."""
    fmt, rate_hz = playback.format, playback.format.motion_rate_hz
    still = round((1 - KEPT_DWELL) * fmt.dwell_s * rate_hz)
    end = -(-playback.frames // fmt.samples_per_motion) - still
    for first, places_mm in _read(playback):
        kept = places_mm[max(still - first, 0) : max(end - first, 0)]
        if len(kept):
            yield Motion(kept, rate_hz, max(first, still) / rate_hz, fmt.axes)


def _lost(doubtful: dict[Gap, Bridge], missing: Array, fmt: TapeFormat) -> dict[Gap, int]:
    """Whole cycles to put back at each doubtful dropout; raises TapeFault or LockFault if unknown."""
    told: dict[Gap, int] = {}
    for axis, cycles in enumerate(missing.tolist()):
        gaps = [gap for gap in sorted(doubtful) if gap[1] == axis]
        if abs(cycles - round(cycles)) > END_CYCLES:
            raise _not_whole(axis, cycles, fmt)
        sets = _sets([_candidates(doubtful[gap]) for gap in gaps], round(cycles))
        if len(sets) != 1:
            raise _unknown(
                axis,
                round(cycles),
                [gap[0] / fmt.motion_rate_hz for gap in gaps],
                len(sets),
                fmt,
            )
        told |= dict(zip(gaps, sets[0], strict=True))
    return told


def _candidates(found: Bridge) -> range:
    """Whole cycles by which the travel over a dropout may be wrong."""
    most = found.reach + COUNT_MARGIN + found.misfit
    return range(int(np.ceil(-most - found.off)), int(np.floor(most - found.off)) + 1)


def _sets(candidates: list[range], total: int) -> list[tuple[int, ...]]:
    """Sets of one number from each range with this sum; at most two, as two are ambiguous already."""
    if not candidates:
        return [()] if total == 0 else []
    found: list[tuple[int, ...]] = []
    rest_low, rest_high = (
        sum(r[0] for r in candidates[1:] if r),
        sum(r[-1] for r in candidates[1:] if r),
    )
    for number in candidates[0]:
        if rest_low <= total - number <= rest_high:
            found += [(number, *rest) for rest in _sets(candidates[1:], total - number)]
        if len(found) >= MANY:
            return found[:MANY]
    return found


def _unknown(
    axis: int, cycles: int, times_s: list[float], sets: int, fmt: TapeFormat
) -> TapeFault:
    """The fault of cycles that no dropout, or one of several, has lost."""
    name, places = (
        fmt.axes[axis].upper(),
        ", ".join(f"{time_s:.3f} s" for time_s in times_s[:6]),
    )
    if sets and not cycles:
        why = (
            f"where it should, but what one of the {len(times_s)} dropouts at {places} lost another may "
            "have put back"
        )
    elif sets:
        why = (
            f"{cycles:+d} cycles off, and the {len(times_s)} dropouts at {places} could have lost them "
            "in more than one way"
        )
    elif times_s:
        why = f"{cycles:+d} cycles off, and the dropouts at {places} are too short for it"
    else:
        why = f"{cycles:+d} cycles off, and there is no dropout that could have lost them; look for a splice"
    return TapeFault(f"{name} ends {why}: it cannot be known; get another copy")


def _not_whole(axis: int, cycles: float, fmt: TapeFormat) -> LockFault:
    """The fault of an end that is off by more than whole cycles."""
    return LockFault(
        f"{fmt.axes[axis].upper()} ends {cycles:+.2f} cycles off, which is no whole number within "
        f"{END_CYCLES:g}: more than "
        f"cycles was lost, or it is cut short; get another copy",
        axis=fmt.axes[axis],
        time_s=0.0,
        error_cycles=cycles,
        position_mm=float(fmt.end_mm[axis] if fmt.end_mm else 0.0),
    )
