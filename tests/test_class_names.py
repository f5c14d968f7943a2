"""Names of classes: one name is one thing, in the whole house."""

from __future__ import annotations

import ast
from collections import defaultdict
from pathlib import Path

from tests.rooms import ROOMS

ROOT = Path(__file__).parents[1]


def _classes(file: Path) -> list[str]:
    """The names of a file's classes; those that begin with an underscore are its own business."""
    body = ast.parse(file.read_text()).body
    names = [node.name for node in body if isinstance(node, ast.ClassDef)]
    return [name for name in names if not name.startswith("_")]


def test_no_two_classes_have_one_name() -> None:
    where = defaultdict[str, list[str]](list)
    for file in sorted({file for room in ROOMS for file in (ROOT / room).rglob("*.py")}):
        for name in _classes(file):
            where[name].append(str(file.relative_to(ROOT)))
    assert {name: files for name, files in where.items() if len(files) > 1} == {}
