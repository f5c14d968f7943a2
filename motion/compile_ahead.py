"""Compiling ahead: on a first run, the processor's other cores compile the kernels that will be needed next.

The process that meets the first kernel which nobody has compiled starts others (`begin`). They share a list
of kernels in the order in which a run needs them: one beside the run begins in the middle of the list, two
at a third and at two thirds. Neighbours in the list have kernels within them in common, which each process
has to compile for itself. Each kernel is compiled by one process at a time (`claimed`); whoever needs it
meanwhile waits for it. They end with the list, or with the process that started them.

Signals in: `kernels.tsv`: module, function and types of arguments (`compiled.described`), a line each.
Signals out: files of machine code (`machine_code`). `MORFAX_COMPILE_AHEAD=0` turns it off.

Questions: the list is made by `python -m benchmarks first --write`. What it lacks is compiled when it is
needed, as without it; what is no longer needed is passed over.
"""

from __future__ import annotations

import atexit
import importlib
import os
import subprocess
import sys
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion.kernel_folder import kernel_folder

if TYPE_CHECKING:
    from morfax.motion.compiled import Kernel

LIST = Path(__file__).with_name("kernels.tsv")
MOST = 3  # processes beside the one that runs; each took up to 0.56 GB
SWITCH = "MORFAX_COMPILE_AHEAD"


def begin() -> None:
    """Start a process on each core but one, which compiles what this one will need."""
    count = min(len(_cores()) - 1, MOST)
    if os.environ.get(SWITCH) == "0" or count < 1 or kernel_folder() is None:
        return
    command = [sys.executable, "-m", __name__, str(os.getpid()), str(count + 1)]
    nowhere = subprocess.DEVNULL
    for number in range(1, count + 1):
        with suppress(OSError):  # no process to be had: this one compiles alone
            started = subprocess.Popen(
                [*command, str(number)],
                stdin=nowhere,
                stdout=nowhere,
                stderr=nowhere,
                env={**os.environ, SWITCH: "0"},
            )
            atexit.register(started.terminate)


@contextmanager
def claimed(kernel: str) -> Iterator[None]:
    """Be the only process that compiles a kernel; wait while another one does."""
    try:
        import fcntl

        file = _claims()
        byte = zlib.crc32(kernel.encode())
        fcntl.lockf(file, fcntl.LOCK_EX, 1, byte)
    except (ImportError, OSError):  # a system or a disk without locks: two may compile the same
        yield
        return
    try:
        yield
    finally:
        fcntl.lockf(file, fcntl.LOCK_UN, 1, byte)


def examples(types: str) -> tuple[Any, ...]:
    """Arguments of the types of a text (`compiled.described`)."""
    names = {"f8": 0.0, "i8": 0, "b1": False, "float32": np.float32(0), "int32": np.int32(0)}
    names |= {"uint8": np.uint8(0), "uint32": np.uint32(0), "dtype": np.dtype, "numpy": np}
    names |= {"array": _array, "named": _named}
    names |= {"void": lambda of: np.zeros(1, of)[0], "record": lambda of: np.recarray(1, of)[0]}
    found = eval(f"({types})", {"__builtins__": {}, **names})
    assert isinstance(found, tuple)
    return found


def compile_listed(parent: int, processes: int, number: int) -> None:
    """Compile the kernels of the list that are not kept yet, while the process that asked is there.

    Of so many processes, the one with this number begins with its part of the list and goes on from there.
    """
    for kernel, types, arguments in listed(processes, number):
        if os.getppid() != parent:
            return
        kernel.compile_for(types, arguments)


def listed(
    processes: int = 1, number: int = 0
) -> Iterator[tuple[Kernel, str, tuple[Any, ...]]]:
    """Kernels of the list, types of their arguments, and such arguments.

    They come from the part of the list on that is for one of so many processes, by its number.
    """
    lines = LIST.read_text(encoding="utf-8").splitlines()
    first = number * len(lines) // processes
    for line in [*lines[first:], *lines[:first]]:
        module, name, types = line.split("\t")
        with suppress(ImportError, AttributeError):  # a list of another version
            kernel = getattr(importlib.import_module(module), name)
            yield kernel, types, examples(types)


def _cores() -> set[int] | range:
    """The cores that this process may run on."""
    return (
        os.sched_getaffinity(0)
        if hasattr(os, "sched_getaffinity")
        else range(os.cpu_count() or 1)
    )


_CLAIMS: dict[
    Path, int
] = {}  # a lock goes with any file of it that is closed: one is open, always


def _claims() -> int:
    """The file in which each kernel has a byte to lock."""
    folder = kernel_folder()
    if folder is None:
        raise OSError("no folder for kernels")
    file = folder / "claims"
    if file not in _CLAIMS:
        _CLAIMS[file] = os.open(file, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    return _CLAIMS[file]


def _array(of: np.dtype[Any], dimensions: int, kind: str) -> np.ndarray[Any, Any]:
    """An array of a type, of two elements along each dimension."""
    if "u" in kind:  # begins between two addresses that suit its elements
        count = of.itemsize * 2**dimensions
        made = np.zeros(count + 1, np.uint8)[1:].view(of).reshape((2,) * dimensions)
    elif "A" in kind:
        made = np.zeros((4,) * dimensions, of)[(slice(None, None, 2),) * dimensions]
    else:
        made = np.zeros((2,) * dimensions, of, order="F" if "F" in kind else "C")
    made.setflags(write="r" not in kind)
    return made


def _named(module: str, name: str) -> Any:
    """Makes a named tuple of a class of its fields."""
    kind = getattr(importlib.import_module(module), name)
    return lambda *fields: kind(*fields)


if __name__ == "__main__":
    compile_listed(*(int(word) for word in sys.argv[1:]))
