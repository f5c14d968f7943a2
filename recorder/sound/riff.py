"""The chunks of a WAV file, as far as the tape needs them beside libsndfile: sizes, and what stands in a
header.

A plain WAV counts its bytes with 32 bits, so it ends at 4 GiB; what libsndfile writes beyond is lost without
an error. An RF64 has a chunk of 64-bit sizes in front. Tapes are therefore written as RF64, and one that
turned out small enough is made a plain WAV in place when it is finished, as EBU Tech 3306 foresees:

    "RF64" ffffffff "WAVE" "ds64" sizes   "fmt " fffe …  "data" ffffffff  frames
    "RIFF" size     "WAVE" "JUNK" unread  "fmt " 0001 …  "data" size      frames

Its format goes back to plain PCM (or float) with it: the extensible one of an RF64 names loudspeakers, which
the tracks are not, and simple programs do not read it. The bytes that follow are then ignored, as the Windows
SDK has it.

Reading, libsndfile takes a file that ends before its data chunk does for a shorter one; `Sizes` tells.

Source: EBU Tech 3306 v1.1 (RF64); Microsoft and IBM, Multimedia Programming Interface 1.0 (RIFF); Windows
SDK, WAVEFORMATEX (cbSize) and WAVEFORMATEXTENSIBLE.
"""

from __future__ import annotations

import os
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

# a margin below 4 GiB for programs that count frames in whole pages
LARGEST_RIFF_BYTES = 2**32 - 2**16
# in an RF64: see ds64; in a plain WAV written through a pipe: up to the end
UNKNOWN = 0xFFFFFFFF
_EXTENSIBLE = b"\xfe\xff"
_SEARCHED_BYTES = 65536  # of a header
_HEAD_BYTES, _FORMAT_BYTES = 12, 40  # of a RIFF; of an extensible format, with its GUID


@dataclass(frozen=True, slots=True)
class Sizes:
    """Size of the data chunk, stated and held, in bytes, and where format and data begin."""

    kind: bytes
    format_at: int
    data_at: int
    stated: int | None
    held: int

    @property
    def cut_short(self) -> bool:
        """Whether the file ends before its data chunk does."""
        return self.stated is not None and self.held < self.stated


def read_sizes(file: str | os.PathLike[str]) -> Sizes | None:
    """Sizes of a WAV, RF64, W64 or AIFF; None for another kind of file, or one without a data chunk."""
    with Path(file).open("rb") as opened:
        kind = opened.read(24)
        if kind[:4] in (b"FORM", b"riff") and len(kind) == 24:
            return _whole_file(kind, os.fstat(opened.fileno()).st_size)
        opened.seek(_HEAD_BYTES)
        kind = kind[:_HEAD_BYTES]
        if (
            len(kind) < _HEAD_BYTES
            or kind[:4] not in (b"RIFF", b"RF64", b"BW64")
            or kind[8:] != b"WAVE"
        ):
            return None
        end = os.fstat(opened.fileno()).st_size
        return _find_data(opened, kind[:4], end)


def make_plain(file: str | os.PathLike[str]) -> bool:
    """Turn an RF64 that is small enough into a plain WAV, in place; True if it was."""
    sizes = read_sizes(file)
    end = Path(file).stat().st_size
    if (
        sizes is None
        or sizes.kind != b"RF64"
        or sizes.stated is None
        or end > LARGEST_RIFF_BYTES
    ):
        return False
    with Path(file).open("r+b") as opened:
        opened.write(struct.pack("<4sI4s4s", b"RIFF", end - 8, b"WAVE", b"JUNK"))
        opened.seek(sizes.data_at - 4)
        opened.write(struct.pack("<I", sizes.stated))
        _name_samples_plainly(opened, sizes.format_at)
    return True


def replace_text(file: str | os.PathLike[str], old: str, new: str) -> None:
    """Replace a text in the header by one that is not longer; raises ValueError if that cannot be done."""
    before = old.encode()
    after = new.encode().ljust(len(old.encode()))
    with Path(file).open("r+b") as opened:
        at = opened.read(_SEARCHED_BYTES).find(before)
        if at < 0 or len(after) != len(before):
            raise ValueError(
                f"a text of {len(new)} characters has no place in the header; it must be there already"
            )
        opened.seek(at)
        opened.write(after)


def _name_samples_plainly(opened: BinaryIO, format_at: int) -> None:
    """Copy the kind of sample (first two bytes of its GUID) to where a plain format has it."""
    opened.seek(format_at)
    body = opened.read(_FORMAT_BYTES)
    if body[:2] == _EXTENSIBLE and len(body) == _FORMAT_BYTES:
        opened.seek(format_at)
        opened.write(body[24:26])


def _whole_file(head: bytes, held: int) -> Sizes:
    """Sizes of an AIFF or a W64, whose outermost chunk states the length of the whole file."""
    stated = (
        struct.unpack(">I", head[4:8])[0] + 8
        if head[:4] == b"FORM"
        else struct.unpack("<Q", head[16:24])[0]
    )
    return Sizes(head[:4], 0, 0, stated, held)


def _find_data(opened: BinaryIO, kind: bytes, end: int) -> Sizes | None:
    """Go from chunk to chunk until the data."""
    stated_64, format_at = None, 0
    while len(head := opened.read(8)) == 8:
        name, size = struct.unpack("<4sI", head)
        if name == b"data":
            stated = stated_64 if size == UNKNOWN else size
            return Sizes(kind, format_at, opened.tell(), stated, end - opened.tell())
        next_at = opened.tell() + size + size % 2  # chunks start at even places
        if name == b"fmt ":
            format_at = opened.tell()
        if name == b"ds64" and len(body := opened.read(16)) == 16:
            stated_64 = struct.unpack("<QQ", body)[1]
        opened.seek(next_at)
    return None
