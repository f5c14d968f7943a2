"""The codec: a tape that was sent or kept as MP3 or Opus, in stereo files of two tracks each.

Signals: frames float32 (n, tracks), full scale 1, in blocks in and out, as many as came in. Every two tracks
are coded together, as a stereo file, with joint stereo where the coder likes; both files lose the same few
frames at their start, which the decoder takes away again.

    mp3-64     MPEG-1 Layer III, constant 64 kbit/s for two tracks    LAME, by way of libsndfile
    mp3-128    the same, 128 kbit/s
    opus-64    Opus, about 64 kbit/s for two tracks                   libopus, by way of libsndfile

Source: ISO/IEC 11172-3; RFC 6716. Questions: at 64 kbit/s the program `lame` goes down to a sample rate of 24
kHz unless told, which leaves the carriers more of the bits; here the rate stays.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import soundfile
from numpy.typing import NDArray

from morfax.motion.files import for_soundfile
from morfax.recorder.sound.source import BLOCK_FRAMES

Frames = NDArray[np.float32]

# kind of file and of sample, and what libsndfile is told: of MP3, 320 kbit/s less 288 times the level
CODECS: dict[str, tuple[str, str, dict[str, Any]]] = {
    "mp3-64": (
        "MP3",
        "MPEG_LAYER_III",
        {"compression_level": 0.888, "bitrate_mode": "CONSTANT"},
    ),
    "mp3-128": (
        "MP3",
        "MPEG_LAYER_III",
        {"compression_level": 0.666, "bitrate_mode": "CONSTANT"},
    ),
    "opus-64": ("OGG", "OPUS", {"compression_level": 0.9}),
}
STEREO = 2  # tracks of a file


def coded(blocks: Iterable[Frames], rate_hz: int, tracks: int, codec: str) -> Iterator[Frames]:
    """The frames as they come out of a codec again; raises SoundFileError where it cannot be."""
    kind, sample, how = CODECS[codec]
    with tempfile.TemporaryDirectory(prefix="morfax-") as folder:
        columns = [slice(at, at + STEREO) for at in range(0, tracks, STEREO)]
        files = [Path(folder) / f"{at}" for at in range(len(columns))]
        with ExitStack() as opened:
            sinks = [
                opened.enter_context(
                    soundfile.SoundFile(
                        for_soundfile(file),
                        "w",
                        rate_hz,
                        min(STEREO, tracks - part.start),
                        sample,
                        format=kind,
                        **how,
                    )
                )
                for file, part in zip(files, columns, strict=True)
            ]
            count = 0
            for block in blocks:
                count += len(block)
                for sink, part in zip(sinks, columns, strict=True):
                    sink.write(np.ascontiguousarray(block[:, part]))
        with ExitStack() as opened:
            sources = [
                opened.enter_context(soundfile.SoundFile(for_soundfile(file))) for file in files
            ]
            while count > 0:
                parts = [
                    source.read(min(count, BLOCK_FRAMES), dtype="float32", always_2d=True)
                    for source in sources
                ]
                length = min(map(len, parts))
                if not length:
                    return
                count -= length
                yield np.hstack([part[:length] for part in parts])
