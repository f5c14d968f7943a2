"""Compiled kernels on disk that are damaged are compiled again, once, and it is said in one line."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

MODULE = """
from numba import njit

@njit(cache=True)
def twice(x):
    return 2 * x
"""
RUN = """
import sys
from morfax.jobs.damaged_kernels import compile_damaged_again
compile_damaged_again(lambda line: print(line, file=sys.stderr))
import loop
print(loop.twice(21))
"""


def cut(file: Path) -> None:
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


def garbled(file: Path) -> None:
    file.write_bytes(b"\x80\x05garbage" * 40)


def empty(file: Path) -> None:
    file.write_bytes(b"")


def folder(file: Path) -> None:
    file.unlink()
    file.mkdir()


@pytest.fixture(scope="module")
def run(
    tmp_path_factory: pytest.TempPathFactory,
) -> Callable[[], subprocess.CompletedProcess[str]]:
    """Run a module with one kernel in a process of its own; its cache lies beside it."""
    home = tmp_path_factory.mktemp("house")
    (home / "loop.py").write_text(MODULE)
    (home / "run.py").write_text(RUN)

    def once() -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, str(home / "run.py")],
            capture_output=True,
            text=True,
            check=False,
            cwd=Path(__file__).parents[2],
            env={"PYTHONPATH": f"{Path(__file__).parents[2]}:{home}"},
        )

    once.home = home  # type: ignore[attr-defined]
    assert once().stdout == "42\n"
    return once


@pytest.mark.parametrize(
    ("damage", "suffix"), [(cut, "nbc"), (garbled, "nbc"), (empty, "nbi"), (folder, "nbi")]
)
def test_damaged_kernels_are_compiled_again(
    run: Callable[[], subprocess.CompletedProcess[str]],
    damage: Callable[[Path], None],
    suffix: str,
) -> None:
    cache: Path = run.home / "__pycache__"  # type: ignore[attr-defined]
    file = next(cache.glob(f"loop.twice-*.{suffix}"))
    damage(file)
    done = run()
    assert done.stdout == "42\n", done.stderr
    if damage is folder:  # cannot be kept: left as it is
        file.rmdir()
        assert run().stdout == "42\n"
        return
    assert done.stderr.count("are damaged: they are compiled again") == 1
    assert done.stderr.count("\n") == 1
    again = run()
    assert (again.stdout, again.stderr) == ("42\n", "")


def test_many_commands_of_a_process_leave_one_lookout() -> None:
    """Each of them asks for it, and numba may be loaded after thousands."""
    code = (
        "import sys; from morfax.jobs.damaged_kernels import compile_damaged_again;"
        " before = len(sys.meta_path);"
        " [compile_damaged_again(print) for _ in range(2000)];"
        " print(len(sys.meta_path) - before); import numba"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert done.stdout == "1\n"
