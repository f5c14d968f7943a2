"""The page of all modules, from their docstrings (a hook of mkdocs)."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
PAGE = "reference/modules.md"
# in the order in which they may ask each other, lowest first; a package that is not named comes last
PACKAGES = ("motion", "tracer", "recorder", "player", "jobs", "reports", "console")
ORDER = (
    *("flatten", "corrections", "drawing", "sensing", "marks", "head", "junctions"),
    *("tangles", "following", "ink", "operator", "program", "cutter"),
    *("passes", "lines", "against_ink", "laid", "nets"),
    *("media", "readings", "settings", "machine", "remarks", "tracing"),
)


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Fill the page of all modules."""
    return f"{markdown}\n{all_modules()}" if page.file.src_uri == PAGE else markdown


def all_modules() -> str:
    """A heading and a table for every room."""
    return "\n".join(table for package in PACKAGES for table in rooms(ROOT / package))


def rooms(package: Path) -> list[str]:
    """The tables of a package and of its rooms, each followed by the rooms within it."""
    order = {name: place for place, name in enumerate(ORDER)}
    below = [file.parent for file in package.glob("*/__init__.py")]
    below.sort(key=lambda room: (order.get(room.name, 0), room.name))
    return [table(package), *(text for room in below for text in rooms(room))]


def table(room: Path) -> str:
    """A room: its own docstring, and its modules with the first sentence of each."""
    name = room.relative_to(ROOT).as_posix()
    lines = [f"## {name}/", "", paragraph(room / "__init__.py"), ""]
    modules = sorted(file for file in room.glob("*.py") if file.name != "__init__.py")
    if modules:
        lines += ["| module | what it does |", "| --- | --- |"]
        lines += [f"| `{file.name}` | {cell(paragraph(file))} |" for file in modules]
    return "\n".join([*lines, ""])


def paragraph(file: Path) -> str:
    """The first paragraph of a module's docstring, on one line."""
    docstring = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or ""
    return " ".join(docstring.split("\n\n")[0].split())


def cell(text: str) -> str:
    """A text as it may stand in a table."""
    return text.replace("|", "\\|").replace("<", "&lt;")
