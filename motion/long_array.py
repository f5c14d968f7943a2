"""Long arrays: rows that come one after the other, kept in memory up to a limit and in a file beyond it.

Signals: blocks of rows (n, columns) in; all of them as one array out, in the units that came in.

    rows ──►  newest, in memory  ──(32 MB)──►  a file without a name, which is gone with the array
                                                  │
    one array  ◄──  mapped: what is read comes into memory, and leaves it when a block is done (`blocks`)

30 m of line are 18 million positions of the head, 288 MB. Nothing but the newest of them need be in memory,
and what goes through all of them goes block by block. Up to the limit, 3.5 m of line at 10 mm/s, nothing
changes: there is one block. A mapped array is an array like any other, so what needs a place here and there
asks for it; only memory that is given back by `released` is not held until the end.

Source: our own. Questions: the file is in the folder for temporary files (`TMPDIR`). Where that folder is
itself in memory (tmpfs), the rows are too.
"""

from __future__ import annotations

import mmap
import tempfile
import weakref
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from morfax.motion.arrays import Array, bounds
from morfax.motion.faults import FileFault

# of one array: 2 million positions, 3.5 m of line at 10 mm/s; chosen
IN_MEMORY_BYTES = 32_000_000
BLOCK_ROWS = 240_000  # that are looked at together: 4 MB of positions, 40 s; chosen


@dataclass(slots=True)
class _Part:
    """Rows that copies share: when one of them puts all its rows together, these are a part of that."""

    rows: Array


class LongArray:
    """Rows of float64 that grow. What is in its file is never changed, so that copies share it."""

    def __init__(self, columns: int = 2) -> None:
        self._columns = columns
        # rows in files (the file, the first byte there, how many rows), and the newest, in memory
        self._filed = list[tuple[_File, int, int]]()
        self._newest = list[_Part]()
        self._newest_rows = 0

    def __len__(self) -> int:
        """How many rows there are."""
        return self._filed_rows + self._newest_rows

    @property
    def _filed_rows(self) -> int:
        """How many of them are in files."""
        return sum(rows for _, _, rows in self._filed)

    @property
    def last(self) -> Array:
        """The last row."""
        return self._newest[-1].rows[-1] if self._newest else self.since(len(self) - 1)[0]

    def add(self, rows: Array) -> None:
        """Add rows (n, columns), which are copied; raises FileFault where there is no room for a file."""
        if not len(rows):
            return
        self._newest.append(_Part(np.array(rows, float)))
        self._newest_rows += len(rows)
        if 8 * self._columns * self._newest_rows > IN_MEMORY_BYTES:
            self._to_file()

    def cut(self, count: int) -> None:
        """Keep the first `count` rows."""
        kept, over = list[tuple[_File, int, int]](), count
        for file, first, rows in self._filed:
            if over > 0:
                kept.append((file, first, min(rows, over)))
            over -= rows
        newest = list[_Part]()
        for part in self._newest:
            if over > 0:
                newest.append(part if over >= len(part.rows) else _Part(part.rows[:over]))
            over -= len(part.rows)
        self._filed, self._newest = kept, newest
        self._newest_rows = sum(len(part.rows) for part in newest)

    def since(self, count: int) -> Array:
        """The rows from one on, (n, columns)."""
        missing = len(self) - count
        parts = list[Array]()
        for part in reversed(self._newest):
            if missing > 0:
                parts.append(part.rows[-missing:])
            missing -= len(part.rows)
        if missing > 0:
            return self.whole()[count:]
        return np.vstack(parts[::-1]) if parts else np.empty((0, self._columns))

    def whole(self) -> Array:
        """All rows as one array, (n, columns), not to be changed: a mapped one, if any are in a file."""
        if not self._filed:
            return self._in_one()
        if self._newest:
            self._to_file()
        if len(self._filed) > 1:  # cut, or copied, and gone on from there
            parts = [
                file.mapped(first, rows, self._columns) for file, first, rows in self._filed
            ]
            together = _File()
            for part in parts:
                for block in blocks(part):
                    together.append([block])
            self._filed = [(together, 0, len(self))]
        file, first, rows = self._filed[0]
        return file.mapped(first, rows, self._columns)

    def _in_one(self) -> Array:
        """The newest rows as one array, put together once, for copies too; it is not to be changed."""
        if not self._newest:
            return np.empty((0, self._columns))
        if len(self._newest) > 1:
            together = np.vstack([part.rows for part in self._newest])
            ends = np.cumsum([len(part.rows) for part in self._newest])
            for part, rows in zip(self._newest, np.split(together, ends[:-1]), strict=True):
                part.rows = rows
            self._newest = [_Part(together)]
        return self._newest[0].rows

    def _to_file(self) -> None:
        """Put the newest rows into the file, behind what is there."""
        file = self._filed[-1][0] if self._filed else _File()
        at, rows = file.append([part.rows for part in self._newest]), self._newest_rows
        self._newest, self._newest_rows = [], 0
        if self._filed:
            _, first, before = self._filed[-1]
            if at == first + 8 * self._columns * before:
                self._filed[-1] = file, first, before + rows
                return
        self._filed.append((file, at, rows))

    def __deepcopy__(self, memo: dict[int, Any]) -> LongArray:
        """A copy that goes on by itself; the rows so far are shared."""
        copied = LongArray(self._columns)
        copied._filed = list(self._filed)
        copied._newest = list(self._newest)
        copied._newest_rows = self._newest_rows
        return copied

    def __getstate__(self) -> dict[str, Any]:
        """What another process needs: all rows."""
        whole = np.array(self.whole())
        return {
            "_columns": self._columns,
            "_filed": [],
            "_newest": [_Part(whole)],
            "_newest_rows": len(whole),
        }


