"""Tapes without a text chunk, as a sound program writes them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import soundfile

from morfax.player.tape.playback import TapePlayback, play
from tests.player.carriers import (
    CYCLES_PER_MM,
    RATE_HZ,
    REFERENCE_HZ,
)

SECONDS = 1.5


def tape(file: Path, frames: np.ndarray, rate_hz: int = RATE_HZ) -> Path:
    """A tape without a text chunk, 16 bit."""
    soundfile.write(file, frames, rate_hz, subtype="PCM_16")
    return file


def by_hand(file: Path, start_mm: tuple[float, ...] | None = None) -> TapePlayback:
    """Play such a tape."""
    return play(file, reference_hz=REFERENCE_HZ, cycles_per_mm=CYCLES_PER_MM, start_mm=start_mm)
