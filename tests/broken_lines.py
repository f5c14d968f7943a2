"""The lines that the tables of claims break: each is put into a copy of the tree, and its test must fail.

    python -m tests.broken_lines pratt-whitney
    python -m tests.broken_lines superior-electric sea alfred-herbert mutants

A row of docs/background/claims-*.md, or of mutants.md, ends with its test and the line that is broken for it:

    | 14 | … | `test_claim_14_…` | `player/gcode/residues.py`: `(now < 0) != (before < 0)` → `… == …` |

The test is one of the file that the page names, or `tests/….py::test_…`. The text before the arrow stands
once in the file. Nothing here is changed; the first run of a test, without
a broken line, compiles its kernels and must pass.
"""

from __future__ import annotations

import re
import resource
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from tests.mutants import Copy, Mutant

ROOT = Path(__file__).parents[1]
TABLES = ROOT / "docs" / "background"
# of processor time for one test, with the compiling of a broken kernel; a loop that never ends is noticed too
LIMIT_S = 120.0
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
    """The file of tests that a table of claims names."""
    found = re.search(r"`(tests/sources/test_\w+\.py)`", table)
    if not found:
        raise ValueError("the table names no file of tests in tests/sources/")
    return found[1]


def page_of(name: str) -> str:
    """The text of the page of a patent's claims, or of `mutants`."""
    file = f"{name}.md" if name == "mutants" else f"claims-{name}.md"
    return (TABLES / file).read_text(encoding="utf-8")


def broken_lines(name: str) -> list[Broken]:
    """The broken lines of the table of a patent, or of `mutants`, in its order."""
    found = []
    for line in page_of(name).splitlines():
        cells = [cell.strip() for cell in line.split("|")]
        broken = _BREAK.fullmatch(cells[-2]) if len(cells) > 2 else None
        if broken:
            test, file = cells[-3].strip("`"), Path(broken[1])
            found.append(Broken(cells[1], test, file, broken[2], broken[3]))
    return found


def _worked_s() -> float:
    """Processor time of all tests so far."""
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def main() -> None:
    """Break the lines of the tables named, one by one, and list those that their test does not notice."""
    left = 0
    for name in sys.argv[1:]:
        lines = list(dict.fromkeys(broken_lines(name)))
        own = "" if name == "mutants" else test_file(page_of(name)) + "::"
        tests = {line: line.test if "::" in line.test else own + line.test for line in lines}
        with tempfile.TemporaryDirectory() as folder:
            copy = Copy(Path(folder))
            if not copy.passes(sorted(set(tests.values()))):
                sys.exit(f"the tests of {name} fail as they are; mend them first")
            for line in lines:
                begun_s = _worked_s()
                noticed = copy.notices(line.mutant(), [tests[line]], LIMIT_S)
                left += not noticed
                said = "noticed" if noticed else "NOT NOTICED"
                if _worked_s() - begun_s > LIMIT_S - 1:
                    said = "noticed by its time alone"
                print(f"{name} {line.claim}: {said}: {line.before} → {line.after}", flush=True)
    sys.exit(f"{left} broken lines were not noticed" if left else 0)


if __name__ == "__main__":
    main()
