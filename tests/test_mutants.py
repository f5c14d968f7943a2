"""Mutants: every kind of change is found in the text, is a program still, and meets its tests."""

from __future__ import annotations

import ast
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.mutants import Copy, Mutant, mutants_of
from tests.mutants import __main__ as runner
from tests.mutants.tree import ROOT, WatchedTest
from tests.mutants.users import users_of

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


FILES = {
    "a": "LIMIT_MM = 0.3\nTWICE_MM = 2 * LIMIT_MM\n\ndef near(x):\n    return x < LIMIT_MM\n",
    "b": "from morfax.motion.a import TWICE_MM\n\nclass Pen:\n    size = 1\n\n    def far(self, x):\n"
    "        return x > TWICE_MM\n\ndef inked():\n    return Pen().far(2)\n",
    "c": "def other(LIMIT_MM):\n    return LIMIT_MM\n",
}


def users(root: Path, file: str, line: int) -> tuple[set[str], set[str]]:
    """Who a change in a line of FILES can matter to."""
    (root / "motion").mkdir(exist_ok=True)
    for name, text in FILES.items():
        (root / "motion" / f"{name}.py").write_text(text, encoding="utf-8")
    found = users_of(root, Path(f"motion/{file}.py"), line)
    return {name.removeprefix("motion/") for name in found.functions}, set(found.symbols)


def test_a_change_matters_to_its_own_function_or_to_who_names_it(tmp_path: Path) -> None:
    """A constant also matters to those of another file that a constant made of it comes to."""
    assert users(tmp_path, "a", 5) == ({"a.py:near"}, set())
    assert users(tmp_path, "b", 7) == ({"b.py:Pen.far"}, set())
    both = {"a.py:near", "b.py:Pen.far"}
    assert users(tmp_path, "a", 1) == (both, {"LIMIT_MM", "TWICE_MM"})
    assert users(tmp_path, "b", 4) == ({"b.py:inked"}, {"Pen"})


def copy_of(root: Path) -> Copy:
    """A small tree with one function, and two tests of which one comes by it."""
    (root / "motion").mkdir()
    (root / "motion" / "__init__.py").write_text("")
    code = (
        "def twice(x):\n    return 2 * x\n\ndef loop(x):\n    while x < 0.1:\n        x += 1\n"
    )
    (root / "motion" / "a.py").write_text(code, encoding="utf-8")
    (root / "test_a.py").write_text(
        "from motion.a import loop, twice\n\ndef test_a():\n    assert twice(2) == 4\n\n"
        "def test_b():\n    loop(0)\n",
        encoding="utf-8",
    )
    copy = object.__new__(Copy)
    copy.root, copy._environment = root, dict(os.environ) | {"PYTHONPATH": str(ROOT)}
    copy._change = root / "change.json"
    return copy


def test_a_mutant_meets_the_tests_that_come_by_it(tmp_path: Path) -> None:
    """The one is found; with the other test it is not, as that does not come by its function."""
    copy = copy_of(tmp_path)
    every = mutants_of(Path("motion/a.py"), (tmp_path / "motion" / "a.py").read_text("utf-8"))
    times = next(mutant for mutant in every if mutant.new == "/")
    one = WatchedTest("test_a.py::test_a", 0.01, frozenset({"motion/a.py:twice"}))
    other = WatchedTest("test_a.py::test_b", 0.01, frozenset({"motion/a.py:loop"}))
    assert copy.tests_for(times, [one, other]) == [one]
    assert copy.finds(times, [one, other]) and not copy.finds(times, [other])


def test_what_the_tests_said_is_kept_for_whoever_has_to_mend_them(tmp_path: Path) -> None:
    copy = copy_of(tmp_path)
    assert copy.passes(["test_a.py"])
    (tmp_path / "motion" / "a.py").write_text("def twice(x): pass\nloop = twice\n")
    assert not copy.passes(["test_a.py"])
    assert "FAILED test_a.py::test_a" in copy.said


def test_a_copy_has_the_vectors_that_tests_ask_for(
    tmp_path: Path, vectors: Callable[[str], Any]
) -> None:
    """Else those tests are left out, and a broken line of theirs is not noticed."""
    assert vectors("se_clock")
    copied = Copy(tmp_path).root.parent / "shared" / "vectors" / "se_clock.json"
    assert copied.is_file()


def test_a_mutant_that_waits_for_ever_is_found(tmp_path: Path) -> None:
    (tmp_path / "test_a.py").write_text(
        "import time\n\ndef test_a():\n    time.sleep(60)\n", encoding="utf-8"
    )
    copy = object.__new__(Copy)
    copy.root, copy._environment = tmp_path, dict(os.environ) | {"PYTHONPATH": str(ROOT)}
    assert not copy.passes(["test_a.py"], 0.1)  # a second of the clock


def test_a_survivor_is_told_by_the_text_that_was_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Somebody who writes tests for the survivors may change the file while the others still run."""
    monkeypatch.setattr(runner, "ROOT", tmp_path)
    (tmp_path / "a.py").write_text(SOURCE)
    chosen = runner.chosen_of(Path("a.py"), 0, 1)
    (tmp_path / "a.py").write_text("# another text\n" * 40)
    assert {chosen.told(m) for m in chosen.mutants} == {m.told(SOURCE) for m in found()}
