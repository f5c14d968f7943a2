"""Mending: where a tape tells how many whole cycles were lost in which dropout, it is recorded anew.

Signals: a tape in; a tape out whose dropouts are gone, and what was found of each that the player would stop
at.

On a checked tape the next frame behind a dropout tells where the axis is. The way until there is laid as the
motion with the least acceleration, and `unknown_mm` is how far off it may be, as the program's acceleration
and speed are told (bridges.py).

A bare tape is read through with every dropout bridged as the motion on both sides suggests. A travel over a
dropout may still be wrong by whole cycles N, within what the acceleration A allows (bridges.py: |r + N| < H +
0.1). Each axis then ends whole cycles off the end that the tape states, or off its start where the program is
closed:

    N of the first doubtful dropout + N of the second + ...  =  cycles missing at the end

If just one set of N fulfils that, it is known, and the tape is read again with it. If there are several (two
dropouts that could each have lost the cycle), or none, or what is missing is no whole number, it cannot be
known.

Source: patent ES 361967 (a program is a tape, and may be copied); fault circuit 162 asks for it. Questions:
what the tape's noise did to the motion is recorded with it. Where nothing tells the program's acceleration
within a dropout, that of the motors is taken, and `unknown_mm` is large.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Unpack

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import TapeFault
from morfax.motion.motion import Motion
from morfax.player.tape.bridges import Bridge
from morfax.player.tape.end_count import Place, lost_cycles, not_whole
from morfax.player.tape.lost_ways import Laid
from morfax.player.tape.playback import TapePlayback, play
from morfax.player.tape.reader import TapeReader
from morfax.player.tape.standstill import REFERENCE_BAND, STANDSTILL_S
from morfax.recorder.tape.format import SURE_CYCLES, TapeFormat
from morfax.recorder.tape.recording import Progress, Recording, record
from morfax.recorder.tape.stated import TapeEntries


@dataclass(frozen=True, slots=True)
class Mend:
    """A dropout that would have stopped the player: start and length on the tape (with the filter's reach),
    whole cycles put back, the largest possible error of the way laid within it, and the largest if the
    program asks for no more there than the frames around it tell.
    """

    axis: str
    time_s: float
    length_s: float
    cycles: int
    unknown_mm: float
    likely_mm: float


@dataclass(frozen=True, slots=True)
class Mended:
    """The new tape, the doubtful dropouts in it, how many there were in all, and notes on the old tape."""

    recording: Recording
    mends: tuple[Mend, ...]
    dropouts: int
    notes: tuple[str, ...]


def mend(
    file: str | os.PathLike[str],
    mended: str | os.PathLike[str],
    *,
    closed: bool = False,
    acceleration_mm_s2: float | None = None,
    progress: Progress | None = None,
    **by_hand: Unpack[TapeEntries],
) -> Mended:
    """Mend a tape; raises TapeFault if the loss cannot be known, and the faults of playing and recording."""
    playback = play(file, closed=closed, acceleration_mm_s2=acceleration_mm_s2, **by_hand)
    fmt, reader = playback.format, playback.reader
    if is_checked(playback):
        reader.mends = True
    else:
        if fmt.end_mm is None:
            raise _no_end(file)
        reader.told = {}
        missing = (np.array(fmt.end_mm) - _end_mm(playback)) * fmt.cycles_per_mm
        doubtful = dict(reader.doubtful)
        reader.told = lost_cycles(doubtful, missing, fmt)
    total_s = playback.duration_s
    recording = record(
        _motion(playback),
        mended,
        replace(fmt, checked=reader.is_checked),
        None if progress is None else lambda done_s, _: progress(done_s, total_s),
    )
    if reader.told is None:
        mends = [_laid(one, fmt) for one in reader.mended]
    else:
        mends = [_mend(place, found, reader, fmt) for place, found in doubtful.items()]
    mends.sort(key=lambda one: (one.time_s, fmt.axes.index(one.axis)))
    return Mended(recording, tuple(mends), len(reader.bridged), reader.notes)


def is_checked(playback: TapePlayback) -> bool:
    """Whether the tape has a check signal, as its first rows tell."""
    next(playback.reader.read(lambda: playback.start_mm.tolist()), None)
    return playback.reader.is_checked


def _laid(laid: Laid, fmt: TapeFormat) -> Mend:
    """The mend of a dropout whose way was laid to the place that the next frame tells."""
    gap, rate_hz, mm = laid.gap, fmt.motion_rate_hz, fmt.mm_per_cycle
    return Mend(
        fmt.axes[gap.axis],
        gap.first / rate_hz,
        (gap.last - gap.first) / rate_hz,
        laid.cycles,
        gap.freedom * mm,
        replace(gap, bound=laid.likely).freedom * mm,
    )


def _mend(place: Place, found: Bridge, reader: TapeReader, fmt: TapeFormat) -> Mend:
    """The mend of a dropout; a motion of acceleration A in it may swing out by A T² / 16."""
    cycles = (reader.told or {})[place]
    unknown_mm = (abs(found.off + cycles) / 2 + found.reach / 4) * fmt.mm_per_cycle
    time_s = place[0] / fmt.motion_rate_hz
    axis = fmt.axes[place[1]]
    length_s = reader.bridged[time_s, axis]
    return Mend(axis, time_s, length_s, cycles, unknown_mm, unknown_mm)


def _read(playback: TapePlayback) -> Iterator[tuple[int, Array]]:
    """Read the tape: blocks of places in mm with their first row; raises the tape's faults."""
    place_mm, fmt = playback.start_mm.copy(), playback.format
    for read in playback.reader.read(lambda: place_mm.tolist()):
        fault = read.first_fault(fmt.motion_rate_hz, place_mm.tolist())
        if fault is not None:
            raise fault.fault
        phases, zero_cycles = read.rows, read.bearings.zero_cycles
        places_mm = playback.start_mm + (phases.cycles - zero_cycles) * fmt.mm_per_cycle
        if len(places_mm):
            place_mm[:] = places_mm[-1]
            yield phases.first_row, places_mm


def _no_end(file: object) -> TapeFault:
    """The fault of a bare tape that does not state where it ends."""
    return TapeFault(
        f"{file} does not state where it ends, so nothing tells what was lost; if its program returns to its "
        "start, say so (--closed)"
    )


def _end_mm(playback: TapePlayback) -> Array:
    """The stated end of the tape, mm."""
    rows = max(round(STANDSTILL_S * playback.format.motion_rate_hz), 1)
    last = np.zeros((0, len(playback.format.axes)))
    for _, places_mm in _read(playback):
        last = np.concatenate([last, places_mm])[-rows:]
    return np.asarray(np.median(last, axis=0))


def _motion(playback: TapePlayback) -> Iterator[Motion]:
    """The motion between the standstills at both ends; the recorder makes the standstills anew."""
    fmt, rate_hz = playback.format, playback.format.motion_rate_hz
    # the tape may have run as much too fast; it gets new standstills
    still = round((1 - REFERENCE_BAND) * fmt.dwell_s * rate_hz)
    end = -(-playback.frames // fmt.samples_per_motion) - still
    ends_mm = np.full(len(fmt.axes), np.nan)
    for first, places_mm in _read(playback):
        ends_mm = places_mm[-1]
        kept = places_mm[max(still - first, 0) : max(end - first, 0)]
        if len(kept):
            yield Motion(kept, rate_hz, max(first, still) / rate_hz, fmt.axes)
    if fmt.end_mm is not None:
        missing = (np.array(fmt.end_mm) - ends_mm) * fmt.cycles_per_mm
        axis = int(np.argmax(np.abs(missing)))
        if abs(missing[axis]) > SURE_CYCLES:
            raise not_whole(axis, float(missing[axis]), fmt)
