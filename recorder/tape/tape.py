"""The tape as it is read: tracks in blocks, with the format that its text chunk states.

Signals: a WAV, RF64 or FLAC in; float32 frames (n, tracks) out, full scale 1, columns reference, X, Y, Z. One
block is held at a time, however long the tape.

Source: patent ES 361967, figure 5 (the tracks that the machine is given).
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path as FilePath
from types import TracebackType

import numpy as np
import soundfile
from numpy.typing import NDArray

from morfax.motion.faults import FileFault, TapeFault
from morfax.motion.files import for_soundfile
from morfax.recorder.tape.carrier import Frames
from morfax.recorder.tape.format import TapeFormat, columns_of
from morfax.recorder.tape.recording import Recording, record
from morfax.recorder.tape.riff import read_sizes
from morfax.recorder.tape.stated import allowed, format_of, started, text_of

__all__ = ["Recording", "Tape", "TapeFormat", "record"]

BLOCK_FRAMES = 65536  # 1.4 s at 48 kHz, a megabyte of four tracks
_FEWEST_TRACKS = 3  # reference, X, Y
_INT16_STEP = np.float32(1 / 32768)  # full scale 1
Stored = NDArray[np.float32 | np.int16]


class Tape:
    """An open tape; a context manager."""

    def __init__(
        self,
        file: FilePath,
        sound: soundfile.SoundFile,
        fmt: TapeFormat,
        columns: list[int] | None = None,
    ) -> None:
        self.file, self.format, self._sound, self._columns = file, fmt, sound, columns

    @classmethod
    def open(
        cls,
        file: str | os.PathLike[str],
        *,
        reference_hz: float | None = None,
        cycles_per_mm: float | None = None,
        start_mm: Sequence[float] | None = None,
        order: Sequence[int] | None = None,
        still: Sequence[str] | None = None,
        alike: Sequence[str] | None = None,
    ) -> Tape:
        """Open a tape; values given by hand override its text chunk; a start X, Y leaves Z as it is.

        `order`: the tracks of the file, from 1, on which reference, X, Y … are, where it is not this order.
        `still`, `alike`: axes that may stand from start to end, and that may run alike.

        Raises FileFault if the file cannot be read, TapeFault if it is no tape, cut short, empty or of
        unknown format.
        """
        sound = _open_sound(FilePath(file))
        try:
            _check_whole(FilePath(file), sound)
            fmt = format_of(
                FilePath(file),
                sound,
                {"reference_hz": reference_hz, "cycles_per_mm": cycles_per_mm},
            )
            fmt = allowed(started(fmt, start_mm), still, alike)
            return cls(FilePath(file), sound, fmt, columns_of(order, fmt.tracks))
        except BaseException:
            sound.close()
            raise

    def __enter__(self) -> Tape:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        self._sound.close()

    @property
    def frames(self) -> int:
        """Frames on the tape."""
        return int(self._sound.frames)

    @property
    def duration_s(self) -> float:
        """Length of the tape, s."""
        return self.frames / self.format.sample_rate_hz

    @property
    def container(self) -> str:
        """Kind of file: WAV, WAVEX, RF64 or FLAC."""
        return str(self._sound.format)

    @property
    def sample(self) -> str:
        """Kind of sample: PCM_16, PCM_24, PCM_32 or FLOAT."""
        return str(self._sound.subtype)

    @property
    def text(self) -> str:
        """The text chunk as it stands in the file; empty if there is none."""
        return text_of(self.file, self._sound).strip()

    def blocks(self, frames: int = BLOCK_FRAMES, first: int = 0) -> Iterator[Frames]:
        """The tape from frame `first` on in blocks (n, tracks) of so many frames, the last one shorter."""
        return map(full_scale, self.stored_blocks(frames, first))

    def stored_blocks(self, frames: int = BLOCK_FRAMES, first: int = 0) -> Iterator[Stored]:
        """The same, but samples of 16 bit as they are stored."""
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
        kind = "int16" if self._sound.subtype == "PCM_16" else "float32"
        try:
            block: Stored = self._sound.read(frames, dtype=kind, always_2d=True)
        except soundfile.SoundFileError as error:
            raise _cut_short(
                self.file, done / self.format.sample_rate_hz, self.duration_s
            ) from error
        if not len(block):
            raise _cut_short(self.file, done / self.format.sample_rate_hz, self.duration_s)
        return block if self._columns is None else block[:, self._columns]


def full_scale(frames: Stored) -> Frames:
    """Samples of full scale 1, whichever way they are stored."""
    return np.asarray(frames * _INT16_STEP if frames.dtype == np.int16 else frames, np.float32)


def _open_sound(file: FilePath) -> soundfile.SoundFile:
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
    """Raise TapeFault for a file that is empty, cut short or has too few tracks."""
    if sound.channels < _FEWEST_TRACKS:
        tracks = "one track" if sound.channels == 1 else f"{sound.channels} tracks"
        raise TapeFault(
            f"{file} has {tracks}; a tape has at least {_FEWEST_TRACKS}: reference, X, Y"
        )
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
