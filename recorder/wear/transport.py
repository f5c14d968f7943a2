"""The transport: what a real recorder, its tape and the years do to a tape.

Signals: a sound file in, the worn sound file out, in blocks of constant size; the text chunk goes along. Each
part stands by itself and does nothing at its default; what a maker states of a kind of machine is a named
set.

    programme ─► distortion ─► crosstalk ─► print-through ─► dropouts ─► head (speed, flutter, skew)
              ─► level, unevenness ─► bandwidth ─► hum, DC, noise ─► order, polarity ─► clipping ─► codec
              ─► worn tape

The worn tape starts at `cut_start_s` of the programme and ends `cut_end_s` before its end. All chance comes
from one seed, part by part, so that a part is the same whatever the others are, and however long the blocks.

Source: patent ES 361967 (the tape goes from one machine to another); figures and their sources:
docs/background/transport.md. Questions: wow and flutter are given unweighted, root mean square. A head's
azimuth makes skew that grows evenly from track to track; weave is the tape wandering in its guides, in the
same proportion.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path as FilePath

import numpy as np
import soundfile
from numpy.typing import NDArray

from morfax.motion.faults import TapeFault
from morfax.motion.files import disk_full_fault, written_beside
from morfax.recorder.sound.riff import make_plain
from morfax.recorder.sound.source import open_sound, sidecar, text_of
from morfax.recorder.sound.spool import Spool, medium
from morfax.recorder.wear.codec import BLOCK_FRAMES, coded
from morfax.recorder.wear.settings import Wear, check
from morfax.recorder.wear.signal import (
    BandLimit,
    Dropout,
    Dropouts,
    PrintThrough,
    Unevenness,
    crosstalk,
    distorted,
    gain,
    hum,
)
from morfax.recorder.wear.timebase import (
    FLUTTER_HZ,
    SCRAPE_HZ,
    WEAVE_HZ,
    WOW_HZ,
    Head,
    Timebase,
    Tones,
)

END_FRAMES = 1e-3  # rounding of a place at the very end

Frames = NDArray[np.float32]
Progress = Callable[[float, float | None], None]


@dataclass(frozen=True, slots=True)
class Aged:
    """The worn tape: file, length in frames, the time base of the transport, and the dropouts in it."""

    file: FilePath
    frames: int
    sample_rate_hz: int
    timebase: Timebase
    dropouts: tuple[Dropout, ...]

    @property
    def duration_s(self) -> float:
        """Length of the worn tape, s."""
        return self.frames / self.sample_rate_hz


def age(
    file: str | os.PathLike[str],
    worn: str | os.PathLike[str],
    wear: Wear,
    seed: int = 0,
    sample: str = "16",
    progress: Progress | None = None,
) -> Aged:
    """Wear a tape; raises FileFault or TapeFault for a bad file, ValueError for bad settings."""
    source, target = FilePath(file), FilePath(worn)
    with open_sound(source) as sound:
        return _aged(sound, source, target, wear, seed, sample, progress)


def _aged(
    sound: soundfile.SoundFile,
    source: FilePath,
    target: FilePath,
    wear: Wear,
    seed: int,
    sample: str,
    progress: Progress | None,
) -> Aged:
    """Run an open tape through the transport into a file."""
    kind = medium(target, sample)
    deck = Deck(wear, sound.samplerate, sound.channels, seed)
    rate_hz = wear.stamped_hz or sound.samplerate
    total_s = sound.frames / sound.samplerate
    text = text_of(source, sound)
    with written_beside(target) as beside:
        with (
            _written(target),
            Spool(beside, rate_hz, sound.channels, kind, text, name=target) as out,
        ):
            worn = deck.frames(_cut(sound, wear))
            if wear.codec is not None:
                worn = coded(worn, sound.samplerate, sound.channels, wear.codec)
            for frames in worn:
                out.put(frames)
                if progress is not None:
                    progress(min(out.frames / sound.samplerate, total_s), total_s)
        if target.suffix.lower() == ".wav":
            make_plain(beside)
        if target.suffix.lower() == ".w64" and text.strip():
            with written_beside(sidecar(target)) as words:
                words.write_text(text, encoding="utf-8")
    return Aged(target, out.frames, rate_hz, deck.timebase, tuple(deck.dropouts))


class Deck:
    """A worn tape machine: frames of the programme in, frames as played out."""

    def __init__(self, wear: Wear, rate_hz: float, tracks: int, seed: int) -> None:
        check(wear, tracks)
        self._wear, self._rate_hz, self._tracks = wear, rate_hz, tracks
        bands = ((wear.wow, WOW_HZ), (wear.flutter, FLUTTER_HZ), (wear.scrape, SCRAPE_HZ))
        tones = [
            Tones.drawn(rms, band, np.random.default_rng((seed, i)))
            for i, (rms, band) in enumerate(bands)
        ]
        weave = Tones.drawn(wear.weave_s, WEAVE_HZ, np.random.default_rng((seed, 3)))
        self.timebase = Timebase(wear.speed, tuple(tones), wear.skew_s, weave)
        self._noise, self._uneven = (
            np.random.default_rng((seed, 4)),
            Unevenness(wear.uneven_db, tracks, (seed, 5)),
        )
        holes = (
            wear.dropouts_per_min,
            wear.dropout_s,
            gain(-wear.dropout_db),
            wear.dropout_all,
            (seed, 6),
        )
        self._dropouts = Dropouts(*holes) if wear.dropouts_per_min > 0 else None
        turn = max(round(wear.print_s * rate_hz), 1)
        self._print = (
            PrintThrough(gain(-wear.print_db), turn, tracks)
            if wear.print_db is not None
            else None
        )
        self._bands: list[BandLimit] = []
        if wear.bandwidth_hz:
            self._bands.append(BandLimit.below(wear.bandwidth_hz, rate_hz, tracks))
        if wear.band_hz is not None:
            self._bands.append(BandLimit.telephone(wear.band_hz, rate_hz, tracks))
        self._head, self._came, self._went, self._peak = Head(tracks), 0, 0, 0.0

    @property
    def dropouts(self) -> list[Dropout]:
        """The dropouts met so far."""
        return self._dropouts.met if self._dropouts else []

    def frames(self, blocks: Iterator[Frames]) -> Iterator[Frames]:
        """The worn tape."""
        for block in blocks:
            self._peak = self._peak or float(np.abs(block).max()) or 0.0
            yield self._played(self._recorded(block))
        if self._print is not None:
            yield self._played(self._laid(self._print.rest()))
        # blank tape: the last frames' filter reaches there
        self._head.take(np.zeros((64, self._tracks), np.float32))
        yield self._played(np.zeros((0, self._tracks), np.float32), last=True)

    def _recorded(self, frames: Frames) -> Frames:
        """The frames as the record head lays them on the tape."""
        wear = self._wear
        if wear.third and self._peak:
            frames = distorted(frames, wear.third, self._peak)
        if wear.crosstalk_db is not None:
            frames = frames @ crosstalk(gain(-wear.crosstalk_db), self._tracks)
        return self._laid(self._print.feed(frames) if self._print is not None else frames)

    def _laid(self, frames: Frames) -> Frames:
        """The frames with the tape's dropouts."""
        first_s = self._came / self._rate_hz
        self._came += len(frames)
        if self._dropouts is None or not len(frames):
            return frames
        gains = self._dropouts.gains(first_s, len(frames), self._rate_hz, self._tracks)
        return frames if gains is None else (frames * gains).astype(np.float32)

    def _played(self, frames: Frames, last: bool = False) -> Frames:
        """The frames that the play head reads from the tape that has come by now."""
        self._head.take(frames)
        # flutter may be 1 % either way
        reach, slow = (self._came, 0.99) if last else (self._head.reach, 1.01)
        gone = (
            self.timebase.programme_s(np.array([self._went / self._rate_hz]))[0] * self._rate_hz
        )
        count = max(int((reach - gone) / (slow + self._wear.speed)), 0)
        if last:
            places = self.timebase.places(self._went, count + 2, self._rate_hz, self._tracks)
            places = places[places[:, 0] < self._came - END_FRAMES]
        else:  # flutter and skew move a place less than 10 ms
            count = max(count - round(0.01 * self._rate_hz), 0)
            places = self.timebase.places(self._went, count, self._rate_hz, self._tracks)
        if not len(places):
            return np.zeros((0, self._tracks), np.float32)
        read = self._amplified(self._head.read(places))
        self._went += len(read)
        return read

    def _amplified(self, frames: Frames) -> Frames:
        """The frames behind the play amplifier."""
        wear, first, count = self._wear, self._went, len(frames)
        frames = frames * np.float32(gain(wear.level_db))
        if wear.uneven_db:
            frames = (frames * self._uneven.gains(first, count, self._rate_hz)).astype(
                np.float32
            )
        for band in self._bands:
            frames = band.feed(frames)
        if wear.hum_db is not None:
            buzz = hum(
                first, count, self._rate_hz, wear.hum_hz, self._peak * gain(-wear.hum_db)
            )
            frames = frames + buzz[:, None].astype(np.float32)
        if wear.noise_db is not None:
            sigma = self._peak / np.sqrt(2) * gain(-wear.noise_db)
            frames = frames + np.float32(sigma) * self._noise.standard_normal(
                frames.shape, np.float32
            )
        return self._wired(frames + np.float32(wear.dc))

    def _wired(self, frames: Frames) -> Frames:
        """The frames behind the cables and the sound card: order, polarity, clipping."""
        wear = self._wear
        if wear.order:
            frames = frames[:, [track - 1 for track in wear.order]]
        for track in wear.inverted:
            frames[:, track - 1] *= -1
        most = 1.0 if wear.clip is None else wear.clip
        return np.clip(frames, -most, most)


def _cut(sound: soundfile.SoundFile, wear: Wear) -> Iterator[Frames]:
    """The blocks of the programme between the two cuts."""
    first = round(wear.cut_start_s * sound.samplerate)
    left = sound.frames - first - round(wear.cut_end_s * sound.samplerate)
    if left <= 0:
        raise ValueError(
            f"cuts of {wear.cut_start_s:g} s and {wear.cut_end_s:g} s leave nothing of the tape; cut less"
        )
    sound.seek(first)
    while left > 0:
        block = sound.read(min(BLOCK_FRAMES, left), dtype="float32", always_2d=True)
        if not len(block):
            raise TapeFault(
                f"the tape ends {left / sound.samplerate:.3f} s before its header says; copy it again"
            )
        left -= len(block)
        yield block


@contextmanager
def _written(target: FilePath) -> Iterator[None]:
    """Turn libsndfile's error on a full disk into a fault."""
    try:
        yield
    except soundfile.SoundFileError as error:
        raise disk_full_fault(target) from error
