"""The words of the page: options in messages have the names of the page's controls."""

from __future__ import annotations

import io
from typing import Any

import pytest

from morfax.panel import pipe
from morfax.panel.lookout import Lookout
from morfax.panel.page_words import in_page_words
from morfax.panel.worker import Teller


@pytest.mark.parametrize(
    ("told", "shown"),
    [
        ("give --width 210mm, or --dpi 300", "give “Width” 210mm, or “Dpi” 300"),
        ("leave out --tab-width.", "leave out “Tab width”."),
        ("Invalid value for '--start'", "Invalid value for “Start”"),
        ("give '--resume-at'", "give '--resume-at'"),
        ("give --resume-at 3s", "give --resume-at 3s"),  # the page has no such control
        ("300 -- 400 dpi, a-b", "300 -- 400 dpi, a-b"),
    ],
)
def test_options_that_the_page_has_are_named_as_its_controls_are(told: str, shown: str) -> None:
    assert in_page_words(told) == shown


@pytest.mark.parametrize("kind", ["note", "warning"])
def test_what_a_job_says_reaches_the_page_in_its_words(kind: str) -> None:
    out = io.BytesIO()
    getattr(Teller(out, Lookout()), kind)("give --lines all")
    out.seek(0)
    message: dict[str, Any] = pipe.read_from(out)
    assert (message["say"], message["text"]) == (kind, "give “Lines” all")
