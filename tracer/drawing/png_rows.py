"""A PNG by its rows: unpacked some lines at a time, with its own filters.

Signals: an open file in; grey levels (uint8) out, some rows at a time, from the top. Colours are their
darkest channel.

Source: PNG, ISO/IEC 15948:2004, clauses 7 to 10. Questions: checksums are not looked at; zlib tells most
damage.
"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator
from typing import TYPE_CHECKING, BinaryIO

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.tracer.drawing.scan import darkest
from morfax.tracer.effort import FEW_PX

if TYPE_CHECKING:
    from PIL.Image import Image

Bytes = NDArray[np.uint8]

AT_ONCE = FEW_PX  # bytes that are unpacked at a time: a byte is a pixel of grey
BARE, BEFORE, ABOVE, MEAN = 0, 1, 2, 3  # filters of a line; the fourth is Paeth's
CHANNELS = {0: 1, 2: 3, 3: 1}  # of a PNG: grey, colours, numbers of a palette


def parts_of(image: Image, stream: BinaryIO) -> Iterator[Bytes] | None:
    """The parts of a PNG; None if it is interlaced, deeper than a byte, or transparent."""
    stream.seek(8)
    columns, _, depth, colour, _, _, interlaced = struct.unpack(">8x2I5B", stream.read(21))
    if interlaced or depth > 8 or colour not in CHANNELS:
        return None
    palette = image.getpalette("RGB") if colour == 3 else None
    levels = np.arange(256, dtype=np.uint8)
    if colour == 0 and depth < 8:
        levels = (np.arange(256) * 255 // ((1 << depth) - 1)).astype(np.uint8)
    if palette is not None:
        least = np.array(palette, np.uint8).reshape(-1, 3).min(axis=1)
        levels[: len(least)] = least
    width = (columns * CHANNELS[colour] * depth + 7) // 8
    return _grey_rows(
        _lines(stream, width, max(1, CHANNELS[colour] * depth // 8)),
        (colour, depth, columns),
        levels,
    )


def _lines(stream: BinaryIO, width: int, step: int) -> Iterator[Bytes]:
    """Lines of a PNG's bytes (rows, width) without their filters."""
    before = np.zeros(width, np.uint8)
    left = bytearray()
    for unpacked in _unpacked(stream):
        left += unpacked
        count = len(left) // (width + 1)
        if not count:
            continue
        lines = (
            np.frombuffer(left, np.uint8, count * (width + 1)).reshape(count, width + 1).copy()
        )
        del left[: count * (width + 1)]
        _unfilter(lines, before, step)
        before = lines[-1, 1:]
        yield lines[:, 1:]


def _unpacked(stream: BinaryIO) -> Iterator[bytes]:
    """The bytes of a PNG's IDAT chunks, unpacked, some at a time."""
    stream.seek(8)
    unpacker = zlib.decompressobj()
    while len(head := stream.read(8)) == 8:
        length, kind = struct.unpack(">I4s", head)
        if kind == b"IEND":
            break
        if kind != b"IDAT":
            stream.seek(length + 4, io.SEEK_CUR)
            continue
        content = stream.read(length)
        stream.seek(4, io.SEEK_CUR)
        while content:
            yield unpacker.decompress(content, AT_ONCE)
            content = unpacker.unconsumed_tail
    yield unpacker.flush()


def _grey_rows(
    lines: Iterator[Bytes], kind: tuple[int, int, int], levels: Bytes
) -> Iterator[Bytes]:
    """Lines of bytes as grey levels."""
    colour, depth, columns = kind
    for part in lines:
        if colour == 2:
            yield darkest(part.reshape(len(part), columns, 3))
            continue
        if depth < 8:
            bits = np.unpackbits(part, axis=1).reshape(len(part), -1, depth)
            part = (bits @ (1 << np.arange(depth)[::-1]))[:, :columns].astype(np.uint8)
        yield part if colour == 0 and depth == 8 else levels[part]


@njit(cache=True)
def _unfilter(lines, before, step):  # type: ignore[no-untyped-def]
    """Take the filters off lines (the filter's number, then bytes), in place; `before` is the line above."""
    for i in range(len(lines)):
        above = lines[i - 1, 1:] if i else before
        if lines[i, 0] == ABOVE:
            lines[i, 1:] += above
        elif lines[i, 0] != BARE:
            _unfilter_line(lines[i, 1:], above, lines[i, 0], step)


@njit(cache=True)
def _unfilter_line(line, above, kind, step):  # type: ignore[no-untyped-def]
    """Take the filter off one line whose guess is made of the bytes before, each after the other."""
    for j in range(len(line)):
        a = np.int64(line[j - step]) if j >= step else 0
        b = np.int64(above[j])
        if kind == BEFORE:
            guess = a
        elif kind == MEAN:
            guess = (a + b) // 2
        else:
            guess = _nearest(a, b, np.int64(above[j - step]) if j >= step else 0)
        line[j] = np.uint8((line[j] + guess) & 255)


@njit(cache=True, inline="always")
def _nearest(a, b, c):  # type: ignore[no-untyped-def]
    """Which of the bytes before (a), above (b) and above that before (c) is nearest to a + b - c."""
    to_a, to_b, to_c = abs(b - c), abs(a - c), abs(a + b - 2 * c)
    guess = c
    if to_a <= to_b and to_a <= to_c:
        guess = a
    elif to_b <= to_c:
        guess = b
    return guess
