"""The carriers of a tape: level and frequency of each track, measured without knowing the tape's format.

The tracks are measured in windows of 4096 frames, from where the first of them is heard to where all are
silent:

    level        root mean square of the track, against that of a full-scale sine                       (dB)
    frequency    the peak of the window's spectrum, by a parabola through the logarithms of three bins  (Hz)
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.faults import TapeFault
from morfax.motion.files import for_soundfile
from morfax.motion.usual import AT_ONCE

WINDOW_FRAMES = 4096  # 85 ms at 48 kHz: bins of 12 Hz
SILENT_DB = -80.0  # under this level a track has no carrier whose frequency could be measured


@dataclass(frozen=True, slots=True)
class CarrierReading:
    """The carrier of one track: level and frequency of each window, dB and Hz (not a number where silent)."""

    level_db: Array
    frequency_hz: Array

    def figures(self) -> dict[str, Any]:
        """Levels, and between which frequencies the carrier moves."""
        heard = self.frequency_hz[np.isfinite(self.frequency_hz)]
        return {
            "level_db": float(np.median(self.level_db)),
            "lowest_level_db": float(self.level_db.min()),
            "from_hz": float(heard.min()) if len(heard) else None,
            "to_hz": float(heard.max()) if len(heard) else None,
        }


def listen(
    file: FilePath, fault: TapeFault | None
) -> tuple[dict[str, Any], list[CarrierReading]]:
    """Kind and length of the file, and the carrier of each track; raises the fault if it is no sound file."""
    import soundfile

    try:
        with soundfile.SoundFile(for_soundfile(file)) as sound:
            kind = {"kind": f"{sound.format} {sound.subtype}", "tracks": sound.channels}
            blocks = sound.blocks(AT_ONCE, dtype="float32", always_2d=True)
            carriers = _carriers(blocks, sound.samplerate, sound.channels)
            duration_s = sound.frames / sound.samplerate
            return {
                **kind,
                "sample_rate_hz": sound.samplerate,
                "duration_s": duration_s,
            }, carriers
    except soundfile.SoundFileError as error:
        raise (
            fault
            or TapeFault(f"{file} cannot be read as a sound file: {error}; record it again")
        ) from None


def measured(frames: NDArray[np.float32], rate_hz: float) -> list[CarrierReading]:
    """The carrier of each track of some frames (n, tracks)."""
    return _carriers([frames], rate_hz, frames.shape[1])


def _carriers(
    blocks: Iterable[NDArray[np.float32]], rate_hz: float, tracks: int
) -> list[CarrierReading]:
    """Measure the tracks window by window; a rest that is shorter than a window is left out."""
    levels = [np.full((1, tracks), -np.inf)]
    frequencies = [np.full((1, tracks), np.nan)]
    for block in blocks:
        windows = block[: len(block) // WINDOW_FRAMES * WINDOW_FRAMES].reshape(
            -1, WINDOW_FRAMES, tracks
        )
        if len(windows):
            level_db = 10 * np.log10(2 * (windows.astype(float) ** 2).mean(axis=1) + NOT_ZERO)
            levels.append(level_db)
            frequencies.append(
                np.where(level_db > SILENT_DB, _peak_hz(windows, rate_hz), np.nan)
            )
    level, frequency = (np.vstack(rows[1:] or rows) for rows in (levels, frequencies))
    heard = _programme(level)
    return [
        CarrierReading(level[heard, track], frequency[heard, track]) for track in range(tracks)
    ]


def _programme(level_db: Array) -> slice:
    """The windows between two silences of all tracks, without those in which the carriers come or go."""
    from morfax.recorder.sound.programme import LEAST_LEVEL

    quiet_db = 20 * math.log10(LEAST_LEVEL * math.sqrt(2))  # of a sine
    heard = np.flatnonzero((level_db > quiet_db).any(axis=1))
    if len(heard) < 3:
        return slice(None)
    first, last = int(heard[0]), int(heard[-1])
    return slice(first + (first > 0), last + (last == len(level_db) - 1))


def _peak_hz(windows: NDArray[np.float32], rate_hz: float) -> Array:
    """Frequency of the highest peak of each window (windows, frames, tracks), Hz."""
    spectrum = (
        np.abs(np.fft.rfft(windows * np.hanning(WINDOW_FRAMES)[:, None], axis=1)) + NOT_ZERO
    )
    peak = spectrum[:, 1:-1].argmax(axis=1)[:, None] + 1
    left, middle, right = (
        np.log(np.take_along_axis(spectrum, peak + step, axis=1))[:, 0] for step in (-1, 0, 1)
    )
    curve = left - 2 * middle + right
    shift = np.where(curve < 0, (left - right) / (2 * np.where(curve < 0, curve, 1)), 0)
    return np.asarray((peak[:, 0] + shift) * rate_hz / WINDOW_FRAMES)
