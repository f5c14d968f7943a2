"""The recording: a stream of Motion becomes a sound file with a carrier per track.

Signals: Motion in, at the format's motion rate; a sound file out (see spool.py). One block is held at a time,
however long the tape. The tape starts and ends with standstill, the reference frequency on all tracks:

    speed            ___________
           _________/           \\_________
           | dwell |  the motion |  dwell |

Source: patent ES 361967, figure 2 and the sequence at the end (a section at the reference frequency is
standstill). Questions: the patent's tape says nothing of its start; here the text chunk does. It is written
before the frames, as a FLAC takes it nowhere else, with room for the end position, which is put in when it is
known.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path as FilePath
from typing import Any

import numpy as np
import soundfile

from morfax.motion.arrays import Array
from morfax.motion.faults import MotionFault
from morfax.motion.files import disk_full_fault, written_beside
from morfax.motion.motion import AXES, Motion, Path
from morfax.recorder.report import Written
from morfax.recorder.sound.riff import make_plain, replace_text
from morfax.recorder.sound.source import SampleType, Sink, Stored, sidecar
from morfax.recorder.sound.spool import Spool, medium
from morfax.recorder.tape.carrier import Carrier
from morfax.recorder.tape.check_signal import CheckWriter
from morfax.recorder.tape.format import LARGEST_TEXT_BYTES, TapeFormat
from morfax.recorder.tape.own_motion import OwnMotion
from morfax.recorder.tape.speed_gauge import SpeedGauge

_BLOCK_SAMPLES = 8192  # a megabyte of frames, which stays in the processor's cache
_PLACE_DECIMALS = 6  # of the start and end in the text chunk: a nanometre
_PLACE_CHARACTERS = 24  # room for one coordinate of the end
_AXIS_CHARACTERS = 30  # room for the name of an axis that stands, or runs like another
_ENTRY_CHARACTERS = 60  # room for the three entries that a text of version 3 has more

Progress = Callable[[float, float | None], None]


@dataclass(frozen=True)  # without slots: two bases with slots cannot be joined in Recording
class LiveRecording:
    """What was put out: format with start and end, length, and the largest speed of each axis."""

    format: TapeFormat
    frames: int
    largest_speed_mm_s: tuple[float, ...]

    @property
    def duration_s(self) -> float:
        """Length of the tape with the standstill at both ends, s."""
        return self.frames / self.format.sample_rate_hz

    @property
    def figures(self) -> dict[str, Any]:
        """Further figures for the report."""
        return {"largest_speed_mm_s": max(self.largest_speed_mm_s)}


@dataclass(frozen=True, slots=True)
class Recording(LiveRecording, Written):
    """What was recorded in a file."""


def record(
    stream: Iterable[Motion] | Motion | Path,
    file: str | os.PathLike[str],
    fmt: TapeFormat | None = None,
    progress: Progress | None = None,
    sample: str = "16",
) -> Recording:
    """Record a motion as a tape: .wav (RF64 inside from 4 GiB on), .rf64, .w64, .flac or .aiff.

    Start and end in `fmt` are those of the motion, whatever is given; without `fmt` it is the usual one for
    its axes, with the check signal. `progress(done_s, total_s)` is called after each block; the total is None
    where a stream does not tell. Raises MotionFault for a motion that is empty, of another rate, not finite
    or too fast, and FileFault; nothing is left under the name then.
    """
    kind = medium(FilePath(file), sample)
    with written_beside(file) as beside:

        def spool(begun: TapeFormat) -> Sink:
            return Spool(
                beside,
                begun.sample_rate_hz,
                begun.tracks,
                kind,
                placeholder(begun),
                name=FilePath(file),
            )

        try:
            done = record_live(stream, spool, fmt, progress)
        except soundfile.SoundFileError as error:
            raise disk_full_fault(file) from error
        finish(beside, done.format, FilePath(file))
    return Recording(FilePath(file), done.format, done.frames, done.largest_speed_mm_s)


def record_live(
    stream: Iterable[Motion] | Motion | Path,
    open_sink: Callable[[TapeFormat], Sink],
    fmt: TapeFormat | None = None,
    progress: Progress | None = None,
) -> LiveRecording:
    """Record a motion into any sink, which is opened with the format as it is known at the start.

    Raises what `record` raises, and the sink's own faults.
    """
    if fmt is None:
        stream, axes = _axes_of(stream)
        fmt = TapeFormat(axes=axes, checked=True)
    blocks = _blocks(stream, fmt)
    first = next(blocks, None)
    if first is None:
        raise MotionFault("the motion is empty; a tape needs at least one position")
    fmt = replace(fmt, start_mm=_place(first[0]), end_mm=None, still=(), alike=())
    with open_sink(fmt) as out:
        tape = _Take(fmt, first[0], out.takes, _Progress(progress, _total_s(stream)))
        for frames in tape.frames(chain([first], blocks)):
            out.put(frames)
    still, alike = tape.own.told(fmt.axes)
    fmt = replace(fmt, end_mm=_place(tape.last_mm), still=still, alike=alike)
    return LiveRecording(fmt, tape.count, tape.largest_speed_mm_s)


@dataclass(frozen=True, slots=True)
class _Progress:
    """Whom to tell how much of the motion is recorded, and its length in s, if that is known."""

    tell: Progress | None
    total_s: float | None


class _Take:
    """One run of the tape: carriers, speed gauge and count of frames."""

    def __init__(
        self, fmt: TapeFormat, first_mm: Array, samples: SampleType, progress: _Progress
    ) -> None:
        self._format, self._progress = fmt, progress
        self._carrier = Carrier(fmt.carrier, first_mm, samples)
        self._samples = 0
        self.last_mm = first_mm
        self._speeds = SpeedGauge(fmt)
        self.own = OwnMotion(len(first_mm))
        self._check = CheckWriter(fmt, self._carrier) if fmt.checked else None

    @property
    def count(self) -> int:
        """Frames so far."""
        return self._carrier.done

    @property
    def largest_speed_mm_s(self) -> tuple[float, ...]:
        """The largest speed of each axis so far."""
        return tuple(self._speeds.largest_mm_s.tolist())

    def frames(self, blocks: Iterable[Array]) -> Iterator[Stored]:
        """All frames of the tape, standstill included."""
        yield from self._standstill()
        for positions in blocks:
            self._gauge(positions)
            self.own.feed(self._carrier.feed(positions))
            yield from self._ready()
            self._tell()
        yield from self._standstill()
        if self._check is None:
            yield self._carrier.rest()
        else:
            yield from self._check.rest()

    def _standstill(self) -> Iterator[Stored]:
        """The frames of a standstill where the screws are."""
        samples = _dwell_samples(self._format)
        for first in range(0, samples, _BLOCK_SAMPLES):
            rows = min(_BLOCK_SAMPLES, samples - first)
            self._carrier.feed(np.tile(self.last_mm, (rows, 1)))
            yield from self._ready()

    def _ready(self) -> Iterator[Stored]:
        """The frames that can be finished by now, with the check signal, where the tape has one."""
        if self._check is None:
            yield self._carrier.ready()
        else:
            yield from self._check.frames()

    def _gauge(self, positions: Array) -> None:
        """Note the largest speeds; raise MotionFault where an axis leaves the deviation."""
        self._speeds.feed(positions, self.last_mm, self._samples)
        self._samples += len(positions)
        self.last_mm = positions[-1]

    def _tell(self) -> None:
        """Report the progress in s of the motion."""
        if self._progress.tell is not None:
            self._progress.tell(
                self._samples / self._format.motion_rate_hz, self._progress.total_s
            )


def _axes_of(
    stream: Iterable[Motion] | Motion | Path,
) -> tuple[Iterable[Motion] | Motion | Path, tuple[str, ...]]:
    """The axes of a motion, and the whole motion."""
    if isinstance(stream, Motion | Path):
        return stream, stream.axes
    blocks = iter(stream)
    first = next(blocks, None)
    return (blocks, AXES) if first is None else (chain([first], blocks), first.axes)


def _blocks(stream: Iterable[Motion] | Motion | Path, fmt: TapeFormat) -> Iterator[Array]:
    """Positions (n, axes) in blocks of moderate length, checked."""
    if isinstance(stream, Path):
        stream = stream.motion(fmt.motion_rate_hz)
    done = 0
    for block in [stream] if isinstance(stream, Motion) else stream:
        positions = np.asarray(block.positions_mm, np.float64)
        _check(positions, block.rate_hz, done, fmt)
        done += len(positions)
        for first in range(0, len(positions), _BLOCK_SAMPLES):
            yield positions[first : first + _BLOCK_SAMPLES]


def _check(positions: Array, rate_hz: float, done: int, fmt: TapeFormat) -> None:
    """Raise MotionFault for a block that this tape cannot take."""
    if abs(rate_hz - fmt.motion_rate_hz) > 1e-6 * fmt.motion_rate_hz:
        raise MotionFault(
            f"the motion runs at {rate_hz:g} Hz; a tape of {fmt.sample_rate_hz} Hz takes "
            f"{fmt.motion_rate_hz:g} Hz: "
            "give it at that rate, as Path.motion(rate_hz) does"
        )
    if positions.ndim != 2 or positions.shape[1] != len(fmt.axes):
        got = positions.shape[-1] if positions.ndim else 0
        raise MotionFault(
            f"the motion has {got} axes; this tape takes {len(fmt.axes)}: {', '.join(fmt.axes)}"
        )
    if not _is_finite(positions):
        at, axis = np.argwhere(~np.isfinite(positions))[0].tolist()
        time_s, name = (done + at) / rate_hz, fmt.axes[axis]
        message = f"axis {name} is at {positions[at, axis]} mm at {time_s:.4f} s; positions must be finite"
        raise MotionFault(message, axis=name, time_s=time_s)


def _is_finite(positions: Array) -> bool:
    """Whether all are numbers. A sum takes a third of the time, and is one only if all are."""
    with np.errstate(over="ignore", invalid="ignore"):
        return bool(np.isfinite(positions.sum())) or bool(np.isfinite(positions).all())


def finish(beside: FilePath, fmt: TapeFormat, file: FilePath) -> None:
    """Write the end position; turn an RF64 that is small enough into a plain WAV where a .wav is asked."""
    if file.suffix.lower() == ".w64":
        with written_beside(sidecar(file)) as text:
            text.write_text(fmt.to_json() + "\n", encoding="utf-8")
        return
    replace_text(beside, placeholder(fmt), fmt.to_json())
    if file.suffix.lower() == ".wav":
        make_plain(beside)


def placeholder(fmt: TapeFormat) -> str:
    """The text chunk with room for the end position, which is not known yet."""
    text = replace(fmt, end_mm=None, still=(), alike=()).to_json()
    room = _ENTRY_CHARACTERS + (_PLACE_CHARACTERS + _AXIS_CHARACTERS) * len(fmt.axes)
    return text.ljust(min(len(text) + room, LARGEST_TEXT_BYTES))


def _place(position: Array) -> tuple[float, ...]:
    """A position for the text chunk, mm."""
    return tuple((np.round(position, _PLACE_DECIMALS) + 0.0).tolist())


def _dwell_samples(fmt: TapeFormat) -> int:
    """Motion samples of the standstill at each end."""
    return round(fmt.dwell_s * fmt.motion_rate_hz)


def _total_s(stream: Iterable[Motion] | Motion | Path) -> float | None:
    """Length of a motion in s; None for a stream of unknown length."""
    if isinstance(stream, Path):
        return float(stream.t_s[-1] - stream.t_s[0])
    return stream.duration_s if isinstance(stream, Motion) else None
