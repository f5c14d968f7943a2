"""Object code that is placed by ourselves: the same results as LLVM's, and other kinds are refused."""

from __future__ import annotations

import struct
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

from morfax.motion import kernel_linker, machine_code, placed_code, processor
from morfax.motion.compiled import described
from morfax.motion.kernel_folder import kernel_folder
from morfax.motion.kernel_linker import Entry, Linker
from morfax.motion.object_file import GAP_FIELDS, GAPS, SECTION_FIELDS, SECTIONS_AT, ObjectFile
from morfax.motion.placed_code import placed
from morfax.motion.polyline import _kept

pytestmark = [
    pytest.mark.skipif(not machine_code.can_be_kept(), reason="numba runs the kernels here"),
    pytest.mark.skipif(
        machine_code.can_be_kept() and kernel_linker.linker().triple != processor.LINUX,
        reason="llvmlite links on this kind of machine",
    ),
]


@pytest.fixture(scope="module")
def asked() -> tuple[Any, ...]:
    """Arguments of a kernel that has constants, loops and arrays that it gives back."""
    return np.random.default_rng(3).normal(size=(300, 2)).cumsum(axis=0), 0.8


@pytest.fixture(scope="module")
def entry(asked: tuple[Any, ...]) -> Entry:
    """What is kept of that kernel."""
    _kept(*asked)
    return machine_code._read(_kept, kernel_folder())[described(asked)]


def test_placed_code_and_llvm_s_give_the_same_to_the_bit(
    asked: tuple[Any, ...], entry: Entry, monkeypatch: pytest.MonkeyPatch
) -> None:
    ours = Linker()
    own = ours.function(_kept, entry)(*asked)
    assert np.array_equal(own, _kept.py_func(*asked))
    assert 2 < own.sum() < len(own)
    assert "_by_llvm" not in vars(ours)
    monkeypatch.setattr(kernel_linker, "placed", refused)
    other = Linker()
    by_llvm = other.function(_kept, entry)(*asked)
    assert "_by_llvm" in vars(other)
    assert np.array_equal(own, by_llvm)


def refused(*_: Any) -> dict[str, int]:
    """Place nothing."""
    raise NotImplementedError


def changed(code: bytes, at: int, value: bytes) -> bytes:
    """Object code with some bytes changed."""
    return code[:at] + value + code[at + len(value) :]


def section_at(code: bytes, number: int) -> int:
    """Where the record of a section lies in object code."""
    return int(struct.unpack_from("<Q", code, SECTIONS_AT)[0]) + number * SECTION_FIELDS.size


def test_code_of_another_machine_is_refused(entry: Entry) -> None:
    arm = changed(entry[0], 18, b"\xb7")
    for code in (b"", b"\xcf\xfa\xed\xfe" + bytes(80), arm):
        with pytest.raises(NotImplementedError, match="no object file"):
            ObjectFile(code)


def test_a_gap_of_another_kind_is_refused(entry: Entry) -> None:
    code = entry[0]
    gaps = next(s for s in ObjectFile(code).sections if s.kind == GAPS)
    first = list(GAP_FIELDS.unpack_from(code, gaps.at))
    first[1] = 2  # an address of 32 bits, from where the gap is
    with pytest.raises(NotImplementedError, match="gap of kind 2"):
        placed(changed(code, gaps.at, GAP_FIELDS.pack(*first)), lambda _: 0)


def test_a_section_that_is_written_to_is_refused(entry: Entry) -> None:
    code = entry[0]
    at = section_at(code, 3)
    fields = list(SECTION_FIELDS.unpack_from(code, at))
    fields[2] |= 1
    with pytest.raises(NotImplementedError, match="written to"):
        placed(changed(code, at, SECTION_FIELDS.pack(*fields)), lambda _: 0)


def test_a_name_that_nobody_has_is_refused() -> None:
    with pytest.raises(NotImplementedError, match="no such_a_function"):
        Linker()._address("such_a_function")


def test_pages_that_may_not_be_run_are_left_to_llvm(
    asked: tuple[Any, ...], entry: Entry, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        placed_code, "READ_AND_RUN", -1
    )  # no such protection: the system refuses
    with pytest.raises(OSError, match="no pages"):
        placed(entry[0], lambda _: 0)
    other = Linker()
    other.function(_kept, entry)(*asked)
    assert "_by_llvm" in vars(other)


def test_kept_kernels_run_without_llvmlite() -> None:
    """Its library took 48 MB of each process."""
    code = """if True:
        import sys
        import numpy as np
        from morfax.motion.polyline import _kept
        _kept(np.zeros((4, 2)), 0.1)
        print("llvmlite" in sys.modules, "numba" in sys.modules)
        """
    subprocess.run([sys.executable, "-c", code], check=True)  # compiles, if need be
    done = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True
    )
    assert done.stdout == "False False\n"
