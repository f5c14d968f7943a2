"""Machine code of kernels on disk: kept once numba has compiled a kernel, and read by later processes.

    first process    numba compiles -> object code, as numba's own cache has it -> NAME.kernel
    every other one  NAME.kernel -> the object code is linked -> a Python function (`kernel_linker`)

What a kernel was made with is kept beside it (versions, processor, numba's settings, sources of all kernels
in it, values of constants); a kernel whose makings have changed is compiled anew, and so is one whose file is
damaged. Where the linker cannot be made, or a kernel asks for a name that it does not know, nothing is kept
here, and numba runs the kernels with its own cache. `MORFAX_KERNELS=numba` asks for that.

Signals in: a kernel, the types of its arguments as a text. Signals out: a Python function.
Files: `MODULE.NAME.TAG.MAKINGS.kernel` in the user's folder of kernels (`kernel_folder`), or among those that
the wheel brought along (`wheel_kernels`): a SHA-256 digest, then what the kernel was made with and its
entries, marshalled. Sources count by what is in them, not by where or when they were installed.

Questions: none.
"""

from __future__ import annotations

import marshal
import os
import pickle
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion import processor
from morfax.motion.kernel_folder import kernel_folder, wheel_folder
from morfax.motion.kernel_linker import Entry, in_process, linker, numba_folder

if TYPE_CHECKING:
    from morfax.motion.compiled import Kernel

FORMAT = 4  # of the files; another number with every change of Entry
VERSIONS = 8  # of one kernel are kept beside each other: an upgrade, a checkout, settings that were tried
DIGEST = 32  # bytes of a SHA-256 digest, which stands before the rest of a file


def kept(kernel: Kernel, types: str) -> Callable[..., Any] | None:
    """The function that runs kept machine code for arguments of these types; None if none fits."""
    if not can_be_kept():
        return None
    for folder in (wheel_folder(), kernel_folder()):
        entry = _read(kernel, folder).get(types)
        if entry is not None:
            return linker().function(kernel, entry)
    return None


def keep(kernel: Kernel, types: str, entry: Entry) -> None:
    """Keep the machine code of a kernel for arguments of these types."""
    file = file_of(kernel, kernel_folder())
    if file is None:
        return
    content = marshal.dumps(
        (_makings(kernel), {**_read(kernel, kernel_folder()), types: entry})
    )
    unfinished = None
    try:
        number, name = tempfile.mkstemp(dir=file.parent, prefix=file.name)
        unfinished = Path(name)
        with os.fdopen(number, "wb") as stream:
            stream.write(sha256(content).digest() + content)
        unfinished.replace(file)
        _clear_old(file)
    except OSError:  # a full disk: compiled again next time
        if unfinished is not None:
            unfinished.unlink(missing_ok=True)


def _clear_old(file: Path) -> None:
    """Delete the oldest files of a kernel where there are more than VERSIONS of it."""
    kernel = file.name.rsplit(".", 2)[0]
    every = sorted(file.parent.glob(f"{kernel}.*.kernel"), key=lambda of: of.stat().st_mtime_ns)
    for old in every[:-VERSIONS]:
        old.unlink(missing_ok=True)


def aim() -> None:
    """Have numba compile for the processor that machine code is kept for.

    Where the process has compiled kernels of others before, ours are made and kept as those were.
    """
    if (found := processor.aim(linker().target)) != linker().target:
        linker().target = found
        _surroundings.cache_clear()


@cache
def can_be_kept() -> bool:
    """Whether machine code can be run without numba here."""
    if os.environ.get("MORFAX_KERNELS") == "numba":
        return False
    try:
        linker()
    except (ImportError, AttributeError, OSError, TypeError, RuntimeError):
        return False
    return True


def entry(compiled: Any, code: bytes) -> Entry | None:
    """What is kept of numba's result and its object code; None if it needs more than these to run."""
    module = compiled.library._final_module
    known = linker().addresses
    for function in module.functions:
        name = function.name
        if function.is_declaration and not (
            name.startswith("llvm.") or name in known or in_process(name)
        ):
            return None
    others = [
        held
        for held in compiled._find_referenced_environments()
        if held is not compiled.environment
    ]
    held = [compiled.environment, *others]
    constants = [constant for environment in held for constant in environment.consts]
    if compiled.objectmode or not all(isinstance(constant, np.dtype) for constant in constants):
        return None
    environments = [
        (
            of.env_name,
            of.globals["__name__"],
            [pickle.dumps(constant) for constant in of.consts],
        )
        for of in held
    ]
    return code, compiled.fndesc.llvm_cpython_wrapper_name, environments


def _read(kernel: Kernel, folder: Path | None) -> dict[str, Entry]:
    """The entries of a kernel that a folder has, made with what is there now; none without such a file."""
    file = file_of(kernel, folder)
    try:
        data = file.read_bytes() if file is not None else b""
    except OSError:
        return {}
    digest, content = data[:DIGEST], data[DIGEST:]
    if sha256(content).digest() != digest:
        return {}  # damaged
    made_with, entries = marshal.loads(content)
    return entries if made_with == _makings(kernel) else {}


def _makings(kernel: Kernel) -> str:
    """What the machine code of a kernel depends on, as a text to compare."""
    called = kernel.called()
    sources = sorted({part.py_func.__code__.co_filename for part in called})
    values = sorted(part.frozen for part in called)
    return repr((_surroundings(), [_stamp(source) for source in sources], values))


@cache
def _surroundings() -> str:
    """Kind of Python and machine, versions, processor and numba's settings."""
    settings = {name: value for name, value in os.environ.items() if name.startswith("NUMBA_")}
    settings.pop("NUMBA_CACHE_DIR", None)
    folder = numba_folder()
    versions = [folder / "_version.py", folder.parent / "llvmlite" / "_version.py"]
    python = EXTENSION_SUFFIXES[0]  # of one ABI, as for extension modules
    machine = (linker().triple, *linker().target)
    return repr((FORMAT, python, machine, settings, [_stamp(str(file)) for file in versions]))


@cache
def _stamp(file: str) -> tuple[str, str]:
    """Name of a file, and a digest of what is in it."""
    return Path(file).name, sha256(Path(file).read_bytes()).hexdigest()


def file_of(kernel: Kernel, folder: Path | None) -> Path | None:
    """Where in a folder the machine code of a kernel is kept; None without a folder."""
    if folder is None:
        return None
    function, tag = kernel.py_func, sys.implementation.cache_tag
    makings = sha256(_makings(kernel).encode()).hexdigest()[:16]
    return folder / f"{function.__module__}.{function.__name__}.{tag}.{makings}.kernel"
