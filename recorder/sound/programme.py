"""The programme: what stands between two silences of sound that comes from a recorder.

    silence, hiss      carriers on all tracks                     silence, hiss
    ______________/‾‾‾|‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾‾\\_______________
                  0.2 s                                   |   0.5 s
                      the programme                       |

Signals: frames (n, tracks) of full scale 1 in blocks in; those of the programme out, without a hole. It
begins 0.2 s after all tracks have come up, when the recorder's own levels and speed have settled, and ends
40 ms before all tracks fall by 12 dB and stay there for half a second; what is shorter is a dropout, and is
given out. Of a file only an end at which all tracks are silent is cut: one silent track is damage.

Source: our own. Questions: a gap of half a second on all tracks ends the tape; its check signal, or its end,
then says that it is not whole.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import DeviceFault
from morfax.recorder.sound.source import BLOCK_FRAMES, FileSource, Frames, Stored, full_scale

WINDOW_S = 0.02  # in which a level is told: 100 cycles of a carrier
SETTLING = 10  # windows of carriers before the programme begins, 0.2 s: chosen
GONE = 25  # windows of silence that end it, 0.5 s
MARGIN = 2  # windows before the silence that are left out: the carriers fade in one of them
LEAST_LEVEL = 0.005  # RMS of a track that has a carrier, -46 dB of full scale: below lies hiss
GONE_SHARE = 0.25  # of the level: 12 dB down


def between_silences(
    blocks: Iterator[Frames], rate_hz: int, wait_s: float, name: str
) -> Iterator[Frames]:
    """The frames of the programme; raises DeviceFault if no carriers come within `wait_s`."""
    window = round(WINDOW_S * rate_hz)
    carriers = _Carriers(wait_s, name)
    left: Frames | None = None
    for block in blocks:
        # 1. whole windows, and the level of each track in each
        frames = block if left is None else np.concatenate([left, block])
        count = len(frames) // window
        rms = _levels(frames[: count * window], window)
        # 2. wait for the carriers, and follow them until they are gone
        begin = carriers.begin(rms)
        gone = carriers.gone(rms[begin:])
        if gone is not None:
            yield frames[begin * window : (begin + max(gone - MARGIN, 0)) * window]
            return
        # 3. what may be the beginning of the last silence waits for the next block, and is heard again
        end = (count - carriers.held(count - begin)) * window
        out = frames[begin * window : end]
        left = frames[end:]
        if len(out):
            yield out
    if carriers.level is not None and left is not None and len(left):
        yield left


@dataclass(slots=True)
class _Carriers:
    """The carriers of the tracks, as they come up and go."""

    wait_s: float
    name: str
    level: Array | None = None  # RMS of each track (tracks,), since the programme has begun
    up: int = 0  # windows in a row
    waited: int = 0  # windows
    silent: int = 0  # windows in a row, those heard again not counted

    def begin(self, rms: Array) -> int:
        """The first window of the programme among these (windows, tracks); their number if there is none."""
        if self.level is not None:
            return 0
        for at, levels in enumerate(rms):
            self.up = self.up + 1 if (levels > LEAST_LEVEL).all() else 0
            self.waited += 1
            if self.up > SETTLING:
                self.level = levels
                return at
            if self.waited * WINDOW_S > self.wait_s:
                raise DeviceFault(_nothing(self.name, self.wait_s, levels), device=self.name)
        return len(rms)

    def gone(self, rms: Array) -> int | None:
        """The window at which the carriers have gone for good; None if they go on."""
        if self.level is None:
            return None
        for at, levels in enumerate(rms):
            self.silent = self.silent + 1 if (levels < GONE_SHARE * self.level).all() else 0
            if self.silent >= GONE:
                return at + 1 - GONE
        return None

    def held(self, count: int) -> int:
        """How many of the last windows, of so many of the programme, may belong to the silence after it."""
        held = 0 if self.level is None else min(self.silent + MARGIN, count)
        self.silent = 0
        return held


def _levels(frames: Frames, window: int) -> Array:
    """Root mean square of each track in each window (windows, tracks)."""
    windows = frames.reshape(-1, window, frames.shape[1]).astype(np.float64)
    return np.asarray(np.sqrt((windows**2).mean(axis=1)))


def _nothing(name: str, wait_s: float, rms: Array) -> str:
    """What to say when no carriers come: the levels tell which track is silent."""
    levels = ", ".join(f"{20 * np.log10(max(each, 1e-5)):.0f}" for each in rms * np.sqrt(2))
    return (
        f"no tape came from {name} in {wait_s:g} s: its tracks are at {levels} dB of full scale, and a "
        "carrier is above -43 dB; start the recorder, check cables and levels (morfax devices --meters)"
    )


def programme_within(blocks: Iterator[Stored], rate_hz: int) -> tuple[int, int] | None:
    """The first frame of a recording's programme and the one behind its last; None for silence."""
    window, left, levels = round(WINDOW_S * rate_hz), None, []
    for block in blocks:
        frames = full_scale(block)
        frames = frames if left is None else np.concatenate([left, frames])
        count = len(frames) // window
        left = frames[count * window :]
        levels.append(_levels(frames[: count * window], window))
    if sum(map(len, levels)) < SETTLING:
        return None
    level = np.concatenate(levels)
    up = np.asarray((level > LEAST_LEVEL).all(axis=1))
    runs = np.flatnonzero(np.convolve(up, np.ones(SETTLING), "valid") == SETTLING)
    if not len(runs):
        return None
    first = int(runs[0])
    last = int(np.flatnonzero(up)[-1]) + 1
    first += (
        SETTLING if first else 0
    )  # a recording that begins with carriers has no silence to leave
    last -= MARGIN if last < len(up) else 0
    return first * window, max(last, first) * window


class Programme:
    """A sound file without the silence before and behind its programme, as a source; `notes` tell of it.

    What begins within silence has to stand for `stands_s`: the start of a tape may be missing.
    """

    stands_s = SETTLING * WINDOW_S  # as long as its carriers have had to settle

    def __init__(self, file: FileSource, first: int, end: int) -> None:
        self._file, self._first, self.frames = file, first, end - first
        self.name, self.tracks, self.rate_hz = file.name, file.tracks, file.rate_hz
        self.text, self.container, self.sample = file.text, file.container, file.sample
        ends = ((first, "before"), (file.frames - end, "behind"))
        silent = [f"{count / file.rate_hz:.2f} s {where} it" for count, where in ends if count]
        self.notes = (
            f"{file.name}: the tape stands between silences; {' and '.join(silent)} are left out, and "
            "times count from where it begins",
        )

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def stored_blocks(self, frames: int = BLOCK_FRAMES, first: int = 0) -> Iterator[Stored]:
        """The frames of the programme from `first` on in blocks."""
        left = self.frames - first
        for block in self._file.stored_blocks(frames, self._first + first):
            if left <= 0:
                return
            yield block[:left]
            left -= len(block)


def without_silence(file: FileSource) -> FileSource | Programme:
    """The file, or its programme if it begins or ends in silence on all tracks."""
    window = round(WINDOW_S * file.rate_hz)
    if file.frames < SETTLING * window:
        return file
    before, behind = (
        (_levels(full_scale(next(file.stored_blocks(window, at))), window) < LEAST_LEVEL).all()
        for at in (0, file.frames - window)
    )
    found = programme_within(file.stored_blocks(), file.rate_hz) if before or behind else None
    if found is None or found[0] == found[1]:
        return file
    return Programme(file, found[0] if before else 0, found[1] if behind else file.frames)
