"""The tape as it is read: tracks in blocks, with the format that its text chunk states.

Signals: a source of sound in (a file, a pipe, a device: recorder/sound); frames (n, tracks) out, full scale
1, columns reference, X, Y, Z. One block is held at a time, however long the tape.

Source: patent ES 361967, figure 5 (the tracks that the machine is given).
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import replace
from typing import Unpack

from morfax.motion.ending import Ending
from morfax.motion.faults import TapeFault
from morfax.recorder.sound.pipe import FEWEST_TRACKS
from morfax.recorder.sound.programme import Programme, without_silence
from morfax.recorder.sound.source import (
    BLOCK_FRAMES,
    FileSource,
    Frames,
    Source,
    Stored,
    full_scale,
)
from morfax.recorder.tape.format import TapeFormat, columns_of
from morfax.recorder.tape.recording import Recording, record
from morfax.recorder.tape.stated import TapeEntries, allowed, format_of, started

__all__ = ["Recording", "Stored", "Tape", "TapeFormat", "full_scale", "record"]


class Tape(Ending):
    """An open tape; a context manager. One from a pipe or a device is read once."""

    def __init__(
        self, source: Source, fmt: TapeFormat, columns: list[int] | None = None
    ) -> None:
        self.source, self.format, self._columns = source, fmt, columns

    @classmethod
    def open(cls, file: str | os.PathLike[str], **by_hand: Unpack[TapeEntries]) -> Tape:
        """Open a tape in a file.

        Raises FileFault if the file cannot be read, TapeFault if it is no tape, cut short, empty or of
        unknown format.
        """
        return cls.of(FileSource(file), **by_hand)

    @classmethod
    def of(cls, source: Source, **by_hand: Unpack[TapeEntries]) -> Tape:
        """The tape in a source, with what is given of it by hand.

        Raises TapeFault if it has too few tracks, or is of unknown format; the source is closed then.
        """
        try:
            _check_tracks(source)
            source = without_silence(source) if isinstance(source, FileSource) else source
            fmt = started(format_of(source, by_hand), by_hand.get("start_mm"))
            fmt = allowed(fmt, by_hand.get("still"), by_hand.get("alike"))
            if isinstance(source, Programme):
                fmt = replace(fmt, dwell_s=max(fmt.dwell_s, source.stands_s))
            return cls(source, fmt, columns_of(by_hand.get("order"), fmt.tracks))
        except BaseException:
            source.close()
            raise

    def end(self, error: BaseException | None) -> None:
        """Close the source."""
        self.close()

    def close(self) -> None:
        """Close the source."""
        self.source.close()

    @property
    def frames(self) -> int:
        """Frames on the tape; from a pipe or a device those that have come."""
        return self.source.frames

    @property
    def duration_s(self) -> float:
        """Length of the tape, s."""
        return self.frames / self.format.sample_rate_hz

    @property
    def container(self) -> str:
        """Kind of file: WAV, WAVEX, RF64 or FLAC."""
        return self.source.container

    @property
    def sample(self) -> str:
        """Kind of sample: PCM_16, PCM_24, PCM_32 or FLOAT."""
        return self.source.sample

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be told of how it was opened: silence that was left out."""
        return self.source.notes if isinstance(self.source, Programme) else ()

    @property
    def text(self) -> str:
        """The text chunk as it stands in the file; empty if there is none."""
        return self.source.text.strip()

    def blocks(self, frames: int = BLOCK_FRAMES, first: int = 0) -> Iterator[Frames]:
        """The tape from frame `first` on in blocks (n, tracks) of so many frames, the last one shorter."""
        return map(full_scale, self.stored_blocks(frames, first))

    def stored_blocks(self, frames: int = BLOCK_FRAMES, first: int = 0) -> Iterator[Stored]:
        """The same, but samples of 16 bit as they are stored."""
        blocks = self.source.stored_blocks(frames, first)
        return blocks if self._columns is None else self._ordered(blocks, self._columns)

    @staticmethod
    def _ordered(blocks: Iterator[Stored], columns: list[int]) -> Iterator[Stored]:
        """The blocks with their tracks in order."""
        for block in blocks:
            yield block[:, columns]


def _check_tracks(source: Source) -> None:
    """Raise TapeFault for too few tracks."""
    if source.tracks >= FEWEST_TRACKS:
        return
    tracks = "one track" if source.tracks == 1 else f"{source.tracks} tracks"
    raise TapeFault(
        f"{source.name} has {tracks}; a tape has at least {FEWEST_TRACKS}: reference, X, Y (give the other "
        "file of two stereo files with --second)"
    )
