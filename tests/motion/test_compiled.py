"""Kernels that are kept on disk: run without numba, same to the bit, and compiled anew when they must be."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from itertools import combinations
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from morfax.motion import compiled, machine_code
from morfax.motion.compiled import Kernel, hear, keeps_kinds, njit
from morfax.motion.drive import drive_step

PART = """
from morfax.motion.compiled import njit
GAIN = 2.0

@njit(cache=True, inline="always")
def part(x):
    return GAIN * x
"""
WHOLE = """
from typing import NamedTuple
import math
import numpy as np
from morfax.motion.compiled import njit
import part_of_it
from part_of_it import part

ROW = np.dtype([("sum", np.float64), ("number", np.int64)])

class Found(NamedTuple):
    sums: np.ndarray
    count: int

@njit(cache=True)
def whole(values, places):
    if len(values) == 0:
        raise ValueError("nothing there")
    sums = np.zeros(len(values), ROW)
    for k in range(len(values)):
        sums[k]["number"] = k
        sums[k]["sum"] = part(values[k]) + math.sin(places[0]) + part_of_it.part(places[1])
    return Found(sums, len(values))
"""
ASKED = """
import json, sys
import numpy as np
from morfax.motion import compiled
heard = []
compiled.hear(heard.append)
from whole import whole
values = np.arange(5.0) / 7.0
found = [whole(v, (0.3, 1)) for v in (values, values[::2], values.astype(np.int64))]
with_numba = "numba.core" in sys.modules
try:
    whole(values[:0], (0.3, 1))
    said = ""
except ValueError as error:
    said = str(error)
rows = [[f.sums["sum"].tolist(), f.sums["number"].sum().item(), type(f).__name__] for f in found]
print(json.dumps([*rows, said, len(heard), with_numba]))
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a kernel that has another one in it, and a program that calls it with three types."""
    (tmp_path / "part_of_it.py").write_text(PART)
    (tmp_path / "whole.py").write_text(WHOLE)
    return tmp_path


def asked(folder: Path, **settings: str) -> list[Any]:
    """What the program prints in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", ASKED],
        cwd=folder,
        env={
            **os.environ,
            "NUMBA_CACHE_DIR": str(folder / "kept"),
            "PYTHONPATH": os.pathsep.join([str(folder), *sys.path]),
            **settings,
        },
        capture_output=True,
        text=True,
        check=True,
    )
    return list(json.loads(done.stdout))


@pytest.mark.skipif(not machine_code.can_be_kept(), reason="numba runs the kernels here")
def test_a_kept_kernel_runs_without_numba_and_is_made_anew_when_what_is_in_it_changes(
    folder: Path,
) -> None:
    # 1. three types of arguments are compiled, and kept
    first = asked(folder)
    assert first[3:5] == ["nothing there", 3]
    plain = asked(folder, NUMBA_DISABLE_JIT="1")
    for (sums, *rest), (expected, *others) in zip(first[:3], plain[:3], strict=True):
        assert np.allclose(sums, expected, rtol=1e-15)  # one rounding of a sum of three numbers
        assert rest == others
    assert [row[1:] for row in first[:3]] == [[10, "Found"], [3, "Found"], [10, "Found"]]
    # 2. the next process compiles nothing and has no numba; every bit is the same
    assert asked(folder) == [*first[:4], 0, False]
    # 3. a damaged file is compiled anew
    (file,) = (folder / "kept").glob("whole.whole.*.kernel")
    kept = file.read_bytes()
    file.write_bytes(kept[:-3] + b"xyz")
    assert asked(folder) == first
    # 4. so is one whose kernel within has another constant
    (folder / "part_of_it.py").write_text(PART.replace("GAIN = 2.0", "GAIN = 30.0"))
    changed = asked(folder)
    assert changed[4] == 3
    assert changed[0] != first[0]
    # 5. the same kernels elsewhere, as after an upgrade or beside a checkout, are not compiled again
    elsewhere = folder / "elsewhere"
    elsewhere.mkdir()
    for name in ("part_of_it.py", "whole.py"):
        (elsewhere / name).write_text((folder / name).read_text())
        (folder / name).unlink()
    moved = asked(elsewhere, NUMBA_CACHE_DIR=str(folder / "kept"))
    assert moved == [*changed[:4], 0, False]


