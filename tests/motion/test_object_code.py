"""Object code: numba is left as it was, runs its own functions, and runs ours where none can be made."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from morfax.motion import machine_code

pytestmark = pytest.mark.skipif(
    not machine_code.can_be_kept(), reason="numba runs the kernels here"
)
KERNELS = """
from morfax.motion.compiled import njit

@njit(cache=True)
def part(x):
    if x < 0.0:
        raise ValueError("below zero")
    return 2.0 * x

@njit(cache=True)
def whole(values):
    total = 0.0
    for value in values:
        total += part(value)
    return total

@njit(cache=True)
def broken(values):
    return values.no_such_thing()
"""
AFTER = """
import numba, numpy as np
from numba.core.codegen import JITCodeLibrary, JITCPUCodegen
before = dict(vars(JITCodeLibrary)), dict(vars(JITCPUCodegen))
from kernels import broken, part, whole
values = np.arange(4.0)
assert whole(values) == 12.0
try:
    broken(values)
except numba.TypingError:
    pass
assert (dict(vars(JITCodeLibrary)), dict(vars(JITCPUCodegen))) == before
# a part is called by itself, and one that raises tells what it has to tell
assert part(3.0) == 6.0
try:
    whole(-values)
except ValueError as error:
    assert str(error) == "below zero"
else:
    raise AssertionError
# a function of somebody else that calls a kernel is numba's, and runs
assert numba.njit(lambda values: whole(values) + part(1.0))(values) == 14.0
print("right")
"""
OTHERWISE = """
import numpy as np
from morfax.motion import object_code
from numba.core.codegen import JITCPUCodegen
if {without}:
    object_code._nothing_is_optimised = lambda: object_code._instead(JITCPUCodegen, "no_such", None)
from kernels import whole
assert whole(np.arange(4.0)) == 12.0
print("right", type(next(iter(whole._ready.values()))).__name__)
"""


def said(folder: Path, program: str) -> str:
    """What a program prints in a process of its own, with a new folder for kernels."""
    (folder / "kernels.py").write_text(KERNELS)
    environment = {
        **os.environ,
        "NUMBA_CACHE_DIR": str(folder / "kept"),
        "PYTHONPATH": os.pathsep.join([str(folder), *sys.path]),
    }
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_numba_is_left_as_it_was_and_runs_its_own_functions(tmp_path: Path) -> None:
    assert said(tmp_path, AFTER) == "right"


@pytest.mark.parametrize(
    ("without", "runs"), [(False, "builtin_function_or_method"), (True, "CPUDispatcher")]
)
def test_a_numba_that_is_made_otherwise_runs_the_kernels_itself(
    tmp_path: Path, without: bool, runs: str
) -> None:
    assert said(tmp_path, OTHERWISE.format(without=without)) == f"right {runs}"
