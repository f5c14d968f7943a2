"""The glossary: a word has one row in a table, our words are used, and the files that rows name are there."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[2]
ROOMS = (
    "batch",
    "console",
    "jobs",
    "motion",
    "panel",
    "player",
    "recorder",
    "reports",
    "tracer",
)
TEXT = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
# tables of words that no patent has: they stand here because the code, its messages or a page use them
OURS = ("our name | what it is | where", "our name | meaning")
HEAD = "| our name |"


class Row(NamedTuple):
    """A row of a table: the table's head, the words in the first column, and the other columns."""

    head: str
    words: list[str]
    rest: str


def rows() -> Iterator[list[Row]]:
    """The rows of each table."""
    for table in re.findall(rf"^{re.escape(HEAD)}.*\n\| ---.*\n(?:\|.*\n?)+", TEXT, re.M):
        head, _, *lines = table.strip().split("\n")
        yield [_row(head.strip("| "), line) for line in lines]


def _row(head: str, line: str) -> Row:
    """A line of a table; what stands in brackets is no word of the row."""
    first, rest = line.strip("| ").split(" | ", 1)
    words = re.sub(r"\([^()]*\)", "", first).split(",")
    return Row(head, [word.strip().lower() for word in words], rest)


TABLES = list(rows())
ROWS = [row for table in TABLES for row in table]


def test_a_word_has_one_row_in_a_table() -> None:
    assert len(TABLES) > 8 and len(ROWS) > 200
    for table in TABLES:
        words = [word for row in table for word in row.words]
        assert sorted(words) == sorted(set(words)), table[0].head


@pytest.fixture(scope="module")
def used() -> str:
    """All that is written in the code and on the other pages, in small letters."""
    code = [file for room in ROOMS for file in (ROOT / room).rglob("*.py")]
    pages = [file for file in (ROOT / "docs").rglob("*.md") if file.name != "glossary.md"]
    return "\n".join(file.read_text(encoding="utf-8").lower() for file in [*code, *pages])


def test_a_word_of_ours_is_used_somewhere(used: str) -> None:
    idle = [
        row.words[0]
        for row in ROWS
        if row.head in OURS
        and not any(
            re.search(r"[\s_-]*".join(map(re.escape, word.split())), used) for word in row.words
        )
    ]
    assert idle == []


def test_the_files_of_a_row_are_there() -> None:
    files = [str(path.relative_to(ROOT)) for room in ROOMS for path in (ROOT / room).rglob("*")]
    named = {name for row in ROWS for name in re.findall(r"`([a-z_/]+(?:\.py|/))`", row.rest)}
    assert len(named) > 100
    missing = [
        name
        for name in named
        if not any(f"/{file}".endswith(f"/{name.rstrip('/')}") for file in [*files, *ROOMS])
    ]
    assert missing == []
