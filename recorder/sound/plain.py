"""Plain samples: the frames of a WAV of 16 bit or float32 as they stand in the file, without a converter.

Signals in: a WAV, WAVEX or RF64 with samples of 16 bit or float32. Signals out: frames (n, tracks) in blocks,
samples as they are stored. libsndfile goes over such samples twice more, which takes as long as making phases
of them.

Source: the chunks of riff.py. Questions: a memory map would not even copy them, but a file that is cut short
while it is mapped kills the process that reads it; a read of it comes back short.
"""

from __future__ import annotations

from io import FileIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from morfax.recorder.sound.riff import read_sizes

CONTAINERS = ("WAV", "WAVEX", "RF64")
SAMPLES: dict[str, np.dtype[Any]] = {
    "PCM_16": np.dtype("<i2"),
    "FLOAT": np.dtype("<f4"),
}  # as they stand in the file


class PlainSamples:
    """The frames of one open file."""

    def __init__(
        self, opened: FileIO, first_byte: int, kind: np.dtype[Any], tracks: int
    ) -> None:
        self._opened, self._first_byte = opened, first_byte
        self._kind, self._tracks = kind, tracks

    @classmethod
    def of(cls, file: Path, container: str, sample: str, tracks: int) -> PlainSamples | None:
        """The frames of a file, of the kind that libsndfile says; None for kinds that need a converter."""
        kind = SAMPLES.get(sample)
        if container not in CONTAINERS or kind is None or not kind.isnative:
            return None
        sizes = read_sizes(file)
        if sizes is None:
            return None
        return cls(FileIO(file), sizes.data_at, kind, tracks)

    def read(self, first: int, count: int) -> NDArray[np.float32 | np.int16]:
        """At most so many frames from one on; fewer where the file ends."""
        frames = np.empty((count, self._tracks), self._kind)
        self._opened.seek(self._first_byte + first * frames.strides[0])
        left = frames.data.cast("B")
        while len(left) and (got := self._opened.readinto(left)):
            left = left[got:]
        return frames[: count - -(-len(left) // frames.strides[0])]

    def close(self) -> None:
        """Close the file."""
        self._opened.close()

    def __del__(self) -> None:
        """Close the file that nobody closed, as soundfile does with its own."""
        self._opened.close()
