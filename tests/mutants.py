"""Mutation testing of one room: put one wrong line at a time into the code, and see whether a test fails.

    python -m tests.mutants player/gcode --sample 60 --seed 1

The tree is copied to a temporary folder, so nothing here is changed. A mutant is one of these changes, in a
function or in a constant of a module:

    a < b     a >= b            a + b     a - b            if a      if not a         min      max
    a == b    a != b            a * b     a / b            a and b   a or b           x[0] = 1    (left out)
    0.8       1.6, 0.27         3         6                  0        1               floor    ceil

A mutant is found where a test fails, or where the tests take three times the processor time that they
should, or wait for ever. The quickest files of tests are run first. What builds a message (`raise`, `assert`,
f-strings) is left alone, and so are types and decorators.

Questions: mutants that change nothing (a bound that is never reached) are counted as not found.
"""

from __future__ import annotations

import argparse
import ast
import math
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
OPPOSITE = {
    ast.Lt: ">=", ast.LtE: ">", ast.Gt: "<=", ast.GtE: "<", ast.Eq: "!=", ast.NotEq: "==",
    ast.Is: "is not", ast.IsNot: "is", ast.In: "not in", ast.NotIn: "in",
    ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.FloorDiv: "*", ast.Mod: "*", ast.Pow: "*",
    ast.LShift: ">>", ast.RShift: "<<", ast.BitAnd: "|", ast.BitOr: "&", ast.And: "or", ast.Or: "and",
}  # fmt: skip
_PAIRS = [("min", "max"), ("argmin", "argmax"), ("floor", "ceil")]
TWINS = {one: other for pair in _PAIRS for one, other in (pair, pair[::-1])}
SLOWER = 3.0  # times the tests' own time, for a mutant
SPARE_S = 30.0  # to compile the kernels of a mutant
WAITS = (
    10.0  # times that limit, by the clock: a mutant may also wait for ever, and take no time
)


@dataclass(frozen=True)
class Mutant:
    """A change of the text of a file: from and to which character, and what stands there then."""

    file: Path
    line: int
    start: int
    end: int
    new: str

    def text(self, source: str) -> str:
        """The source with the change."""
        return source[: self.start] + self.new + source[self.end :]

    def told(self, source: str) -> str:
        """File, line, and the line as it becomes, for the list."""
        first = source.rfind("\n", 0, self.start) + 1
        last = source.find("\n", self.end)
        old, new = source[self.start : self.end], self.new
        line = f"{source[first : self.start]}[{old} -> {new}]{source[self.end : last]}"
        return f"{self.file}:{self.line}: {' '.join(line.split())}"


def mutants_of(file: Path, source: str) -> list[Mutant]:
    """All mutants of a file, in the order of its text."""
    finder = _Finder(file, source)
    finder.visit(ast.parse(source))
    return sorted(finder.mutants, key=lambda mutant: (mutant.start, mutant.new))


