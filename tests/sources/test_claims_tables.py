"""The claims tables name files that are there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TABLES = sorted(path.name for path in (ROOT / "docs" / "background").glob("claims-*.md"))


def test_each_patent_has_a_table() -> None:
    assert len(TABLES) == 5


@pytest.mark.parametrize("table", TABLES)
def test_every_file_that_a_table_names_is_there(table: str) -> None:
    named = re.findall(
        r"`([\w/]+\.py)`", (ROOT / "docs" / "background" / table).read_text(encoding="utf-8")
    )
    assert named and [name for name in named if not (ROOT / name).is_file()] == []
