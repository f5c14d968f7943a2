"""Count the limits and tuned numbers of the packages, room by room, always by the same rule.

    python -m tests.odd_numbers               the table of rooms
    python -m tests.odd_numbers tracer/ink    each of a room's, with file and line

Counted is a number that somebody chose and that could be another one:

- a name of a module or class in capitals whose value has such a number (one for each name);
- a default of a parameter or field that has one;
- each such number in the body of a function.

Not counted:

- 0, 1, 2 and a half with either sign; in bodies also 3 and 4, which count axes, corners and powers;
- units: 25.4, 180, 360, 3600, and 255 and 256 for the levels of a byte; in bodies also 60, 90, and powers of
  ten from 10 on and from 1e-3 on downwards in thousandths;
- numbers of a protocol: written in hexadecimal, octal or binary, or as bytes and text; in bodies 8, 16, 24,
  32 and 64, which count bits and bytes, and the largest of 16 bit;
- numbers that only name cases: names that are given whole numbers one after the other (`A, B, C = 3, 4, 5`);
- tables, colours and shapes: a display of three or more values, a dictionary, what stands in [ ];
- what is computed from other constants, without a number of its own;
- messages.
"""

from __future__ import annotations

import ast
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.rooms import ROOMS

ROOT = Path(__file__).parents[1]
PLAIN = {0.0, 0.5, 1.0, 2.0, 25.4, 180.0, 255.0, 256.0, 360.0, 3600.0}
BITS = {8.0, 16.0, 24.0, 32.0, 64.0, 32767.0, 32768.0}
IN_BODIES = PLAIN | BITS | {3.0, 4.0, 60.0, 90.0, 10.0, 100.0, 1e3, 1e4, 1e6, 1e9, 1e-3, 1e-6}
TABLE = 3  # values of a display: from so many on it is a table


@dataclass(frozen=True)
class Odd:
    """A number that counts: the file, the line, and a constant's name or the number itself."""

    file: Path
    line: int
    name: str
    constant: bool


def odd_numbers(file: Path, source: str) -> list[Odd]:
    """All of a file, in the order of its text."""
    return sorted(_of(ast.parse(source), _Text(file, source)), key=lambda odd: odd.line)


@dataclass(frozen=True)
class _Text:
    """A file and its text, which tells how a number is written."""

    file: Path
    source: str

    def numbers(self, node: ast.AST, plain: set[float]) -> Iterator[ast.Constant]:
        """The numbers of an expression that count."""
        for part in _read(node):
            if isinstance(part, ast.Constant) and type(part.value) in (int, float):
                written = (ast.get_source_segment(self.source, part) or "")[:2].lower()
                if abs(part.value) not in plain and written not in ("0x", "0o", "0b"):
                    yield part


def _read(node: ast.AST) -> Iterator[ast.AST]:
    """A node and what it holds, without tables, indices, messages and types."""
    if isinstance(node, ast.Dict | ast.JoinedStr | ast.Raise | ast.Assert):
        return
    if isinstance(node, ast.Tuple | ast.List | ast.Set) and len(node.elts) >= TABLE:
        return
    yield node
    for name, value in ast.iter_fields(node):
        if name in ("slice", "annotation", "returns"):
            continue
        for part in value if isinstance(value, list) else [value]:
            if isinstance(part, ast.AST):
                yield from _read(part)


def _of(node: ast.AST, text: _Text) -> Iterator[Odd]:
    """The constants of a module or class, and the numbers of its functions."""
    for statement in getattr(node, "body", []):
        if isinstance(statement, ast.ClassDef):
            yield from _of(statement, text)
        elif isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef):
            yield from _function(statement, text)
        elif isinstance(statement, ast.Assign | ast.AnnAssign) and statement.value:
            targets = (
                statement.targets if isinstance(statement, ast.Assign) else [statement.target]
            )
            for target in targets:
                yield from _assigned(target, statement.value, text)
        elif hasattr(statement, "body"):
            yield from _of(statement, text)


def _assigned(target: ast.expr, value: ast.expr, text: _Text) -> Iterator[Odd]:
    """Names that are given values: one for each whose value has a number that counts."""
    names, values = [target], [value]
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        names, values = target.elts, value.elts
        if _follow(values):
            return
    for name, given in zip(names, values, strict=False):
        if next(text.numbers(given, PLAIN), None) is not None:
            yield Odd(text.file, name.lineno, ast.unparse(name), constant=True)


def _follow(values: list[ast.expr]) -> bool:
    """Whether values are whole numbers, each one more than the last."""
    given = [v.value if isinstance(v, ast.Constant) else None for v in values]
    whole = [v for v in given if type(v) is int]
    return len(whole) == len(given) and whole == list(range(whole[0], whole[0] + len(whole)))


def _function(function: ast.FunctionDef | ast.AsyncFunctionDef, text: _Text) -> Iterator[Odd]:
    """Defaults and numbers in the body of a function, and in functions within."""
    arguments = function.args
    for default in [*arguments.defaults, *arguments.kw_defaults]:
        for number in text.numbers(default, PLAIN) if default else ():
            yield Odd(text.file, number.lineno, ast.unparse(number), constant=True)
    for statement in function.body:
        for number in text.numbers(statement, IN_BODIES):
            yield Odd(text.file, number.lineno, ast.unparse(number), constant=False)


def rooms() -> dict[str, list[Odd]]:
    """The numbers of each room, by its folder."""
    found: dict[str, list[Odd]] = {}
    for package in ROOMS:
        for file in sorted((ROOT / package).rglob("*.py")):
            place = file.relative_to(ROOT)
            found.setdefault(str(place.parent), []).extend(
                odd_numbers(place, file.read_text("utf-8"))
            )
    return found


def main(asked: list[str]) -> None:
    """Print the table, or the numbers of the rooms that are asked for."""
    found = rooms()
    if asked:
        for odd in (odd for room in asked for odd in found[room]):
            print(f"{odd.file}:{odd.line}: {odd.name}")
        return
    counts = {room: Counter(odd.constant for odd in odds) for room, odds in found.items()}
    print(f"{'room':24s}{'constants':>10s}{'in bodies':>10s}")
    for room, count in sorted(counts.items(), key=lambda one: -one[1].total()):
        print(f"{room:24s}{count[True]:10d}{count[False]:10d}")
    every = sum(counts.values(), Counter())
    print(f"{'all':24s}{every[True]:10d}{every[False]:10d}   {every.total()} together")


if __name__ == "__main__":
    main(sys.argv[1:])
