"""Program files as text: lines with their numbers, entries of a header, and a check sum in the last line.

A program file is ASCII, its first line names kind and version, its last line is

    end crc32 8f3a09c1

the CRC-32 of all lines before it, each stripped and followed by a newline. Blank lines and lines that begin
with # are passed over and not summed. With the sum a changed digit anywhere is a fault, even one that makes
sense, such as another size of the steps. A file whose last line is `end` alone is read too; `summed` tells.

Source: CRC-32 as of zlib, which finds every change within 32 bits in a row. Questions: none of the patents
has a check sum; the SEA tape (US 3062995) checks places, the others nothing.
"""

from __future__ import annotations

import os
import zlib
from collections.abc import Iterable, Iterator
from pathlib import Path as FilePath

from morfax.motion.faults import SHOWN, FileFault, ProgramFault
from morfax.motion.files import written_beside

AGAIN = "record it again"
_END = "end"


def demand(good: bool, name: str, value: object, allowed: str) -> None:
    """Raise ValueError with the entry, the value got and the values allowed."""
    if not good:
        raise ValueError(f"{name} is {' '.join(str(value)[:60].split())}; it must be {allowed}")


def write_lines(file: str | os.PathLike[str], lines: Iterable[str]) -> None:
    """Write the lines of a program, and the last one with their check sum."""
    total = 0
    with (
        written_beside(file) as beside,
        beside.open("w", encoding="ascii", newline="\n") as out,
    ):
        for line in lines:
            out.write(line + "\n")
            total = _added(total, line)
        out.write(f"{_END} crc32 {total:08x}\n")


class Lines:
    """The lines of a program file that count, one after the other; raises ProgramFault, FileFault."""

    def __init__(self, file: str | os.PathLike[str], kind: str, version: int) -> None:
        self.file, self.number, self.summed = FilePath(file), 1, False
        self._total, self._ended = 0, False
        self._left = self._counted(_text(self.file, kind))
        self._check_version(f"morfax {kind}", kind, version)

    def __iter__(self) -> Iterator[str]:
        """The lines up to the last one, whose check sum must be right."""
        for line in self._left:
            if line.split()[0] == _END:
                self._end(line)
                return
            self._total = _added(self._total, line)
            yield line

    def entry(self, name: str) -> list[str]:
        """The words behind the name of an entry, which the next line must hold."""
        line = next(iter(self), "")
        words = line.split()
        if not words or words[0] != name:
            raise self.fault(f"{line[:SHOWN]!r} instead of {name}")
        return words[1:]

    def numbers(self, name: str) -> tuple[float, ...]:
        """The numbers of an entry."""
        words = self.entry(name)
        try:
            return tuple(float(word) for word in words)
        except ValueError:
            got = " ".join([name, *words])[:SHOWN]
            raise self.fault(f"{got!r} is no number") from None

    def fault(self, what: str) -> ProgramFault:
        """The fault of the present line."""
        return ProgramFault(
            f"{self.file}, line {self.number}: {what}; {AGAIN}", line=self.number
        )

    def header_fault(self, error: ValueError) -> ProgramFault:
        """The fault of an entry whose value cannot be."""
        return ProgramFault(f"{self.file}, header: {error}; {AGAIN}")

    def check_whole(self, got: int, stated: int, what: str) -> None:
        """Raise ProgramFault unless the file has its last line, and as many rows as it states."""
        if not self._ended:
            raise ProgramFault(
                f"{self.file} is cut short: {got} of {stated} {what} and no end; copy it again or {AGAIN}"
            )
        if got != stated:
            raise ProgramFault(
                f"{self.file} holds {got} of the {stated} {what} that it states; copy it again or {AGAIN}"
            )

    def _counted(self, text: str) -> Iterator[str]:
        """The lines that are neither blank nor remarks."""
        for self.number, line in enumerate(text.splitlines(), 1):
            if line.strip() and not line.startswith("#"):
                yield line.strip()

    def _check_version(self, header: str, kind: str, version: int) -> None:
        """Raise ProgramFault unless the first line names this kind of program and a version that is known."""
        line = next(iter(self), "")
        if line.split()[:2] != header.split():
            raise ProgramFault(
                f"{self.file} is no {kind} program: it must begin with '{header} {version}'; give another",
                line=1,
            )
        if line != f"{header} {version}":
            raise ProgramFault(
                f"{self.file}, line {self.number}: the format is version {line.split()[-1][:20]}; "
                f"this program reads {version}: use a later one",
                line=self.number,
            )

    def _end(self, line: str) -> None:
        """Check the sum in the last line, if there is one."""
        self._ended = True
        words = line.split()
        if words == [_END]:
            return
        stated = f"{_END} crc32 {self._total:08x}"
        if words[:2] != stated.split()[:2] or len(words) != 3:
            raise self.fault(f"{line[:SHOWN]!r} must be '{_END} crc32' and eight digits")
        if line != stated:
            raise ProgramFault(
                f"{self.file}: a character is wrong somewhere: the check sum is {words[2][:16]}, "
                "the lines give "
                f"{self._total:08x}; copy it again, or {AGAIN}; if you have changed it, end it with "
                "'end' alone"
            )
        self.summed = True


def note_of_no_sum(file: str | os.PathLike[str]) -> str:
    """The note on a program file without a check sum."""
    return f"{file} has no check sum: a digit changed by mistake would not be noticed; {AGAIN} to have one"


def _added(total: int, line: str) -> int:
    """The check sum with one more line."""
    counted = line.strip()
    if not counted or line.startswith("#"):
        return total
    return zlib.crc32(counted.encode("ascii") + b"\n", total)


def _text(file: FilePath, kind: str) -> str:
    """The text of a file."""
    try:
        return file.read_bytes().decode("ascii")
    except UnicodeDecodeError as error:
        raise ProgramFault(
            f"{file} is no {kind} program: byte {error.start} is no ASCII text; give another"
        ) from None
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from error
