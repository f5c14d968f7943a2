"""Mutants: each is one wrong line in a file, told by its place in the text and by what stands there then.

    a < b     a >= b            a + b     a - b            if a      if not a         min      max
    a == b    a != b            a * b     a / b            a and b   a or b           x[0] = 1    (left out)
    0.8       1.6, 0.27         3         6                  0        1               floor    ceil

What builds a message (`raise`, `assert`, f-strings) is left alone, and so are types and decorators.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from pathlib import Path

OPPOSITE = {
    ast.Lt: ">=", ast.LtE: ">", ast.Gt: "<=", ast.GtE: "<", ast.Eq: "!=", ast.NotEq: "==",
    ast.Is: "is not", ast.IsNot: "is", ast.In: "not in", ast.NotIn: "in",
    ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.FloorDiv: "*", ast.Mod: "*", ast.Pow: "*",
    ast.LShift: ">>", ast.RShift: "<<", ast.BitAnd: "|", ast.BitOr: "&", ast.And: "or", ast.Or: "and",
}  # fmt: skip
_PAIRS = [("min", "max"), ("argmin", "argmax"), ("floor", "ceil")]
TWINS = {one: other for pair in _PAIRS for one, other in (pair, pair[::-1])}


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
        for_types = isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        if not isinstance(node, left_alone) and not for_types:
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
