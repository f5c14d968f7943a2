"""The claims tables name files and tests that are there, and lines that can be broken."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.broken_lines import broken_lines
from tests.broken_lines import test_file as file_of_tests

ROOT = Path(__file__).parents[2]
TABLES = sorted(path.name for path in (ROOT / "docs" / "background").glob("claims-*.md"))
BROKEN = ["alfred-herbert", "morfax", "pratt-whitney", "sea", "superior-electric"]


def table_of(name: str) -> str:
    """The text of a table."""
    return (ROOT / "docs" / "background" / name).read_text(encoding="utf-8")


def test_each_patent_has_a_table() -> None:
    assert len(TABLES) == 5


@pytest.mark.parametrize("table", TABLES)
def test_every_file_that_a_table_names_is_there(table: str) -> None:
    named = re.findall(r"`([\w/]+\.py)`", table_of(table))
    assert named and [name for name in named if not (ROOT / name).is_file()] == []


@pytest.mark.parametrize("patent", BROKEN)
def test_every_claim_has_a_test_and_a_line_that_can_be_broken(patent: str) -> None:
    text = table_of(f"claims-{patent}.md")
    rows = [line for line in text.splitlines() if re.match(r"\| \d+ \|", line)]
    broken = broken_lines(patent)
    assert len(broken) == len(rows) == len({line.claim for line in broken})
    for line in broken:
        file, _, test = line.test.rpartition("::")
        tests = (ROOT / (file or file_of_tests(text))).read_text(encoding="utf-8")
        assert f"def {test}(" in tests
        assert line.mutant().new != line.before


def test_the_lines_that_nobody_noticed_can_be_broken() -> None:
    broken = broken_lines("mutants")
    assert len(broken) == 12
    for line in broken:
        file, _, test = line.test.partition("::")
        assert f"def {test}" in (ROOT / file).read_text(encoding="utf-8")
        assert line.mutant().new != line.before
