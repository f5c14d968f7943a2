"""The levels of a tape's tracks over its time, as the panel's fourth scope shows them: dropouts are dips.

Signals in: a tape (WAV, RF64, FLAC). Signals out: for each of `COLUMNS` stretches the effective level (RMS)
of each track, as a share of full scale.
"""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import numpy as np

from morfax.motion.files import for_soundfile

COLUMNS = 800  # stretches: more than a scope has pixels
NAMES = ("reference", "X", "Y", "Z")
DECIMALS = 4


def levels(tape: FilePath) -> dict[str, Any] | None:
    """Levels of a tape's tracks; None for a file that is no tape."""
    import soundfile

    if tape.suffix.lower() not in (".wav", ".rf64", ".flac"):
        return None
    with soundfile.SoundFile(for_soundfile(tape)) as opened:
        frames = max(1, -(-opened.frames // COLUMNS))
        rows = [
            np.sqrt(np.mean(np.square(b), axis=0))
            for b in opened.blocks(frames, dtype="float32", always_2d=True)
        ]
        seconds = frames / opened.samplerate
    if not rows:
        return None
    table = np.round(np.array(rows), DECIMALS)
    return {
        "tracks": list(NAMES[: table.shape[1]]),
        "t_s": np.round(seconds * (0.5 + np.arange(len(table))), DECIMALS).tolist(),
        "level": table.T.tolist(),
    }
