"""Run the commands of the recipes, and put their pictures and the ends of their programs into the pages.

    python -m docs.figures.recipes [NAMES]  after a change of a recipe, a drawing or what a program looks like

A command is an indented line that begins with `morfax`; a block of text with a program's name as its title
holds the first and the last lines of that program. `tests/packaging/test_recipes.py` runs the same.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from morfax.console.cli import main as morfax

RECIPES = Path(__file__).parents[1] / "recipes"
FIRST, LAST = 13, 6  # lines of a program that a page shows
LEFT_OUT = "…"
COMMAND = re.compile(r"^ +(morfax (?:.*\\\n)*.*)$", re.MULTILINE)
EXCERPT = re.compile(r'```text title="([\w.-]+)"\n(.*?)```', re.DOTALL)
PICTURE = re.compile(r"\]\(pictures/([\w.-]+)\)")


def pages() -> list[Path]:
    """The pages of the recipes, but for their list."""
    return sorted(page for page in RECIPES.glob("*.md") if page.stem != "index")


def commands(text: str) -> list[list[str]]:
    """The commands that a page shows, as words."""
    return [shlex.split(line.replace("\\\n", " ")) for line in COMMAND.findall(text)]


def excerpts(text: str) -> dict[str, str]:
    """What a page shows of each program, by the program's name."""
    return dict(EXCERPT.findall(text))


def excerpt(program: Path) -> str:
    """The first and the last lines of a program."""
    lines = program.read_text(encoding="utf-8").splitlines()
    if len(lines) > FIRST + LAST + 1:
        lines = [*lines[:FIRST], LEFT_OUT, *lines[-LAST:]]
    return "".join(f"{line}\n" for line in lines)


def run(text: str, folder: Path) -> None:
    """Run a page's commands in a folder, beside the drawings; raises RuntimeError if one fails."""
    for drawing in (RECIPES / "drawings").iterdir():
        shutil.copy(drawing, folder)
    with _inside(folder):
        for words in commands(text):
            told = io.StringIO()
            with contextlib.redirect_stderr(told), contextlib.redirect_stdout(io.StringIO()):
                code = morfax(words[1:])
            if code:
                raise RuntimeError(f"{shlex.join(words)}: exit code {code}: {told.getvalue()}")


def main(names: list[str]) -> None:
    """Make pictures and excerpts anew, of all pages or of some by their names."""
    for page in [page for page in pages() if not names or page.stem in names]:
        text = page.read_text(encoding="utf-8")
        with tempfile.TemporaryDirectory() as aside:
            run(text, Path(aside))
            for name in PICTURE.findall(text):
                shutil.copy(Path(aside) / name, RECIPES / "pictures" / name)
            for name in excerpts(text):
                begin = text.index(f'```text title="{name}"\n')
                first = text.index("\n", begin) + 1
                end = text.index("```", first)
                text = text[:first] + excerpt(Path(aside) / name) + text[end:]
        page.write_text(text, encoding="utf-8")
        print(page.name)  # each takes some seconds


@contextmanager
def _inside(folder: Path) -> Iterator[None]:
    """Work in a folder."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


if __name__ == "__main__":
    main(sys.argv[1:])
