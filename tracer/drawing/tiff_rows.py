"""A TIFF by its rows: some strips, or a row of tiles, at a time, as a small TIFF that Pillow reads.

Signals: an open file and what Pillow says of it in; grey levels (uint8) out, some rows at a time, from the
top. Colours are their darkest channel.

Source: TIFF 6.0, sections 2, 3 and 15. Questions: the tables of old JPEG strips stand elsewhere in the file;
such files are read as a whole.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.png_rows import AT_ONCE
from morfax.tracer.drawing.scan import darkest

if TYPE_CHECKING:
    from PIL.Image import Image

Bytes = NDArray[np.uint8]

TIFF_PACKED = {1, 2, 3, 4, 5, 8, 32773, 32946}  # Pillow unpacks a part of such a file alone
# tags, as TIFF 6.0 numbers them
COMPRESSION, STRIPS, STRIP_BYTES, STRIP_ROWS = 0x103, 0x111, 0x117, 0x116
TILE_WIDTH, TILE_HEIGHT, TILES, TILE_BYTES = 322, 323, 324, 325
WIDTH, HEIGHT, BITS, PHOTOMETRIC = 0x100, 0x101, 0x102, 0x106
FILL_ORDER, SAMPLES, PLANAR, COLOURS = 0x10A, 0x115, 0x11C, 0x140
# what a part needs of its file: how pixels are meant and packed
KEPT_TAGS = (
    BITS,
    COMPRESSION,
    PHOTOMETRIC,
    FILL_ORDER,
    SAMPLES,
    PLANAR,
    0x124,
    0x125,
    0x13D,
    COLOURS,
)
BLACK_IS_ZERO = 1


def not_packed(image: Image, stream: BinaryIO) -> tuple[BinaryIO, int] | None:
    """The file, opened again, and where its pixels begin, of a TIFF of unpacked bytes, one to a pixel, whose
    strips follow one another. None if it is another.
    """
    tags: Any = image.tag_v2  # type: ignore[attr-defined]
    if image.mode != "L" or tags.get(COMPRESSION, 1) != 1 or STRIPS not in tags:
        return None
    if tags.get(PHOTOMETRIC) != BLACK_IS_ZERO or tags.get(BITS) != (8,):
        return None
    if tags.get(FILL_ORDER, 1) != 1:  # bits from the right
        return None
    begins, sizes = np.array(tags[STRIPS]), np.array(tags[STRIP_BYTES])
    columns, rows = image.size
    if np.any(begins[1:] != begins[:-1] + sizes[:-1]) or sizes.sum() != rows * columns:
        return None
    own = Path(stream.name).open("rb")  # noqa: SIM115 - it stays open while rows are read
    return own, int(begins[0])


def parts_of(image: Image, stream: BinaryIO) -> Iterator[Bytes] | None:
    """The parts of a TIFF whose strips or tiles can be read alone; None if it is another."""
    tags: Any = image.tag_v2  # type: ignore[attr-defined]
    compression, planar = tags.get(COMPRESSION, 1), tags.get(PLANAR, 1)
    if compression not in TIFF_PACKED or planar != 1:
        return None
    if TILES in tags:
        return _rows_of_tiles(image, stream, tags)
    if len(tags.get(STRIPS, ())) < 2:
        return None
    return _strips(image, stream, tags)


def _strips(image: Image, stream: BinaryIO, tags: Any) -> Iterator[Bytes]:
    """Some strips at a time."""
    columns, rows = image.size
    high = int(tags.get(STRIP_ROWS, rows))
    some = max(1, AT_ONCE // (high * columns))
    begins, sizes = tags[STRIPS], tags[STRIP_BYTES]
    for first in range(0, len(begins), some):
        strips = _read(stream, begins[first : first + some], sizes[first : first + some])
        count = min(rows - first * high, some * high)
        yield _grey(
            _tiff(tags, (columns, count), {STRIP_ROWS: high}, (STRIPS, STRIP_BYTES), strips)
        )


def _rows_of_tiles(image: Image, stream: BinaryIO, tags: Any) -> Iterator[Bytes]:
    """A row of tiles at a time."""
    columns, rows = image.size
    wide, high = int(tags[TILE_WIDTH]), int(tags[TILE_HEIGHT])
    across = -(-columns // wide)
    begins, sizes = tags[TILES], tags[TILE_BYTES]
    for number, top in enumerate(range(0, rows, high)):
        own = slice(number * across, (number + 1) * across)
        tiles = _read(stream, begins[own], sizes[own])
        more = {TILE_WIDTH: wide, TILE_HEIGHT: high}
        size = columns, min(high, rows - top)
        yield _grey(_tiff(tags, size, more, (TILES, TILE_BYTES), tiles))


def _read(stream: BinaryIO, begins: Any, sizes: Any) -> list[bytes]:
    """Pieces of a file."""
    pieces = []
    for begin, size in zip(begins, sizes, strict=True):
        stream.seek(begin)
        pieces.append(stream.read(size))
    return pieces


def _tiff(
    tags: Any,
    size: tuple[int, int],
    more: dict[int, int],
    names: tuple[int, int],
    pieces: list[bytes],
) -> io.BytesIO:
    """A TIFF of some strips or tiles of another: columns and rows, their own tags, and the pieces."""
    values: dict[int, Any] = {tag: tags[tag] for tag in KEPT_TAGS if tag in tags}
    values |= {WIDTH: size[0], HEIGHT: size[1], **more}
    where, lengths = names
    values |= {where: [0] * len(pieces), lengths: [len(piece) for piece in pieces]}
    end = tags._endian  # a packed piece has the bytes of numbers in its file's order
    entries, beyond = sorted(values), bytearray()
    head = (b"II*\0" if end == "<" else b"MM\0*") + struct.pack(end + "I", 8)
    after = 8 + 2 + 12 * len(entries) + 4
    for _ in range(2):  # the places of the pieces are known when all that stands before them is
        directory, beyond = struct.pack(end + "H", len(entries)), bytearray()
        for tag in entries:
            value = values[tag]
            numbers = (
                [int(v) for v in value] if isinstance(value, tuple | list) else [int(value)]
            )
            kind, letter = (3, "H") if tag in (BITS, COLOURS) else (4, "I")
            packed = struct.pack(f"{end}{len(numbers)}{letter}", *numbers)
            if len(packed) > 4:
                place = after + len(beyond)
                beyond += packed + b"\0" * (len(packed) % 2)
                packed = struct.pack(end + "I", place)
            directory += struct.pack(end + "HHI", tag, kind, len(numbers)) + packed.ljust(
                4, b"\0"
            )
        begins = after + len(beyond) + np.cumsum([0, *values[lengths][:-1]])
        values[where] = [int(begin) for begin in begins]
    return io.BytesIO(
        head + directory + struct.pack(end + "I", 0) + bytes(beyond) + b"".join(pieces)
    )


def _grey(file: io.BytesIO) -> Bytes:
    """The grey levels of a small picture."""
    from PIL import Image

    with Image.open(file) as part:
        if part.mode in ("1", "L"):
            return np.asarray(part.convert("L"))
        return darkest(np.asarray(part.convert("RGB")))
