"""The manifest of a batch: one JSON object to a line for each drawing, as it ends.

Signals in: rows. Signals out: the file `manifest.jsonl`. A row is appended by one write, so that a run that
is killed leaves whole rows; a drawing that is done once more has a second row, and the last one counts.

Source: JSON Lines. Questions: a last line that is cut short (a full disk) is passed over when it is read.
"""

from __future__ import annotations

import json
import os
from array import array
from bisect import bisect_left
from collections.abc import Iterator
from pathlib import Path

from morfax.batch.row import BatchRow
from morfax.motion.ending import Ending
from morfax.motion.faults import FileFault
from morfax.motion.files import printable

NAME = "manifest.jsonl"
_KNOWN_DIGITS = 16  # of a hash: 8 bytes of memory for each row that was there before


class Manifest(Ending):
    """The manifest of a folder, open for more rows."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / NAME
        self._known = array("Q", sorted(_keys(self._file)))
        is_cut_short = _is_cut_short(self._file)
        try:
            self._stream = self._file.open("ab", buffering=0)
        except OSError as error:
            raise FileFault(
                f"cannot write {self._file}: {error.strerror}; give another folder with -o"
            ) from None
        if is_cut_short:
            self._stream.write(b"\n")

    def end(self, error: BaseException | None) -> None:
        """Close the file."""
        self._stream.close()

    def append(self, row: BatchRow) -> None:
        """Write a row, unless the drawing was there already and has one."""
        if row.kept and self._has(row):
            return
        line = printable(json.dumps(row.as_plain(), ensure_ascii=False)) + "\n"
        self._stream.write(line.encode())

    def _has(self, row: BatchRow) -> bool:
        """Whether there was a row of this hash when the batch began."""
        key = int(row.hash[:_KNOWN_DIGITS], 16)
        place = bisect_left(self._known, key)
        return place < len(self._known) and self._known[place] == key


def rows(folder: Path) -> Iterator[BatchRow]:
    """The rows of a folder's manifest, as they were written; raises FileFault if there is none."""
    file = folder / NAME
    try:
        # a letter that was cut in two makes a line that is no JSON
        with file.open(encoding="utf-8", errors="replace") as stream:
            for line in stream:
                row = _read(line)
                if row is not None:
                    yield row
    except OSError as error:
        raise FileFault(
            f"{file} cannot be read: {error.strerror}; give the folder that morfax batch -o named"
        ) from None


def _keys(file: Path) -> Iterator[int]:
    """The beginnings of the hashes of all rows that have a folder."""
    if not file.exists():
        return
    for row in rows(file.parent):
        if row.hash and row.folder:
            yield int(row.hash[:_KNOWN_DIGITS], 16)


def _is_cut_short(file: Path) -> bool:
    """Whether the last line of a file has no end."""
    if not file.exists() or not file.stat().st_size:
        return False
    with file.open("rb") as stream:
        stream.seek(-1, os.SEEK_END)
        return stream.read() != b"\n"


def _read(line: str) -> BatchRow | None:
    """The row of a line; None of one that was cut short."""
    try:
        return BatchRow.of(json.loads(line))
    except (ValueError, TypeError, AttributeError):
        return None
