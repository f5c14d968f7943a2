"""A tape that comes through a pipe: WAV or raw samples from any recorder program, as they come.

Signals: bytes in; float32 frames (n, tracks) out, full scale 1, as soon as a block of them is there. Nothing
but one block is held, so a pipe may run for hours.

A WAV through a pipe states no length, or a wrong one: it ends where the pipe ends. Chunks before its data are
read, and the text chunk with them; raw samples are 16 bit, little-endian, interleaved, at 48 kHz with four
tracks unless told.

Source: Microsoft and IBM, Multimedia Programming Interface 1.0 (RIFF); what `arecord`, `sox` and `ffmpeg`
write. Questions: text that stands behind the data comes too late; such a tape needs its figures by hand.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from types import TracebackType
from typing import Any, BinaryIO

import numpy as np

from morfax.motion.faults import TapeFault
from morfax.recorder.tape.carrier import Frames
from morfax.recorder.tape.format import TapeFormat, columns_of, is_format_text
from morfax.recorder.tape.stated import allowed, unnamed

PIPE_FRAMES = 65536  # 1.4 s at 48 kHz
LARGEST_CHUNK_BYTES = 1 << 20  # of a header: more is no tape
_PCM, _FLOAT, _EXTENSIBLE = 1, 3, 0xFFFE


@dataclass(frozen=True, slots=True)
class Samples:
    """Layout of the samples in the pipe: tracks, rate, bits, and whether they are floats."""

    tracks: int = 4
    sample_rate_hz: int = 48000
    bits: int = 16
    is_float: bool = False

    @property
    def frame_bytes(self) -> int:
        """Bytes of one frame."""
        return self.tracks * self.bits // 8

    def frames(self, data: bytes) -> Frames:
        """The whole frames in some bytes."""
        if self.is_float:
            values = np.frombuffer(data, f"<f{self.bits // 8}").astype(np.float32)
        elif self.bits == 24:
            padded = np.zeros((len(data) // 3, 4), np.uint8)
            padded[:, 1:] = np.frombuffer(data, np.uint8).reshape(-1, 3)
            values = padded.view("<i4")[:, 0] * np.float32(2.0**-31)
        else:
            values = np.frombuffer(data, f"<i{self.bits // 8}") * np.float32(
                2.0 ** (1 - self.bits)
            )
        return np.asarray(values.reshape(-1, self.tracks), np.float32)


class Pipe:
    """A tape in a pipe, with the interface of a Tape; it can be read once."""

    def __init__(
        self,
        stream: BinaryIO,
        samples: Samples,
        fmt: TapeFormat,
        begun: bytes,
        columns: list[int] | None = None,
    ) -> None:
        self.format, self._stream, self._samples, self._begun = fmt, stream, samples, begun
        self._columns = columns
        self.file, self.frames = FilePath("-"), 0

    @classmethod
    def open(
        cls,
        stream: BinaryIO,
        *,
        reference_hz: float | None = None,
        cycles_per_mm: float | None = None,
        start_mm: tuple[float, ...] | None = None,
        order: Sequence[int] | None = None,
        still: Sequence[str] | None = None,
        alike: Sequence[str] | None = None,
        samples: Samples | None = None,
    ) -> Pipe:
        """Read the header, if there is one; raises TapeFault for no tape, or for an unknown format."""
        begun = _whole(stream, 12)
        if not begun:
            raise TapeFault("nothing came through the pipe; give a WAV or raw 16-bit samples")
        text = ""
        if begun[:4] in (b"RIFF", b"RF64") and begun[8:] == b"WAVE":
            samples, text = _header(stream)
            begun = b""
        samples = samples or Samples()
        fmt = _format(text, samples, reference_hz, cycles_per_mm)
        if start_mm is not None:
            fmt = replace(
                fmt, start_mm=tuple(start_mm) + fmt.start_mm[len(start_mm) :], end_mm=None
            )
        fmt = allowed(fmt, still, alike)
        return cls(stream, samples, fmt, begun, columns_of(order, fmt.tracks))

    def __enter__(self) -> Pipe:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        return None

    def blocks(self, frames: int = PIPE_FRAMES, first: int = 0) -> Iterator[Frames]:
        """The tape in blocks from frame `first` on; an incomplete frame at the end is dropped."""
        step, held = self._samples.frame_bytes, self._begun
        skip = first * step
        while True:
            data = held + _whole(self._stream, frames * step - len(held))
            held, whole = b"", len(data) // step * step
            if not whole:
                return
            if skip:
                gone = min(skip, whole)
                data, whole, skip = data[gone:], whole - gone, skip - gone
            if whole:
                self.frames += whole // step
                block = self._samples.frames(data[:whole])
                yield block if self._columns is None else block[:, self._columns]

    def stored_blocks(self, frames: int = PIPE_FRAMES, first: int = 0) -> Iterator[Frames]:
        """The same as `blocks`: a pipe converts its samples to full scale at once."""
        return self.blocks(frames, first)


def _whole(stream: BinaryIO, size: int) -> bytes:
    """The next bytes; fewer than `size` only where the pipe ends."""
    parts, left = [], size
    while left > 0:
        part = stream.read(left)
        if not part:
            break
        parts.append(part)
        left -= len(part)
    return b"".join(parts)


def _header(stream: BinaryIO) -> tuple[Samples, str]:
    """Read the chunks up to the data: layout of the samples, and the text."""
    samples, text = None, ""
    while len(head := _whole(stream, 8)) == 8:
        name, size = struct.unpack("<4sI", head)
        if name == b"data":
            if samples is None:
                raise TapeFault(
                    "the WAV in the pipe has no format before its data; give raw samples, or another WAV"
                )
            return samples, text
        if size > LARGEST_CHUNK_BYTES:
            raise TapeFault(
                f"the WAV in the pipe has a header chunk of {size} bytes; at most "
                f"{LARGEST_CHUNK_BYTES} allowed"
            )
        body = _whole(stream, size + size % 2)
        if name == b"fmt ":
            samples = _samples(body)
        elif name == b"LIST":
            text = text or _comment(body)
    raise TapeFault("the WAV in the pipe ends within its header; nothing was recorded")


def _samples(body: bytes) -> Samples:
    """The layout of the samples from a format chunk; raises TapeFault for a kind that cannot be read."""
    if len(body) < 16:
        raise TapeFault("the WAV in the pipe has a broken format chunk; record it again")
    kind, tracks, rate_hz, _, _, bits = struct.unpack("<HHIIHH", body[:16])
    if kind == _EXTENSIBLE and len(body) >= 26:
        kind = struct.unpack("<H", body[24:26])[0]
    good = (kind == _PCM and bits in (16, 24, 32)) or (kind == _FLOAT and bits in (32, 64))
    if not good or not 3 <= tracks <= 64 or not rate_hz:
        raise TapeFault(
            f"the WAV in the pipe has {tracks} tracks of {bits} bits (kind {kind}) at {rate_hz} Hz; "
            "a tape has 3 or more of "
            f"16, 24 or 32 bit or float"
        )
    return Samples(tracks, rate_hz, bits, kind == _FLOAT)


def _comment(body: bytes) -> str:
    """The comment of an INFO list."""
    read = io.BytesIO(body[4:]) if body[:4] == b"INFO" else io.BytesIO()
    while len(head := read.read(8)) == 8:
        name, size = struct.unpack("<4sI", head)
        words = read.read(size + size % 2)
        if name == b"ICMT":
            return words[:size].rstrip(b"\0 ").decode("utf-8", "replace")
    return ""


def _format(
    text: str, samples: Samples, reference_hz: float | None, cycles_per_mm: float | None
) -> TapeFormat:
    """The format from the text, or from the figures given by hand."""
    given = {"reference_hz": reference_hz, "cycles_per_mm": cycles_per_mm}
    by_hand: dict[str, Any] = {
        name: value for name, value in given.items() if value is not None
    }
    rate_hz = samples.sample_rate_hz
    try:
        if is_format_text(text):
            stated = TapeFormat.from_json(text)
            if stated.tracks != samples.tracks:
                raise TapeFault(
                    f"the pipe has {samples.tracks} tracks, its text speaks of {stated.tracks}; "
                    "record it again"
                )
            return replace(stated, sample_rate_hz=rate_hz, **by_hand)
        if len(by_hand) < 2:
            raise TapeFault(
                "the pipe does not say its format; give --reference-frequency 6kHz --cycles-per-mm "
                "20, or what it has"
            )
        return unnamed(rate_hz, samples.tracks, by_hand)
    except TapeFault:
        raise
    except ValueError as error:
        raise TapeFault(f"the pipe cannot be played so: {error}") from None
