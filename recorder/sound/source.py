"""The source and the sink: where frames of sound come from, and where they go, whatever it is.

    file ───┐                                                 ┌─► file     spool.py
    pipe ───┼─► Source ─► frames (n, tracks) ─► … ─► Sink ────┼─► pipe     pipe.py
    device ─┘                                                 └─► device   device.py

Signals: frames in blocks (n, tracks), float32 of full scale 1, or 16-bit samples as they are stored. One
block is held at a time. A live source (a pipe, a device) is read once, and its length is known at its end.

Source: libsndfile (files). Questions: libsndfile takes a WAV that ends early for a shorter one, so the sizes
in its header are read here (riff.py); of other kinds the last frame is read.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path as FilePath
from typing import Protocol

import numpy as np
import soundfile
from numpy.typing import NDArray

from morfax.motion.ending import Ending
from morfax.motion.faults import FileFault, TapeFault
from morfax.motion.files import for_soundfile
from morfax.motion.usual import AT_ONCE
from morfax.recorder.sound.plain import PlainSamples
from morfax.recorder.sound.riff import read_sizes

BLOCK_FRAMES = AT_ONCE  # 1.4 s at 48 kHz, a megabyte of four tracks
LARGEST_SIDECAR_BYTES = 1 << 16  # more is no text of a tape
_INT16_STEP = np.float32(1 / 32768)  # full scale 1

Frames = NDArray[np.float32]
Stored = NDArray[np.float32 | np.int16]
SampleType = type[np.float32] | type[np.int16]


class Source(Protocol):
    """Where frames come from; `name` is what messages call it, `text` what stands beside the frames."""

    name: str
    tracks: int
    rate_hz: int
    text: str
    container: str
    sample: str

    @property
    def frames(self) -> int:
        """Frames in it; of a live source those that have come."""

    def stored_blocks(self, frames: int = BLOCK_FRAMES, first: int = 0) -> Iterator[Stored]:
        """The frames from `first` on in blocks, samples of 16 bit as they are stored."""

    def close(self) -> None:
        """Let go of it."""


class Sink(Ending, Protocol):
    """Where frames go; it ends well only if all are there, and after an error nothing may look whole."""

    @property
    def takes(self) -> SampleType:
        """The kind of samples that it keeps; it takes float32, too."""

    def put(self, frames: Stored) -> None:
        """Take the next frames."""


class FileSource:
    """A sound file of any kind that libsndfile reads: WAV, RF64, FLAC, AIFF, W64, MP3, Ogg Vorbis, Opus.

    Raises FileFault if it cannot be read, TapeFault if it is no sound file, empty or cut short.
    """

    def __init__(self, file: str | os.PathLike[str]) -> None:
        self.file = FilePath(file)
        self.name = str(self.file)
        self._sound = open_sound(self.file)
        try:
            _check_whole(self.file, self._sound)
        except BaseException:
            self._sound.close()
            raise
        self.tracks, self.rate_hz = int(self._sound.channels), int(self._sound.samplerate)
        self.container, self.sample = str(self._sound.format), str(self._sound.subtype)
        self.text = text_of(self.file, self._sound)
        self._plain = PlainSamples.of(self.file, self.container, self.sample, self.tracks)

    @property
    def frames(self) -> int:
        """Frames in the file."""
        return int(self._sound.frames)

    def close(self) -> None:
        """Close the file."""
        self._sound.close()
        if self._plain is not None:
            self._plain.close()

    def stored_blocks(self, frames: int = BLOCK_FRAMES, first: int = 0) -> Iterator[Stored]:
        """The frames from `first` on in blocks; raises TapeFault where the file cannot be read on."""
        if frames < 1:
            raise ValueError(f"a block of {frames} frames holds nothing; it must be at least 1")
        done = first
        try:
            self._sound.seek(first)
        except soundfile.SoundFileError as error:
            raise TapeFault(
                f"{self.file} cannot be wound to frame {first}: {error}; copy the file again"
            ) from error
        while done < self.frames:
            block = self._read(frames, done)
            done += len(block)
            yield block

    def _read(self, frames: int, done: int) -> Stored:
        """The next block; raises TapeFault where the file ends early or cannot be decoded."""
        # libsndfile is slow to make one of the other
        kind = "int16" if self.sample == "PCM_16" else "float32"
        try:
            block: Stored = (
                self._sound.read(frames, dtype=kind, always_2d=True)
                if self._plain is None
                else self._plain.read(done, min(frames, self.frames - done))
            )
        except (soundfile.SoundFileError, OSError) as error:
            raise self._ends_at(done) from error
        if not len(block):
            raise self._ends_at(done)
        return block

    def _ends_at(self, done: int) -> TapeFault:
        """The fault of a file that cannot be read beyond a frame."""
        return _cut_short(self.file, done / self.rate_hz, self.frames / self.rate_hz)


def full_scale(frames: Stored) -> Frames:
    """Samples of full scale 1, whichever way they are stored."""
    return np.asarray(frames * _INT16_STEP if frames.dtype == np.int16 else frames, np.float32)


def sidecar(file: FilePath) -> FilePath:
    """The file beside a W64 that holds its text."""
    return file.with_name(file.name + ".json")


def text_of(file: FilePath, sound: soundfile.SoundFile) -> str:
    """The text chunk, or the text of the file beside it (a W64 has no text chunk)."""
    text = str(sound.comment)
    if text.strip():
        return text
    try:
        with sidecar(file).open("rb") as beside:
            return beside.read(LARGEST_SIDECAR_BYTES).decode("utf-8", "replace")
    except OSError:
        return ""


def open_sound(file: FilePath) -> soundfile.SoundFile:
    """The sound file; raises FileFault if it cannot be read, TapeFault if it is no sound file."""
    try:
        with file.open("rb") as opened:
            empty = not opened.read(1)
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from error
    if empty:
        raise TapeFault(f"{file} is empty; a tape is a WAV, RF64 or FLAC file")
    try:
        return soundfile.SoundFile(for_soundfile(file))
    except (
        soundfile.SoundFileError,
        TypeError,
    ) as error:  # TypeError: of a .raw it wants to be told everything
        raise TapeFault(
            f"{file} is no tape: it is not a sound file that can be read; give a WAV, RF64 or FLAC"
        ) from error


def _check_whole(file: FilePath, sound: soundfile.SoundFile) -> None:
    """Raise TapeFault for a file that is empty or cut short."""
    sizes = read_sizes(file)
    if sizes is not None and sizes.stated is not None and sizes.cut_short:
        frame_s = 1 / sound.samplerate
        stated_s = sizes.stated / max(sizes.held, 1) * sound.frames * frame_s
        raise _cut_short(file, sound.frames * frame_s, stated_s)
    if not sound.frames:
        raise TapeFault(f"{file} holds no frames; record the tape again")
    if sizes is None:
        _check_last_frame(file, sound)


def _check_last_frame(file: FilePath, sound: soundfile.SoundFile) -> None:
    """Raise TapeFault unless the last frame can be read; for files whose header states no length."""
    try:
        sound.seek(sound.frames - 1)
        there = len(sound.read(1)) == 1
    except soundfile.SoundFileError:
        there = False
    if not there:
        raise TapeFault(
            f"{file} is cut short: its last frame is missing; copy the file again or record it again"
        )


def _cut_short(file: FilePath, held_s: float, stated_s: float) -> TapeFault:
    """The fault of a file that is shorter than its header states."""
    message = (
        f"{file} is cut short: {held_s:.3f} s of {stated_s:.3f} s are there; "
        "copy the file again or record it again"
    )
    return TapeFault(message, time_s=held_s)
