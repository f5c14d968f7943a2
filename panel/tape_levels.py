"""The tracks of a tape over its time, as the panel's strip shows them: level, deviation, lock, damage.

Signals in: a tape (WAV, RF64, FLAC). Signals out: for each of `COLUMNS` stretches

    level         effective level (RMS) of each track, as a share of full scale
    deviation_hz  by how much the carrier of an axis is off the reference: its speed times cycles per mm
    lock          how far a phase lay from the one expected, cycles, at most: at half a cycle it is lost

and the damage: where a track is below `WEAK` of its usual level for a window of 2 ms or more.

Source: our own. Questions: a tape that the control refuses has levels and damage, and no deviation.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion.arrays import NOT_ZERO
from morfax.motion.faults import Fault
from morfax.motion.files import for_soundfile

if TYPE_CHECKING:
    from morfax.motion.arrays import Array
    from morfax.player.tape.phases import Phases
    from morfax.recorder.tape.tape import Tape

COLUMNS = 800  # stretches: more than a strip has pixels
NAMES = ("reference", "X", "Y", "Z")
DECIMALS = 4  # 0.1 um, 0.1 ms
WINDOW_S = 0.002  # 12 cycles of a carrier of 6 kHz
WEAK = 0.5  # of a track's median level: 6 dB, which tape and recorder do not waver by; by trial
MOST_DAMAGES = 200  # that are listed, the longest


def levels(tape: FilePath) -> dict[str, Any] | None:
    """Level, deviation, lock and damage of a tape's tracks; None for a file that is no tape."""
    import soundfile

    if tape.suffix.lower() not in (".wav", ".rf64", ".flac"):
        return None
    with soundfile.SoundFile(for_soundfile(tape)) as opened:
        window = round(WINDOW_S * opened.samplerate)
        seconds = opened.frames / opened.samplerate
        blocks = opened.blocks(512 * window, dtype="float32", always_2d=True)
        power = [_power(block, window) for block in blocks]
    if not power:
        return None
    powers = np.vstack(power)
    group = max(1, -(-len(powers) // COLUMNS))
    firsts = np.arange(0, len(powers), group)
    sizes = np.diff(firsts, append=len(powers))[:, None]
    level = np.sqrt(np.add.reduceat(powers, firsts) / sizes)
    tracks = list(NAMES[: level.shape[1]])
    return {
        "tracks": tracks,
        "duration_s": round(seconds, DECIMALS),
        "t_s": np.round((firsts + 0.5 * sizes[:, 0]) * WINDOW_S, DECIMALS).tolist(),
        "level": np.round(level.T, DECIMALS).tolist(),
        **_of_phases(tape, len(firsts)),
        "damage": damages(np.sqrt(powers), tracks),
    }


def damages(level: Array, tracks: list[str]) -> list[dict[str, Any]]:
    """Where a track (windows, tracks) is below `WEAK` of its usual level; the longest, in their order."""
    found = list[dict[str, Any]]()
    for name, own in zip(tracks, level.T, strict=False):
        usual = float(np.median(own))
        weak = np.r_[False, own < WEAK * usual, False].astype(np.int8)
        for a, b in np.flatnonzero(np.diff(weak)).reshape(-1, 2):
            least = float(own[a:b].min()) / max(usual, NOT_ZERO)
            found.append(
                {
                    "track": name,
                    "from_s": round(float(a) * WINDOW_S, DECIMALS),
                    "to_s": round(float(b) * WINDOW_S, DECIMALS),
                    "share": round(least, 3),
                }
            )
    longest = sorted(found, key=lambda one: one["from_s"] - one["to_s"])[:MOST_DAMAGES]
    return sorted(longest, key=lambda one: float(one["from_s"]))


def _power(block: Array, window: int) -> Array:
    """Mean square of the windows (windows, tracks) of a block; a shorter rest counts as one."""
    firsts = np.arange(0, len(block), window)
    sizes = np.diff(firsts, append=len(block))[:, None]
    return np.asarray(np.add.reduceat(np.square(block, dtype=float), firsts) / sizes)


def _of_phases(file: FilePath, columns: int) -> dict[str, Any]:
    """Deviation and lock of the axes, by the control's own discriminator; nothing of a tape it refuses."""
    from morfax.recorder.tape.tape import Tape

    try:
        with Tape.open(file) as tape:
            rate_hz = tape.format.sample_rate_hz / tape.format.samples_per_motion
            rows = max(1.0, tape.duration_s * rate_hz / columns)
            return _gathered(tape, rows, rate_hz, columns)
    except Fault:
        return {"deviation_hz": None, "lock": None}


def _gathered(tape: Tape, rows: float, rate_hz: float, columns: int) -> dict[str, Any]:
    """Deviation and lock of so many columns of so many rows each."""
    axes = len(tape.format.axes)
    first = np.full((columns, axes), np.nan)
    last = np.full((columns, axes), np.nan)
    lock = np.zeros((columns, axes))
    for phases in _phases(tape):
        column = ((phases.first_row + np.arange(len(phases))) / rows).astype(int)
        column = np.minimum(column, columns - 1)
        begins = np.flatnonzero(np.r_[True, np.diff(column) > 0])
        ends = np.r_[begins[1:], len(column)] - 1
        at = column[begins]
        fresh = np.isnan(first[at])
        first[at] = np.where(fresh, phases.cycles[begins], first[at])
        last[at] = phases.cycles[ends]
        np.maximum.at(lock, column, np.abs(phases.surprise))
    deviation_hz = np.nan_to_num((last - first) * rate_hz / max(rows - 1.0, 1.0))
    return {
        "deviation_hz": np.round(deviation_hz.T, 2).tolist(),
        "lock": np.round(lock.T, DECIMALS).tolist(),
    }


def _phases(tape: Tape) -> Iterator[Phases]:
    """The phases of a whole tape, block by block."""
    from morfax.player.tape.discriminator import Discriminator, discriminate

    fmt = tape.format
    organ = Discriminator(
        fmt.sample_rate_hz, fmt.reference_hz, fmt.samples_per_motion, fmt.tracks
    )
    return discriminate(tape.stored_blocks(), organ)
