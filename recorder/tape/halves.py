"""A tape in two stereo files, for recorders of two tracks: reference and X in one, Y and Z in the other.

Signals: Motion in; `cam.1-2.wav` and `cam.3-4.wav` out, of the name `cam.wav`. Each has the text chunk of the
whole tape, so that either says what the tape is; the player joins them (player/tape/stereo.py).

Source: our own.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path as FilePath

import numpy as np
import soundfile

from morfax.motion.ending import Ending
from morfax.motion.faults import TapeFault
from morfax.motion.files import disk_full_fault, written_beside
from morfax.motion.motion import Motion, Path
from morfax.recorder.sound.source import SampleType, Stored
from morfax.recorder.sound.spool import Spool, medium
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.tape.recording import (
    LiveRecording,
    finish,
    placeholder,
    record_live,
)

TRACKS = 2  # of a file


@dataclass(frozen=True)
class Halves(Ending):
    """A sink that shares its tracks out to two."""

    spools: tuple[Spool, Spool]
    takes: SampleType = np.int16

    def end(self, error: BaseException | None) -> None:
        """End both."""
        with (
            ExitStack() as ends
        ):  # the second is closed where the first one's end is a fault, too
            for spool in self.spools:
                ends.callback(spool.end, error)

    def put(self, frames: Stored) -> None:
        """Take the next frames."""
        for half, spool in enumerate(self.spools):
            spool.put(frames[:, TRACKS * half : TRACKS * (half + 1)].copy())


def half_names(file: FilePath) -> tuple[FilePath, FilePath]:
    """The names of the two files of a tape."""
    one, other = (
        file.with_name(f"{file.stem}.{tracks}{file.suffix}") for tracks in ("1-2", "3-4")
    )
    return one, other


def record_halves(
    stream: Iterable[Motion] | Motion | Path, file: FilePath, fmt: TapeFormat
) -> LiveRecording:
    """Record a motion in two stereo files; raises what `record` raises, TapeFault but for four tracks."""
    if fmt.tracks != 2 * TRACKS:
        raise TapeFault(
            f"two stereo files hold four tracks, and this tape has {fmt.tracks}; record it in one file"
        )
    kind, names = medium(file, "16"), half_names(file)
    with ExitStack() as files:
        besides = [files.enter_context(written_beside(name)) for name in names]

        def open_halves(begun: TapeFormat) -> Halves:
            one, other = (
                Spool(beside, begun.sample_rate_hz, TRACKS, kind, placeholder(begun), name=name)
                for beside, name in zip(besides, names, strict=True)
            )
            return Halves((one, other))

        try:
            done = record_live(stream, open_halves, fmt)
        except soundfile.SoundFileError as error:
            raise disk_full_fault(file) from error
        for beside, name in zip(besides, names, strict=True):
            finish(beside, done.format, name)
    return done
