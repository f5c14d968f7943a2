"""Which functions a change of the text can matter to: its own one, or whoever names its constant or class.

A function is told by its file and its name as it stands in the file: `tracer/sensing/leg.py:Leg.at`. What a
change stands in at the level of a module or of a class is a symbol: a constant, or the class. Functions that
name a symbol are its users, and so are those of a constant that is made of it.

Questions: whoever holds a value of a class by another's hand does not name the class; so of a symbol all of
the file count as users where nobody names it.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tests.rooms import PACKAGES

FUNCTION = (ast.FunctionDef, ast.AsyncFunctionDef)


@dataclass(frozen=True)
class Users:
    """The functions that a change can matter to, and the symbols whose value it changes."""

    functions: frozenset[str]
    symbols: frozenset[str]


def users_of(root: Path, file: Path, line: int) -> Users:
    """Who a change in a line of a file can matter to."""
    inside = _parts(ast.parse((root / file).read_text("utf-8")))
    here = [part for part in inside if part.first <= line <= part.last]
    functions = {f"{file}:{part.name}" for part in here if part.is_function}
    if functions or not here:
        return Users(frozenset(functions or (f"{file}:{p.name}" for p in inside)), frozenset())
    symbols = {(file, here[-1].name)}
    while True:
        named = [*_naming(root, symbols)]
        more = {(place, part.name) for place, part in named if not part.is_function} - symbols
        if not more:
            break
        symbols |= more
    functions = {f"{place}:{part.name}" for place, part in named if part.is_function}
    own = {f"{file}:{part.name}" for part in inside if part.is_function}
    return Users(frozenset(functions or own), frozenset(name for _, name in symbols))


@dataclass(frozen=True)
class _Part:
    """A function, or a statement of a module or class: its name, its lines, and the names that it has."""

    name: str
    first: int
    last: int
    is_function: bool
    names: frozenset[str]


def _naming(root: Path, symbols: set[tuple[Path, str]]) -> Iterator[tuple[Path, _Part]]:
    """The parts of all files that name a symbol which they can reach."""
    for place, (text, parts) in _files(root).items():
        near = {name for file, name in symbols if file == place or _module(file) in text}
        for part in parts:
            if part.names & near:
                yield place, part


def _module(file: Path) -> str:
    """How another file imports a file."""
    return "morfax." + ".".join(file.with_suffix("").parts)


@cache
def _files(root: Path) -> dict[Path, tuple[str, list[_Part]]]:
    """Text and parts of all files of the packages, modules named in full wherever they are imported from."""
    found = {}
    for package in PACKAGES:
        for file in sorted((root / package).rglob("*.py")):
            text = file.read_text("utf-8")
            tree = ast.parse(text)
            imports = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
            modules = [f"{node.module}.{name.name}" for node in imports for name in node.names]
            found[file.relative_to(root)] = (" ".join(modules) + text, _parts(tree))
    return found


def _parts(tree: ast.AST, within: str = "") -> list[_Part]:
    """The parts of a module or a class, in their order; a class's statements bear its name."""
    parts = []
    for node in getattr(tree, "body", []):
        if isinstance(node, FUNCTION):
            parts.append(_part(node, within + node.name))
        elif isinstance(node, ast.ClassDef):
            parts += _parts(node, f"{node.name}.")
        elif not isinstance(node, ast.Import | ast.ImportFrom):
            parts.append(_part(node, within.rstrip(".") or _assigned(node)))
    return parts


def _part(node: ast.stmt, name: str) -> _Part:
    words = {getattr(inner, "id", getattr(inner, "attr", "")) for inner in ast.walk(node)}
    is_function = isinstance(node, FUNCTION)
    return _Part(name, node.lineno, node.end_lineno or 0, is_function, frozenset(words))


def _assigned(node: ast.stmt) -> str:
    """The first name that a statement gives a value."""
    names = (inner for inner in ast.walk(node) if isinstance(inner, ast.Name))
    return next((name.id for name in names if isinstance(name.ctx, ast.Store)), "")
