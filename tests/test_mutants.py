"""Mutants: every kind of change is found in the text, and is a program still."""

from __future__ import annotations

import ast
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.mutants import Copy, Mutant, mutants_of

SOURCE = '''"""A module of 2 words."""
LIMIT_MM: float = 0.3  # µm would be "3"

@njit(cache=True)
def kernel(a, b=0):
    """Not 3 < 4."""
    if a and (b < 2):
        raise ValueError(f"{a + 1} is too small")
    a[0] += max(a, b) * LIMIT_MM
    b[1] = 5
    return (a) - (b) if b is not None else a
'''


def changes() -> set[tuple[int, str, str]]:
    """Line, old text, new text of every mutant."""
    return {(m.line, SOURCE[m.start : m.end], m.new) for m in found()}


def found() -> list[Mutant]:
    return mutants_of(Path("a.py"), SOURCE)


def test_each_kind_of_change_is_made_and_nothing_else() -> None:
    assert changes() == {
        (2, "0.3", "0.6"),
        (2, "0.3", "0.1"),
        (5, "0", "1"),
        (7, "and", "or"),
        (7, "<", ">="),
        (7, "2", "4"),
        (9, "a[0] += max(a, b) * LIMIT_MM", "pass"),
        (9, "max", "min"),
        (9, "*", "/"),
        (10, "b[1] = 5", "pass"),
        (10, "5", "10"),
        (11, "-", "+"),
        (11, "is not", "is"),
    }


def test_every_mutant_can_be_read() -> None:
    for mutant in found():
        ast.parse(mutant.text(SOURCE))
        assert mutant.told(SOURCE).startswith(f"a.py:{mutant.line}: ")


def test_a_copy_has_the_vectors_that_tests_ask_for(
    tmp_path: Path, vectors: Callable[[str], Any]
) -> None:
    """Else those tests are left out, and a broken line of theirs is not noticed."""
    assert vectors("se_clock")
    copied = Copy(tmp_path, []).root.parent / "shared" / "vectors" / "se_clock.json"
    assert copied.is_file()


def test_a_mutant_that_waits_for_ever_is_found(tmp_path: Path) -> None:
    (tmp_path / "test_a.py").write_text(
        "import time\n\ndef test_a():\n    time.sleep(60)\n", encoding="utf-8"
    )
    copy = object.__new__(Copy)
    copy.root, copy.tests, copy._environment = tmp_path, ["test_a.py"], dict(os.environ)
    assert not copy.passes(0.1)  # a second of the clock
