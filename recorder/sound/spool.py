"""The spool: a sound file being written, of whatever kind its name asks for, that cannot end as half a tape.

Signals: frames float32 (n, tracks), full scale 1, in blocks in; a WAV (RF64 inside while it grows), RF64,
W64, FLAC or AIFF out. The text goes into the header before the first frame, as a FLAC takes it nowhere else.
A W64 has no place for a text: it goes into a file beside it, `cam.w64.json` (source.sidecar).

Source: EBU Tech 3306 (RF64); Apple, Audio Interchange File Format 1.3; Sonic Foundry, Wave64 file format 2.
Questions: a plain WAV and an AIFF count their bytes with 32 bits. The first is written as an RF64 until it is
known to be small enough; the second has no larger kind and is refused beyond its size.
"""

from __future__ import annotations

from pathlib import Path as FilePath

import numpy as np
import soundfile

from morfax.motion.ending import Ending
from morfax.motion.faults import FileFault, TapeFault
from morfax.motion.files import for_soundfile
from morfax.recorder.sound.sixteen_bit import in_16_bit
from morfax.recorder.sound.source import SampleType, Stored

CONTAINERS = {
    ".wav": "RF64",
    ".rf64": "RF64",
    ".flac": "FLAC",
    ".w64": "W64",
    ".aiff": "AIFF",
    ".aif": "AIFF",
}
SUBTYPES = {"16": "PCM_16", "24": "PCM_24", "32": "PCM_32", "float": "FLOAT"}
MOST_FLAC_TRACKS = 8  # FLAC, format specification: channels 1 to 8
LARGEST_AIFF_BYTES = 2**31 - 2**16  # sizes in an AIFF are signed
_SAMPLE_BYTES = {"PCM_16": 2, "PCM_24": 3, "PCM_32": 4, "FLOAT": 4}


def medium(file: FilePath, sample: str) -> tuple[str, str]:
    """Container and kind of sample by the file's name; raises FileFault, TapeFault, ValueError."""
    if sample not in SUBTYPES:
        raise ValueError(f"sample is {sample!r}; it must be one of {', '.join(SUBTYPES)}")
    suffix = file.suffix.lower()
    if suffix not in CONTAINERS:
        raise FileFault(
            f"cannot write {file}: a tape's name ends in {', '.join(CONTAINERS)}; give it one of these"
        )
    if suffix == ".flac" and sample not in ("16", "24"):
        raise TapeFault(
            f"a FLAC has no samples of {sample}; it takes 16 or 24 bit: write a .wav for more"
        )
    return CONTAINERS[suffix], SUBTYPES[sample]


class Spool(Ending):
    """A sound file that is being written; a context manager. Raises SoundFileError when the disk is full."""

    def __init__(
        self,
        file: FilePath,
        rate_hz: int,
        tracks: int,
        kind: tuple[str, str],
        text: str,
        *,
        name: FilePath | None = None,
    ) -> None:
        container, subtype = kind
        if container == "FLAC" and tracks > MOST_FLAC_TRACKS:
            raise TapeFault(
                f"a FLAC holds at most {MOST_FLAC_TRACKS} tracks, these are {tracks}; write a .wav, "
                ".rf64 or .w64"
            )
        self._file, self._name, self._container = file, name or file, container
        self._frame_bytes = tracks * _SAMPLE_BYTES[subtype]
        self._sound = soundfile.SoundFile(
            for_soundfile(file), "w", rate_hz, tracks, subtype, format=container
        )
        self.frames = 0
        self.takes: SampleType = np.int16 if subtype == "PCM_16" else np.float32
        if text and container != "W64":
            self._sound.comment = text

    def end(self, error: BaseException | None) -> None:
        """Close the file; it is whole if nothing went wrong."""
        self._sound.close()
        if error is None:
            self._check_whole()

    def put(self, frames: Stored) -> None:
        """Write frames; raises SoundFileRuntimeError on a full disk, TapeFault beyond an AIFF's size."""
        self.frames += len(frames)
        if self._container == "AIFF" and self.frames * self._frame_bytes > LARGEST_AIFF_BYTES:
            raise TapeFault(
                f"cannot write {self._name}: an AIFF ends at 2 GiB; write a .wav, .rf64, .w64 or .flac"
            )
        try:
            if self.takes is np.int16:
                self._sound.buffer_write(in_16_bit(frames), "int16")
            else:
                self._sound.write(frames)
        except AssertionError:  # soundfile asserts that libsndfile wrote all of it
            raise soundfile.SoundFileRuntimeError("not all frames were written") from None

    def _check_whole(self) -> None:
        """Raise SoundFileError unless the last frame is there: a FLAC meets a full disk only on closing."""
        if not self.frames:
            return
        with soundfile.SoundFile(for_soundfile(self._file)) as written:
            written.seek(self.frames - 1)
            if written.frames != self.frames or len(written.read(1)) != 1:
                raise soundfile.SoundFileRuntimeError("the last frame is missing")
