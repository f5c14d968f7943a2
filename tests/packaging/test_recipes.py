"""The recipes: their commands run as they stand, and what the pages show is what comes out.

To make pictures and excerpts anew: `python -m docs.figures.recipes`; the drawings: `python -m
docs.figures.recipe_drawings`.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageChops

from docs.figures import recipes

PAGES = recipes.pages()
CHECK_SUM = re.compile(r"crc32 [0-9a-f]{8}")
NUMBER = re.compile(r"-?\d+\.?\d*")
MACHINES = {
    "grbl-laser",
    "grbl-pen",
    "grbl-router",
    "hpgl",
    "linuxcnc",
    "marlin",
    "marlin-fan",
    "qtplasmac",
}


def shape(program: str) -> list[str]:
    """The lines of a program without numbers, which may differ in the last digit, and their check sum."""
    return NUMBER.sub("#", CHECK_SUM.sub("crc32 #", program)).splitlines()


def alike(made: Path, shown: Path) -> bool:
    """Whether a page's picture is what comes out, but for places that move by a fraction of a pixel."""
    with Image.open(made) as one, Image.open(shown) as other:
        if one.size != other.size:
            return False
        apart = ImageChops.difference(one.convert("L"), other.convert("L"))
    moved = np.asarray(apart) > 64  # of the edge of a line that moves by a quarter of a pixel
    return bool(moved.mean() < 0.002)


@pytest.mark.parametrize("page", PAGES, ids=[page.stem for page in PAGES])
def test_a_recipe_runs_and_shows_what_comes_out(page: Path, tmp_path: Path) -> None:
    text = page.read_text(encoding="utf-8")
    recipes.run(text, tmp_path)
    shown, pictures = recipes.excerpts(text), recipes.PICTURE.findall(text)
    assert shown and pictures
    for name, told in shown.items():
        assert shape(told) == shape(recipes.excerpt(tmp_path / name))
    for name in pictures:
        assert alike(tmp_path / name, recipes.RECIPES / "pictures" / name)


def test_there_is_a_recipe_for_every_machine_and_each_program_is_checked() -> None:
    named = set[str]()
    for page in PAGES:
        words = recipes.commands(page.read_text(encoding="utf-8"))
        made = {line[line.index("--machine") + 1] for line in words if "--machine" in line}
        checked = [line for line in words if line[1] == "check"]
        drawn = any(Path(word).suffix in (".plt", ".dxf") for line in words for word in line)
        assert checked or drawn, page.stem
        named |= made
    assert named == MACHINES


@pytest.mark.skipif(
    shutil.which("rs274") is None, reason="rs274 of linuxcnc-uspace is not installed"
)
@pytest.mark.parametrize("machine", ["linuxcnc"])
def test_linuxcnc_s_own_reader_takes_the_program_of_its_recipe(
    machine: str, tmp_path: Path
) -> None:
    (page,) = (
        page for page in PAGES if f"--machine {machine}" in page.read_text(encoding="utf-8")
    )
    text = page.read_text(encoding="utf-8")
    recipes.run(text, tmp_path)
    (tmp_path / "tool.tbl").write_text("T1 P1 D1 Z0\n")
    for name in recipes.excerpts(text):
        if name.endswith(".ngc"):
            call = ["rs274", "-t", "tool.tbl", "-g", name]
            done = subprocess.run(
                call, cwd=tmp_path, capture_output=True, text=True, timeout=300
            )
            assert done.returncode == 0 and "PROGRAM_END" in done.stdout, done.stderr