class _Finder(ast.NodeVisitor):
    """Collects the mutants of one file."""

    def __init__(self, file: Path, source: str) -> None:
        self.file, self.source, self.mutants = file, source, list[Mutant]()
        lines = source.splitlines(keepends=True)
        self._bytes = [line.encode() for line in lines]
        self._starts = [0]
        for line in lines:
            self._starts.append(self._starts[-1] + len(line))
        self._inside = 0

    def visit(self, node: ast.AST) -> None:
        """Visit what may be changed; messages, types and imports are left alone."""
        left_alone = ast.Raise | ast.Assert | ast.JoinedStr | ast.Import | ast.ImportFrom
        if not isinstance(node, left_alone):
            super().visit(node)

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        self._inside += 1
        for default in [*node.args.defaults, *node.args.kw_defaults]:
            if default is not None:
                self.visit(default)
        for statement in node.body:
            self.visit(statement)
        self._inside -= 1

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        for statement in node.body:
            self.visit(statement)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        if node.value is not None:
            self.visit(node.value)

    def visit_Assign(self, node: ast.Assign) -> None:
        if not isinstance(node.targets[0], ast.Name | ast.Tuple):
            self._drop(node)
        self.visit(node.value)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        self._drop(node)
        self.visit(node.value)

    def visit_Expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Call):
            self._drop(node)
            self.visit(node.value)

    def visit_Constant(self, node: ast.Constant) -> None:
        if isinstance(node.value, bool) or not isinstance(node.value, int | float):
            return
        others = (
            [2 * node.value, node.value / 3]
            if isinstance(node.value, float)
            else [2 * node.value]
        )
        for other in others if node.value else [1]:
            self._change(node, f"{other:.6g}" if isinstance(other, float) else str(other))

    def visit_Compare(self, node: ast.Compare) -> None:
        left = node.left
        for operator, right in zip(node.ops, node.comparators, strict=True):
            self._between(left, right, operator)
            left = right
        self.generic_visit(node)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        self._between(node.left, node.right, node.op)
        self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        self._between(node.values[0], node.values[1], node.op)
        self.generic_visit(node)

    def visit_If(self, node: ast.If) -> None:
        self._negate(node.test)
        self.generic_visit(node)

    def visit_While(self, node: ast.While) -> None:
        self._negate(node.test)
        self.generic_visit(node)

    def visit_IfExp(self, node: ast.IfExp) -> None:
        self._negate(node.test)
        self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> None:
        name = node.func
        word = name.id if isinstance(name, ast.Name) else getattr(name, "attr", "")
        if word in TWINS:
            end = self._span(name)[1]
            self._add(name.lineno, end - len(word), end, TWINS[word])
        self.generic_visit(node)

    def _negate(self, test: ast.expr) -> None:
        """Turn a condition about, where it is no comparison, which is turned about itself."""
        if not isinstance(test, ast.Compare | ast.BoolOp):
            start, end = self._span(test)
            self._change(test, f"(not ({self.source[start:end]}))")

    def _drop(self, node: ast.stmt) -> None:
        """Leave out a statement of a function."""
        if self._inside:
            self._change(node, "pass")

    def _change(self, node: ast.expr | ast.stmt, new: str) -> None:
        self._add(node.lineno, *self._span(node), new)

    def _between(self, left: ast.expr, right: ast.expr, operator: ast.AST) -> None:
        """Change the operator that stands between two expressions."""
        start, end = self._span(left)[1], self._span(right)[0]
        found = re.search(
            r"(?<![\w(])(is not|not in|is|in|and|or|[-+*/%<>=!&|]+)(?!\w)",
            self.source[start:end],
        )
        if found and type(operator) in OPPOSITE:
            line = self.source.count("\n", 0, start + found.start()) + 1
            self._add(
                line, start + found.start(1), start + found.end(1), OPPOSITE[type(operator)]
            )

    def _add(self, line: int, start: int, end: int, new: str) -> None:
        self.mutants.append(Mutant(self.file, line, start, end, new))

    def _span(self, node: ast.expr | ast.stmt) -> tuple[int, int]:
        """First and last character (past it) of a node."""
        return self._at(node.lineno, node.col_offset), self._at(
            node.end_lineno or 0, node.end_col_offset or 0
        )

    def _at(self, line: int, column: int) -> int:
        """Where a line and a column (in bytes) are in the text."""
        return self._starts[line - 1] + len(self._bytes[line - 1][:column].decode())


def tests_of(room: str) -> list[str]:
    """The files of tests of a room, and those of the sources that import it."""
    name = "morfax." + room.replace("/", ".")
    sources = (ROOT / "tests" / "sources").glob("test_*.py")
    own = sorted((ROOT / "tests" / room).rglob("test_*.py"))
    asking = [s for s in sources if name in s.read_text("utf-8")]
    return [str(file.relative_to(ROOT)) for file in (*own, *asking)]