class _File:
    """A file without a name, to which rows are appended. It is gone when nobody holds it, nor its rows."""

    def __init__(self) -> None:
        self._end = 0
        try:
            self._file = tempfile.TemporaryFile()  # noqa: SIM115 -- it is open as long as its rows are
        except OSError as error:
            raise _no_room(error) from error
        weakref.finalize(self, self._file.close)

    def append(self, parts: list[Array]) -> int:
        """Append parts (n, columns); the number of their first byte."""
        at = self._end
        try:
            for part in parts:
                self._file.write(np.ascontiguousarray(part).data)
            self._file.flush()
        except OSError as error:
            raise _no_room(error) from error
        self._end += sum(part.nbytes for part in parts)
        return at

    def mapped(self, first_byte: int, rows: int, columns: int) -> Array:
        """Rows from a byte on."""
        if not rows:
            return np.empty((0, columns))
        bytes_ = mmap.mmap(self._file.fileno(), first_byte + 8 * rows * columns)
        values = np.frombuffer(bytes_, np.float64, rows * columns, first_byte)
        return values.reshape(rows, columns)


def filed(parts: list[Array]) -> list[Array]:
    """Some arrays (n, columns) behind each other in a file, each mapped; FileFault where it has no room."""
    if not parts:
        return []
    file, ends = _File(), np.cumsum([len(part) for part in parts])
    whole = file.mapped(file.append(parts), int(ends[-1]), parts[0].shape[1])
    return np.split(whole, ends[:-1])


def blocks(rows: Array, before: int = 0, every: int = 1) -> Iterator[Array]:
    """The rows of an array in blocks, each with as many rows `before` its own as are there.

    The first row of a block's own is a multiple of `every`. An array in memory is one block; a block of a
    mapped one is given back when the next is asked for.
    """
    if not is_mapped(rows) or not len(rows):
        yield rows
        return
    size = BLOCK_ROWS - BLOCK_ROWS % every
    for first in range(0, len(rows), size):
        block = rows[max(0, first - before) : first + size]
        yield block
        released(block)


def one_in(rows: Array, every: int) -> Array:
    """One row in so many, the first of them first; an array in memory gives a view of itself."""
    if not is_mapped(rows) or not len(rows):
        return rows[::every]
    return np.vstack([block[::every].copy() for block in blocks(rows, every=every)])


def bounds_by_blocks(rows: Array) -> tuple[Array, Array]:
    """The lowest and the highest of each column of rows (n, columns), of which there is one at least."""
    lows, highs = zip(*(bounds(block) for block in blocks(rows)), strict=True)
    return np.min(lows, axis=0), np.max(highs, axis=0)


def released(rows: Array) -> None:
    """Give back the memory of mapped rows (which are read again when they are asked for); else nothing."""
    mapped = _map_of(rows)
    if mapped is None or not hasattr(mapped, "madvise"):
        return
    begin, _ = np.frombuffer(mapped, np.uint8).__array_interface__["data"]
    if rows.flags.c_contiguous:
        low, _ = rows.__array_interface__["data"]
        high = low + rows.nbytes
    else:
        low, high = np.lib.array_utils.byte_bounds(rows)
    page = mmap.PAGESIZE
    first = (low - begin) // page * page
    mapped.madvise(mmap.MADV_DONTNEED, first, min(high - begin, len(mapped)) - first)


def is_mapped(rows: Array) -> bool:
    """Whether an array is in a file."""
    return _map_of(rows) is not None


def _map_of(rows: Array) -> mmap.mmap | None:
    """What an array is mapped by; None for one in memory."""
    base: Any = rows
    while isinstance(base, np.ndarray):
        base = base.base
    if isinstance(base, memoryview):
        base = base.obj
    return base if isinstance(base, mmap.mmap) else None


def _no_room(error: OSError) -> FileFault:
    """The fault of a folder that takes no temporary file."""
    return FileFault(
        f"cannot keep the positions of a long line in {tempfile.gettempdir()}: {error.strerror}; a metre of"
        " line takes 10 MB there: make room, or set TMPDIR to another folder"
    )
