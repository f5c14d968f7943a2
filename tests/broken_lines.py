"""The lines that the tables of claims break: each is put into a copy of the tree, and its test must fail.

    python -m tests.broken_lines pratt-whitney
    python -m tests.broken_lines superior-electric sea alfred-herbert

A row of docs/background/claims-*.md ends with its test and the line that is broken for it:

    | 14 | … | `test_claim_14_…` | `player/gcode/residues.py`: `(now < 0) != (before < 0)` → `… == …` |

The text before the arrow stands once in the file. Nothing here is changed; the first run of a test, without
a broken line, compiles its kernels and must pass.
"""

from __future__ import annotations

import re
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from tests.mutants import Copy, Mutant

ROOT = Path(__file__).parents[1]
TABLES = ROOT / "docs" / "background"
LIMIT_S = 90.0  # for one test, with the compiling of a broken kernel; a loop that never ends is noticed too
_BREAK = re.compile(r"`([\w/]+\.py)`: `([^`]+)` → `([^`]+)`")


@dataclass(frozen=True)
class Broken:
    """A claim (or some that share a test), its test, and the line that is broken: text before and after."""

    claim: str
    test: str
    file: Path
    before: str
    after: str

    def mutant(self) -> Mutant:
        """The broken line as a change of the file; raises ValueError where the text does not stand once."""
        source = (ROOT / self.file).read_text(encoding="utf-8")
        if source.count(self.before) != 1:
            raise ValueError(
                f"{self.before!r} stands {source.count(self.before)} times in {self.file}; it must stand once"
            )
        start = source.index(self.before)
        line = source.count("\n", 0, start) + 1
        return Mutant(self.file, line, start, start + len(self.before), self.after)


def test_file(table: str) -> str:
    """The file of tests that a table names."""
    found = re.search(r"`(tests/sources/test_\w+\.py)`", table)
    if not found:
        raise ValueError("the table names no file of tests in tests/sources/")
    return found[1]


def broken_lines(patent: str) -> list[Broken]:
    """The broken lines of the table of a patent, in its order."""
    found = []
    for line in (TABLES / f"claims-{patent}.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.split("|")]
        broken = _BREAK.fullmatch(cells[-2]) if len(cells) > 2 else None
        if broken:
            test, file = cells[-3].strip("`"), Path(broken[1])
            found.append(Broken(cells[1], test, file, broken[2], broken[3]))
    return found


def main() -> None:
    """Break the lines of the tables named, one by one, and list those that their test does not notice."""
    left = 0
    for patent in sys.argv[1:]:
        tests = test_file((TABLES / f"claims-{patent}.md").read_text(encoding="utf-8"))
        with tempfile.TemporaryDirectory() as folder:
            if not Copy(Path(folder), [tests]).passes():
                sys.exit(f"{tests} fails as it is; mend it first")
            for broken in dict.fromkeys(broken_lines(patent)):
                copy = Copy(Path(folder), [f"{tests}::{broken.test}"])
                noticed = copy.notices(broken.mutant(), LIMIT_S)
                left += not noticed
                said = "noticed" if noticed else "NOT NOTICED"
                print(
                    f"{patent} {broken.claim}: {said}: {broken.before} → {broken.after}",
                    flush=True,
                )
    sys.exit(f"{left} broken lines were not noticed" if left else 0)


if __name__ == "__main__":
    main()