class Copy:
    """A copy of the tree, with its own cache of compiled kernels."""

    def __init__(self, folder: Path, tests: list[str]) -> None:
        hidden = shutil.ignore_patterns(".*", "__pycache__", "demo", "site")
        self.root = folder / "tree"
        if not self.root.exists():
            shutil.copytree(ROOT, self.root, symlinks=True, ignore=hidden)
            # tests that ask for the vectors would be left out without them, and notice nothing
            if (ROOT.parent / "shared").exists():
                (folder / "shared").symlink_to(ROOT.parent / "shared")
        self.tests = tests
        self._kernels = folder / "kernels"
        self._environment = os.environ | {
            "NUMBA_CACHE_DIR": str(self._kernels),
            "PYTHONDONTWRITEBYTECODE": "1",
        }

    def passes(self, limit_s: float | None = None) -> bool:
        """Whether the tests pass, in time: processor time, as the machine may have other work."""
        limited = ["prlimit", f"--cpu={math.ceil(limit_s)}"] if limit_s else []
        how = {"cwd": self.root, "env": self._environment}
        pytest = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider"]
        command = [*limited, *pytest, *self.tests]
        try:
            done = subprocess.run(
                command,
                capture_output=True,
                check=False,
                timeout=WAITS * limit_s if limit_s else None,
                **how,
            )
        except subprocess.TimeoutExpired:
            return False
        return done.returncode == 0

    def quickest_first(self) -> float | None:
        """Put the quickest files of tests first, as most mutants are found by any; the processor time of all,
        s, or None if one fails.
        """
        tests, took_s = self.tests, dict[str, float]()
        for file in tests:
            self.tests, began_s = [file], _children_s()
            if not self.passes():
                return None
            took_s[file] = _children_s() - began_s
        self.tests = sorted(tests, key=took_s.__getitem__)
        return sum(took_s.values())

    def notices(self, mutant: Mutant, limit_s: float) -> bool:
        """Whether a test fails with a mutant, which is taken out again."""
        file = self.root / mutant.file
        source = file.read_text(encoding="utf-8")
        self._write(mutant.file, mutant.text(source))
        found = not self.passes(limit_s)
        self._write(mutant.file, source)
        return found

    def _write(self, file: Path, text: str) -> None:
        """Write a file, and forget the compiled kernels of those files that may have taken in one of it.

        numba knows a kernel by the text of its own file alone.
        """
        (self.root / file).write_text(text, encoding="utf-8")
        name = "morfax." + ".".join(file.with_suffix("").parts)
        for other in (self.root / file.parts[0]).rglob("*.py"):
            asked = other.read_text(encoding="utf-8")
            if name in asked and "njit" in asked:
                for kernel in self._kernels.rglob(f"{other.stem}.*"):
                    kernel.unlink()


def _children_s() -> float:
    """The processor time of all processes that have been run and waited for, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    """Run the mutants of a room, and list those that no test has found."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("room", help="a folder, such as player/gcode, or one file of it")
    parser.add_argument(
        "--sample", type=int, default=0, help="so many mutants by chance; 0 is all of them"
    )
    parser.add_argument("--seed", type=int, default=1, help="of the choice")
    parser.add_argument("--tests", nargs="*", help="instead of the room's own and the sources'")
    asked = parser.parse_args()
    place = Path(asked.room)
    inside = (
        [place] if place.suffix else [f.relative_to(ROOT) for f in (ROOT / place).glob("*.py")]
    )
    sources = {file: (ROOT / file).read_text(encoding="utf-8") for file in sorted(inside)}
    every = [mutant for file, source in sources.items() for mutant in mutants_of(file, source)]
    count = min(asked.sample or len(every), len(every))
    chosen = random.Random(asked.seed).sample(every, count)
    tests = asked.tests or tests_of(str(place.parent if place.suffix else place))
    with tempfile.TemporaryDirectory() as folder:
        copy = Copy(Path(folder), tests)
        copy.passes()  # compiles the kernels
        took_s = copy.quickest_first()
        if took_s is None:
            sys.exit("the tests fail without a mutant; mend them first")
        limit_s = SLOWER * took_s + SPARE_S
        named = " ".join(copy.tests)
        print(f"{count} of {len(every)} mutants; {named}; {limit_s:.0f} s each", flush=True)
        left = 0
        for mutant in chosen:
            if not copy.notices(mutant, limit_s):
                left += 1
                print(mutant.told(sources[mutant.file]), flush=True)
    print(f"found {count - left} of {count}, {1 - left / max(1, count):.0%}")


if __name__ == "__main__":
    main()
