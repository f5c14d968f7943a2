"""The processor that kernels are compiled for: one level for all machines that have it, else their own."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from morfax.motion.processor import (
    CPUINFO,
    IN_LINUX,
    LEVEL,
    LEVEL_HAS,
    Processor,
    has_level,
    here,
    target,
)

OLDER = "sse2 avx"


class Features(dict[str, bool]):
    """What llvmlite says of a processor."""

    def flatten(self) -> str:
        """All of it as a text, as LLVM takes it."""
        return ",".join(f"+{name}" for name, there in self.items() if there)


class Llvm:
    """`llvmlite.binding` of a machine that is not this one."""

    def __init__(self, features: str, triple: str = "x86_64-unknown-linux-gnu") -> None:
        self.features, self.triple = features, triple

    def get_host_cpu_name(self) -> str:
        """The processor's name in LLVM's words."""
        return "its-own"

    def get_host_cpu_features(self) -> Features:
        """What it has, and one thing that it has not."""
        return Features({name: True for name in self.features.split()} | {"amx": False})

    def get_process_triple(self) -> str:
        """The kind of machine."""
        return self.triple


@pytest.fixture(autouse=True)
def nothing_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    """No processor is asked for by numba's settings."""
    monkeypatch.delenv("NUMBA_CPU_NAME", raising=False)
    monkeypatch.delenv("NUMBA_CPU_FEATURES", raising=False)


def test_machines_that_have_the_level_share_their_code() -> None:
    has = " ".join(LEVEL_HAS)
    assert target(Llvm(has)) == target(Llvm(f"{has} avx512f")) == Processor(LEVEL, "")


@pytest.mark.parametrize("missing", sorted(LEVEL_HAS))
def test_a_machine_that_lacks_a_part_of_the_level_has_code_of_its_own(missing: str) -> None:
    found = target(Llvm(" ".join(sorted(LEVEL_HAS - {missing}))))
    assert found.name == "its-own"
    assert f"+{missing}," not in f"{found.features},"


def test_another_kind_of_machine_has_code_of_its_own() -> None:
    has = " ".join(LEVEL_HAS)
    assert target(Llvm(has, "aarch64-apple-darwin")).name == "its-own"


def test_numba_s_own_setting_goes_before(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CPU_NAME", "nehalem")
    assert target(Llvm(" ".join(LEVEL_HAS))) == Processor("nehalem", "")


NUMBA_FIRST = """
import numba
numba.njit(lambda x: x + 1)(1)  # numba compiles for this machine's own processor from now on
from morfax.motion import machine_code
from morfax.motion.drive import drive_step
aimed, before = machine_code.linker().target, machine_code._makings(drive_step)
drive_step.dispatcher("whole")
found, after = machine_code.linker().target, machine_code._makings(drive_step)
assert aimed.features or found.features, found  # not the bare level
assert (found == aimed) == (before == after)
"""


def test_code_made_for_another_processor_is_not_kept_as_the_level_s() -> None:
    """Where a program has compiled kernels of its own before, numba has chosen its processor already."""
    done = subprocess.run(
        [sys.executable, "-c", NUMBA_FIRST], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_linux_tells_whether_a_processor_has_the_level(tmp_path: Path) -> None:
    names = sorted(IN_LINUX.get(name, name) for name in LEVEL_HAS)
    file = tmp_path / "cpuinfo"
    file.write_text(f"processor\t: 0\nflags\t\t: fpu {' '.join(names)} avx512f\n")
    assert has_level(file)
    for missing in names:
        file.write_text(f"flags\t\t: fpu {' '.join(n for n in names if n != missing)}\n")
        assert not has_level(file)
    assert not has_level(tmp_path / "none")


@pytest.mark.skipif(not CPUINFO.exists(), reason="no Linux")
def test_linux_and_llvm_tell_the_same() -> None:
    import llvmlite.binding as llvm

    kind, processor = here()
    assert (kind, processor) == (llvm.get_process_triple(), target(llvm))
