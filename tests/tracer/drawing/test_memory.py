"""Memory for the sheet: what a sheet was in goes back to the system as soon as it is free."""

from __future__ import annotations

import platform
import subprocess
import sys

import pytest

IN_A_PROCESS_OF_ITS_OWN = """
import ctypes

import numpy as np

from morfax.tracer.drawing.memory import SHEET_BYTES, give_back

FIELDS = "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost"


class Info(ctypes.Structure):  # what glibc tells of its memory (mallinfo2)
    _fields_ = [(name, ctypes.c_size_t) for name in FIELDS.split()]


def alone_bytes():  # how much memory is the system's own, in pieces that go back to it each by itself
    asked = ctypes.CDLL(None).mallinfo2
    asked.restype = Info
    return int(asked().hblkhd)


larger = np.empty(4 * SHEET_BYTES - 100_000, np.uint8)
del larger
give_back()
before = alone_bytes()
sheet = np.empty(2 * SHEET_BYTES, np.uint8)
assert alone_bytes() - before >= sheet.nbytes, "the sheet lies among small things"
del sheet
assert alone_bytes() - before < SHEET_BYTES, "the sheet was not given back"
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="glibc alone keeps memory so")
def test_a_sheet_is_in_memory_of_its_own_also_after_a_larger_one_has_gone() -> None:
    """Else glibc takes what has gone for usual, and puts the next sheet among small things, which last.

    In a process of its own: what other tests have freed would have room for the sheet.
    """
    ran = subprocess.run(
        [sys.executable, "-c", IN_A_PROCESS_OF_ITS_OWN], capture_output=True, text=True
    )
    assert ran.returncode == 0, ran.stderr
