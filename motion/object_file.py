"""Object files: what a compiler wrote, and where in it everything lies (ELF of 64 bits, for x86-64).

Signals in: the bytes of an object file. Signals out: its sections, symbols and gaps (relocations).

Source: System V ABI, chapter 4, and its AMD64 supplement. Questions: none.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import NamedTuple

# how a file of 64 bits, lowest byte first, begins; and its kind and machine: to be linked, x86-64
BEGINS, TO_BE_LINKED = b"\x7fELF\x02\x01", b"\x01\x00\x3e\x00"
SECTIONS_AT, SECTION_COUNT_AT = 40, 60  # bytes from the beginning of the file
SECTION_FIELDS = struct.Struct("<IIQQQQIIQQ")
SYMBOL_FIELDS, GAP_FIELDS = struct.Struct("<IBBHQQ"), struct.Struct("<QIIq")

CONTENT, SYMBOLS, GAPS, ZEROS = 1, 2, 4, 8  # kinds of section
WRITTEN, LOADED = 1, 2  # flags of a section
ELSEWHERE, VARIABLE = (
    0,
    0xFFF2,
)  # in place of a symbol's section: another file; not in the file yet
GLOBAL = 16  # kinds of symbol from here on are known to other files


class Section(NamedTuple):
    """A part of a file."""

    kind: int
    flags: int
    at: int  # bytes from the beginning of the file
    size_bytes: int
    link: int  # number of the section that has its names
    about: int  # number of the section whose gaps these are
    align_bytes: int


class Symbol(NamedTuple):
    """A name for a place."""

    name: str
    is_global: bool
    section: int
    at: int  # bytes from the beginning of the section
    size_bytes: int


class Relocation(NamedTuple):
    """A place in a section into which an address is filled."""

    at: int  # bytes from the beginning of the section
    kind: int
    symbol: int  # number of the symbol whose address is asked for
    more: int  # bytes on from there


class ObjectFile:
    """An object file; NotImplementedError if it is for another kind of machine."""

    def __init__(self, code: bytes) -> None:
        """Take the bytes of the file."""
        if not code.startswith(BEGINS) or code[16:20] != TO_BE_LINKED:
            raise NotImplementedError("no object file for x86-64")
        self._code = code
        (begin,) = struct.unpack_from("<Q", code, SECTIONS_AT)
        (count,) = struct.unpack_from("<H", code, SECTION_COUNT_AT)
        rows = code[begin : begin + count * SECTION_FIELDS.size]
        self.sections = [
            Section(kind, flags, at, size, link, about, align)
            for _, kind, flags, _, at, size, link, about, align, _ in SECTION_FIELDS.iter_unpack(
                rows
            )
        ]
        self.symbols = list(self._symbols())

    def content(self, section: Section) -> bytes:
        """What is in a section."""
        return self._code[section.at : section.at + section.size_bytes]

    def gaps(self) -> Iterator[tuple[int, Relocation]]:
        """All gaps, each with the number of its section."""
        for section in self.sections:
            if section.kind == GAPS:
                for fields in GAP_FIELDS.iter_unpack(self.content(section)):
                    yield section.about, Relocation(*fields)

    def _symbols(self) -> Iterator[Symbol]:
        """All symbols, in the order of their numbers."""
        (table,) = (section for section in self.sections if section.kind == SYMBOLS)
        names = self.content(self.sections[table.link])
        for begin, kind, _, section, at, size in SYMBOL_FIELDS.iter_unpack(self.content(table)):
            name = names[begin : names.index(b"\0", begin)].decode()
            yield Symbol(name, kind >= GLOBAL, section, at, size)
