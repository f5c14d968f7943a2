"""Sound through a pipe: WAV or raw samples from any recorder program, as they come; and a WAV put out.

Signals: bytes in; frames (n, tracks) out, full scale 1, as soon as a block of them is there; and the other
way round. Nothing but one block is held, so a pipe may run for hours.

A WAV through a pipe states no length, or a wrong one: it ends where the pipe ends. Chunks before its data are
read, and the text chunk with them; raw samples are 16 bit, little-endian, interleaved, at 48 kHz with four
tracks unless told.

Source: Microsoft and IBM, Multimedia Programming Interface 1.0 (RIFF); what `arecord`, `sox` and `ffmpeg`
write. Questions: text that stands behind the data comes too late; such a tape needs its figures by hand.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

from morfax.motion.ending import Ending
from morfax.motion.faults import TapeFault
from morfax.motion.usual import SAMPLE_RATE_HZ, TRACKS
from morfax.recorder.sound.riff import UNKNOWN
from morfax.recorder.sound.sixteen_bit import in_16_bit
from morfax.recorder.sound.source import BLOCK_FRAMES, Frames, SampleType, Stored

LARGEST_CHUNK_BYTES = 1 << 20  # of a header: more is no tape
FEWEST_TRACKS, MOST_TRACKS = 3, 64  # reference, X, Y; more is no tape
_PCM, _FLOAT, _EXTENSIBLE = 1, 3, 0xFFFE


@dataclass(frozen=True, slots=True)
class Samples:
    """Layout of the samples in the pipe: tracks, rate, bits, and whether they are floats."""

    tracks: int = TRACKS
    sample_rate_hz: int = SAMPLE_RATE_HZ
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


class PipeSource:
    """Sound that comes through a pipe; it can be read once.

    Raises TapeFault where nothing comes, or a WAV's header cannot be read.
    """

    name = "the pipe"
    container = "pipe"

    def __init__(self, stream: BinaryIO, samples: Samples | None = None) -> None:
        self._stream, self._begun, self.text = stream, _whole(stream, 12), ""
        if not self._begun:
            raise TapeFault("nothing came through the pipe; give a WAV or raw 16-bit samples")
        if self._begun[:4] in (b"RIFF", b"RF64") and self._begun[8:] == b"WAVE":
            samples, self.text = _header(stream)
            self._begun = b""
        self._samples = samples or Samples()
        self.tracks, self.rate_hz = self._samples.tracks, self._samples.sample_rate_hz
        self.sample = "FLOAT" if self._samples.is_float else f"PCM_{self._samples.bits}"
        self.frames = 0  # that have come

    def close(self) -> None:
        """Leave the pipe open: it is the caller's."""

    def stored_blocks(self, frames: int = BLOCK_FRAMES, first: int = 0) -> Iterator[Stored]:
        """The frames in blocks from frame `first` on; an incomplete frame at the end is dropped."""
        step, held = self._samples.frame_bytes, self._begun
        skip = first * step
        while True:
            data = held + _whole(self._stream, frames * step - len(held))
            held, whole = b"", len(data) // step * step
            if not whole:
                return
            if skip:
                gone = min(skip, whole)
                data = data[gone:]
                whole = whole - gone
                skip = skip - gone
            if whole:
                self.frames += whole // step
                yield self._samples.frames(data[:whole])


class PipeSink(Ending):
    """A WAV of 16 bit put into a pipe; its header states no length, and its text stands in front."""

    takes: SampleType = np.int16

    def __init__(self, stream: BinaryIO, rate_hz: int, tracks: int, text: str) -> None:
        self._stream = stream
        words = text.encode() + b"\0" * (1 + (len(text.encode()) + 1) % 2)
        comment = b"INFO" + struct.pack("<4sI", b"ICMT", len(words)) + words
        kind = struct.pack(
            "<HHIIHH", _PCM, tracks, rate_hz, 2 * tracks * rate_hz, 2 * tracks, 16
        )
        stream.write(struct.pack("<4sI4s", b"RIFF", UNKNOWN, b"WAVE"))
        for name, body in ((b"fmt ", kind), (b"LIST", comment)):
            stream.write(struct.pack("<4sI", name, len(body)) + body)
        stream.write(struct.pack("<4sI", b"data", UNKNOWN))

    def end(self, error: BaseException | None) -> None:
        """Have all that was written go out."""
        if error is None:
            self._stream.flush()

    def put(self, frames: Stored) -> None:
        """Write frames; raises BrokenPipeError where nobody reads any more."""
        self._stream.write(in_16_bit(frames).astype("<i2", copy=False).tobytes())


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
    if not good or not FEWEST_TRACKS <= tracks <= MOST_TRACKS or not rate_hz:
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
