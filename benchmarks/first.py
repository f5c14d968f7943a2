"""The first run on a machine: how long it takes while kernels are compiled, alone and on all cores, and warm.

Signals out: seconds and processor seconds of `morfax run` of a sample with an empty folder for kernels.
`--write` makes the list that is compiled ahead (`motion/kernels.tsv`) of what COMMANDS call, in that order.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from morfax.motion.compile_ahead import LIST, SWITCH

RUN = "run samples/program.png --card samples/program.toml -o {folder}/{name}"
COMMANDS = (  # one that most will use first, then others in the order of how many will use them
    RUN,
    "trace samples/cam.png --cutter 3mm -o {folder}/cam.ngc",
    "trace samples/gear.png --lines all -o {folder}/plate.ngc",
    "play {folder}/cam.ngc -o {folder}/played.csv",
)
LISTED = """
import sys
from contextlib import suppress
from morfax.motion import compiled
find = compiled.Kernel._found
def found(kernel, args):
    with suppress(TypeError), open({file!r}, "a") as file:  # types that only numba tells are not kept
        types = compiled.described(args)
        print(kernel.py_func.__module__, kernel.py_func.__name__, types, sep="\\t", file=file)
    return find(kernel, args)
compiled.Kernel._found = found
from morfax.console.cli import main
sys.exit(main({words!r}))
"""


def used_s(name: str, folder: str, ahead: str) -> tuple[float, float]:
    """Seconds and processor seconds of a run, with the kernels that a folder has."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": f"{folder}/kernels", SWITCH: ahead}
    before, begin_s = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    command = [sys.executable, "-m", "morfax", *RUN.format(folder=folder, name=name).split()]
    subprocess.run(command, check=True, capture_output=True, env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return time.monotonic() - begin_s, used


def write_list() -> None:
    """Write down which kernels the commands call, in the order in which they do."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "list"
        for command in COMMANDS:
            words = command.format(folder=folder, name="run").split()
            told = LISTED.format(file=str(file), words=words)
            subprocess.run([sys.executable, "-c", told], check=True)
        lines = dict.fromkeys(file.read_text(encoding="utf-8").splitlines())
    LIST.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    print(f"{len(lines)} kernels in {LIST}")


def main(words: list[str]) -> None:
    """Print a line for each way, or write the list."""
    if words == ["--write"]:
        write_list()
        return
    for way, ahead in (("one core", "0"), ("all cores", "1")):
        with tempfile.TemporaryDirectory() as folder:
            for when in ("first", "second"):
                whole_s, processor_s = used_s(when, folder, ahead)
                print(
                    f"{when} run, {way}: {whole_s:.0f} s, {processor_s:.0f} s of processor time"
                )


if __name__ == "__main__":
    main(sys.argv[1:])
