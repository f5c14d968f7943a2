"""The first run on a machine: how long it takes while kernels are compiled, alone and on all cores, and warm.

Signals out: seconds and processor seconds of `morfax run` of a sample with an empty folder for kernels.
`--write` makes the list that is compiled ahead, or for a wheel (`motion/kernels.tsv`), of what COMMANDS call,
in that order.
"""

from __future__ import annotations

import math
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np

from morfax.motion.compile_ahead import LIST, SWITCH

RUN = "run samples/program.png --card samples/program.toml -o {folder}/{name}"
RECIPES = "docs/recipes/drawings"
COMMANDS = (  # one that most will use first, then others in the order of how many will use them
    RUN,
    "trace samples/cam.png --cutter 3mm -o {folder}/cam.ngc",
    "trace samples/gear.png --lines all -o {folder}/plate.ngc",
    "play {folder}/cam.ngc -o {folder}/played.csv",
    f"trace {RECIPES}/shelf-bracket.png --lines contours -o {{folder}}/shelf.nc --machine grbl-router",
    f"trace {RECIPES}/leaf.png --edge -o {{folder}}/leaf.plt",
    f"trace {RECIPES}/figure.png --lines all -o {{folder}}/figure.gcode --machine grbl-pen",
    f"lines {RECIPES}/name-tag.png --follow",
    "trace {folder}/coast.png --width 40mm -o {folder}/coast.ngc",
    "trace {folder}/pencil.png --width 60mm -o {folder}/pencil.ngc",
    "trace {folder}/slots.png --width 40mm --lines contours -o {folder}/slots.ngc",
    "compare samples/bracket.png --systems all -o {folder}/systems.html",
    "age {folder}/run/program.wav -o {folder}/worn.wav --noise 40 --flutter 0.3%",
    "play {folder}/worn.wav -o {folder}/worn.csv",
)
LEFT_WITH_A_PATH = (0, 4)  # exit codes; the coast may end with its line lost
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


def draw(folder: Path) -> None:
    """Draw what the samples lack: a coast whose spikes run together, a faint pencil line with grain, and a
    plate with a small hole and a narrow slot.
    """
    rng = np.random.default_rng(1)
    turns = np.linspace(0, math.tau, 181)
    radius = 180 + rng.uniform(-35, 35, len(turns))  # pixels; 40 mm in all at 300 dpi
    radius[-1] = radius[0]
    coast = np.full((500, 500), 235, np.uint8)
    ellipse = coast.copy()
    line = 250 + radius[:, None] * np.column_stack([np.cos(turns), np.sin(turns)])
    cv2.polylines(coast, [line.round().astype(np.int32)], False, 40, 6, cv2.LINE_AA)
    cv2.ellipse(ellipse, (250, 250), (200, 140), 0, 0, 360, 0, 6, cv2.LINE_AA)
    grain = cv2.GaussianBlur(rng.normal(0, 1, ellipse.shape), (0, 0), 1.2)
    ink = (235 - ellipse.astype(float)) * (1 + 0.4 * grain / grain.std()) / 3
    noisy = 235 - ink + rng.normal(0, 8, ink.shape)
    plate = np.full((500, 500), 235, np.uint8)
    notch = (330, 60), (330, 100), (339, 100), (339, 60)
    outline = np.array([(60, 60), *notch, (440, 60), (440, 300), (60, 300)])
    cv2.polylines(plate, [outline], True, 40, 6, cv2.LINE_AA)
    cv2.circle(plate, (150, 180), 7, 40, 6, cv2.LINE_AA)
    cv2.rectangle(plate, (250, 170), (310, 181), 40, 6, cv2.LINE_AA)
    cv2.imwrite(str(folder / "slots.png"), cv2.GaussianBlur(plate, (0, 0), 0.7))
    cv2.imwrite(str(folder / "coast.png"), coast)
    cv2.imwrite(str(folder / "pencil.png"), noisy.clip(0, 255).astype(np.uint8))


def write_list() -> None:
    """Write down which kernels the commands call, in the order in which they do."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "list"
        draw(Path(folder))
        for command in COMMANDS:
            words = command.format(folder=folder, name="run").split()
            told = LISTED.format(file=str(file), words=words)
            done = subprocess.run([sys.executable, "-c", told])
            if done.returncode not in LEFT_WITH_A_PATH:
                sys.exit(f"{command} ended with {done.returncode}")
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
