"""One line of each patch: which is the line, the run from an open end or the run round about."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.program import one_of_each, selection
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import arc, inked

SHEET = Sheet.of(inked(arc((16, 16), 10)))


def line(ending: str, length_mm: float, ink_mm: float = 100.0) -> Line:
    """A line along X, as it might have ended."""
    places = np.column_stack([np.linspace(0, length_mm, 50), np.zeros(50)])
    return Line(places, ending, 0.5, length_mm, ink_mm=ink_mm)


@pytest.mark.parametrize(
    ("from_end", "round_about", "taken"),
    [
        # an end that is no end led round a part of the ink
        (line("joined", 40), line("closed", 95), "round"),
        # a stem that leads to a small loop
        (line("joined", 40), line("closed", 30), "end"),
        (line("joined", 40), line("joined", 95), "end"),
        # a stem, and the loop that it leads to
        (line("joined", 70), line("closed", 95), "end"),
        (line("ended", 40), line("closed", 95), "end"),
        (None, line("closed", 95), "round"),
    ],
)
def test_a_line_from_an_end_that_leads_round_little_of_the_ink_gives_way(
    monkeypatch: pytest.MonkeyPatch, from_end: Line | None, round_about: Line, taken: str
) -> None:
    monkeypatch.setattr(one_of_each, "followed_from_an_end", lambda *_: from_end)
    monkeypatch.setattr(one_of_each, "followed", lambda *_, **__: round_about)
    asked, _ = selection.plan(SHEET, (1,))
    (found,), letters = one_of_each.one_of_each(Setup(SHEET), asked, (1,))
    assert found is (from_end if taken == "end" else round_about) and letters == 0
