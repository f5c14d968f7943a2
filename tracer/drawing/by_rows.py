"""By rows: a large picture is read some rows at a time, and never held as a whole.

Signals: an open file and what Pillow says of it in; its grey levels (uint8), rows from the top, out. Colours
are their darkest channel, so that coloured lines are dark.

    PNG, not interlaced           unpacked row by row, with its own filters
    TIFF, strips or tiles         a row of strips or tiles at a time, as a small TIFF that Pillow reads
    TIFF of bytes, not packed     straight from the file

What is packed is unpacked once, into a file without a name in the system's folder for such files, since the
rows are read twice: a byte for each pixel. The picture takes that much of the disk, and no memory.

Source: PNG, ISO/IEC 15948:2004, clause 9; TIFF 6.0, sections 3 and 15. Questions: what is neither, or is
interlaced, turned, transparent, or deeper than 8 bits, is read as a whole.
"""

from __future__ import annotations

import io
import struct
import tempfile
import weakref
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.tracer.drawing.scan import darkest

if TYPE_CHECKING:
    from PIL.Image import Image

Bytes = NDArray[np.uint8]

AT_ONCE = 1 << 22  # bytes that are unpacked at a time
CHANNELS = {0: 1, 2: 3, 3: 1}  # of a PNG: grey, colours, numbers of a palette
TIFF_PACKED = {1, 2, 3, 4, 5, 8, 32773, 32946}  # Pillow unpacks a part of such a file alone
COMPRESSION, STRIPS, STRIP_BYTES, STRIP_ROWS = 259, 273, 279, 278
TILE_WIDTH, TILE_HEIGHT, TILES, TILE_BYTES = 322, 323, 324, 325
WIDTH, HEIGHT, BITS, PHOTOMETRIC, FILL_ORDER, SAMPLES, PLANAR = (
    256,
    257,
    258,
    262,
    266,
    277,
    284,
)
# what a part needs of its file: how pixels are meant and packed
KEPT_TAGS = (BITS, COMPRESSION, PHOTOMETRIC, FILL_ORDER, SAMPLES, PLANAR, 292, 293, 317, 320)
BLACK_IS_ZERO = 1
UPRIGHT = (None, 1)
ORIENTATION = 0x112


class Rows:
    """Grey levels of a picture in a file of bytes, from an offset on."""

    dtype = np.dtype(np.uint8)
    ndim = 2

    def __init__(self, file: BinaryIO, shape: tuple[int, int], offset: int = 0) -> None:
        self._file, self.shape, self._offset = file, shape, offset
        weakref.finalize(self, file.close)

    @property
    def size(self) -> int:
        """How many pixels there are."""
        return self.shape[0] * self.shape[1]

    def __len__(self) -> int:
        """How many rows there are."""
        return self.shape[0]

    def __getitem__(self, rows: slice) -> Bytes:
        """Some rows, read from the file."""
        top, bottom, step = rows.indices(self.shape[0])
        if step != 1:
            raise TypeError(
                "a picture that is read by rows has no steps; ask for a slice without"
            )
        part = np.empty((max(bottom - top, 0), self.shape[1]), np.uint8)
        self._file.seek(self._offset + top * self.shape[1])
        if self._file.readinto(part.data) != part.nbytes:  # type: ignore[attr-defined]
            raise ValueError("it ends too early")
        return part

    def fill(self, parts: Iterator[Bytes]) -> None:
        """Write all rows; raises ValueError for too few or too many."""
        for part in parts:
            self._file.write(np.ascontiguousarray(part).data)
        if self._file.tell() != self.size:
            raise ValueError("it ends too early")

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """All rows."""
        return np.asarray(self[:], dtype)


def rows_of(image: Image, stream: BinaryIO) -> Rows | None:
    """The picture by its rows; None for one that can only be read as a whole."""
    late_exif = image.format == "PNG" and "exif" not in image.info
    if late_exif:
        image.info["exif"] = (
            b""  # else Pillow unpacks the whole picture to look for one behind it
        )
    found = _rows_of(image, stream)
    if late_exif and found is None:
        del image.info["exif"]
    return found


def _rows_of(image: Image, stream: BinaryIO) -> Rows | None:
    """The same."""
    if image.getexif().get(ORIENTATION) not in UPRIGHT or "transparency" in image.info:
        return None
    parts: Iterator[Bytes] | None = None
    if image.format == "PNG":
        parts = _of_png(image, stream)
    elif image.format == "TIFF" and image.mode in ("1", "L", "P", "RGB"):
        straight = _not_packed(image, stream)
        if straight is not None:
            return straight
        parts = _of_tiff(image, stream)
    if parts is None:
        return None
    columns, rows = image.size
    unpacked = Rows(tempfile.TemporaryFile(), (rows, columns))  # type: ignore[arg-type]  # noqa: SIM115
    unpacked.fill(parts)
    return unpacked


# PNG


def _of_png(image: Image, stream: BinaryIO) -> Iterator[Bytes] | None:
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
    width = lines.shape[1] - 1
    for i in range(len(lines)):
        kind = lines[i, 0]
        line = lines[i, 1:]
        above = lines[i - 1, 1:] if i else before
        if kind == 0:
            continue
        if kind == 2:
            for j in range(width):
                line[j] += above[j]
            continue
        for j in range(width):
            a = np.int64(line[j - step]) if j >= step else 0
            b = np.int64(above[j])
            if kind == 1:
                guess = a
            elif kind == 3:
                guess = (a + b) // 2
            else:
                c = np.int64(above[j - step]) if j >= step else 0
                to_a, to_b, to_c = abs(b - c), abs(a - c), abs(a + b - 2 * c)
                guess = c
                if to_a <= to_b and to_a <= to_c:
                    guess = a
                elif to_b <= to_c:
                    guess = b
            line[j] = np.uint8((line[j] + guess) & 255)


# TIFF


def _not_packed(image: Image, stream: BinaryIO) -> Rows | None:
    """A TIFF of one byte to a pixel whose strips follow one another; None if it is another."""
    tags: Any = image.tag_v2  # type: ignore[attr-defined]
    if image.mode != "L" or tags.get(COMPRESSION, 1) != 1 or STRIPS not in tags:
        return None
    if tags.get(PHOTOMETRIC) != BLACK_IS_ZERO or tags.get(BITS) != (8,):
        return None
    begins, sizes = np.array(tags[STRIPS]), np.array(tags[STRIP_BYTES])
    columns, rows = image.size
    if np.any(begins[1:] != begins[:-1] + sizes[:-1]) or sizes.sum() != rows * columns:
        return None
    own = Path(stream.name).open("rb")  # noqa: SIM115 - it stays open while rows are read
    return Rows(own, (rows, columns), int(begins[0]))


def _of_tiff(image: Image, stream: BinaryIO) -> Iterator[Bytes] | None:
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
            kind, letter = (3, "H") if tag in (BITS, 320) else (4, "I")
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