@pytest.mark.skipif(not machine_code.can_be_kept(), reason="numba runs the kernels here")
@pytest.mark.parametrize("formula", ["np.linalg.solve(a, b)", "a @ b"])
def test_linear_algebra_is_loaded_before_a_kept_kernel_runs(
    tmp_path: Path, formula: str
) -> None:
    """Where the kernel itself loads it at its first call, Ctrl-C ends the process with a dump.

    (Fails without `_load_algebra`: the kernel comes by no algebra here.)
    """
    lines = [
        "import numpy as np",
        "from morfax.motion.compiled import njit",
        "@njit(cache=True)",
        "def solved(a, b, rounds):",
        "    for _ in range(rounds):",
        f"        b = {formula}",
        "    return b",
    ]
    (tmp_path / "solved.py").write_text("\n".join([*lines, ""]))
    call = (
        "import sys, numpy as np; from solved import solved; solved(np.eye(2), np.ones(2), 0); "
    )
    names = "scipy.linalg.cython_lapack", "scipy.linalg.cython_blas", "numba.core"
    call += f"print(*[name in sys.modules for name in {names}]); "
    # and by itself: scipy.linalg takes a fifth of a second and 25 MB
    call += "solved(np.eye(2), np.ones(2), 2); print('scipy.linalg' in sys.modules)"
    kept = {"NUMBA_CACHE_DIR": str(tmp_path / "kept")}
    paths = {"PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}
    for with_numba in (True, False):
        done = subprocess.run(
            [sys.executable, "-c", call],
            env={**os.environ, **kept, **paths},
            capture_output=True,
            text=True,
            check=True,
        )
        *loaded, all_of_it = done.stdout.split()
        assert loaded == ["True", "True", str(with_numba)]
        assert with_numba or all_of_it == "False"


def test_only_the_newest_versions_of_a_kernel_are_kept(tmp_path: Path) -> None:
    for age in range(machine_code.VERSIONS + 3):
        file = tmp_path / f"a.part.cpython-311.{age:016x}.kernel"
        file.touch()
        os.utime(file, (1e9 - age, 1e9 - age))
    another = tmp_path / "a.part_of_it.cpython-311.0.kernel"
    another.touch()
    os.utime(another, (1.0, 1.0))
    machine_code._clear_old(tmp_path / f"a.part.cpython-311.{0:016x}.kernel")
    left = {file.name.split(".")[3] for file in tmp_path.glob("a.part.*")}
    assert left == {f"{age:016x}" for age in range(machine_code.VERSIONS)}
    assert another.exists()


def test_a_kernel_is_its_plain_function_where_compiling_is_turned_off(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
    heard: list[int] = []
    hear(heard.append)
    double = Kernel(lambda x: 2 * x, {"cache": True})
    assert double("ab") == "abab"
    hear(None)
    assert heard == []


def test_what_goes_into_a_kernel_is_known_by_its_makings(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """numba's settings and the source of a kernel within are part of what is compared."""
    before = machine_code._makings(drive_step)
    assert "drive.py" in before
    machine_code._surroundings.cache_clear()
    monkeypatch.setenv("NUMBA_OPT", "0")
    assert machine_code._makings(drive_step) != before
    machine_code._surroundings.cache_clear()


def test_a_slice_of_another_shape_is_refused_and_one_that_fits_is_filled() -> None:
    filled = np.zeros(4)
    _put(filled, np.ones(2))
    assert filled.tolist() == [0.0, 1.0, 1.0, 0.0]
    with pytest.raises(ValueError, match="cannot assign slice from input of different size"):
        _put(filled, np.ones(3))


@njit(cache=True)
def _put(out, values):  # type: ignore[no-untyped-def]
    """Put an array into a slice of another."""
    out[1:3] = values


class _Fields(NamedTuple):
    values: np.ndarray
    place: float


@keeps_kinds
class Kept(_Fields):
    """A tuple that keeps what of it decides the machine code."""


def kinds(*args: Any) -> tuple[Any, ...]:
    """What of some arguments decides the machine code."""
    of: list[Any] = []
    compiled._add_kinds(args, of)
    return tuple(of)


def test_arguments_that_need_other_machine_code_are_told_apart() -> None:
    row, table = np.zeros(3), np.zeros((3, 3))
    groups = [
        (1.0, 2.0, 3.0),
        ((1.0, 2.0), 3.0),
        (1.0, (2.0, 3.0)),
        ((1.0,), (2.0, 3.0)),
        ((1.0, 2.0), (3.0,)),
        ((1.0, 2.0, 3.0),),
        (((1.0, 2.0), 3.0),),
        (_Fields(row, 1.0), 2.0),
        (Kept(row, 1.0), 2.0),
        (Kept(table, 1.0), 2.0),
        (Kept(row.astype(np.float32), 1.0), 2.0),
        (row, row),
        (row, table[:, 0]),
        (table, table),
        (table, table.T),
        (1, 2.0, 3.0),
        (None, 2.0),
    ]
    assert all(kinds(*one) != kinds(*other) for one, other in combinations(groups, 2))
    assert kinds(Kept(row, 1.0)) == kinds(Kept(row + 1, 2.0))
    assert kinds((row, 1.0)) == kinds((row[:2], 2.0))


def test_a_tuple_that_keeps_its_kinds_gives_them_to_no_other() -> None:
    one = Kept(np.zeros(3), 1.0)
    kept = kinds(one)
    assert kinds(one) == kept
    assert kinds(one._replace(place=2.0)) == kept
    assert kinds(one._replace(values=np.zeros((2, 2)))) != kept
