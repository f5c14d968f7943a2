"""Placing: object code of a kernel is put where the process can run it, with the addresses that it asks for.

    sections with code and constants ─> pages of their own ─┐
    gaps: the address of a name, and so much ─> filled in ──┴> run

Object code that numba makes for this kind of machine has few kinds of parts: a gap is 64 bits wide and holds
a whole address, and what may be written to are pointers that numba sets. Code with other parts, or for other
machines, cannot be placed here (`NotImplementedError`); llvmlite places it (`kernel_linker`), and its library
takes 48 MB of the process.

Signals in: object code; addresses by names. Signals out: addresses of the functions in it.

Source: our own. Questions: tables for unwinding are left out, for no exception of C++ passes through a
kernel; numba's own are plain results.
"""

from __future__ import annotations

import ctypes
import mmap
import struct
from collections.abc import Callable
from typing import Any

from morfax.motion import object_file
from morfax.motion.object_file import ObjectFile, Section, Symbol

WHOLE_ADDRESS = 1  # the kind of gap that is filled here: 64 bits
POINTER_BYTES = 8
READ_AND_RUN = mmap.PROT_READ | mmap.PROT_EXEC

_RUN = list[
    tuple[mmap.mmap, Any]
]()  # pages with code, and its pointers, last as long as the process


def placed(code: bytes, address_of: Callable[[str], int]) -> dict[str, int]:
    """Put object code into pages that are run; give the addresses of its functions and pointers, by names.

    `address_of` gives that of a function elsewhere. Raises NotImplementedError for what cannot be placed
    here, OSError if the system gives no pages to run.
    """
    file = ObjectFile(code)
    # 1. sections, each where its kind may lie
    offsets, size = _offsets(file.sections)
    pages = mmap.mmap(-1, size, mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    begin = ctypes.addressof(ctypes.c_char.from_buffer(pages))
    for number, offset in offsets.items():
        section = file.sections[number]
        pages[offset : offset + section.size_bytes] = file.content(section)
    # 2. the addresses of all names, in the gaps that ask for them
    pointers = (ctypes.c_void_p * len(file.symbols))()
    begins = {number: begin + offset for number, offset in offsets.items()}
    own = _addresses(file.symbols, begins, ctypes.addressof(pointers))
    for number, gap in file.gaps():
        if number in offsets:
            if gap.kind != WHOLE_ADDRESS:
                raise NotImplementedError(f"a gap of kind {gap.kind}")
            address = own[gap.symbol] or address_of(file.symbols[gap.symbol].name)
            struct.pack_into("<Q", pages, offsets[number] + gap.at, address + gap.more)
    # 3. from now on the pages are run, and no longer written to
    _have_run(begin, size)
    _RUN.append((pages, pointers))
    return {
        symbol.name: address
        for symbol, address in zip(file.symbols, own, strict=True)
        if symbol.is_global
    }


def _offsets(sections: list[Section]) -> tuple[dict[int, int], int]:
    """Where each section that is run or read comes, bytes from the beginning of its pages, and their end."""
    offsets, end = dict[int, int](), 0
    for number, section in enumerate(sections):
        if section.flags & object_file.WRITTEN or section.kind == object_file.ZEROS:
            raise NotImplementedError("a section that is written to")
        if section.kind == object_file.CONTENT and section.flags & object_file.LOADED:
            align = max(1, section.align_bytes)
            offsets[number] = -(-end // align) * align
            end = offsets[number] + section.size_bytes
    return offsets, end


def _addresses(symbols: list[Symbol], begins: dict[int, int], pointers: int) -> list[int]:
    """The address of each symbol: in sections that begin at these, among pointers, or 0: elsewhere."""
    addresses = list[int]()
    for number, symbol in enumerate(symbols):
        if symbol.section == object_file.VARIABLE:
            if symbol.size_bytes != POINTER_BYTES:
                raise NotImplementedError("a variable that is no pointer")
            addresses.append(pointers + number * POINTER_BYTES)
        else:
            begin = begins.get(symbol.section)
            addresses.append(0 if begin is None else begin + symbol.at)
    return addresses


def _have_run(begin: int, size: int) -> None:
    """Have the system run pages from an address on."""
    protect = ctypes.CDLL(None, use_errno=True).mprotect
    protect.argtypes = (ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int)
    if protect(begin, size, READ_AND_RUN) != 0:
        raise OSError(ctypes.get_errno(), "no pages to run code in")
