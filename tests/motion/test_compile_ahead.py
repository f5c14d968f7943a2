"""Kernels that other cores compile on a first run: the list, who compiles, and that nobody does it twice."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from morfax.motion import compile_ahead, machine_code
from morfax.motion.compile_ahead import SWITCH, begin, examples
from morfax.motion.compiled import Kernel, described

LISTED = [line.split("\t") for line in compile_ahead.LIST.read_text().splitlines()]
KERNEL = """
from typing import NamedTuple
import numpy as np
from morfax.motion.compiled import njit

class Pair(NamedTuple):
    one: float
    two: np.ndarray

@njit(cache=True)
def swapped(pair, values):
    return pair.two[0] * values[0], pair.one
"""
CALL = """
import sys
import numpy as np
from morfax.motion import compiled
here = compiled.Kernel._compiled_here
compiled.Kernel._compiled_here = lambda *words: print("compiled") or here(*words)
from kernel import Pair, swapped
swapped(Pair(2.0, np.arange(1.0, 3.0)), np.ones((4, 4), np.float32)[::2, 1])
print("numba" if "numba.core" in sys.modules else "no numba")
"""
AHEAD = """
import os
from pathlib import Path
from morfax.motion import compile_ahead
compile_ahead.LIST = Path("list.tsv")
compile_ahead.compile_listed(os.getppid(), 2, 1)
"""
ARRAYS = (
    np.zeros((3, 4)),
    np.zeros((3, 4)).T,
    np.zeros((3, 4))[::2, ::2],
    np.zeros(3, np.uint8),
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a kernel."""
    (tmp_path / "kernel.py").write_text(KERNEL)
    return tmp_path


def started(folder: Path, program: str) -> subprocess.Popen[str]:
    """A process in a folder, whose kernels are kept there too."""
    environment = {
        **os.environ,
        "NUMBA_CACHE_DIR": str(folder / "kept"),
        "PYTHONPATH": os.pathsep.join([str(folder), *sys.path]),
    }
    return subprocess.Popen(
        [sys.executable, "-c", program],
        cwd=folder,
        env=environment,
        text=True,
        stdout=subprocess.PIPE,
    )


@pytest.mark.parametrize(
    "of", [*ARRAYS, 1.0, 1, True, None, np.float32(1), (1.0, (2, ARRAYS[2]))]
)
def test_types_are_told_and_made_again(of: Any) -> None:
    types = described((of, 1.0))
    assert described(examples(types)) == types


def test_arrays_that_are_read_only_or_lie_between_addresses_are_made_again() -> None:
    between = np.zeros(17, np.uint8)[1:].view(np.float64)
    fixed = np.zeros(3)
    fixed.setflags(write=False)
    for array in (between, fixed):
        types = described((array,))
        assert described(examples(types)) == types
        assert types != described((np.zeros(3),))


@pytest.mark.parametrize(("module", "name", "types"), LISTED)
def test_the_list_names_kernels_and_types_that_there_are(
    module: str, name: str, types: str
) -> None:
    """A kernel that was renamed, or whose records have other fields, would be compiled late again."""
    assert isinstance(getattr(importlib.import_module(module), name), Kernel)
    assert described(examples(types)) == types


@pytest.mark.skipif(not machine_code.can_be_kept(), reason="numba runs the kernels here")
def test_what_was_compiled_ahead_is_not_compiled_again(folder: Path) -> None:
    """It is named by its types alone; what the list has and the code has not is passed over."""
    types = "named('kernel', 'Pair')(f8, array(dtype('float64'), 1, 'C'),), array(dtype('float32'), 1, 'A'),"
    lines = [
        f"no_such\tkernel\t{types}",
        f"kernel\tno_such\t{types}",
        f"kernel\tswapped\t{types}",
    ]
    (folder / "list.tsv").write_text("\n".join(lines))
    assert started(folder, AHEAD).communicate()[0] == ""
    assert started(folder, CALL).communicate()[0] == "no numba\n"


@pytest.mark.skipif(not machine_code.can_be_kept(), reason="numba runs the kernels here")
def test_of_two_processes_that_need_a_kernel_one_compiles_it(folder: Path) -> None:
    pytest.importorskip("fcntl")
    both = [started(folder, CALL), started(folder, CALL)]
    said = [process.communicate()[0] for process in both]
    assert [process.returncode for process in both] == [0, 0]
    assert sum(text.count("compiled") for text in said) == 1


def test_each_begins_with_a_part_of_its_own_and_the_first_is_the_run_s(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else all would stand before the same kernel, and one of them compile."""
    taken: list[str] = []

    class Kernels:
        def __getattr__(self, name: str) -> Any:
            return self

        def compile_for(self, types: str, args: tuple[Any, ...]) -> None:
            taken.append(types)

    monkeypatch.setattr(compile_ahead, "LIST", tmp_path / "list.tsv")
    compile_ahead.LIST.write_text("\n".join(f"a\tb\tnamed({k}, 'x')" for k in range(7)))
    monkeypatch.setattr(compile_ahead, "examples", lambda types: ())
    monkeypatch.setattr(compile_ahead.importlib, "import_module", lambda name: Kernels())
    compile_ahead.compile_listed(os.getppid(), 3, 1)
    assert [int(types[6]) for types in taken] == [2, 3, 4, 5, 6, 0, 1]
    # and none for a process that has ended
    taken.clear()
    compile_ahead.compile_listed(-1, 3, 1)
    assert taken == []


@pytest.mark.parametrize(
    ("cores", "switch", "expected"),
    [(1, None, 0), (2, None, 1), (3, None, 2), (64, None, 3), (8, "0", 0)],
)
def test_one_core_is_left_to_the_run_and_the_switch_turns_it_off(
    monkeypatch: pytest.MonkeyPatch, cores: int, switch: str | None, expected: int
) -> None:
    begun: list[dict[str, Any]] = []

    class Started:
        def __init__(self, command: list[str], **how: Any) -> None:
            begun.append(how)

        def terminate(self) -> None:
            raise AssertionError

    monkeypatch.setattr(compile_ahead.subprocess, "Popen", Started)
    monkeypatch.setattr(compile_ahead, "_cores", lambda: range(cores))
    monkeypatch.setattr(compile_ahead.atexit, "register", lambda end: None)
    monkeypatch.delenv(SWITCH, raising=False)
    if switch is not None:
        monkeypatch.setenv(SWITCH, switch)
    begin()
    assert len(begun) == expected
    assert all(how["env"][SWITCH] == "0" for how in begun)  # they start no others
