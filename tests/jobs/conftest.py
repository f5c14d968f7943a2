"""What the tests of jobs share: an empty folder, a path file and its tape, as the command line's; silence."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.console.conftest import here, path_file, tape_file

__all__ = ["here", "path_file", "tape_file"]


@pytest.fixture
def silent(capfd: pytest.CaptureFixture[str]) -> Iterator[None]:
    """No job prints."""
    yield
    assert capfd.readouterr() == ("", "")
