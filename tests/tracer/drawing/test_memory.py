"""Memory for the sheet: what a sheet was in goes back to the system as soon as it is free."""

from __future__ import annotations

import ctypes
import platform

import numpy as np
import pytest

from morfax.tracer.drawing.memory import SHEET_BYTES, give_back

FIELDS = "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost"


class _Info(ctypes.Structure):
    """What glibc tells of its memory (mallinfo2)."""

    _fields_ = [(name, ctypes.c_size_t) for name in FIELDS.split()]


def alone_bytes() -> int:
    """How much memory is the system's own, in pieces that go back to it each by itself."""
    asked = ctypes.CDLL(None).mallinfo2
    asked.restype = _Info
    return int(asked().hblkhd)


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="glibc alone keeps memory so")
def test_a_sheet_is_in_memory_of_its_own_also_after_a_larger_one_has_gone() -> None:
    """Else glibc takes what has gone for usual, and puts the next sheet among small things, which last."""
    larger = np.empty(4 * SHEET_BYTES - 100_000, np.uint8)
    del larger
    give_back()
    before = alone_bytes()
    sheet = np.empty(2 * SHEET_BYTES, np.uint8)
    assert alone_bytes() - before >= sheet.nbytes
    del sheet
    assert alone_bytes() - before < SHEET_BYTES
