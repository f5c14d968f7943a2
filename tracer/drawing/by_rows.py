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

import tempfile
import weakref
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing import png_rows, tiff_rows
from morfax.tracer.drawing.exif import ORIENTATION

if TYPE_CHECKING:
    from PIL.Image import Image

Bytes = NDArray[np.uint8]

UPRIGHT = (None, 1)


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


def bytes_of(image: Image, stream: BinaryIO) -> Bytes | None:
    """All grey levels of a TIFF whose pixels stand in the file as they are, read once; None of another."""
    if image.format != "TIFF" or not _is_plain(image):
        return None
    straight = tiff_rows.not_packed(image, stream)
    return None if straight is None else Rows(straight[0], image.size[::-1], straight[1])[:]


def _is_plain(image: Image) -> bool:
    """Whether a picture is upright and not transparent."""
    return image.getexif().get(ORIENTATION) in UPRIGHT and "transparency" not in image.info


def _rows_of(image: Image, stream: BinaryIO) -> Rows | None:
    """The same."""
    if not _is_plain(image):
        return None
    parts: Iterator[Bytes] | None = None
    if image.format == "PNG":
        parts = png_rows.parts_of(image, stream)
    elif image.format == "TIFF" and image.mode in ("1", "L", "P", "RGB"):
        straight = tiff_rows.not_packed(image, stream)
        if straight is not None:
            return Rows(straight[0], image.size[::-1], straight[1])
        parts = tiff_rows.parts_of(image, stream)
    if parts is None:
        return None
    columns, rows = image.size
    unpacked = Rows(tempfile.TemporaryFile(), (rows, columns))  # type: ignore[arg-type]  # noqa: SIM115
    unpacked.fill(parts)
    return unpacked
