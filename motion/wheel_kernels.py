"""Kernels for the wheel: machine code of every kernel of the list, put where the wheel takes it from.

    kernels.tsv -> kept already, or compiled now -> kernels/NAME.kernel -> wheel -> no compiling at the user's

Signals in: the list of `compile_ahead`. Signals out: files in a folder. `make wheel` calls it, then builds.
The files serve every machine whose Python, numba and kind of processor are those that they were made with
(`machine_code._surroundings`); any other machine passes over them, and compiles as without them. Files of
another Python stay in the folder, so that one wheel can hold those of several.

Questions: the list holds what commands of the samples and recipes call (`python -m benchmarks first
--write`). A kernel that it lacks is compiled when it is needed.
"""

from __future__ import annotations

import shutil
import sys

from morfax.motion import compile_ahead, machine_code
from morfax.motion.kernel_folder import kernel_folder, wheel_folder
from morfax.motion.kernel_linker import linker


def gather() -> int:
    """Put the machine code of all listed kernels into the wheel's folder; give how many files that makes.

    Raises OSError where machine code cannot be kept (`machine_code.can_be_kept`).
    """
    if not machine_code.can_be_kept() or kernel_folder() is None:
        raise OSError(
            "numba runs the kernels here, and keeps no machine code that a wheel could bring"
        )
    folder = wheel_folder()
    folder.mkdir(parents=True, exist_ok=True)
    of_this_python = f"*.{sys.implementation.cache_tag}.*.kernel"
    for old in folder.glob(of_this_python):
        old.unlink()
    for kernel, types, arguments in compile_ahead.listed():
        kernel.compile_for(types, arguments)
        kept = machine_code.file_of(kernel, kernel_folder())
        if kept is not None and kept.exists():
            shutil.copy(kept, folder)
    return len(list(folder.glob(of_this_python)))


def main() -> None:
    """Fill the folder that a wheel takes kernels from, and say with what."""
    print(f"{gather()} kernels for {sys.implementation.cache_tag}, {linker().target.name}")


if __name__ == "__main__":
    main()
